/* quat.h: quaternions x, y, z, w; unit unless said otherwise.
 *
 *   noh_quat_mul          first b, then a
 *   noh_quat_conjugate    the inverse of a unit quaternion
 *   noh_quat_dot
 *   noh_quat_normalize    length 1, identity where there is no length
 *   noh_quat_rotate       a vector
 *   noh_quat_nlerp        along the shorter way, normalised
 *   noh_quat_to_rotation  axis times angle, angle 0 to pi
 *   noh_quat_from_rotation
 *   noh_quat_twist        the part of a rotation about one axis */
#ifndef NOH_BASE_QUAT_H
#define NOH_BASE_QUAT_H

/* out may be a or b. */
void noh_quat_mul(const float a[4], const float b[4], float out[4]);
void noh_quat_conjugate(const float q[4], float out[4]);
void noh_quat_normalize(float q[4]);

/* out may be v. q need not be exactly unit: the error is of second order. */
void noh_quat_rotate(const float q[4], const float v[3], float out[3]);

/* ranges  t 0..1; row C4.1: b is negated where that is the shorter way. out may be a or b */
void noh_quat_nlerp(const float a[4], const float b[4], float t, float out[4]);

/* The rotation as a vector: unit axis times angle, the angle 0 to pi. */
void noh_quat_to_rotation(const float q[4], float rotation[3]);
void noh_quat_from_rotation(const float rotation[3], float q[4]);

/* The twist of q about the axis 0, 1 or 2, as a quaternion; identity where q
 * turns by pi about an axis across it (then no twist is defined).
 * source  swing-twist decomposition: the projection of the vector part on the axis */
void noh_quat_twist(const float q[4], unsigned axis, float out[4]);

static inline float noh_quat_dot(const float a[4], const float b[4])
{
    return (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]);
}

#endif
