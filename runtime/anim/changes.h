/* changes.h: changes over a time, asked for ahead: speed, weight, position, mode, priority blend.
 *
 * A fixed table of 32-byte records inside a controller. All of it is exact in
 * ticks: what a change does at a tick does not depend on how time is cut in steps.
 *   WEIGHT, PRIORITY   follow the curve at every tick
 *   SPEED              follows it in NOH_CHANGE_SLICES equal slices of constant speed,
 *                      each at the curve's middle value, so that the way travelled is
 *                      that of the curve
 *   POSITION           travels along the curve in the same slices and arrives exactly;
 *                      it is play and fires events. With duration 0 it jumps and fires none
 *   MODE               switches when it is due; its duration must be 0 */
#ifndef NOH_ANIM_CHANGES_H
#define NOH_ANIM_CHANGES_H

#include "anim/tracks.h"

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

typedef enum noh_curve {
    NOH_CURVE_LINEAR = 0,
    NOH_CURVE_SMOOTHSTEP
} noh_curve;

typedef struct noh_change_desc {
    noh_change_kind kind;
    uint32_t track;          /* not used by PRIORITY */
    uint32_t delay_ticks;    /* from now; default 0 */
    uint32_t duration_ticks; /* default 0: at once */
    noh_curve curve;         /* default linear */
    int32_t speed;           /* SPEED: to reach, 1/65,536; |speed| <= NOH_SPEED_MAX */
    float weight;            /* WEIGHT: to reach, 0..NOH_WEIGHT_MAX; PRIORITY: 0..1 */
    int64_t position_ticks;  /* POSITION: to reach, unwrapped; |position| <= 2^44 */
    noh_track_mode mode;     /* MODE */
} noh_change_desc;

/* 32 bytes. */
typedef struct noh_change {
    int64_t start;     /* tick of the controller's clock */
    int64_t from, to;  /* speed, position, mode, or the bits of a float */
    uint32_t duration;
    uint8_t state;     /* NOH_CHANGE_FREE .. */
    uint8_t kind, track;
    uint8_t curve;     /* noh_curve, or NOH_CURVE_JUMP */
} noh_change;

#define NOH_CURVE_JUMP 2u /* a seek that fires what it passes: linear, one tick long, not root motion */

#define NOH_CHANGE_FREE 0u
#define NOH_CHANGE_WAITING 1u
#define NOH_CHANGE_RUNNING 2u

NOH_STATIC_ASSERT(sizeof(noh_change) == 32, change);

/* What the table works on. */
typedef struct noh_change_target {
    const noh_anim_set *set;
    noh_track *tracks;
    float *priority_blend;
    int64_t clock;
    int sync_touched; /* out: something that a sync group depends on has changed */
} noh_change_target;

/* The value of a curve at t, which is held in 0..1. */
float noh_curve_at(noh_curve curve, float t);

/* Check a desc and put it in the table; begins it if it is due now. A change of
 * the same kind and track that waits for the same tick is replaced.
 * errors  ARG names the field (POSITION of a synchronised track is refused: its
 *         group moves it); LIMIT the table is full (need: entries) */
noh_result noh_changes_add(noh_change *table, uint32_t count, noh_change_target *target, uint32_t track_count,
                           const noh_change_desc *desc, noh_error *error);

/* Travel to a position within the next tick, firing what is passed: a seek. */
noh_result noh_changes_jump(noh_change *table, uint32_t count, noh_change_target *target, uint32_t track, int64_t position, noh_error *error);

/* End a running change of this kind and track where it stands. */
void noh_changes_cancel(noh_change *table, uint32_t count, noh_change_kind kind, uint32_t track);

/* Drop all changes of a track, waiting ones too. */
void noh_changes_drop(noh_change *table, uint32_t count, uint32_t track);

/* Bring weights and the priority blend to target->clock, end what is over, begin what is due. */
void noh_changes_update(noh_change *table, uint32_t count, noh_change_target *target);

/* Set the rates of the tracks for the ticks from target->clock on, and say up to
 * which tick, at most `end`, they hold. Synchronised tracks are left to their group. */
int64_t noh_changes_rates(const noh_change *table, uint32_t count, const noh_change_target *target, uint32_t track_count, int64_t end);

#ifdef __cplusplus
}
#endif

#endif
