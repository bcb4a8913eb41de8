/* check_mesh.c: everything that later code trusts about a mesh chunk. */
#include "pack/check.h"

static int any_word(const uint32_t *words, size_t count)
{
    uint32_t all = 0;
    for (size_t i = 0; i < count; i++) {
        all |= words[i];
    }
    return all != 0;
}

static noh_result check_limits(const noh_check *check, const noh_mesh_header *h)
{
    if (h->vertex_count == 0 || h->vertex_count > NOH_VERTICES_MAX) {
        return noh_check_fail(check, "vertex count is zero or over the limit", 4);
    }
    if (h->level || !h->level_count || h->level_count > NOH_LEVELS_MAX) {
        return noh_check_fail(check, "mesh has no level or too many, or does not begin with the full one", 192);
    }
    if (h->index_count > NOH_INDICES_MAX || h->index_count % 3) {
        return noh_check_fail(check, "index count is over the limit or not a multiple of three", 8);
    }
    if ((h->index_bytes != 2 && h->index_bytes != 4) || (h->index_bytes == 2 && h->vertex_count > 65536u)) {
        return noh_check_fail(check, "indices are neither 2 nor 4 bytes, or 2 for too many vertices", 12);
    }
    if (h->submesh_count == 0 || h->submesh_count > NOH_SUBMESHES_MAX) {
        return noh_check_fail(check, "submesh count is zero or over the limit", 16);
    }
    if (h->target_count > NOH_TARGETS_MAX || h->texel_count > NOH_TEXELS_MAX || h->rect_count > h->texel_count) {
        return noh_check_fail(check, "target, texel or rectangle count is over its limit", 20);
    }
    if ((h->flags & ~(NOH_MESH_TANGENTS | NOH_MESH_UVS | NOH_MESH_COLORS | NOH_MESH_DUAL_QUATERNION | NOH_MESH_TEXELS)) ||
        any_word(h->reserved, sizeof h->reserved / sizeof h->reserved[0])) {
        return noh_check_fail(check, "unknown mesh flags, or a reserved field is not zero", 0);
    }
    return NOH_OK;
}

/* What sizes the arrays of a skinned mesh; before they are looked at. */
static noh_result check_skin_counts(const noh_check *check, const noh_mesh_header *h)
{
    const uint32_t n = h->influence_count;
    const int split = h->palette_count > 1;
    if (h->skin == NOH_NONE) {
        return n || h->palette_count || h->palette_joint_count || (h->flags & NOH_MESH_DUAL_QUATERNION)
                   ? noh_check_fail(check, "rigid mesh has influences, palettes or a skin's flags", 148)
                   : NOH_OK;
    }
    if (h->skin >= check->pack->skin_count) {
        return noh_check_fail(check, "mesh names a skin that is not there", 148);
    }
    if (n != 1 && n != 2 && n != 4 && n != 8) {
        return noh_check_fail(check, "skinned mesh has neither 1, 2, 4 nor 8 influences a vertex", 152);
    }
    if (!h->palette_count || h->palette_count > NOH_SUBMESHES_MAX ||
        h->palette_joint_count > h->palette_count * NOH_PALETTE_JOINTS_MAX) {
        return noh_check_fail(check, "palette count is zero or over the limit, or palettes have too many joints", 160);
    }
    if (split && !(h->flags & NOH_MESH_TEXELS)) {
        return noh_check_fail(check, "mesh is split into palettes without texel references", 0);
    }
    return NOH_OK;
}

/* Boxes: finite, and not inside out, or (inverted) altogether. */
static noh_result check_boxes(const noh_check *check, uint32_t offset, uint32_t count, int may_be_empty)
{
    const float *boxes = (const float *)(const void *)(check->bytes + offset);
    noh_result result = noh_check_floats(check, boxes, count * 6u, "box is not finite");
    for (uint32_t i = 0; !result && i < count; i++) {
        const float *b = boxes + 6u * (size_t)i;
        int proper = b[0] <= b[3] && b[1] <= b[4] && b[2] <= b[5];
        int empty = may_be_empty && b[0] > b[3] && b[1] > b[4] && b[2] > b[5];
        if (!proper && !empty) {
            result = noh_check_fail(check, "box is inside out", offset + 24ull * i);
        }
    }
    return result;
}

