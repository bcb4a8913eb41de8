#include "motion/clip/clip_synth_internal.h"

#include <string.h>

#include "core/base/simd_internal.h"
#include "core/base/compiler_internal.h"
#include "noh/low_motion.h"

#define QUAT_ONE 32767.0f
#define HALF_ROOT 0.70710678f
#define COSINE_TERMS 12u

/* cos(pi m / (2 n)), 0 <= m <= n: Taylor's series in double; 12 terms leave an error below 1e-16 up to pi / 2. */
static double quarter_cosine(uint32_t m, uint32_t n)
{
    const double x = 1.57079632679489661923 * (double)m / (double)n;
    double sum = 0.0;
    if (m == n) {
        return 0.0;
    }
    for (uint32_t term = COSINE_TERMS; term > 0u; term--) {
        const double k = 2.0 * (double)term;
        sum = (1.0 + sum) * (-(x * x) / (k * (k - 1.0)));
    }
    return 1.0 + sum;
}

/* cos(pi m / (2 n)) for every m: folded into the first quarter of the turn by its symmetries, in integers, so that rows
 * are exactly even or odd about their middle. */
static double basis_cosine(uint32_t m, uint32_t n)
{
    m %= 4u * n;
    if (m > 2u * n) {
        m = 4u * n - m;
    }
    return m <= n ? quarter_cosine(m, n) : -quarter_cosine(2u * n - m, n);
}

/* The square root of a number in float range, by Newton's method from the float's root. */
static double root(double x)
{
    double r = (double)noh_sqrt((float)x);
    r = 0.5 * (r + x / r);
    return 0.5 * (r + x / r);
}

/* The sum over all frames of a product of two rows of the same symmetry, given their first halves. */
static double product_of(const double *a, const double *b, uint32_t frames)
{
    double sum = 0.0;
    for (uint32_t f = 0; f < frames / 2u; f++) {
        sum += 2.0 * a[f] * b[f];
    }
    return frames % 2u ? sum + a[frames / 2u] * b[frames / 2u] : sum;
}

/* The even or the odd rows of the transform that begins with a parabola. Motion does not stop at the end of a segment:
 * the DCT mirrors it there, and the kink in its slope keeps coefficients large up to the highest frequencies. After x
 * and x^2 are removed, a smooth motion has no slope at either end.
 *
 * Gram-Schmidt in closed form: `rest` is what remains of the power (x or x^2) after the cosines so far, which are
 * already orthogonal to each other; so each new cosine only has to be made orthogonal to `rest`. */
static void build_parabola(uint32_t frames, uint32_t odd, float *rows)
{
    const uint32_t half = noh_clip_basis_half(frames), middle = (frames + 1u) / 2u;
    const double scale = root(2.0 / (double)frames);
    double rest[(NOH_CLIP_SEGMENT_FRAMES_MAX + 1u) / 2u] = { 0.0 };
    double cosine[(NOH_CLIP_SEGMENT_FRAMES_MAX + 1u) / 2u] = { 0.0 }, size, mean;
    for (uint32_t f = 0; f < middle; f++) {
        const double x = (double)frames - 1.0 - 2.0 * (double)f;
        rest[f] = odd ? x : x * x;
        cosine[f] = 1.0 / (double)frames;
    }
    mean = odd ? 0.0 : product_of(rest, cosine, frames);
    for (uint32_t f = 0; f < middle; f++) {
        rest[f] -= mean;
    }
    for (uint32_t k = odd ? 1u : 2u; k < frames; k += 2u) {
        const uint32_t frequency = k - 2u; /* wraps if k is 1: the power itself, as for k 2 */
        const double square = product_of(rest, rest, frames);
        if (k <= 2u) {
            size = 1.0 / root(square);
            for (uint32_t f = 0; f < middle; f++) {
                rows[k * half + f] = (float)(size * rest[f]);
            }
            continue;
        }
        for (uint32_t f = 0; f < middle; f++) {
            cosine[f] = scale * basis_cosine((2u * f + 1u) * frequency, frames);
        }
        mean = product_of(cosine, rest, frames);
        size = 1.0 / root(1.0 - mean * mean / square);
        for (uint32_t f = 0; f < middle; f++) {
            rows[k * half + f] = (float)(size * (cosine[f] - mean / square * rest[f]));
            rest[f] -= mean * cosine[f];
        }
    }
}

void noh_clip_basis_build(uint32_t frames, uint32_t parabola, float *rows)
{
    const uint32_t half = noh_clip_basis_half(frames), cosines = parabola ? 1u : frames;
    memset(rows, 0, (size_t)noh_clip_basis_count(frames) * sizeof *rows);
    if (parabola) {
        build_parabola(frames, 0, rows);
        build_parabola(frames, 1, rows);
    }
    for (uint32_t k = 0; k < cosines; k++) {
        const float scale = noh_sqrt((k ? 2.0f : 1.0f) / (float)frames);
        for (uint32_t f = 0; f < (frames + 1u) / 2u; f++) {
            rows[k * half + f] = scale * (float)basis_cosine((2u * f + 1u) * k, frames);
        }
    }
}

