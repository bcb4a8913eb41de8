/* light.h: what the library keeps to itself of runtime/noh/light.h. */
#ifndef NOH_LIGHT_REFLECTION_H
#define NOH_LIGHT_REFLECTION_H

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
