/* wrinkles.h: wrinkle weights of the twelve regions of a face, from its morph weights.
 *
 *   noh_wrinkles_of       the matrix of a mesh
 *   noh_wrinkles_weights  region weights from morph weights
 *   noh_wrinkles_area     a triangle's weight from its change of area
 *   noh_wrinkles_normal   a normal with wrinkles, blended as in shaders_es/common_wrinkle.glsl
 *
 * source   "character wrinkle" (region weights from expressions, for which it gives no formula)
 * Threads: constant data; any thread. */
#ifndef NOH_MESH_WRINKLES_H
#define NOH_MESH_WRINKLES_H

#include "core/mesh/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A view: valid as long as the pack and its bytes are. */
typedef struct noh_wrinkles {
    uint32_t target_count;
    const uint8_t *matrix; /* [target_count][NOH_WRINKLE_REGIONS], 255: all at weight 1 */
} noh_wrinkles;

/* Get the wrinkles of a mesh; the same at every LOD level.
 * errors  NOT_FOUND the mesh has no wrinkles: its pack was built without --wrinkles and --region-mask; *wrinkles is
 *         untouched */
noh_result noh_wrinkles_of(const noh_mesh *mesh, noh_wrinkles *wrinkles, noh_error *error);

/* Compute region weights from morph weights: the sum of weight times matrix, clamped to 0..1. Channel c of the
 * material's weight map k is region 3 * c + k.
 * shapes  weights[target_count]; regions[NOH_WRINKLE_REGIONS]
 * ranges  weights finite; those below 0 count as 0 */
void noh_wrinkles_weights(const noh_wrinkles *wrinkles, const float *weights, float *regions);

/* The wrinkle weight of a triangle by its area, as in the SparseMorphTargets sample: 0.3 at rest, more when it shrinks,
 * slightly less when it grows, within 0..1. Areas are in bind space: after targets, before joints. A triangle with no
 * area at rest keeps its rest weight. */
float noh_wrinkles_area(float area_at_rest, float area);

/* Blend a wrinkle normal onto a base normal, with the wrinkle's slopes times weight.
 * shapes  base, wrinkle, out: [3] unit, tangent space; out may be base or wrinkle
 * ranges  z of both above 0; weight 0..1
 * source  reoriented normal mapping: Barre-Brisebois, Hill, Blending in Detail, 2012 */
void noh_wrinkles_normal(const float *base, const float *wrinkle, float weight, float *out);

#ifdef __cplusplus
}
#endif
#endif
