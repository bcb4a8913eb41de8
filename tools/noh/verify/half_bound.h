/* half_bound.h: how far half-float accumulators can be off for weights that are known, or known to lie in a range. */
#ifndef NOH_NOH_VERIFY_HALF_BOUND_H
#define NOH_NOH_VERIFY_HALF_BOUND_H

#include "noh/base.h"
#include "noh/pack.h"

/* The known facts about the weights and the rounding of sums. */
typedef struct half_range {
    const float *low, *high; /* [target_count]: the range of each weight; both 0: the target is not there */
    int once;           /* sums are rounded at the end alone, as paths do that sum in floats; else after each target,
                              * in the targets' order */
    noh_half_mode mode; /* NOH_HALF_UNKNOWN: either way, and products may be rounded before they are added */
} half_range;

typedef enum half_layer { HALF_POSITION, HALF_NORMAL } half_layer;

/* How far each accumulation texel of a layer may be off, errors[touched_count]: Euclidean distances, model units.
 * Returns 0; below 0: out of memory. */
int half_errors(const noh_mesh *mesh, const half_range *range, half_layer layer, double *errors);

/* The largest distance of a position, model units; below 0: out of memory. */
double half_bound(const noh_mesh *mesh, const half_range *range);

#endif
