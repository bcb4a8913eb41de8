/* body.h: what the library keeps to itself of runtime/noh/body.h. */
#ifndef NOH_SIM_WORLD_H
#define NOH_SIM_WORLD_H

#include <stdint.h>

#include "noh/body.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_PUSH_OUT_SPEED 1.0f /* metres per second at which overlaps separate */

#ifdef __cplusplus
}
#endif

#endif
