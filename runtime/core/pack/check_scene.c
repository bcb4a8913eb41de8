/* check_scene.c: the checkers of textures, materials and nodes. */
#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"

#include <stddef.h>

/* Levels of a whole chain, down to 1 x 1. */
static uint32_t chain_of(const noh_texture_header *h)
{
    uint32_t longer = h->width > h->height ? h->width : h->height, count = 1;
    while (longer >>= 1) count++;
    return count;
}

static uint64_t level_bytes(const noh_texture_header *h)
{
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < h->level_count; i++) {
        const uint32_t width = h->width >> i, height = h->height >> i;
        bytes += noh_texture_bytes(h->format, width ? width : 1u, height ? height : 1u);
    }
    return bytes;
}

static noh_result check_texture_format(const noh_check *check, const noh_texture_header *h)
{
    const noh_check_field format[] = {
        { offsetof(noh_texture_header, format), h->format > NOH_TEXTURE_ETC2_RGBA1 },
        { offsetof(noh_texture_header, format),
          h->format == NOH_TEXTURE_EAC_RG && (!(h->flags & NOH_TEXTURE_LINEAR) || h->nearest) },
    };
    const noh_check_field error = { offsetof(noh_texture_header, error), !(h->error >= 0.0f && h->error <= 65025.0f) };
    noh_result result = noh_check_fields(check, format, 2, "unknown texture format, or not one for such a texture", 0);
    if (!result) result = noh_check_fields(check, &error, 1, "texture's error is not from 0 to 65025", 0);
    return result;
}

/* What was taken out was there. */
static noh_result check_texture_trim(const noh_check *check, const noh_texture_header *h)
{
    const noh_check_field whole[] = {
        { offsetof(noh_texture_header, whole_width),
          h->trim ? h->whole_width < h->width || h->whole_width > NOH_TEXTURE_SIZE_MAX : h->whole_width != 0 },
        { offsetof(noh_texture_header, whole_height),
          h->trim ? h->whole_height < h->height || h->whole_height > NOH_TEXTURE_SIZE_MAX : h->whole_height != 0 },
    };
    return noh_check_fields(check, whole, 2, "a texture's sides do not fit what was trimmed of it", 0);
}

static noh_result check_texture_fields(const noh_check *check, const noh_texture_header *h)
{
    const noh_check_field size[] = {
        { offsetof(noh_texture_header, width), !h->width || h->width > NOH_TEXTURE_SIZE_MAX },
        { offsetof(noh_texture_header, height), !h->height || h->height > NOH_TEXTURE_SIZE_MAX },
    };
    const noh_check_field sampling[] = {
        { offsetof(noh_texture_header, wrap_s), h->wrap_s > NOH_WRAP_MIRROR },
        { offsetof(noh_texture_header, wrap_t), h->wrap_t > NOH_WRAP_MIRROR },
        { offsetof(noh_texture_header, nearest), h->nearest > 1 },
        { offsetof(noh_texture_header, flags), (h->flags & ~NOH_TEXTURE_LINEAR) != 0 },
    };
    const noh_check_field levels = { offsetof(noh_texture_header, level_count),
                                     h->level_count != (h->nearest ? 1u : chain_of(h)) };
    noh_result result = noh_check_fields(check, size, 2, "texture size is zero or over the limit", 0);
    if (!result) result = noh_check_fields(check, sampling, 4, "unknown texture sampling", 0);
    if (!result) result = noh_check_fields(check, &levels, 1, "texture has another number of mip levels", 0);
    if (!result) result = check_texture_trim(check, h);
    return result ? result : check_texture_format(check, h);
}

noh_result noh_check_texture(noh_check *check)
{
    const noh_texture_header *h = (const noh_texture_header *)(const void *)check->bytes;
    noh_result result = noh_check_head(check, sizeof *h);
    if (result) {
        return result;
    }
    result = check_texture_fields(check, h);
    if (!result) {
        result = noh_check_array(check, offsetof(noh_texture_header, pixels_offset), level_bytes(h), 1);
    }
    return result ? result : noh_check_end(check);
}

