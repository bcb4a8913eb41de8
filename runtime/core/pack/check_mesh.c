/* check_mesh.c: everything that later code trusts about a mesh chunk. */
#include "core/base/math_internal.h"
#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"

#include <stddef.h>

static noh_result check_limits(const noh_check *check, const noh_mesh_header *h)
{
    if (h->vertex_count == 0 || h->vertex_count > NOH_VERTICES_MAX) {
        return noh_check_fail(check, "vertex count is zero or over the limit", offsetof(noh_mesh_header, vertex_count));
    }
    if (!h->level_count || h->level_count > NOH_LOD_LEVELS_MAX) {
        return noh_check_fail(check, "mesh has no level or too many", offsetof(noh_mesh_header, level_count));
    }
    if (h->level_first >= h->level_count) {
        return noh_check_fail(check, "mesh lacks all of its levels", offsetof(noh_mesh_header, level_first));
    }
    if (h->level != h->level_first) {
        return noh_check_fail(check, "mesh does not begin with the finest of its levels",
                              offsetof(noh_mesh_header, level));
    }
    if (h->source_crc && !h->level_first) {
        return noh_check_fail(check, "mesh has all levels but names a source", offsetof(noh_mesh_header, source_crc));
    }
    if (h->index_count > NOH_INDICES_MAX || h->index_count % 3) {
        return noh_check_fail(check, "index count is over the limit or not a multiple of three",
                              offsetof(noh_mesh_header, index_count));
    }
    if ((h->index_bytes != 2 && h->index_bytes != 4) || (h->index_bytes == 2 && h->vertex_count > 65536u)) {
        return noh_check_fail(check, "indices are neither 2 nor 4 bytes, or 2 for too many vertices",
                              offsetof(noh_mesh_header, index_bytes));
    }
    if (h->submesh_count == 0 || h->submesh_count > NOH_SUBMESHES_MAX) {
        return noh_check_fail(check, "submesh count is zero or over the limit",
                              offsetof(noh_mesh_header, submesh_count));
    }
    if (h->target_count > NOH_TARGETS_MAX) {
        return noh_check_fail(check, "target count is over the limit", offsetof(noh_mesh_header, target_count));
    }
    if (h->texel_count > NOH_DELTA_TEXELS_MAX) {
        return noh_check_fail(check, "delta texel count is over the limit", offsetof(noh_mesh_header, texel_count));
    }
    if (h->rect_count > h->texel_count) {
        return noh_check_fail(check, "rectangle count is over its limit: there are fewer delta texels",
                              offsetof(noh_mesh_header, rect_count));
    }
    if (h->flags & ~(NOH_MESH_TANGENTS | NOH_MESH_UVS | NOH_MESH_COLORS | NOH_MESH_DUAL_QUATERNION | NOH_MESH_TEXELS |
                     NOH_MESH_UV_TARGETS)) {
        return noh_check_fail(check, "unknown mesh flags", offsetof(noh_mesh_header, flags));
    }
    if (h->extra_words > NOH_EXTRA_WORDS_ROOM(h->flags)) {
        return noh_check_fail(check, "more words of extra attributes than a mesh can have",
                              offsetof(noh_mesh_header, extra_words));
    }
    return NOH_OK;
}

/* Targets move texture coordinates of a mesh that has some and refers to their texels, by a number that is one. */
static noh_result check_uv_targets(const noh_check *check, const noh_mesh_header *h)
{
    const uint32_t needed = NOH_MESH_UVS | NOH_MESH_TEXELS;
    const int moves = (h->flags & NOH_MESH_UV_TARGETS) != 0;
    if (moves && (h->flags & needed) != needed) {
        return noh_check_fail(check, "targets move texture coordinates that the mesh does not have",
                              offsetof(noh_mesh_header, flags));
    }
    if (moves ? !(h->uv_per_unit > 0.0f) || !noh_is_finite(h->uv_per_unit) : h->uv_per_unit != 0.0f) {
        return noh_check_fail(check, "texture coordinates for a unit are not above 0, or nothing moves any",
                              offsetof(noh_mesh_header, uv_per_unit));
    }
    return NOH_OK;
}

