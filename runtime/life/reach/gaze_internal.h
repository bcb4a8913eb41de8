/* gaze_internal.h: the private part of low_life.h. */
#ifndef NOH_SIM_GAZE_INTERNAL_H
#define NOH_SIM_GAZE_INTERNAL_H

#include "noh/body.h"
#include "noh/low_life.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Check a state that comes from outside.
 * returns  NULL if it may be used, else a constant message */
const char *noh_gaze_check(const noh_gaze *gaze);

#ifdef __cplusplus
}
#endif

#endif
