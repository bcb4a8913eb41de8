/* blend_space.h: weights of clips placed along one or two parameters.
 *
 * 1-D: linear between two neighbours. 2-D: a Delaunay triangulation, made once with the space, and barycentric weights
 * in the triangle that contains the point: at most three clips are sampled, the weights are continuous, and at a clip's
 * own point it has full weight. A point outside uses the nearest point of the hull. (Inverse distance weighting needs
 * no triangles, but samples every clip and gives each some weight everywhere.)
 *
 * Threads: pure functions of their arguments; any thread. */
#ifndef NOH_GRAPH_BLEND_SPACE_H
#define NOH_GRAPH_BLEND_SPACE_H

#include "core/base/limits.h"
#include "core/base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_blend_space_2d {
    uint32_t point_count;     /* 1..NOH_BLEND_SPACE_POINTS_MAX */
    uint32_t triangle_count;  /* 0: one point, or all points on a line */
    const float *points;      /* [point_count][2] */
    const uint8_t *triangles; /* [triangle_count][3], counter-clockwise */
} noh_blend_space_2d;

/* Compute the weights of clips along one parameter.
 * shapes  thresholds[count] increasing, weights[count]
 * ranges  |thresholds| <= NOH_BLEND_SPACE_COORDINATE_MAX; x is clamped to the first and last threshold, NaN counts as
 *         the first */
void noh_blend_space_1d_weights(uint32_t count, const float *thresholds, float x, float *weights);

/* Triangulate the points. They are first rounded to 1/4096 of their extent, so that all geometric tests are exact in
 * integers and the result is the same on every machine.
 * shapes  points[count][2], triangles[NOH_BLEND_SPACE_TRIANGLES_MAX][3]
 * errors  ARG count; DATA (where: the point) not finite, beyond NOH_BLEND_SPACE_COORDINATE_MAX, or equal to another
 *         point */
noh_result noh_blend_space_2d_triangulate(uint32_t count, const float *points, uint8_t *triangles,
                                          uint32_t *triangle_count, noh_error *error);

/* Compute the weights of clips over two parameters.
 * shapes  weights[point_count]; the sum is 1, at most three are not zero
 * ranges  x, y are clamped to NOH_BLEND_SPACE_COORDINATE_MAX; NaN counts as 0 */
void noh_blend_space_2d_weights(const noh_blend_space_2d *space, float x, float y, float *weights);

#ifdef __cplusplus
}
#endif

#endif
