/* simd_internal.h: vectors of floats, one set of operations for SSE2, AVX2, NEON and plain C.
 *
 *   noh_v4   four floats; the four lanes of a struct in plain C
 *   noh_v8   eight floats, where NOH_SIMD_V8 is defined: AVX2 is compiled in, or the compiler can make single functions
 *            of it (processor_internal.h), which then begin with NOH_TARGET_AVX2
 *   lanes    as many floats as the widest register of the target holds, NOH_LANES: 8, 4, or 1 in plain C
 *
 * Operations are called noh_v4_add, noh_v8_add and lanes_add. Each works on every lane by itself and rounds once, as
 * IEEE 754 has it (division and square root too; approximations such as SSE's rsqrt are not used), so every width gives
 * the bits of a single lane. Masks are all ones or all zeros in each lane; in plain C 1 or 0.
 *
 *   load, store, set            from and to memory of any alignment; all lanes the same
 *   words                       load 32-bit words as they are
 *   add, sub, mul, div, sqrt, negate, abs
 *   min, max                    a < b ? a : b, and a < b ? b : a
 *   less, and, or, any, choose  masks; choose takes yes where the mask is set
 *   between                     the mask of lanes first to end - 1
 *   with_sign                   a, its sign inverted where the second's sign is set
 *   field                       of 32-bit words: the signed number in the bits between, as a float
 *   halves                      x's lowest 16 bits, and above them y's
 *   transpose                   4 x 4; of eight lanes two such side by side. In place where out is in
 *   columns, rows               NOH_LANES rows of 4 floats, `stride` floats apart, as four columns, and back. Rows are
 *                               stored in order: where two overlap by one float, the later one's stays
 *   gather, scatter             the same for rows that lie anywhere, from float `first` of each
 *   triples                     rows of 3 floats without a gap, as three columns
 *   dot3                        of vectors of three
 *
 * For clips:
 *   make                        of four floats
 *   lane                        one lane of four in all four; of eight lanes in each half
 *   even                        lanes 0 and 2 of a, then of b
 *   sums                        lane i: (x + z) + (y + w) of the i-th vector
 *   blend_i16                   a and b of twice as many int16 (`first` the lower four, `second` the upper four; of
 *                               eight lanes in each half) summed with whole weights, 0..32767, that add up to 32767 at
 *                               most: exact in 32 bits, then rounded once
 *   store_i16                   rounded, halves up; |v| below 32768
 *
 * For searches, noh_h8 of eight int16 and noh_i4 of four int32; no operation may overflow:
 *   noh_h8_load_i8              sixteen int8, widened, as two vectors
 *   noh_h8_pair                 the same two int16, the first in the low half of the word, four times
 *   noh_h8_sub, noh_h8_max
 *   noh_i4_add_squares          sum + x * x + y * y of the four pairs (x, y)
 *   noh_i4_add_four_times       a + 4 * b
 *   noh_i4_any_at_most, noh_i4_zero, noh_i4_store
 *
 * Define NOH_SIMD_SCALAR before the first include of this file for plain C: what vectors are compared with.
 * Threads: no state; any thread. */
#ifndef NOH_BASE_SIMD_INTERNAL_H
#define NOH_BASE_SIMD_INTERNAL_H

#include <stdint.h>
#include <string.h>

#include "core/base/math_internal.h"
#include "core/base/processor_internal.h"
#include "core/base/compiler_internal.h"

#if defined(NOH_SIMD_SCALAR)
#elif defined(NOH_SSE2)
#define NOH_SIMD_SSE2 1
#elif defined(NOH_NEON)
#define NOH_SIMD_NEON 1
#endif

#if defined(NOH_SIMD_SSE2) && (defined(NOH_AVX2) || defined(NOH_AVX2_AT_RUN_TIME))
#include <immintrin.h>
#define NOH_SIMD_V8 1
#elif defined(NOH_SIMD_SSE2)
#include <emmintrin.h>
#elif defined(NOH_SIMD_NEON)
#include <arm_neon.h>
#endif

#if defined(NOH_SIMD_SSE2) && defined(NOH_AVX2)
#define NOH_LANES 8
#define NOH_SIMD_NAME "avx2"
#elif defined(NOH_SIMD_SSE2)
#define NOH_LANES 4
#define NOH_SIMD_NAME "sse2"
#elif defined(NOH_SIMD_NEON)
#define NOH_LANES 4
#define NOH_SIMD_NAME "neon"
#else
#define NOH_LANES 1
#define NOH_SIMD_NAME "scalar"
#endif

/* Tables of one-line functions follow. V: their prefix; T: the type; IN: how they are declared. */
/* clang-format off */

/* ---- any vectors of four floats or more ---- */

#define NOH_SIMD_DOT3(V, T, IN)                                                                                        \
    IN T V##_dot3(const T a[3], const T b[3])                                                                          \
    {                                                                                                                  \
        return V##_add(V##_add(V##_mul(a[0], b[0]), V##_mul(a[1], b[1])), V##_mul(a[2], b[2]));                        \
    }

