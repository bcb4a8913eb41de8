/* morph_quantise.c: deltas to integers of a few bits, and the error of that.
 *
 * A word holds one axis of one texel: position, normal and tangent, two's
 * complement, from the top. The decoder computes (float)integer * scale, and
 * the errors here are of exactly that product against the source. */
#include "morph_internal.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define WORD_BITS 32u
#define PART_BITS_MAX 24u /* integers stay exact in a float */
#define NORMAL_BITS_MIN 8u
#define TANGENT_BITS_MIN 6u
#define EMPTY_BITS 1u /* of a part that moves nothing */

/* A pair is dropped if its position would be stored as zero anyway (so vertices of a seam, which share a position, are
 * kept or dropped together) and no component of its normal and tangent delta is above this: 0.1 degrees, less than one
 * 8-bit step of a lit surface. */
#define NEGLIGIBLE (1.0f / 512.0f)

/* A pair of the source, for the report: position above this share of the bounding box's diagonal ... */
#define SOURCE_POSITION 1e-6
#define SOURCE_DIRECTION 1e-5f /* ... or a normal or tangent component above this */

static float largest_component(const float *delta, uint32_t vertex_count)
{
    float largest = 0.0f;
    if (!delta) return 0.0f;
    for (size_t i = 0; i < (size_t)vertex_count * MORPH_AXES; i++) {
        const float a = fabsf(delta[i]);
        if (a > largest) largest = a;
    }
    return largest;
}

/* Symmetric: the largest component maps to the largest integer. A scale that a GPU would flush
 * to zero is zero here too. */
static float scale_for(float largest, uint32_t bits)
{
    const uint32_t top = ((uint32_t)1 << (bits - 1u)) - 1u;
    float scale;
    if (top == 0u) return 0.0f;
    scale = (float)((double)largest / (double)top);
    return scale < FLT_MIN ? 0.0f : scale;
}

/* Halves are rounded away from zero, so that mirrored deltas give mirrored integers. */
static int32_t quantise(float value, float scale, uint32_t bits)
{
    const double top = (double)(((uint32_t)1 << (bits - 1u)) - 1u);
    double q;
    if (scale == 0.0f) return 0;
    q = floor(fabs((double)value / (double)scale) + 0.5);
    if (q > top) q = top;
    return value < 0.0f ? -(int32_t)q : (int32_t)q;
}

static double component_error(float value, float scale, uint32_t bits)
{
    const float decoded = (float)quantise(value, scale, bits) * scale;
    return fabs((double)decoded - (double)value);
}

static double length3(const float v[3])
{
    const double x = (double)v[0], y = (double)v[1], z = (double)v[2];
    return sqrt(x * x + y * y + z * z);
}

static double vector_error(const float v[3], float scale, uint32_t bits)
{
    double sum = 0.0;
    for (uint32_t a = 0; a < MORPH_AXES; a++) {
        const double e = component_error(v[a], scale, bits);
        sum += e * e;
    }
    return sqrt(sum);
}

/* The smallest float that is not below x: a certified bound must not be rounded down. */
static float float_above(double x)
{
    float f;
    uint32_t u;
    if (x >= (double)FLT_MAX) return FLT_MAX;
    f = (float)x;
    if ((double)f >= x) return f;
    memcpy(&u, &f, sizeof u);
    u++;
    memcpy(&f, &u, sizeof f);
    return f;
}

/* Largest position error; stops as soon as it is above `enough`. */
static double position_error(const float *delta, uint32_t vertex_count, float scale, uint32_t bits, double enough)
{
    double largest = 0.0;
    for (uint32_t v = 0; v < vertex_count && largest <= enough; v++) {
        const double e = vector_error(delta + (size_t)v * MORPH_AXES, scale, bits);
        if (e > largest) largest = e;
    }
    return largest;
}

