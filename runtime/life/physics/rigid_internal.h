/* rigid_internal.h: the private part of body.h. */
#ifndef NOH_SIM_RIGID_INTERNAL_H
#define NOH_SIM_RIGID_INTERNAL_H

#include "noh/body.h"

#ifdef __cplusplus
extern "C" {
#endif

#ifdef __cplusplus
}
#endif

#endif
