/* face.h: what the library keeps to itself of face.h. */
#ifndef NOH_FACE_IDENTITY_H
#define NOH_FACE_IDENTITY_H

#include "noh/face.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_IDENTITY_NONE 0xffffu

/* Get the weight at which target closings[i] closes a person's lids: 0.5..2, 1 on the mesh's own face.
 * shapes  weights[target_count] of the person */
float noh_identity_shut(const noh_identity *identity, const float *weights, uint32_t i);

#ifdef __cplusplus
}
#endif

#endif
