/* f16_bound.h: a bound on the error of accumulating in half floats, proven from the data. */
#ifndef NOH_CONVERT_MORPH_F16_BOUND_H
#define NOH_CONVERT_MORPH_F16_BOUND_H

#include "morph_encode.h"

/* The largest error that blending all targets one after another into half floats can make, for any weights in -2 to 2,
 * whether the driver rounds to nearest or toward zero.
 *
 * Each addition rounds a partial sum s by at most 2^-10 |s| (toward zero; to nearest, half of that), or by 2^-24 if s
 * is subnormal. A GPU that rounds the summand toward zero, too, and the sum to nearest (NVIDIA), errs by half as much
 * more at most. |s| is bounded by the sum of 2 |delta| of the targets so far, plus the error so far. position:
 * Euclidean, model units; direction: per component of normal or tangent. Returns 1 when out of memory. */
int f16_bound(const morph_encoding *e, float *position, float *direction);

#endif
