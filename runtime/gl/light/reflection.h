/* reflection.h: what surfaces of any roughness mirror of the light from all around: a cube of texels with a level for
 * each roughness, for a cube map.
 *
 *   noh_reflection_size       bytes of the texels; noh_reflection_scratch_size of what only init needs
 *   noh_reflection_init       sample a radiance and blur it
 *   noh_reflection_texel      one texel; noh_reflection_direction where it looks
 *   noh_reflection_of_environment  a radiance function for an environment
 *
 * Level 0 mirrors; level k of 0 to 4 is blurred as a surface of roughness k / 4 blurs that is looked at straight on: by
 * the distribution of GGX with alpha = roughness^2, weighted by the cosine. Between levels a GPU's trilinear filter
 * mixes.
 *
 * A texel is 32 bits with a shared exponent (GL_RGB9_E5): OpenGL ES 3.0 filters it, and its largest part is off by 1 /
 * 512 at most. Levels follow each other; in each, faces in GL's order (+x -x +y -y +z -z), rows as GL reads them.
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

/* What comes from a direction, linear RGB, not below 0.
 * shapes  direction is unit */
typedef void (*noh_radiance)(const void *user, const float direction[3], float rgb[3]);

typedef struct noh_reflection_desc {
    uint32_t side; /* power of 2, 16..NOH_REFLECTION_SIDE_MAX; default (0) 64: 130,944 bytes */
    noh_radiance radiance;
    const void *user;
} noh_reflection_desc;

/* A noh_radiance: user is a const noh_environment *. */
void noh_reflection_of_environment(const void *user, const float direction[3], float rgb[3]);

/* Bytes; 0 for a side that is out of range. */
size_t noh_reflection_size(uint32_t side);
size_t noh_reflection_scratch_size(uint32_t side);

/* Level 0 takes 16 samples of each texel; the other levels are sums over its texels, blurred from coarser ones of them
 * where the blur is wide.
 * memory   [bytes] of the texels; must stay as long as the reflection
 * scratch  [scratch_bytes] yours again afterwards
 * errors   ARG side or no radiance, memory or scratch NULL or misaligned; MEMORY one of them is too small (need: its
 *          bytes). At most 2 % of the brightest texel off an exact blur, 0.5 % on average, for the built-in
 * environments
 */
noh_result noh_reflection_init(void *memory, size_t bytes, void *scratch, size_t scratch_bytes,
                               const noh_reflection_desc *desc, noh_reflection *out, noh_error *error);

/* ranges  level below NOH_REFLECTION_LEVELS, face 0..5, x and y below side >> level */
void noh_reflection_texel(const noh_reflection *reflection, uint32_t level, uint32_t face, uint32_t x, uint32_t y,
                          float rgb[3]);
/* The unit vector through the middle of a texel of a face with so many texels a side. */
void noh_reflection_direction(uint32_t side, uint32_t face, uint32_t x, uint32_t y, float direction[3]);
/* The texels of all levels before this one. */
uint32_t noh_reflection_first(uint32_t side, uint32_t level);

#ifdef __cplusplus
}
#endif

#endif
