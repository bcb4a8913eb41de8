/* clip.h: clips without a stage: skeletons and clips of a pack, a bank that decodes them, a controller that plays
 * them, poses and matrices. A stage (noh.h) does all of this for its actors. */

#ifndef NOH_CLIP_H
#define NOH_CLIP_H

#include <stdint.h>

#include "base.h"
#include "format.h"
#include "pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== poses ========
 * The transform of a joint, local to its parent. A pose is an array of transforms in skeleton order, parents
 * first.
 *
 * Threads: no state; any thread. */

/* One joint, local to its parent: model = parent * translation * rotation * scale. */
typedef struct noh_transform {
    float rotation[4];    /* unit quaternion, xyzw */
    float translation[3]; /* model units */
    float scale[3];
} noh_transform;

/* ======== time ======== */

#define NOH_TICKS_PER_SECOND 48000u
#define NOH_SPEED_ONE 65536 /* speeds are 16.16 fixed point: clip ticks per tick */
#define NOH_SPEED_MAX (256 * 65536)
#define NOH_DURATION_MAX 0x7fffffffu        /* ticks: 12.4 hours */
#define NOH_POSITION_MAX ((int64_t)1 << 60) /* 11 years at speed one; larger positions are rebased */

typedef enum noh_loop {
    NOH_LOOP_OF_CLIP = 0, /* in descs only: the clip's own mode */
    NOH_LOOP_ONCE,        /* holds its first and last tick */
    NOH_LOOP_REPEAT,
    NOH_LOOP_PING_PONG /* forwards and back: two legs make one cycle */
} noh_loop;

/* Convert seconds to the nearest tick.
 * ranges  |seconds| <= 1e9, else 0 */
int64_t noh_ticks_from_seconds(double seconds);

/* The remainder when a frame's seconds are rounded to whole ticks; initialise to {0}. At 144 Hz a frame is 333.3 ticks
 * long: rounding each frame alone would lose a third of a tick per frame, one second in 17 minutes. */
typedef struct noh_frame_clock {
    double left_ticks; /* -0.5 to 0.5 */
} noh_frame_clock;

/* ======== sets of clips ========
 * The clips that a controller plays.
 *
 * A noh_clip_entry describes one clip: name, duration, loop mode, callback keys and sync markers, as plain data with
 * indices instead of pointers. How poses are stored is up to noh_clip_set.sample. Any number of instances share one
 * set. A game fills in its own set, or uses the one in a noh_clip_bank.
 *
 * Threads: a set is read-only while instances use it. Threads may share it if `sample` may run on several threads. If
 * not, give each thread a copy with its own `user`; for clips of packs, noh_clip_bank_view holds that copy. */

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
#define NOH_CLIP_MAPPED 8u      /* private: of another skeleton; `sample` at NOH_NONE gives that one's bind pose */
#define NOH_CLIP_FLAGS (NOH_CLIP_ADDITIVE | NOH_CLIP_FLOATS_ONLY | NOH_CLIP_JOINTS_ONLY | NOH_CLIP_MAPPED)

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

/* Root displacement of one clip; measured when a clip bank is opened. */
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
    struct noh_clip_reserve *reserve;      /* private: knows which clips are in memory; NULL: all are */
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

/* ======== tracks ======== */

/* How much of a track runs. Granberg stops distant characters altogether; TIME_ONLY still fires callback keys. */
typedef enum noh_track_mode {
    NOH_TRACK_OFF = 0,   /* does not play */
    NOH_TRACK_TIME_ONLY, /* plays and fires events, but does not affect the pose */
    NOH_TRACK_ON
} noh_track_mode;

/* The blend group (priority in D3DX): low tracks are blended, high tracks are blended, and the high result covers the
 * low one by the controller's priority blend. (Granberg 2009, chapter 5, uses priority for camera distance; here that
 * is `lod_levels`.) */
typedef enum noh_track_group { NOH_GROUP_LOW = 0, NOH_GROUP_HIGH } noh_track_group;

#define NOH_TRACK_SILENT 1u          /* starts at weight 0, to be faded in */
#define NOH_TRACK_PAUSED 2u          /* starts at speed 0 */
#define NOH_TRACK_ADDITIVE 4u        /* its difference from a reference pose is added after the blend */
#define NOH_TRACK_REFERENCE_START 8u /* the reference is the clip's own pose at tick 0, not the bind pose */
#define NOH_TRACK_TURNS 16u          /* in noh_track only: plays ping-pong although its clip does not */
/* in noh_track only: covers part of the bind pose that the other tracks leave visible */
#define NOH_TRACK_RISES 32u
#define NOH_TRACK_FLAGS (NOH_TRACK_SILENT | NOH_TRACK_PAUSED | NOH_TRACK_ADDITIVE | NOH_TRACK_REFERENCE_START)

