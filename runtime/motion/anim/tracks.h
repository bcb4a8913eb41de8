/* tracks.h: one track of a controller: which clip plays, where in it, how fast, at what weight (Granberg 2009, chapter
 * 5: position, speed and weight of a track; here the position is in integer ticks and cannot drift).
 *
 * Plain state without pointers. Change it through controller.h, which updates what depends on it.
 *
 * Threads: a track belongs to the thread of its controller. */
#ifndef NOH_ANIM_TRACKS_H
#define NOH_ANIM_TRACKS_H

#include "motion/anim/events.h"
#include "core/base/limits.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What a track costs. Granberg stops far characters altogether; TIME_ONLY still fires their callback keys. */
typedef enum noh_track_mode {
    NOH_TRACK_OFF = 0,   /* does not play */
    NOH_TRACK_TIME_ONLY, /* plays and fires events, but is not in the pose */
    NOH_TRACK_ON
} noh_track_mode;

/* The blend group, the priority of D3DX: the low tracks are blended, the high tracks are blended, and the high result
 * is laid over the low one by the controller's priority blend. (Granberg 2009, chapter 5, takes priority for a distance
 * to the camera; that is `lod_levels`.) */
typedef enum noh_track_group { NOH_GROUP_LOW = 0, NOH_GROUP_HIGH } noh_track_group;

#define NOH_TRACK_SILENT 1u          /* starts at weight 0, to be faded in */
#define NOH_TRACK_PAUSED 2u          /* starts at speed 0 */
#define NOH_TRACK_ADDITIVE 4u        /* its difference from a reference pose is added after the blend */
#define NOH_TRACK_REFERENCE_START 8u /* that reference is the clip's own pose at tick 0, not the bind pose */
#define NOH_TRACK_TURNS 16u          /* of a noh_track alone: plays ping-pong a clip that by itself does not */
#define NOH_TRACK_RISES 32u          /* likewise: it hides a part of what the other tracks leave of the bind pose */
#define NOH_TRACK_FLAGS (NOH_TRACK_SILENT | NOH_TRACK_PAUSED | NOH_TRACK_ADDITIVE | NOH_TRACK_REFERENCE_START)

/* How a track starts. All zeros play clip 0 from its start. */
typedef struct noh_track_desc {
    uint32_t clip;          /* the clip's index in the set; default 0 */
    int64_t position_ticks; /* default 0; unwrapped, see time.h; |position| <= 2^44 */
    int32_t speed;          /* 1/65,536; default (0) 65536; |speed| <= NOH_SPEED_MAX, negative plays backwards */
    float weight;           /* default (0) 1; 0..NOH_WEIGHT_MAX */
    noh_loop loop;          /* default NOH_LOOP_OF_CLIP: the clip's own */
    noh_track_mode mode;    /* default (NOH_TRACK_OFF) NOH_TRACK_ON: a track cannot start off */
    noh_track_group group;  /* default NOH_GROUP_LOW */
    uint32_t mask;          /* default 0: none; else 1 + index in the set's masks */
    uint32_t lod_levels; /* sampled while the controller's LOD level is below this; default (0) always; at most 255 */
    uint32_t sync_group; /* default 0: none; 1..NOH_SYNC_GROUPS_MAX; needs NOH_LOOP_REPEAT and a duration of
                            NOH_SYNC_DURATION_MIN..MAX */
    uint32_t flags;      /* NOH_TRACK_* */
    uint32_t
        reference; /* ADDITIVE: 1 + index of the clip whose first frame is the reference pose, so that a clip of one
                          * pose adds its difference from it; default (0) as the flags say */
} noh_track_desc;

/* 48 bytes. */
typedef struct noh_track {
    int64_t position;      /* 1/65,536 ticks, unwrapped */
    int64_t root_position; /* root motion has been returned up to here */
    int64_t speed_now;     /* playback speed at present, 1/65,536: its own, that of a change, or its sync group's */
    int32_t speed;         /* its own */
    float weight;
    uint16_t clip;
    uint8_t mask; /* 1 + index, 0: none */
    uint8_t loop, mode, group, sync_group, lod_levels, flags;
    uint8_t placed;     /* 1: it has not moved since it was started or sought */
    uint16_t reference; /* ADDITIVE: 1 + index of the clip whose first frame is the reference; 0: as its flags say */
    float
        full; /* how far a track of the low group hides the bind pose (noh_track_cover), -1..NOH_WEIGHT_MAX. 0: wholly,
                 * at any weight, as it starts. Above 0: wholly at this weight, and in proportion below it, so that a
                 * track that plays alone can be faded in or out. Below 0: by -full, at any weight. May be set */
} noh_track;

NOH_STATIC_ASSERT(sizeof(noh_track) == 48, track);

/* Fill a track from a desc.
 * errors  ARG names the field; the track is then untouched */
noh_result noh_track_start(noh_track *track, const noh_clip_set *set, const noh_track_desc *desc, noh_error *error);

/* Move a track to a position without firing callbacks; keys that lie exactly there fire when play moves on. */
void noh_track_place(noh_track *track, const noh_clip_entry *clip, int64_t position);

/* What it will pass in the next `ticks`: see events.h. */
noh_passage noh_track_passage(const noh_track *track, const noh_clip_entry *clip, int64_t ticks);

/* Ticks until the next key is passed, 1..ticks; 0: none is within `ticks`. */
int64_t noh_track_next_event(const noh_track *track, const noh_clip_set *set, int64_t ticks);

/* Whether a ONCE track has reached its end in the direction of play. */
int noh_track_ended(const noh_track *track, const noh_clip_entry *clip);

/* How far a track of the low group hides the bind pose, 0..1. Of several tracks the one that hides the most counts,
 * joint by joint, and what it leaves those with NOH_TRACK_RISES hide; what their weights sum to does not matter. */
float noh_track_cover(const noh_track *track);

/* The clip tick to sample, `ago` ticks before now at the present speed. */
uint32_t noh_track_clip_tick(const noh_track *track, const noh_clip_entry *clip, int64_t ago);

#ifdef __cplusplus
}
#endif

#endif
