/* morph_finish.c: final vertices from accumulated layers.
 *
 * A direction need not be unit to be mapped to the octahedron, and a tangent needs no unit normal to be made
 * perpendicular: t - n (t.n / n.n). Only the length of the bind pose's directions counts, because deltas are added to
 * unit directions. */
#include "deform/morph/morph_finish_internal.h"

#include <string.h>

#include "core/base/math_internal.h"
#include "core/base/octahedral_internal.h"
#include "core/base/assert_internal.h"
#include "noh/format.h"
#include "noh/pack.h"
#include "noh/low_core.h"
#include "noh/deform.h"

uint32_t noh_morph_finished_stride(const noh_mesh *mesh)
{
    NOH_ASSERT(mesh && mesh->header);
    return mesh->header->flags & NOH_MESH_TANGENTS ? 20u : 16u;
}

/* ---- plain C ---- */

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static float with_sign_of(float x, float sign)
{
    const uint32_t bits = bits_of(x) ^ (bits_of(sign) & 0x80000000u);
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* The pair of a direction that is not 0, each number in -1..1: the inverse of noh_octahedral_unfold. */
static void fold(const float v[3], float pair[2])
{
    const float inverse = 1.0f / (noh_abs(v[0]) + noh_abs(v[1]) + noh_abs(v[2]));
    const float x = v[0] * inverse, y = v[1] * inverse;
    pair[0] = v[2] < 0.0f ? with_sign_of(1.0f - noh_abs(y), x) : x;
    pair[1] = v[2] < 0.0f ? with_sign_of(1.0f - noh_abs(x), y) : y;
}

/* Add a delta to a direction of the pack, scaled by the length of the pack's direction: not unit. */
static void move(float out[3], const float *delta)
{
    const float length = noh_sqrt(noh_dot3(out, out));
    for (int i = 0; i < 3; i++) out[i] = out[i] + (delta ? delta[i] : 0.0f) * length;
}

static void unfold_normal(uint32_t word, float out[3])
{
    noh_octahedral_unfold((float)((int32_t)(word << 16) >> 16) * (1.0f / 32767.0f),
                          (float)((int32_t)word >> 16) * (1.0f / 32767.0f), out);
}

static void unfold_tangent(uint32_t word, float out[3])
{
    noh_octahedral_unfold((float)((int32_t)(word << 16) >> 16) * (1.0f / 32767.0f),
                          (float)((int32_t)word >> 17) * (1.0f / 16383.0f), out);
}

static uint32_t normal_word(const float v[3])
{
    float pair[2];
    fold(v, pair);
    return (bits_of(pair[0] * 32767.0f + NOH_ROUNDER) & 0xffffu) | bits_of(pair[1] * 32767.0f + NOH_ROUNDER) << 16;
}

static uint32_t tangent_word(const float v[3], uint32_t handedness)
{
    float pair[2];
    fold(v, pair);
    return (bits_of(pair[0] * 32767.0f + NOH_ROUNDER) & 0xffffu) | bits_of(pair[1] * 16383.0f + NOH_ROUNDER) << 17 |
           (handedness & 0x10000u);
}

static int is_direction(float square)
{
    return square > NOH_VANISHES && square < NOH_OVERFLOWS;
}

/* The words of a vertex's normal and tangent, with deltas. A direction that vanishes or overflows becomes the bind
 * pose's. */
static void morph_words(uint32_t words[2], const float *normal_delta, const float *tangent_delta, int has_tangents)
{
    float n[3], t[3], square;
    unfold_normal(words[0], n);
    move(n, normal_delta);
    square = noh_dot3(n, n);
    if (is_direction(square)) {
        words[0] = normal_word(n);
    } else {
        unfold_normal(words[0], n);
        square = noh_dot3(n, n);
    }
    if (has_tangents) {
        float along;
        unfold_tangent(words[1], t);
        move(t, tangent_delta);
        along = noh_dot3(t, n) / square;
        for (int i = 0; i < 3; i++) t[i] = t[i] - n[i] * along;
        if (is_direction(noh_dot3(t, t))) words[1] = tangent_word(t, words[1]);
    }
}

/* Finish one vertex. texel: index of its deltas; beyond the last one: none */
static void finish_one(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t v, uint32_t texel, uint8_t *out)
{
    const uint8_t *record = mesh->attributes + (size_t)v * mesh->header->attribute_stride;
    const int has_tangents = (mesh->header->flags & NOH_MESH_TANGENTS) != 0;
    const size_t at = 3u * (size_t)texel;
    float position[3];
    uint32_t words[2] = { 0, 0 };
    memcpy(position, mesh->positions + 3u * (size_t)v, sizeof position);
    memcpy(words, record, has_tangents ? 8u : 4u);
    if (layers && texel < mesh->header->touched_count) {
        for (int i = 0; i < 3; i++) position[i] += layers->position[at + (size_t)i];
        morph_words(words, layers->normal + at, layers->tangent ? layers->tangent + at : NULL, has_tangents);
    }
    memcpy(out, position, sizeof position);
    memcpy(out + 12, words, has_tangents ? 8u : 4u);
}

void noh_morph_finish_scalar(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count,
                             void *out)
{
    NOH_ASSERT(first <= mesh->header->vertex_count && count <= mesh->header->vertex_count - first && (out || !count));
    const uint32_t stride = noh_morph_finished_stride(mesh);
    for (uint32_t i = 0; i < count; i++) {
        finish_one(mesh, layers, first + i, noh_mesh_accumulation_texel(mesh, first + i),
                   (uint8_t *)out + (size_t)i * stride);
    }
}

/* ---- lanes ---- */

#if NOH_LANES > 1
#include "deform/morph/morph_finish_template.h"

void noh_morph_finish(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count, void *out)
{
    lanes_finish(mesh, layers, first, count, out);
}
#else
void noh_morph_finish(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count, void *out)
{
    noh_morph_finish_scalar(mesh, layers, first, count, out);
}
#endif
