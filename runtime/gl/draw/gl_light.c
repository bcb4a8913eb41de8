#include "core/base/assert_internal.h"
#include "gl/device/gl_api_internal.h"
#include "gl/draw/gl_light_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/light.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"

#include <string.h>

#include "gl/device/gl_state_internal.h"
#include "gl/light/sh_internal.h"
#include "gl/device/gl_debug_internal.h"
#include "gl/light/light_internal.h"
#include "gl/device/gl_memory_internal.h"

/* ---- uniforms ---- */

void noh_lighting_make(const noh_light *light, const float rotation[9], int key, noh_lighting *out)
{
    static const float identity[9] = { 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f };
    const float *r = rotation ? rotation : identity;
    noh_light turned, rest;
    float rgb[3];
    NOH_ASSERT(light && out && light->order >= 2u);
    memset(out, 0, sizeof *out);
    noh_light_rotate(light, r, &turned);
    noh_light_key(&turned, out->key_direction, rgb, &rest);
    out->rest = key ? rest : turned;
    if (key) memcpy(out->key, rgb, sizeof rgb);
    for (uint32_t i = 0; i < 9u; i++) out->turn[i] = r[i % 3u * 3u + i / 3u];
    out->exposure = 1.0f;
}

void noh_lighting_shadow(noh_lighting *lighting, const float view_projection[16], float radius, uint32_t shadow_px)
{
    NOH_ASSERT(lighting && view_projection && radius > 0.0f && shadow_px);
    memcpy(lighting->shadow, view_projection, sizeof lighting->shadow);
    lighting->shadow_texel = 2.0f * radius / (float)shadow_px;
}

/* Of the spherical harmonics, as factors of the polynomials 1, y, z, x, xy, yz, 3z^2-1, zx, x^2-y^2. */
static const float polynomial[9] = { 0.282094792f, 0.488602512f, 0.488602512f, 0.488602512f, 1.09254843f,
                                     1.09254843f,  0.315391565f, 1.09254843f,  0.546274215f };

/* A toon takes one colour, in the fourth column: the mean light and the key, also where no key was split off. */
static void pack_toon(const noh_lighting *l, float rows[NOH_LIGHTING_ROWS][4])
{
    noh_light rest = l->rest;
    float key[3], direction[3];
    memcpy(key, l->key, sizeof key);
    if (rest.order >= 2u && key[0] + key[1] + key[2] <= 0.0f) noh_light_key(&l->rest, direction, key, &rest);
    for (uint32_t c = 0; c < 3u; c++) {
        rows[3u + c][3] = rest.coefs[0][c] * polynomial[0] * noh_sh_cosine_lobe[0] + key[c];
    }
}

/* Spherical harmonics become the light that a matte surface reflects. */
void noh_lighting_pack(const noh_lighting *lighting, uint32_t shadow_px, float rows[NOH_LIGHTING_ROWS][4])
{
    const noh_lighting *l = lighting;
    NOH_ASSERT(l && rows);
    memset(rows, 0, NOH_LIGHTING_ROWS * sizeof *rows);
    for (uint32_t i = 0; i < 9u && i < NOH_SH_COUNT(l->rest.order); i++) {
        const uint32_t band = i > 3u ? 2u : i > 0u;
        for (uint32_t c = 0; c < 3u; c++) rows[i][c] = l->rest.coefs[i][c] * polynomial[i] * noh_sh_cosine_lobe[band];
    }
    pack_toon(l, rows);
    rows[1][3] = l->has_floor ? NOH_SOFT_DEEPEST : 1.0f;
    if (shadow_px) rows[0][3] = noh_gl_soft_hardness(0.5f * l->shadow_texel * (float)shadow_px, shadow_px);
    for (uint32_t i = 0; i < 9u; i++) rows[9u + i / 3u][i % 3u] = l->turn[i];
    memcpy(rows[12], l->key, sizeof l->key);
    rows[12][3] = l->key_gloss;
    rows[13][0] = l->exposure;
    rows[13][1] = (float)l->tonemap;
    rows[13][2] = shadow_px ? l->shadow_texel : 0.0f;
    rows[13][3] = shadow_px ? 0.75f / (float)shadow_px : 0.0f;
    rows[2][3] = (float)shadow_px;
    /* From the world to the map's coordinates and depth, 0 to 1. */
    for (uint32_t i = 0; i < 16u; i++) rows[14u + i / 4u][i % 4u] = 0.5f * l->shadow[i] + (i > 11u ? 0.5f : 0.0f);
}

