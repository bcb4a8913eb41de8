/* low_life.h: what the library keeps to itself of runtime/noh/low_life.h. */
#ifndef NOH_SIM_HAIR_H
#define NOH_SIM_HAIR_H

#include <stddef.h>
#include <stdint.h>

#include "noh/body.h"
#include "noh/low_life.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Check hair of this desc whose bytes come from outside.
 * shapes   hair: noh_hair_size bytes, aligned to 16
 * returns  NULL if it may be used, else a constant message */
const char *noh_hair_check(const noh_hair *hair, const noh_hair_desc *desc);

/* Compute a point of the Catmull-Rom curve through the points of a hair, as used for strips. Tangents are half the
 * difference of the neighbours; with the full difference, as in the source, the curve overshoots.
 * shapes  points[count][3]
 * ranges  count 2..; t 0 the root, 1 the tip */
void noh_hair_curve(const float *points, uint32_t count, float t, float out[3]);

#ifdef __cplusplus
}
#endif

#endif