/* How a track starts. All zeros play clip 0 from its start. */
typedef struct noh_track_desc {
    uint32_t clip;          /* index in the set; default 0 */
    int64_t position_ticks; /* default 0; unwrapped, see low_motion.h; |position| <= 2^44 */
    int32_t speed;          /* 1/65,536; default (0) 65536; |speed| <= NOH_SPEED_MAX, negative plays backwards */
    float weight;           /* default (0) 1; 0..NOH_WEIGHT_MAX */
    noh_loop loop;          /* default NOH_LOOP_OF_CLIP: the clip's own */
    noh_track_mode mode;    /* default (NOH_TRACK_OFF) NOH_TRACK_ON: a track cannot start off */
    noh_track_group group;  /* default NOH_GROUP_LOW */
    uint32_t mask;          /* default 0: none; else 1 + index in the set's masks */
    uint32_t lod_levels;    /* sampled only at LOD levels below this; default (0) always; at most 255 */
    /* default 0: none; 1..NOH_SYNC_GROUPS_MAX; needs NOH_LOOP_REPEAT and a duration of NOH_SYNC_DURATION_MIN..MAX */
    uint32_t sync_group;
    uint32_t flags; /* NOH_TRACK_* */
    /* ADDITIVE: 1 + index of the clip whose first frame is the reference pose; default (0) as the flags say */
    uint32_t reference;
} noh_track_desc;

typedef struct noh_track {
    int64_t position;      /* 1/65,536 ticks, unwrapped */
    int64_t root_position; /* root motion has been returned up to here */
    int64_t speed_now;     /* present playback speed, 1/65,536: its own, a change's or its sync group's */
    int32_t speed;         /* its own speed */
    float weight;
    uint16_t clip;
    uint8_t mask; /* 1 + index, 0: none */
    uint8_t loop, mode, group, sync_group, lod_levels, flags;
    uint8_t placed;     /* 1: not moved since it was started or sought */
    uint16_t reference; /* ADDITIVE: 1 + index of the clip whose first frame is the reference; 0: as its flags say */
    /* how much a track of the low group covers the bind pose, -1..NOH_WEIGHT_MAX. 0 (default): fully,
     * at any weight. Above 0: fully at this weight and proportionally below it, so a track that plays alone can fade.
     * Below 0: by -full, at any weight. May be set */
    float full;
} noh_track;

/* ======== changes over time ========
 * Immediate or scheduled changes of speed, weight, position, mode and priority blend.
 *
 * A controller holds a fixed table of 32-byte records. Times are exact ticks: the effect of a change at a tick does not
 * depend on how time is split into steps.
 *   WEIGHT, PRIORITY   follow the curve at every tick
 *   SPEED              follows the curve in NOH_CHANGE_SLICES equal slices of constant speed, each at its middle
 *                      value, so the distance travelled matches the curve
 *   POSITION           moves along the curve in the same slices and arrives exactly; this counts as play and fires
 *                      callback keys. With duration 0 it jumps and fires none
 *   MODE               switches at the start tick; its duration must be 0
 *
 * Threads: a table belongs to the thread of its controller. */

#define NOH_CURVE_JUMP 2u /* a seek that fires the keys it passes: linear, one tick long, no root motion */

#define NOH_CHANGE_SLICES 64

typedef enum noh_change_kind {
    NOH_CHANGE_SPEED = 0,
    NOH_CHANGE_WEIGHT,
    NOH_CHANGE_POSITION,
    NOH_CHANGE_MODE,
    NOH_CHANGE_PRIORITY
} noh_change_kind;

typedef enum noh_curve { NOH_CURVE_LINEAR = 0, NOH_CURVE_SMOOTHSTEP } noh_curve;

typedef struct noh_change_desc {
    noh_change_kind kind;
    uint32_t track;          /* unused by PRIORITY */
    uint32_t delay_ticks;    /* from now; default 0 */
    uint32_t duration_ticks; /* default 0: immediate */
    noh_curve curve;         /* default linear */
    int32_t speed;           /* SPEED: final speed, 1/65,536; |speed| <= NOH_SPEED_MAX */
    float weight;            /* WEIGHT: final weight, 0..NOH_WEIGHT_MAX; PRIORITY: 0..1 */
    int64_t position_ticks;  /* POSITION: final position, unwrapped; |position| <= 2^44 */
    noh_track_mode mode;     /* MODE */
} noh_change_desc;

