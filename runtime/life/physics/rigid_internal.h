/* rigid_internal.h: the private part of body.h. */
#ifndef NOH_SIM_RIGID_INTERNAL_H
#define NOH_SIM_RIGID_INTERNAL_H

#include "noh/body.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Get the kinetic energy, including spin, in joules. */
float noh_rigid_energy(const noh_rigid *body);

#ifdef __cplusplus
}
#endif

#endif