/* Four steps to each factor of two: the exponent is written into the float's bits, the rest is a table of 2^(-i / 4).
 */
float noh_clip_step(uint32_t id)
{
    static const float parts[4] = { 1.0f, 0.84089642f, 0.70710678f, 0.59460356f };
    const int32_t exponent = NOH_CLIP_STEP_TOP - (int32_t)(id / 4u);
    const uint32_t bits = (uint32_t)(exponent + 127) << 23;
    float power;
    memcpy(&power, &bits, sizeof power);
    return power * parts[id % 4u];
}

/* "Smallest three": the largest component of a unit quaternion is made positive and omitted. None of the others is
 * above sqrt(1/2), and the omitted one follows from them. Codes that give no unit quaternion (in a broken clip) are
 * scaled to one. */
void noh_clip_quat_expand(const uint32_t codes[3], uint32_t left_out, uint32_t width, float q[4])
{
    const uint32_t mid = (1u << (width - 1u)) - 1u;
    float square = 0.0f, scale = 1.0f, rest = 0.0f;
    for (uint32_t i = 0, k = 0; i < 4u; i++) {
        if (i != left_out) {
            const float v = (float)((int32_t)codes[k++] - (int32_t)mid) * (HALF_ROOT / (float)mid);
            q[i] = v;
            square += v * v;
        }
    }
    if (square > 1.0f) {
        scale = 1.0f / noh_sqrt(square);
    } else {
        rest = noh_sqrt(1.0f - square);
    }
    q[left_out] = 0.0f;
    for (uint32_t i = 0; i < 4u; i++) {
        q[i] *= scale;
    }
    q[left_out] = rest;
}

void noh_clip_quat_unit(const float q[4], float unit[4])
{
    const float square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    if (square > 1e-30f && square < 1e30f) {
        const float r = 1.0f / noh_sqrt(square);
        for (uint32_t i = 0; i < 4u; i++) {
            unit[i] = q[i] * r;
        }
    } else {
        unit[0] = unit[1] = unit[2] = 0.0f;
        unit[3] = 1.0f;
    }
}

/* A track's components may be coded along other axes, chosen by the encoder; the matrix of a quaternion turns them
 * back. */
void noh_clip_mix_matrix(const float q[4], float m[9])
{
    const float x = q[0], y = q[1], z = q[2], w = q[3];
    m[0] = 1.0f - 2.0f * (y * y + z * z);
    m[1] = 2.0f * (x * y - z * w);
    m[2] = 2.0f * (x * z + y * w);
    m[3] = 2.0f * (x * y + z * w);
    m[4] = 1.0f - 2.0f * (x * x + z * z);
    m[5] = 2.0f * (y * z - x * w);
    m[6] = 2.0f * (x * z - y * w);
    m[7] = 2.0f * (y * z + x * w);
    m[8] = 1.0f - 2.0f * (x * x + y * y);
}

void noh_clip_dequantise(const int32_t (*coefs)[4], uint32_t last, float step, const float *mix, float out[][4])
{
    for (uint32_t k = 0; k < last; k++) {
        const float a = (float)coefs[k][0] * step, b = (float)coefs[k][1] * step, c = (float)coefs[k][2] * step;
        if (mix) {
            out[k][0] = mix[0] * a + mix[1] * b + mix[2] * c;
            out[k][1] = mix[3] * a + mix[4] * b + mix[5] * c;
            out[k][2] = mix[6] * a + mix[7] * b + mix[8] * c;
        } else {
            out[k][0] = a;
            out[k][1] = b;
            out[k][2] = c;
        }
        out[k][3] = 0.0f;
    }
}

/* Four slots of three components, and the four that mirror them. Basis row k is even about the middle of the segment
 * for even k and odd for odd k, so one sum over even frequencies and one over odd ones give two frames: their sum is
 * the frame in the first half, their difference its mirror in the second. That halves the products. */
typedef struct quad {
    noh_v4 front[3], back[3];
} quad;

/* The values of four slots in a row: neighbours, or every second of eight; `next`: position of the last four of
 * these. */
NOH_ALWAYS_INLINE noh_v4 load_slots(const float *row, int halved, uint32_t next)
{
    return halved ? noh_v4_even(noh_v4_load(row), noh_v4_load(row + next)) : noh_v4_load(row);
}

/* Sums of three components over rows of one symmetry, for four slots and for the four after them. */
typedef struct sums {
    noh_v4 near[3], far[3];
} sums;