/* Rows of four lanes. */
#define NOH_SIMD_ROWS4(V, T, IN)                                                                                       \
    IN void V##_columns(const float *rows, size_t stride, T out[4])                                                    \
    {                                                                                                                  \
        NOH_UNROLL for (size_t i = 0; i < 4; i++) out[i] = V##_load(rows + i * stride);                                \
        V##_transpose(out, out);                                                                                       \
    }                                                                                                                  \
    IN void V##_rows(const T columns[4], float *rows, size_t stride)                                                   \
    {                                                                                                                  \
        T r[4];                                                                                                        \
        V##_transpose(columns, r);                                                                                     \
        NOH_UNROLL for (size_t i = 0; i < 4; i++) V##_store(rows + i * stride, r[i]);                                  \
    }                                                                                                                  \
    IN void V##_gather(const float *const *rows, size_t first, T out[4])                                               \
    {                                                                                                                  \
        NOH_UNROLL for (size_t i = 0; i < 4; i++) out[i] = V##_load(rows[i] + first);                                  \
        V##_transpose(out, out);                                                                                       \
    }                                                                                                                  \
    IN void V##_scatter(const T columns[4], float *const *rows, size_t first)                                          \
    {                                                                                                                  \
        T r[4];                                                                                                        \
        V##_transpose(columns, r);                                                                                     \
        NOH_UNROLL for (size_t i = 0; i < 4; i++) V##_store(rows[i] + first, r[i]);                                    \
    }

#if defined(NOH_SIMD_SSE2)

/* ---- x86 ---- */

/* Both widths. mm: _mm or _mm256; si: si128 or si256. */
#define NOH_SIMD_X86(V, T, mm, bits, IN)                                                                               \
    IN T V##_load(const float *from) { return mm##_loadu_ps(from); }                                                   \
    IN void V##_store(float *to, T v) { mm##_storeu_ps(to, v); }                                                       \
    IN T V##_words(const uint32_t *from)                                                                               \
    {                                                                                                                  \
        return mm##_castsi##bits##_ps(mm##_loadu_si##bits((const __m##bits##i *)(const void *)from));                  \
    }                                                                                                                  \
    IN T V##_set(float v) { return mm##_set1_ps(v); }                                                                  \
    IN T V##_add(T a, T b) { return mm##_add_ps(a, b); }                                                               \
    IN T V##_sub(T a, T b) { return mm##_sub_ps(a, b); }                                                               \
    IN T V##_mul(T a, T b) { return mm##_mul_ps(a, b); }                                                               \
    IN T V##_div(T a, T b) { return mm##_div_ps(a, b); }                                                               \
    IN T V##_sqrt(T a) { return mm##_sqrt_ps(a); }                                                                     \
    IN T V##_min(T a, T b) { return mm##_min_ps(a, b); }                                                               \
    IN T V##_max(T a, T b) { return mm##_max_ps(b, a); }                                                               \
    IN T V##_and(T a, T b) { return mm##_and_ps(a, b); }                                                               \
    IN T V##_or(T a, T b) { return mm##_or_ps(a, b); }                                                                 \
    IN int V##_any(T mask) { return mm##_movemask_ps(mask) != 0; }                                                     \
    IN T V##_negate(T a) { return mm##_xor_ps(a, mm##_set1_ps(-0.0f)); }                                               \
    IN T V##_abs(T a) { return mm##_andnot_ps(mm##_set1_ps(-0.0f), a); }                                               \
    IN T V##_with_sign(T a, T sign) { return mm##_xor_ps(a, mm##_and_ps(sign, mm##_set1_ps(-0.0f))); }                 \
    IN T V##_field(T words, int left, int right)                                                                       \
    {                                                                                                                  \
        const __m##bits##i w = mm##_sll_epi32(mm##_castps_si##bits(words), _mm_cvtsi32_si128(left));                   \
        return mm##_cvtepi32_ps(mm##_sra_epi32(w, _mm_cvtsi32_si128(right)));                                          \
    }                                                                                                                  \
    IN T V##_halves(T x, T y)                                                                                          \
    {                                                                                                                  \
        const __m##bits##i low = mm##_and_si##bits(mm##_castps_si##bits(x), mm##_set1_epi32(0xffff));                  \
        return mm##_castsi##bits##_ps(mm##_or_si##bits(low, mm##_slli_epi32(mm##_castps_si##bits(y), 16)));            \
    }                                                                                                                  \
    IN void V##_transpose(const T in[4], T out[4])                                                                     \
    {                                                                                                                  \
        const T a = mm##_unpacklo_ps(in[0], in[1]), b = mm##_unpackhi_ps(in[0], in[1]);                                \
        const T c = mm##_unpacklo_ps(in[2], in[3]), d = mm##_unpackhi_ps(in[2], in[3]);                                \
        out[0] = mm##_shuffle_ps(a, c, 0x44);                                                                          \
        out[1] = mm##_shuffle_ps(a, c, 0xee);                                                                          \
        out[2] = mm##_shuffle_ps(b, d, 0x44);                                                                          \
        out[3] = mm##_shuffle_ps(b, d, 0xee);                                                                          \
    }                                                                                                                  \
    IN void V##_triples_of(T a, T b, T c, T out[3])                                                                    \
    {                                                                                                                  \
        const T xy = mm##_shuffle_ps(b, c, 0x9e), yz = mm##_shuffle_ps(a, b, 0x49);                                    \
        out[0] = mm##_shuffle_ps(a, xy, 0x8c);                                                                         \
        out[1] = mm##_shuffle_ps(yz, xy, 0xd8);                                                                        \
        out[2] = mm##_shuffle_ps(yz, c, 0xcd);                                                                         \
    }                                                                                                                  \
    IN T V##_sums(T a, T b, T c, T d)                                                                                  \
    {                                                                                                                  \
        const T ab = mm##_add_ps(mm##_unpacklo_ps(a, b), mm##_unpackhi_ps(a, b));                                      \
        const T cd = mm##_add_ps(mm##_unpacklo_ps(c, d), mm##_unpackhi_ps(c, d));                                      \
        return mm##_add_ps(mm##_shuffle_ps(ab, cd, 0x44), mm##_shuffle_ps(ab, cd, 0xee));                              \
    }                                                                                                                  \
    IN T V##_lane(T v, int lane)                                                                                       \
    {                                                                                                                  \
        switch (lane) { /* a constant after inlining */                                                                \
        case 0: return mm##_shuffle_ps(v, v, 0x00);                                                                    \
        case 1: return mm##_shuffle_ps(v, v, 0x55);                                                                    \
        case 2: return mm##_shuffle_ps(v, v, 0xaa);                                                                    \
        default: return mm##_shuffle_ps(v, v, 0xff);                                                                   \
        }                                                                                                              \
    }                                                                                                                  \
    IN void V##_blend_i16(const int16_t *a, const int16_t *b, int32_t to_a, int32_t to_b, T *first, T *second)         \
    {                                                                                                                  \
        const __m##bits##i w = mm##_set1_epi32((int32_t)((uint32_t)to_b << 16 | (uint32_t)to_a));                      \
        const __m##bits##i p = mm##_loadu_si##bits((const __m##bits##i *)(const void *)a);                             \
        const __m##bits##i q = mm##_loadu_si##bits((const __m##bits##i *)(const void *)b);                             \
        *first = mm##_cvtepi32_ps(mm##_madd_epi16(mm##_unpacklo_epi16(p, q), w));                                      \
        *second = mm##_cvtepi32_ps(mm##_madd_epi16(mm##_unpackhi_epi16(p, q), w));                                     \
    }                                                                                                                  \
    NOH_SIMD_DOT3(V, T, IN)

