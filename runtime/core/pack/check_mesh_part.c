/* check_mesh_part.c: checks of the parts that every level of a mesh has: its accumulation texture, triangles,
 * submeshes, rectangles and texel references. check_mesh.c, check_level.c and check_skin.c call these functions, never
 * the other way round. `h` is always the header of the level that is checked. */
#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"

#include <stddef.h>

/* The accumulation texture has a power of two as its width and just as many rows as its texels need. */
noh_result noh_check_texture_shape(const noh_check *check, const noh_mesh_header *h)
{
    const uint64_t at = noh_check_level_at(h);
    const uint64_t most = (uint64_t)h->vertex_count * (h->flags & NOH_MESH_UV_TARGETS ? 2u : 1u);
    uint64_t texels;
    if (h->touched_count > most || h->touched_count > NOH_VERTICES_MAX) {
        return noh_check_fail(check, "more touched vertices than vertices",
                              at + offsetof(noh_mesh_header, touched_count));
    }
    if (h->morph_width_log2 < NOH_MORPH_WIDTH_LOG2_MIN || h->morph_width_log2 > NOH_MORPH_WIDTH_LOG2_MAX) {
        return noh_check_fail(check, "width of the accumulation texture is outside its limits",
                              at + offsetof(noh_mesh_header, morph_width_log2));
    }
    if (h->morph_height > NOH_MORPH_HEIGHT_MAX) {
        return noh_check_fail(check, "height of the accumulation texture is over its limits",
                              at + offsetof(noh_mesh_header, morph_height));
    }
    texels = (uint64_t)h->morph_height << h->morph_width_log2;
    if (texels < h->touched_count || texels - h->touched_count >= (1u << h->morph_width_log2)) {
        return noh_check_fail(check, "accumulation texture does not fit the touched vertices",
                              at + offsetof(noh_mesh_header, morph_height));
    }
    return NOH_OK;
}

noh_result noh_check_indices(const noh_check *check, const noh_mesh_header *h)
{
    const uint8_t *indices = check->bytes + h->indices_offset;
    for (uint32_t i = 0; i < h->index_count; i++) {
        uint32_t index = h->index_bytes == 2 ? ((const uint16_t *)(const void *)indices)[i]
                                             : ((const uint32_t *)(const void *)indices)[i];
        if (index >= h->vertex_count) {
            return noh_check_fail(check, "index past the last vertex",
                                  h->indices_offset + (uint64_t)i * h->index_bytes);
        }
    }
    return NOH_OK;
}

/* The indices and vertices of a submesh are some of the mesh's. */
static noh_result check_ranges(const noh_check *check, const noh_mesh_header *h, const noh_submesh *s, uint64_t at)
{
    const noh_check_field indices[] = {
        { offsetof(noh_submesh, first_index), s->first_index > h->index_count },
        { offsetof(noh_submesh, index_count), s->index_count > h->index_count - s->first_index || s->index_count % 3 },
    };
    const noh_check_field vertices[] = {
        { offsetof(noh_submesh, first_vertex), s->first_vertex > h->vertex_count },
        { offsetof(noh_submesh, vertex_count), s->vertex_count > h->vertex_count - s->first_vertex },
    };
    const noh_result result = noh_check_fields(check, indices, 2, "submesh indices lie outside the mesh", at);
    return result ? result : noh_check_fields(check, vertices, 2, "submesh vertices lie outside the mesh", at);
}

noh_result noh_check_submeshes(const noh_check *check, const noh_mesh_header *h)
{
    const noh_submesh *submeshes = (const noh_submesh *)(const void *)(check->bytes + h->submeshes_offset);
    uint32_t next = 0;
    for (uint32_t i = 0; i < h->submesh_count; i++) {
        const noh_submesh *s = &submeshes[i];
        uint64_t at = h->submeshes_offset + (uint64_t)i * sizeof *s;
        noh_result result = check_ranges(check, h, s, at);
        if (result) {
            return result;
        }
        if (s->first_index < next) {
            return noh_check_fail(check, "submeshes overlap, or are out of order",
                                  at + offsetof(noh_submesh, first_index));
        }
        next = s->first_index + s->index_count;
        if (s->material != NOH_NONE && s->material >= check->pack->material_count) {
            return noh_check_fail(check, "submesh names a missing material", at + offsetof(noh_submesh, material));
        }
    }
    return NOH_OK;
}