/* ======== controllers ========
 * The animation of one instance: tracks, changes over time, callback keys.
 *
 * A controller is one block without pointers: clone, save or restore it with one memcpy of its `bytes`, to memory
 * aligned to NOH_MEMORY_ALIGN. Instances share the clip set, which is passed to every call. Poses go to the caller's
 * buffers.
 *
 * Timing does not depend on how time is split into steps:
 *   - noh_controller_step advances time from event to event;
 *   - keys are delivered exactly once, ordered by the tick at which play passes them, then track, direction of play and
 *     index. An event's tick is the first tick by whose end its key was passed;
 *   - the callback may change the controller. The change takes effect at the event's tick, in the same step: a track
 *     started by an event at tick n is at its start position at n, and its own keys fire from n + 1 on. Keys of other
 *     tracks passed at tick n are still delivered, with the weights their tracks had at n. The callback may call every
 *     function except noh_controller_step, which does nothing there;
 *   - weight_min of a key is compared with the track's weight after all changes up to and including the event's tick.
 *
 * source  D3DX's animation controller as in C. Granberg, "Character Animation with Direct3D", Charles River Media 2009,
 *         chapters 4 and 5; here keys are in ticks instead of seconds, and clones share no state
 *
 * Threads: a controller belongs to one thread at a time. The set is only read, so several threads may step controllers
 * of one set. */

#define NOH_CONTROLLER_INERTIAL 1u /* reserve memory for inertial transitions: 48 bytes per joint, 8 per float */
/* the last step passed more than NOH_STEP_EVENTS_MAX keys; the rest were not delivered */
#define NOH_CONTROLLER_EVENTS_CUT 2u
/* Weights with a sum below 1 cover only partly: the high group covers the pose of the low group, and floats cover their
 * defaults. So a group fades in and out with the weights of its tracks. Without this flag weights are relative. Weights
 * of joints in the low group are always relative. */
#define NOH_CONTROLLER_COVERS 4u

/* Memory: 80 bytes, 48 per track and 32 per change; with NOH_CONTROLLER_INERTIAL 48 more per joint and 8 per float. */
typedef struct noh_controller_desc {
    const noh_clip_set *set; /* checked with noh_clip_set_check; required */
    uint32_t track_count;    /* default (0) 4; at most NOH_TRACKS_MAX */
    /* changes that wait or run at the same time; default (0) track_count + 2; at most NOH_CHANGES_MAX */
    uint32_t change_count;
    uint32_t flags; /* NOH_CONTROLLER_INERTIAL, NOH_CONTROLLER_COVERS */
} noh_controller_desc;

/* The head of the block; tables follow at byte offsets. Fields may be read; change them with the functions below. */
typedef struct noh_controller {
    int64_t clock;          /* ticks since init */
    int64_t inertia_start;  /* clock at which the offsets of a transition began to decay */
    uint32_t inertia_ticks; /* duration of the transition; 0: none */
    uint32_t bytes;         /* of the whole block */
    uint32_t clip_count, joint_count, float_count, mask_count; /* of its set */
    uint32_t track_count, change_count;
    uint32_t tracks_offset, changes_offset, inertia_offset, inertia_floats_offset; /* inertia: 0 without room for it */
    float priority_blend;       /* 0..1: how much the high group covers the low group; starts at 1 */
    uint32_t lod_joint_count;   /* joints that are sampled; the others keep the bind pose */
    uint32_t events_high_water; /* most events that one step has delivered */
    uint16_t changes_high_water;
    uint8_t lod;   /* LOD level; skips tracks with lod_levels of 1..lod */
    uint8_t flags; /* NOH_CONTROLLER_*, and two private flags */
} noh_controller;

/* A callback key that play has passed. */
typedef struct noh_event {
    const noh_event_key *key; /* in the set */
    int64_t clock;            /* the controller's clock, ticks */
    int64_t position_tick;    /* the key's position on its track, unwrapped */
    uint32_t track, clip;
    uint32_t index; /* of the key in its clip */
    float weight;   /* the track's weight at that tick */
    int backward;   /* 1: play ran backwards */
} noh_event;

typedef void (*noh_event_fn)(void *user, const noh_event *event);

/* ---- memory ---- */

/* Exact size in bytes; 0 if the desc is invalid. */
size_t noh_controller_size(const noh_controller_desc *desc);

/* Make a controller in memory[bytes], with all tracks off and the clock at 0.
 * errors  ARG a field of the desc, or memory NULL or misaligned; MEMORY too small (need: the bytes) */
noh_result noh_controller_init(void *memory, size_t bytes, const noh_controller_desc *desc, noh_controller **controller,
                               noh_error *error);

/* ---- tracks ---- */

noh_track *noh_controller_tracks(noh_controller *c); /* [track_count] */
const noh_track *noh_controller_track(const noh_controller *c, uint32_t track);