#define NOH_SIMD_X86_4(V, IN)                                                                                          \
    NOH_SIMD_X86(V, __m128, _mm, 128, IN)                                                                              \
    NOH_SIMD_ROWS4(V, __m128, IN)                                                                                      \
    IN __m128 V##_less(__m128 a, __m128 b) { return _mm_cmplt_ps(a, b); }                                              \
    IN __m128 V##_choose(__m128 mask, __m128 yes, __m128 no)                                                           \
    {                                                                                                                  \
        return _mm_or_ps(_mm_and_ps(mask, yes), _mm_andnot_ps(mask, no));                                              \
    }                                                                                                                  \
    IN __m128 V##_between(size_t first, size_t end)                                                                    \
    {                                                                                                                  \
        const __m128i lane = _mm_setr_epi32(0, 1, 2, 3), below = _mm_cmplt_epi32(lane, _mm_set1_epi32((int)first));    \
        return _mm_castsi128_ps(_mm_andnot_si128(below, _mm_cmplt_epi32(lane, _mm_set1_epi32((int)end))));             \
    }                                                                                                                  \
    IN void V##_triples(const float *rows, __m128 out[3])                                                              \
    {                                                                                                                  \
        V##_triples_of(V##_load(rows), V##_load(rows + 4), V##_load(rows + 8), out);                                   \
    }

typedef __m128 noh_v4;
NOH_SIMD_X86_4(noh_v4, NOH_UNUSED static inline)
NOH_UNUSED static inline noh_v4 noh_v4_make(float x, float y, float z, float w) { return _mm_setr_ps(x, y, z, w); }
NOH_UNUSED static inline noh_v4 noh_v4_even(noh_v4 a, noh_v4 b) { return _mm_shuffle_ps(a, b, 0x88); }
NOH_UNUSED static inline void noh_v4_store_i16(int16_t *to, noh_v4 v)
{
    const __m128i i = _mm_sub_epi32(_mm_cvttps_epi32(_mm_add_ps(v, _mm_set1_ps(32768.5f))), _mm_set1_epi32(32768));
    _mm_storel_epi64((__m128i *)(void *)to, _mm_packs_epi32(i, i));
}

