/* clip_space.h (private to the clip encoder): poses in double precision. */
#ifndef NOH_CONVERT_CODEC_CLIP_SPACE_H
#define NOH_CONVERT_CODEC_CLIP_SPACE_H

#include <math.h>
#include <stdint.h>
#include <string.h>

/* A joint relative to its parent. */
typedef struct space_local {
    double q[4], t[3], s[3];
} space_local;

/* A joint in object space: its rotation, the linear part (rotation and scale), its position. */
typedef struct space_global {
    double q[4], m[9], p[3];
} space_global;

static inline void space_mul(const double a[4], const double b[4], double o[4])
{
    const double x = a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1];
    const double y = a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0];
    const double z = a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3];
    const double w = a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2];
    o[0] = x;
    o[1] = y;
    o[2] = z;
    o[3] = w;
}

static inline void space_conj(const double a[4], double o[4])
{
    o[0] = -a[0];
    o[1] = -a[1];
    o[2] = -a[2];
    o[3] = a[3];
}

static inline double space_dot(const double a[4], const double b[4])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

static inline void space_unit(double q[4])
{
    const double n = sqrt(space_dot(q, q));
    if (n > 1e-15) {
        for (int i = 0; i < 4; i++) q[i] /= n;
    } else {
        q[0] = q[1] = q[2] = 0.0;
        q[3] = 1.0;
    }
}

/* The angle between two rotations, radians, 0 to pi; precise for small angles too. */
static inline double space_angle(const double a[4], const double b[4])
{
    double i[4], d[4];
    space_conj(a, i);
    space_mul(i, b, d);
    return 2.0 * atan2(sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), fabs(d[3]));
}

static inline void space_matrix(const double q[4], double m[9])
{
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    m[0] = 1 - 2 * (y * y + z * z);
    m[1] = 2 * (x * y - z * w);
    m[2] = 2 * (x * z + y * w);
    m[3] = 2 * (x * y + z * w);
    m[4] = 1 - 2 * (x * x + z * z);
    m[5] = 2 * (y * z - x * w);
    m[6] = 2 * (x * z - y * w);
    m[7] = 2 * (y * z + x * w);
    m[8] = 1 - 2 * (x * x + y * y);
}

static inline void space_apply(const double m[9], const double v[3], double o[3])
{
    const double x = v[0], y = v[1], z = v[2];
    o[0] = m[0] * x + m[1] * y + m[2] * z;
    o[1] = m[3] * x + m[4] * y + m[5] * z;
    o[2] = m[6] * x + m[7] * y + m[8] * z;
}

static inline void space_product(const double a[9], const double b[9], double o[9])
{
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            o[3 * i + k] = a[3 * i] * b[k] + a[3 * i + 1] * b[3 + k] + a[3 * i + 2] * b[6 + k];
        }
    }
}

static inline double space_distance(const double a[3], const double b[3])
{
    const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return sqrt(x * x + y * y + z * z);
}

/* The position of a joint's origin. parent NULL: a root. */
static inline void space_place(const space_global *parent, const double t[3], double p[3])
{
    if (parent) {
        space_apply(parent->m, t, p);
        for (int i = 0; i < 3; i++) p[i] += parent->p[i];
    } else {
        memcpy(p, t, 3 * sizeof *p);
    }
}

/* Rotation and linear part; the position is not set. */
static inline void space_turn(const space_global *parent, const double q[4], const double s[3], space_global *g)
{
    double r[9];
    space_matrix(q, r);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) r[3 * i + k] *= s[k];
    }
    if (!parent) {
        memcpy(g->q, q, sizeof g->q);
        memcpy(g->m, r, sizeof g->m);
        return;
    }
    space_mul(parent->q, q, g->q);
    space_product(parent->m, r, g->m);
}

static inline void space_compose(const space_global *parent, const space_local *l, space_global *g)
{
    space_place(parent, l->t, g->p);
    space_turn(parent, l->q, l->s, g);
}

/* ---- how far points about a joint are from where they should be ----
 *
 * A point of the shell lies at `shell` (x) u from its joint, |u| = 1: `shell` is the distance in the joint's own unit
 * along each of its axes. It should be at a.p + A u and is at b.p + B u; with x = a.p - b.p and D = A - B it is off by
 * |x + D u|. */

static inline void space_apart(const space_global *a, const space_global *b, const double shell[3], double x[3],
                               double d[9])
{
    for (int i = 0; i < 3; i++) {
        x[i] = a->p[i] - b->p[i];
        for (int k = 0; k < 3; k++) d[3 * i + k] = shell[k] * (a->m[3 * i + k] - b->m[3 * i + k]);
    }
}

/* The largest distance of the three points on the axes. */
static inline double space_error_axes(const space_global *a, const space_global *b, const double shell[3])
{
    double x[3], d[9], worst = 0.0;
    space_apart(a, b, shell, x, d);
    for (int k = 0; k < 3; k++) {
        const double dx = d[k] + x[0], dy = d[3 + k] + x[1], dz = d[6 + k] + x[2], square = dx * dx + dy * dy + dz * dz;
        if (!(square <= worst)) worst = square; /* also true for a NaN, which wins */
    }
    return sqrt(worst);
}

