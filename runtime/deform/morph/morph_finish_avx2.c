/* morph_finish_avx2.c: noh_morph_finish with AVX2, for compilers that can target single functions.
 * noh_morph_kernel_find queries the processor before it is called. */
#include "deform/morph/morph_finish_wide_internal.h"
#include "noh/pack.h"
#include "noh/deform.h"

#ifdef NOH_AVX2_AT_RUN_TIME

NOH_TARGET_AVX2 void noh_morph_finish_wide(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first,
                                           uint32_t count, void *out)
{
    noh_v8_finish(mesh, layers, first, count, out);
}

#endif