noh_result noh_check_texture_shape(const noh_check *check, const noh_mesh_header *h)
{
    uint64_t texels;
    if (h->touched_count > h->vertex_count) {
        return noh_check_fail(check, "more touched vertices than vertices", 40);
    }
    if (h->morph_width_log2 < NOH_MORPH_WIDTH_LOG2_MIN || h->morph_width_log2 > NOH_MORPH_WIDTH_LOG2_MAX ||
        h->morph_height > NOH_MORPH_HEIGHT_MAX) {
        return noh_check_fail(check, "accumulation texture is over its limits", 44);
    }
    texels = (uint64_t)h->morph_height << h->morph_width_log2;
    if (texels < h->touched_count || texels - h->touched_count >= (1u << h->morph_width_log2)) {
        return noh_check_fail(check, "accumulation texture does not fit the touched vertices", 48);
    }
    return NOH_OK;
}

static uint32_t stride_of(uint32_t flags)
{
    return 4u + ((flags & NOH_MESH_TANGENTS) ? 4u : 0u) + ((flags & NOH_MESH_UVS) ? 4u : 0u) +
           ((flags & NOH_MESH_COLORS) ? 4u : 0u) + ((flags & NOH_MESH_TEXELS) ? 4u : 0u);
}

static noh_result check_arrays(noh_check *check, const noh_mesh_header *h)
{
    const noh_level_sums sums = noh_check_level_sums(h);
    const struct { uint32_t offset; uint64_t count; uint32_t stride; } arrays[13] = {
        { h->positions_offset, h->vertex_count, 12 },
        { h->attributes_offset, h->vertex_count, h->attribute_stride },
        { h->indices_offset, sums.indices, h->index_bytes },
        { h->submeshes_offset, sums.submeshes, sizeof(noh_submesh) },
        { h->targets_offset, (uint64_t)h->target_count * h->level_count, sizeof(noh_target) },
        { h->weights_offset, h->target_count, 4 },
        { h->rects_offset, h->rect_count, sizeof(noh_rect) },
        { h->texels_offset, h->texel_count, 12 },
        { h->target_boxes_offset, h->target_count, 24 },
        { h->influences_offset, h->vertex_count, 4u * NOH_INFLUENCE_WORDS(h->influence_count) },
        { h->palettes_offset, h->palette_count, sizeof(noh_palette) },
        { h->palette_joints_offset, h->palette_joint_count, 2 },
        { h->joint_boxes_offset, noh_check_skin_joints(check->pack, h->skin), 24 }
    };
    if (h->attribute_stride != stride_of(h->flags)) {
        return noh_check_fail(check, "attribute stride does not fit the mesh flags", 52);
    }
    for (unsigned i = 0; i < sizeof arrays / sizeof arrays[0]; i++) {
        noh_result result = noh_check_array(check, arrays[i].offset, arrays[i].count, arrays[i].stride);
        if (result) {
            return result;
        }
    }
    return noh_check_end(check);
}

noh_result noh_check_indices(const noh_check *check, const noh_mesh_header *h)
{
    const uint8_t *indices = check->bytes + h->indices_offset;
    for (uint32_t i = 0; i < h->index_count; i++) {
        uint32_t index = h->index_bytes == 2 ? ((const uint16_t *)(const void *)indices)[i]
                                             : ((const uint32_t *)(const void *)indices)[i];
        if (index >= h->vertex_count) {
            return noh_check_fail(check, "index past the last vertex", h->indices_offset + (uint64_t)i * h->index_bytes);
        }
    }
    return NOH_OK;
}

noh_result noh_check_submeshes(const noh_check *check, const noh_mesh_header *h)
{
    const noh_submesh *submeshes = (const noh_submesh *)(const void *)(check->bytes + h->submeshes_offset);
    uint32_t next = 0;
    for (uint32_t i = 0; i < h->submesh_count; i++) {
        const noh_submesh *s = &submeshes[i];
        uint64_t at = h->submeshes_offset + (uint64_t)i * sizeof *s;
        if (s->first_index > h->index_count || s->index_count > h->index_count - s->first_index || s->index_count % 3) {
            return noh_check_fail(check, "submesh indices lie outside the mesh", at);
        }
        if (s->first_index < next) {
            return noh_check_fail(check, "submeshes overlap, or are out of order", at);
        }
        next = s->first_index + s->index_count;
        if (s->first_vertex > h->vertex_count || s->vertex_count > h->vertex_count - s->first_vertex) {
            return noh_check_fail(check, "submesh vertices lie outside the mesh", at);
        }
        if (s->material != NOH_NONE && s->material >= check->pack->material_count) {
            return noh_check_fail(check, "submesh names a material that is not there", at);
        }
    }
    return NOH_OK;
}