static uint32_t choose_position_bits(const float *delta, uint32_t vertex_count, float largest, double error,
                                     uint32_t limit)
{
    uint32_t bits = EMPTY_BITS;
    if (largest == 0.0f) return bits;
    for (; bits < limit; bits++) {
        const float scale = scale_for(largest, bits);
        if (position_error(delta, vertex_count, scale, bits, error) <= error) break;
    }
    return bits;
}

static uint32_t at_most(uint32_t x, uint32_t limit)
{
    return x < limit ? x : limit;
}

/* The bits that positions leave go to the normal and the tangent; a part that moves nothing takes one bit. */
static void split_rest(morph_target *q, int has_normal, int has_tangent)
{
    const uint32_t rest = WORD_BITS - q->position_bits;
    uint32_t normal = EMPTY_BITS, tangent = EMPTY_BITS;
    if (has_normal && has_tangent) {
        normal = (rest + 1u) / 2u;
        if (normal < NORMAL_BITS_MIN) normal = NORMAL_BITS_MIN;
        tangent = rest - normal;
    } else if (has_normal) {
        normal = rest - EMPTY_BITS;
    } else if (has_tangent) {
        tangent = rest - EMPTY_BITS;
    }
    q->normal_bits = (uint8_t)at_most(normal, PART_BITS_MAX);
    q->tangent_bits = (uint8_t)at_most(tangent, PART_BITS_MAX);
}

static uint32_t position_limit(int has_normal, int has_tangent)
{
    uint32_t limit = WORD_BITS;
    limit -= has_normal ? NORMAL_BITS_MIN : EMPTY_BITS;
    limit -= has_tangent ? TANGENT_BITS_MIN : EMPTY_BITS;
    return at_most(limit, PART_BITS_MAX);
}

static int direction_matters(const float *delta, uint32_t vertex, float threshold)
{
    if (!delta) return 0;
    for (uint32_t a = 0; a < MORPH_AXES; a++)
        if (fabsf(delta[(size_t)vertex * MORPH_AXES + a]) > threshold) return 1;
    return 0;
}

static int32_t part_of(const float *delta, uint32_t vertex, uint32_t axis, float scale, uint32_t bits)
{
    return delta ? quantise(delta[(size_t)vertex * MORPH_AXES + axis], scale, bits) : 0;
}

static uint32_t field(int32_t value, uint32_t bits, uint32_t shift)
{
    return ((uint32_t)value & (((uint32_t)1 << bits) - 1u)) << shift;
}

int morph_quantise_pack(const morph_target *q, const model_target *source, uint32_t vertex, uint32_t words[3])
{
    const uint32_t p = q->position_bits, n = q->normal_bits, t = q->tangent_bits;
    uint32_t moves = 0;
    words[0] = words[1] = words[2] = 0;
    for (uint32_t a = 0; a < MORPH_AXES; a++) {
        words[a] = field(part_of(source->position, vertex, a, q->position_scale, p), p, WORD_BITS - p);
        moves |= words[a];
    }
    if (!moves && !direction_matters(source->normal, vertex, NEGLIGIBLE) &&
        !direction_matters(source->tangent, vertex, NEGLIGIBLE))
        return 0;
    for (uint32_t a = 0; a < MORPH_AXES; a++) {
        words[a] |= field(part_of(source->normal, vertex, a, q->normal_scale, n), n, WORD_BITS - p - n);
        words[a] |= field(part_of(source->tangent, vertex, a, q->tangent_scale, t), t, WORD_BITS - p - n - t);
        moves |= words[a];
    }
    return moves != 0;
}

static double decoded_error(uint32_t word, uint32_t shift, uint32_t bits, float scale, float value)
{
    const uint32_t top = (uint32_t)1 << (bits - 1u);
    const uint32_t raw = word >> shift & (((uint32_t)1 << bits) - 1u);
    const int32_t integer = (int32_t)(raw ^ top) - (int32_t)top;
    const float decoded = (float)integer * scale;
    return fabs((double)decoded - (double)value);
}

