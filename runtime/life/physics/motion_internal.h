/* motion_internal.h: the private part of low_life.h. */
#ifndef NOH_SIM_MOTION_INTERNAL_H
#define NOH_SIM_MOTION_INTERNAL_H

#include <stdint.h>

#include "noh/body.h"
#include "noh/low_life.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_GRAVITY 9.82f /* metres per second squared */

#ifdef __cplusplus
}
#endif

#endif
