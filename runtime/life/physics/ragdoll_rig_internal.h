/* ragdoll_rig_internal.h: the private part of low_life.h. */
#ifndef NOH_SIM_RAGDOLL_RIG_INTERNAL_H
#define NOH_SIM_RAGDOLL_RIG_INTERNAL_H

#include "noh/clip.h"
#include "noh/low_life.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Get a joint's transform in the bind pose, in the skeleton's unit. */
void noh_ragdoll_bind(const noh_skeleton *skeleton, uint32_t joint, float position[3], float rotation[4]);

#ifdef __cplusplus
}
#endif

#endif
