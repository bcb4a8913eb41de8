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

#include "core/base/simd_internal.h"
#include "core/base/compiler_internal.h"

/* The position of a field in a word, and the weight of one unit. The left shift drops the bits above the field; the
 * arithmetic right shift drops the bits below it and extends the sign. */
typedef struct morph_field {
    uint32_t left, right;
    float weight;
} morph_field;

#define NOH_MORPH_LANES 8u    /* of the widest vectors */
#define NOH_MORPH_ALONE 0xffu /* in place of a lead: nothing outside the run may be touched */

static inline float noh_field_value(uint32_t word, morph_field f)
{
    /* C99 leaves the right shift of a negative value to the compiler; all known compilers shift in the sign, and a test
     * checks it */
    return (float)((int32_t)(word << f.left) >> f.right) * f.weight;
}

static inline void noh_add_run_scalar(const uint32_t *words, size_t count, morph_field f, float *layer)
{
    for (size_t i = 0; i < count; i++) {
        layer[i] = layer[i] + noh_field_value(words[i], f);
    }
}

/* Rows of a rectangle: contiguous in the words, `stride` floats apart in the layers. */
typedef struct noh_morph_rows {
    const uint32_t *words;
    size_t count; /* words of a row, and floats in each layer */
    size_t rows, stride;
    size_t lead; /* below NOH_MORPH_LANES: vectors may begin `lead` words and floats before a row, and end at the next
                  * multiple of NOH_MORPH_LANES after it; or NOH_MORPH_ALONE */
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

/* Not inlined: it is rare, and would be a quarter of each kernel. */
NOH_NEVER_INLINE static void noh_add_rows_scalar(const noh_morph_rows *r, const morph_field f[3],
                                                 float *const layers[3])
{
    noh_each_row(r, f, layers, noh_add_row_scalar);
}

#if NOH_LANES > 1
#define LANES(name) noh_v4_##name
#define LANES_TYPE noh_v4
#define LANES_COUNT 4u
#define LANES_INLINE NOH_UNUSED NOH_ALWAYS_INLINE
#include "deform/morph/morph_rows_template.h"
#endif
#if defined(NOH_SIMD_V8)
#define LANES(name) noh_v8_##name
#define LANES_TYPE noh_v8
#define LANES_COUNT 8u
#define LANES_INLINE NOH_TARGET_AVX2 NOH_ALWAYS_INLINE
#include "deform/morph/morph_rows_template.h"
#endif

/* Add rows with the widest vectors that the whole library is compiled for. */
NOH_ALWAYS_INLINE void noh_add_rows(const noh_morph_rows *r, const morph_field f[3], float *const layers[3])
{
#if NOH_LANES == 8
    noh_v8_add_rows(r, f, layers);
#elif NOH_LANES == 4
    noh_v4_add_rows(r, f, layers);
#else
    noh_add_rows_scalar(r, f, layers);
#endif
}

#endif
