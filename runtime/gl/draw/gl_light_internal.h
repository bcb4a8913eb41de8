/* gl_light_internal.h: the private part of noh_gl.h. */
#ifndef NOH_GL_GL_LIGHT_INTERNAL_H
#define NOH_GL_GL_LIGHT_INTERNAL_H

#include "noh/base.h"
#include "noh/noh_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_LIGHTING_ROWS 18u

/* Get the uniform noh_lighting of common_environment.glsl, for your own programs; the renderer sets it itself.
 * shadow_px  as in noh_gl_light_desc */
void noh_lighting_pack(const noh_lighting *lighting, uint32_t shadow_px, float rows[NOH_LIGHTING_ROWS][4]);

/* Get the uniform noh_rest of common_transfer.glsl, for your own programs: coefficients of `rest` times the factors of
 * the spherical harmonics' polynomials, 0 past its order. */
void noh_lighting_pack_rest(const noh_lighting *lighting, float rows[NOH_SH_COUNT_MAX][4]);

#ifdef __cplusplus
}
#endif

#endif