NOH_ALWAYS_INLINE void add_row(sums *s, const float *row, const float coef[4], int halved, uint32_t next, int two)
{
    const uint32_t far = halved ? 8u : 4u;
    const noh_v4 x = noh_v4_set(coef[0]), y = noh_v4_set(coef[1]), z = noh_v4_set(coef[2]);
    const noh_v4 a = load_slots(row, halved, two ? 4u : next);
    s->near[0] = noh_v4_add(s->near[0], noh_v4_mul(a, x));
    s->near[1] = noh_v4_add(s->near[1], noh_v4_mul(a, y));
    s->near[2] = noh_v4_add(s->near[2], noh_v4_mul(a, z));
    if (two) {
        const noh_v4 b = load_slots(row + far, halved, next);
        s->far[0] = noh_v4_add(s->far[0], noh_v4_mul(b, x));
        s->far[1] = noh_v4_add(s->far[1], noh_v4_mul(b, y));
        s->far[2] = noh_v4_add(s->far[2], noh_v4_mul(b, z));
    }
}

NOH_ALWAYS_INLINE void join(const noh_v4 even[3], const noh_v4 odd[3], quad *out)
{
    out->front[0] = noh_v4_add(even[0], odd[0]);
    out->front[1] = noh_v4_add(even[1], odd[1]);
    out->front[2] = noh_v4_add(even[2], odd[2]);
    out->back[0] = noh_v4_sub(even[0], odd[0]);
    out->back[1] = noh_v4_sub(even[1], odd[1]);
    out->back[2] = noh_v4_sub(even[2], odd[2]);
}

/* `two`: eight slots at once, which share the cost of broadcasting coefficients to lanes. */
NOH_ALWAYS_INLINE void transform_slots(const noh_clip_basis *basis, const float (*coefs)[4], uint32_t last,
                                       uint32_t slot, int halved, int two, quad *out)
{
    const uint32_t half = basis->half, first = halved ? 2u * slot : slot, end = first + (two ? halved ? 12u : 8u : 4u);
    const uint32_t next = end < half ? 4u : 0u; /* 0: past the middle, not used */
    const float *row = basis->rows + first;
    const noh_v4 zero = noh_v4_set(0.0f);
    sums even = { { zero, zero, zero }, { zero, zero, zero } }, odd = even;
    uint32_t k = 0;
    for (; k + 1u < last; k += 2u, row += 2u * half) {
        add_row(&even, row, coefs[k], halved, next, two);
        add_row(&odd, row + half, coefs[k + 1u], halved, next, two);
    }
    if (k < last) {
        add_row(&even, row, coefs[k], halved, next, two);
    }
    join(even.near, odd.near, out);
    if (two) {
        join(even.far, odd.far, out + 1);
    }
}

/* The quads of a segment in order, two at a time if both are needed. */
typedef struct quads {
    quad of[2];
    uint32_t ready; /* 1: of[1] is the next */
} quads;

static const quad *next_quad(quads *q, const noh_clip_basis *basis, const float (*coefs)[4], uint32_t last,
                             uint32_t slot, uint32_t slots)
{
    const int two = slot + 4u < slots && !(basis->skip >> (slot / 4u + 1u) & 1u);
    if (q->ready) {
        q->ready = 0;
        return &q->of[1];
    }
    q->ready = (uint32_t)two;
    if (basis->halved) {
        if (two) {
            transform_slots(basis, coefs, last, slot, 1, 1, q->of);
        } else {
            transform_slots(basis, coefs, last, slot, 1, 0, q->of);
        }
    } else if (two) {
        transform_slots(basis, coefs, last, slot, 0, 1, q->of);
    } else {
        transform_slots(basis, coefs, last, slot, 0, 0, q->of);
    }
    return &q->of[0];
}

/* reference * rodrigues(u), times 32767; then transposed: q[i] is frame i. With v = u / 4 a modified Rodrigues vector
 * is the unit quaternion (2 v, 1 - |v|^2) / (1 + |v|^2): no sine, no square root. */
