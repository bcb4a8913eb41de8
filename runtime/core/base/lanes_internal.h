/* lanes_internal.h: as many floats side by side as a register of the processor holds.
 *
 * Kernels are written once, over these. Each operation works on every lane by itself and rounds once, as IEEE 754 has
 * it (division and square root too; approximations of them, such as SSE's rsqrt, are not used), so every width gives
 * the bits of a single lane. Masks are all ones or all zeros in each lane. The width is chosen when the library is
 * compiled. */
#ifndef NOH_BASE_LANES_INTERNAL_H
#define NOH_BASE_LANES_INTERNAL_H

#include <stdint.h>
#include <string.h>

#include "core/base/math_internal.h"

#if defined(NOH_AVX2)
#include <immintrin.h>
#define NOH_LANES 8
typedef __m256 lanes;
static inline void lanes_store(float *to, lanes v)
{
    _mm256_storeu_ps(to, v);
}
static inline lanes lanes_set(float v)
{
    return _mm256_set1_ps(v);
}
static inline lanes lanes_add(lanes a, lanes b)
{
    return _mm256_add_ps(a, b);
}
static inline lanes lanes_sub(lanes a, lanes b)
{
    return _mm256_sub_ps(a, b);
}
static inline lanes lanes_mul(lanes a, lanes b)
{
    return _mm256_mul_ps(a, b);
}
static inline lanes lanes_div(lanes a, lanes b)
{
    return _mm256_div_ps(a, b);
}
static inline lanes lanes_sqrt(lanes a)
{
    return _mm256_sqrt_ps(a);
}
static inline lanes lanes_less(lanes a, lanes b)
{
    return _mm256_cmp_ps(a, b, _CMP_LT_OQ);
}
static inline lanes lanes_choose(lanes mask, lanes yes, lanes no)
{
    return _mm256_blendv_ps(no, yes, mask);
}
static inline int lanes_any(lanes mask)
{
    return _mm256_movemask_ps(mask) != 0;
}
static inline lanes lanes_negate(lanes a)
{
    return _mm256_xor_ps(a, _mm256_set1_ps(-0.0f));
}
static inline lanes lanes_abs(lanes a)
{
    return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a);
}
static inline lanes lanes_field(lanes bits, int left, int right)
{
    __m256i w = _mm256_sll_epi32(_mm256_castps_si256(bits), _mm_cvtsi32_si128(left));
    return _mm256_cvtepi32_ps(_mm256_sra_epi32(w, _mm_cvtsi32_si128(right)));
}
static inline lanes lanes_larger(lanes a, lanes b) /* of two zeros any */
{
    return _mm256_max_ps(a, b);
}
/* the sign of a turned where that of `sign` is set */
static inline lanes lanes_with_sign(lanes a, lanes sign)
{
    return _mm256_xor_ps(a, _mm256_and_ps(sign, _mm256_set1_ps(-0.0f)));
}
/* the lowest 16 bits of x, and above them those of y */
static inline lanes lanes_halves(lanes x, lanes y)
{
    const __m256i low = _mm256_and_si256(_mm256_castps_si256(x), _mm256_set1_epi32(0xffff));
    return _mm256_castsi256_ps(_mm256_or_si256(low, _mm256_slli_epi32(_mm256_castps_si256(y), 16)));
}
static inline void lanes_turn(const lanes pairs[4], lanes out[4]) /* two 4 x 4 matrices side by side, transposed */
{
    __m256 a = _mm256_unpacklo_ps(pairs[0], pairs[1]), b = _mm256_unpackhi_ps(pairs[0], pairs[1]);
    __m256 c = _mm256_unpacklo_ps(pairs[2], pairs[3]), d = _mm256_unpackhi_ps(pairs[2], pairs[3]);
    out[0] = _mm256_shuffle_ps(a, c, 0x44);
    out[1] = _mm256_shuffle_ps(a, c, 0xee);
    out[2] = _mm256_shuffle_ps(b, d, 0x44);
    out[3] = _mm256_shuffle_ps(b, d, 0xee);
}
/* rows[NOH_LANES] of 4 floats, `stride` floats apart, as four columns: a transposition */
static inline void lanes_columns(const float *rows, size_t stride, lanes out[4])
{
    lanes pairs[4];
    NOH_UNROLL
    for (size_t i = 0; i < 4; i++) {
        pairs[i] = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(rows + i * stride)),
                                        _mm_loadu_ps(rows + (i + 4) * stride), 1);
    }
    lanes_turn(pairs, out);
}
/* rows[NOH_LANES] of 3 floats, one behind another, as three columns */
static inline void lanes_triples(const float *rows, lanes out[3])
{
    const lanes a = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(rows)), _mm_loadu_ps(rows + 12), 1);
    const lanes b = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(rows + 4)), _mm_loadu_ps(rows + 16), 1);
    const lanes c = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(rows + 8)), _mm_loadu_ps(rows + 20), 1);
    const lanes xy = _mm256_shuffle_ps(b, c, 0x9e), yz = _mm256_shuffle_ps(a, b, 0x49);
    out[0] = _mm256_shuffle_ps(a, xy, 0x8c);
    out[1] = _mm256_shuffle_ps(yz, xy, 0xd8);
    out[2] = _mm256_shuffle_ps(yz, c, 0xcd);
}
/* the inverse; rows are stored in order, so that where two overlap by one float, the later one's stays */
static inline void lanes_rows(const lanes columns[4], float *rows, size_t stride)
{
    lanes pairs[4];
    lanes_turn(columns, pairs);
    NOH_UNROLL
    for (size_t i = 0; i < 4; i++) {
        _mm_storeu_ps(rows + i * stride, _mm256_castps256_ps128(pairs[i]));
    }
    NOH_UNROLL
    for (size_t i = 0; i < 4; i++) {
        _mm_storeu_ps(rows + (i + 4) * stride, _mm256_extractf128_ps(pairs[i], 1));
    }
}
/* the same of rows[NOH_LANES] that lie anywhere, from float `first` of each */
static inline void lanes_gather(const float *const *rows, size_t first, lanes out[4])
{
    lanes pairs[4];
    NOH_UNROLL
    for (size_t i = 0; i < 4; i++) {
        pairs[i] = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(rows[i] + first)),
                                        _mm_loadu_ps(rows[i + 4] + first), 1);
    }
    lanes_turn(pairs, out);
}
static inline void lanes_scatter(const lanes columns[4], float *const *rows, size_t first)
{
    lanes pairs[4];
    lanes_turn(columns, pairs);
    NOH_UNROLL
    for (size_t i = 0; i < 4; i++) {
        _mm_storeu_ps(rows[i] + first, _mm256_castps256_ps128(pairs[i]));
        _mm_storeu_ps(rows[i + 4] + first, _mm256_extractf128_ps(pairs[i], 1));
    }
}

