/* check_level.c: the checker of a mesh's LOD levels, and of its texel references. */
#include "core/base/math_internal.h"
#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"

#include <stddef.h>
#include <string.h>

/* ---- headers ---- */

/* A level's header with the fields in which levels differ replaced by the finest one's: what is left must be equal to
 * it. */
static noh_mesh_header as_full(const noh_mesh_header *l, const noh_mesh_header *h)
{
    noh_mesh_header same = *l;
    same.vertex_count = h->vertex_count;
    same.index_count = h->index_count;
    same.submesh_count = h->submesh_count;
    same.rect_count = h->rect_count;
    same.texel_count = h->texel_count;
    same.pair_count = h->pair_count;
    same.touched_count = h->touched_count;
    same.morph_height = h->morph_height;
    same.indices_offset = h->indices_offset;
    same.submeshes_offset = h->submeshes_offset;
    same.targets_offset = h->targets_offset;
    same.level = h->level;
    memcpy(&same.level_error_rest, &h->level_error_rest, 6u * sizeof(float));
    return same;
}

/* No count is larger than the finer level's, or one that no level can have. */
static noh_result check_level_counts(const noh_check *check, const noh_mesh_header *l, const noh_mesh_header *finer)
{
    const noh_check_field counts[] = {
        { offsetof(noh_mesh_header, vertex_count), !l->vertex_count || l->vertex_count > finer->vertex_count },
        { offsetof(noh_mesh_header, index_count), l->index_count > finer->index_count || l->index_count % 3 },
        { offsetof(noh_mesh_header, submesh_count), !l->submesh_count || l->submesh_count > NOH_SUBMESHES_MAX },
        { offsetof(noh_mesh_header, touched_count), l->touched_count > finer->touched_count },
        { offsetof(noh_mesh_header, rect_count), l->rect_count > finer->rect_count },
        { offsetof(noh_mesh_header, texel_count), l->texel_count > finer->texel_count },
        { offsetof(noh_mesh_header, pair_count), l->pair_count > finer->pair_count },
    };
    return noh_check_fields(check, counts, sizeof counts / sizeof counts[0],
                            "LOD level has a higher count than the finer level", noh_check_level_at(l));
}

/* The byte in a header of the first field in which two headers differ; their size where they are the same. Headers are
 * words without gaps. */
static size_t find_difference(const noh_mesh_header *a, const noh_mesh_header *b)
{
    const uint8_t *x = (const uint8_t *)a, *y = (const uint8_t *)b;
    size_t at = 0;
    while (at < sizeof *a && memcmp(x + at, y + at, 4u) == 0) at += 4u;
    return at;
}

/* Fields shared by all levels are in each of their headers. If the second and third levels agree and differ from the
 * first, the first level's field is reported, otherwise this level's field. */
static noh_result check_shared(const noh_check *check, const noh_mesh_header *h, uint32_t k)
{
    const uint32_t count = noh_check_levels_there(h);
    const noh_mesh_header same = as_full(&h[k], h), next = as_full(&h[k + 1u < count ? k + 1u : k], h);
    const uint64_t start = (uint64_t)k * sizeof *h;
    const size_t at = find_difference(&same, h);
    if (h[k].level != h->level_first + k) {
        return noh_check_fail(check, "LOD level is out of order", start + offsetof(noh_mesh_header, level));
    }
    if (at == sizeof same) {
        return NOH_OK;
    }
    if (k == 1 && count > 2 && memcmp((const uint8_t *)&same + at, (const uint8_t *)&next + at, 4u) == 0) {
        return noh_check_fail(check, "the finest level differs from the coarser LOD levels in what all levels share",
                              at);
    }
    return noh_check_fail(check, "LOD level differs in what all levels share", start + at);
}

static noh_result check_errors(const noh_check *check, const noh_mesh_header *l, const noh_mesh_header *finer)
{
    const float *mine = &l->level_error_rest, *before = &finer->level_error_rest;
    noh_result result = noh_check_floats(check, mine, 6, "level's error is not finite");
    for (unsigned i = 0; !result && i < 6; i++) {
        if (mine[i] < before[i]) {
            result = noh_check_fail(check, "level's error is below the finer level's error",
                                    noh_check_level_at(l) + offsetof(noh_mesh_header, level_error_rest) + 4u * i);
        }
    }
    return result;
}

/* The errors of the finest level: 0 where it is the full mesh. */
static noh_result check_finest_errors(const noh_check *check, const noh_mesh_header *h)
{
    static const noh_mesh_header none;
    const float *errors = &h->level_error_rest;
    for (unsigned i = 0; i < 3; i++) {
        if (!(h->influence_errors[i] >= (i ? h->influence_errors[i - 1] : 0.0f)) ||
            !noh_is_finite(h->influence_errors[i])) {
            return noh_check_fail(check, "error of fewer influences is not finite, or falls",
                                  offsetof(noh_mesh_header, influence_errors) + 4u * i);
        }
    }
    for (unsigned i = 0; i < 6 && !h->level_first; i++) {
        if (!(errors[i] == 0.0f)) {
            return noh_check_fail(check, "full mesh has the error of a level",
                                  offsetof(noh_mesh_header, level_error_rest) + 4u * i);
        }
    }
    return check_errors(check, h, &none);
}

noh_result noh_check_level_headers(noh_check *check, const noh_mesh_header *h)
{
    const uint32_t count = noh_check_levels_there(h);
    noh_result result = noh_check_head(check, count * (uint32_t)sizeof *h);
    if (!result) result = check_finest_errors(check, h);
    for (uint32_t k = 1; !result && k < count; k++) {
        result = check_shared(check, h, k);
        if (!result) result = check_level_counts(check, &h[k], &h[k - 1]);
        if (!result) result = check_errors(check, &h[k], &h[k - 1]);
    }
    return result;
}

