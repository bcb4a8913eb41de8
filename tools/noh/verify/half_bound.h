/* half_bound.h: how far half-float accumulators can be off for weights that are known, or known to lie in a range. */
#ifndef NOH_NOH_VERIFY_HALF_BOUND_H
#define NOH_NOH_VERIFY_HALF_BOUND_H

#include "deform/morph.h"

/* The sums are rounded to half after each target, in the targets' order; once: only at the end, as paths do that sum
 * in floats. mode: how; NOH_HALF_UNKNOWN: either way, and products may be rounded before they are added.
 * shapes   low[target_count], high[target_count]: the range of each weight; both 0: the target is not there
 * returns  the largest Euclidean distance of a vertex, model units; below 0: out of memory */
double half_bound(const noh_mesh *mesh, const float *low, const float *high, int once, noh_half_mode mode);

#endif