/* At least the largest eigenvalue of D^T D, and it up to rounding. The smallest one is the smallest root of
 * l^3 - t l^2 + c l - e; Newton's method from 0 approaches it from below. The other two are then roots of a quadratic.
 * Of a difference of two rotations the smallest is 0 and the others are equal: nothing is left to iterate. */
static inline double space_stretch(const double d[9])
{
    double s[6], t, c, e, low = 0.0, half, square;
    s[0] = d[0] * d[0] + d[3] * d[3] + d[6] * d[6];
    s[1] = d[1] * d[1] + d[4] * d[4] + d[7] * d[7];
    s[2] = d[2] * d[2] + d[5] * d[5] + d[8] * d[8];
    s[3] = d[0] * d[1] + d[3] * d[4] + d[6] * d[7];
    s[4] = d[0] * d[2] + d[3] * d[5] + d[6] * d[8];
    s[5] = d[1] * d[2] + d[4] * d[5] + d[7] * d[8];
    t = s[0] + s[1] + s[2];
    c = s[0] * s[1] - s[3] * s[3] + s[0] * s[2] - s[4] * s[4] + s[1] * s[2] - s[5] * s[5];
    e = d[0] * (d[4] * d[8] - d[5] * d[7]) - d[1] * (d[3] * d[8] - d[5] * d[6]) + d[2] * (d[3] * d[7] - d[4] * d[6]);
    e *= e;
    for (int i = 0; i < 8; i++) {
        const double value = ((low - t) * low + c) * low - e, slope = (3.0 * low - 2.0 * t) * low + c;
        if (!(value < -1e-14 * t * t * t) || !(slope > 1e-9 * t * t)) break;
        low -= value / slope;
    }
    half = 0.5 * (t - low);
    square = half * half - (c - low * (t - low));
    return half + (square > 0.0 ? sqrt(square) : 0.0);
}

/* The largest distance of all points of the shell, or a little more.
 *
 * |x + D u|^2 = |x|^2 + 2 (D^T x) . u + u^T D^T D u is at most |x|^2 + 2 |D^T x| + s, where s is the largest eigenvalue
 * of D^T D. Of two rotations D has no stretch along the axis of the turn between them and the same across it, and D^T x
 * lies across it: then some u has all three at once, and the bound is the largest distance itself. The factor covers
 * rounding. */
static inline double space_error_sphere(const space_global *a, const space_global *b, const double shell[3])
{
    double x[3], d[9], g[3], square;
    space_apart(a, b, shell, x, d);
    for (int k = 0; k < 3; k++) g[k] = d[k] * x[0] + d[3 + k] * x[1] + d[6 + k] * x[2];
    square = x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + 2.0 * sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]) +
             space_stretch(d);
    return sqrt(square) * (1.0 + 1e-7);
}

/* The same where both are rotations and the shell is the same along all axes: D's stretch across the turn's axis is
 * then half of the sum of its squares. */
static inline double space_error_turned(const space_global *a, const space_global *b, double shell)
{
    double x[3], d[9], g[3], squares = 0.0;
    for (int i = 0; i < 3; i++) x[i] = a->p[i] - b->p[i];
    for (int i = 0; i < 9; i++) {
        d[i] = a->m[i] - b->m[i];
        squares += d[i] * d[i];
    }
    for (int k = 0; k < 3; k++) g[k] = d[k] * x[0] + d[3 + k] * x[1] + d[6 + k] * x[2];
    return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + 2.0 * shell * sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]) +
                0.5 * shell * shell * squares) *
           (1.0 + 1e-7);
}

/* Between two frames: lerp, rotations normalised; signs as they are. */
static inline void space_between(const space_local *a, const space_local *b, double f, space_local *o)
{
    for (int i = 0; i < 4; i++) o->q[i] = a->q[i] + (b->q[i] - a->q[i]) * f;
    space_unit(o->q);
    for (int i = 0; i < 3; i++) {
        o->t[i] = a->t[i] + (b->t[i] - a->t[i]) * f;
        o->s[i] = a->s[i] + (b->s[i] - a->s[i]) * f;
    }
}

static inline int space_inverse(const double m[9], double o[9])
{
    const double a = m[4] * m[8] - m[5] * m[7], b = m[5] * m[6] - m[3] * m[8], c = m[3] * m[7] - m[4] * m[6];
    const double det = m[0] * a + m[1] * b + m[2] * c;
    double size = 0.0;
    for (int i = 0; i < 9; i++) size += m[i] * m[i];
    if (!(fabs(det) > 1e-6 * size * sqrt(size))) return 0; /* nearly singular */
    o[0] = a / det;
    o[1] = (m[2] * m[7] - m[1] * m[8]) / det;
    o[2] = (m[1] * m[5] - m[2] * m[4]) / det;
    o[3] = b / det;
    o[4] = (m[0] * m[8] - m[2] * m[6]) / det;
    o[5] = (m[2] * m[3] - m[0] * m[5]) / det;
    o[6] = c / det;
    o[7] = (m[1] * m[6] - m[0] * m[7]) / det;
    o[8] = (m[0] * m[4] - m[1] * m[3]) / det;
    return 1;
}

#endif
