/* vector_internal.h: vectors of three floats. Threads: no state; any thread. */
#ifndef NOH_BASE_VECTOR_INTERNAL_H
#define NOH_BASE_VECTOR_INTERNAL_H

#include <string.h>

#include "core/base/math_internal.h"
#include "core/base/compiler_internal.h"
#include "noh/low_core.h"

static inline void noh_sub3(const float a[3], const float b[3], float out[3])
{
    out[0] = a[0] - b[0];
    out[1] = a[1] - b[1];
    out[2] = a[2] - b[2];
}

/* a + s * b; out may be any of them. */
static inline void noh_madd3(const float a[3], float s, const float b[3], float out[3])
{
    out[0] = a[0] + s * b[0];
    out[1] = a[1] + s * b[1];
    out[2] = a[2] + s * b[2];
}

static inline void noh_cross3(const float a[3], const float b[3], float out[3])
{
    const float x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

static inline float noh_length3(const float v[3])
{
    return noh_sqrt(noh_dot3(v, v));
}

static inline float noh_apart3(const float a[3], const float b[3])
{
    float way[3];
    noh_sub3(a, b, way);
    return noh_length3(way);
}

static inline void noh_mix3(const float a[3], const float b[3], float t, float out[3])
{
    for (int i = 0; i < 3; i++) out[i] = a[i] + t * (b[i] - a[i]);
}

/* v without its component along the unit vector `axis`; out may be v. */
static inline void noh_reject3(const float v[3], const float axis[3], float out[3])
{
    noh_madd3(v, -noh_dot3(v, axis), axis, out);
}

/* A unit vector perpendicular to the unit vector v: from `hint` if possible, else any. */
NOH_UNUSED static inline void noh_perpendicular3(const float v[3], const float hint[3], float out[3])
{
    static const float axes[3][3] = { { 1.0f, 0.0f, 0.0f }, { 0.0f, 1.0f, 0.0f }, { 0.0f, 0.0f, 1.0f } };
    const float x = v[0] * v[0], y = v[1] * v[1], z = v[2] * v[2];
    const float *least = axes[x <= y && x <= z ? 0 : y <= z ? 1 : 2]; /* its perpendicular part is at least 0.8 long */
    float part[3];
    noh_reject3(hint, v, part);
    if (noh_dot3(part, part) > 1e-8f * noh_dot3(hint, hint)) {
        noh_reject3(part, v, part); /* a second time, because the rest may be small relative to what was subtracted */
        noh_normalize3(part, least);
    } else {
        noh_reject3(least, v, part);
        noh_normalize3(part, least);
    }
    memcpy(out, part, sizeof part);
}

/* The shortest rotation from direction a to b, of any lengths; the identity if either is 0. `hint` selects the axis if
 * they are opposed.
 * Beyond a right angle it takes two steps, half a turn about the axis and then the rest: the sum of nearly opposed
 * vectors has few digits, and the second step corrects the error of the axis. */
NOH_UNUSED static inline void noh_quat_between(const float a[3], const float b[3], const float hint[3], float q[4])
{
    static const float none[3] = { 0.0f, 0.0f, 0.0f };
    const float cosine = noh_dot3(a, b), size = noh_sqrt(noh_dot3(a, a) * noh_dot3(b, b));
    if (cosine >= 0.0f || !(size > 0.0f)) {
        noh_cross3(a, b, q);
        q[3] = size + cosine;
        noh_quat_normalize(q);
    } else {
        float from[3] = { -a[0], -a[1], -a[2] }, axis[3], half[4] = { 0.0f, 0.0f, 0.0f, 0.0f };
        noh_cross3(a, b, axis);
        const float *about = noh_dot3(axis, axis) > 1e-12f * size * size ? axis : hint;
        noh_cross3(from, b, q);
        q[3] = size - cosine;
        noh_quat_normalize(q);
        noh_normalize3(from, none);
        noh_perpendicular3(from, about, half);
        noh_quat_mul(q, half, q);
    }
}

#endif
