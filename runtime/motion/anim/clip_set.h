/* clip_set.h: what a controller knows of the clips it plays.
 *
 * To a controller a clip is a noh_clip_entry: a name, a duration, a loop mode, callback keys and sync markers, as plain
 * data with indices instead of pointers. How its poses are stored the controller need not know: it asks
 * noh_clip_set.sample for them. One set serves any number of instances. A game fills in a set of its own, or takes the
 * one that a noh_clip_bank makes of a pack (clip_bank.h).
 *
 * Threads: a set is only read while instances use it, so any number of threads may share one whose `sample` may run on
 * several threads. Where it may not, each thread passes a copy of its own with another `user`; for clips of packs
 * noh_clip_bank_view holds that copy. */
#ifndef NOH_ANIM_CLIP_SET_H
#define NOH_ANIM_CLIP_SET_H

#include "motion/pose/pose.h"
#include "motion/anim/time.h"
#include "core/base/limits.h"
#include "core/base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A callback key. */
typedef struct noh_event_key {
    uint32_t tick;      /* 0..duration of its clip */
    uint32_t name_hash; /* noh_hash_name of its name */
    uint8_t payload[8];
    float weight_min; /* fires only while its track weighs at least this much; 0: always */
} noh_event_key;

/* A moment that the clips of a sync group have in common: a foot touches the ground. */
typedef struct noh_marker {
    uint32_t tick; /* below the duration, increasing */
    uint32_t id;
} noh_marker;

#define NOH_CLIP_ADDITIVE 1u    /* its poses are differences already: see noh_pose_difference */
#define NOH_CLIP_FLOATS_ONLY 2u /* animates floats only: joints are left to the other tracks */
#define NOH_CLIP_JOINTS_ONLY 4u /* animates joints only: a walk leaves the face to another track */
#define NOH_CLIP_FLAGS (NOH_CLIP_ADDITIVE | NOH_CLIP_FLOATS_ONLY | NOH_CLIP_JOINTS_ONLY)

/* A clip of a set. */
typedef struct noh_clip_entry {
    uint32_t name_hash;
    uint32_t duration_ticks;             /* 0..NOH_DURATION_MAX */
    uint32_t loop;                       /* noh_loop, not NOH_LOOP_OF_CLIP */
    uint32_t flags;                      /* NOH_CLIP_* */
    uint32_t first_event, event_count;   /* in the set's events, in tick order */
    uint32_t first_marker, marker_count; /* in the set's markers */
} noh_clip_entry;

/* The root joint in a clip's first and last frame, as the source has them: rotation, then translation. What `sample`
 * gives at the two ends may be off by the clip's error. */
typedef float noh_root_ends[2][7];

/* The root displacement of one clip; made by noh_root_track_measure (root_motion.h). */
struct noh_root_track;

/* Sample a clip: fill pose[joint_count] with its first joints and floats[float_count].
 * ranges  clip_tick 0..duration */
typedef void (*noh_clip_sample_fn)(void *user, uint32_t clip, uint32_t clip_tick, uint32_t joint_count,
                                   noh_transform *pose, uint32_t float_count, float *floats);

/* The clips of one skeleton, and what they are blended with. Borrowed; constant while instances use it. */
typedef struct noh_clip_set {
    uint32_t clip_count;  /* 1..NOH_CLIPS_MAX */
    uint32_t joint_count; /* 0..NOH_JOINTS_MAX; 0 needs floats, and takes no roots */
    uint32_t float_count; /* 0..NOH_FLOATS_MAX: morph weights and named floats */
    uint32_t mask_count;  /* 0..NOH_MASKS_MAX */
    uint32_t event_count, marker_count;
    const noh_clip_entry *clips;           /* [clip_count] */
    const noh_event_key *events;           /* [event_count]; may be NULL where that is 0 */
    const noh_marker *markers;             /* [marker_count]; may be NULL where that is 0 */
    const noh_transform *bind_pose;        /* [joint_count]; never NULL */
    const float *float_defaults;           /* [float_count]; NULL: all 0 */
    const uint8_t *masks;                  /* [mask_count][joint_count + float_count], 255 = full weight */
    const struct noh_root_track *roots;    /* [clip_count]; NULL: the root joint moves in its pose */
    const noh_root_ends *const *root_ends; /* [clip_count]; NULL: the ends are what `sample` gives */
    noh_clip_sample_fn sample;
    void *user; /* for sample */
} noh_clip_set;

/* Check a set once, before instances use it.
 * errors  ARG a count or pointer, named; DATA a clip (where: its index): its loop mode or duration, the tick, weight or
 *         order of a key, the tick or order of a marker */
noh_result noh_clip_set_check(const noh_clip_set *set, noh_error *error);

/* The index of the clip of that name; NOH_NONE when there is none. */
uint32_t noh_clip_set_find(const noh_clip_set *set, uint32_t name_hash);

#ifdef __cplusplus
}
#endif

#endif
