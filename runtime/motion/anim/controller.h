/* controller.h: one instance's animation: tracks, changes over time, callback keys.
 *
 * A controller is one block of bytes without pointers: cloning an instance, saving and restoring it is one memcpy of
 * noh_controller_bytes(c) bytes. The set, which instances share, is passed to every call; poses go to the caller's
 * buffers, so no instance writes what another one reads.
 *
 * What happens at which tick does not depend on how time is cut into steps:
 *   - noh_controller_step(c, ..., t) moves time on by t ticks, from event to event;
 *   - keys are delivered in the order of (tick at which they are passed, track, direction of play, index), each exactly
 *     once (events.h has the definition). The tick of an event is the first by whose end its key has been passed;
 *   - the callback may change the controller. While it runs the controller stands at the event's tick, and the change
 *     holds from there on, within the same step: a track started by an event at tick n is at its start position at n,
 *     and its own keys fire from n + 1 on. Keys of other tracks passed by the same tick n are still delivered, with the
 *     weights that their tracks had at n. The callback may call everything but noh_controller_step (which then does
 *     nothing);
 *   - a key's weight_min is compared with the track's weight at the tick of the event, after all changes up to and at
 *     that tick.
 *
 * source  D3DX's animation controller as in C. Granberg, "Character Animation with Direct3D", Charles River Media 2009,
 *         chapters 4 and 5, with keys in ticks rather than seconds and no state shared by clones
 *
 * Threads: a controller belongs to one thread at a time; the set is only read, so any number of threads may step
 * controllers of one set, each its own. */
#ifndef NOH_ANIM_CONTROLLER_H
#define NOH_ANIM_CONTROLLER_H

#include "motion/anim/changes.h"
#include "core/base/limits.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_CONTROLLER_INERTIAL 1u   /* room for the offsets of a transition: 48 bytes per joint, 8 per float */
#define NOH_CONTROLLER_EVENTS_CUT 2u /* set by a step that reached NOH_STEP_EVENTS_MAX keys and delivered no more */
/* Weights that sum to less than 1 cover in part: those of the high group cover the pose of the low one, those of floats
 * their defaults. So a group can be faded in and out by the weights of its tracks. Without it weights are relative to
 * each other. The joints of the low group are always relative */
#define NOH_CONTROLLER_COVERS 4u

/* A controller takes 80 bytes, 48 per track and 32 per change; with room for inertia 48 more per joint and 8 per
 * float. */
typedef struct noh_controller_desc {
    const noh_clip_set *set; /* checked with noh_clip_set_check; required */
    uint32_t track_count;    /* default (0) 4; at most NOH_TRACKS_MAX */
    /* changes waiting or running at one time; default (0) track_count + 2; at most NOH_CHANGES_MAX */
    uint32_t change_count;
    uint32_t flags; /* NOH_CONTROLLER_INERTIAL, NOH_CONTROLLER_COVERS */
} noh_controller_desc;

/* The head of the block; tables follow at byte offsets from it. Reading the fields is fine; change them by calls. */
typedef struct noh_controller {
    int64_t clock;          /* ticks since init */
    int64_t inertia_start;  /* clock at which the offsets of a transition began to decay */
    uint32_t inertia_ticks; /* for how long they decay; 0: there are none */
    uint32_t bytes;         /* of the whole block */
    uint32_t clip_count, joint_count, float_count, mask_count; /* of its set */
    uint32_t track_count, change_count;
    uint32_t tracks_offset, changes_offset, inertia_offset, inertia_floats_offset; /* inertia: 0 without room for it */
    float priority_blend;       /* 0..1: how far the high group covers the low one; starts at 1 */
    uint32_t lod_joint_count;   /* joints that are sampled; the others keep the bind pose */
    uint32_t events_high_water; /* the most events that one step has delivered */
    uint16_t changes_high_water;
    uint8_t lod;   /* LOD level: tracks with lod_levels of 1..lod are not sampled */
    uint8_t flags; /* NOH_CONTROLLER_*, and two private ones */
} noh_controller;

/* A callback key that play has passed. */
typedef struct noh_event {
    const noh_event_key *key; /* in the set */
    int64_t clock;            /* of the controller, ticks */
    int64_t position_tick;    /* of the key on its track, unwrapped */
    uint32_t track, clip;
    uint32_t index; /* of the key in its clip */
    float weight;   /* of the track at that tick */
    int backward;   /* 1: passed in backward play */
} noh_event;

typedef void (*noh_event_fn)(void *user, const noh_event *event);

/* ---- memory ---- */