#elif defined(NOH_SSE2)
#include <emmintrin.h>
#define NOH_LANES 4
typedef __m128 lanes;
static inline lanes lanes_load(const float *v)
{
    return _mm_loadu_ps(v);
}
static inline void lanes_store(float *to, lanes v)
{
    _mm_storeu_ps(to, v);
}
static inline lanes lanes_set(float v)
{
    return _mm_set1_ps(v);
}
static inline lanes lanes_add(lanes a, lanes b)
{
    return _mm_add_ps(a, b);
}
static inline lanes lanes_sub(lanes a, lanes b)
{
    return _mm_sub_ps(a, b);
}
static inline lanes lanes_mul(lanes a, lanes b)
{
    return _mm_mul_ps(a, b);
}
static inline lanes lanes_div(lanes a, lanes b)
{
    return _mm_div_ps(a, b);
}
static inline lanes lanes_sqrt(lanes a)
{
    return _mm_sqrt_ps(a);
}
static inline lanes lanes_less(lanes a, lanes b)
{
    return _mm_cmplt_ps(a, b);
}
static inline lanes lanes_choose(lanes mask, lanes yes, lanes no)
{
    return _mm_or_ps(_mm_and_ps(mask, yes), _mm_andnot_ps(mask, no));
}
static inline int lanes_any(lanes mask)
{
    return _mm_movemask_ps(mask) != 0;
}
static inline lanes lanes_negate(lanes a)
{
    return _mm_xor_ps(a, _mm_set1_ps(-0.0f));
}
static inline lanes lanes_abs(lanes a)
{
    return _mm_andnot_ps(_mm_set1_ps(-0.0f), a);
}
static inline lanes lanes_field(lanes bits, int left, int right)
{
    __m128i w = _mm_sll_epi32(_mm_castps_si128(bits), _mm_cvtsi32_si128(left));
    return _mm_cvtepi32_ps(_mm_sra_epi32(w, _mm_cvtsi32_si128(right)));
}
static inline lanes lanes_larger(lanes a, lanes b)
{
    return _mm_max_ps(a, b);
}
static inline lanes lanes_with_sign(lanes a, lanes sign)
{
    return _mm_xor_ps(a, _mm_and_ps(sign, _mm_set1_ps(-0.0f)));
}
static inline lanes lanes_halves(lanes x, lanes y)
{
    const __m128i low = _mm_and_si128(_mm_castps_si128(x), _mm_set1_epi32(0xffff));
    return _mm_castsi128_ps(_mm_or_si128(low, _mm_slli_epi32(_mm_castps_si128(y), 16)));
}
static inline void lanes_columns(const float *rows, size_t stride, lanes out[4])
{
    NOH_UNROLL
    for (size_t i = 0; i < 4; i++) {
        out[i] = _mm_loadu_ps(rows + i * stride);
    }
    _MM_TRANSPOSE4_PS(out[0], out[1], out[2], out[3]);
}
static inline void lanes_triples(const float *rows, lanes out[3])
{
    const lanes a = _mm_loadu_ps(rows), b = _mm_loadu_ps(rows + 4), c = _mm_loadu_ps(rows + 8);
    const lanes xy = _mm_shuffle_ps(b, c, 0x9e), yz = _mm_shuffle_ps(a, b, 0x49);
    out[0] = _mm_shuffle_ps(a, xy, 0x8c);
    out[1] = _mm_shuffle_ps(yz, xy, 0xd8);
    out[2] = _mm_shuffle_ps(yz, c, 0xcd);
}
static inline void lanes_rows(const lanes columns[4], float *rows, size_t stride)
{
    lanes r[4] = { columns[0], columns[1], columns[2], columns[3] };
    _MM_TRANSPOSE4_PS(r[0], r[1], r[2], r[3]);
    NOH_UNROLL
    for (size_t i = 0; i < 4; i++) {
        _mm_storeu_ps(rows + i * stride, r[i]);
    }
}
static inline void lanes_gather(const float *const *rows, size_t first, lanes out[4])
{
    NOH_UNROLL
    for (size_t i = 0; i < 4; i++) {
        out[i] = _mm_loadu_ps(rows[i] + first);
    }
    _MM_TRANSPOSE4_PS(out[0], out[1], out[2], out[3]);
}
static inline void lanes_scatter(const lanes columns[4], float *const *rows, size_t first)
{
    lanes r[4] = { columns[0], columns[1], columns[2], columns[3] };
    _MM_TRANSPOSE4_PS(r[0], r[1], r[2], r[3]);
    NOH_UNROLL
    for (size_t i = 0; i < 4; i++) {
        _mm_storeu_ps(rows[i] + first, r[i]);
    }
}

