#include "clips.h"
#include "steps.h"

#include <math.h>

/* A slow dance: the right hand points ahead; a round to the left with open arms; two stamps; a
 * round to the right with the left sleeve raised; and back to rest. */
enum { STEPS = 540, TURN_STEPS = 16 };
#define COUNT(list) ((int)(sizeof(list) / sizeof *(list)))
#define PI 3.14159265358979323846

static const double period_s = (double)STEPS / CLIP_RATE_HZ;
static const double left_turn_s = 3.2, right_turn_s = 10.2, turn_s = 5.0, radius = 0.24;
static const double stamp_s[SIDES] = { 8.8, 9.7 };

/* Two circles that touch at the origin: the first to the left, the second to the right. */
static Spot path(double time_s)
{
    time_s -= period_s * floor(time_s / period_s);
    double left = 2 * PI * pace((time_s - left_turn_s) / turn_s, 0.2);
    double right = 2 * PI * pace((time_s - right_turn_s) / turn_s, 0.2);
    double side = right > 0 ? -1 : 1, turned = right > 0 ? right : left;
    Spot spot = { { side * radius * (1 - cos(turned)), 0, radius * sin(turned) }, left - right };
    return spot;
}

/* --- feet --- */

static void add_step(Gait *gait, int side, double lift_s, double land_s, double height, double heel)
{
    Step step = { lift_s, land_s, height, heel };
    gait->steps[side][gait->count[side]++] = step;
}

static void add_turn(Gait *gait, double start_s, int first)
{
    for (int i = 0; i < TURN_STEPS; i++) {
        double lift = start_s + turn_s * i / TURN_STEPS;
        add_step(gait, (i + first) % SIDES, lift, lift + 0.26, 0.014, 0.10);
    }
}

static Gait make_gait(void)
{
    Gait gait = { .period_s = period_s, .path = path, .apart = 0.098 };
    add_turn(&gait, left_turn_s, LEFT);
    for (int side = 0; side < SIDES; side++) {
        add_step(&gait, side, stamp_s[side] - 0.55, stamp_s[side], 0.15, 0.30);
    }
    add_turn(&gait, right_turn_s, RIGHT);
    return gait;
}

/* --- hands --- */

typedef struct {
    double time_s;
    V3 wrist, elbow;
    double roll, curl;
} HandKey;

#define REST_WRIST { 0.255, -0.215, 0.195 }, { 0.85, -0.15, -0.50 }, 0.15, 0.38

static const HandKey left_keys[] = {
    { 0, REST_WRIST },
    { 2.9, REST_WRIST },
    { 4.6, { 0.500, 0.075, 0.265 }, { 0.30, -0.90, -0.35 }, 0.30, 0.15 },
    { 7.6, { 0.515, 0.095, 0.235 }, { 0.30, -0.90, -0.35 }, 0.40, 0.12 },
    { 8.6, { 0.360, -0.110, 0.290 }, { 0.80, -0.55, -0.30 }, 0.20, 0.40 },
    { 9.9, { 0.360, -0.110, 0.290 }, { 0.80, -0.55, -0.30 }, 0.20, 0.40 },
    { 11.4, { 0.250, 0.340, 0.335 }, { 0.95, -0.20, 0.10 }, 0.10, 0.15 },
    { 14.4, { 0.270, 0.365, 0.310 }, { 0.95, -0.20, 0.10 }, 0.20, 0.12 },
    { 16.0, { 0.440, 0.020, 0.300 }, { 0.60, -0.70, -0.30 }, 0.30, 0.20 },
    { 17.6, REST_WRIST },
};

static const HandKey right_keys[] = {
    { 0, REST_WRIST },
    { 0.5, REST_WRIST },
    { 1.9, { 0.190, 0.110, 0.480 }, { 0.50, -0.80, -0.10 }, 0.25, 0.22 },
    { 2.9, { 0.190, 0.120, 0.480 }, { 0.50, -0.80, -0.10 }, 0.25, 0.22 },
    { 4.6, { 0.500, 0.075, 0.265 }, { 0.30, -0.90, -0.35 }, 0.30, 0.15 },
    { 7.6, { 0.515, 0.095, 0.235 }, { 0.30, -0.90, -0.35 }, 0.40, 0.12 },
    { 8.6, { 0.360, -0.110, 0.290 }, { 0.80, -0.55, -0.30 }, 0.20, 0.40 },
    { 9.9, { 0.360, -0.110, 0.290 }, { 0.80, -0.55, -0.30 }, 0.20, 0.40 },
    { 11.6, { 0.430, -0.060, 0.300 }, { 0.60, -0.75, -0.30 }, 0.20, 0.20 },
    { 14.6, { 0.460, -0.020, 0.270 }, { 0.60, -0.75, -0.30 }, 0.30, 0.18 },
    { 16.2, { 0.330, -0.080, 0.340 }, { 0.70, -0.60, -0.30 }, 0.20, 0.25 },
    { 17.6, REST_WRIST },
};

static HandStance hand_at(const HandKey *keys, int count, double time_s)
{
    int i = 0;
    time_s -= period_s * floor(time_s / period_s);
    while (i + 2 < count && keys[i + 1].time_s <= time_s) {
        i++;
    }
    const HandKey *a = &keys[i], *b = &keys[i + 1];
    double k = smooth(a->time_s, b->time_s, time_s), curl = mix(a->curl, b->curl, k);
    HandStance hand = stance_calm().hands[LEFT];
    hand.wrist = v3_mix(a->wrist, b->wrist, k);
    hand.elbow = v3_mix(a->elbow, b->elbow, k);
    hand.roll = mix(a->roll, b->roll, k);
    hand.curl = curl;
    hand.thumb = 0.25 + 0.9 * curl;
    return hand;
}

