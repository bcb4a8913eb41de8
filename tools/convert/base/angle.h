/* angle.h: sine, cosine and arc tangent in double precision, made of sums, products and square roots only: libm's last
 * bits differ between machines, these do not. Errors below 4e-16. */
#ifndef NOH_CONVERT_BASE_ANGLE_H
#define NOH_CONVERT_BASE_ANGLE_H

#ifdef __cplusplus
extern "C" {
#endif

/* Any finite angle; exact at multiples of 90 degrees. */
void angle_sin_cos_degrees(double degrees, double *sine, double *cosine);

/* The sine of 0 to pi/2 radians. */
double angle_sine(double radians);

/* The arc tangent of 0 to 1, in radians. */
double angle_arc_tangent(double ratio);

#ifdef __cplusplus
}
#endif
#endif
