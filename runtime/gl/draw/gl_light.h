/* gl_light.h: light for the plain renderer: environment light and reflections, one key light with a shadow map,
 * exposure, a tone map.
 *
 *   noh_lighting_make       shader lighting from any light: the key light and the rest
 *   noh_lighting_shadow     set the view of the shadow map
 *   noh_gl_light_bytes      exact GPU bytes of the textures
 *   noh_gl_light_create     upload the reflection, make the shadow map; noh_gl_light_delete,
 *                           noh_gl_light_forget, noh_gl_light_restore
 *   noh_gl_light_upload     upload a changed reflection
 *   noh_gl_light_begin_shadow  bind and clear the shadow map; noh_gl_light_end_shadow
 *   noh_gl_renderer_light   set the light of a renderer (gl_draw.h)
 *
 * A renderer with noh_gl_renderer_desc.lit uses it (shaders_es/common_light.glsl): diffuse light by spherical harmonics
 * of order 3, specular light from the cube map by roughness with the split sum, the key light with the shadow map.
 * Occlusion dims both. A renderer without `lit` has its own light and needs none of this.
 *
 * Threads: the context's own thread; any thread for noh_lighting_* and noh_gl_light_bytes. */
#ifndef NOH_GL_GL_LIGHT_H
#define NOH_GL_GL_LIGHT_H

#include "gl/device/gl_memory.h"
#include "gl/device/gl_state.h"
#include "gl/light/reflection.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum noh_tonemap {
    NOH_TONEMAP_NONE,  /* radiance 1 is white; brighter values are clamped */
    NOH_TONEMAP_FILMIC /* a curve with a shoulder: K. Narkowicz, ACES filmic tone mapping curve, 2015 */
} noh_tonemap;

/* Lighting values. Plain data: change any field between draws. */
typedef struct noh_lighting {
    noh_light rest;         /* world space, without the key light */
    float key_direction[3]; /* unit, towards it, world */
    float key[3];           /* its light reflected by a white matte surface facing it; zeros: none */
    float key_gloss; /* its share of specular light: 0 if the reflection already contains it, 1 for your own lamp */
    float turn[9];   /* rows: world to the reflection's space */
    float exposure;  /* factor before the tone map */
    noh_tonemap tonemap;
    float shadow[16];   /* world to the shadow map's clip space, column-major */
    float shadow_texel; /* size of a shadow texel, world; 0: no shadow */
} noh_lighting;

/* Split light, rotated by `rotation`, into a key light and the rest, with no shadow, exposure 1 and no tone map.
 * shapes  rotation[9] 3 rows of 3, orthonormal with determinant 1; NULL: not rotated
 * ranges  light's order at least 2
 * key     0: all light stays in `rest`, and nothing casts shadows */
void noh_lighting_make(const noh_light *light, const float rotation[9], int key, noh_lighting *out);

/* Enable shadows of the key light.
 * shapes  view_projection[16]: the parallel view that the shadow map was drawn with (noh_view_shadow)
 * ranges  radius: of the view, above 0; shadow_px as in noh_gl_light_desc, not 0 */
void noh_lighting_shadow(noh_lighting *lighting, const float view_projection[16], float radius, uint32_t shadow_px);

#define NOH_LIGHTING_ROWS 18u

/* Get the uniform noh_lighting of common_environment.glsl, for your own programs; the renderer sets it itself.
 * shadow_px  as in noh_gl_light_desc */
void noh_lighting_pack(const noh_lighting *lighting, uint32_t shadow_px, float rows[NOH_LIGHTING_ROWS][4]);

/* Get the uniform noh_rest of common_transfer.glsl, for your own programs: coefficients of `rest` times the factors of
 * the spherical harmonics' polynomials, 0 past its order. */
void noh_lighting_pack_rest(const noh_lighting *lighting, float rows[NOH_SH_COUNT_MAX][4]);

typedef struct noh_gl_light_desc {
    const noh_reflection *reflection; /* required; must stay, with its texels, as long as the light */
    uint32_t shadow_px;               /* side of the shadow map; 0: none */
} noh_gl_light_desc;

typedef struct noh_gl_light {
    const noh_gl_api *gl;
    noh_gl_ledger *ledger;
    noh_gl_light_desc desc;
    noh_gl_texture cube, shadow; /* GL_RGB9_E5; GL_DEPTH_COMPONENT16 with comparison, one texel without shadows */
    unsigned framebuffer;        /* 0 without shadows */
    noh_gl_offscreen kept;       /* state restored by noh_gl_light_end_shadow */
} noh_gl_light;

uint64_t noh_gl_light_bytes(const noh_gl_light_desc *desc);

/* Upload the reflection and make the shadow map.
 * errors  ARG no reflection; MEMORY, GL as noh_gl_texture_create, or the shadow map cannot be drawn to. All GL objects
 *         made so far are then deleted */
noh_result noh_gl_light_create(const noh_gl_device *device, const noh_gl_light_desc *desc, noh_gl_light *out,
                               noh_error *error);
void noh_gl_light_delete(noh_gl_light *light);

/* Release the GL objects of a lost context without GL calls (gl_lost.h). They may be restored later. */
void noh_gl_light_forget(noh_gl_light *light);

/* Make the GL objects again in a new context (gl_lost.h).
 * errors  MEMORY, GL as noh_gl_light_create; it then has no GL objects */
noh_result noh_gl_light_restore(noh_gl_light *light, noh_error *error);

/* Upload the reflection's texels again, after noh_reflection_init in the same memory with the same side.
 * errors  GL the driver refused the upload */
noh_result noh_gl_light_upload(const noh_gl_light *light, noh_error *error);

/* Begin: bind the shadow map's framebuffer, set its viewport and clear it. Then draw the depth of shadow casters as
 * seen from the light. End: restore render state, framebuffers and viewport. Only with shadow_px above 0. */
void noh_gl_light_begin_shadow(const noh_gl_light *light);
void noh_gl_light_end_shadow(const noh_gl_light *light);

#ifdef __cplusplus
}
#endif

#endif