/* Start a clip on a track. Ends the clip that played there and removes its changes. A track that joins a sync group
 * moves to the group's phase.
 * errors  ARG names the field; the track is then unchanged */
noh_result noh_controller_start(noh_controller *c, const noh_clip_set *set, uint32_t track, const noh_track_desc *desc,
                                noh_error *error);

typedef enum noh_seek {
    NOH_SEEK_SKIP = 0, /* jump without firing callbacks; keys exactly at the target fire when play moves on */
    NOH_SEEK_FIRE /* move to the target within the next tick, forwards or backwards, and fire the keys on the way */
} noh_seek;

/* Move a track to a tick of its present pass (for a ping-pong clip: its present cycle of two legs). Ticks below 0 or
 * past the duration lie in earlier or later passes. The track's sync group follows.
 * errors  ARG track, tick or policy, or FIRE on a synchronised track; LIMIT FIRE needs a free change */
noh_result noh_controller_seek(noh_controller *c, const noh_clip_set *set, uint32_t track, int64_t tick,
                               noh_seek policy, noh_error *error);

/* Set a value immediately and end a running change of the same kind.
 * errors  ARG bad track, or value out of range (see noh_track_desc) */
noh_result noh_controller_set_speed(noh_controller *c, uint32_t track, int32_t speed);
noh_result noh_controller_set_weight(noh_controller *c, uint32_t track, float weight);
noh_result noh_controller_set_mode(noh_controller *c, uint32_t track, noh_track_mode mode);
noh_result noh_controller_set_priority_blend(noh_controller *c, float blend);

/* Set the LOD level: sample only joints 0..joint_count-1 (0: all) and skip tracks with lod_levels of 1..lod.
 * errors  ARG lod above 255, or more joints than the set has */
noh_result noh_controller_set_lod(noh_controller *c, uint32_t lod, uint32_t joint_count);

/* ---- time ---- */

/* Start or schedule a change over time.
 * errors  ARG a field of the desc; LIMIT the table of changes is full */
noh_result noh_controller_change(noh_controller *c, const noh_clip_set *set, const noh_change_desc *desc,
                                 noh_error *error);

/* Fade one track out and switch it off, while another fades in to `weight`. Uses three changes.
 * errors  as noh_controller_change; nothing has changed then */
noh_result noh_controller_cross_fade(noh_controller *c, const noh_clip_set *set, uint32_t from, uint32_t to,
                                     float weight, uint32_t duration_ticks, noh_curve curve, noh_error *error);

/* Advance time and deliver events. fn may be NULL.
 * A step delivers at most NOH_STEP_EVENTS_MAX events. Later keys are passed without delivery, and
 * NOH_CONTROLLER_EVENTS_CUT is set in c->flags until the next step.
 * ranges   ticks 0..2^32-1; 0 does nothing. The clock stops at INT64_MAX
 * returns  the number of events delivered */
uint32_t noh_controller_step(noh_controller *c, const noh_clip_set *set, uint32_t ticks, noh_event_fn fn, void *user);

/* ======== root motion ======== */

#define NOH_ROOT_X 1u
#define NOH_ROOT_Y 2u
#define NOH_ROOT_Z 4u
#define NOH_ROOT_HEADING 8u
#define NOH_ROOT_GROUND (NOH_ROOT_X | NOH_ROOT_Z | NOH_ROOT_HEADING) /* for y up */
#define NOH_ROOT_BY_GAME 16u                                         /* of noh_kind_desc.root_axes alone */

/* A displacement: turn about the up axis, then translate. */
typedef struct noh_root_pose {
    double translation[3]; /* model units */
    uint32_t turn;         /* 2^-32 turns, counter-clockwise seen from the tip of the up axis */
    uint32_t reserved;
} noh_root_pose;

/* Root motion data of one clip. Plain data. */
typedef struct noh_root_track {
    uint32_t axes;                  /* NOH_ROOT_*; 0: nothing is extracted */
    uint32_t up;                    /* 0, 1, 2: x, y, z */
    noh_root_pose start, end, loop; /* E(0), E(duration), L */
    float seam[2][3];               /* E(0) and E(duration) minus the sampled values */
    int32_t seam_turn[2];
    uint32_t facing; /* heading of the first frame, 2^-32 turns; stays in the pose */
    uint32_t reserved;
} noh_root_track;

/* Compose: displacement a, then b in the resulting frame. */
noh_root_pose noh_root_compose(uint32_t up, const noh_root_pose *a, const noh_root_pose *b);

/* ======== skeletons ======== */

typedef struct noh_skeleton {
    uint32_t joint_count;           /* 1..NOH_JOINTS_MAX */
    const uint16_t *parents;        /* [joint_count], each below its joint's own index, or NOH_JOINT_ROOT */
    const noh_transform *bind_pose; /* [joint_count], local */
    const float *inverse_bind;      /* [joint_count][12], see low_motion.h; NULL: all identity */
} noh_skeleton;