/* Eight lanes: load_two and store_two take the halves from and to two places. */
#define NOH_SIMD_X86_8(V, IN)                                                                                          \
    NOH_SIMD_X86(V, __m256, _mm256, 256, IN)                                                                           \
    IN __m256 V##_less(__m256 a, __m256 b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }                                 \
    IN __m256 V##_choose(__m256 mask, __m256 yes, __m256 no) { return _mm256_blendv_ps(no, yes, mask); }               \
    IN __m256 V##_between(size_t first, size_t end)                                                                    \
    {                                                                                                                  \
        const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);                                                \
        const __m256i below = _mm256_cmpgt_epi32(_mm256_set1_epi32((int)first), lane);                                 \
        return _mm256_castsi256_ps(                                                                                    \
            _mm256_andnot_si256(below, _mm256_cmpgt_epi32(_mm256_set1_epi32((int)end), lane)));                        \
    }                                                                                                                  \
    IN noh_v4 V##_low(__m256 v) { return _mm256_castps256_ps128(v); }                                                  \
    IN __m256 V##_load_two(const float *low, const float *high)                                                        \
    {                                                                                                                  \
        return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(low)), _mm_loadu_ps(high), 1);                 \
    }                                                                                                                  \
    IN void V##_store_two(float *low, float *high, __m256 v)                                                           \
    {                                                                                                                  \
        _mm_storeu_ps(low, _mm256_castps256_ps128(v));                                                                 \
        _mm_storeu_ps(high, _mm256_extractf128_ps(v, 1));                                                              \
    }                                                                                                                  \
    IN void V##_triples(const float *rows, __m256 out[3])                                                              \
    {                                                                                                                  \
        V##_triples_of(V##_load_two(rows, rows + 12), V##_load_two(rows + 4, rows + 16),                               \
                       V##_load_two(rows + 8, rows + 20), out);                                                        \
    }                                                                                                                  \
    IN void V##_columns(const float *rows, size_t stride, __m256 out[4])                                               \
    {                                                                                                                  \
        NOH_UNROLL for (size_t i = 0; i < 4; i++) out[i] = V##_load_two(rows + i * stride, rows + (i + 4) * stride);   \
        V##_transpose(out, out);                                                                                       \
    }                                                                                                                  \
    IN void V##_rows(const __m256 columns[4], float *rows, size_t stride)                                              \
    {                                                                                                                  \
        __m256 r[4];                                                                                                   \
        V##_transpose(columns, r);                                                                                     \
        NOH_UNROLL for (size_t i = 0; i < 4; i++) _mm_storeu_ps(rows + i * stride, _mm256_castps256_ps128(r[i]));      \
        NOH_UNROLL for (size_t i = 0; i < 4; i++)                                                                      \
        {                                                                                                              \
            _mm_storeu_ps(rows + (i + 4) * stride, _mm256_extractf128_ps(r[i], 1));                                    \
        }                                                                                                              \
    }                                                                                                                  \
    IN void V##_gather(const float *const *rows, size_t first, __m256 out[4])                                          \
    {                                                                                                                  \
        NOH_UNROLL for (size_t i = 0; i < 4; i++) out[i] = V##_load_two(rows[i] + first, rows[i + 4] + first);         \
        V##_transpose(out, out);                                                                                       \
    }                                                                                                                  \
    IN void V##_scatter(const __m256 columns[4], float *const *rows, size_t first)                                     \
    {                                                                                                                  \
        __m256 r[4];                                                                                                   \
        V##_transpose(columns, r);                                                                                     \
        NOH_UNROLL for (size_t i = 0; i < 4; i++) V##_store_two(rows[i] + first, rows[i + 4] + first, r[i]);           \
    }

#if defined(NOH_SIMD_V8)
typedef __m256 noh_v8;
NOH_SIMD_X86_8(noh_v8, NOH_TARGET_AVX2 NOH_UNUSED NOH_ALWAYS_INLINE)
#endif

#if NOH_LANES == 8
typedef __m256 lanes;
NOH_SIMD_X86_8(lanes, NOH_UNUSED static inline)
#else
typedef __m128 lanes;
NOH_SIMD_X86_4(lanes, NOH_UNUSED static inline)
#endif

#elif defined(NOH_SIMD_NEON)

/* ---- NEON ---- */

