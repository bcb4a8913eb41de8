/* ragdoll_kernels.h: the step of ragdolls compiled again: for one lane everywhere, and for what x86 has (Makefile,
 * KERNELS). */
#ifndef NOH_TESTS_RAGDOLL_KERNELS_H
#define NOH_TESTS_RAGDOLL_KERNELS_H

#include "life/physics/ragdoll_internal.h"

#if defined(__x86_64__)
void noh_ragdoll_step_dolls_scalar(const noh_ragdoll_shape *shape, const noh_world *world,
                                   noh_ragdoll_doll *const *dolls, uint32_t count, float *scratch, float size);
void noh_ragdoll_step_dolls_sse2(const noh_ragdoll_shape *shape, const noh_world *world, noh_ragdoll_doll *const *dolls,
                                 uint32_t count, float *scratch, float size);
void noh_ragdoll_step_dolls_avx2(const noh_ragdoll_shape *shape, const noh_world *world, noh_ragdoll_doll *const *dolls,
                                 uint32_t count, float *scratch, float size);
#endif

#endif