/* Exact bytes; 0 for an impossible desc. */
size_t noh_controller_size(const noh_controller_desc *desc);

/* Make a controller in memory[bytes]: all tracks off, clock 0.
 * errors  ARG a field of the desc, or memory NULL or misaligned; MEMORY too small; need: the exact bytes */
noh_result noh_controller_init(void *memory, size_t bytes, const noh_controller_desc *desc, noh_controller **controller,
                               noh_error *error);

/* How many bytes to copy to clone or save it. The copy must be aligned to NOH_MEMORY_ALIGN too. */
size_t noh_controller_bytes(const noh_controller *c);

/* Check a block from outside, such as a saved game, before any other call. With a block that passes, no call overruns
 * its memory, overflows or hangs; but the offsets of a transition are not checked, so a pose may still be nonsense.
 * errors  ARG memory NULL or misaligned; DATA not a controller for this set (where: the track or change) */
noh_result noh_controller_check(const void *memory, size_t bytes, const noh_clip_set *set, noh_error *error);

/* ---- tracks ---- */

noh_track *noh_controller_tracks(noh_controller *c); /* [track_count] */
const noh_track *noh_controller_track(const noh_controller *c, uint32_t track);

/* Start a clip on a track, ending what played there and its changes. A track that joins a sync group is moved to the
 * group's phase.
 * errors  ARG names the field; the track then stays as it was */
noh_result noh_controller_start(noh_controller *c, const noh_clip_set *set, uint32_t track, const noh_track_desc *desc,
                                noh_error *error);

typedef enum noh_seek {
    NOH_SEEK_SKIP = 0, /* jumps without firing callbacks; keys exactly at the target fire when play moves on */
    NOH_SEEK_FIRE /* travels to the target within the next tick, forwards or backwards, and fires the keys on the way */
} noh_seek;

/* Move a track to a tick of its present pass (of a ping-pong clip: its present cycle of two legs). Ticks below 0 and
 * past the duration lie in the passes before and after. Its sync group follows.
 * errors  ARG track, tick or policy, or FIRE on a synchronised track; LIMIT FIRE needs a free change */
noh_result noh_controller_seek(noh_controller *c, const noh_clip_set *set, uint32_t track, int64_t tick,
                               noh_seek policy, noh_error *error);

/* These take effect at once, and end a running change of the same kind.
 * errors  ARG track, or a value that is out of its range: see noh_track_desc */
noh_result noh_controller_set_speed(noh_controller *c, uint32_t track, int32_t speed);
noh_result noh_controller_set_weight(noh_controller *c, uint32_t track, float weight);
noh_result noh_controller_set_mode(noh_controller *c, uint32_t track, noh_track_mode mode);
noh_result noh_controller_set_priority_blend(noh_controller *c, float blend);

/* Choose a LOD level: sample joints 0..joint_count-1 only (0: all), and no tracks with lod_levels of 1..lod.
 * errors  ARG lod above 255, or more joints than the set has */
noh_result noh_controller_set_lod(noh_controller *c, uint32_t lod, uint32_t joint_count);

/* ---- time ---- */

/* Start a change over time, now or later (changes.h).
 * errors  ARG a field of the desc; LIMIT the table of changes is full */
noh_result noh_controller_change(noh_controller *c, const noh_clip_set *set, const noh_change_desc *desc,
                                 noh_error *error);

/* Fade one track out to 0, then switch it off, and fade another in to `weight` over the same time. Takes three changes.
 * errors  as noh_controller_change; nothing has changed then */
noh_result noh_controller_cross_fade(noh_controller *c, const noh_clip_set *set, uint32_t from, uint32_t to,
                                     float weight, uint32_t duration_ticks, noh_curve curve, noh_error *error);

/* Move time on. fn may be NULL.
 * A step looks at NOH_STEP_EVENTS_MAX keys at most. Keys after that are passed without being delivered, and
 * NOH_CONTROLLER_EVENTS_CUT is set in c->flags until the next step; noh_controller_events_max tells beforehand.
 * ranges   ticks 0..2^32-1; 0 does nothing. The clock stops at INT64_MAX
 * returns  how many events were delivered */
uint32_t noh_controller_step(noh_controller *c, const noh_clip_set *set, uint32_t ticks, noh_event_fn fn, void *user);

/* An upper bound on the events of a step, changes included, provided that the callback starts or moves nothing. At most
 * NOH_STEP_EVENTS_MAX. */
uint32_t noh_controller_events_max(const noh_controller *c, const noh_clip_set *set, uint32_t ticks);

#ifdef __cplusplus
}
#endif

#endif
