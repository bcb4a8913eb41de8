/* actor_hair_internal.h: the private part of modules.h. */
#ifndef NOH_ACTORS_ACTOR_HAIR_INTERNAL_H
#define NOH_ACTORS_ACTOR_HAIR_INTERNAL_H

#include "noh/modules.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_HAIR_MOVING_PIXELS 60.0f

#ifdef __cplusplus
}
#endif

#endif
