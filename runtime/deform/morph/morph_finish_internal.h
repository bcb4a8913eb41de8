/* morph_finish_internal.h (private to deform/): shared by the kernels that finish vertices. */
#ifndef NOH_DEFORM_MORPH_FINISH_INTERNAL_H
#define NOH_DEFORM_MORPH_FINISH_INTERNAL_H

#include "core/base/simd_internal.h"
#include "core/base/processor_internal.h"
#include "noh/deform.h"
#include "noh/pack.h"

/* noh_morph_finish in plain C: the reference. */
void noh_morph_finish_scalar(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count,
                             void *out);

/* Adding it to a number below 2^22 rounds to the nearest integer, ties to even, in the lowest bits. */
#define NOH_ROUNDER 12582912.0f

/* A vector has a direction only if its square is above NOH_VANISHES (as in noh_normalize3) and below NOH_OVERFLOWS,
 * where products overflow. */
#define NOH_VANISHES 1e-30f
#define NOH_OVERFLOWS 1e30f

/* Blocks that run through each half of the kernel together. The dependency chain of one block takes about 200 cycles,
 * and a processor looks ahead by about as many instructions as a block has: with one block it would stall. */
#define NOH_FINISH_BLOCKS 4u

#ifdef NOH_AVX2_AT_RUN_TIME
/* noh_morph_finish with AVX2, for processors that have it. */
void noh_morph_finish_wide(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count,
                           void *out);
#endif

#endif
