/* controller.h: one instance's animation: tracks, changes over time, callback keys (rows C4.3, C4.4, C5.1-C5.6).
 *
 * A controller is one block of bytes without a pointer in it: cloning an instance,
 * saving and restoring it is one memcpy of noh_controller_bytes(c) bytes. What
 * instances share, the set, is handed to every call; poses go to buffers of the
 * caller's, so that no instance writes what another reads (row C4.4).
 *
 * What happens at which tick does not depend on how time is cut into steps:
 *   - noh_controller_step(c, ..., t) moves time on by t ticks, from event to event;
 *   - keys are delivered in the order (tick at which they are passed, track, along
 *     the play, index), each exactly once (events.h has the definition). The tick
 *     of an event is the first by whose end the key has been passed;
 *   - the callback may change the controller. While it runs the controller stands
 *     at the event's tick, and the change holds from there on, within the same step:
 *     a track started by an event at tick n is at its start position at n, and its own
 *     keys fire from n + 1 on. Keys of other tracks that were passed by the same tick
 *     n are delivered all the same, with the weights that they had at n. It may call
 *     everything but noh_controller_step (which then does nothing);
 *   - weights compared with a key's weight_min are those at the tick of the event,
 *     changes over time and changes due at that tick included. */
#ifndef NOH_ANIM_CONTROLLER_H
#define NOH_ANIM_CONTROLLER_H

#include "anim/changes.h"
#include "base/limits.h"

#define NOH_CONTROLLER_INERTIAL 1u /* room for a pose of offsets: 48 bytes per joint, 8 per float (inertial.h) */
#define NOH_CONTROLLER_EVENTS_CUT 2u /* set by a step that came to NOH_STEP_EVENTS_MAX keys and handed out no more */

/* Its bytes: 80, 48 per track, 32 per change; with room for inertia 48 per joint and 8
 * per float. With the default table that is at most 64 per joint and 64 per track for
 * any skeleton with 9 joints more than tracks. */
typedef struct noh_controller_desc {
    const noh_anim_set *set; /* checked with noh_anim_set_check; required */
    uint32_t track_count;    /* default (0) 4; at most NOH_TRACKS_MAX */
    uint32_t change_count;   /* changes that wait or run at one time; default (0) track_count + 2; at most NOH_CHANGES_MAX */
    uint32_t flags;          /* NOH_CONTROLLER_INERTIAL */
} noh_controller_desc;

/* The head of the block; tables follow at byte offsets from it. Read what you like. */
typedef struct noh_controller {
    int64_t clock;              /* ticks since init */
    int64_t inertia_start;      /* tick at which the offsets began to decay */
    uint32_t inertia_ticks;     /* how long they do; 0: there are none */
    uint32_t bytes;             /* of the whole block */
    uint32_t motion_count, joint_count, float_count, mask_count; /* of the set it was made for */
    uint32_t track_count, change_count;
    uint32_t tracks_offset, changes_offset, inertia_offset, inertia_floats_offset; /* inertia: 0 without room for it */
    float priority_blend;       /* 0..1: how much of the high group covers the low one; starts at 1 */
    uint32_t lod_joint_count;   /* joints that are sampled; the others keep the bind pose */
    uint32_t events_high_water; /* the most that one step has delivered */
    uint16_t changes_high_water;
    uint8_t lod;                /* tracks with lod_levels of 1..lod are not sampled */
    uint8_t flags;              /* NOH_CONTROLLER_*, and two of its own */
} noh_controller;

/* A callback key that play has passed. */
typedef struct noh_event {
    const noh_event_key *key; /* in the set */
    int64_t clock;            /* tick of the controller's clock */
    int64_t position_tick;    /* unwrapped tick of the track at which the key lies */
    uint32_t track, motion;
    uint32_t index;           /* of the key in its motion */
    float weight;             /* of the track at that tick */
    int backward;             /* 1: passed while playing backwards */
} noh_event;

typedef void (*noh_event_fn)(void *user, const noh_event *event);

/* ---- memory ---- */

/* Exact bytes; 0 for an impossible desc. */
size_t noh_controller_size(const noh_controller_desc *desc);

