/* wire_vertex.c: what each vertex has, in the order in which triangles come to them.
 *
 * A vertex is predicted from the triangle that it was reached from: the two ends of the edge less the vertex on its
 * other side, so that four vertices make a parallelogram.
 * source  Touma, Gotsman: Triangle mesh compression, 1998 */
#include "core/wire/wire_internal.h"

#include <string.h>

#include "core/base/math_internal.h"
#include "noh/base.h"
#include "noh/format.h"

/* ---- positions ---- */

#define PARAM_ORIGIN 0 /* float[3] */
#define PARAM_STEP 3
#define MODEL_TWIN 96u
#define MODEL_TWIN_PLACE 104u

static float param_float(const noh_wire_filter *f, uint32_t i)
{
    float value;
    memcpy(&value, &f->section.params[i], sizeof value);
    return value;
}

/* Floats as integers in the same order. */
static int32_t ordered(uint32_t bits)
{
    return (int32_t)(bits & 0x80000000u ? ~(bits & 0x7fffffffu) : bits);
}

static uint32_t unordered(int32_t value)
{
    return value < 0 ? ~(uint32_t)value | 0x80000000u : (uint32_t)value;
}

static uint64_t position_at(const noh_wire_filter *f, uint32_t v)
{
    return (uint64_t)f->mesh.chunk + f->mesh.header.positions_offset + 12u * (uint64_t)v;
}

static int32_t to_grid(float x, float origin, float step)
{
    const float q = (x - origin) / step + 0.5f;
    return q >= 0.0f && q < 16777216.0f ? (int32_t)q : 0;
}

/* In place of positions the grid has what they are predicted from: steps, or floats as ordered integers. */
static void load_grid(noh_wire_filter *f, uint32_t v)
{
    for (uint32_t i = 0; i < 3u; i++) {
        const uint32_t word = noh_wire_load(f, position_at(f, v) + 4u * i);
        float x;
        memcpy(&x, &word, sizeof x);
        f->mesh.grid[3u * (size_t)v + i] = f->section.mode ? to_grid(x, param_float(f, PARAM_ORIGIN + i),
                                                                     param_float(f, PARAM_STEP))
                                                           : ordered(word);
    }
}

static void store_grid(noh_wire_filter *f, uint32_t v)
{
    for (uint32_t i = 0; i < 3u; i++) {
        const int32_t q = f->mesh.grid[3u * (size_t)v + i];
        const float x = param_float(f, PARAM_ORIGIN + i) + param_float(f, PARAM_STEP) * (float)q;
        uint32_t word;
        memcpy(&word, &x, sizeof word);
        noh_wire_store(f, position_at(f, v) + 4u * i, f->section.mode ? word : unordered(q));
    }
}

/* Predict floats as floats: one step of their integers is smaller near 0. */
static int32_t predict_float(const noh_wire_filter *f, const noh_wire_near *n, uint32_t i)
{
    float sum = 0.0f;
    uint32_t bits;
    for (uint32_t k = 0; k < n->count; k++) {
        float value;
        bits = unordered(f->mesh.grid[3u * (size_t)n->vertex[k] + i]);
        memcpy(&value, &bits, sizeof value);
        sum += n->sign[k] > 0 ? value : -value;
    }
    sum /= (float)n->divisor;
    if (!noh_is_finite(sum)) return 0;
    memcpy(&bits, &sum, sizeof bits);
    return ordered(bits);
}

static int32_t predict_grid(const noh_wire_filter *f, const noh_wire_near *n, uint32_t i)
{
    int64_t sum = 0;
    for (uint32_t k = 0; k < n->count; k++) sum += (int64_t)n->sign[k] * f->mesh.grid[3u * (size_t)n->vertex[k] + i];
    return noh_wire_mean(n, sum);
}