#define NOH_SIMD_NEON_4(V, T, IN)                                                                                      \
    IN T V##_load(const float *from) { return vld1q_f32(from); }                                                       \
    IN void V##_store(float *to, T v) { vst1q_f32(to, v); }                                                            \
    IN T V##_words(const uint32_t *from) { return vreinterpretq_f32_u32(vld1q_u32(from)); }                            \
    IN T V##_set(float v) { return vdupq_n_f32(v); }                                                                   \
    IN T V##_add(T a, T b) { return vaddq_f32(a, b); }                                                                 \
    IN T V##_sub(T a, T b) { return vsubq_f32(a, b); }                                                                 \
    IN T V##_mul(T a, T b) { return vmulq_f32(a, b); }                                                                 \
    IN T V##_div(T a, T b) { return vdivq_f32(a, b); }                                                                 \
    IN T V##_sqrt(T a) { return vsqrtq_f32(a); }                                                                       \
    IN T V##_min(T a, T b) { return vbslq_f32(vcltq_f32(a, b), a, b); }                                                \
    IN T V##_max(T a, T b) { return vbslq_f32(vcltq_f32(a, b), b, a); }                                                \
    IN T V##_less(T a, T b) { return vreinterpretq_f32_u32(vcltq_f32(a, b)); }                                         \
    IN T V##_and(T a, T b)                                                                                             \
    {                                                                                                                  \
        return vreinterpretq_f32_u32(vandq_u32(vreinterpretq_u32_f32(a), vreinterpretq_u32_f32(b)));                   \
    }                                                                                                                  \
    IN T V##_or(T a, T b)                                                                                              \
    {                                                                                                                  \
        return vreinterpretq_f32_u32(vorrq_u32(vreinterpretq_u32_f32(a), vreinterpretq_u32_f32(b)));                   \
    }                                                                                                                  \
    IN int V##_any(T mask) { return vmaxvq_u32(vreinterpretq_u32_f32(mask)) != 0; }                                    \
    IN T V##_choose(T mask, T yes, T no) { return vbslq_f32(vreinterpretq_u32_f32(mask), yes, no); }                   \
    IN T V##_between(size_t first, size_t end)                                                                         \
    {                                                                                                                  \
        static const uint32_t numbers[4] = { 0, 1, 2, 3 };                                                             \
        const uint32x4_t lane = vld1q_u32(numbers), from = vcgeq_u32(lane, vdupq_n_u32((uint32_t)first));              \
        return vreinterpretq_f32_u32(vandq_u32(from, vcltq_u32(lane, vdupq_n_u32((uint32_t)end))));                    \
    }                                                                                                                  \
    IN T V##_negate(T a) { return vnegq_f32(a); }                                                                      \
    IN T V##_abs(T a) { return vabsq_f32(a); }                                                                         \
    IN T V##_with_sign(T a, T sign)                                                                                    \
    {                                                                                                                  \
        const uint32x4_t bit = vandq_u32(vreinterpretq_u32_f32(sign), vdupq_n_u32(0x80000000u));                       \
        return vreinterpretq_f32_u32(veorq_u32(vreinterpretq_u32_f32(a), bit));                                        \
    }                                                                                                                  \
    IN T V##_field(T words, int left, int right)                                                                       \
    {                                                                                                                  \
        const int32x4_t w = vshlq_s32(vreinterpretq_s32_f32(words), vdupq_n_s32(left));                                \
        return vcvtq_f32_s32(vshlq_s32(w, vdupq_n_s32(-right)));                                                       \
    }                                                                                                                  \
    IN T V##_halves(T x, T y)                                                                                          \
    {                                                                                                                  \
        return vreinterpretq_f32_u32(vsliq_n_u32(vreinterpretq_u32_f32(x), vreinterpretq_u32_f32(y), 16));             \
    }                                                                                                                  \
    IN void V##_transpose(const T in[4], T out[4])                                                                     \
    {                                                                                                                  \
        const float32x4x2_t ab = vtrnq_f32(in[0], in[1]), cd = vtrnq_f32(in[2], in[3]);                                \
        out[0] = vcombine_f32(vget_low_f32(ab.val[0]), vget_low_f32(cd.val[0]));                                       \
        out[1] = vcombine_f32(vget_low_f32(ab.val[1]), vget_low_f32(cd.val[1]));                                       \
        out[2] = vcombine_f32(vget_high_f32(ab.val[0]), vget_high_f32(cd.val[0]));                                     \
        out[3] = vcombine_f32(vget_high_f32(ab.val[1]), vget_high_f32(cd.val[1]));                                     \
    }                                                                                                                  \
    IN void V##_triples(const float *rows, T out[3])                                                                   \
    {                                                                                                                  \
        const float32x4x3_t columns = vld3q_f32(rows);                                                                 \
        NOH_UNROLL for (int i = 0; i < 3; i++) out[i] = columns.val[i];                                                \
    }                                                                                                                  \
    NOH_SIMD_ROWS4(V, T, IN)                                                                                           \
    NOH_SIMD_DOT3(V, T, IN)

