/* reflection.h: reflections of an environment by surfaces of any roughness: a cube map with a level for each roughness.
 *
 *   noh_reflection_size       bytes of the texels; noh_reflection_scratch_size: bytes of init's scratch
 *   noh_reflection_init       sample a radiance and blur it
 *   noh_reflection_texel      one texel; noh_reflection_direction: its direction
 *   noh_reflection_of_environment  a radiance function for an environment
 *
 * Level 0 is a mirror; level k of 0 to 4 is blurred as by a surface of roughness k / 4 at normal incidence: by the GGX
 * distribution with alpha = roughness^2, weighted by the cosine. The GPU's trilinear filter blends between levels.
 *
 * A texel is 32 bits with a shared exponent (GL_RGB9_E5), which OpenGL ES 3.0 can filter; its largest component has an
 * error of at most 1 / 512. Levels are consecutive, each with its faces in GL's order (+x -x +y -y +z -z) and rows as
 * GL reads them.
 *
 * source   Karis: Real shading in Unreal Engine 4, SIGGRAPH 2013 (the split sum); Walter et al.: Microfacet models for
 *          refraction through rough surfaces, EGSR 2007 (GGX)
 * Threads: no state; any thread. */
#ifndef NOH_LIGHT_REFLECTION_H
#define NOH_LIGHT_REFLECTION_H

#include <stddef.h>

#include "core/base/result.h"
#include "gl/light/environment.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_REFLECTION_LEVELS 5u

typedef struct noh_reflection {
    uint32_t side;          /* texels of a face of level 0 */
    const uint32_t *texels; /* [noh_reflection_size(side) / 4] */
} noh_reflection;

/* The radiance from a direction, linear RGB, not below 0.
 * shapes  direction is unit */
typedef void (*noh_radiance)(const void *user, const float direction[3], float rgb[3]);

typedef struct noh_reflection_desc {
    uint32_t side; /* power of 2, 16..NOH_REFLECTION_SIDE_MAX; default (0) 64: 130,944 bytes */
    noh_radiance radiance;
    const void *user;
} noh_reflection_desc;

/* A noh_radiance for an environment; user is a const noh_environment *. */
void noh_reflection_of_environment(const void *user, const float direction[3], float rgb[3]);

/* Bytes of the texels, and of the scratch of init; 0 if side is out of range. */
size_t noh_reflection_size(uint32_t side);
size_t noh_reflection_scratch_size(uint32_t side);

/* Sample a radiance and blur it. Level 0 takes 16 samples per texel; the other levels are sums over its texels, or over
 * reduced ones for wide blurs. Errors are at most 2 % of the brightest texel from an exact blur, 0.5 % on average, for
 * the built-in environments.
 * memory   [bytes] for the texels; must stay as long as the reflection
 * scratch  [scratch_bytes] free again afterwards
 * errors   ARG side, no radiance, or memory or scratch is NULL or misaligned; MEMORY one of them is too small (need:
 *          its bytes) */
noh_result noh_reflection_init(void *memory, size_t bytes, void *scratch, size_t scratch_bytes,
                               const noh_reflection_desc *desc, noh_reflection *out, noh_error *error);

/* Decode a texel.
 * ranges  level below NOH_REFLECTION_LEVELS, face 0..5, x and y below side >> level */
void noh_reflection_texel(const noh_reflection *reflection, uint32_t level, uint32_t face, uint32_t x, uint32_t y,
                          float rgb[3]);
/* The unit vector through the centre of a texel of a face of side x side texels. */
void noh_reflection_direction(uint32_t side, uint32_t face, uint32_t x, uint32_t y, float direction[3]);
/* The number of texels in all levels before this one. */
uint32_t noh_reflection_first(uint32_t side, uint32_t level);

#ifdef __cplusplus
}
#endif

#endif