static noh_result check_target_head(const noh_check *check, const noh_mesh_header *h, const noh_target *t,
                                    uint32_t first_rect, uint32_t first_texel, uint64_t at)
{
    noh_result result = noh_check_name(check, t->name, t->name_hash, at);
    if (result) {
        return result;
    }
    if (t->first_rect != first_rect || t->rect_count > h->rect_count - first_rect || t->first_texel != first_texel ||
        t->texel_count > h->texel_count - first_texel) {
        return noh_check_fail(check, "target's rectangles or texels lie outside the mesh's", at);
    }
    if (!t->position_bits || !t->normal_bits || !t->tangent_bits || t->position_bits > 24 || t->normal_bits > 24 ||
        t->tangent_bits > 24 || t->position_bits + t->normal_bits + t->tangent_bits > 32 || t->reserved0 || t->reserved1) {
        return noh_check_fail(check, "target's bit widths are impossible", at + 28);
    }
    if (t->position_scale < 0.0f || t->normal_scale < 0.0f || t->tangent_scale < 0.0f || t->max_displacement < 0.0f) {
        return noh_check_fail(check, "target's scale is negative", at + 32);
    }
    return noh_check_floats(check, &t->position_scale, 7, "target's scale is not finite");
}

/* One rectangle: inside the texture, and no delta on a texel that no vertex has. */
static noh_result check_rect(const noh_check *check, const noh_mesh_header *h, const noh_rect *r, uint32_t first_texel,
                             uint32_t *pairs, uint64_t at)
{
    const uint32_t *texel = (const uint32_t *)(const void *)(check->bytes + h->texels_offset) + 3u * (size_t)first_texel;
    if (!r->w || !r->h || (uint32_t)r->x + r->w > (1u << h->morph_width_log2) || (uint32_t)r->y + r->h > h->morph_height) {
        return noh_check_fail(check, "rectangle lies outside the accumulation texture", at);
    }
    for (uint32_t y = r->y; y < (uint32_t)r->y + r->h; y++) {
        for (uint32_t x = r->x; x < (uint32_t)r->x + r->w; x++, texel += 3) {
            uint32_t any = (texel[0] | texel[1] | texel[2]) != 0u;
            if (any && (y << h->morph_width_log2) + x >= h->touched_count) {
                return noh_check_fail(check, "rectangle moves a texel that no vertex has", at);
            }
            *pairs += any;
        }
    }
    return NOH_OK;
}

noh_result noh_check_rects(const noh_check *check, const noh_mesh_header *h, const noh_target *t)
{
    const noh_rect *rects = (const noh_rect *)(const void *)(check->bytes + h->rects_offset) + t->first_rect;
    uint32_t texel = t->first_texel, pairs = 0;
    for (uint32_t i = 0; i < t->rect_count; i++) {
        uint64_t at = h->rects_offset + ((uint64_t)t->first_rect + i) * sizeof *rects;
        uint64_t area = (uint64_t)rects[i].w * rects[i].h;
        noh_result result;
        if (area > t->texel_count - (texel - t->first_texel)) {
            return noh_check_fail(check, "rectangle has more texels than its target", at);
        }
        result = check_rect(check, h, &rects[i], texel, &pairs, at);
        if (result) {
            return result;
        }
        texel += (uint32_t)area;
    }
    if (texel - t->first_texel != t->texel_count || pairs != t->pair_count) {
        return noh_check_fail(check, "target's texel or pair count is wrong",
                              h->targets_offset + (uint64_t)((const uint8_t *)t - (check->bytes + h->targets_offset)));
    }
    return NOH_OK;
}

static noh_result check_targets(const noh_check *check, const noh_mesh_header *h)
{
    const noh_target *targets = (const noh_target *)(const void *)(check->bytes + h->targets_offset);
    uint32_t rects = 0, texels = 0, pairs = 0;
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
    if (rects != h->rect_count || texels != h->texel_count || pairs != h->pair_count) {
        return noh_check_fail(check, "the targets' counts do not add up to the mesh's", h->targets_offset);
    }
    return NOH_OK;
}

/* Of the full mesh and what all levels share. */
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
    if (!result) result = noh_check_level_headers(check, h);
    if (!result) result = noh_check_texture_shape(check, h);
    if (!result) result = check_skin_counts(check, h);
    if (!result) result = check_arrays(check, h);
    if (!result) result = check_full(check, h);
    if (!result) result = noh_check_levels(check, h);
    return result;
}
