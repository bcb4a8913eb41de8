/* time_lod_points.h: the error of lower update rates, measured on points of a mesh.
 *
 * noh_time_lod_measure bounds the error of every point within a joint's radius: safe, but on a body three to seven
 * times the error of its vertices. noh_time_lod_points_measure measures chosen vertices exactly, and no others.
 *
 * Threads: as time_lod.h. */
#ifndef NOH_CHARACTER_TIME_LOD_POINTS_H
#define NOH_CHARACTER_TIME_LOD_POINTS_H

#include "stage/character/time_lod.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One joint's influence on a point. */
typedef struct noh_time_hold {
    uint32_t joint;
    float weight;   /* 0: unused */
    float place[3]; /* position in the joint's space: inverse bind matrix times vertex */
} noh_time_hold;

typedef struct noh_time_lod_points {
    const noh_time_hold *holds; /* [point_count][holds_per_point]; the weights of a point sum to 1 */
    uint32_t point_count, holds_per_point;
} noh_time_lod_points;

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
