#include "angle.h"

#include <math.h>

#define PI 3.14159265358979323846

/* Taylor series, cut off where the next term is below half a bit at pi/4. */
static double sine_series(double x)
{
    double x2 = x * x, sum = 1.0;
    for (int k = 8; k >= 1; --k) sum = 1.0 - sum * x2 / (double)(2 * k * (2 * k + 1));
    return x * sum;
}

static double cosine_series(double x)
{
    double x2 = x * x, sum = 1.0;
    for (int k = 9; k >= 1; --k) sum = 1.0 - sum * x2 / (double)(2 * k * (2 * k - 1));
    return sum;
}

void angle_sin_cos_degrees(double degrees, double *sine, double *cosine)
{
    double turned = fmod(degrees, 360.0); /* exact, and so is the subtraction below */
    double quarters = floor(turned / 90.0 + 0.5);
    double x = (turned - 90.0 * quarters) * (PI / 180.0), s = sine_series(x), c = cosine_series(x);
    switch ((int)quarters & 3) {
    case 0: *sine = s, *cosine = c; break;
    case 1: *sine = c, *cosine = -s; break;
    case 2: *sine = -s, *cosine = -c; break;
    default: *sine = -c, *cosine = s; break;
    }
}

double angle_sine(double radians)
{
    return radians <= PI / 4.0 ? sine_series(radians) : cosine_series(PI / 2.0 - radians);
}

double angle_arc_tangent(double ratio)
{
    /* arctan t = 2 arctan(t / (1 + sqrt(1 + t^2))): two halvings bring it below pi/16 */
    double t = ratio;
    for (int i = 0; i < 2; ++i) t = t / (1.0 + sqrt(1.0 + t * t));
    static const double odd[] = { 1.0,      1.0 / 3,  1.0 / 5,  1.0 / 7,  1.0 / 9,  1.0 / 11, 1.0 / 13,
                                  1.0 / 15, 1.0 / 17, 1.0 / 19, 1.0 / 21, 1.0 / 23, 1.0 / 25 };
    double t2 = t * t, sum = 0.0;
    for (int k = 12; k >= 0; --k) sum = odd[k] - t2 * sum;
    return 4.0 * t * sum;
}
