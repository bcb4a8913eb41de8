/* gl_light.h: light for the plain renderer: an environment that lights and is mirrored, one key light with a shadow
 * map, exposure, a tone map.
 *
 *   noh_lighting_make       what shaders are told: the key light and the rest, out of any light
 *   noh_lighting_shadow     where a shadow map looks
 *   noh_gl_light_bytes      exact GPU bytes of the textures
 *   noh_gl_light_create     upload the reflection, make the shadow map; noh_gl_light_delete,
 *                           noh_gl_light_forget, noh_gl_light_restore
 *   noh_gl_light_upload     the reflection is another one now
 *   noh_gl_light_begin_shadow  bind and clear the shadow map; noh_gl_light_end_shadow
 *   noh_gl_renderer_light   light what the renderer draws from now on
 *
 * A renderer with noh_gl_renderer_desc.lit shades by it (shaders_es/common_light.glsl): matte light by spherical
 * harmonics of order 3, gloss from the cube by roughness with the split sum, the key light through the shadow map.
 * Occlusion dims both. A renderer without it has light of its own and needs none of this.
 *
 * Threads: the context's own thread; noh_lighting_* and noh_gl_light_bytes, any. */
#ifndef NOH_GL_GL_LIGHT_H
#define NOH_GL_GL_LIGHT_H

#include "gl/device/gl_memory.h"
#include "gl/device/gl_state.h"
#include "gl/light/reflection.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum noh_tonemap {
    NOH_TONEMAP_NONE,  /* radiance 1 is white; brighter is cut off */
    NOH_TONEMAP_FILMIC /* a curve with a shoulder: K. Narkowicz, ACES filmic tone mapping curve, 2015 */
} noh_tonemap;

/* Plain data: change what you like between draws. */
typedef struct noh_lighting {
    noh_light rest;         /* in the world, without the key light */
    float key_direction[3]; /* unit, towards it, world */
    float key[3];           /* what a white matte surface that faces it reflects; zeros: none */
    float key_gloss; /* share of it that glosses: 0 where it is in the reflection already, 1 for a lamp of yours */
    float turn[9];   /* rows: from the world into the reflection's space */
    float exposure;  /* factor before the tone map */
    noh_tonemap tonemap;
    float shadow[16];   /* world to the shadow map's clip space, column-major */
    float shadow_texel; /* length of one of its texels, world; 0: no shadow */
} noh_lighting;

/* Light from all around that stands turned by `rotation`, taken apart into a key light and the rest; no shadow,
 * exposure 1, no tone map.
 * shapes  rotation[9] 3 rows of 3, orthonormal with determinant 1; NULL: as it is
 * ranges  light's order at least 2
 * key     0: all of the light stays in `rest`, no surface is in shadow */
void noh_lighting_make(const noh_light *light, const float rotation[9], int key, noh_lighting *out);

/* Let the key light cast shadows.
 * shapes  view_projection[16]: of the view that the shadow map was drawn by, parallel (noh_view_shadow)
 * ranges  radius, of what it sees, above 0; shadow_px as in noh_gl_light_desc, not 0 */
void noh_lighting_shadow(noh_lighting *lighting, const float view_projection[16], float radius, uint32_t shadow_px);

#define NOH_LIGHTING_ROWS 18u

/* The uniform noh_lighting of common_environment.glsl: the renderer sets it; a program of your own does by this.
 * shadow_px  as in noh_gl_light_desc */
void noh_lighting_pack(const noh_lighting *lighting, uint32_t shadow_px, float rows[NOH_LIGHTING_ROWS][4]);

/* The uniform noh_rest of common_transfer.glsl, likewise: coefficients of `rest` times the factors of the spherical
 * harmonics' polynomials, 0 past its order. */
void noh_lighting_pack_rest(const noh_lighting *lighting, float rows[NOH_SH_COUNT_MAX][4]);

typedef struct noh_gl_light_desc {
    const noh_reflection *reflection; /* required; must stay, with its texels, as long as the light */
    uint32_t shadow_px;               /* side of the shadow map; 0: none */
} noh_gl_light_desc;

typedef struct noh_gl_light {
    const noh_gl_api *gl;
    noh_gl_ledger *ledger;
    noh_gl_light_desc desc;
    noh_gl_texture cube, shadow; /* GL_RGB9_E5; GL_DEPTH_COMPONENT16, compared, one texel without shadows */
    unsigned framebuffer;        /* 0 without shadows */
    noh_gl_offscreen kept;       /* what noh_gl_light_end_shadow puts back */
} noh_gl_light;

uint64_t noh_gl_light_bytes(const noh_gl_light_desc *desc);

/* errors  ARG no reflection; MEMORY, GL as noh_gl_texture_create, or the shadow map cannot be drawn to: nothing is left
 * behind */
noh_result noh_gl_light_create(const noh_gl_device *device, const noh_gl_light_desc *desc, noh_gl_light *out,
                               noh_error *error);
void noh_gl_light_delete(noh_gl_light *light);

/* The same where the context was lost (gl_lost.h): no GL is called. It may be restored later. */
void noh_gl_light_forget(noh_gl_light *light);

/* Make its GL objects again in a new context (gl_lost.h).
 * errors  MEMORY, GL as noh_gl_light_create: it then has no GL objects */
noh_result noh_gl_light_restore(noh_gl_light *light, noh_error *error);

/* Its reflection was made anew in place (noh_reflection_init in the same memory, of the same side): upload the texels.
 * errors  GL the driver refuses them */
noh_result noh_gl_light_upload(const noh_gl_light *light, noh_error *error);

/* Bind the shadow map's framebuffer, set its viewport, clear it. Draw what casts shadows, depth alone, from the light;
 * then end, which puts render state, framebuffers and viewport back. Not without shadows. */
void noh_gl_light_begin_shadow(const noh_gl_light *light);
void noh_gl_light_end_shadow(const noh_gl_light *light);

#ifdef __cplusplus
}
#endif

#endif
