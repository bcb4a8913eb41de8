#include "clips.h"
#include "steps.h"

#include <math.h>

#define PI 3.14159265358979323846

/* Suriashi, the gliding walk of the Noh stage: level hips, still hands, and soles that barely leave the floor. The root
 * moves forward. */
enum { STEPS = 42 };
static const double period_s = (double)STEPS / CLIP_RATE_HZ, speed = 0.50;
static const double left_lands_s = 0.60, right_lands_s = 1.30;

static Spot path(double time_s)
{
    Spot spot = { { 0, 0, speed * time_s }, 0 };
    return spot;
}

static Stance stance(double time_s)
{
    const Gait gait = { .period_s = period_s,
                        .path = path,
                        .apart = 0.092,
                        .count = { 1, 1 },
                        .steps = { { { 0.06, left_lands_s, 0.014, 0.16 } },
                                   { { 0.76, right_lands_s, 0.014, 0.16 } } } };
    /* 1 while the left foot carries the weight, -1 while the right one does. */
    double phase = 2 * PI * (time_s - 1.03) / period_s, carries = cos(phase), leads = sin(phase + 0.5);
    Stance s = stance_calm();
    s.root = path(time_s).place;
    s.hips.x = 0.020 * carries;
    s.hips.y -= 0.022;
    s.hips_turn.x += 0.04;
    s.hips_turn.y = 0.07 * leads;
    s.hips_turn.z = -0.02 * carries;
    s.waist.y = -0.09 * leads;
    s.waist.z = 0.03 * carries;
    s.head.y = 0.02 * leads;
    s.head.x -= 0.03;
    for (int side = 0; side < SIDES; side++) {
        s.feet[side] = gait_foot(&gait, side, time_s);
        s.hands[side].wrist.z += 0.022 * side_sign(side) * leads;
        s.hands[side].wrist.y += 0.004 * cos(2 * phase);
    }
    return s;
}

static void face(double time_s, double *weights)
{
    (void)time_s;
    face_add(weights, "smile", 0.12);
}

static int cues(Cue *list)
{
    Cue left = { left_lands_s, "foot_left", -1 }, right = { right_lands_s, "foot_right", -1 };
    list[0] = left;
    list[1] = right;
    return 2;
}

const Clip clip_walk = { "walk", STEPS, stance, face, cues, 0 };
