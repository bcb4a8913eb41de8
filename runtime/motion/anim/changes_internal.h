/* changes_internal.h: the private part of clip.h. */
#ifndef NOH_ANIM_CHANGES_INTERNAL_H
#define NOH_ANIM_CHANGES_INTERNAL_H

#include "noh/base.h"
#include "noh/clip.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_change {
    int64_t start;    /* tick of the controller's clock */
    int64_t from, to; /* speed, position, mode, or the bits of a float */
    uint32_t duration;
    uint8_t state; /* NOH_CHANGE_FREE .. */
    uint8_t kind, track;
    uint8_t curve; /* noh_curve, or NOH_CURVE_JUMP */
} noh_change;

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
