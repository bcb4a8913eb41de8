/* trig.h: trigonometry for sampling and simulation, without libm.
 *
 *   noh_sin_cos        sine and cosine of an angle in radians
 *   noh_sin_cos_turn   sine and cosine of a 32-bit fraction of a turn
 *   noh_atan2          the angle of a direction
 *   noh_acos           the angle of a cosine, clamped
 *   noh_exp2           a power of two
 *   noh_log2           the logarithm to base two
 *   noh_turn_from_radians, noh_radians_from_turn
 *
 * Chebyshev fits of the reduced functions, from sums, products, quotients and square roots only: the same bits on every
 * machine. Errors compare the float result with the exact function of the float argument, measured by the tests over
 * the stated range.
 *
 * A turn is an angle as a uint32_t, 2^32 for the full circle. It wraps by itself and adds without rounding, so a
 * heading never drifts.
 * Threads: no state; any thread. */
#ifndef NOH_BASE_TRIG_H
#define NOH_BASE_TRIG_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_PI 3.14159265358979f

/* Sine and cosine of an angle.
 * ranges  |radians| <= 1e6; outside (and for NaN) the angle is taken as 0
 * errors  at most 1.2e-7 absolute */
void noh_sin_cos(float radians, float *sine, float *cosine);

/* Sine and cosine of a turn.
 * errors  at most 1.2e-7 absolute; exact at quarter turns; the sine near 0 at most 3e-7 relative */
void noh_sin_cos_turn(uint32_t turn, float *sine, float *cosine);

/* The angle of the direction (x, y), -pi to pi; 0 for (0, 0).
 * ranges  finite
 * errors  at most 4e-7 absolute, 3e-7 relative near 0 */
float noh_atan2(float y, float x);

/* The angle whose cosine is x, 0 to pi.
 * ranges  x is clamped to -1..1, because rounding can move a dot product of unit vectors outside
 * errors  at most 4e-7 */
float noh_acos(float x);

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

#ifdef __cplusplus
}
#endif

#endif
