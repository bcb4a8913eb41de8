/* tracks.h: one track of a controller: the clip it plays, position, speed and weight (Granberg 2009, chapter 5; here
 * the position is in integer ticks and cannot drift).
 *
 * Plain state without pointers. Change it through controller.h, which updates dependent state.
 *
 * Threads: a track belongs to the thread of its controller. */
#ifndef NOH_ANIM_TRACKS_H
#define NOH_ANIM_TRACKS_H

#include "motion/anim/events.h"
#include "core/base/limits.h"

#ifdef __cplusplus
extern "C" {
#endif

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
    int64_t position_ticks; /* default 0; unwrapped, see time.h; |position| <= 2^44 */
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
    /* how much a track of the low group covers the bind pose (noh_track_cover), -1..NOH_WEIGHT_MAX. 0 (default): fully,
     * at any weight. Above 0: fully at this weight and proportionally below it, so a track that plays alone can fade.
     * Below 0: by -full, at any weight. May be set */
    float full;
} noh_track;

NOH_STATIC_ASSERT(sizeof(noh_track) == 48, track);

/* Start a track from a desc.
 * errors  ARG names the field; the track is then unchanged */
noh_result noh_track_start(noh_track *track, const noh_clip_set *set, const noh_track_desc *desc, noh_error *error);

/* Move a track to a position without firing callbacks; keys exactly there fire when play moves on. */
void noh_track_place(noh_track *track, const noh_clip_entry *clip, int64_t position);

/* Get the passage of the next `ticks` (events.h). */
noh_passage noh_track_passage(const noh_track *track, const noh_clip_entry *clip, int64_t ticks);

/* Get the ticks until the next key is passed, 1..ticks; 0 if there is none within `ticks`. */
int64_t noh_track_next_event(const noh_track *track, const noh_clip_set *set, int64_t ticks);

/* Test whether a ONCE track has reached its end in the direction of play. */
int noh_track_ended(const noh_track *track, const noh_clip_entry *clip);

/* Get how much a track of the low group covers the bind pose, 0..1. For each joint the track that covers most counts;
 * tracks with NOH_TRACK_RISES cover part of the rest. The sum of the weights does not matter. */
float noh_track_cover(const noh_track *track);

/* Get the clip tick to sample, `ago` ticks before now at the present speed. */
uint32_t noh_track_clip_tick(const noh_track *track, const noh_clip_entry *clip, int64_t ago);

#ifdef __cplusplus
}
#endif

#endif
