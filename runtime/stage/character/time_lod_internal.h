/* time_lod_internal.h: the private part of low_stage.h. */
#ifndef NOH_CHARACTER_TIME_LOD_INTERNAL_H
#define NOH_CHARACTER_TIME_LOD_INTERNAL_H

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_stage.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Compute the errors of a playing controller: the largest of its blended tracks plus the weighted sum of its additive
 * ones. A track's error grows with the square of a playback speed above 1, as interpolation error does for a clip that
 * is smooth over an update period. A clip that ends by itself was measured as stopping; played ping-pong its velocity
 * reverses instead, so its error counts twice.
 * shapes  clip_error_m[clip_count of the set][NOH_UPDATE_RATE_COUNT], error_m[NOH_UPDATE_RATE_COUNT] */
void noh_time_lod_error(const noh_controller *c, const float *clip_error_m, float *error_m);

/* Call after changing tracks: an update is then due. */
void noh_time_lod_wake(noh_time_lod *t);

NOH_STATIC_ASSERT(sizeof(noh_time_lod) == 48, time_lod);

/* Ticks between updates; 0 for NOH_UPDATE_RATE_FULL. */
uint32_t noh_update_period(noh_update_rate rate);

void noh_time_lod_init(noh_time_lod *t, uint32_t instance);

/* Call once for each frame with the instance in view. If frames are at least as long as the update period, every frame
 * is posed exactly, or with behind_ticks every step.
 * units   clock: the game's */
void noh_time_lod_frame(noh_time_lod *t, int64_t clock, noh_update_rate rate);

noh_due noh_time_lod_due(const noh_time_lod *t);

/* Ticks since the update was due; 0 if none is due. */
uint32_t noh_time_lod_late(const noh_time_lod *t);

/* The work of an update, in two steps:
 *   1. if keep is below 1: replace the other pose by the blend of both at this fraction, the pose shown now
 *   2. pose the instance as of pose_clock into `pose`; the other pose is then the source */
typedef struct noh_time_update {
    int64_t pose_clock; /* the game's clock in this frame, or later */
    float keep;
    uint8_t pose; /* 0 or 1: the target from now on */
} noh_time_update;

/* Begin an update; allowed in any frame, due or not. */
noh_time_update noh_time_lod_update(noh_time_lod *t);

/* The blend of this frame: 0 the source, 1 the target (to_pose). */
float noh_time_lod_fraction(const noh_time_lod *t);

/* ---- errors ---- */

#ifdef __cplusplus
}
#endif

#endif
