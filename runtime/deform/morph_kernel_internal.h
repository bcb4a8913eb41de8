/* morph_kernel_internal.h (private to deform/): add one run of delta words to the layers.
 *
 * Words and layers both run x, y, z, x, y, z..., so a run of texels is a run of words, and vectors of any width need no
 * shuffles. Each kernel does, per word,
 *   layer[i] = layer[i] + (float)field(word[i]) * weight
 * A field has at most 24 bits and converts exactly; the product and the sum round once each, in this order. No
 * operation mixes words, so the width of the vectors does not matter: all kernels give the same bits. */
#ifndef NOH_DEFORM_MORPH_KERNEL_INTERNAL_H
#define NOH_DEFORM_MORPH_KERNEL_INTERNAL_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/processor_internal.h"

#if defined(NOH_AVX2) || defined(NOH_AVX2_AT_RUN_TIME)
#include <immintrin.h>
#endif
#if defined(NOH_AVX2)
#define NOH_MORPH_SIMD "avx2"
#elif defined(NOH_SSE2)
#include <emmintrin.h>
#define NOH_MORPH_SIMD "sse2"
#elif defined(NOH_NEON)
#include <arm_neon.h>
#define NOH_MORPH_SIMD "neon"
#else
#define NOH_MORPH_SIMD "scalar"
#endif

/* Where a field lies in a word, and the weight of one unit of it. The left shift drops the bits above the field, the
 * arithmetic right shift those below it, and extends the sign. */
typedef struct morph_field {
    uint32_t left, right;
    float weight;
} morph_field;

static inline float noh_field_value(uint32_t word, morph_field f)
{
    /* C99 leaves the right shift of a negative value to the compiler; all known ones shift in the sign, and a test says
     * so */
    return (float)((int32_t)(word << f.left) >> f.right) * f.weight;
}

static inline void noh_add_run_scalar(const uint32_t *words, size_t count, morph_field f, float *layer)
{
    for (size_t i = 0; i < count; i++) {
        layer[i] = layer[i] + noh_field_value(words[i], f);
    }
}

#if defined(NOH_SSE2) /* AVX2 has it too */
NOH_ALWAYS_INLINE __m128 noh_add_four(__m128i q, morph_field f, __m128 layer)
{
    q = _mm_sra_epi32(_mm_sll_epi32(q, _mm_cvtsi32_si128((int)f.left)), _mm_cvtsi32_si128((int)f.right));
    return _mm_add_ps(layer, _mm_mul_ps(_mm_cvtepi32_ps(q), _mm_set1_ps(f.weight)));
}

NOH_ALWAYS_INLINE void noh_add_step4(const uint32_t *words, morph_field f, float *layer)
{
    __m128i q = _mm_loadu_si128((const __m128i *)(const void *)words);
    _mm_storeu_ps(layer, noh_add_four(q, f, _mm_loadu_ps(layer)));
}

/* The last one to three words of a run, in one register. Runs are rows of rectangles, so they end often: this saves a
 * sixth of the whole time with AVX2. Nothing past the run is read or written. */
NOH_ALWAYS_INLINE __m128i noh_load_tail(const void *from, size_t count)
{
    __m128i low = count >= 2 ? _mm_loadl_epi64((const __m128i *)from) : _mm_setzero_si128();
    int32_t last;
    if (count == 2) {
        return low;
    }
    memcpy(&last, (const uint8_t *)from + 4 * (count - 1), 4);
    return count == 3 ? _mm_unpacklo_epi64(low, _mm_cvtsi32_si128(last)) : _mm_cvtsi32_si128(last);
}

NOH_ALWAYS_INLINE void noh_add_tail(const uint32_t *words, size_t count, morph_field f, float *layer)
{
    __m128 sum = noh_add_four(noh_load_tail(words, count), f, _mm_castsi128_ps(noh_load_tail(layer, count)));
    if (count == 1) {
        _mm_store_ss(layer, sum);
    } else {
        _mm_storel_epi64((__m128i *)(void *)layer, _mm_castps_si128(sum));
        if (count == 3) {
            _mm_store_ss(layer + 2, _mm_movehl_ps(sum, sum));
        }
    }
}
#endif

