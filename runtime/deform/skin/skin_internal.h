/* skin_internal.h: the private part of deform.h. */
#ifndef NOH_DEFORM_SKIN_INTERNAL_H
#define NOH_DEFORM_SKIN_INTERNAL_H

#include "noh/deform.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Split a matrix of 3 rows of 4. If its axes vanish or lie in a plane the rotation is undefined: it is then the
 * identity, and all of A is stretch. */
void noh_dual_quaternion_from_matrix(const float matrix[12], noh_dual_quaternion *out);

/* Get the instruction set that noh_skin_vertices was compiled for: "scalar", "sse2", "avx2" or "neon". */
const char *noh_skin_simd(void);

#ifdef __cplusplus
}
#endif

#endif
