/* gl_light_internal.h: the private part of noh_gl.h. */
#ifndef NOH_GL_GL_LIGHT_INTERNAL_H
#define NOH_GL_GL_LIGHT_INTERNAL_H

#include "noh/base.h"
#include "noh/noh_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

uint64_t noh_gl_light_bytes(const noh_gl_light_desc *desc);

/* Upload the reflection and make the shadow map.
 * errors  ARG no reflection; MEMORY, GL as noh_gl_texture_create, or the shadow map cannot be drawn to. All GL objects
 *         made so far are then deleted */
noh_result noh_gl_light_create(const noh_gl_device *device, const noh_gl_light_desc *desc, noh_gl_light *out,
                               noh_error *error);
void noh_gl_light_delete(noh_gl_light *light);

/* Release the GL objects of a lost context without GL calls (gl_device.h). They may be restored later. */
void noh_gl_light_forget(noh_gl_light *light);

/* Make the GL objects again in a new context (gl_device.h).
 * errors  MEMORY, GL as noh_gl_light_create; it then has no GL objects */
noh_result noh_gl_light_restore(noh_gl_light *light, noh_error *error);

/* Begin: bind the shadow map's framebuffer, set its viewport and clear it. Then draw the depth of shadow casters as
 * seen from the light. End: restore render state, framebuffers and viewport. Only with shadow_px above 0. */
void noh_gl_light_begin_shadow(const noh_gl_light *light);
void noh_gl_light_end_shadow(const noh_gl_light *light);

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
