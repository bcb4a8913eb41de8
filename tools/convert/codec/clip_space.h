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
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            g->m[3 * i + k] = parent->m[3 * i] * r[k] + parent->m[3 * i + 1] * r[3 + k] +
                              parent->m[3 * i + 2] * r[6 + k];
        }
    }
}

static inline void space_compose(const space_global *parent, const space_local *l, space_global *g)
{
    space_place(parent, l->t, g->p);
    space_turn(parent, l->q, l->s, g);
}

/* The largest distance of the three points at the shell. */
static inline double space_error(const space_global *a, const space_global *b, double shell)
{
    const double x = a->p[0] - b->p[0], y = a->p[1] - b->p[1], z = a->p[2] - b->p[2];
    double worst = 0.0;
    for (int k = 0; k < 3; k++) {
        const double dx = shell * (a->m[k] - b->m[k]) + x, dy = shell * (a->m[3 + k] - b->m[3 + k]) + y,
                     dz = shell * (a->m[6 + k] - b->m[6 + k]) + z, square = dx * dx + dy * dy + dz * dz;
        if (!(square <= worst)) worst = square; /* also true for a NaN, which wins */
    }
    return sqrt(worst);
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