/* Colours are sRGB, everything else is data. */
static noh_result check_texture_of(const noh_check *check, uint32_t texture, int is_data, uint64_t where)
{
    const noh_pack *pack = check->pack;
    const noh_pack_chunk *chunk;
    uint32_t flags;
    if (texture == NOH_NONE) {
        return NOH_OK;
    }
    if (texture >= pack->texture_count) {
        return noh_check_fail(check, "material names a texture that is not there", where);
    }
    chunk = &pack->chunks[pack->first_texture + texture];
    flags = ((const noh_texture_header *)(const void *)(pack->bytes + chunk->offset))->flags;
    return (flags & NOH_TEXTURE_LINEAR) == (is_data ? NOH_TEXTURE_LINEAR : 0u)
               ? NOH_OK
               : noh_check_fail(check, "material takes a texture of colours for data, or one of data for colours",
                                where);
}

static noh_result check_material_textures(const noh_check *check, const noh_material *m, uint64_t at)
{
    const struct {
        size_t field;
        uint32_t texture;
        int is_data;
    } textures[] = {
        { offsetof(noh_material, base_color_texture), m->base_color_texture, 0 },
        { offsetof(noh_material, emissive_texture), m->emissive_texture, 0 },
        { offsetof(noh_material, normal_texture), m->normal_texture, 1 },
        { offsetof(noh_material, surface_texture), m->surface_texture, 1 },
        { offsetof(noh_material, wrinkle_texture), m->wrinkle_texture, 1 },
        { offsetof(noh_material, wrinkle_weights), m->wrinkle_weights[0], 1 },
        { offsetof(noh_material, wrinkle_weights) + 4u, m->wrinkle_weights[1], 1 },
        { offsetof(noh_material, wrinkle_weights) + 8u, m->wrinkle_weights[2], 1 },
    };
    noh_result result = NOH_OK;
    for (size_t i = 0; !result && i < sizeof textures / sizeof textures[0]; i++) {
        result = check_texture_of(check, textures[i].texture, textures[i].is_data, at + textures[i].field);
    }
    return result;
}

/* A mask of codes is read texel by texel. */
static noh_result check_wrinkle_codes(const noh_check *check, const noh_material *m, uint64_t at)
{
    const noh_texture_header *h;
    const uint64_t where = at + offsetof(noh_material, wrinkle_weights);
    if (!(m->flags & NOH_MATERIAL_WRINKLE_CODES)) return NOH_OK;
    if (m->wrinkle_weights[0] == NOH_NONE || m->wrinkle_weights[1] != NOH_NONE || m->wrinkle_weights[2] != NOH_NONE) {
        return noh_check_fail(check, "material flags name a mask of wrinkle regions that it has not",
                              at + offsetof(noh_material, flags));
    }
    h = (const void *)(check->pack->bytes +
                       check->pack->chunks[check->pack->first_texture + m->wrinkle_weights[0]].offset);
    return h->nearest && h->format == NOH_TEXTURE_RGBA8
               ? NOH_OK
               : noh_check_fail(check, "mask of wrinkle regions is filtered or compressed", where);
}

#define SPECULAR (NOH_MATERIAL_SPECULAR_WEIGHT | NOH_MATERIAL_SPECULAR_ROUGHNESS)
static noh_result check_specular(const noh_check *check, const noh_material *m, uint64_t at)
{
    const uint32_t kind = m->flags & SPECULAR;
    const uint64_t where = at + offsetof(noh_material, specular_texture);
    const int maps = (m->normal_texture != NOH_NONE) + (m->surface_texture != NOH_NONE) +
                     (m->emissive[0] > 0.0f || m->emissive[1] > 0.0f || m->emissive[2] > 0.0f) +
                     (m->wrinkle_texture != NOH_NONE) + (kind != 0) + ((m->flags & NOH_MATERIAL_WRINKLE_CODES) != 0);
    if (!(m->f90_loss >= 0.0f && m->f90_loss <= 1.0f)) {
        return noh_check_fail(check, "what a material reflects at grazing angles is not within 0 to 1",
                              at + offsetof(noh_material, f90_loss));
    }
    if (kind == SPECULAR || (!kind && m->specular_texture) || (kind && m->specular_texture == NOH_NONE)) {
        return noh_check_fail(check, "material has a specular map without a use of its alpha, or one without the other",
                              where);
    }
    if (maps > (int)NOH_MATERIAL_MAPS_MAX) {
        return noh_check_fail(check, "material has more maps than a pixel may read", at);
    }
    return kind ? check_texture_of(check, m->specular_texture, 0, where) : NOH_OK;
}

