/* wire_normal.c: normals, relative to the triangles' normals. */
#include "core/wire/wire_internal.h"

#include <string.h>

#include "core/base/math_internal.h"
#include "core/base/octahedral_internal.h"

static uint32_t first_of(const noh_wire_filter *f, uint32_t v)
{
    return f->mesh.summed == 2 ? f->mesh.twins[v] : v;
}

static void add_triangle(noh_wire_filter *f, const uint32_t t[3])
{
    float p[3][3], u[3], v[3], n[3];
    for (uint32_t i = 0; i < 3u; i++) noh_wire_position(f, t[i], p[i]);
    for (uint32_t i = 0; i < 3u; i++) {
        u[i] = p[1][i] - p[0][i];
        v[i] = p[2][i] - p[0][i];
    }
    n[0] = u[1] * v[2] - u[2] * v[1];
    n[1] = u[2] * v[0] - u[0] * v[2];
    n[2] = u[0] * v[1] - u[1] * v[0];
    for (uint32_t k = 0; k < 3u; k++) {
        float *sum = f->mesh.directions + 3u * (size_t)first_of(f, t[k]);
        for (uint32_t i = 0; i < 3u; i++) sum[i] += n[i];
    }
}

void noh_wire_sum_normals(noh_wire_filter *f, int by_place)
{
    const uint32_t triangles = f->mesh.header.index_count / 3u;
    f->mesh.summed = by_place ? 2u : 1u;
    memset(f->mesh.directions, 0, 12u * (size_t)f->mesh.header.vertex_count);
    for (uint32_t i = 0; i < triangles; i++) {
        const uint32_t t[3] = { noh_wire_index(f, 3u * i), noh_wire_index(f, 3u * i + 1u),
                                noh_wire_index(f, 3u * i + 2u) };
        add_triangle(f, t);
    }
    for (uint32_t v = 0; by_place && v < f->mesh.header.vertex_count; v++) {
        memcpy(f->mesh.directions + 3u * (size_t)v, f->mesh.directions + 3u * (size_t)f->mesh.twins[v], 12u);
    }
}

/* ---- octahedral ---- */

static int32_t rounded(float x)
{
    return x >= 0.0f ? (int32_t)(x + 0.5f) : -(int32_t)(0.5f - x);
}

/* The inverse of noh_octahedral_unfold, in steps of 1. */
static void fold(const float n[3], float steps, int32_t out[2])
{
    float x = n[0], y = n[1];
    const float size = (x < 0.0f ? -x : x) + (y < 0.0f ? -y : y) + (n[2] < 0.0f ? -n[2] : n[2]);
    if (!(size > 1e-30f) || !(size < 1e30f)) {
        out[0] = out[1] = 0;
        return;
    }
    x /= size;
    y /= size;
    if (n[2] < 0.0f) {
        const float u = (1.0f - (y < 0.0f ? -y : y)) * (x >= 0.0f ? 1.0f : -1.0f);
        y = (1.0f - (x < 0.0f ? -x : x)) * (y >= 0.0f ? 1.0f : -1.0f);
        x = u;
    }
    out[0] = rounded(x * steps);
    out[1] = rounded(y * steps);
}

static int32_t signed_half(uint32_t word, uint32_t shift)
{
    return (int32_t)(word << (16u - shift)) >> 16;
}

static void guess_of(const noh_wire_filter *f, uint32_t v, int32_t steps, int32_t guess[2])
{
    const noh_wire_near n = noh_wire_near_of(f, v);
    const uint64_t base = (uint64_t)f->mesh.chunk + f->mesh.header.attributes_offset;
    const uint32_t stride = f->mesh.header.attribute_stride;
    if (f->section.mode) {
        fold(f->mesh.directions + 3u * (size_t)v, (float)steps, guess);
        return;
    }
    for (uint32_t i = 0; i < 2u; i++) {
        int64_t sum = 0;
        for (uint32_t k = 0; k < n.count; k++) {
            const uint32_t word = noh_wire_load(f, base + (uint64_t)n.vertex[k] * stride);
            sum += (int64_t)n.sign[k] * noh_wire_steps(signed_half(word, 16u * i), 32767, steps);
        }
        guess[i] = noh_wire_mean(&n, sum);
    }
}

static void code_normal(noh_wire_filter *f, uint32_t v)
{
    const int32_t steps = (int32_t)(f->section.params[0] & 0x7fffu);
    const uint64_t at = (uint64_t)f->mesh.chunk + f->mesh.header.attributes_offset +
                        (uint64_t)v * f->mesh.header.attribute_stride;
    const uint32_t old = noh_wire_load(f, at);
    uint32_t word = 0, before = 0;
    int32_t guess[2];
    guess_of(f, v, steps, guess);
    for (uint32_t i = 0; i < 2u; i++) {
        const int32_t value = noh_wire_steps(signed_half(old, 16u * i), 32767, steps);
        const int32_t residual = noh_wire_residual(f, 16u * i + (before > 1u ? 8u : 0u), noh_wire_activity(f, i),
                                                   (int32_t)((uint32_t)value - (uint32_t)guess[i]));
        noh_wire_note(f, i, residual);
        before = noh_wire_magnitude(residual);
        word |= ((uint32_t)noh_wire_steps((int32_t)((uint32_t)guess[i] + (uint32_t)residual), steps, 32767) & 0xffffu)
                << 16u * i;
    }
    noh_wire_store(f, at, word);
}

/* mode 0: as a parallelogram; 1, 2: relative to the sums by vertex or by place. params: steps of a half */
int noh_wire_run_normals(noh_wire_filter *f)
{
    if (!(f->section.params[0] & 0x7fffu)) return noh_wire_wrong(f, "normals have no steps");
    if (f->section.mode && f->mesh.summed != f->section.mode) noh_wire_sum_normals(f, f->section.mode == 2);
    for (; f->cursor[0] < f->mesh.order_count; f->cursor[0]++) {
        if (!noh_wire_item(&f->coder)) return 0;
        code_normal(f, f->mesh.order[f->cursor[0]]);
    }
    return 1;
}
