/* amplitude_internal.h: the private part of face.h. */
#ifndef NOH_FACE_AMPLITUDE_INTERNAL_H
#define NOH_FACE_AMPLITUDE_INTERNAL_H

#include "noh/face.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Get the shape and weight for a mean of |samples| at a peak level of `loud` (0: silence). */
noh_viseme noh_amplitude_shape(uint32_t mean, uint32_t loud, float *weight);

#ifdef __cplusplus
}
#endif

#endif
