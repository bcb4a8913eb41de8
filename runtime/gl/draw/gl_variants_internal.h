/* gl_variants_internal.h: the private part of low_gl.h. */
#ifndef NOH_GL_GL_VARIANTS_INTERNAL_H
#define NOH_GL_GL_VARIANTS_INTERNAL_H

#include "noh/low_gl.h"
#include "noh/noh_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

/* NOH_FEATURE_* of a material on a mesh. Normal maps need tangents; unlit materials have NOH_FEATURE_ALPHA at most. */
uint32_t noh_gl_features_of(const noh_mesh *mesh, const noh_material *material);

/* The key that draws the same triangles with the same depth, to the bit, without colour.
 * cut  1: for alpha-cut materials */
noh_gl_variant_key noh_gl_variant_key_depth(noh_gl_variant_key key, int cut);

#ifdef __cplusplus
}
#endif

#endif
