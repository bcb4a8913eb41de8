#include "quat.h"

#include <math.h>
#include <string.h>

#include "convert/base/angle.h"

double quat_dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

void quat_multiply(const double *a, const double *b, double *out)
{
    out[0] = a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1];
    out[1] = a[3] * b[1] + a[1] * b[3] + a[2] * b[0] - a[0] * b[2];
    out[2] = a[3] * b[2] + a[2] * b[3] + a[0] * b[1] - a[1] * b[0];
    out[3] = a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2];
}

int quat_normalize(double *q)
{
    double length = sqrt(quat_dot(q, q));
    if (!(length > 1e-6) || !isfinite(length)) return 0;
    for (int i = 0; i < 4; ++i) q[i] /= length;
    return 1;
}

void quat_align(double *q, const double *to)
{
    if (quat_dot(q, to) >= 0.0) return;
    for (int i = 0; i < 4; ++i) q[i] = -q[i];
}

/* Half the angle of the rotation from a to b, where their dot product is not negative. */
static double half_angle(const double *a, const double *b)
{
    double apart = 0.0, together = 0.0;
    for (int i = 0; i < 4; ++i) {
        apart += (a[i] - b[i]) * (a[i] - b[i]);
        together += (a[i] + b[i]) * (a[i] + b[i]);
    }
    return 2.0 * angle_arc_tangent(fmin(sqrt(apart / together), 1.0));
}

double quat_angle(const double *a, const double *b)
{
    double near_b[4];
    memcpy(near_b, b, sizeof near_b);
    quat_align(near_b, a);
    return 2.0 * half_angle(a, near_b);
}

static void mix(const double *a, double wa, const double *b, double wb, double *out)
{
    for (int i = 0; i < 4; ++i) out[i] = a[i] * wa + b[i] * wb;
    (void)quat_normalize(out); /* both in one hemisphere: never of length 0 */
}

void quat_slerp(const double *a, const double *b, double t, double *out)
{
    double near_b[4];
    memcpy(near_b, b, sizeof near_b);
    quat_align(near_b, a);
    double angle = half_angle(a, near_b);
    if (angle < 1e-5) /* the arc is its chord, to the last bit */
        mix(a, 1.0 - t, near_b, t, out);
    else
        mix(a, angle_sine((1.0 - t) * angle), near_b, angle_sine(t * angle), out);
}

void quat_nlerp(const double *a, const double *b, double t, double *out)
{
    double near_b[4];
    memcpy(near_b, b, sizeof near_b);
    quat_align(near_b, a);
    mix(a, 1.0 - t, near_b, t, out);
}

void quat_columns(const double *q, double *out)
{
    double x = q[0], y = q[1], z = q[2], w = q[3];
    out[0] = 1.0 - 2.0 * (y * y + z * z);
    out[1] = 2.0 * (x * y + z * w);
    out[2] = 2.0 * (x * z - y * w);
    out[3] = 2.0 * (x * y - z * w);
    out[4] = 1.0 - 2.0 * (x * x + z * z);
    out[5] = 2.0 * (y * z + x * w);
    out[6] = 2.0 * (x * z + y * w);
    out[7] = 2.0 * (y * z - x * w);
    out[8] = 1.0 - 2.0 * (x * x + y * y);
}
