/* tracks.h: one track of a controller: which motion plays, where, how fast, how heavy (row C5.1).
 *
 * Plain state without pointers. Change it through controller.h, which knows what
 * else has to follow. */
#ifndef NOH_ANIM_TRACKS_H
#define NOH_ANIM_TRACKS_H

#include "anim/events.h"
#include "base/limits.h"

/* Three levels of cost (row C5.3). */
typedef enum noh_track_mode {
    NOH_TRACK_OFF = 0,   /* stands still */
    NOH_TRACK_TIME_ONLY, /* plays and fires events, is not in the pose */
    NOH_TRACK_ON
} noh_track_mode;

/* The blend group, as in D3DX (row C5.2): all low tracks are blended, all high
 * tracks are blended, then the high result is laid over the low one by the
 * controller's priority blend. What distance costs is `lod_levels`, apart from it. */
typedef enum noh_track_group {
    NOH_GROUP_LOW = 0,
    NOH_GROUP_HIGH
} noh_track_group;

#define NOH_TRACK_SILENT 1u          /* starts at weight 0, to be faded in */
#define NOH_TRACK_PAUSED 2u          /* starts at speed 0 */
#define NOH_TRACK_ADDITIVE 4u        /* its difference from a reference pose is added after the blend */
#define NOH_TRACK_REFERENCE_START 8u /* that reference is the motion's own pose at tick 0, not the bind pose */
#define NOH_TRACK_FLAGS (NOH_TRACK_SILENT | NOH_TRACK_PAUSED | NOH_TRACK_ADDITIVE | NOH_TRACK_REFERENCE_START)

/* How a track starts. Zero everywhere plays motion 0 from its start, alone. */
typedef struct noh_track_desc {
    uint32_t motion;        /* index in the set; default 0 */
    int64_t position_ticks; /* default 0; unwrapped, see time.h; |position| <= 2^44 */
    int32_t speed;          /* 1/65,536; default (0) 65536; |speed| <= NOH_SPEED_MAX, negative plays backwards */
    float weight;           /* default (0) 1; 0..NOH_WEIGHT_MAX */
    noh_loop loop;          /* default NOH_LOOP_OF_MOTION */
    noh_track_mode mode;    /* default (NOH_TRACK_OFF) NOH_TRACK_ON: what is started is on */
    noh_track_group group;  /* default NOH_GROUP_LOW */
    uint32_t mask;          /* default 0: none; else 1 + index in the set's masks */
    uint32_t lod_levels;    /* sampled while the controller's lod is below this; default (0) always; at most 255 */
    uint32_t sync_group;    /* default 0: none; 1..NOH_SYNC_GROUPS_MAX; needs NOH_LOOP_REPEAT and a duration of NOH_SYNC_DURATION_MIN..MAX */
    uint32_t flags;         /* NOH_TRACK_* */
} noh_track_desc;

/* 48 bytes. */
typedef struct noh_track {
    int64_t position;      /* 1/65,536 ticks, unwrapped */
    int64_t root_position; /* up to where root motion has been handed out */
    int64_t rate;          /* what it moves per tick just now: speed, a change of it, a glide or the sync group's */
    int32_t speed;
    float weight;
    uint16_t motion;
    uint8_t mask;          /* 1 + index, 0: none */
    uint8_t loop, mode, group, sync_group, lod_levels, flags;
    uint8_t placed;        /* has not moved since it was started or sought */
    uint8_t reserved[6];
} noh_track;

NOH_STATIC_ASSERT(sizeof(noh_track) == 48, track);

/* Fill a track from a desc.
 * errors  ARG names the field; the track is then untouched */
noh_result noh_track_start(noh_track *track, const noh_anim_set *set, const noh_track_desc *desc, noh_error *error);

/* Put a track at a position; nothing fires on the way, what lies exactly there
 * fires when play moves on. */
void noh_track_place(noh_track *track, const noh_motion *motion, int64_t position);

/* What the track passes in the next `ticks`. */
noh_passage noh_track_passage(const noh_track *track, const noh_motion *motion, int64_t ticks);

/* After how many ticks, 1..ticks, the next key is passed; 0: none is. */
int64_t noh_track_next_event(const noh_track *track, const noh_anim_set *set, int64_t ticks);

/* Whether a ONCE track has come to its end in the direction in which it plays. */
int noh_track_ended(const noh_track *track, const noh_motion *motion);

/* The clip tick to sample, `ago` ticks before now at the present rate. */
uint32_t noh_track_clip_tick(const noh_track *track, const noh_motion *motion, int64_t ago);

#endif
