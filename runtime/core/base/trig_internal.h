/* trig_internal.h: the private part of low_core.h. */
#ifndef NOH_BASE_TRIG_INTERNAL_H
#define NOH_BASE_TRIG_INTERNAL_H

#include <stdint.h>

#include "noh/low_core.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Sine and cosine of an angle.
 * ranges  |radians| <= 1e6; outside (and for NaN) the angle is taken as 0
 * errors  at most 1.2e-7 absolute */
void noh_sin_cos(float radians, float *sine, float *cosine);

/* The angle of the direction (x, y), -pi to pi; 0 for (0, 0).
 * ranges  finite
 * errors  at most 4e-7 absolute, 3e-7 relative near 0 */
float noh_atan2(float y, float x);

/* 2 to the power x.
 * ranges  below -126 the result is 0, above 127.999 it is 2^127.999
 * errors  at most 2e-7 relative */
float noh_exp2(float x);

/* The logarithm of x to base 2.
 * ranges  above 0 and finite; -150 for 0 and below
 * errors  at most 2e-7 absolute near 1, else 1e-7 relative */
float noh_log2(float x);

/* Radians to a turn.
 * ranges  |radians| <= 1e6 */
uint32_t noh_turn_from_radians(float radians);

/* A turn to radians, -pi to pi. */
float noh_radians_from_turn(uint32_t turn);

/* The twist of q about the axis 0, 1 or 2, as a quaternion; the identity if q turns by pi about an axis orthogonal to
 * it (the twist is then undefined).
 * source  swing-twist decomposition: projection of the vector part on the axis */
void noh_quat_twist(const float q[4], unsigned axis, float out[4]);

#ifdef __cplusplus
}
#endif

#endif