/* --- the rest --- */

/* While a foot is raised to stamp, the other one carries the weight. */
static double stamp_lift(double time_s, int side)
{
    double since = time_s - stamp_s[side];
    return smooth(-0.80, -0.35, since) * smooth(0.25, -0.08, since);
}

/* 1 in the round to the left, -1 in the one to the right. */
static double in_turn(double time_s)
{
    double left = time_s - left_turn_s, right = time_s - right_turn_s;
    return smooth(-0.4, 0.5, left) * smooth(turn_s + 0.2, turn_s - 0.5, left) -
           smooth(-0.4, 0.5, right) * smooth(turn_s + 0.2, turn_s - 0.5, right);
}

static Stance stance(double time_s)
{
    static const Key lean[] = { { 0.5, 0 },      { 1.9, 0.10 },  { 2.9, 0.08 }, { 4.6, -0.03 },
                                { 7.6, -0.05 },  { 8.6, 0.06 },  { 9.9, 0.06 }, { 11.4, -0.04 },
                                { 14.4, -0.05 }, { 16.2, 0.05 }, { 17.6, 0 } };
    static const Key nod[] = { { 1.2, 0 },      { 2.2, 0.04 },   { 4.6, -0.06 }, { 8.6, 0.10 }, { 9.9, 0.06 },
                               { 11.6, -0.12 }, { 14.4, -0.10 }, { 16.2, 0.10 }, { 17.7, 0 } };
    const Gait gait = make_gait();
    double turning = in_turn(time_s), left = stamp_lift(time_s, LEFT), right = stamp_lift(time_s, RIGHT);
    double rock = fabs(turning) * sin(2 * PI * (time_s - left_turn_s) * TURN_STEPS / (2 * turn_s));
    Stance s = stance_calm();
    Spot spot = path(time_s);
    s.root = spot.place;
    s.heading = spot.heading;
    s.hips.x = -0.050 * left + 0.050 * right - 0.010 * rock;
    s.hips.y -= 0.006 * fabs(turning) + 0.012 * (left + right);
    s.hips_turn.x += 0.04 * fabs(turning);
    s.hips_turn.z = 0.05 * (right - left);
    s.waist.x += glide(lean, COUNT(lean), time_s);
    s.waist.y = 0.12 * turning - 0.10 * smooth(0.6, 1.9, time_s) * smooth(3.6, 2.9, time_s);
    s.waist.z = 0.05 * turning + 0.06 * (left - right);
    s.head.x += glide(nod, COUNT(nod), time_s);
    s.head.y = 0.25 * turning - 0.12 * smooth(0.6, 1.9, time_s) * smooth(3.6, 2.9, time_s);
    s.jaw = 0.05 * smooth(4.0, 4.6, time_s) * smooth(8.0, 7.4, time_s) * (1 + sin(2 * PI * 1.4 * time_s));
    for (int side = 0; side < SIDES; side++) {
        s.feet[side] = gait_foot(&gait, side, time_s);
    }
    s.hands[LEFT] = hand_at(left_keys, COUNT(left_keys), time_s);
    s.hands[RIGHT] = hand_at(right_keys, COUNT(right_keys), time_s);
    return s;
}

/* It smiles while it dances, and looks stern when it stamps. */
static void face(double time_s, double *weights)
{
    static const Key smiles[] = { { 0, 0.12 },   { 2.0, 0.12 }, { 4.2, 1.0 },  { 7.4, 0.85 }, { 8.2, 0.0 },
                                  { 10.0, 0.0 }, { 12.0, 0.9 }, { 15.2, 1.0 }, { 17.6, 0.12 } };
    static const Key sternness[] = { { 7.6, 0 }, { 8.5, 0.8 }, { 9.8, 0.8 }, { 10.8, 0 } };
    face_add(weights, "smile", glide(smiles, COUNT(smiles), time_s));
    face_add(weights, "anger", glide(sternness, COUNT(sternness), time_s));
    face_add(weights, "blink",
             blink_at(time_s, 1.0) + blink_at(time_s, 3.4) + blink_at(time_s, 6.1) + blink_at(time_s, 10.4) +
                 blink_at(time_s, 13.0) + blink_at(time_s, 16.4));
    face_add(weights, "browInnerUp", 0.5 * smooth(11.2, 12.4, time_s) * smooth(16.4, 15.0, time_s));
}

/* Keeps the list in time order. */
static void insert(Cue *list, int count, Cue cue)
{
    int place = count;
    while (place > 0 && list[place - 1].time_s > cue.time_s) {
        list[place] = list[place - 1];
        place--;
    }
    list[place] = cue;
}

static int cues(Cue *list)
{
    static const char *const names[SIDES] = { "foot_left", "foot_right" };
    const Gait gait = make_gait();
    int count = 0;
    for (int side = 0; side < SIDES; side++) {
        for (int i = 0; i < gait.count[side]; i++) {
            int stamps = gait.steps[side][i].land_s == stamp_s[side];
            Cue cue = { gait.steps[side][i].land_s, stamps ? "stamp" : names[side], stamps ? side : -1 };
            insert(list, count++, cue);
        }
    }
    return count;
}

const Clip clip_dance = { "dance", STEPS, stance, face, cues, 0 };
