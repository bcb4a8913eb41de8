/* flock_internal.h: the private part of low_stage.h. */
#ifndef NOH_CROWD_FLOCK_INTERNAL_H
#define NOH_CROWD_FLOCK_INTERNAL_H

#include <stdint.h>

#include "noh/low_stage.h"

#ifdef __cplusplus
extern "C" {
#endif

#ifdef __cplusplus
}
#endif

#endif