void noh_lighting_pack_rest(const noh_lighting *lighting, float rows[NOH_SH_COUNT_MAX][4])
{
    NOH_ASSERT(lighting && rows);
    const noh_light *rest = &lighting->rest;
    memset(rows, 0, NOH_SH_COUNT_MAX * sizeof *rows);
    for (uint32_t l = 0, i = 0; l < rest->order; l++) {
        for (; i < NOH_SH_COUNT(l + 1u); i++) {
            const uint32_t middle = l * (l + 1u), m = i < middle ? middle - i : i - middle;
            for (uint32_t c = 0; c < 3u; c++) rows[i][c] = rest->coefs[i][c] * noh_sh_normalisation(l, m);
        }
    }
}

/* ---- textures ---- */

static noh_gl_texture_desc cube_desc(const noh_gl_light_desc *d)
{
    const uint32_t side = d->reflection ? d->reflection->side : 0;
    const noh_gl_texture_desc cube = { GL_RGB9_E5, side, side, NOH_GL_CUBE, NOH_REFLECTION_LEVELS, GL_LINEAR, 0 };
    return cube;
}

static noh_gl_texture_desc depth_desc(const noh_gl_light_desc *d, int is_soft)
{
    const uint32_t side = d->shadow_px ? d->shadow_px : 1u; /* a sampler needs a texture */
    const noh_gl_texture_desc depth = { GL_DEPTH_COMPONENT16, side, side, 0, 1, is_soft ? GL_NEAREST : GL_LINEAR, 0 };
    return depth;
}

uint64_t noh_gl_light_bytes(const noh_gl_light_desc *desc, int is_soft)
{
    NOH_ASSERT(desc);
    const noh_gl_texture_desc cube = cube_desc(desc), depth = depth_desc(desc, is_soft);
    const uint64_t soft = is_soft && desc->shadow_px ? noh_gl_soft_bytes(desc->shadow_px) : 0;
    return noh_gl_texture_bytes(&cube) + noh_gl_texture_bytes(&depth) + soft;
}

noh_result noh_gl_light_upload(const noh_gl_light *light, noh_error *error)
{
    const noh_gl_light *l = light;
    const noh_reflection *r = l->desc.reflection;
    noh_gl_pixels kept;
    NOH_ASSERT(l->gl && r && l->cube.name);
    l->gl->BindTexture(GL_TEXTURE_CUBE_MAP, l->cube.name);
    noh_gl_unpack_begin(l->gl, &kept);
    for (uint32_t i = 0; i < 6u * NOH_REFLECTION_LEVELS; i++) {
        const uint32_t level = i / 6u, face = i % 6u, n = r->side >> level;
        l->gl->TexSubImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, (GLint)level, 0, 0, (GLsizei)n, (GLsizei)n, GL_RGB,
                             GL_UNSIGNED_INT_5_9_9_9_REV,
                             r->texels + noh_reflection_first(r->side, level) + (size_t)face * n * n);
    }
    noh_gl_unpack_end(l->gl, &kept);
    l->gl->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
    return noh_gl_error_check(l->gl, "the driver refused the texels of a reflection", l->cube.bytes, error);
}

static noh_result create_cube(noh_gl_light *l, noh_error *error)
{
    const noh_gl_texture_desc desc = cube_desc(&l->desc);
    const noh_result result = noh_gl_texture_create(l->gl, l->ledger, &desc, &l->cube, error);
    if (result != NOH_OK) {
        return result;
    }
    l->gl->BindTexture(GL_TEXTURE_CUBE_MAP, l->cube.name);
    noh_gl_label(l->gl, GL_TEXTURE, l->cube.name, "reflection", NULL);
    return noh_gl_light_upload(l, error);
}

