/* feet_internal.h: the private part of low_life.h. */
#ifndef NOH_SIM_FEET_INTERNAL_H
#define NOH_SIM_FEET_INTERNAL_H

#include "noh/body.h"
#include "noh/low_life.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- feet ---- */

/* Move the origin of the world: all positions p become p - by. */
void noh_feet_shift(noh_feet *feet, const float by[3]);

/* Check a state that comes from outside.
 * returns  NULL if it may be used, else a constant message */
const char *noh_feet_check(const noh_feet *feet);

#ifdef __cplusplus
}
#endif

#endif
