#include "shape.h"

#include <math.h>

#define PI 3.14159265358979323846

/* Millimetres. Height and depth of a ring in front and at the back, half its width, the depth where it is widest, and
 * how much narrower it is towards the front. */
enum { T, FRONT_Y, FRONT_Z, BACK_Y, BACK_Z, WIDTH, MIDDLE_Z, NARROW, MEMBERS, RINGS = 22 };
static const double rings[RINGS][MEMBERS] = {
    { -215, -172, 10, -160, -62, 46, -22, 0 },  { -190, -148, 8, -138, -60, 41, -22, 0 },
    { -165, -124, 7, -112, -58, 37, -22, 0 },   { -140, -100, 9, -86, -58, 36.5, -21, 0.02 },
    { -122, -86, 17, -62, -62, 39, -16, 0.06 }, { -107, -79.5, 32, -48, -67, 44, -9, 0.14 },
    { -95, -79, 47, -41, -71, 49, -4, 0.25 },   { -85, -78, 60, -36, -75, 53, 0, 0.33 },
    { -75, -72.5, 69, -32, -78, 57, 2, 0.34 },  { -66, -65.5, 73.5, -29, -81, 60, 3, 0.31 },
    { -57, -57, 75.5, -25, -84, 63, 3, 0.27 },  { -47, -47, 77, -20, -87, 66.5, 3, 0.21 },
    { -36, -36, 78, -14, -90, 70, 2, 0.14 },    { -20, -20, 77, -4, -94, 72.5, 0, 0.09 },
    { 0, 0, 76, 8, -97, 74, -2, 0.05 },         { 20, 20, 77.5, 24, -99, 75.5, -4, 0.02 },
    { 42, 42, 79, 42, -99, 77, -6, 0 },         { 66, 65, 77, 62, -97, 77, -8, 0 },
    { 92, 88, 68, 84, -89, 72, -10, 0 },        { 122, 109, 50, 105, -72, 58, -11, 0 },
    { 152, 122, 24, 120, -42, 36, -10, 0 },     { 182, 126, -9, 126, -9.01, 0.01, -9, 0 },
};

static double member(int which, double t)
{
    static Key keys[MEMBERS][RINGS];
    if (keys[T][0].y == 0) {
        for (int m = 0; m < MEMBERS; m++) {
            double unit = m == NARROW ? 1 : 0.001;
            for (int i = 0; i < RINGS; i++) {
                keys[m][i].x = rings[i][T] * 0.001;
                keys[m][i].y = rings[i][m] * unit;
            }
        }
    }
    return curve(keys[which], RINGS, t);
}

/* The angle about the ring, so that in front s is a length. */
static double angle_at(double s, double t)
{
    double rate = 1 / fmax(member(WIDTH, t) * (1 - member(NARROW, t)), 0.048), k = s / HALF_ROUND;
    return rate * s + (PI - rate * HALF_ROUND) * k * k * k;
}

V3 shape_at(double s, double t)
{
    double angle = angle_at(s, t), across = sin(angle), ahead = cos(angle);
    double front = ahead > 0 ? ahead * ahead : 0;
    double x = member(WIDTH, t) * across * (1 - member(NARROW, t) * front);
    double y0 = member(FRONT_Y, t), y1 = member(BACK_Y, t), middle = member(MIDDLE_Z, t);
    double z = ahead > 0 ? middle + (member(FRONT_Z, t) - middle) * (ahead + 0.36 * front * (1 - ahead))
                         : middle + (middle - member(BACK_Z, t)) * ahead;
    return v3(x, (y0 + y1) / 2 + (y0 - y1) / 2 * ahead, z);
}

V3 shape_normal(double s, double t)
{
    const double step = 0.0015;
    V3 along_s = v3_sub(shape_at(s + step, t), shape_at(s - step, t));
    V3 along_t = v3_sub(shape_at(s, t + step), shape_at(s, t - step));
    return v3_unit(v3_cross(along_s, along_t));
}

V3 shape_out(double s, double t)
{
    double angle = angle_at(s, t);
    return v3_unit(v3(0.7 * sin(angle), 0, cos(angle)));
}