static noh_result check_material(const noh_check *check, const noh_material *m, uint64_t at)
{
    noh_result result = noh_check_name(check, m->name, m->name_hash, at);
    if (!result) result = noh_check_floats(check, m->base_color, 15, "material value is not finite");
    if (!result) result = noh_check_floats(check, m->surface_values, 4, "material value is not finite");
    if (!result) result = noh_check_floats(check, m->surface_more, 6, "material value is not finite");
    if (!result) result = check_material_textures(check, m, at);
    if (!result && m->flags & ~255u) {
        result = noh_check_fail(check, "unknown material flags", at + offsetof(noh_material, flags));
    }
    if (!result) result = check_wrinkle_codes(check, m, at);
    if (!result) result = check_specular(check, m, at);
    if (!result && m->surface > NOH_SURFACE_TOON) {
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
    if (!result && m->surface == NOH_SURFACE_TOON && !(m->surface_more[0] >= 0.0f && m->surface_more[0] <= 1.0f)) {
        result = noh_check_fail(check, "the hardness of a toon surface's edge is not within 0 to 1",
                                at + offsetof(noh_material, surface_more));
    }
    return result;
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
    return result;
}

static uint32_t mesh_target_count(const noh_pack *pack, uint32_t mesh)
{
    const noh_pack_chunk *chunk = &pack->chunks[pack->first_mesh + mesh];
    return ((const noh_mesh_header *)(const void *)(pack->bytes + chunk->offset))->target_count;
}

/* A node comes after its parent, so nodes make trees, and one pass in stored order meets parents first. */
static noh_result check_node(const noh_check *check, const noh_nodes_header *h, const noh_node *node, uint32_t index)
{
    uint64_t at = h->nodes_offset + (uint64_t)index * sizeof *node;
    noh_result result = noh_check_name(check, node->name, node->name_hash, at);
    if (!result) {
        result = noh_check_floats(check, node->translation, 22, "node transform is not finite");
    }
    if (result) {
        return result;
    }
    if (node->parent != NOH_NONE && node->parent >= index) {
        return noh_check_fail(check, "node comes before its parent", at + offsetof(noh_node, parent));
    }
    if (node->mesh != NOH_NONE && node->mesh >= check->pack->mesh_count) {
        return noh_check_fail(check, "node names a mesh that is not there", at + offsetof(noh_node, mesh));
    }
    if (node->first_weight != NOH_NONE &&
        (node->mesh == NOH_NONE || node->first_weight > h->weight_count ||
         mesh_target_count(check->pack, node->mesh) > h->weight_count - node->first_weight)) {
        return noh_check_fail(check, "node's weights lie outside the weights", at + offsetof(noh_node, first_weight));
    }
    return node->flags ? noh_check_fail(check, "unknown node flags", at + offsetof(noh_node, flags)) : NOH_OK;
}

noh_result noh_check_nodes(noh_check *check)
{
    const noh_nodes_header *h = (const noh_nodes_header *)(const void *)check->bytes;
    noh_result result = noh_check_head(check, sizeof *h);
    if (result) {
        return result;
    }
    if (h->node_count > NOH_NODES_MAX) {
        return noh_check_fail(check, "node count is over the limit", offsetof(noh_nodes_header, node_count));
    }
    result = noh_check_array(check, offsetof(noh_nodes_header, nodes_offset), h->node_count, sizeof(noh_node));
    if (!result) result = noh_check_array(check, offsetof(noh_nodes_header, weights_offset), h->weight_count, 4);
    if (!result) result = noh_check_end(check);
    for (uint32_t i = 0; !result && i < h->node_count; i++) {
        result = check_node(check, h, (const noh_node *)(const void *)(check->bytes + h->nodes_offset) + i, i);
    }
    if (!result) {
        result = noh_check_floats(check, (const float *)(const void *)(check->bytes + h->weights_offset),
                                  h->weight_count, "node weight is not finite");
    }
    return result;
}
