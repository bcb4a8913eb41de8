/* skin_internal.h: the private part of deform.h. */
#ifndef NOH_DEFORM_SKIN_INTERNAL_H
#define NOH_DEFORM_SKIN_INTERNAL_H

#include "noh/deform.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Get the instruction set that noh_skin_vertices was compiled for: "scalar", "sse2", "avx2" or "neon". */
const char *noh_skin_simd(void);

#ifdef __cplusplus
}
#endif

#endif