typedef float32x4_t noh_v4;
NOH_SIMD_NEON_4(noh_v4, noh_v4, NOH_UNUSED static inline)
NOH_UNUSED static inline noh_v4 noh_v4_make(float x, float y, float z, float w)
{
    return vsetq_lane_f32(w, vsetq_lane_f32(z, vsetq_lane_f32(y, vdupq_n_f32(x), 1), 2), 3);
}
NOH_UNUSED static inline noh_v4 noh_v4_even(noh_v4 a, noh_v4 b) { return vuzp1q_f32(a, b); }
NOH_UNUSED static inline noh_v4 noh_v4_lane(noh_v4 v, int lane)
{
    switch (lane) { /* a constant after inlining */
    case 0: return vdupq_laneq_f32(v, 0);
    case 1: return vdupq_laneq_f32(v, 1);
    case 2: return vdupq_laneq_f32(v, 2);
    default: return vdupq_laneq_f32(v, 3);
    }
}
NOH_UNUSED static inline noh_v4 noh_v4_sums(noh_v4 a, noh_v4 b, noh_v4 c, noh_v4 d)
{
    const noh_v4 ab = vaddq_f32(vzip1q_f32(a, b), vzip2q_f32(a, b)), cd = vaddq_f32(vzip1q_f32(c, d), vzip2q_f32(c, d));
    return vaddq_f32(vcombine_f32(vget_low_f32(ab), vget_low_f32(cd)),
                     vcombine_f32(vget_high_f32(ab), vget_high_f32(cd)));
}
NOH_UNUSED static inline void noh_v4_blend_i16(const int16_t *a, const int16_t *b, int32_t to_a, int32_t to_b,
                                               noh_v4 *first, noh_v4 *second)
{
    const int16x8_t p = vld1q_s16(a), q = vld1q_s16(b);
    const int16_t s = (int16_t)to_a, t = (int16_t)to_b;
    *first = vcvtq_f32_s32(vmlal_n_s16(vmull_n_s16(vget_low_s16(p), s), vget_low_s16(q), t));
    *second = vcvtq_f32_s32(vmlal_n_s16(vmull_n_s16(vget_high_s16(p), s), vget_high_s16(q), t));
}
NOH_UNUSED static inline void noh_v4_store_i16(int16_t *to, noh_v4 v)
{
    vst1_s16(to, vqmovn_s32(vsubq_s32(vcvtq_s32_f32(vaddq_f32(v, vdupq_n_f32(32768.5f))), vdupq_n_s32(32768))));
}

typedef float32x4_t lanes;
NOH_SIMD_NEON_4(lanes, lanes, NOH_UNUSED static inline)

#else

/* ---- plain C ---- */

typedef float lanes;
NOH_UNUSED static inline lanes lanes_set(float v) { return v; }
NOH_UNUSED static inline lanes lanes_add(lanes a, lanes b) { return a + b; }
NOH_UNUSED static inline lanes lanes_sub(lanes a, lanes b) { return a - b; }
NOH_UNUSED static inline lanes lanes_mul(lanes a, lanes b) { return a * b; }
NOH_UNUSED static inline lanes lanes_div(lanes a, lanes b) { return a / b; }
NOH_UNUSED static inline lanes lanes_sqrt(lanes a) { return noh_sqrt(a); }
NOH_UNUSED static inline lanes lanes_less(lanes a, lanes b) { return a < b ? 1.0f : 0.0f; }
NOH_UNUSED static inline lanes lanes_and(lanes a, lanes b) { return a != 0.0f ? b : 0.0f; }
NOH_UNUSED static inline lanes lanes_or(lanes a, lanes b) { return a != 0.0f ? a : b; }
NOH_UNUSED static inline int lanes_any(lanes mask) { return mask != 0.0f; }
NOH_UNUSED static inline lanes lanes_choose(lanes mask, lanes yes, lanes no) { return mask != 0.0f ? yes : no; }
NOH_UNUSED static inline lanes lanes_min(lanes a, lanes b) { return lanes_choose(lanes_less(a, b), a, b); }
NOH_UNUSED static inline lanes lanes_max(lanes a, lanes b) { return lanes_choose(lanes_less(a, b), b, a); }
NOH_UNUSED static inline lanes lanes_negate(lanes a) { return -a; }
NOH_UNUSED static inline lanes lanes_abs(lanes a) { return a < 0.0f ? -a : a; }
NOH_UNUSED static inline lanes lanes_field(lanes words, int left, int right)
{
    uint32_t word;
    memcpy(&word, &words, sizeof word);
    return (float)((int32_t)(word << left) >> right);
}
NOH_UNUSED static inline void lanes_columns(const float *rows, size_t stride, lanes out[4])
{
    (void)stride;
    memcpy(out, rows, 4 * sizeof *rows);
}
NOH_UNUSED static inline void lanes_rows(const lanes columns[4], float *rows, size_t stride)
{
    (void)stride;
    memcpy(rows, columns, 4 * sizeof *rows);
}
NOH_UNUSED static inline void lanes_gather(const float *const *rows, size_t first, lanes out[4])
{
    memcpy(out, rows[0] + first, 4 * sizeof **rows);
}
NOH_UNUSED static inline void lanes_scatter(const lanes columns[4], float *const *rows, size_t first)
{
    memcpy(rows[0] + first, columns, 4 * sizeof **rows);
}
NOH_SIMD_DOT3(lanes, lanes, NOH_UNUSED static inline)

