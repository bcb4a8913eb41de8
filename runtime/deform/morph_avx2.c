/* morph_avx2.c: noh_morph_accumulate with AVX2, where the compiler makes single functions of it. The processor is asked
 * before it is called: noh_morph_kernel_find. */
#include "deform/morph_accumulate_internal.h"

#ifdef NOH_AVX2_AT_RUN_TIME

NOH_TARGET_AVX2 NOH_ALWAYS_INLINE void add_wide(const noh_morph_rows *rows, const morph_field f[3],
                                                float *const layers[3])
{
    noh_add_rows8(rows, f, layers, layers[2] ? 3 : 2);
}

NOH_TARGET_AVX2 void noh_morph_accumulate_wide(const noh_mesh *mesh, const float *weights,
                                               const noh_morph_layers *layers)
{
    noh_morph_accumulate_some_wide(mesh, weights, layers, NULL);
}

NOH_TARGET_AVX2 void noh_morph_accumulate_some_wide(const noh_mesh *mesh, const float *weights,
                                                    const noh_morph_layers *layers, const uint8_t *groups)
{
    noh_accumulate_targets(mesh, weights, layers, groups, add_wide);
}

#endif