#elif defined(NOH_NEON)
#include <arm_neon.h>
#define NOH_LANES 4
typedef float32x4_t lanes;
static inline lanes lanes_load(const float *v)
{
    return vld1q_f32(v);
}
static inline void lanes_store(float *to, lanes v)
{
    vst1q_f32(to, v);
}
static inline lanes lanes_set(float v)
{
    return vdupq_n_f32(v);
}
static inline lanes lanes_add(lanes a, lanes b)
{
    return vaddq_f32(a, b);
}
static inline lanes lanes_sub(lanes a, lanes b)
{
    return vsubq_f32(a, b);
}
static inline lanes lanes_mul(lanes a, lanes b)
{
    return vmulq_f32(a, b);
}
static inline lanes lanes_div(lanes a, lanes b)
{
    return vdivq_f32(a, b);
}
static inline lanes lanes_sqrt(lanes a)
{
    return vsqrtq_f32(a);
}
static inline lanes lanes_less(lanes a, lanes b)
{
    return vreinterpretq_f32_u32(vcltq_f32(a, b));
}
static inline lanes lanes_choose(lanes mask, lanes yes, lanes no)
{
    return vbslq_f32(vreinterpretq_u32_f32(mask), yes, no);
}
static inline int lanes_any(lanes mask)
{
    return vmaxvq_u32(vreinterpretq_u32_f32(mask)) != 0;
}
static inline lanes lanes_negate(lanes a)
{
    return vnegq_f32(a);
}
static inline lanes lanes_abs(lanes a)
{
    return vabsq_f32(a);
}
static inline lanes lanes_field(lanes bits, int left, int right)
{
    int32x4_t w = vshlq_s32(vreinterpretq_s32_f32(bits), vdupq_n_s32(left));
    return vcvtq_f32_s32(vshlq_s32(w, vdupq_n_s32(-right)));
}
static inline lanes lanes_larger(lanes a, lanes b)
{
    return vmaxq_f32(a, b);
}
static inline lanes lanes_with_sign(lanes a, lanes sign)
{
    const uint32x4_t bit = vandq_u32(vreinterpretq_u32_f32(sign), vdupq_n_u32(0x80000000u));
    return vreinterpretq_f32_u32(veorq_u32(vreinterpretq_u32_f32(a), bit));
}
static inline lanes lanes_halves(lanes x, lanes y)
{
    return vreinterpretq_f32_u32(vsliq_n_u32(vreinterpretq_u32_f32(x), vreinterpretq_u32_f32(y), 16));
}
static inline void lanes_turn(const lanes in[4], lanes out[4])
{
    float32x4x2_t ab = vtrnq_f32(in[0], in[1]), cd = vtrnq_f32(in[2], in[3]);
    out[0] = vcombine_f32(vget_low_f32(ab.val[0]), vget_low_f32(cd.val[0]));
    out[1] = vcombine_f32(vget_low_f32(ab.val[1]), vget_low_f32(cd.val[1]));
    out[2] = vcombine_f32(vget_high_f32(ab.val[0]), vget_high_f32(cd.val[0]));
    out[3] = vcombine_f32(vget_high_f32(ab.val[1]), vget_high_f32(cd.val[1]));
}
static inline void lanes_columns(const float *rows, size_t stride, lanes out[4])
{
    lanes in[4];
    NOH_UNROLL
    for (size_t i = 0; i < 4; i++) {
        in[i] = vld1q_f32(rows + i * stride);
    }
    lanes_turn(in, out);
}
static inline void lanes_triples(const float *rows, lanes out[3])
{
    const float32x4x3_t columns = vld3q_f32(rows);
    NOH_UNROLL
    for (int i = 0; i < 3; i++) out[i] = columns.val[i];
}
static inline void lanes_rows(const lanes columns[4], float *rows, size_t stride)
{
    lanes out[4];
    lanes_turn(columns, out);
    NOH_UNROLL
    for (size_t i = 0; i < 4; i++) {
        vst1q_f32(rows + i * stride, out[i]);
    }
}
static inline void lanes_gather(const float *const *rows, size_t first, lanes out[4])
{
    lanes in[4];
    NOH_UNROLL
    for (size_t i = 0; i < 4; i++) {
        in[i] = vld1q_f32(rows[i] + first);
    }
    lanes_turn(in, out);
}
static inline void lanes_scatter(const lanes columns[4], float *const *rows, size_t first)
{
    lanes out[4];
    lanes_turn(columns, out);
    NOH_UNROLL
    for (size_t i = 0; i < 4; i++) {
        vst1q_f32(rows[i] + first, out[i]);
    }
}

