#include "noh/low_core.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"
#include "core/base/trig_internal.h"

/* Sums only, with the signs of b applied beforehand: where the processor has fused multiply-adds, gcc 12 makes them out
 * of alternating sums and differences of products, whatever -ffp-contract says. */
void noh_quat_mul(const float a[4], const float b[4], float out[4])
{
    const float x = b[0], y = b[1], z = b[2], w = b[3], nx = -x, ny = -y, nz = -z;
    float r[4];
    r[0] = a[3] * x + a[0] * w + a[1] * z + a[2] * ny;
    r[1] = a[3] * y + a[0] * nz + a[1] * w + a[2] * x;
    r[2] = a[3] * z + a[0] * y + a[1] * nx + a[2] * w;
    r[3] = a[3] * w + a[0] * nx + a[1] * ny + a[2] * nz;
    memcpy(out, r, sizeof r);
}

void noh_quat_conjugate(const float q[4], float out[4])
{
    out[0] = -q[0];
    out[1] = -q[1];
    out[2] = -q[2];
    out[3] = q[3];
}

static void identity(float q[4])
{
    static const float unit[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
    memcpy(q, unit, sizeof unit);
}

void noh_quat_normalize(float q[4])
{
    float square = noh_quat_dot(q, q);
    if (square > 1e-30f) {
        float inverse = 1.0f / noh_sqrt(square);
        for (int i = 0; i < 4; i++) {
            q[i] *= inverse;
        }
    } else {
        identity(q);
    }
}

void noh_quat_rotate(const float q[4], const float v[3], float out[3])
{
    float t[3], r[3];
    /* q v q* without the terms that cancel: v + 2 w (u x v) + 2 u x (u x v), u the vector part; t = 2 u x v */
    t[0] = 2.0f * (q[1] * v[2] - q[2] * v[1]);
    t[1] = 2.0f * (q[2] * v[0] - q[0] * v[2]);
    t[2] = 2.0f * (q[0] * v[1] - q[1] * v[0]);
    r[0] = v[0] + q[3] * t[0] + (q[1] * t[2] - q[2] * t[1]);
    r[1] = v[1] + q[3] * t[1] + (q[2] * t[0] - q[0] * t[2]);
    r[2] = v[2] + q[3] * t[2] + (q[0] * t[1] - q[1] * t[0]);
    memcpy(out, r, sizeof r);
}

void noh_quat_nlerp(const float a[4], const float b[4], float t, float out[4])
{
    float sign = noh_quat_dot(a, b) < 0.0f ? -1.0f : 1.0f;
    for (int i = 0; i < 4; i++) {
        out[i] = a[i] * (1.0f - t) + sign * b[i] * t;
    }
    noh_quat_normalize(out);
}

/* The vector part is the axis times sin(angle / 2), w is cos(angle / 2), and atan2 of both keeps all its digits at
 * every angle, where an arccosine loses half of them near 0. Near 0 the quotient angle / sine is 2. */
void noh_quat_to_rotation(const float q[4], float rotation[3])
{
    float sign = q[3] < 0.0f ? -1.0f : 1.0f;
    float sine = noh_sqrt(noh_dot3(q, q));
    /* below this the angle is 2 sine to the last bit */
    float scale = sine > 1e-4f ? 2.0f * noh_atan2(sine, sign * q[3]) / sine : 2.0f;
    for (int i = 0; i < 3; i++) {
        rotation[i] = sign * scale * q[i];
    }
}

void noh_quat_from_rotation(const float rotation[3], float q[4])
{
    float angle = noh_sqrt(noh_dot3(rotation, rotation)), sine, cosine;
    float scale;
    noh_sin_cos(0.5f * angle, &sine, &cosine);
    scale = angle > 1e-4f ? sine / angle : 0.5f;
    for (int i = 0; i < 3; i++) {
        q[i] = rotation[i] * scale;
    }
    q[3] = cosine;
    noh_quat_normalize(q);
}

/* Project the vector part on the axis, keep w, and normalise: the rotation that is left over (the swing) then has its
 * axis orthogonal to the twist's. */
void noh_quat_twist(const float q[4], unsigned axis, float out[4])
{
    float along = q[axis], w = q[3];
    NOH_ASSERT(axis < 3u);
    identity(out);
    if (along * along + w * w > 1e-12f) {
        out[axis] = along;
        out[3] = w;
        noh_quat_normalize(out);
    }
}
