/* pick_cutout.c: visibility of a surface by its alpha, from the pack's own texels. */
#include "deform/pick/pick_internal.h"

#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"

#define CLEAR (0.5f / 255.0f) /* a lower alpha is written as 0 */
#define FAR_AWAY 1e6f         /* larger texture coordinates have no useful fraction */

static int32_t below(float x)
{
    const int32_t whole = (int32_t)x;
    return (float)whole > x ? whole - 1 : whole;
}

/* Fold a texture coordinate into 0..1. */
static float folded(float u, uint32_t wrap)
{
    if (!(u > -FAR_AWAY && u < FAR_AWAY)) return 0.0f;
    if (wrap == NOH_WRAP_CLAMP) return u < 0.0f ? 0.0f : u > 1.0f ? 1.0f : u;
    if (wrap == NOH_WRAP_MIRROR) {
        const float half = 0.5f * u - (float)below(0.5f * u);
        return half < 0.5f ? 2.0f * half : 2.0f - 2.0f * half;
    }
    return u - (float)below(u);
}

/* Wrap a texel of -1..size, where the first and last are over an edge. */
static uint32_t wrapped(int32_t texel, uint32_t size, uint32_t wrap)
{
    if (texel < 0) return wrap == NOH_WRAP_REPEAT ? size - 1u : 0;
    if ((uint32_t)texel >= size) return wrap == NOH_WRAP_REPEAT ? 0 : size - 1u;
    return (uint32_t)texel;
}

static float alpha_of(const noh_texture *texture, const noh_texture_level *level, uint32_t x, uint32_t y)
{
    uint16_t values[16];
    if (texture->header->format == NOH_TEXTURE_RGBA8) {
        return (float)level->pixels[((size_t)y * level->width + x) * 4u + 3u] / 255.0f;
    }
    if (texture->header->format == NOH_TEXTURE_ETC2_RGB || texture->header->format == NOH_TEXTURE_EAC_RG ||
        texture->header->format >= NOH_TEXTURE_ASTC_4X4) {
        return 1.0f;
    }
    const uint8_t *block = level->pixels + ((size_t)(y / 4u) * ((level->width + 3u) / 4u) + x / 4u) *
                                               noh_texture_block_bytes(texture->header->format);
    if (texture->header->format == NOH_TEXTURE_ETC2_RGBA1) {
        uint8_t texels[16][4];
        noh_etc2_decode(NOH_TEXTURE_ETC2_RGBA1, block, 1, texels[0]);
        return texels[y % 4u * 4u + x % 4u][3] ? 1.0f : 0.0f;
    }
    noh_eac_decode(block, 0, values);
    return (float)values[y % 4u * 4u + x % 4u] / 255.0f;
}

/* Filtered bilinearly between the four nearest texels, as drawn under magnification. */
static float alpha_at(const noh_texture *texture, const float uv[2])
{
    const noh_texture_header *h = texture->header;
    const noh_texture_level level = noh_texture_level_at(texture, 0);
    const float nudge = h->nearest ? 0.0f : 0.5f;
    const float x = folded(uv[0], h->wrap_s) * (float)level.width - nudge;
    const float y = folded(uv[1], h->wrap_t) * (float)level.height - nudge;
    const int32_t left = below(x), top = below(y);
    const float right = h->nearest ? 0.0f : x - (float)left, down = h->nearest ? 0.0f : y - (float)top;
    float rows[2];
    for (int32_t i = 0; i < 2; i++) {
        const uint32_t row = wrapped(top + i, level.height, h->wrap_t);
        const float a = alpha_of(texture, &level, wrapped(left, level.width, h->wrap_s), row);
        const float b = alpha_of(texture, &level, wrapped(left + 1, level.width, h->wrap_s), row);
        rows[i] = a + right * (b - a);
    }
    return rows[0] + down * (rows[1] - rows[0]);
}

int noh_pick_shows(const noh_mesh *mesh, const noh_submesh *submesh, const uint32_t vertices[3], const float mix[3],
                   uint8_t tint_alpha)
{
    const noh_material *m = submesh->material == NOH_NONE ? NULL : &mesh->pack->materials[submesh->material];
    float uv[2] = { 0.0f, 0.0f }, color = 0.0f, alpha;
    noh_texture texture;
    if (!m || !(m->flags & (NOH_MATERIAL_MASK | NOH_MATERIAL_BLEND))) return 1;
    for (int c = 0; c < 3; c++) {
        noh_vertex v;
        noh_mesh_vertex(mesh, vertices[c], &v);
        uv[0] += mix[c] * v.uv[0];
        uv[1] += mix[c] * v.uv[1];
        color += mix[c] * v.color[3];
    }
    alpha = m->base_color[3] * color;
    if (!noh_pack_texture_at(mesh->pack, m->base_color_texture, &texture, NULL)) alpha *= alpha_at(&texture, uv);
    if (m->flags & NOH_MATERIAL_MASK && alpha < m->alpha_cutoff) return 0;
    return !(m->flags & NOH_MATERIAL_BLEND) || alpha * ((float)tint_alpha / 255.0f) >= CLEAR;
}
