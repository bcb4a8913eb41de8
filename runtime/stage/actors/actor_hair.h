/* modules.h: what the library keeps to itself of runtime/noh/modules.h. */
#ifndef NOH_ACTORS_ACTOR_HAIR_H
#define NOH_ACTORS_ACTOR_HAIR_H

#include "noh/modules.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_HAIR_MOVING_PIXELS 60.0f

#ifdef __cplusplus
}
#endif

#endif
