/* check_materials.c: the checker of materials. */
#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"

#include <stddef.h>
#include <string.h>

/* Colours are sRGB, everything else is data. */
static noh_result check_texture_of(const noh_check *check, uint32_t texture, int is_data, uint64_t where)
{
    const noh_pack *pack = check->pack;
    const noh_texture_header *h = noh_pack_chunk_at(pack, NOH_CHUNK_TEXTURE, texture);
    if (texture == NOH_NONE) {
        return NOH_OK;
    }
    if (!h) {
        return noh_check_fail(check, "material names a missing texture", where);
    }
    return (h->flags & NOH_TEXTURE_LINEAR) == (is_data ? NOH_TEXTURE_LINEAR : 0u)
               ? NOH_OK
               : noh_check_fail(check, "material uses a colour texture for data, or a data texture for colours", where);
}

/* The first two are of colours; the sixth and seventh, too, in a toon. */
static noh_result check_material_textures(const noh_check *check, const noh_material *m, uint64_t at)
{
    static const uint8_t fields[8] = {
        offsetof(noh_material, base_color_texture), offsetof(noh_material, emissive_texture),
        offsetof(noh_material, normal_texture),     offsetof(noh_material, surface_texture),
        offsetof(noh_material, wrinkle_texture),    offsetof(noh_material, more_textures),
        offsetof(noh_material, more_textures) + 4u, offsetof(noh_material, more_textures) + 8u,
    };
    const uint32_t colors = m->surface == NOH_SURFACE_TOON ? 0x63u : 3u;
    noh_result result = NOH_OK;
    for (uint32_t i = 0; !result && i < sizeof fields; i++) {
        uint32_t texture;
        memcpy(&texture, (const uint8_t *)m + fields[i], sizeof texture);
        result = check_texture_of(check, texture, !(colors >> i & 1u), at + fields[i]);
    }
    return result;
}

/* A mask of codes is read texel by texel. */
static noh_result check_wrinkle_codes(const noh_check *check, const noh_material *m, uint64_t at)
{
    const noh_texture_header *h;
    const uint64_t where = at + offsetof(noh_material, more_textures);
    if (!(m->flags & NOH_MATERIAL_WRINKLE_CODES)) return NOH_OK;
    if (m->more_textures[0] == NOH_NONE || m->more_textures[1] != NOH_NONE || m->more_textures[2] != NOH_NONE) {
        return noh_check_fail(check, "material flags use a mask of wrinkle regions, but the material has none",
                              at + offsetof(noh_material, flags));
    }
    h = noh_pack_chunk_at(check->pack, NOH_CHUNK_TEXTURE, m->more_textures[0]);
    return h->nearest && h->format == NOH_TEXTURE_RGBA8
               ? NOH_OK
               : noh_check_fail(check, "mask of wrinkle regions is filtered or compressed", where);
}

#define SPECULAR (NOH_MATERIAL_SPECULAR_WEIGHT | NOH_MATERIAL_SPECULAR_ROUGHNESS)
uint32_t noh_material_maps(const noh_material *m)
{
    const int is_toon = m->surface == NOH_SURFACE_TOON;
    const int maps = (m->normal_texture != NOH_NONE) + (m->surface_texture != NOH_NONE) +
                     (m->emissive[0] > 0.0f || m->emissive[1] > 0.0f || m->emissive[2] > 0.0f) +
                     (m->wrinkle_texture != NOH_NONE) + ((m->flags & SPECULAR) != 0) +
                     ((m->flags & NOH_MATERIAL_WRINKLE_CODES) != 0) + ((m->flags & NOH_MATERIAL_TOON_SHADE) != 0) +
                     ((m->flags & NOH_MATERIAL_TOON_MASKS) != 0) +
                     (is_toon && m->more_textures[NOH_TOON_MATCAP] != NOH_NONE);
    return (uint32_t)maps;
}

static noh_result check_specular(const noh_check *check, const noh_material *m, uint64_t at)
{
    const uint32_t kind = m->flags & SPECULAR;
    const uint64_t where = at + offsetof(noh_material, specular_texture);
    if (!(m->f90_loss >= 0.0f && m->f90_loss <= 1.0f)) {
        return noh_check_fail(check, "what a material reflects at grazing angles is not within 0 to 1",
                              at + offsetof(noh_material, f90_loss));
    }
    if (kind == SPECULAR || (!kind && m->specular_texture) || (kind && m->specular_texture == NOH_NONE)) {
        return noh_check_fail(check, "material has a specular map without a use of its alpha, or one without the other",
                              where);
    }
    if (noh_material_maps(m) > NOH_MATERIAL_MAPS_MAX) {
        return noh_check_fail(check, "material has more maps than a pixel may read", at);
    }
    return kind ? check_texture_of(check, m->specular_texture, 0, where) : NOH_OK;
}

