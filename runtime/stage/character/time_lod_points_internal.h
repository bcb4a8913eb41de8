/* time_lod_points_internal.h: the private part of low_stage.h. */
#ifndef NOH_CHARACTER_TIME_LOD_POINTS_INTERNAL_H
#define NOH_CHARACTER_TIME_LOD_POINTS_INTERNAL_H

#include "noh/base.h"
#include "noh/low_stage.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Bytes of working memory for measuring; 0 for a set over NOH_JOINTS_MAX or NOH_FLOATS_MAX. */
size_t noh_time_lod_points_size(const noh_time_probe *probe);

/* Measure the largest error of any point at each update rate, over the periods and ticks of noh_time_lod_measure, plus
 * the movement by the probe's floats. joint_radius_m is not read. Ten seconds of 31 joints and 128 points take about
 * 0.2 s.
 * shapes  error_m[NOH_UPDATE_RATE_COUNT]; 0 at the full rate
 * units   model units, taken as metres
 * errors  ARG probe, clip, points (none, or a joint does not exist; where: the hold), or memory is NULL or not aligned
 *         to NOH_MEMORY_ALIGN; MEMORY too small (need: the exact bytes) */
noh_result noh_time_lod_points_measure(void *memory, size_t bytes, const noh_time_probe *probe,
                                       const noh_time_lod_points *points, uint32_t clip, float *error_m,
                                       noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
