#include "steps.h"

#include <math.h>

/* Step `number` of a foot; steps continue before and after the period. */
static Step step_at(const Gait *gait, int side, int number)
{
    int count = gait->count[side];
    int round = (int)floor((double)number / count);
    Step step = gait->steps[side][number - round * count];
    step.lift_s += round * gait->period_s;
    step.land_s += round * gait->period_s;
    return step;
}

static FootStance put_down(const Gait *gait, int side, int number)
{
    double middle = 0.5 * (step_at(gait, side, number).land_s + step_at(gait, side, number + 1).lift_s);
    Spot spot = gait->path(middle);
    V3 out = v3(side_sign(side) * gait->apart, 0, -0.012);
    FootStance foot = { .heading = spot.heading + side_sign(side) * 0.10 };
    foot.place = v3_add(spot.place, quat_rotate(quat_about(v3(0, 1, 0), spot.heading), out));
    return foot;
}

/* From one place to the next. The heel rises first, and the toes come down last. */
static FootStance swing(FootStance from, FootStance to, const Step *step, double k)
{
    double across = smooth(0, 1, k);
    FootStance foot = { .place = v3_mix(from.place, to.place, across),
                        .heading = mix(from.heading, to.heading, across) };
    foot.place.y = step->height * 16 * k * k * (1 - k) * (1 - k);
    foot.pitch = step->heel * (0.8 * bump((k - 0.72) / 0.28) - bump((k - 0.25) / 0.25));
    return foot;
}

FootStance gait_foot(const Gait *gait, int side, double time_s)
{
    int number = -gait->count[side];
    while (step_at(gait, side, number + 1).lift_s <= time_s) {
        number++;
    }
    Step step = step_at(gait, side, number);
    FootStance to = put_down(gait, side, number);
    if (time_s >= step.land_s) {
        return to;
    }
    double k = (time_s - step.lift_s) / (step.land_s - step.lift_s);
    return swing(put_down(gait, side, number - 1), to, &step, k);
}
