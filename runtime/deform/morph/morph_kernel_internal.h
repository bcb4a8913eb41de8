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

#include "core/base/processor_internal.h"

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

#define NOH_MORPH_LANES 8u    /* of the widest vectors */
#define NOH_MORPH_ALONE 0xffu /* in place of a lead: nothing beside the run may be touched */

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

/* Rows of a rectangle: one behind another in the words, `stride` floats apart in the layers. */
typedef struct noh_morph_rows {
    const uint32_t *words;
    size_t count; /* words of a row, and floats in each layer */
    size_t rows, stride;
    size_t lead; /* below NOH_MORPH_LANES: vectors may begin so many words and floats before a row, and end at the next
                  * multiple of NOH_MORPH_LANES behind it; or NOH_MORPH_ALONE */
} noh_morph_rows;

typedef void (*noh_row_function)(const uint32_t *words, size_t count, const morph_field f[3], float *const layers[3]);

/* For kernels that take a row at a time. */
NOH_ALWAYS_INLINE void noh_each_row(const noh_morph_rows *r, const morph_field f[3], float *const layers[3],
                                    noh_row_function row)
{
    for (size_t y = 0; y < r->rows; y++) {
        const size_t at = y * r->stride;
        float *const to[3] = { layers[0] + at, layers[1] + at, layers[2] ? layers[2] + at : NULL };
        row(r->words + y * r->count, r->count, f, to);
    }
}

static inline void noh_add_row_scalar(const uint32_t *words, size_t count, const morph_field f[3],
                                      float *const layers[3])
{
    for (int l = 0; l < 3 && layers[l]; l++) noh_add_run_scalar(words, count, f[l], layers[l]);
}

/* Called, since it is rare: inlined into each kernel it would be a quarter of them. */
NOH_NEVER_INLINE static void noh_add_rows_scalar(const noh_morph_rows *r, const morph_field f[3],
                                                 float *const layers[3])
{
    noh_each_row(r, f, layers, noh_add_row_scalar);
}

/* For each width of vectors: load, store, the sum of a layer and of what words add to it, the lanes first to end - 1 as
 * a mask, and what a mask chooses of two. The rows themselves are morph_rows_template.h. */
#if defined(NOH_SSE2) /* AVX2 has it too */
NOH_ALWAYS_INLINE __m128 noh_load4(const float *from)
{
    return _mm_loadu_ps(from);
}

NOH_ALWAYS_INLINE __m128i noh_words4(const uint32_t *from)
{
    return _mm_loadu_si128((const __m128i *)(const void *)from);
}

NOH_ALWAYS_INLINE void noh_store4(float *to, __m128 v)
{
    _mm_storeu_ps(to, v);
}

NOH_ALWAYS_INLINE __m128 noh_sum4(__m128i q, morph_field f, __m128 layer)
{
    q = _mm_sra_epi32(_mm_sll_epi32(q, _mm_cvtsi32_si128((int)f.left)), _mm_cvtsi32_si128((int)f.right));
    return _mm_add_ps(layer, _mm_mul_ps(_mm_cvtepi32_ps(q), _mm_set1_ps(f.weight)));
}

NOH_ALWAYS_INLINE __m128 noh_mask4(size_t first, size_t end)
{
    const __m128i lane = _mm_setr_epi32(0, 1, 2, 3), below = _mm_cmplt_epi32(lane, _mm_set1_epi32((int)first));
    return _mm_castsi128_ps(_mm_andnot_si128(below, _mm_cmplt_epi32(lane, _mm_set1_epi32((int)end))));
}

NOH_ALWAYS_INLINE __m128 noh_choose4(__m128 mask, __m128 yes, __m128 no)
{
    return _mm_or_ps(_mm_and_ps(mask, yes), _mm_andnot_ps(mask, no));
}

#define ROWS(name) noh_##name##4
#define ROWS_LANES 4u
#define ROWS_TYPE __m128
#define ROWS_WORDS __m128i
#define ROWS_MASK __m128
#define ROWS_INLINE NOH_ALWAYS_INLINE
#include "deform/morph/morph_rows_template.h"
#elif defined(NOH_NEON)
NOH_ALWAYS_INLINE float32x4_t noh_load4(const float *from)
{
    return vld1q_f32(from);
}

