/* morph_avx2.c: noh_morph_accumulate with AVX2, for compilers that can target single functions. noh_morph_kernel_find
 * queries the processor before it is called. */
#include "deform/morph/morph_accumulate_internal.h"
#include "noh/pack.h"
#include "noh/deform.h"

#ifdef NOH_AVX2_AT_RUN_TIME

NOH_TARGET_AVX2 void noh_morph_accumulate_wide(const noh_mesh *mesh, const float *weights,
                                               const noh_morph_layers *layers)
{
    noh_morph_accumulate_some_wide(mesh, weights, layers, NULL);
}

NOH_TARGET_AVX2 void noh_morph_accumulate_some_wide(const noh_mesh *mesh, const float *weights,
                                                    const noh_morph_layers *layers, const uint8_t *groups)
{
    noh_accumulate_targets(mesh, weights, layers, groups, noh_v8_add_rows);
}

#endif
