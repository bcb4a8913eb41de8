/* quat.h: quaternions xyzw in double precision. */
#ifndef NOH_CONVERT_BASE_QUAT_H
#define NOH_CONVERT_BASE_QUAT_H

#ifdef __cplusplus
extern "C" {
#endif

double quat_dot(const double *a, const double *b);

/* The rotation b followed by a. out may be neither of them. */
void quat_multiply(const double *a, const double *b, double *out);

/* Scale to length 1. Returns 0 and leaves q alone when it has no length. */
int quat_normalize(double *q);

/* Negate q if that brings it nearer to `to`: the same rotation, in the same hemisphere. */
void quat_align(double *q, const double *to);

/* The angle of the rotation from one unit quaternion to another, 0 to pi. */
double quat_angle(const double *a, const double *b);

/* Spherical interpolation of unit quaternions along the shorter way; t from 0 to 1. */
void quat_slerp(const double *a, const double *b, double t, double *out);

/* Interpolate along the shorter chord, then normalise, as the player does between frames. */
void quat_nlerp(const double *a, const double *b, double t, double *out);

/* The rotation matrix of a unit quaternion: three columns. */
void quat_columns(const double *q, double *out);

#ifdef __cplusplus
}
#endif
#endif
