/* controller.h: the animation of one instance: tracks, changes over time, callback keys.
 *
 * A controller is one block without pointers: clone, save or restore it with one memcpy of noh_controller_bytes(c)
 * bytes. Instances share the clip set, which is passed to every call. Poses go to the caller's buffers.
 *
 * Timing does not depend on how time is split into steps:
 *   - noh_controller_step advances time from event to event;
 *   - keys are delivered exactly once, ordered by the tick at which play passes them, then track, direction of play and
 *     index (events.h has the definition). An event's tick is the first tick by whose end its key was passed;
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
#ifndef NOH_ANIM_CONTROLLER_H
#define NOH_ANIM_CONTROLLER_H

#include "motion/anim/changes.h"
#include "core/base/limits.h"

#ifdef __cplusplus
extern "C" {
#endif

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

/* Bytes to copy to clone or save a controller. Align the copy to NOH_MEMORY_ALIGN too. */
size_t noh_controller_bytes(const noh_controller *c);

/* Check a block from outside, such as a saved game, before any other call. A block that passes cannot make a call
 * overrun its memory, overflow or hang. Transition offsets are not checked, so poses may still be meaningless.
 * errors  ARG memory NULL or misaligned; DATA not a controller for this set (where: the track or change) */
noh_result noh_controller_check(const void *memory, size_t bytes, const noh_clip_set *set, noh_error *error);

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

/* Start or schedule a change over time (changes.h).
 * errors  ARG a field of the desc; LIMIT the table of changes is full */
noh_result noh_controller_change(noh_controller *c, const noh_clip_set *set, const noh_change_desc *desc,
                                 noh_error *error);

/* Fade one track out and switch it off, while another fades in to `weight`. Uses three changes.
 * errors  as noh_controller_change; nothing has changed then */
noh_result noh_controller_cross_fade(noh_controller *c, const noh_clip_set *set, uint32_t from, uint32_t to,
                                     float weight, uint32_t duration_ticks, noh_curve curve, noh_error *error);

/* Advance time and deliver events. fn may be NULL.
 * A step delivers at most NOH_STEP_EVENTS_MAX events. Later keys are passed without delivery, and
 * NOH_CONTROLLER_EVENTS_CUT is set in c->flags until the next step. noh_controller_events_max gives an upper bound
 * beforehand.
 * ranges   ticks 0..2^32-1; 0 does nothing. The clock stops at INT64_MAX
 * returns  the number of events delivered */
uint32_t noh_controller_step(noh_controller *c, const noh_clip_set *set, uint32_t ticks, noh_event_fn fn, void *user);

/* Upper bound on the events of a step, including running changes, if the callback starts and moves nothing. At most
 * NOH_STEP_EVENTS_MAX. */
uint32_t noh_controller_events_max(const noh_controller *c, const noh_clip_set *set, uint32_t ticks);

#ifdef __cplusplus
}
#endif

#endif