/* The counts that size a skinned mesh's arrays, before the arrays are looked at. */
static noh_result check_skin_counts(const noh_check *check, const noh_mesh_header *h)
{
    const uint32_t n = h->influence_count;
    const int split = h->palette_count > 1;
    if (h->skin == NOH_NONE) {
        const noh_check_field fields[] = {
            { offsetof(noh_mesh_header, influence_count), n != 0 },
            { offsetof(noh_mesh_header, palette_count), h->palette_count != 0 },
            { offsetof(noh_mesh_header, palette_joint_count), h->palette_joint_count != 0 },
            { offsetof(noh_mesh_header, flags), (h->flags & NOH_MESH_DUAL_QUATERNION) != 0 },
        };
        return noh_check_fields(check, fields, 4, "rigid mesh has influences, palettes or a skin's flags", 0);
    }
    if (h->skin >= check->pack->runs[NOH_CHUNK_SKIN].count) {
        return noh_check_fail(check, "mesh names a missing skin", offsetof(noh_mesh_header, skin));
    }
    if (n != 1 && n != 2 && n != 4 && n != 8) {
        return noh_check_fail(check, "skinned mesh has neither 1, 2, 4 nor 8 influences a vertex",
                              offsetof(noh_mesh_header, influence_count));
    }
    if (!h->palette_count || h->palette_count > NOH_SUBMESHES_MAX) {
        return noh_check_fail(check, "palette count is zero or over the limit",
                              offsetof(noh_mesh_header, palette_count));
    }
    if (h->palette_joint_count > h->palette_count * NOH_PALETTE_JOINTS_MAX) {
        return noh_check_fail(check, "palettes have too many joints", offsetof(noh_mesh_header, palette_joint_count));
    }
    if (split && !(h->flags & NOH_MESH_TEXELS)) {
        return noh_check_fail(check, "mesh is split into palettes without texel references",
                              offsetof(noh_mesh_header, flags));
    }
    return NOH_OK;
}

/* Boxes are finite, and each has its smallest corner first; where it may be empty all three axes are inverted. */
static noh_result check_boxes(const noh_check *check, uint32_t offset, uint32_t count, int may_be_empty)
{
    const float *boxes = (const float *)(const void *)(check->bytes + offset);
    noh_result result = NOH_OK;
    for (uint32_t i = 0; !result && i < count; i++) {
        const float *b = boxes + 6u * (size_t)i;
        int proper = b[0] <= b[3] && b[1] <= b[4] && b[2] <= b[5];
        int empty = may_be_empty && b[0] > b[3] && b[1] > b[4] && b[2] > b[5];
        if (!empty) result = noh_check_floats(check, b, 6u, "box is not finite");
        if (!result && !proper && !empty) {
            result = noh_check_fail(check, "minimum of a box is above its maximum", offset + 24ull * i);
        }
    }
    return result;
}

static uint32_t stride_of(const noh_mesh_header *h)
{
    const uint32_t flags = h->flags;
    return 4u + 4u * h->extra_words + ((flags & NOH_MESH_TANGENTS) ? 4u : 0u) + ((flags & NOH_MESH_UVS) ? 4u : 0u) +
           ((flags & NOH_MESH_COLORS) ? 4u : 0u) + ((flags & NOH_MESH_UV_TARGETS) ? 4u : 0u) +
           ((flags & NOH_MESH_TEXELS) ? 4u : 0u);
}

static noh_result check_arrays(noh_check *check, const noh_mesh_header *h)
{
    const noh_level_sums sums = noh_check_level_sums(h);
    const struct {
        size_t field;
        uint64_t count;
        uint32_t stride;
    } arrays[13] = {
        { offsetof(noh_mesh_header, positions_offset), h->vertex_count, 12 },
        { offsetof(noh_mesh_header, attributes_offset), h->vertex_count, h->attribute_stride },
        { offsetof(noh_mesh_header, indices_offset), sums.indices, h->index_bytes },
        { offsetof(noh_mesh_header, submeshes_offset), sums.submeshes, sizeof(noh_submesh) },
        { offsetof(noh_mesh_header, targets_offset), (uint64_t)h->target_count * noh_check_levels_there(h),
          sizeof(noh_target) },
        { offsetof(noh_mesh_header, weights_offset), h->target_count, 4 },
        { offsetof(noh_mesh_header, rects_offset), h->rect_count, sizeof(noh_rect) },
        { offsetof(noh_mesh_header, texels_offset), h->texel_count, 12 },
        { offsetof(noh_mesh_header, target_boxes_offset), h->target_count, 24 },
        { offsetof(noh_mesh_header, influences_offset), h->vertex_count, 4u * NOH_INFLUENCE_WORDS(h->influence_count) },
        { offsetof(noh_mesh_header, palettes_offset), h->palette_count, sizeof(noh_palette) },
        { offsetof(noh_mesh_header, palette_joints_offset), h->palette_joint_count, 2 },
        { offsetof(noh_mesh_header, joint_boxes_offset), noh_check_skin_joints(check->pack, h->skin), 24 }
    };
    if (h->attribute_stride != stride_of(h)) {
        return noh_check_fail(check, "attribute stride does not fit the mesh flags",
                              offsetof(noh_mesh_header, attribute_stride));
    }
    for (unsigned i = 0; i < sizeof arrays / sizeof arrays[0]; i++) {
        noh_result result = noh_check_array(check, arrays[i].field, arrays[i].count, arrays[i].stride);
        if (result) {
            return result;
        }
    }
    return noh_check_end(check);
}

static int bad_bits(uint32_t bits)
{
    return !bits || bits > 24u;
}

/* A delta's three fields fill a word at most, and none is wider than a float's mantissa; where their sum is too large
 * the first is named. */
