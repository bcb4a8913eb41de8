/* gl_light_internal.h: the private part of noh_gl.h. */
#ifndef NOH_GL_GL_LIGHT_INTERNAL_H
#define NOH_GL_GL_LIGHT_INTERNAL_H

#include "noh/base.h"
#include "noh/noh_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Whether shadow maps are blurred variance maps (gl_shadow.c); else shaders filter depths. Lights, renderers and
 * drawables of one device agree. caps: NULL: no */
static inline int noh_gl_has_soft_shadows(const noh_gl_caps *caps)
{
    return caps && caps->render_f16;
}

/* The shadow map that shaders read. */
static inline unsigned noh_gl_light_map(const noh_gl_light *light)
{
    return light->moments.name ? light->moments.name : light->depth.name;
}

uint64_t noh_gl_light_bytes(const noh_gl_light_desc *desc, int is_soft);

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
 * seen from the light. End: blur a soft map, then restore render state, framebuffers and viewport. Only with shadow_px
 * above 0.
 * view_projection  that was drawn with
 * lighting         its floor; NULL: none */
void noh_gl_light_begin_shadow(const noh_gl_light *light);
void noh_gl_light_end_shadow(const noh_gl_light *light, const float view_projection[16], const noh_lighting *lighting);

/* Floors count as no farther from the centre of the light's view than this, in its radii, and all else as 1. */
#define NOH_SOFT_DEEPEST 6.0f

/* The soft map of a light with shadow_px above 0: gl_shadow.c. */
uint64_t noh_gl_soft_bytes(uint32_t shadow_px);
noh_result noh_gl_soft_create(noh_gl_light *light, char *log, size_t log_bytes, noh_error *error);
void noh_gl_soft_delete(noh_gl_light *light);
void noh_gl_soft_blur(const noh_gl_light *light, const float view_projection[16], const noh_lighting *lighting);
/* The distance between caster and receiver, in radii of the view, at which the blur is as wide as the lamp's penumbra. */
float noh_gl_soft_hardness(float radius, uint32_t shadow_px);

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