/* Four of them. Written out: at -O2 compilers keep loops of four. */
typedef struct noh_v4 {
    float f[4];
} noh_v4;
#define NOH_SIMD_BINARY(op)                                                                                            \
    NOH_UNUSED static inline noh_v4 noh_v4_##op(noh_v4 a, noh_v4 b)                                                    \
    {                                                                                                                  \
        const noh_v4 r = { { lanes_##op(a.f[0], b.f[0]), lanes_##op(a.f[1], b.f[1]), lanes_##op(a.f[2], b.f[2]),       \
                             lanes_##op(a.f[3], b.f[3]) } };                                                           \
        return r;                                                                                                      \
    }
NOH_SIMD_BINARY(add)
NOH_SIMD_BINARY(sub)
NOH_SIMD_BINARY(mul)
NOH_SIMD_BINARY(div)
NOH_SIMD_BINARY(max)
NOH_UNUSED static inline noh_v4 noh_v4_sqrt(noh_v4 a)
{
    const noh_v4 r = { { noh_sqrt(a.f[0]), noh_sqrt(a.f[1]), noh_sqrt(a.f[2]), noh_sqrt(a.f[3]) } };
    return r;
}
NOH_UNUSED static inline noh_v4 noh_v4_make(float x, float y, float z, float w)
{
    const noh_v4 r = { { x, y, z, w } };
    return r;
}
NOH_UNUSED static inline noh_v4 noh_v4_set(float v) { return noh_v4_make(v, v, v, v); }
NOH_UNUSED static inline noh_v4 noh_v4_load(const float *from)
{
    noh_v4 r;
    memcpy(r.f, from, sizeof r.f);
    return r;
}
NOH_UNUSED static inline void noh_v4_store(float *to, noh_v4 v) { memcpy(to, v.f, sizeof v.f); }
NOH_UNUSED static inline noh_v4 noh_v4_lane(noh_v4 v, int lane) { return noh_v4_set(v.f[lane]); }
NOH_UNUSED static inline noh_v4 noh_v4_even(noh_v4 a, noh_v4 b) { return noh_v4_make(a.f[0], a.f[2], b.f[0], b.f[2]); }
NOH_UNUSED static inline void noh_v4_transpose(const noh_v4 in[4], noh_v4 out[4])
{
    float columns[4][4];
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 4; k++) columns[k][i] = in[i].f[k];
    }
    memcpy(out, columns, sizeof columns);
}
NOH_UNUSED static inline float noh_v4_sum(noh_v4 v) { return (v.f[0] + v.f[2]) + (v.f[1] + v.f[3]); }
NOH_UNUSED static inline noh_v4 noh_v4_sums(noh_v4 a, noh_v4 b, noh_v4 c, noh_v4 d)
{
    return noh_v4_make(noh_v4_sum(a), noh_v4_sum(b), noh_v4_sum(c), noh_v4_sum(d));
}
NOH_UNUSED static inline noh_v4 noh_v4_blend_four(const int16_t *a, const int16_t *b, int32_t to_a, int32_t to_b)
{
    return noh_v4_make((float)(a[0] * to_a + b[0] * to_b), (float)(a[1] * to_a + b[1] * to_b),
                       (float)(a[2] * to_a + b[2] * to_b), (float)(a[3] * to_a + b[3] * to_b));
}
NOH_UNUSED static inline void noh_v4_blend_i16(const int16_t *a, const int16_t *b, int32_t to_a, int32_t to_b,
                                               noh_v4 *first, noh_v4 *second)
{
    *first = noh_v4_blend_four(a, b, to_a, to_b);
    *second = noh_v4_blend_four(a + 4, b + 4, to_a, to_b);
}
NOH_UNUSED static inline void noh_v4_store_i16(int16_t *to, noh_v4 v)
{
    for (int i = 0; i < 4; i++) {
        const int32_t r = (int32_t)(v.f[i] + 32768.5f) - 32768;
        to[i] = (int16_t)(r > 32767 ? 32767 : r);
    }
}

#endif

/* ---- whole numbers, for searches ---- */