/* ======== blending ======== */

/* A blend in progress. The arrays are borrowed; joint_count may be less than their length. */
typedef struct noh_blend {
    uint32_t joint_count, float_count;
    noh_transform *sum;   /* [joint_count] */
    float *weights;       /* [joint_count] */
    float *float_sum;     /* [float_count] */
    float *float_weights; /* [float_count] */
    float *totals;        /* [joint_count] unmasked weights, only of a sum that lies over another */
    float *float_totals;  /* [float_count] likewise */
    int covers;           /* 1: it lies over another sum */
    /* 0: weights are relative. 1: weights with a sum below 1 cover only partly: floats their defaults, a sum that
     * lies over another the pose below it */
    float full;
} noh_blend;

/* A mask: one factor per joint and float, 255 = 1; NULL arrays: 1 everywhere (track masks: Granberg 2009, chapter
 * 16). */
typedef struct noh_mask_view {
    const uint8_t *joints; /* [joint_count] */
    const uint8_t *floats; /* [float_count] */
} noh_mask_view;

/* ======== poses of a controller ========
 * Poses and root motion of a controller, and inertial transitions.
 *
 * Posing reads the controller and writes only to the caller's buffers, so one scratch serves any number of instances in
 * turn. (In Granberg 2009, chapter 4, all clones of a controller write one tree of joints, and each must be drawn
 * before the next is posed.)
 *
 * Threads: a controller and a scratch belong to one thread at a time. Several threads may pose controllers of one set,
 * each with its own scratch, if set->sample allows it. With a noh_clip_bank give each thread its own view. */

/* Working memory for posing. It holds no state between calls, so instances of a set that are posed one after another
 * share it. The exception: while an inertial transition begins it holds the captured poses. */
typedef struct noh_pose_scratch {
    noh_blend blend;
    noh_transform *sample;             /* [joint_count] */
    float *below;                      /* [joint_count] weights of the low group */
    float *float_sample, *float_below; /* [float_count] */
    noh_transform *captured[4];        /* [joint_count] each: source, source before, target, target before */
    float *float_captured[4];
} noh_pose_scratch;

/* Size and make a scratch, aligned to NOH_MEMORY_ALIGN. `inertial` 1 adds memory for the four poses of a transition.
 * The size is 0 for a set over NOH_JOINTS_MAX or NOH_FLOATS_MAX.
 * errors  ARG the set is over a limit, or memory NULL or misaligned; MEMORY need: the bytes */
size_t noh_pose_scratch_size(const noh_clip_set *set, int inertial);
noh_result noh_pose_scratch_init(void *memory, size_t bytes, const noh_clip_set *set, int inertial,
                                 noh_pose_scratch *scratch, noh_error *error);

/* Compute the pose at the controller's clock: the low group, the high group over it by the priority blend, additive
 * tracks in order, then the remaining transition offsets. Clips with NOH_CLIP_FLOATS_ONLY do not affect joints; clips
 * without floats do not affect floats. A single unmasked track reproduces its clip bit for bit.
 * shapes  pose[joint_count], floats[float_count] of the set */
void noh_controller_pose(const noh_controller *c, const noh_clip_set *set, noh_pose_scratch *scratch,
                         noh_transform *pose, float *floats);

/* Take the root displacement since the last call, with the weights of joint 0. Additive tracks and clips that animate
 * no joints do not count. A seek does not move the root and discards the track's displacement since the last call. Zero
 * without set->roots. All roots of a set must have the same up axis. */
noh_root_pose noh_controller_root_motion(noh_controller *c, const noh_clip_set *set);

/* ======== masks ========
 * Weights per joint and per float, one byte each (track masks: Granberg 2009, chapter 16).
 *
 * 255 = full weight, 0 = excluded. A mask of a set is uint8_t[joint_count + float_count]. Fill masks in your own memory
 * at load time.
 *
 * Threads: pure functions of their arguments; any thread. */

/* Set all entries. */
void noh_mask_fill(uint8_t *mask, uint32_t count, uint8_t value);

/* Set the entries of a joint and all its descendants.
 * ranges  joint below skeleton->joint_count */
void noh_mask_subtree(uint8_t *mask, const noh_skeleton *skeleton, uint32_t joint, uint8_t value);

/* ======== weights as functions of time ========
 * Weights as functions of time: a ramp and a ping-pong.
 *
 * Times are 64-bit ticks of the caller's own counter, so nothing wraps or drifts.
 *
 * Threads: pure functions; any thread. */