static inline void rotate_quad(const noh_v4 u[3], const noh_v4 r[4], noh_v4 q[4])
{
    const noh_v4 quarter = noh_v4_set(0.25f), one = noh_v4_set(1.0f);
    noh_v4 a = noh_v4_mul(u[0], quarter), b = noh_v4_mul(u[1], quarter), c = noh_v4_mul(u[2], quarter);
    const noh_v4 n = noh_v4_add(noh_v4_add(noh_v4_mul(a, a), noh_v4_mul(b, b)), noh_v4_mul(c, c));
    const noh_v4 k = noh_v4_div(noh_v4_set(QUAT_ONE), noh_v4_add(one, n));
    const noh_v4 d = noh_v4_mul(noh_v4_sub(one, n), k);
    const noh_v4 twice = noh_v4_add(k, k);
    a = noh_v4_mul(a, twice);
    b = noh_v4_mul(b, twice);
    c = noh_v4_mul(c, twice);
#define SUM(p, q0, r0, s) noh_v4_add(noh_v4_add(p, q0), noh_v4_sub(r0, s))
    q[0] = SUM(noh_v4_mul(r[3], a), noh_v4_mul(r[0], d), noh_v4_mul(r[1], c), noh_v4_mul(r[2], b));
    q[1] = SUM(noh_v4_mul(r[3], b), noh_v4_mul(r[1], d), noh_v4_mul(r[2], a), noh_v4_mul(r[0], c));
    q[2] = SUM(noh_v4_mul(r[3], c), noh_v4_mul(r[2], d), noh_v4_mul(r[0], b), noh_v4_mul(r[1], a));
#undef SUM
    q[3] = noh_v4_sub(noh_v4_sub(noh_v4_mul(r[3], d), noh_v4_mul(r[0], a)),
                      noh_v4_add(noh_v4_mul(r[1], b), noh_v4_mul(r[2], c)));
    noh_v4_transpose(q, q);
}

static inline void store_quat(uint8_t *out, noh_v4 q, int wide)
{
    if (wide) {
        noh_v4_store((float *)(void *)out, q);
    } else {
        noh_v4_store_i16((int16_t *)(void *)out, q);
    }
}

static inline void synth_rotation(const noh_clip_basis *basis, const float (*coefs)[4], uint32_t last,
                                  const float reference[4], int wide, uint8_t *out, size_t stride)
{
    const uint32_t slots = noh_clip_slots(basis->frames, basis->halved);
    const uint32_t fronts = noh_clip_front_slots(basis->frames, basis->halved);
    noh_v4 r[4], front[4], back[4];
    quads q;
    q.ready = 0;
    for (int i = 0; i < 4; i++) {
        r[i] = noh_v4_set(reference[i]);
    }
    for (uint32_t s = 0; s < fronts; s += 4u) {
        const uint32_t used = fronts - s < 4u ? fronts - s : 4u;
        const quad *u;
        if (basis->skip >> s / 4u & 1u) continue;
        u = next_quad(&q, basis, coefs, last, s, fronts);
        rotate_quad(u->front, r, front);
        rotate_quad(u->back, r, back);
        for (uint32_t i = 0; i < used; i++) {
            store_quat(out + (slots - 1u - s - i) * stride, back[i], wide);
            store_quat(out + (s + i) * stride, front[i], wide);
        }
    }
}

void noh_clip_synth_rotation(const noh_clip_basis *basis, const float (*coefs)[4], uint32_t last,
                             const float reference[4], int wide, uint8_t *out, size_t stride)
{
    if (wide) {
        synth_rotation(basis, coefs, last, reference, 1, out, stride);
    } else {
        synth_rotation(basis, coefs, last, reference, 0, out, stride);
    }
}

void noh_clip_synth_linear(const noh_clip_basis *basis, const float (*coefs)[4], uint32_t last,
                           const float reference[3], uint8_t *out, size_t stride)
{
    const uint32_t slots = noh_clip_slots(basis->frames, basis->halved);
    const uint32_t fronts = noh_clip_front_slots(basis->frames, basis->halved);
    quads q;
    q.ready = 0;
    for (uint32_t s = 0; s < fronts; s += 4u) {
        const uint32_t used = fronts - s < 4u ? fronts - s : 4u;
        float front[4][4], back[4][4];
        noh_v4 v[4];
        const quad *u;
        if (basis->skip >> s / 4u & 1u) continue;
        u = next_quad(&q, basis, coefs, last, s, fronts);
        for (int side = 0; side < 2; side++) {
            for (int c = 0; c < 3; c++) {
                v[c] = noh_v4_add(noh_v4_set(reference[c]), side ? u->back[c] : u->front[c]);
            }
            v[3] = noh_v4_set(0.0f);
            noh_v4_transpose(v, v);
            for (int i = 0; i < 4; i++) {
                noh_v4_store(side ? back[i] : front[i], v[i]);
            }
        }
        for (uint32_t i = 0; i < used; i++) {
            memcpy(out + (slots - 1u - s - i) * stride, back[i], 3u * sizeof(float));
            memcpy(out + (s + i) * stride, front[i], 3u * sizeof(float));
        }
    }
}

void noh_clip_store_rotation(const float q[4], int wide, uint8_t *out)
{
    float scaled[4];
    for (uint32_t i = 0; i < 4u; i++) {
        scaled[i] = q[i] > -1.0001f && q[i] < 1.0001f ? q[i] * QUAT_ONE : 0.0f;
        scaled[i] = scaled[i] > QUAT_ONE ? QUAT_ONE : scaled[i] < -QUAT_ONE ? -QUAT_ONE : scaled[i];
    }
    store_quat(out, noh_v4_load(scaled), wide);
}