#if defined(NOH_SIMD_SSE2)
typedef __m128i noh_h8;
typedef __m128i noh_i4;
NOH_UNUSED static inline void noh_h8_load_i8(const int8_t *from, noh_h8 out[2])
{
    const __m128i v = _mm_loadu_si128((const __m128i *)(const void *)from);
    out[0] = _mm_srai_epi16(_mm_unpacklo_epi8(v, v), 8);
    out[1] = _mm_srai_epi16(_mm_unpackhi_epi8(v, v), 8);
}
NOH_UNUSED static inline noh_h8 noh_h8_pair(int32_t pair) { return _mm_set1_epi32(pair); }
NOH_UNUSED static inline noh_h8 noh_h8_sub(noh_h8 a, noh_h8 b) { return _mm_sub_epi16(a, b); }
NOH_UNUSED static inline noh_h8 noh_h8_max(noh_h8 a, noh_h8 b) { return _mm_max_epi16(a, b); }
NOH_UNUSED static inline noh_i4 noh_i4_zero(void) { return _mm_setzero_si128(); }
NOH_UNUSED static inline noh_i4 noh_i4_add_squares(noh_i4 sum, noh_h8 d) { return _mm_add_epi32(sum, _mm_madd_epi16(d, d)); }
NOH_UNUSED static inline noh_i4 noh_i4_add_four_times(noh_i4 a, noh_i4 b) { return _mm_add_epi32(a, _mm_slli_epi32(b, 2)); }
NOH_UNUSED static inline int noh_i4_any_at_most(noh_i4 a, int32_t limit)
{
    return _mm_movemask_epi8(_mm_cmpgt_epi32(a, _mm_set1_epi32(limit))) != 0xffff;
}
NOH_UNUSED static inline void noh_i4_store(int32_t *to, noh_i4 v) { _mm_storeu_si128((__m128i *)(void *)to, v); }
#elif defined(NOH_SIMD_NEON)
typedef int16x8_t noh_h8;
typedef int32x4_t noh_i4;
NOH_UNUSED static inline void noh_h8_load_i8(const int8_t *from, noh_h8 out[2])
{
    const int8x16_t v = vld1q_s8(from);
    out[0] = vmovl_s8(vget_low_s8(v));
    out[1] = vmovl_s8(vget_high_s8(v));
}
NOH_UNUSED static inline noh_h8 noh_h8_pair(int32_t pair) { return vreinterpretq_s16_s32(vdupq_n_s32(pair)); }
NOH_UNUSED static inline noh_h8 noh_h8_sub(noh_h8 a, noh_h8 b) { return vsubq_s16(a, b); }
NOH_UNUSED static inline noh_h8 noh_h8_max(noh_h8 a, noh_h8 b) { return vmaxq_s16(a, b); }
NOH_UNUSED static inline noh_i4 noh_i4_zero(void) { return vdupq_n_s32(0); }
NOH_UNUSED static inline noh_i4 noh_i4_add_squares(noh_i4 sum, noh_h8 d)
{
    const int32x4_t low = vmull_s16(vget_low_s16(d), vget_low_s16(d));
    return vaddq_s32(sum, vpaddq_s32(low, vmull_s16(vget_high_s16(d), vget_high_s16(d))));
}
NOH_UNUSED static inline noh_i4 noh_i4_add_four_times(noh_i4 a, noh_i4 b) { return vaddq_s32(a, vshlq_n_s32(b, 2)); }
NOH_UNUSED static inline int noh_i4_any_at_most(noh_i4 a, int32_t limit) { return vminvq_s32(a) <= limit; }
NOH_UNUSED static inline void noh_i4_store(int32_t *to, noh_i4 v) { vst1q_s32(to, v); }
#else
typedef struct noh_h8 {
    int16_t s[8];
} noh_h8;
typedef struct noh_i4 {
    int32_t i[4];
} noh_i4;
NOH_UNUSED static inline void noh_h8_load_i8(const int8_t *from, noh_h8 out[2])
{
    for (int i = 0; i < 16; i++) out[i / 8].s[i % 8] = from[i];
}
NOH_UNUSED static inline noh_h8 noh_h8_pair(int32_t pair)
{
    noh_h8 r;
    for (int i = 0; i < 8; i++) r.s[i] = (int16_t)((uint32_t)pair >> (i % 2 ? 16 : 0) & 0xffffu);
    return r;
}
NOH_UNUSED static inline noh_h8 noh_h8_sub(noh_h8 a, noh_h8 b)
{
    for (int i = 0; i < 8; i++) a.s[i] = (int16_t)(a.s[i] - b.s[i]);
    return a;
}
NOH_UNUSED static inline noh_h8 noh_h8_max(noh_h8 a, noh_h8 b)
{
    for (int i = 0; i < 8; i++) a.s[i] = a.s[i] > b.s[i] ? a.s[i] : b.s[i];
    return a;
}
NOH_UNUSED static inline noh_i4 noh_i4_zero(void)
{
    const noh_i4 r = { { 0, 0, 0, 0 } };
    return r;
}
NOH_UNUSED static inline noh_i4 noh_i4_add_squares(noh_i4 sum, noh_h8 d)
{
    for (int i = 0; i < 4; i++) sum.i[i] += d.s[2 * i] * d.s[2 * i] + d.s[2 * i + 1] * d.s[2 * i + 1];
    return sum;
}
NOH_UNUSED static inline noh_i4 noh_i4_add_four_times(noh_i4 a, noh_i4 b)
{
    for (int i = 0; i < 4; i++) a.i[i] += 4 * b.i[i];
    return a;
}
NOH_UNUSED static inline int noh_i4_any_at_most(noh_i4 a, int32_t limit)
{
    return a.i[0] <= limit || a.i[1] <= limit || a.i[2] <= limit || a.i[3] <= limit;
}
NOH_UNUSED static inline void noh_i4_store(int32_t *to, noh_i4 v) { memcpy(to, v.i, sizeof v.i); }
#endif
/* clang-format on */

#endif
