/* flock_internal.h: the private part of low_stage.h. */
#ifndef NOH_CROWD_FLOCK_INTERNAL_H
#define NOH_CROWD_FLOCK_INTERNAL_H

#include <stdint.h>

#include "noh/low_stage.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_FLOCK_RANGE 3.0f     /* metres within which neighbours repel each other */
#define NOH_FLOCK_REPULSION 5.0f /* metres per second squared, at contact of centres */
#define NOH_FLOCK_AVOIDANCE 10.0f

#ifdef __cplusplus
}
#endif

#endif
