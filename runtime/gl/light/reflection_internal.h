/* reflection_internal.h: the private part of light.h. */
#ifndef NOH_LIGHT_REFLECTION_INTERNAL_H
#define NOH_LIGHT_REFLECTION_INTERNAL_H

#include <stddef.h>

#include "noh/light.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_REFLECTION_LEVELS 5u

#ifdef __cplusplus
}
#endif

#endif