noh_level_sums noh_check_level_sums(const noh_mesh_header *h)
{
    noh_level_sums sums = { 0, 0 };
    for (uint32_t k = 0; k < noh_check_levels_there(h); k++) {
        sums.indices += h[k].index_count;
        sums.submeshes += h[k].submesh_count;
    }
    return sums;
}

/* ---- texels ---- */

static int texel_is_right(const noh_mesh_header *l, uint32_t vertex, uint32_t texel)
{
    return l->level_count > 1 || l->flags & NOH_MESH_UV_TARGETS
               ? texel < l->touched_count || texel == NOH_TEXEL_NONE
               : texel <= vertex && (vertex >= l->touched_count || texel == vertex);
}

/* The texel of its texture coordinates is one of the level, too. */
static noh_result check_uv_texel(const noh_check *check, const noh_mesh_header *l, uint32_t vertex)
{
    const uint64_t at = l->attributes_offset + ((uint64_t)vertex + 1u) * l->attribute_stride - 8u;
    uint32_t texel;
    memcpy(&texel, check->bytes + at, 4);
    return texel < l->touched_count || texel == NOH_TEXEL_NONE
               ? NOH_OK
               : noh_check_fail(check, "texture coordinates of a vertex have a texel that its level does not have", at);
}

/* Every vertex of a level refers to a texel that the level has. */
static noh_result check_texels(const noh_check *check, const noh_mesh_header *h, const noh_mesh_header *l)
{
    if (!(l->flags & NOH_MESH_TEXELS)) {
        const uint32_t least = l->vertex_count < h->touched_count ? l->vertex_count : h->touched_count;
        return l->touched_count < least
                   ? noh_check_fail(check, "LOD level has no texels for some of its vertices", noh_check_level_at(l))
                   : NOH_OK;
    }
    for (uint32_t v = 0; v < l->vertex_count; v++) {
        const uint32_t word = noh_check_texel_word(check, l, v), texel = word & NOH_TEXEL_NONE;
        if (!texel_is_right(l, v, texel) || (l->skin == NOH_NONE && word != texel)) {
            return noh_check_fail(check,
                                  "vertex shares the texel of a later vertex, or one that its level does not have",
                                  l->attributes_offset + (uint64_t)v * l->attribute_stride);
        }
        if (l->flags & NOH_MESH_UV_TARGETS) {
            const noh_result result = check_uv_texel(check, l, v);
            if (result) return result;
        }
    }
    return NOH_OK;
}

/* ---- targets ---- */

static noh_target as_full_target(const noh_target *t, const noh_target *full)
{
    noh_target same = *t;
    same.rect_count = full->rect_count;
    same.texel_count = full->texel_count;
    same.pair_count = full->pair_count;
    return same;
}

/* Each target's rectangles are the first ones of the finer level's. */
static noh_result check_targets(const noh_check *check, const noh_mesh_header *h, const noh_mesh_header *l)
{
    const noh_target *full = (const noh_target *)(const void *)(check->bytes + h->targets_offset);
    const noh_target *targets = (const noh_target *)(const void *)(check->bytes + l->targets_offset);
    const noh_target *finer = targets - h->target_count;
    uint64_t rects = 0, texels = 0, pairs = 0;
    for (uint32_t i = 0; i < h->target_count; i++) {
        const noh_target *t = &targets[i], same = as_full_target(t, &full[i]);
        const uint64_t at = l->targets_offset + (uint64_t)i * sizeof *t;
        noh_result result;
        if (memcmp(&same, &full[i], sizeof same) != 0) {
            return noh_check_fail(check, "level's target differs from the full mesh's", at);
        }
        if (t->rect_count > finer[i].rect_count || t->texel_count > finer[i].texel_count) {
            return noh_check_fail(check, "level's target has more rectangles than the finer level's", at);
        }
        result = noh_check_rects(check, l, t);
        if (result) {
            return result;
        }
        rects += t->rect_count;
        texels += t->texel_count;
        pairs += t->pair_count;
    }
    return noh_check_target_sums(check, l, rects, texels, pairs);
}

/* ---- all of it ---- */

static noh_result check_offsets(const noh_check *check, const noh_mesh_header *l, const noh_mesh_header *finer)
{
    size_t field = 0;
    if (l->indices_offset != finer->indices_offset + finer->index_count * finer->index_bytes) {
        field = offsetof(noh_mesh_header, indices_offset);
    } else if (l->submeshes_offset != finer->submeshes_offset + finer->submesh_count * sizeof(noh_submesh)) {
        field = offsetof(noh_mesh_header, submeshes_offset);
    } else if (l->targets_offset != finer->targets_offset + finer->target_count * sizeof(noh_target)) {
        field = offsetof(noh_mesh_header, targets_offset);
    }
    return field ? noh_check_fail(check, "level's indices, submeshes or targets do not follow the finer level's",
                                  noh_check_level_at(l) + field)
                 : NOH_OK;
}

noh_result noh_check_levels(const noh_check *check, const noh_mesh_header *h)
{
    noh_result result = check_texels(check, h, h);
    for (uint32_t k = 1; !result && k < noh_check_levels_there(h); k++) {
        const noh_mesh_header *l = &h[k];
        result = check_offsets(check, l, &h[k - 1]);
        if (!result) result = noh_check_texture_shape(check, l);
        if (!result) result = noh_check_indices(check, l);
        if (!result) result = noh_check_submeshes(check, l);
        if (!result) result = noh_check_draws(check, l);
        if (!result) result = check_targets(check, h, l);
        if (!result) result = check_texels(check, h, l);
    }
    return result;
}