static void code_position(noh_wire_filter *f, uint32_t v)
{
    const noh_wire_near n = noh_wire_near_of(f, v);
    int32_t *grid = f->mesh.grid;
    uint32_t before = 0;
    for (uint32_t i = 0; i < 3u; i++) {
        int32_t *value = grid + 3u * (size_t)v + i;
        const int32_t guess = f->section.mode ? predict_grid(f, &n, i) : predict_float(f, &n, i);
        const uint32_t model = 16u * i + (n.across == NOH_NONE ? 64u : before > 15u ? 8u : 0u);
        const int32_t residual = noh_wire_residual(f, model, noh_wire_activity(f, i),
                                                   (int32_t)((uint32_t)*value - (uint32_t)guess));
        *value = (int32_t)((uint32_t)guess + (uint32_t)residual);
        noh_wire_note(f, i, residual);
        before = noh_wire_magnitude(residual);
    }
}

/* Whether the vertex lies where one before it lies, which is then named by its place in the order, counted from where
 * the last such one was: along a seam both sides go on side by side. Writing, the plan has 1 + that place. */
static int code_twin(noh_wire_filter *f, uint32_t v)
{
    const uint32_t now = f->cursor[0], plan = f->plan ? f->plan[now] : 0u;
    const uint32_t context = f->cursor[1] + (f->mesh.around[3u * (size_t)v + 2u] == NOH_NONE ? 2u : 0u);
    const uint32_t twin = noh_wire_symbol(&f->coder, &f->models[MODEL_TWIN + context], plan ? 1u : 0u);
    f->cursor[1] = twin ? 1u : 0u;
    if (twin) {
        const uint32_t place = f->cursor[2] +
                               (uint32_t)noh_wire_residual(f, MODEL_TWIN_PLACE, 0, (int32_t)(plan - 1u - f->cursor[2]));
        f->cursor[2] = place < now ? place : 0u;
        memcpy(f->mesh.grid + 3u * (size_t)v, f->mesh.grid + 3u * (size_t)f->mesh.order[f->cursor[2]], 12u);
    }
    return twin != 0u;
}

int noh_wire_run_positions(noh_wire_filter *f)
{
    for (; f->cursor[0] < f->mesh.order_count; f->cursor[0]++) {
        const uint32_t v = f->mesh.order[f->cursor[0]];
        if (!noh_wire_item(&f->coder)) return 0;
        if (noh_wire_writes(f)) load_grid(f, v);
        if (!code_twin(f, v)) code_position(f, v);
        store_grid(f, v);
    }
    return 1;
}

/* ---- words of a vertex ---- */

static uint64_t attribute_at(const noh_wire_filter *f, uint32_t v)
{
    return (uint64_t)f->mesh.chunk + f->mesh.header.attributes_offset + f->section.stride +
           (uint64_t)v * f->mesh.header.attribute_stride;
}

typedef struct field {
    uint32_t shift, mask;
    int32_t whole, steps;
    int is_signed;
} field;

static field field_of(const noh_wire_filter *f, uint32_t i)
{
    const uint32_t p = f->section.params[2u * i], bits = p >> 8 & 31u;
    field result;
    result.shift = p & 31u;
    result.mask = (1u << bits) - 1u;
    result.is_signed = (int)(p >> 16 & 1u);
    result.whole = (int32_t)(result.is_signed ? result.mask >> 1 : result.mask);
    result.steps = (int32_t)(f->section.params[2u * i + 1u] & 0xfffffu);
    if (!result.whole) result.whole = 1;
    if (!result.steps) result.steps = 1;
    return result;
}

static int32_t field_value(const field *d, uint32_t word)
{
    const uint32_t raw = word >> d->shift & d->mask;
    const int32_t value = d->is_signed && raw > d->mask >> 1 ? (int32_t)raw - (int32_t)d->mask - 1 : (int32_t)raw;
    return noh_wire_steps(value, d->whole, d->steps);
}

