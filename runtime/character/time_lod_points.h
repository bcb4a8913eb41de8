/* time_lod_points.h: what posing less often than once a frame moves the points of a mesh by (row C16.4).
 *
 * noh_time_lod_measure bounds any point within reach of a joint: safe, and on a body three to seven times what its
 * vertices are off. Here some vertices are looked at, exactly, and what lies between them is not. */
#ifndef NOH_CHARACTER_TIME_LOD_POINTS_H
#define NOH_CHARACTER_TIME_LOD_POINTS_H

#include "character/time_lod.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How one joint holds a point: at a place in the joint's own space (inverse bind matrix times vertex). */
typedef struct noh_time_hold {
    uint32_t joint;
    float weight; /* 0: not at all */
    float place[3];
} noh_time_hold;

typedef struct noh_time_points {
    const noh_time_hold *holds; /* [point_count][holds_per_point], weights of each sum to 1 */
    uint32_t point_count, holds_per_point;
} noh_time_points;

/* Bytes of the working memory that measuring takes. */
size_t noh_time_points_size(const noh_time_probe *probe);

/* The largest that a point is off when a motion, played in its own loop mode, is posed at each rate: over intervals
 * that begin every 400 ticks, every 200 ticks within each; and what the probe's floats add. joint_reach_m is not read.
 * Where the probe travels, a loop goes on from where it came, as noh_time_lod_measure has it.
 * For a converter, or when a set is loaded: ten seconds of 31 joints and 128 points take about 0.2 s.
 * shapes  error_m[NOH_RATE_COUNT]; that of the full rate is 0
 * memory  16-byte aligned
 * errors  ARG probe, motion, memory; points: none, or a joint that there is not (where: the hold); MEMORY need: the bytes */
noh_result noh_time_points_measure(void *memory, size_t bytes, const noh_time_probe *probe, const noh_time_points *points, uint32_t motion,
                                   float *error_m, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
