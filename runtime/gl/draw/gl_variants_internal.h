/* gl_variants_internal.h: the private part of low_gl.h. */
#ifndef NOH_GL_GL_VARIANTS_INTERNAL_H
#define NOH_GL_GL_VARIANTS_INTERNAL_H

#include "noh/low_gl.h"
#include "noh/noh_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Features of a material; a variant has no cost for others. */
#define NOH_FEATURE_NORMAL_MAP 1u
#define NOH_FEATURE_SURFACE_MAP 2u /* occlusion, roughness, metallic */
#define NOH_FEATURE_EMISSIVE 4u
#define NOH_FEATURE_SKIN 8u
#define NOH_FEATURE_EYE 16u
#define NOH_FEATURE_WRINKLES 32u /* a wrinkle normal map and its three weight maps, read by vertices */
#define NOH_FEATURE_TEETH 64u
#define NOH_FEATURE_TOON 128u
#define NOH_FEATURE_WRINKLE_PIXEL 256u /* with wrinkles: pixels read a mask of regions instead of the weight maps */
#define NOH_FEATURE_SPECULAR_MAP 512u
#define NOH_FEATURE_SPECULAR_ROUGHNESS 1024u /* with a specular map: its alpha is roughness */

/* The key that draws the same triangles with the same depth, to the bit, without colour.
 * cut  1: for alpha-cut materials */
noh_gl_variant_key noh_gl_variant_key_depth(noh_gl_variant_key key, int cut);

#define NOH_GL_DEFINES_BYTES 768u

/* Write the key as lines of #define, zero-terminated. */
void noh_gl_variant_defines(noh_gl_variant_key key, char text[NOH_GL_DEFINES_BYTES]);

#ifdef __cplusplus
}
#endif

#endif