#else
#define NOH_LANES 1
typedef float lanes;
static inline lanes lanes_set(float v)
{
    return v;
}
static inline lanes lanes_add(lanes a, lanes b)
{
    return a + b;
}
static inline lanes lanes_sub(lanes a, lanes b)
{
    return a - b;
}
static inline lanes lanes_mul(lanes a, lanes b)
{
    return a * b;
}
static inline lanes lanes_div(lanes a, lanes b)
{
    return a / b;
}
static inline lanes lanes_sqrt(lanes a)
{
    return noh_sqrt(a);
}
static inline lanes lanes_less(lanes a, lanes b)
{
    return a < b ? 1.0f : 0.0f;
}
static inline lanes lanes_choose(lanes mask, lanes yes, lanes no)
{
    return mask != 0.0f ? yes : no;
}
static inline int lanes_any(lanes mask)
{
    return mask != 0.0f;
}
static inline lanes lanes_negate(lanes a)
{
    return -a;
}
static inline lanes lanes_abs(lanes a)
{
    return a < 0.0f ? -a : a;
}
static inline lanes lanes_field(lanes bits, int left, int right)
{
    uint32_t word;
    memcpy(&word, &bits, sizeof word);
    return (float)((int32_t)(word << left) >> right);
}
static inline void lanes_columns(const float *rows, size_t stride, lanes out[4])
{
    (void)stride;
    memcpy(out, rows, 4 * sizeof *rows);
}
static inline void lanes_rows(const lanes columns[4], float *rows, size_t stride)
{
    (void)stride;
    memcpy(rows, columns, 4 * sizeof *rows);
}
static inline void lanes_gather(const float *const *rows, size_t first, lanes out[4])
{
    memcpy(out, rows[0] + first, 4 * sizeof **rows);
}
static inline void lanes_scatter(const lanes columns[4], float *const *rows, size_t first)
{
    memcpy(rows[0] + first, columns, 4 * sizeof **rows);
}
#endif

/* ---- vectors of three ---- */

static inline lanes lanes_dot3(const lanes a[3], const lanes b[3])
{
    return lanes_add(lanes_add(lanes_mul(a[0], b[0]), lanes_mul(a[1], b[1])), lanes_mul(a[2], b[2]));
}

/* noh_normalize3, lane by lane */
static inline void lanes_normalize3(lanes v[3], const lanes fallback[3])
{
    lanes square = lanes_dot3(v, v), long_enough = lanes_less(lanes_set(1e-30f), square);
    lanes inverse = lanes_div(lanes_set(1.0f), lanes_sqrt(square));
    NOH_UNROLL
    for (int i = 0; i < 3; i++) {
        v[i] = lanes_choose(long_enough, lanes_mul(v[i], inverse), fallback[i]);
    }
}

#endif
