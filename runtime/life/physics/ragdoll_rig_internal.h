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

/* The row of the nearest joint above one, or NOH_NONE. */
uint32_t noh_ragdoll_row_above(const noh_ragdoll_source *source, const noh_ragdoll_row *rows, uint32_t count,
                               uint32_t joint);

#ifdef __cplusplus
}
#endif

#endif
