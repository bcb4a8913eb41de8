/* wrinkles.h: how much a face's morph weights wrinkle the twelve regions of its skin.
 *
 *   noh_wrinkles_of       the matrix of a mesh
 *   noh_wrinkles_weights  regions out of morph weights
 *   noh_wrinkles_area     one triangle's weight out of its change of area
 *   noh_wrinkles_normal   a normal with wrinkles, as shaders_es/common_wrinkle.glsl blends it
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

/* The same at every LOD level.
 * errors  NOT_FOUND  the mesh has no wrinkles: its pack was built without --wrinkles or --region-mask; *wrinkles is
 *         untouched */
noh_result noh_wrinkles_of(const noh_mesh *mesh, noh_wrinkles *wrinkles, noh_error *error);

/* Regions out of morph weights: the sum of weight times matrix, from 0 to 1. Channel c of the material's weight map k
 * is region 3 * c + k.
 * shapes  weights[target_count]; regions[NOH_WRINKLE_REGIONS]
 * ranges  weights finite; those below 0 count as 0 */
void noh_wrinkles_weights(const noh_wrinkles *wrinkles, const float *weights, float *regions);

/* The response of the SparseMorphTargets sample to a triangle's area: 0.3 at rest, more where it shrinks, hardly less
 * where it grows, within 0..1. Areas in bind space: after targets, before joints. A triangle without area at rest has
 * what it has at rest. */
float noh_wrinkles_area(float area_at_rest, float area);

/* Reoriented normal mapping (Barre-Brisebois, Hill: Blending in Detail, 2012), with the wrinkle's slopes times weight.
 * shapes  base, wrinkle, out: [3] unit, tangent space; out may be one of them
 * ranges  z of both over 0; weight 0..1 */
void noh_wrinkles_normal(const float *base, const float *wrinkle, float weight, float *out);

#ifdef __cplusplus
}
#endif
#endif