NOH_ALWAYS_INLINE int32x4_t noh_words4(const uint32_t *from)
{
    return vreinterpretq_s32_u32(vld1q_u32(from));
}

NOH_ALWAYS_INLINE void noh_store4(float *to, float32x4_t v)
{
    vst1q_f32(to, v);
}

NOH_ALWAYS_INLINE float32x4_t noh_sum4(int32x4_t q, morph_field f, float32x4_t layer)
{
    q = vshlq_s32(vshlq_s32(q, vdupq_n_s32((int32_t)f.left)), vdupq_n_s32(-(int32_t)f.right));
    return vaddq_f32(layer, vmulq_f32(vcvtq_f32_s32(q), vdupq_n_f32(f.weight)));
}

NOH_ALWAYS_INLINE uint32x4_t noh_mask4(size_t first, size_t end)
{
    static const uint32_t lanes[4] = { 0, 1, 2, 3 };
    const uint32x4_t lane = vld1q_u32(lanes);
    return vandq_u32(vcgeq_u32(lane, vdupq_n_u32((uint32_t)first)), vcltq_u32(lane, vdupq_n_u32((uint32_t)end)));
}

NOH_ALWAYS_INLINE float32x4_t noh_choose4(uint32x4_t mask, float32x4_t yes, float32x4_t no)
{
    return vbslq_f32(mask, yes, no);
}

#define ROWS(name) noh_##name##4
#define ROWS_LANES 4u
#define ROWS_TYPE float32x4_t
#define ROWS_WORDS int32x4_t
#define ROWS_MASK uint32x4_t
#define ROWS_INLINE NOH_ALWAYS_INLINE
#include "deform/morph/morph_rows_template.h"
#endif

#if defined(NOH_AVX2) || defined(NOH_AVX2_AT_RUN_TIME)
NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 noh_load8(const float *from)
{
    return _mm256_loadu_ps(from);
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256i noh_words8(const uint32_t *from)
{
    return _mm256_loadu_si256((const __m256i *)(const void *)from);
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE void noh_store8(float *to, __m256 v)
{
    _mm256_storeu_ps(to, v);
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 noh_sum8(__m256i q, morph_field f, __m256 layer)
{
    q = _mm256_sra_epi32(_mm256_sll_epi32(q, _mm_cvtsi32_si128((int)f.left)), _mm_cvtsi32_si128((int)f.right));
    return _mm256_add_ps(layer, _mm256_mul_ps(_mm256_cvtepi32_ps(q), _mm256_set1_ps(f.weight)));
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 noh_mask8(size_t first, size_t end)
{
    const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    const __m256i below = _mm256_cmpgt_epi32(_mm256_set1_epi32((int)first), lane);
    return _mm256_castsi256_ps(_mm256_andnot_si256(below, _mm256_cmpgt_epi32(_mm256_set1_epi32((int)end), lane)));
}

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE __m256 noh_choose8(__m256 mask, __m256 yes, __m256 no)
{
    return _mm256_blendv_ps(no, yes, mask);
}

#define ROWS(name) noh_##name##8
#define ROWS_LANES 8u
#define ROWS_TYPE __m256
#define ROWS_WORDS __m256i
#define ROWS_MASK __m256
#define ROWS_INLINE NOH_TARGET_AVX2 NOH_ALWAYS_INLINE
#include "deform/morph/morph_rows_template.h"
#endif

/* By the widest vectors that the whole library is compiled for. */
NOH_ALWAYS_INLINE void noh_add_rows(const noh_morph_rows *r, const morph_field f[3], float *const layers[3])
{
#if defined(NOH_AVX2)
    noh_add_rows8(r, f, layers);
#elif defined(NOH_SSE2) || defined(NOH_NEON)
    noh_add_rows4(r, f, layers);
#else
    noh_add_rows_scalar(r, f, layers);
#endif
}

#endif
