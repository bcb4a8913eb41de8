#include "tube.h"

#include <math.h>

#define PI 3.14159265358979323846

/* ---- weights ---- */

/* All four hold every vertex between the ends: the Bernstein polynomials of degree three, which sum to 1. */
static void share_four(double t, double share[HOLDERS])
{
    double s = 1 - t;
    share[0] = s * s * s;
    share[1] = 3 * s * s * t;
    share[2] = 3 * s * t * t;
    share[3] = t * t * t;
}

static void find_shares(const Tube *tube, double y, double share[HOLDERS])
{
    share[0] = 1;
    share[1] = share[2] = share[3] = 0;
    if (tube->joint_count == 2) {
        share[1] = smooth(tube->joint_at[1] - tube->overlap, tube->joint_at[1] + tube->overlap, y);
        share[0] = 1 - share[1];
    } else if (tube->joint_count == HOLDERS) {
        share_four(clamp((y - tube->low) / (tube->high - tube->low), 0, 1), share);
    }
}

/* In steps of 1/65536; the largest is one minus the others. */
static void find_weights(const Tube *tube, double y, double weight[HOLDERS])
{
    double share[HOLDERS], rest = 65536;
    int largest = 0;
    find_shares(tube, y, share);
    for (int i = 1; i < HOLDERS; i++) {
        largest = share[i] > share[largest] ? i : largest;
    }
    for (int i = 0; i < HOLDERS; i++) {
        double steps = i == largest ? 0 : floor(share[i] * 65536 + 0.5);
        weight[i] = steps / 65536;
        rest -= steps;
    }
    weight[largest] = rest / 65536;
}

/* ---- the surface ---- */

/* The profile that is turned about the axis: a distance from it, a height, and the outward direction. */
typedef struct {
    double radius, y, out, up;
} Profile;

/* f: 0 at the pole, 1 where the cylinder begins; up: 1 at the top, -1 at the bottom. */
static Profile end_profile(const Tube *tube, double f, double up)
{
    double angle = (1 - f) * PI / 2, y = up > 0 ? tube->high : tube->low;
    int is_flat = up > 0 ? tube->flat_high : tube->flat_low;
    Profile flat = { f * tube->radius, y, 0, up };
    Profile round = { f > 0 ? tube->radius * cos(angle) : 0, y + up * tube->radius * sin(angle), f > 0 ? cos(angle) : 0,
                      up * sin(angle) };
    return is_flat ? flat : round;
}

static Profile find_profile(const Tube *tube, int band, int step)
{
    double f = (double)step / TUBE_STEPS;
    Profile side = { tube->radius, 0, 1, 0 };
    if (band == 0) {
        return end_profile(tube, f, -1);
    }
    if (band == tube->bands + 1) {
        return end_profile(tube, 1 - f, 1);
    }
    side.y = mix(tube->low, tube->high, (double)((band - 1) * TUBE_STEPS + step) / (tube->bands * TUBE_STEPS));
    return side;
}

static Place tube_place(const void *what, int band, int step, int side)
{
    Profile p = find_profile(what, band, step);
    double angle = 2 * PI * side / (TUBE_BLOCKS * TUBE_SIDES), c = cos(angle), s = sin(angle);
    Place place = { v3(p.radius * c, p.y, p.radius * s), v3_unit(v3(p.out * c, p.up, p.out * s)), { 0 } };
    find_weights(what, p.y, place.weight);
    return place;
}

Shape tube_build(const Tube *tube, const Dye *dye)
{
    Grid grid = { tube->bands + 2, TUBE_STEPS, TUBE_BLOCKS, TUBE_SIDES, tube_place, tube, *dye };
    return shape_build(&grid);
}