static noh_result check_target_values(const noh_check *check, const noh_target *t, uint64_t at)
{
    const int sum = t->position_bits + t->normal_bits + t->tangent_bits;
    const noh_check_field bits[] = {
        { offsetof(noh_target, normal_bits), bad_bits(t->normal_bits) },
        { offsetof(noh_target, tangent_bits), bad_bits(t->tangent_bits) },
        { offsetof(noh_target, position_bits), bad_bits(t->position_bits) || sum > 32 },
    };
    const noh_check_field scales[] = {
        { offsetof(noh_target, position_scale), t->position_scale < 0.0f },
        { offsetof(noh_target, normal_scale), t->normal_scale < 0.0f },
        { offsetof(noh_target, tangent_scale), t->tangent_scale < 0.0f },
        { offsetof(noh_target, radius), t->radius < 0.0f },
    };
    const noh_check_field flags[] = { { offsetof(noh_target, flags), (t->flags & ~NOH_TARGET_IDENTITY) != 0 } };
    const noh_check_field reserved[] = { { offsetof(noh_target, reserved1), t->reserved1 != 0 } };
    noh_result result = noh_check_fields(check, bits, 3, "target's bit widths are impossible", at);
    if (!result) result = noh_check_fields(check, flags, 1, "target has flags that this version does not know", at);
    if (!result) result = noh_check_fields(check, reserved, 1, "reserved field of a target is not zero", at);
    if (!result) result = noh_check_fields(check, scales, 4, "target's scale or radius is negative", at);
    return result ? result : noh_check_floats(check, &t->position_scale, 7, "target's scale is not finite");
}

/* A target begins where the one before it ended. */
static noh_result check_target_head(const noh_check *check, const noh_mesh_header *h, const noh_target *t,
                                    uint32_t first_rect, uint32_t first_texel, uint64_t at)
{
    const noh_check_field place[] = {
        { offsetof(noh_target, first_rect), t->first_rect != first_rect },
        { offsetof(noh_target, rect_count), t->rect_count > h->rect_count - first_rect },
        { offsetof(noh_target, first_texel), t->first_texel != first_texel },
        { offsetof(noh_target, texel_count), t->texel_count > h->texel_count - first_texel },
    };
    noh_result result = noh_check_name(check, t->name, t->name_hash, at);
    if (result) {
        return result;
    }
    result = noh_check_fields(check, place, 4, "target's rectangles or texels lie outside the mesh's", at);
    return result ? result : check_target_values(check, t, at);
}

/* The targets' rectangles and delta texels follow each other in target order and use up the mesh's. */
static noh_result check_targets(const noh_check *check, const noh_mesh_header *h)
{
    const noh_target *targets = (const noh_target *)(const void *)(check->bytes + h->targets_offset);
    uint32_t rects = 0, texels = 0;
    uint64_t pairs = 0;
    for (uint32_t i = 0; i < h->target_count; i++) {
        uint64_t at = h->targets_offset + (uint64_t)i * sizeof *targets;
        noh_result result = check_target_head(check, h, &targets[i], rects, texels, at);
        if (!result) {
            result = noh_check_rects(check, h, &targets[i]);
        }
        if (result) {
            return result;
        }
        rects += targets[i].rect_count;
        texels += targets[i].texel_count;
        pairs += targets[i].pair_count;
    }
    return noh_check_target_sums(check, h, rects, texels, pairs);
}

/* The finest level, and what all levels share. */
static noh_result check_full(noh_check *check, const noh_mesh_header *h)
{
    noh_result result = noh_check_floats(check, h->bounds_min, 13, "bounds, error bound or scale are not finite");
    if (!result) {
        result = noh_check_floats(check, (const float *)(const void *)(check->bytes + h->positions_offset),
                                  h->vertex_count * 3u, "position is not finite");
    }
    if (!result) result = noh_check_indices(check, h);
    if (!result) result = noh_check_submeshes(check, h);
    if (!result) result = check_targets(check, h);
    if (!result) result = check_boxes(check, h->target_boxes_offset, h->target_count, 0);
    if (!result) {
        result = check_boxes(check, h->joint_boxes_offset, noh_check_skin_joints(check->pack, h->skin), 1);
    }
    if (!result) result = noh_check_mesh_skin(check, h);
    if (!result) {
        result = noh_check_floats(check, (const float *)(const void *)(check->bytes + h->weights_offset),
                                  h->target_count, "default weight is not finite");
    }
    return result;
}

noh_result noh_check_mesh(noh_check *check)
{
    const noh_mesh_header *h = (const noh_mesh_header *)(const void *)check->bytes;
    noh_result result = noh_check_head(check, sizeof *h);
    if (!result) result = check_limits(check, h);
    if (!result) result = noh_check_reserved(check, offsetof(noh_mesh_header, reserved), sizeof h->reserved / 4u);
    if (!result) result = check_uv_targets(check, h);
    if (!result) result = noh_check_texture_shape(check, h);
    if (!result) result = check_skin_counts(check, h);
    if (!result) result = noh_check_level_headers(check, h);
    if (!result) result = check_arrays(check, h);
    if (!result) result = check_full(check, h);
    if (!result) result = noh_check_levels(check, h);
    return result;
}
