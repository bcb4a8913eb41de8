/* ik_chain_internal.h: the private part of body.h. */
#ifndef NOH_SIM_IK_CHAIN_INTERNAL_H
#define NOH_SIM_IK_CHAIN_INTERNAL_H

#include "noh/body.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Clamp a local rotation to a limit.
 * bone  [3] the joint's bone, the axis of twist, in the joint's space
 * bind  [4] or NULL: the identity */
void noh_ik_limit_apply(const noh_ik_limit *limit, const float bone[3], const float *bind, float rotation[4]);

#ifdef __cplusplus
}
#endif

#endif
