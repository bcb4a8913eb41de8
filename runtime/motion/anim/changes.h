/* changes.h: immediate or scheduled changes of speed, weight, position, mode and priority blend.
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
#ifndef NOH_ANIM_CHANGES_H
#define NOH_ANIM_CHANGES_H

#include "motion/anim/tracks.h"

#ifdef __cplusplus
extern "C" {
#endif

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

typedef struct noh_change {
    int64_t start;    /* tick of the controller's clock */
    int64_t from, to; /* speed, position, mode, or the bits of a float */
    uint32_t duration;
    uint8_t state; /* NOH_CHANGE_FREE .. */
    uint8_t kind, track;
    uint8_t curve; /* noh_curve, or NOH_CURVE_JUMP */
} noh_change;

#define NOH_CURVE_JUMP 2u /* a seek that fires the keys it passes: linear, one tick long, no root motion */

#define NOH_CHANGE_FREE 0u
#define NOH_CHANGE_WAITING 1u
#define NOH_CHANGE_RUNNING 2u

NOH_STATIC_ASSERT(sizeof(noh_change) == 32, change);

/* The data that a table of changes updates. */
typedef struct noh_change_target {
    const noh_clip_set *set;
    noh_track *tracks;
    float *priority_blend;
    int64_t clock;
    int sync_touched; /* out: 1 if anything that affects a sync group changed */
} noh_change_target;

/* Evaluate a curve at t.
 * ranges  t is clamped to 0..1 */
float noh_curve_at(noh_curve curve, float t);

/* Add a change and begin it if it is due. It replaces a waiting change of the same kind, track and start tick.
 * errors  ARG a field of the desc, or POSITION on a synchronised track (its group moves it); LIMIT the table is full
 *         (need: entries) */
noh_result noh_changes_add(noh_change *table, uint32_t count, noh_change_target *target, uint32_t track_count,
                           const noh_change_desc *desc, noh_error *error);

/* Move to a position within the next tick and fire the keys on the way (NOH_SEEK_FIRE). */
noh_result noh_changes_jump(noh_change *table, uint32_t count, noh_change_target *target, uint32_t track,
                            int64_t position, noh_error *error);

/* End a running change of a kind on a track; the value stays as it is now. */
void noh_changes_cancel(noh_change *table, uint32_t count, noh_change_kind kind, uint32_t track);

/* Remove all changes of a track, including waiting ones. */
void noh_changes_drop(noh_change *table, uint32_t count, uint32_t track);

/* Update weights and the priority blend to target->clock, remove finished changes and begin those that are due. */
void noh_changes_update(noh_change *table, uint32_t count, noh_change_target *target);

/* Set speed_now of all tracks as of target->clock. Skips synchronised tracks, whose group sets it.
 * returns  the tick, at most `end`, until which these speeds hold */
int64_t noh_changes_speeds(const noh_change *table, uint32_t count, const noh_change_target *target,
                           uint32_t track_count, int64_t end);

#ifdef __cplusplus
}
#endif

#endif
