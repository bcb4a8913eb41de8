/* quat.h: quaternions x, y, z, w; of unit length unless noted.
 *
 *   noh_quat_mul          first b, then a
 *   noh_quat_conjugate    the inverse of a unit quaternion
 *   noh_quat_dot
 *   noh_quat_normalize    to length 1; the identity for length 0
 *   noh_quat_rotate       a vector
 *   noh_quat_nlerp        between two rotations, along the shorter arc
 *   noh_quat_to_rotation  to axis times angle, 0 to pi
 *   noh_quat_from_rotation
 *   noh_quat_twist        the part of a rotation about one axis
 *
 * Threads: no state; any thread. */
#ifndef NOH_BASE_QUAT_H
#define NOH_BASE_QUAT_H

#ifdef __cplusplus
extern "C" {
#endif

/* out may be a or b. */
void noh_quat_mul(const float a[4], const float b[4], float out[4]);
void noh_quat_conjugate(const float q[4], float out[4]);
void noh_quat_normalize(float q[4]);

/* Rotate a vector. out may be v. q need not be exactly unit: the error is of second order. */
void noh_quat_rotate(const float q[4], const float v[3], float out[3]);

/* Interpolate linearly and normalise: the arc of slerp at a speed that varies slightly. b is negated if dot(a, b) is
 * negative, to take the shorter arc: q and -q are the same rotation.
 * ranges  t 0..1; out may be a or b
 * source  Granberg, Character Animation with Direct3D, 2009, chapter 4 (which omits the sign) */
void noh_quat_nlerp(const float a[4], const float b[4], float t, float out[4]);

/* Convert to and from a rotation vector: unit axis times angle, 0 to pi. */
void noh_quat_to_rotation(const float q[4], float rotation[3]);
void noh_quat_from_rotation(const float rotation[3], float q[4]);

/* The twist of q about the axis 0, 1 or 2, as a quaternion; the identity if q turns by pi about an axis orthogonal to
 * it (the twist is then undefined).
 * source  swing-twist decomposition: projection of the vector part on the axis */
void noh_quat_twist(const float q[4], unsigned axis, float out[4]);

static inline float noh_quat_dot(const float a[4], const float b[4])
{
    return (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]);
}

#ifdef __cplusplus
}
#endif

#endif