/* Ramp from 0 at tick 0 to 1 at `duration`, clamped. A duration of 0 or less steps to 1 at tick 0. */
float noh_ramp(int64_t ticks, int64_t duration);

/* Triangle wave: 0 at tick 0, 1 at `half`, 0 at 2 * `half`, and so on, also before tick 0. Returns 0 if `half` is 0 or
 * less. */
float noh_ping_pong(int64_t ticks, int64_t half);

/* ======== compressed clips ======== */

/* Floats that belong together: the morph weights of a node, or one named float. */
typedef struct noh_clip_group {
    uint32_t name_hash;
    uint32_t node;         /* 0xffffffff: none */
    uint32_t first, width; /* floats of a sample */
} noh_clip_group;

/* ======== the clip cache ======== */

typedef struct noh_clip_cache noh_clip_cache;

/* ======== views of a clip cache, for threads ======== */

typedef struct noh_clip_view noh_clip_view;

/* ======== skeletons and clips of a pack ========
 * Skeletons and compressed clips of a pack, as pointers into its bytes.
 *
 * Threads: a pack is read-only; any number of threads. */

/* One clip. Pass its `bytes`, and the bind pose of header->skeleton, to noh_clip_init (low_motion.h). */
typedef struct noh_pack_clip {
    const char *name;
    const noh_clip_header *header;
    const noh_clip_event *events;   /* [header->event_count], in time order */
    const noh_clip_marker *markers; /* [header->marker_count], in time order */
    const uint8_t *bytes;           /* [header->clip_bytes] */
    const float *joint_errors; /* [header->joint_error_count], for the LOD levels of header->skeleton, in its unit */
} noh_pack_clip;

/* Get a skeleton by index; header (NULL: not wanted) receives its hash and unit.
 * errors  NOT_FOUND index past the last skeleton (where: the index, need: the count) */
noh_result noh_pack_skeleton_at(const noh_pack *pack, uint32_t index, noh_skeleton *skeleton,
                                const noh_skeleton_header **header, noh_error *error);

/* Get the name of a joint; "" if there is no such skeleton or joint. */
const char *noh_pack_joint_name(const noh_pack *pack, uint32_t skeleton, uint32_t joint);

/* Get the LOD levels of a skeleton as joint counts: each level poses that many of the first joints.
 * shapes   the result [*level_count], descending; the first is the skeleton's joint_count
 * returns  NULL, and a level_count of 0, if index is past the last skeleton */
const uint32_t *noh_pack_joint_levels(const noh_pack *pack, uint32_t skeleton, uint32_t *level_count);

/* Get a clip by index.
 * errors  NOT_FOUND index past the last clip (where: the index, need: the count) */
noh_result noh_pack_clip_at(const noh_pack *pack, uint32_t index, noh_pack_clip *clip, noh_error *error);

/* Find the skeleton in `pack` that a clip of another pack was built for, by hash, and its index (NULL: not wanted).
 * errors  NOT_FOUND no skeleton in `pack` has the same joints: names and parents (where: the hash) */
noh_result noh_pack_bind_clip(const noh_pack *pack, const noh_pack_clip *clip, noh_skeleton *skeleton, uint32_t *index,
                              noh_error *error);

/* ======== clip banks ========
 * The compressed clips of packs, ready for controllers to play.
 *
 * A clip bank holds everything that can move one skeleton and the morph weights of its pack: the clips that fit,
 * opened, with one cache of decoded segments. Its noh_clip_set, bank->clips, serves any number of controllers.
 * Controllers see only the set (names, durations, keys, a sample function); packs, codec and cache stay behind it.
 * Skeleton and meshes may be in one pack and the clips in others: skeletons are matched by hash, morph weights by node
 * name.
 *
 * Several packs of clips make one set, in order: a base game, its additions, its patches. A clip in a later pack
 * replaces a clip of the same name in an earlier pack, if both fit. Appending a pack replaces or adds clips; existing
 * clips keep their index. Names are not compared within one pack.
 *
 * In each frame of a game call
 *   noh_clip_cache_begin_frame(bank->cache);                        once
 *   noh_controller_step(c, &bank->clips, ticks, fn, user);          per controller
 *   noh_clip_bank_prefetch(bank, c, ahead_ticks);                   per controller
 *   noh_clip_cache_work(bank->cache, budget);                       once: decodes ahead of need
 *   noh_controller_pose(c, &bank->clips, &scratch, pose, floats);   per controller
 * Without prefetch and work the poses are the same, but decoded when they are sampled.
 *
 * Floats: first the morph weights of every node of the mesh pack that has targets, in node order, with the node's
 * defaults; then the named floats of the clips, in order of first occurrence, with default 0. `groups` lists the
 * position of each; noh_clip_bank_mesh_weights finds the weights of a mesh. Floats that a clip does not move have their
 * defaults.
 *
 * Threads: stepping only reads the bank, so any thread may step its own controllers. begin_frame, prefetch and work
 * change the cache: call them on one thread, with no other call on the bank at the same time. Calls that sample
 * (noh_controller_pose, _root_motion, _inertia_*) also change the cache when
 * passed &bank->clips: one thread only. To pose on several threads, give each thread a noh_clip_bank_view and pass
 * &view->clips instead:
 *   noh_controller_pose(c, &view->clips, &scratch, pose, floats);   per controller, with the thread's own view, scratch
 * The poses are bit-identical. A view never changes the bank: it decodes missing segments for itself only, so prefetch
 * what plays. There is no lock; the caller orders work before posing, and posing before the next frame. */

