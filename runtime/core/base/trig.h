/* trig.h: the trigonometry of the sampling and simulation paths, without libm.
 *
 *   noh_sin_cos        sine and cosine of an angle in radians
 *   noh_sin_cos_turn   the same of a 32-bit fraction of a turn
 *   noh_atan2          the angle of a direction
 *   noh_acos           the angle of a cosine, clamped
 *   noh_exp2           a power of two
 *   noh_log2           the logarithm to base two
 *   noh_turn_from_radians, noh_radians_from_turn
 *
 * Polynomials of our own (Chebyshev fits of the reduced functions), made of sums, products, quotients and square roots
 * only: the same bits on every machine. Errors are those of the float result against the exact function of the float
 * argument, measured over the stated range by the tests.
 *
 * A turn is an angle as a uint32_t, 2^32 to the full circle: it wraps by itself and adds without rounding, so that a
 * heading never drifts.
 * Threads: no state; any thread. */
#ifndef NOH_BASE_TRIG_H
#define NOH_BASE_TRIG_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_PI 3.14159265358979f

/* ranges  |radians| <= 1e6; outside (and for NaN) the angle is taken as 0
 * errors  at most 1.2e-7 absolute */
void noh_sin_cos(float radians, float *sine, float *cosine);

/* ranges  any
 * errors  at most 1.2e-7 absolute; exact at quarter turns; the sine near 0 at most 3e-7 relative */
void noh_sin_cos_turn(uint32_t turn, float *sine, float *cosine);

/* The angle of the direction (x, y), -pi to pi; 0 for (0, 0).
 * ranges  finite
 * errors  at most 4e-7 absolute, 3e-7 relative near 0 */
float noh_atan2(float y, float x);

/* The angle whose cosine is x, 0 to pi.
 * ranges  x is clamped to -1..1, because a dot product of unit vectors strays
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

/* ranges  |radians| <= 1e6 */
uint32_t noh_turn_from_radians(float radians);

/* -pi to pi. */
float noh_radians_from_turn(uint32_t turn);

#ifdef __cplusplus
}
#endif

#endif
