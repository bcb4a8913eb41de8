/* trig_internal.h: the private part of low_core.h. */
#ifndef NOH_BASE_TRIG_INTERNAL_H
#define NOH_BASE_TRIG_INTERNAL_H

#include <stdint.h>

#include "noh/low_core.h"

#ifdef __cplusplus
extern "C" {
#endif

#ifdef __cplusplus
}
#endif

#endif
