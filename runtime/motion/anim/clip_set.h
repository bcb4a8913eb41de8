/* clip_set.h: the clips that a controller plays.
 *
 * A noh_clip_entry describes one clip: name, duration, loop mode, callback keys and sync markers, as plain data with
 * indices instead of pointers. How poses are stored is up to noh_clip_set.sample. Any number of instances share one
 * set. A game fills in its own set, or uses the one in a noh_clip_bank (clip_bank.h).
 *
 * Threads: a set is read-only while instances use it. Threads may share it if `sample` may run on several threads. If
 * not, give each thread a copy with its own `user`; for clips of packs, noh_clip_bank_view holds that copy. */
#ifndef NOH_ANIM_CLIP_SET_H
#define NOH_ANIM_CLIP_SET_H

#include "motion/pose/pose.h"
#include "motion/anim/time.h"
#include "core/base/limits.h"
#include "core/base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_event_key {
    uint32_t tick;      /* 0..duration of its clip */
    uint32_t name_hash; /* noh_hash_name of its name */
    uint8_t payload[8];
    float weight_min; /* fires only while its track's weight is at least this; 0: always */
} noh_event_key;

/* A moment that the clips of a sync group share, such as a foot touching the ground. */
typedef struct noh_marker {
    uint32_t tick; /* below the duration, increasing */
    uint32_t id;
} noh_marker;

#define NOH_CLIP_ADDITIVE 1u    /* its poses are differences: see noh_pose_difference */
#define NOH_CLIP_FLOATS_ONLY 2u /* animates floats only; other tracks move the joints */
#define NOH_CLIP_JOINTS_ONLY 4u /* animates joints only, such as a walk that leaves the face to another track */
#define NOH_CLIP_FLAGS (NOH_CLIP_ADDITIVE | NOH_CLIP_FLOATS_ONLY | NOH_CLIP_JOINTS_ONLY)

typedef struct noh_clip_entry {
    uint32_t name_hash;
    uint32_t duration_ticks;             /* 0..NOH_DURATION_MAX */
    uint32_t loop;                       /* noh_loop, not NOH_LOOP_OF_CLIP */
    uint32_t flags;                      /* NOH_CLIP_* */
    uint32_t first_event, event_count;   /* in the set's events, in tick order */
    uint32_t first_marker, marker_count; /* in the set's markers */
} noh_clip_entry;

/* The root joint in the first and last frame of the source clip: rotation, then translation. `sample` may differ from
 * these by the clip's compression error. */
typedef float noh_root_ends[2][7];

/* Root displacement of one clip; made by noh_root_track_measure (root_motion.h). */
struct noh_root_track;

/* Sample a clip: fill pose[joint_count] with its first joints, and floats[float_count].
 * ranges  clip_tick 0..duration */
typedef void (*noh_clip_sample_fn)(void *user, uint32_t clip, uint32_t clip_tick, uint32_t joint_count,
                                   noh_transform *pose, uint32_t float_count, float *floats);

/* The clips of one skeleton and the data to blend them. Borrowed; constant while instances use it. */
typedef struct noh_clip_set {
    uint32_t clip_count;  /* 1..NOH_CLIPS_MAX */
    uint32_t joint_count; /* 0..NOH_JOINTS_MAX; 0 requires float_count > 0 and roots NULL */
    uint32_t float_count; /* 0..NOH_FLOATS_MAX: morph weights and named floats */
    uint32_t mask_count;  /* 0..NOH_MASKS_MAX */
    uint32_t event_count, marker_count;
    const noh_clip_entry *clips;           /* [clip_count] */
    const noh_event_key *events;           /* [event_count]; may be NULL if that is 0 */
    const noh_marker *markers;             /* [marker_count]; may be NULL if that is 0 */
    const noh_transform *bind_pose;        /* [joint_count]; never NULL */
    const float *float_defaults;           /* [float_count]; NULL: all 0 */
    const uint8_t *masks;                  /* [mask_count][joint_count + float_count], 255 = full weight */
    const struct noh_root_track *roots;    /* [clip_count]; NULL: no root motion, the root joint moves in its pose */
    const noh_root_ends *const *root_ends; /* [clip_count]; NULL: use `sample` at both ends */
    noh_clip_sample_fn sample;
    void *user; /* passed to sample */
} noh_clip_set;

/* Check a set once, before instances use it.
 * errors  ARG names a count or pointer; DATA a clip (where: its index) has a bad loop mode or duration, a key with a
 *         bad tick, weight or order, or a marker with a bad tick or order */
noh_result noh_clip_set_check(const noh_clip_set *set, noh_error *error);

/* Find a clip by name.
 * returns  its index, or NOH_NONE */
uint32_t noh_clip_set_find(const noh_clip_set *set, uint32_t name_hash);

#ifdef __cplusplus
}
#endif

#endif