static noh_result check_toon(const noh_check *check, const noh_material *m, uint64_t at)
{
    const float *more = m->surface_more;
    const uint64_t where = at + offsetof(noh_material, surface_more);
    if (m->surface != NOH_SURFACE_TOON) {
        return m->flags & (NOH_MATERIAL_TOON_SHADE | NOH_MATERIAL_OUTLINE_LIT | NOH_MATERIAL_TOON_MASKS)
                   ? noh_check_fail(check, "material has flags of a toon, but another surface", at)
                   : NOH_OK;
    }
    if (!(more[0] >= 0.0f && more[0] <= 1.0f)) {
        return noh_check_fail(check, "the hardness of a toon surface's edge is not within 0 to 1", where);
    }
    for (int i = 1; i < 6; i += 4) {
        if (!(more[i] >= 0.0f && more[i] < 16777216.0f)) {
            return noh_check_fail(check, "the colour of a toon's rim or outline is not within 0 to 16777215", where);
        }
    }
    if (m->wrinkle_texture != NOH_NONE) {
        return noh_check_fail(check, "a toon has a wrinkle map", at + offsetof(noh_material, wrinkle_texture));
    }
    return more[2] >= 0.0f ? NOH_OK : noh_check_fail(check, "the power of a toon's rim is below 0", where);
}

static noh_result check_material(const noh_check *check, const noh_material *m, uint64_t at)
{
    noh_result result = noh_check_name(check, m->name, m->name_hash, at);
    if (!result) result = noh_check_floats(check, m->base_color, 15, "material value is not finite");
    if (!result) result = noh_check_floats(check, m->surface_values, 4, "material value is not finite");
    if (!result) result = noh_check_floats(check, m->surface_more, 6, "material value is not finite");
    if (!result) result = check_material_textures(check, m, at);
    if (!result && m->flags & ~2047u) {
        result = noh_check_fail(check, "unknown material flags", at + offsetof(noh_material, flags));
    }
    if (!result) result = check_wrinkle_codes(check, m, at);
    if (!result) result = check_specular(check, m, at);
    if (!result && m->surface > NOH_SURFACE_HAIR) {
        result = noh_check_fail(check, "material is of an unknown surface", at + offsetof(noh_material, surface));
    }
    if (!result && (m->priority < -128 || m->priority > 127)) {
        result = noh_check_fail(check, "priority of a material is not in -128..127",
                                at + offsetof(noh_material, priority));
    }
    if (!result && (m->wrinkle_models > 7u || !m->wrinkle_models != (m->wrinkle_texture == NOH_NONE))) {
        result = noh_check_fail(check, "material has unknown models of wrinkles, or models without a wrinkle map",
                                at + offsetof(noh_material, wrinkle_models));
    }
    if (!result && m->surface == NOH_SURFACE_SKIN && m->surface_values[0] < 0.0f) {
        result = noh_check_fail(check, "skin has less than 0 millimetres in a unit",
                                at + offsetof(noh_material, surface_values));
    }
    if (!result && (m->surface == NOH_SURFACE_SKIN || m->surface == NOH_SURFACE_TEETH) && m->surface_more[3] < 0.0f) {
        result = noh_check_fail(check, "the gap of lips is below 0", at + offsetof(noh_material, surface_more));
    }
    return result ? result : check_toon(check, m, at);
}

noh_result noh_check_materials(noh_check *check)
{
    const noh_material *m = (const noh_material *)(const void *)check->bytes;
    uint32_t count = check->count / (uint32_t)sizeof *m;
    noh_result result = NOH_OK;
    if (check->count % sizeof *m || count > NOH_MATERIALS_MAX) {
        return noh_check_fail(check, "material chunk is not a whole number of materials, or over the limit", 0);
    }
    for (uint32_t i = 0; !result && i < count; i++) {
        result = check_material(check, &m[i], (uint64_t)i * sizeof *m);
    }
    check->opens->materials = m;
    check->opens->material_count = count;
    return result;
}
