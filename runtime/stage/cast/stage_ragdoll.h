/* modules.h: what the library keeps to itself of runtime/noh/modules.h. */
#ifndef NOH_STAGE_STAGE_RAGDOLL_H
#define NOH_STAGE_STAGE_RAGDOLL_H

#include "noh/modules.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_ACTOR_RAGDOLL_BYTES 1488u

#ifdef __cplusplus
}
#endif

#endif
