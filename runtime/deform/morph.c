/* morph.c: morph targets on the CPU, the reference that the GPU's accumulators are compared with. Every product and
 * every sum is made in the order of the shaders, so equal inputs give equal bits. */
#include "deform/morph.h"

#include <string.h>

#include "base/math_internal.h"
#include "deform/morph_kernel_internal.h"

static morph_field make_field(unsigned before, unsigned bits, float weight)
{
    morph_field f = { before, 32u - bits, weight };
    return f;
}

/* A delta texel is three words, one for each axis; each word holds the position, the normal and the tangent difference
 * of that axis as two's complement integers, from the top bit down. Shifted left to the top and then right
 * arithmetically, a field is its integer; scale and weight make one factor, as on the GPU, so that CPU and GPU round
 * the same products. */
static void target_fields(const noh_target *t, float weight, morph_field f[3])
{
    f[0] = make_field(0, t->position_bits, t->position_scale * weight);
    f[1] = make_field(t->position_bits, t->normal_bits, t->normal_scale * weight);
    f[2] = make_field((unsigned)t->position_bits + t->normal_bits, t->tangent_bits, t->tangent_scale * weight);
}

typedef void (*run_function)(const uint32_t *words, size_t count, const morph_field f[3], float *const layers[3]);

NOH_ALWAYS_INLINE void run_simd(const uint32_t *words, size_t count, const morph_field f[3], float *const layers[3])
{
    if (layers[2]) {
        noh_add_run(words, count, f, layers, 3);
    } else {
        noh_add_run(words, count, f, layers, 2);
    }
}

/* Every row of every rectangle of one target. The delta texels of a target lie in the order of its rectangles, row by
 * row, so that a row is one run of words in the pack and one run of floats in each layer: the inner loop only streams.
 */
NOH_ALWAYS_INLINE void accumulate_target(const noh_mesh *mesh, const noh_target *t, const morph_field f[3],
                                         const noh_morph_layers *layers, run_function run)
{
    const noh_rect *rect = mesh->rects + t->first_rect;
    const uint32_t *words = mesh->texels + 3u * (size_t)t->first_texel;
    for (uint32_t i = 0; i < t->rect_count; i++, rect++) {
        size_t row = 3u * (((size_t)rect->y << mesh->header->morph_width_log2) + rect->x);
        size_t count = 3u * (size_t)rect->w;
        for (unsigned y = 0; y < rect->h; y++) {
            float *at[3] = { layers->position + row, layers->normal + row,
                             layers->tangent ? layers->tangent + row : NULL };
            run(words, count, f, at);
            words += count;
            row += (size_t)3u << mesh->header->morph_width_log2;
        }
    }
}

#if NOH_ASSERT_LEVEL >= 2
static int all_finite(const float *values, uint32_t count)
{
    uint32_t finite = 0;
    for (uint32_t i = 0; i < count; i++) {
        finite += values[i] - values[i] == 0.0f;
    }
    return finite == count;
}
#endif

NOH_ALWAYS_INLINE void accumulate(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers,
                                  run_function run)
{
    NOH_ASSERT(mesh && weights && layers);
    NOH_ASSERT(layers->position || !mesh->header->touched_count);
    NOH_VALIDATE(all_finite(weights, mesh->header->target_count));
    for (uint32_t i = 0; i < mesh->header->target_count; i++) {
        morph_field f[3];
        if (weights[i] != 0.0f) {
            target_fields(&mesh->targets[i], weights[i], f);
            accumulate_target(mesh, &mesh->targets[i], f, layers, run);
        }
    }
}

/* The benches and tests build this file again for other instruction sets, under other names. */
#ifndef NOH_MORPH_ACCUMULATE
#define NOH_MORPH_ACCUMULATE noh_morph_accumulate
#define NOH_MORPH_ALL 1
#endif

void NOH_MORPH_ACCUMULATE(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers);
void NOH_MORPH_ACCUMULATE(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers)
{
    accumulate(mesh, weights, layers, run_simd);
}

#ifdef NOH_MORPH_ALL

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
    return NOH_MORPH_SIMD;
}

static void run_scalar(const uint32_t *words, size_t count, const morph_field f[3], float *const layers[3])
{
    for (int l = 0; l < 3 && layers[l]; l++) {
        noh_add_run_scalar(words, count, f[l], layers[l]);
    }
}

void noh_morph_accumulate_scalar(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers)
{
    accumulate(mesh, weights, layers, run_scalar);
}

static float round_half(float value, noh_half_mode mode)
{
    return noh_half_to_float(noh_half_from_float(value, mode));
}

static void run_f16_rne(const uint32_t *words, size_t count, const morph_field f[3], float *const layers[3])
{
    for (int l = 0; l < 3 && layers[l]; l++) {
        for (size_t i = 0; i < count; i++) {
            layers[l][i] = round_half(layers[l][i] + noh_field_value(words[i], f[l]), NOH_HALF_RNE);
        }
    }
}

static void run_f16_rtz(const uint32_t *words, size_t count, const morph_field f[3], float *const layers[3])
{
    for (int l = 0; l < 3 && layers[l]; l++) {
        for (size_t i = 0; i < count; i++) {
            layers[l][i] = round_half(layers[l][i] + noh_field_value(words[i], f[l]), NOH_HALF_RTZ);
        }
    }
}

void noh_morph_accumulate_f16(const noh_mesh *mesh, const float *weights, noh_half_mode mode,
                              const noh_morph_layers *layers)
{
    accumulate(mesh, weights, layers, mode == NOH_HALF_RTZ ? run_f16_rtz : run_f16_rne);
}

void noh_morph_round_f16(const noh_mesh *mesh, noh_half_mode mode, const noh_morph_layers *layers)
{
    size_t floats = layer_texels(mesh) * (layers->tangent ? 9u : 6u);
    for (size_t i = 0; i < floats; i++) {
        layers->position[i] = round_half(layers->position[i], mode); /* the layers lie one behind another */
    }
}

void noh_morph_vertex(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t index, noh_vertex *out)
{
    float rest_normal[3], rest_tangent[3];
    const float *p, *n, *t;
    size_t texel = noh_mesh_accumulation_texel(mesh, index);
    noh_mesh_vertex(mesh, index, out);
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

void noh_morph_position(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t index, float out[3])
{
    size_t texel = noh_mesh_accumulation_texel(mesh, index);
    memcpy(out, mesh->positions + 3u * (size_t)index, 3 * sizeof *out);
    for (size_t i = 0; layers && texel < mesh->header->touched_count && i < 3; i++) {
        out[i] += layers->position[3u * texel + i];
    }
}

/* The words of a target's delta at a texel; NULL: it does not move it. */
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
    const uint32_t texel = (uint32_t)noh_mesh_accumulation_texel(mesh, index);
    const uint32_t x = texel & ((1u << mesh->header->morph_width_log2) - 1u);
    const uint32_t y = texel >> mesh->header->morph_width_log2;
    float sum[3] = { 0.0f, 0.0f, 0.0f };
    NOH_ASSERT(mesh && weights && out);
    for (uint32_t t = 0; texel < mesh->header->touched_count && t < mesh->header->target_count; t++) {
        const noh_target *target = &mesh->targets[t];
        const uint32_t *words = weights[t] != 0.0f ? delta_at(mesh, target, x, y) : NULL;
        const morph_field f = make_field(0, target->position_bits, target->position_scale * weights[t]);
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

#endif