/* Clips of another skeleton for a skeleton, as noh_retarget_init (low_life.h) makes it: the first field of a
 * noh_retarget. */
typedef struct noh_clip_map {
    const noh_skeleton *source, *target; /* borrowed */
    float ratio;                         /* of the target's size to the source's, each in its own unit */
    /* private: a pose of the source as one of the target, or its first joint_count joints */
    void (*pose)(const struct noh_clip_map *map, const noh_transform *from, uint32_t joint_count, noh_transform *to);
    uint32_t least; /* private: a pose of fewer joints is cut from one of this many, on which they depend; 0: none */
} noh_clip_map;

typedef struct noh_clip_bank_desc {
    const noh_pack *clips; /* the pack whose clips are played; NULL if clip_packs is set */
    /* the pack with the skeleton and nodes that the clips move; default (NULL) `clips`, or the first of clip_packs */
    const noh_pack *mesh;
    /* index in `mesh`, default 0. NOH_NONE, or any index in a pack without skeletons: only clips without joints */
    uint32_t skeleton;
    /* segments that the cache holds; default (0): NOH_CLIP_CACHE_SEGMENTS_PER_TRACK for each of instance_count *
     * track_count tracks, enough to look ahead by one segment; never more than the clips have */
    uint32_t cached_segment_count;
    uint32_t instance_count; /* instances that play at the same time; default (0) 1 */
    uint32_t track_count;    /* tracks of each that play at the same time; default (0) 2, a cross-fade */
    uint32_t root_axes;      /* NOH_ROOT_* to extract from joint 0 as root motion; default (0) none */
    uint32_t root_up;        /* axis of the heading: 0 x, 1 y, 2 z; unused without root_axes */
    /* [clip_pack_count] several packs instead of `clips`, none NULL; both arrays are borrowed until the bank is made */
    const noh_pack *const *clip_packs;
    uint32_t clip_pack_count; /* 0 with `clips` */
    /* sample rate, in frames per second, that suffices: clips with at least twice this rate use half the cache and less
     * time (low_motion.h); default (0) the full rate */
    uint32_t sample_rate_needed;
    uint32_t reserve_bytes; /* private, as noh_kind_desc.clip_reserve (noh.h); 0 */
    /* clips of map->source play, too, as poses of the skeleton, which map->target has to be. In a pack, one of the
     * skeleton itself hides mapped ones of its name. Must outlive the bank, unchanged. Default (NULL) none */
    const noh_clip_map *map;
} noh_clip_bank_desc;

/* Sizes and counts, known before any memory is allocated. */
typedef struct noh_clip_bank_needs {
    size_t bytes;                  /* of the bank: noh_clip_bank_size */
    size_t view_bytes;             /* of each view: noh_clip_bank_view_size */
    noh_clip_set shape;            /* counts only, for noh_controller_size and noh_pose_scratch_size */
    uint32_t cached_segment_count; /* segments that the cache will hold */
    uint32_t segment_count;        /* segments of all clips */
    uint32_t foreign_count;        /* clips left out because they move another skeleton */
    uint32_t replaced_count;       /* clips left out for one of the same name: in a later pack, or not through `map` */
} noh_clip_bank_needs;

typedef struct noh_clip_bank {
    /* the set, for noh_controller_*; fill in masks and mask_count, if any, before making controllers and views */
    noh_clip_set clips;
    noh_skeleton skeleton; /* of the mesh pack; joint_count 0 without one */
    noh_clip_cache *cache; /* clip i of the cache is clip i of the set */
    /* [group_count] groups of the set's floats; `node` is a node of the mesh pack, NOH_NONE for a named float */
    const noh_clip_group *groups;
    const uint32_t *packs;      /* [clips.clip_count] the pack of each clip: an index in clip_packs; 0 with `clips` */
    const uint32_t *pack_clips; /* [clips.clip_count] index of each clip in its pack, for noh_pack_clip_at */
    uint32_t group_count;
    uint32_t foreign_count, replaced_count; /* as above */
    uint32_t unknown_count; /* weight groups of the clips without a matching node in the mesh pack: not played */
    const noh_node *nodes;  /* private: of the mesh pack */
    const struct noh_bank_clip *bound; /* [clips.clip_count] private */
    float *sampled;                    /* private: the floats of one clip */
    uint32_t sampled_count;            /* private */
    const noh_clip_map *map;           /* private: NULL: no clip needs it */
    noh_transform *mapped;             /* private: a pose of its source */
} noh_clip_bank;

