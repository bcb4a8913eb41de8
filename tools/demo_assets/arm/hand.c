#include "hand.h"

#include <math.h>

#define PI 3.14159265358979323846

enum { BANDS = 12, STEPS = 4, BLOCKS = 20, SIDES = 4 };

static const double radius = 0.3;

/* turn: about the z axis, 0 is up; rise: 0 at the back, pi in front. */
static V3 fist_at(double turn, double rise)
{
    return v3_scale(v3(sin(rise) * sin(turn), sin(rise) * cos(turn), -cos(rise)), radius);
}

/* Flat, with five fingers; the valleys between them lie within the fist. */
static V3 open_at(double turn, double rise)
{
    double finger = 0.5 + 0.5 * cos(5 * turn), wide = 0.52 + 0.83 * finger * sqrt(finger);
    V3 at = fist_at(turn, rise);
    return v3(wide * at.x, wide * at.y, 0.40 * at.z);
}

/* The normal, from positions nearby; rise and turn are a right-handed pair. */
static V3 find_normal(V3 (*at)(double, double), double turn, double rise)
{
    const double near = 1e-4;
    V3 along = v3_sub(at(turn, rise + near), at(turn, rise - near));
    V3 around = v3_sub(at(turn + near, rise), at(turn - near, rise));
    return v3_unit(v3_cross(along, around));
}

static Place hand_place(const void *what, int band, int step, int side)
{
    V3 (*at)(double, double) = *(const int *)what ? open_at : fist_at;
    int row = band * STEPS + step, is_back = row == 0, is_front = row == BANDS * STEPS;
    double turn = 2 * PI * side / (BLOCKS * SIDES), rise = PI * row / (BANDS * STEPS);
    Place place = { { 0, 0, 0 }, { 0, 0, 0 }, { 1 } };
    if (is_back || is_front) {
        /* At a pole all turns give one position, and none gives a direction. */
        place.at = v3(0, 0, at(0, is_back ? 0 : PI).z);
        place.normal = v3(0, 0, is_back ? -1 : 1);
    } else {
        place.at = at(turn, rise);
        place.normal = find_normal(at, turn, rise);
    }
    return place;
}

Shape hand_shape(int open, const Dye *dye)
{
    Grid grid = { BANDS, STEPS, BLOCKS, SIDES, hand_place, &open, *dye };
    return shape_build(&grid);
}