static uint32_t field_word(const field *d, int32_t value)
{
    return ((uint32_t)noh_wire_steps(value, d->steps, d->whole) & d->mask) << d->shift;
}

static int32_t word_guess(const noh_wire_filter *f, const noh_wire_near *n, const field *d)
{
    int64_t sum = 0;
    if (f->section.mode & 1u) {
        noh_wire_near edge = *n;
        edge.across = NOH_NONE;
        return noh_wire_predict(&edge, n->a == NOH_NONE ? 0 : field_value(d, noh_wire_load(f, attribute_at(f, n->a))),
                                n->b == NOH_NONE ? 0 : field_value(d, noh_wire_load(f, attribute_at(f, n->b))), 0);
    }
    for (uint32_t k = 0; k < n->count; k++) {
        sum += (int64_t)n->sign[k] * field_value(d, noh_wire_load(f, attribute_at(f, n->vertex[k])));
    }
    return noh_wire_mean(n, sum);
}

/* mode, bit 0: as the mean of an edge, else as parallelograms; bit 1: the second and third field turn out as that
 * before them did, as red, green and blue do. params: for each field, up to 4, its shift | bits << 8 | sign << 16 and
 * its steps. */
static void code_word(noh_wire_filter *f, uint32_t v)
{
    const noh_wire_near n = noh_wire_near_of(f, v);
    uint32_t word = 0, before = 0;
    int32_t carried = 0;
    const uint32_t old = noh_wire_load(f, attribute_at(f, v));
    for (uint32_t i = 0; i < 4u && f->section.params[2u * i]; i++) {
        const field d = field_of(f, i);
        const int32_t guess = (int32_t)((uint32_t)word_guess(f, &n, &d) + (uint32_t)carried),
                      value = field_value(&d, old);
        const uint32_t model = 32u * i + (n.across == NOH_NONE ? 16u : 0u) + (before > 3u ? 8u : 0u);
        const int32_t residual = noh_wire_residual(f, model, noh_wire_activity(f, i),
                                                   (int32_t)((uint32_t)value - (uint32_t)guess));
        word |= field_word(&d, (int32_t)((uint32_t)guess + (uint32_t)residual));
        noh_wire_note(f, i, residual);
        before = noh_wire_magnitude(residual);
        carried = (f->section.mode & 2u) && i < 2u ? (int32_t)((uint32_t)carried + (uint32_t)residual) : 0;
    }
    noh_wire_store(f, attribute_at(f, v), word);
}

int noh_wire_run_column(noh_wire_filter *f)
{
    for (; f->cursor[0] < f->mesh.order_count; f->cursor[0]++) {
        if (!noh_wire_item(&f->coder)) return 0;
        code_word(f, f->mesh.order[f->cursor[0]]);
    }
    return 1;
}

/* ---- references to texels ---- */

/* Most are one after the one before, or none: those are symbols. */
int noh_wire_run_texel_refs(noh_wire_filter *f)
{
    const uint32_t count = f->mesh.header.vertex_count;
    for (; f->cursor[0] < count; f->cursor[0]++) {
        const uint64_t at = attribute_at(f, f->cursor[0]);
        const uint32_t word = noh_wire_load(f, at);
        const uint32_t next = f->cursor[1];
        uint32_t symbol = word == next ? 0u : word == NOH_TEXEL_NONE ? 1u : 2u, result;
        if (!noh_wire_item(&f->coder)) return 0;
        symbol = noh_wire_symbol(&f->coder, &f->models[8u + f->cursor[2]], symbol);
        result = symbol == 0u   ? next
                 : symbol == 1u ? NOH_TEXEL_NONE
                                : next + (uint32_t)noh_wire_residual(f, 0, 0, (int32_t)(word - next));
        f->cursor[2] = symbol < 2u ? symbol : 2u;
        if (symbol != 1u) f->cursor[1] = result + 1u;
        noh_wire_store(f, at, result);
    }
    return 1;
}
