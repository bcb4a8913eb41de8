/* morph_finish_internal.h (private to deform/): what the kernels that finish vertices share. */
#ifndef NOH_DEFORM_MORPH_FINISH_INTERNAL_H
#define NOH_DEFORM_MORPH_FINISH_INTERNAL_H

#include "core/base/simd_internal.h"
#include "core/base/processor_internal.h"
#include "noh/deform.h"
#include "noh/pack.h"

/* Added to a number below 2^22 it leaves the nearest integer, of two the even one, in the lowest bits. */
#define NOH_ROUNDER 12582912.0f

/* A direction whose square is no more has none: noh_normalize3. Nor has one whose square is as large as this, with which
 * products overflow. */
#define NOH_VANISHES 1e-30f
#define NOH_OVERFLOWS 1e30f

/* Blocks that go through each half of the kernel together: the chain of one is some 200 cycles long, and a processor
 * looks ahead by about as many instructions as a block has, so that it would wait. */
#define NOH_FINISH_BLOCKS 4u

#ifdef NOH_AVX2_AT_RUN_TIME
/* noh_morph_finish with AVX2, for processors that have it. */
void noh_morph_finish_wide(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count,
                           void *out);
#endif

#endif