/* One rectangle: inside the texture, and no delta on a texel that no vertex has. */
static noh_result check_rect(const noh_check *check, const noh_mesh_header *h, const noh_rect *r, uint32_t first_texel,
                             uint32_t *pairs, uint64_t at)
{
    const uint32_t *texel = (const uint32_t *)(const void *)(check->bytes + h->texels_offset) +
                            3u * (size_t)first_texel;
    const noh_check_field fields[] = {
        { offsetof(noh_rect, w), !r->w || (uint32_t)r->x + r->w > (1u << h->morph_width_log2) },
        { offsetof(noh_rect, h), !r->h || (uint32_t)r->y + r->h > h->morph_height },
    };
    const noh_result result = noh_check_fields(check, fields, 2, "rectangle lies outside the accumulation texture", at);
    if (result) {
        return result;
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

static noh_result check_counts(const noh_check *check, const noh_target *t, uint32_t texels, uint32_t pairs)
{
    const noh_check_field fields[] = {
        { offsetof(noh_target, texel_count), t->texel_count != texels },
        { offsetof(noh_target, pair_count), t->pair_count != pairs },
    };
    return noh_check_fields(check, fields, 2, "target's texel or pair count is wrong",
                            (uint64_t)((const uint8_t *)t - check->bytes));
}

noh_result noh_check_target_sums(const noh_check *check, const noh_mesh_header *h, uint64_t rects, uint64_t texels,
                                 uint64_t pairs)
{
    const noh_check_field fields[] = {
        { offsetof(noh_mesh_header, rect_count), h->rect_count != rects },
        { offsetof(noh_mesh_header, texel_count), h->texel_count != texels },
        { offsetof(noh_mesh_header, pair_count), h->pair_count != pairs },
    };
    const char *what = h->level ? "the targets' counts do not add up to the level's"
                                : "the targets' counts do not add up to the mesh's";
    return noh_check_fields(check, fields, 3, what, noh_check_level_at(h));
}

/* A target's delta texels fill its rectangles, one rectangle after the other, row by row. They must be used up exactly.
 * Texels that are not zero are the target's pairs. */
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
    return check_counts(check, t, texel - t->first_texel, pairs);
}

uint32_t noh_check_texel_word(const noh_check *check, const noh_mesh_header *h, uint32_t vertex)
{
    size_t last = h->attributes_offset + (size_t)(vertex + 1u) * h->attribute_stride - 4u;
    return (h->flags & NOH_MESH_TEXELS) ? *(const uint32_t *)(const void *)(check->bytes + last) : vertex;
}

/* A draw has one palette: all its vertices are written for it. */
noh_result noh_check_draws(const noh_check *check, const noh_mesh_header *h)
{
    const noh_submesh *submeshes = (const noh_submesh *)(const void *)(check->bytes + h->submeshes_offset);
    const uint8_t *indices = check->bytes + h->indices_offset;
    for (uint32_t s = 0; s < h->submesh_count; s++) {
        uint64_t at = h->submeshes_offset + (uint64_t)s * sizeof *submeshes;
        if (submeshes[s].palette >= (h->palette_count ? h->palette_count : 1u)) {
            return noh_check_fail(check, "submesh names a missing palette", at + offsetof(noh_submesh, palette));
        }
        for (uint32_t i = 0; h->palette_count > 1 && i < submeshes[s].index_count; i++) {
            size_t k = (size_t)submeshes[s].first_index + i;
            uint32_t v = h->index_bytes == 2 ? ((const uint16_t *)(const void *)indices)[k]
                                             : ((const uint32_t *)(const void *)indices)[k];
            if (noh_check_texel_word(check, h, v) >> NOH_TEXEL_VERTEX_BITS != submeshes[s].palette) {
                return noh_check_fail(check, "submesh draws a vertex of another palette", at);
            }
        }
    }
    return NOH_OK;
}
