#include "clips.h"

#include <math.h>

enum { STEPS = 180 };
#define COUNT(list) ((int)(sizeof(list) / sizeof *(list)))

/* Left, right, and for a moment up. */
static double yaw(double time_s)
{
    static const Key keys[] = { { 0.4, 0 },     { 1.3, 0.95 }, { 2.1, 0.95 }, { 3.3, -0.95 },
                                { 4.1, -0.95 }, { 5.0, 0.05 }, { 5.8, 0 } };
    return glide(keys, COUNT(keys), time_s);
}

static double pitch(double time_s)
{
    static const Key keys[] = { { 0.4, 0 },     { 1.3, -0.04 }, { 2.1, 0.02 },  { 2.7, 0.10 }, { 3.3, -0.02 },
                                { 4.1, -0.06 }, { 4.9, -0.26 }, { 5.3, -0.26 }, { 5.9, 0 } };
    return glide(keys, COUNT(keys), time_s);
}

static Stance stance(double time_s)
{
    double now = yaw(time_s), late = yaw(time_s - 0.15);
    Stance s = stance_calm();
    s.head.y = 0.72 * now;
    s.head.x += pitch(time_s);
    s.head.z = -0.06 * now;
    s.waist.y = 0.28 * late;
    s.hips_turn.y = 0.10 * late;
    s.hips.x = 0.012 * late;
    for (int side = 0; side < SIDES; side++) {
        s.hands[side].wrist.z -= 0.02 * side_sign(side) * late;
        s.hands[side].wrist.y += 0.01 * fabs(late);
    }
    return s;
}

/* The eyes lead: they are where the head will be. */
static void face(double time_s, double *weights)
{
    double ahead = yaw(time_s + 0.20) - yaw(time_s), left = clamp(2.2 * ahead, 0, 0.9),
           right = clamp(-2.2 * ahead, 0, 0.9);
    double up = clamp(2.5 * (pitch(time_s) - pitch(time_s + 0.20)), 0, 0.7);
    face_add(weights, "eyeLookOutLeft", left);
    face_add(weights, "eyeLookInRight", left);
    face_add(weights, "eyeLookOutRight", right);
    face_add(weights, "eyeLookInLeft", right);
    face_add(weights, "eyeLookUpLeft", up);
    face_add(weights, "eyeLookUpRight", up);
    face_add(weights, "browInnerUp", 0.5 * smooth(4.2, 4.8, time_s) * smooth(5.8, 5.3, time_s));
    face_add(weights, "blink", blink_at(time_s, 0.65) + blink_at(time_s, 2.45) + blink_at(time_s, 4.35));
}

static int cues(Cue *list)
{
    (void)list;
    return 0;
}

const Clip clip_look_round = { "look_round", STEPS, stance, face, cues, 0 };