/* Errors of one vertex, as decoded from its words; e = { position squared, normal, tangent }. */
static void vertex_errors(const morph_target *q, const model_target *s, uint32_t vertex, const uint32_t words[3],
                          double e[3])
{
    const uint32_t p = q->position_bits, n = q->normal_bits, t = q->tangent_bits;
    e[0] = e[1] = e[2] = 0.0;
    for (uint32_t a = 0; a < MORPH_AXES; a++) {
        const size_t i = (size_t)vertex * MORPH_AXES + a;
        const double ep = decoded_error(words[a], WORD_BITS - p, p, q->position_scale,
                                        s->position ? s->position[i] : 0.0f);
        const double en = decoded_error(words[a], WORD_BITS - p - n, n, q->normal_scale,
                                        s->normal ? s->normal[i] : 0.0f);
        const double et = decoded_error(words[a], WORD_BITS - p - n - t, t, q->tangent_scale,
                                        s->tangent ? s->tangent[i] : 0.0f);
        e[0] += ep * ep;
        if (en > e[1]) e[1] = en;
        if (et > e[2]) e[2] = et;
    }
}

static double diagonal(const model_mesh *mesh)
{
    double sum = 0.0;
    if (!mesh->position || mesh->vertex_count == 0u) return 0.0;
    for (uint32_t a = 0; a < MORPH_AXES; a++) {
        double low = (double)mesh->position[a], high = low;
        for (uint32_t v = 1; v < mesh->vertex_count; v++) {
            const double x = (double)mesh->position[(size_t)v * MORPH_AXES + a];
            if (x < low) low = x;
            if (x > high) high = x;
        }
        sum += (high - low) * (high - low);
    }
    return sqrt(sum);
}

/* One pass over the vertices: certified errors, radius, pairs kept and pairs of the source. */
static void certify(const model_mesh *mesh, const model_target *s, morph_target *q)
{
    const double threshold = SOURCE_POSITION * diagonal(mesh);
    double worst[3] = { 0.0, 0.0, 0.0 }, radius = 0.0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        uint32_t words[3];
        double e[3];
        const double moved = s->position ? length3(s->position + (size_t)v * MORPH_AXES) : 0.0;
        if (morph_quantise_pack(q, s, v, words)) q->pair_count++;
        vertex_errors(q, s, v, words, e);
        for (uint32_t i = 0; i < 3u; i++)
            if (e[i] > worst[i]) worst[i] = e[i];
        if (moved > radius) radius = moved;
        if (moved > threshold || direction_matters(s->normal, v, SOURCE_DIRECTION) ||
            direction_matters(s->tangent, v, SOURCE_DIRECTION))
            q->source_pairs++;
    }
    q->position_error = float_above(sqrt(worst[0]));
    q->normal_error = float_above(worst[1]);
    q->tangent_error = float_above(worst[2]);
    q->radius = float_above(radius);
}

void morph_quantise_choose(const model_mesh *mesh, uint32_t t, float error_um, morph_target *out)
{
    const model_target *s = &mesh->targets[t];
    const float position = largest_component(s->position, mesh->vertex_count);
    const float normal = largest_component(s->normal, mesh->vertex_count);
    const float tangent = largest_component(s->tangent, mesh->vertex_count);
    const double error = (double)error_um * 1e-6;
    uint32_t limit = position_limit(normal > 0.0f, tangent > 0.0f);
    memset(out, 0, sizeof *out);
    out->position_bits = (uint8_t)choose_position_bits(s->position, mesh->vertex_count, position, error, limit);
    split_rest(out, normal > 0.0f, tangent > 0.0f);
    out->position_scale = scale_for(position, out->position_bits);
    out->normal_scale = scale_for(normal, out->normal_bits);
    out->tangent_scale = scale_for(tangent, out->tangent_bits);
    certify(mesh, s, out);
}
