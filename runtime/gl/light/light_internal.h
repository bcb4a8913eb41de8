/* light_internal.h: parts of environments, light and reflections. */
#ifndef NOH_LIGHT_LIGHT_INTERNAL_H
#define NOH_LIGHT_LIGHT_INTERNAL_H

#include "noh/light.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The radiance from a direction.
 * ranges  direction is unit */
void noh_environment_radiance(const noh_environment *environment, const float direction[3], float rgb[3]);

/* Rotate light.
 * ranges  rotation as in noh_sh_rotate; to is not from */
void noh_light_rotate(const noh_light *from, const float rotation[9], noh_light *to);

/* The light reflected by a white matte surface, without shadows: convolution with the clamped cosine at the light's
 * order. May be below 0 opposite a sharp lamp, by a few per cent of it.
 * ranges  normal is unit */
void noh_light_irradiance(const noh_light *light, const float normal[3], float rgb[3]);

/* Split light into a directional key light, which can cast shadows, and the smallest possible rest. Key and rest add up
 * to the light in every coefficient.
 * direction  unit, towards the key light, the main direction of luminance
 * rgb        key light reflected by a white matte surface facing it; zeros if light has no direction
 * rest       must not be light
 * ranges     light's order at least 2
 * source     Sloan: Stupid spherical harmonics (SH) tricks, GDC 2008, Extracting conventional lights from SH */
void noh_light_key(const noh_light *light, float direction[3], float rgb[3], noh_light *rest);

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
