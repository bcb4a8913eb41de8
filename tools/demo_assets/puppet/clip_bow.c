#include "clips.h"

enum { STEPS = 135 };

/* 1 when bowed; the head leads on the way down and comes up last. */
static double bowed(double time_s, double late_s)
{
    return smooth(0.4, 1.6, time_s - late_s) * smooth(3.9, 2.5, time_s - late_s);
}

static Stance stance(double time_s)
{
    double k = bowed(time_s, 0), head = bowed(time_s, -0.05), hands = bowed(time_s, 0.08);
    Stance s = stance_calm();
    s.hips_turn.x += 0.62 * k;
    s.hips.z -= 0.085 * k;
    s.hips.y -= 0.022 * k;
    s.waist.x += 0.34 * k;
    s.head.x += 0.30 * head;
    for (int side = 0; side < SIDES; side++) {
        HandStance *hand = &s.hands[side];
        hand->wrist = v3_mix(hand->wrist, v3(0.215, -0.150, 0.325), hands);
        hand->elbow = v3_mix(hand->elbow, v3(0.70, 0.00, -0.70), hands);
        hand->curl -= 0.22 * hands;
        hand->bend -= 0.10 * hands;
    }
    return s;
}

static void face(double time_s, double *weights)
{
    face_add(weights, "blink", 0.75 * bowed(time_s, -0.10));
    face_add(weights, "smile", 0.12 + 0.38 * smooth(2.9, 3.5, time_s) * smooth(4.5, 3.9, time_s));
}

static int cues(Cue *list)
{
    Cue lowest = { 1.6, "bow", -1 };
    list[0] = lowest;
    return 1;
}

const Clip clip_bow = { "bow", STEPS, stance, face, cues, 0 };