/* Check a desc and the headers of all clips; find the clips that fit and all sizes.
 * errors  as noh_clip_bank_init, except for memory */
noh_result noh_clip_bank_measure(const noh_clip_bank_desc *desc, noh_clip_bank_needs *needs, noh_error *error);

/* Exact size of a bank in bytes, including its clips and cache; 0 on error. */
size_t noh_clip_bank_size(const noh_clip_bank_desc *desc, noh_error *error);

/* Make a bank in memory[bytes], aligned to NOH_MEMORY_ALIGN. The packs' bytes must outlive it.
 * errors  ARG a field of desc, named, or memory NULL or misaligned; MEMORY need: the bytes;
 *         NOT_FOUND no clip fits: all have joints of another skeleton (need: their count), or of one in another unit
 *         (where: the skeleton);
 *         DATA a clip is broken, or its keys or markers lie outside it (where: the clip);
 *         LIMIT a clip longer than NOH_DURATION_MAX (where: the clip), more clips than NOH_CLIP_CACHE_CLIPS_MAX, or
 *         more floats than NOH_FLOATS_MAX.
 *         `where` is an index in a pack, plus 2^32 times the pack's index in clip_packs */
noh_result noh_clip_bank_init(void *memory, size_t bytes, const noh_clip_bank_desc *desc, noh_clip_bank **bank,
                              noh_error *error);

/* Find a clip by name.
 * returns  its index, or NOH_NONE */
uint32_t noh_clip_bank_find(const noh_clip_bank *bank, const char *name);

/* Get the morph weights of a mesh in the floats of a pose, as of the first node that draws it, for noh_morph_accumulate
 * and noh_gl_morph_set_weights.
 * shapes   floats[clips.float_count] of a pose; the result [the mesh's target_count] points into floats
 * returns  NULL if no clip of the bank has weights for the mesh: it keeps its defaults */
const float *noh_clip_bank_mesh_weights(const noh_clip_bank *bank, const float *floats, uint32_t mesh);

/* Request the segments that a controller's tracks need now and within the next ahead_ticks, assuming that position,
 * playback speed, loop mode and LOD level stay as they are. Includes tracks of weight 0. Decodes nothing.
 * ranges   ahead_ticks up to 2^31; the cache should have room for every segment in that range
 * returns  the number of segments that found no room in this frame and will be decoded late */
uint32_t noh_clip_bank_prefetch(noh_clip_bank *bank, const noh_controller *controller, uint32_t ahead_ticks);

/* ---- several threads ---- */

/* The clips of a bank for one thread. */
typedef struct noh_clip_bank_view {
    noh_clip_set clips; /* a copy of bank->clips that samples through this view */
    const noh_clip_bank *bank;
    noh_clip_view *samples; /* counts its late decodes */
    float *sampled;         /* private: the floats of one clip */
    noh_transform *mapped;  /* private: a pose of the map's source */
} noh_clip_bank_view;

/* Exact size of a view in bytes: two segments, and the floats of a clip. */
size_t noh_clip_bank_view_size(const noh_clip_bank *bank);

/* Make a view in memory[bytes], aligned to NOH_MEMORY_ALIGN. The bank must outlive it. Copies the bank's masks as they
 * are now.
 * errors  ARG memory NULL or misaligned; MEMORY need: the bytes */
noh_result noh_clip_bank_view_init(void *memory, size_t bytes, const noh_clip_bank *bank, noh_clip_bank_view **view,
                                   noh_error *error);

/* ======== poses to matrices ======== */

/* Compute model-space matrices in one pass over the joints.
 * shapes  pose[joint_count], model[joint_count][12]
 * ranges  joint_count at most the skeleton's; a LOD level uses the first joints only */
void noh_local_to_model(const noh_skeleton *skeleton, const noh_transform *pose, uint32_t joint_count, float *model);

/* Compute skinning matrices: model * inverse bind.
 * shapes  model[joint_count][12], palette[joint_count][12]; palette may be model */
void noh_model_to_palette(const noh_skeleton *skeleton, const float *model, uint32_t joint_count, float *palette);

#ifdef __cplusplus
}
#endif

#endif
