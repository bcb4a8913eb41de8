/* model_vec.c: small vectors in double precision, without libm but for square roots, which are correctly rounded
 * everywhere: every machine gives the same bits. */
#include "model_build.h"

#include <math.h>
#include <string.h>

double vec_dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double vec_distance(const double *a, const double *b)
{
    const double d[3] = { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
    return sqrt(vec_dot(d, d));
}

void vec_cross(const double *a, const double *b, double *out)
{
    double x = a[1] * b[2] - a[2] * b[1];
    double y = a[2] * b[0] - a[0] * b[2];
    double z = a[0] * b[1] - a[1] * b[0];
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

int vec_normalize(double *v)
{
    double length = sqrt(vec_dot(v, v));
    if (!(length > 0.0)) return 0;
    for (int i = 0; i < 3; ++i) v[i] /= length;
    return 1;
}

void vec_reject(double *v, const double *n)
{
    double along = vec_dot(v, n);
    for (int i = 0; i < 3; ++i) v[i] -= along * n[i];
}

void vec_any_perpendicular(const double *n, double *out)
{
    /* The axis along which n is shortest is never parallel to n. */
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (fabs(n[i]) < fabs(n[axis])) axis = i;
    double unit[3] = { 0.0, 0.0, 0.0 };
    unit[axis] = 1.0;
    vec_reject(unit, n);
    if (!vec_normalize(unit)) unit[axis] = 1.0;
    memcpy(out, unit, sizeof unit);
}

/* Arc tangent of t in 0..1, error below 2e-8 (Abramowitz and Stegun, 4.4.49). */
static double arc_tangent(double t)
{
    static const double c[9] = { 1.0,           -0.3333314528, 0.1999355085,  -0.1420889944, 0.1065626393,
                                 -0.0752896400, 0.0429096138,  -0.0161657367, 0.0028662257 };
    double t2 = t * t, sum = 0.0;
    for (int i = 8; i >= 0; --i) sum = sum * t2 + c[i];
    return t * sum;
}

double vec_angle(const double *a, const double *b)
{
    const double half_pi = 1.57079632679489662, pi = 3.14159265358979324;
    double cross[3];
    vec_cross(a, b, cross);
    double y = sqrt(vec_dot(cross, cross)), x = vec_dot(a, b), x_size = fabs(x);
    if (y == 0.0 && x == 0.0) return 0.0;
    double angle = y <= x_size ? arc_tangent(y / x_size) : half_pi - arc_tangent(x_size / y);
    return x < 0.0 ? pi - angle : angle;
}

void vec_posed(const float *base, const float *delta, uint32_t vertex, double *out)
{
    const float *b = base + (size_t)vertex * 3;
    for (int i = 0; i < 3; ++i) out[i] = (double)b[i];
    for (int i = 0; delta && i < 3; ++i) out[i] += (double)delta[(size_t)vertex * 3 + (size_t)i];
}
