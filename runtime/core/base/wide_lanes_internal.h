/* wide_lanes_internal.h: eight floats side by side, for functions that are compiled with AVX2 in a library that is not:
 * what lanes_internal.h has, under names of its own, as far as such functions call it. */
#ifndef NOH_BASE_WIDE_LANES_INTERNAL_H
#define NOH_BASE_WIDE_LANES_INTERNAL_H

#include <stddef.h>

#include "core/base/processor_internal.h"

#ifdef NOH_AVX2_AT_RUN_TIME
#include <immintrin.h>

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 wide_set(float v)
{
    return _mm256_set1_ps(v);
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 wide_add(__m256 a, __m256 b)
{
    return _mm256_add_ps(a, b);
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 wide_sub(__m256 a, __m256 b)
{
    return _mm256_sub_ps(a, b);
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 wide_mul(__m256 a, __m256 b)
{
    return _mm256_mul_ps(a, b);
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 wide_div(__m256 a, __m256 b)
{
    return _mm256_div_ps(a, b);
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 wide_sqrt(__m256 a)
{
    return _mm256_sqrt_ps(a);
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 wide_larger(__m256 a, __m256 b)
{
    return _mm256_max_ps(a, b);
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 wide_less(__m256 a, __m256 b)
{
    return _mm256_cmp_ps(a, b, _CMP_LT_OQ);
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE int wide_any(__m256 mask)
{
    return _mm256_movemask_ps(mask) != 0;
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 wide_choose(__m256 mask, __m256 yes, __m256 no)
{
    return _mm256_blendv_ps(no, yes, mask);
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 wide_negate(__m256 a)
{
    return _mm256_xor_ps(a, _mm256_set1_ps(-0.0f));
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 wide_abs(__m256 a)
{
    return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a);
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 wide_with_sign(__m256 a, __m256 sign)
{
    return _mm256_xor_ps(a, _mm256_and_ps(sign, _mm256_set1_ps(-0.0f)));
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 wide_field(__m256 bits, int left, int right)
{
    return _mm256_cvtepi32_ps(_mm256_srai_epi32(_mm256_slli_epi32(_mm256_castps_si256(bits), left), right));
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 wide_halves(__m256 x, __m256 y)
{
    const __m256i high = _mm256_slli_epi32(_mm256_castps_si256(y), 16);
    return _mm256_castsi256_ps(_mm256_blend_epi16(_mm256_castps_si256(x), high, 0xaa));
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 wide_dot3(const __m256 a[3], const __m256 b[3])
{
    return wide_add(wide_add(wide_mul(a[0], b[0]), wide_mul(a[1], b[1])), wide_mul(a[2], b[2]));
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE void wide_store(float *to, __m256 v)
{
    _mm256_storeu_ps(to, v);
}

/* Two 4 x 4 matrices side by side, transposed. */
NOH_TARGET_AVX2 NOH_ALWAYS_INLINE void wide_turn(const __m256 pairs[4], __m256 out[4])
{
    const __m256 a = _mm256_unpacklo_ps(pairs[0], pairs[1]), b = _mm256_unpackhi_ps(pairs[0], pairs[1]);
    const __m256 c = _mm256_unpacklo_ps(pairs[2], pairs[3]), d = _mm256_unpackhi_ps(pairs[2], pairs[3]);
    out[0] = _mm256_shuffle_ps(a, c, 0x44);
    out[1] = _mm256_shuffle_ps(a, c, 0xee);
    out[2] = _mm256_shuffle_ps(b, d, 0x44);
    out[3] = _mm256_shuffle_ps(b, d, 0xee);
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE void wide_columns(const float *rows, size_t stride, __m256 out[4])
{
    __m256 pairs[4];
    NOH_UNROLL
    for (size_t i = 0; i < 4; i++) {
        pairs[i] = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(rows + i * stride)),
                                        _mm_loadu_ps(rows + (i + 4) * stride), 1);
    }
    wide_turn(pairs, out);
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE void wide_triples(const float *rows, __m256 out[3])
{
    const __m256 a = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(rows)), _mm_loadu_ps(rows + 12), 1);
    const __m256 b = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(rows + 4)), _mm_loadu_ps(rows + 16), 1);
    const __m256 c = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(rows + 8)), _mm_loadu_ps(rows + 20), 1);
    const __m256 xy = _mm256_shuffle_ps(b, c, 0x9e), yz = _mm256_shuffle_ps(a, b, 0x49);
    out[0] = _mm256_shuffle_ps(a, xy, 0x8c);
    out[1] = _mm256_shuffle_ps(yz, xy, 0xd8);
    out[2] = _mm256_shuffle_ps(yz, c, 0xcd);
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE void wide_rows(const __m256 columns[4], float *rows, size_t stride)
{
    __m256 pairs[4];
    wide_turn(columns, pairs);
    NOH_UNROLL
    for (size_t i = 0; i < 4; i++) {
        _mm_storeu_ps(rows + i * stride, _mm256_castps256_ps128(pairs[i]));
        _mm_storeu_ps(rows + (i + 4) * stride, _mm256_extractf128_ps(pairs[i], 1));
    }
}

#endif

#endif
