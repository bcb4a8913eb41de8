/* time_lod_internal.h: the private part of low_stage.h. */
#ifndef NOH_CHARACTER_TIME_LOD_INTERNAL_H
#define NOH_CHARACTER_TIME_LOD_INTERNAL_H

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_stage.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_TIME_LOD_UNSEEN_TICKS 6000u /* after longer out of view an instance is posed before it is shown */

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

/* Call after changing tracks: an update is then due. */
void noh_time_lod_wake(noh_time_lod *t);

/* ---- errors ---- */

/* Bytes of working memory for measuring; 0 for a set over NOH_JOINTS_MAX or NOH_FLOATS_MAX. */
size_t noh_time_lod_measure_size(const noh_time_probe *probe);

/* Measure the largest error of a clip, played in its own loop mode, at each update rate: over periods that begin every
 * 400 ticks, every 200 ticks within each, for any point within a joint's radius, in object space (without root motion
 * if the set extracts it). For converters and load time: ten seconds of 31 joints take about 0.1 s.
 *
 * The result is the largest error found, not a proof for all ticks. At each measured tick it is a bound: the difference
 * of two matrices moves a point by at most its norm times the point's distance, and the norm is overestimated by up to
 * 15 % (the Schatten 8-norm).
 * shapes  error_m[NOH_UPDATE_RATE_COUNT]; 0 at the full rate
 * units   model units, taken as metres
 * errors  ARG probe, clip, or memory is NULL or not aligned to NOH_MEMORY_ALIGN; MEMORY too small (need: the exact
 *         bytes) */
noh_result noh_time_lod_measure(void *memory, size_t bytes, const noh_time_probe *probe, uint32_t clip, float *error_m,
                                noh_error *error);

/* Compute the errors of a playing controller: the largest of its blended tracks plus the weighted sum of its additive
 * ones. A track's error grows with the square of a playback speed above 1, as interpolation error does for a clip that
 * is smooth over an update period. A clip that ends by itself was measured as stopping; played ping-pong its velocity
 * reverses instead, so its error counts twice.
 * shapes  clip_error_m[clip_count of the set][NOH_UPDATE_RATE_COUNT], error_m[NOH_UPDATE_RATE_COUNT] */
void noh_time_lod_error(const noh_controller *c, const float *clip_error_m, float *error_m);

#ifdef __cplusplus
}
#endif

#endif
