/* morph.c: morph targets on the CPU, the reference for the GPU's accumulators. Products and sums have the same order as
 * in the shaders, so equal inputs give equal bits. */
#include "core/base/name_internal.h"
#include "core/base/assert_internal.h"
#include "core/base/compiler_internal.h"
#include "deform/morph/morph_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"

#include <string.h>

#include "core/base/math_internal.h"
#include "deform/morph/morph_accumulate_internal.h"
#include "deform/morph/morph_finish_internal.h"
#include "core/base/half_internal.h"
#include "core/mesh/mesh_internal.h"

void noh_morph_accumulate(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers)
{
    noh_accumulate_targets(mesh, weights, layers, NULL, noh_add_rows);
}

static void accumulate_some(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers,
                            const uint8_t *groups)
{
    noh_accumulate_targets(mesh, weights, layers, groups, noh_add_rows);
}

/* Kernels that need not be fast are called, not inlined. */
NOH_NEVER_INLINE static void accumulate_by(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers,
                                           const uint8_t *groups, noh_rows_function add)
{
    noh_accumulate_targets(mesh, weights, layers, groups, add);
}

static size_t layer_texels(const noh_mesh *mesh)
{
    return (size_t)mesh->header->morph_height << mesh->header->morph_width_log2;
}

size_t noh_morph_layers_size(const noh_mesh *mesh)
{
    NOH_ASSERT(mesh && mesh->header);
    return layer_texels(mesh) * 9u * sizeof(float);
}

noh_result noh_morph_layers_init(void *memory, size_t bytes, const noh_mesh *mesh, noh_morph_layers *layers,
                                 noh_error *error)
{
    const size_t floats = layer_texels(mesh) * 3u, need = noh_morph_layers_size(mesh);
    NOH_ASSERT(layers);
    if (need) {
        noh_arena arena;
        const noh_result result = noh_arena_open(&arena, memory, bytes, need, error);
        if (result) {
            return result;
        }
        memset(memory, 0, need);
    }
    layers->position = need ? (float *)memory : NULL;
    layers->normal = need ? layers->position + floats : NULL;
    layers->tangent = need ? layers->normal + floats : NULL;
    return NOH_OK;
}

const char *noh_morph_simd(void)
{
    return NOH_SIMD_NAME;
}

void noh_morph_accumulate_scalar(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers)
{
    accumulate_by(mesh, weights, layers, NULL, noh_add_rows_scalar);
}

static void accumulate_some_scalar(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers,
                                   const uint8_t *groups)
{
    accumulate_by(mesh, weights, layers, groups, noh_add_rows_scalar);
}

/* ---- kernels by name ---- */

/* Wrappers in this file: in position-independent code, the address of a function in another file is read from a table
 * that the linker must be able to write. */

static void finish(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count, void *out)
{
    noh_morph_finish(mesh, layers, first, count, out);
}

static void finish_scalar(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count,
                          void *out)
{
    noh_morph_finish_scalar(mesh, layers, first, count, out);
}

#ifdef NOH_AVX2_AT_RUN_TIME
static void accumulate_wide(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers)
{
    noh_morph_accumulate_wide(mesh, weights, layers);
}

static void accumulate_some_wide(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers,
                                 const uint8_t *groups)
{
    noh_morph_accumulate_some_wide(mesh, weights, layers, groups);
}

static void finish_wide(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count, void *out)
{
    noh_morph_finish_wide(mesh, layers, first, count, out);
}
#endif

noh_result noh_morph_kernel_find(const char *name, noh_morph_kernel *kernel, noh_error *error)
{
    const noh_morph_kernel kernels[] = {
#ifdef NOH_AVX2_AT_RUN_TIME
        { "avx2", noh_processor_has_avx2() ? accumulate_wide : NULL, accumulate_some_wide, finish_wide },
#endif
        { NOH_SIMD_NAME, noh_morph_accumulate, accumulate_some, finish },
        { "scalar", noh_morph_accumulate_scalar, accumulate_some_scalar, finish_scalar },
    };
    NOH_ASSERT(kernel);
    for (size_t i = 0; i < sizeof kernels / sizeof kernels[0]; i++) {
        if (kernels[i].accumulate && (!name || noh_names_equal(name, kernels[i].name))) {
            *kernel = kernels[i];
            return NOH_OK;
        }
    }
    return noh_fail(error, NOH_ERR_UNSUPPORTED,
                    "no kernel of that name on this processor or in this build: use scalar, or NULL for the fastest", 0,
                    0);
}

static void row_f16_rne(const uint32_t *words, size_t count, const morph_field f[3], float *const layers[3])
{
    for (int l = 0; l < 3 && layers[l]; l++) {
        for (size_t i = 0; i < count; i++) {
            layers[l][i] = noh_half_round(layers[l][i] + noh_field_value(words[i], f[l]), NOH_HALF_RNE);
        }
    }
}

static void row_f16_rtz(const uint32_t *words, size_t count, const morph_field f[3], float *const layers[3])
{
    for (int l = 0; l < 3 && layers[l]; l++) {
        for (size_t i = 0; i < count; i++) {
            layers[l][i] = noh_half_round(layers[l][i] + noh_field_value(words[i], f[l]), NOH_HALF_RTZ);
        }
    }
}

static void row_f16_rtz_rne(const uint32_t *words, size_t count, const morph_field f[3], float *const layers[3])
{
    for (int l = 0; l < 3 && layers[l]; l++) {
        for (size_t i = 0; i < count; i++) {
            const float added = noh_half_round(noh_field_value(words[i], f[l]), NOH_HALF_RTZ);
            layers[l][i] = noh_half_round(layers[l][i] + added, NOH_HALF_RNE);
        }
    }
}

