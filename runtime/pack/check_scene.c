/* check_scene.c: the checkers of textures, materials and nodes. */
#include "pack/check_internal.h"

#include <stddef.h>

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
    };
    const noh_check_field reserved[] = {
        { offsetof(noh_texture_header, reserved[0]), h->reserved[0] != 0 },
        { offsetof(noh_texture_header, reserved[1]), h->reserved[1] != 0 },
    };
    noh_result result = noh_check_fields(check, size, 2, "texture size is zero or over the limit", 0);
    if (!result) result = noh_check_fields(check, sampling, 3, "unknown texture sampling", 0);
    return result ? result : noh_check_fields(check, reserved, 2, "reserved field of a texture is not zero", 0);
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
        result = noh_check_array(check, offsetof(noh_texture_header, pixels_offset), (uint64_t)h->width * h->height, 4);
    }
    return result ? result : noh_check_end(check);
}

noh_result noh_check_materials(noh_check *check)
{
    const noh_material *m = (const noh_material *)(const void *)check->bytes;
    uint32_t count = check->count / (uint32_t)sizeof *m;
    if (check->count % sizeof *m || count > NOH_MATERIALS_MAX) {
        return noh_check_fail(check, "material chunk is not a whole number of materials, or over the limit", 0);
    }
    for (uint32_t i = 0; i < count; i++) {
        uint64_t at = (uint64_t)i * sizeof *m;
        noh_result result = noh_check_name(check, m[i].name, m[i].name_hash, at);
        if (!result) {
            result = noh_check_floats(check, m[i].base_color, 7, "material value is not finite");
        }
        if (result) {
            return result;
        }
        if (m[i].base_color_texture != NOH_NONE && m[i].base_color_texture >= check->pack->texture_count) {
            return noh_check_fail(check, "material names a texture that is not there",
                                  at + offsetof(noh_material, base_color_texture));
        }
        if (m[i].flags & ~15u) {
            return noh_check_fail(check, "unknown material flags", at + offsetof(noh_material, flags));
        }
        if (m[i].reserved) {
            return noh_check_fail(check, "reserved field of a material is not zero",
                                  at + offsetof(noh_material, reserved));
        }
    }
    return NOH_OK;
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