/* Make a controller in memory[bytes], 16-byte aligned; all tracks off, clock 0.
 * errors  ARG names the field; MEMORY need: the bytes */
noh_result noh_controller_init(void *memory, size_t bytes, const noh_controller_desc *desc, noh_controller **controller, noh_error *error);

/* What to copy to clone or save it. The copy must be 16-byte aligned too. */
size_t noh_controller_bytes(const noh_controller *c);

/* Check a block that comes from outside, as out of a saved game, before anything else is done with it: one that passes
 * cannot make a call overrun, overflow or hang. The offsets of inertia are not looked at; a pose may then be nonsense.
 * errors  ARG memory NULL or not 16-byte aligned; DATA not a controller for this set (where: the track or change) */
noh_result noh_controller_check(const void *memory, size_t bytes, const noh_anim_set *set, noh_error *error);

/* ---- tracks ---- */

noh_track *noh_controller_tracks(noh_controller *c);             /* [track_count] */
const noh_track *noh_controller_track(const noh_controller *c, uint32_t track);

/* Start a motion on a track, dropping what was there and its changes. A track that
 * joins a sync group is placed on the group's phase.
 * errors  ARG names the field; the track then stays as it was */
noh_result noh_controller_start(noh_controller *c, const noh_anim_set *set, uint32_t track, const noh_track_desc *desc, noh_error *error);

typedef enum noh_seek {
    NOH_SEEK_SKIP = 0, /* nothing that is jumped over fires; what lies at the target fires when play moves on */
    NOH_SEEK_FIRE      /* travels there within the next tick, in the direction of the target, and fires what it passes */
} noh_seek;

/* Send a track to a tick of the pass (ping-pong: the cycle of two legs) that it is in;
 * ticks below 0 and past the duration lie in the passes before and after. Its sync
 * group goes along.
 * errors  ARG track, position or policy; FIRE on a synchronised track; LIMIT FIRE
 *         needs a free change */
noh_result noh_controller_seek(noh_controller *c, const noh_anim_set *set, uint32_t track, int64_t tick, noh_seek policy, noh_error *error);

/* At once; each ends a running change of the same kind. ARG: out of range, see noh_track_desc. */
noh_result noh_controller_set_speed(noh_controller *c, uint32_t track, int32_t speed);
noh_result noh_controller_set_weight(noh_controller *c, uint32_t track, float weight);
noh_result noh_controller_set_mode(noh_controller *c, uint32_t track, noh_track_mode mode);
noh_result noh_controller_set_priority_blend(noh_controller *c, float blend);

/* Detail: joints 0..joint_count-1 are sampled (0: all), tracks by their lod_levels. */
noh_result noh_controller_set_lod(noh_controller *c, uint32_t lod, uint32_t joint_count);

/* ---- time ---- */

/* Ask for a change over time. ARG names the field; LIMIT the table is full. */
noh_result noh_controller_change(noh_controller *c, const noh_anim_set *set, const noh_change_desc *desc, noh_error *error);

/* Fade one track out to 0, then off, and another in to `weight`, over the same time.
 * Takes three changes.
 * errors  as noh_controller_change; nothing is changed then */
noh_result noh_controller_cross_fade(noh_controller *c, const noh_anim_set *set, uint32_t from, uint32_t to, float weight,
                                     uint32_t duration_ticks, noh_curve curve, noh_error *error);

/* Move time on. fn may be NULL. Returns how many events were delivered.
 * A step looks at NOH_STEP_EVENTS_MAX keys at most. Keys after that are passed without being delivered, and
 * NOH_CONTROLLER_EVENTS_CUT is set in c->flags until the next step; noh_controller_events_max tells beforehand.
 * ranges  ticks 0..2^32-1; 0 does nothing. The clock stops at INT64_MAX */
uint32_t noh_controller_step(noh_controller *c, const noh_anim_set *set, uint32_t ticks, noh_event_fn fn, void *user);

/* The most that a step of so many ticks can deliver as the controller stands, its
 * changes included, if its callback starts or moves nothing: NOH_STEP_EVENTS_MAX at most. */
uint32_t noh_controller_events_max(const noh_controller *c, const noh_anim_set *set, uint32_t ticks);

#endif
