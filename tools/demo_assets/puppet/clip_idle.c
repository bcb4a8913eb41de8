#include "clips.h"

#include <math.h>

#define PI 3.14159265358979323846

enum { STEPS = 120 };

static Stance stance(double time_s)
{
    double phase = 2 * PI * time_s * CLIP_RATE_HZ / STEPS;
    double breath = sin(phase), sway = cos(phase);
    Stance s = stance_calm();
    s.hips.x = 0.007 * sway;
    s.hips.y += 0.003 * breath;
    s.waist.x -= 0.018 * breath;
    s.waist.z = -0.010 * sway;
    s.head.x += 0.020 * sin(phase - 0.7);
    s.head.y = 0.030 * sin(phase + 0.9);
    for (int side = 0; side < SIDES; side++) {
        s.hands[side].wrist.y += 0.006 * sin(phase - 0.5);
        s.hands[side].wrist.x += 0.004 * breath;
        s.hands[side].curl += 0.03 * sin(phase - 1.2);
    }
    return s;
}

static void face(double time_s, double *weights)
{
    face_add(weights, "blink", blink_at(time_s, 1.4) + 0.9 * blink_at(time_s, 3.2));
    face_add(weights, "smile", 0.12);
}

static int cues(Cue *list)
{
    (void)list;
    return 0;
}

const Clip clip_idle = { "idle", STEPS, stance, face, cues, 0 };