#if defined(NOH_AVX2) || defined(NOH_AVX2_AT_RUN_TIME)
NOH_TARGET_AVX2 NOH_ALWAYS_INLINE void noh_add_step8(const uint32_t *words, morph_field f, float *layer)
{
    __m256i q = _mm256_loadu_si256((const __m256i *)(const void *)words);
    q = _mm256_sra_epi32(_mm256_sll_epi32(q, _mm_cvtsi32_si128((int)f.left)), _mm_cvtsi32_si128((int)f.right));
    _mm256_storeu_ps(
        layer, _mm256_add_ps(_mm256_loadu_ps(layer), _mm256_mul_ps(_mm256_cvtepi32_ps(q), _mm256_set1_ps(f.weight))));
}
#elif defined(NOH_NEON)
NOH_ALWAYS_INLINE void noh_add_step4(const uint32_t *words, morph_field f, float *layer)
{
    int32x4_t q = vreinterpretq_s32_u32(vld1q_u32(words));
    q = vshlq_s32(vshlq_s32(q, vdupq_n_s32((int32_t)f.left)), vdupq_n_s32(-(int32_t)f.right));
    vst1q_f32(layer, vaddq_f32(vld1q_f32(layer), vmulq_f32(vcvtq_f32_s32(q), vdupq_n_f32(f.weight))));
}
#endif

#if defined(NOH_SSE2)
/* What is left of a run behind its wide steps: four words at a time, then a tail. */
NOH_ALWAYS_INLINE void noh_add_rest(const uint32_t *words, size_t count, const morph_field f[3], float *const layers[3],
                                    int layer_count, size_t i)
{
    for (; i + 4u <= count; i += 4u) {
        noh_add_step4(words + i, f[0], layers[0] + i);
        noh_add_step4(words + i, f[1], layers[1] + i);
        if (layer_count == 3) noh_add_step4(words + i, f[2], layers[2] + i);
    }
    for (int l = 0; l < layer_count && i < count; l++) {
        noh_add_tail(words + i, count - i, f[l], layers[l] + i);
    }
}
#endif

#if defined(NOH_AVX2) || defined(NOH_AVX2_AT_RUN_TIME)
NOH_TARGET_AVX2 NOH_ALWAYS_INLINE void noh_add_run_wide(const uint32_t *words, size_t count, const morph_field f[3],
                                                        float *const layers[3], int layer_count)
{
    size_t i = 0;
    for (; i + 8u <= count; i += 8u) {
        noh_add_step8(words + i, f[0], layers[0] + i);
        noh_add_step8(words + i, f[1], layers[1] + i);
        if (layer_count == 3) noh_add_step8(words + i, f[2], layers[2] + i);
    }
    noh_add_rest(words, count, f, layers, layer_count, i);
}
#endif

/* A run into all layers, of which there are two or three: a constant wherever this is inlined. Left to itself gcc calls
 * it, and looks shifts and weights up in every step, as it does in a loop over the layers: with SSE2 that takes up to
 * twice as long. */
NOH_ALWAYS_INLINE void noh_add_run(const uint32_t *words, size_t count, const morph_field f[3], float *const layers[3],
                                   int layer_count)
{
#if defined(NOH_AVX2)
    noh_add_run_wide(words, count, f, layers, layer_count);
#elif defined(NOH_SSE2)
    noh_add_rest(words, count, f, layers, layer_count, 0);
#else
    size_t i = 0;
#if defined(NOH_NEON)
    for (; i + 4u <= count; i += 4u) {
        noh_add_step4(words + i, f[0], layers[0] + i);
        noh_add_step4(words + i, f[1], layers[1] + i);
        if (layer_count == 3) noh_add_step4(words + i, f[2], layers[2] + i);
    }
#endif
    for (int l = 0; l < layer_count; l++) {
        noh_add_run_scalar(words + i, count - i, f[l], layers[l] + i);
    }
#endif
}

#endif