static void add_f16_rne(const noh_morph_rows *rows, const morph_field f[3], float *const layers[3])
{
    noh_each_row(rows, f, layers, row_f16_rne);
}

static void add_f16_rtz(const noh_morph_rows *rows, const morph_field f[3], float *const layers[3])
{
    noh_each_row(rows, f, layers, row_f16_rtz);
}

static void add_f16_rtz_rne(const noh_morph_rows *rows, const morph_field f[3], float *const layers[3])
{
    noh_each_row(rows, f, layers, row_f16_rtz_rne);
}

void noh_morph_accumulate_f16(const noh_mesh *mesh, const float *weights, noh_half_mode mode,
                              const noh_morph_layers *layers)
{
    accumulate_by(mesh, weights, layers, NULL,
                  mode == NOH_HALF_RTZ       ? add_f16_rtz
                  : mode == NOH_HALF_RTZ_RNE ? add_f16_rtz_rne
                                             : add_f16_rne);
}

void noh_morph_round_f16(const noh_mesh *mesh, noh_half_mode mode, const noh_morph_layers *layers)
{
    size_t floats = layer_texels(mesh) * (layers->tangent ? 9u : 6u);
    for (size_t i = 0; i < floats; i++) {
        layers->position[i] = noh_half_round(layers->position[i], mode); /* the layers are contiguous */
    }
}

void noh_morph_vertex(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t index, noh_vertex *out)
{
    float rest_normal[3], rest_tangent[3];
    const float *p, *n, *t;
    size_t texel = noh_mesh_accumulation_texel(mesh, index);
    noh_mesh_vertex(mesh, index, out);
    noh_morph_uv(mesh, layers, index, out->uv);
    if (texel >= mesh->header->touched_count) {
        return;
    }
    p = layers->position + 3u * texel;
    n = layers->normal + 3u * texel;
    t = layers->tangent ? layers->tangent + 3u * texel : NULL;
    memcpy(rest_normal, out->normal, sizeof rest_normal);
    memcpy(rest_tangent, out->tangent, sizeof rest_tangent);
    for (int i = 0; i < 3; i++) {
        out->position[i] += p[i];
        out->normal[i] += n[i];
        out->tangent[i] += t ? t[i] : 0.0f;
    }
    noh_normalize3(out->normal, rest_normal);
    if (mesh->header->flags & NOH_MESH_TANGENTS) {
        float along = noh_dot3(out->tangent, out->normal);
        for (int i = 0; i < 3; i++) {
            out->tangent[i] -= along * out->normal[i];
        }
        noh_normalize3(out->tangent, rest_tangent);
    }
}

void noh_morph_uv(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t index, float uv[2])
{
    const size_t texel = noh_mesh_uv_texel(mesh, index);
    NOH_ASSERT(layers && uv);
    for (size_t i = 0; texel < mesh->header->touched_count && i < 2; i++) {
        uv[i] += layers->position[3u * texel + i] * mesh->header->uv_per_unit;
    }
}

void noh_morph_position(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t index, float out[3])
{
    size_t texel = noh_mesh_accumulation_texel(mesh, index);
    memcpy(out, mesh->positions + 3u * (size_t)index, 3 * sizeof *out);
    for (size_t i = 0; layers && texel < mesh->header->touched_count && i < 3; i++) {
        out[i] += layers->position[3u * texel + i];
    }
}

/* The words of a target's delta at a texel; NULL if the target does not move the texel. */
static const uint32_t *delta_at(const noh_mesh *mesh, const noh_target *t, uint32_t x, uint32_t y)
{
    const noh_rect *rect = mesh->rects + t->first_rect;
    const uint32_t *words = mesh->texels + 3u * (size_t)t->first_texel;
    for (uint32_t i = 0; i < t->rect_count; i++, rect++) {
        if (x - rect->x < rect->w && y - rect->y < rect->h) {
            return words + 3u * ((size_t)(y - rect->y) * rect->w + (x - rect->x));
        }
        words += 3u * (size_t)rect->w * rect->h;
    }
    return NULL;
}

void noh_morph_position_by(const noh_mesh *mesh, const float *weights, uint32_t index, float out[3])
{
    NOH_ASSERT(mesh && weights && out);
    const uint32_t texel = (uint32_t)noh_mesh_accumulation_texel(mesh, index);
    const uint32_t x = texel & ((1u << mesh->header->morph_width_log2) - 1u);
    const uint32_t y = texel >> mesh->header->morph_width_log2;
    float sum[3] = { 0.0f, 0.0f, 0.0f };
    for (uint32_t t = 0; texel < mesh->header->touched_count && t < mesh->header->target_count; t++) {
        const noh_target *target = &mesh->targets[t];
        const uint32_t *words = weights[t] != 0.0f ? delta_at(mesh, target, x, y) : NULL;
        const morph_field f = noh_make_field(0, target->position_bits, target->position_scale * weights[t]);
        for (int i = 0; words && i < 3; i++) sum[i] = sum[i] + noh_field_value(words[i], f);
    }
    memcpy(out, mesh->positions + 3u * (size_t)index, 3 * sizeof *out);
    for (int i = 0; i < 3 && texel < mesh->header->touched_count; i++) out[i] += sum[i];
}

noh_morph_cost noh_morph_cost_of(const noh_mesh *mesh, const float *weights)
{
    noh_morph_cost cost = { 0, 0, 0, 0 };
    for (uint32_t i = 0; i < mesh->header->target_count; i++) {
        const noh_target *t = &mesh->targets[i];
        if (weights[i] != 0.0f && t->rect_count) {
            cost.targets += 1;
            cost.rects += t->rect_count;
            cost.texels += t->texel_count;
            cost.pairs += t->pair_count;
        }
    }
    return cost;
}