static noh_result create_shadow(noh_gl_light *l, noh_error *error)
{
    const noh_gl_texture_desc desc = depth_desc(&l->desc, l->is_soft);
    const GLenum none = GL_NONE;
    int kept[2];
    noh_result result = noh_gl_texture_create(l->gl, l->ledger, &desc, &l->depth, error);
    if (!result && l->desc.shadow_px) result = noh_gl_framebuffer_create(l->gl, l->ledger, &l->framebuffer, error);
    if (result) return result;
    l->gl->BindTexture(GL_TEXTURE_2D, l->depth.name);
    noh_gl_label(l->gl, GL_TEXTURE, l->depth.name, "shadow map", NULL);
    if (!l->is_soft) {
        l->gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
        l->gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    }
    l->gl->BindTexture(GL_TEXTURE_2D, 0);
    if (l->desc.shadow_px) {
        noh_gl_framebuffers_keep(l->gl, kept);
        l->gl->BindFramebuffer(GL_FRAMEBUFFER, l->framebuffer);
        l->gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, l->depth.name, 0);
        l->gl->DrawBuffers(1, &none);
        if (l->gl->CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
            result = noh_fail(error, NOH_ERR_GL, "the driver cannot draw to the shadow map", 0, 0);
        }
        noh_gl_framebuffers_put_back(l->gl, kept);
    }
    return result == NOH_OK ? noh_gl_error_check(l->gl, "the driver refused a shadow map", l->depth.bytes, error)
                            : result;
}

static noh_result create_objects(noh_gl_light *l, char *log, size_t log_bytes, noh_error *error)
{
    noh_result result = create_cube(l, error);
    if (result == NOH_OK) result = create_shadow(l, error);
    if (result == NOH_OK && l->is_soft && l->desc.shadow_px) result = noh_gl_soft_create(l, log, log_bytes, error);
    if (result != NOH_OK) noh_gl_light_delete(l);
    return result;
}

noh_result noh_gl_light_create(const noh_gl_device *device, const noh_gl_light_desc *desc, noh_gl_light *out,
                               noh_error *error)
{
    NOH_ASSERT(device && device->api && device->ledger && desc && out);
    if (!desc->reflection) {
        return noh_fail(error, NOH_ERR_ARG, "light desc: reflection is NULL", 0, 0);
    }
    memset(out, 0, sizeof *out);
    out->gl = device->api;
    out->ledger = device->ledger;
    out->desc = *desc;
    out->is_soft = noh_gl_has_soft_shadows(device->caps);
    return create_objects(out, device->log, device->log_bytes, error);
}

void noh_gl_light_delete(noh_gl_light *light)
{
    NOH_ASSERT(light && light->gl && light->ledger);
    noh_gl_framebuffer_delete(light->gl, light->ledger, &light->framebuffer);
    noh_gl_texture_delete(light->gl, light->ledger, &light->cube);
    noh_gl_texture_delete(light->gl, light->ledger, &light->depth);
    noh_gl_soft_delete(light);
}

void noh_gl_light_forget(noh_gl_light *light)
{
    const noh_gl_api *gl;
    NOH_ASSERT(light && light->gl);
    gl = light->gl;
    light->gl = noh_gl_lost_api();
    noh_gl_light_delete(light);
    light->gl = gl;
}

noh_result noh_gl_light_restore(noh_gl_light *light, noh_error *error)
{
    noh_gl_light_forget(light);
    return create_objects(light, NULL, 0, error);
}

/* ---- the shadow map ---- */

void noh_gl_light_bind_shadow(const noh_gl_light *light)
{
    noh_gl_offscreen *kept = (noh_gl_offscreen *)(uintptr_t)&light->kept; /* of a light that is drawn with */
    noh_gl_offscreen_begin(light->gl, kept);
    light->gl->BindFramebuffer(GL_FRAMEBUFFER, light->framebuffer);
    light->gl->Viewport(0, 0, (GLsizei)light->desc.shadow_px, (GLsizei)light->desc.shadow_px);
    light->gl->DepthFunc(GL_LEQUAL);
}

void noh_gl_light_begin_shadow(const noh_gl_light *light)
{
    static const float far_away = 1.0f;
    NOH_ASSERT(light && light->framebuffer);
    noh_gl_group_begin(light->gl, "noh shadow map", NULL);
    noh_gl_light_bind_shadow(light);
    light->gl->ClearBufferfv(GL_DEPTH, 0, &far_away);
}

void noh_gl_light_end_shadow(const noh_gl_light *light, const float view_projection[16], const noh_lighting *lighting)
{
    NOH_ASSERT(light && light->framebuffer && view_projection);
    if (light->is_soft) noh_gl_soft_blur(light, view_projection, lighting);
    noh_gl_offscreen_end(light->gl, &light->kept);
    noh_gl_group_end(light->gl);
}
