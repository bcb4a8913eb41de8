/* Walks that go wherever a stick points: starts, stops, curves and turns, for motion matching (`noh build --match`). A
 * seeded stick gives a velocity every second or two; the body follows it as by a spring, and feet step to where the
 * body will be. */
#include "clips.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PI 3.14159265358979323846

enum {
    RATE_HZ = 120,
    LEAD = 2 * RATE_HZ,
    MOMENTS = LEAD + ROAM_STEPS * RATE_HZ / CLIP_RATE_HZ + LEAD,
    FALLS_MAX = 256
};

static const double rate = 6.2; /* of the spring */
static const double swing_s = 0.30, both_s = 0.04;
static const double apart = 0.094, slack = 0.05, slack_turn = 0.30;

/* A step of a foot: in the air from the moment `lift` on, for swing_s. */
typedef struct {
    int lift;
    FootStance from, to;
} Fall;

typedef struct {
    V3 place;
    double heading, speed;
} Moment;

typedef struct {
    int is_made;
    Moment moments[MOMENTS];
    Fall falls[SIDES][FALLS_MAX];
    int counts[SIDES];
} Roam;

/* --- the path --- */

static double next_random(unsigned *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0;
}

/* A stick that is pushed another way. */
typedef struct {
    double velocity[2], heading; /* wanted */
    int left;                    /* moments */
} Stick;

static void push(Stick *stick, unsigned *seed)
{
    static const double turns[] = { 0, 0.25, 0.5, 0.5, 0.75, 1, 1 }, speeds[] = { 0, 0.5, 0.5, 0.9, 0.9, 0.9 };
    double turn = PI * turns[(int)(next_random(seed) * 7)], speed = speeds[(int)(next_random(seed) * 6)];
    stick->heading += next_random(seed) < 0.5 ? turn : -turn;
    stick->velocity[0] = speed * sin(stick->heading);
    stick->velocity[1] = speed * cos(stick->heading);
    stick->left = (int)((0.9 + 1.6 * next_random(seed)) * RATE_HZ);
}

static void spring(double goal, double *value, double *change, double dt)
{
    double off = *value - goal, along = *change + off * rate, left = exp(-rate * dt);
    *value = goal + left * (off + along * dt);
    *change = left * (*change - along * rate * dt);
}

static void make_path(Roam *roam, unsigned seed)
{
    const double dt = 1.0 / RATE_HZ;
    Stick stick = { { 0, 0 }, 0, LEAD + RATE_HZ / 2 };
    double velocity[2] = { 0, 0 }, change[2] = { 0, 0 }, heading = 0, turn = 0;
    V3 place = { 0, 0, 0 };
    for (int i = 0; i < MOMENTS; i++) {
        Moment moment = { place, heading, hypot(velocity[0], velocity[1]) };
        roam->moments[i] = moment;
        if (stick.left-- <= 0) push(&stick, &seed);
        for (int k = 0; k < 2; k++) spring(stick.velocity[k], &velocity[k], &change[k], dt);
        spring(stick.heading, &heading, &turn, dt);
        place.x += velocity[0] * dt;
        place.z += velocity[1] * dt;
    }
}

static Moment moment_at(const Roam *roam, double moment)
{
    double at = clamp(moment, 0, MOMENTS - 1.001);
    const Moment *a = &roam->moments[(int)at], *b = a + 1;
    double k = at - (int)at;
    Moment out = { v3_mix(a->place, b->place, k), mix(a->heading, b->heading, k), mix(a->speed, b->speed, k) };
    return out;
}

/* --- feet --- */

static FootStance home(const Roam *roam, int side, double moment)
{
    Moment at = moment_at(roam, moment);
    V3 out = v3(side_sign(side) * apart, 0, -0.012);
    FootStance foot = { .heading = at.heading + side_sign(side) * 0.10 };
    foot.place = v3_add(at.place, quat_rotate(quat_about(v3(0, 1, 0), at.heading), out));
    return foot;
}

/* The foot that is farther from where it belongs steps, once the other one is down. */
static void make_steps(Roam *roam)
{
    const int swing = (int)(swing_s * RATE_HZ), both = (int)(both_s * RATE_HZ);
    FootStance feet[SIDES] = { home(roam, LEFT, 0), home(roam, RIGHT, 0) };
    for (int i = 0, free = 0; i < MOMENTS; i++) {
        double worst = 1;
        int side = -1;
        if (i < free) continue;
        FootStance goals[SIDES];
        for (int k = 0; k < SIDES; k++) {
            goals[k] = home(roam, k, i + 1.5 * swing + both);
            double far = v3_length(v3_sub(goals[k].place, feet[k].place)) / slack;
            far = fmax(far, fabs(goals[k].heading - feet[k].heading) / slack_turn);
            if (far > worst) {
                worst = far;
                side = k;
            }
        }
        if (side < 0 || roam->counts[side] == FALLS_MAX) continue;
        Fall fall = { i, feet[side], goals[side] };
        roam->falls[side][roam->counts[side]++] = fall;
        feet[side] = goals[side];
        free = i + swing + both;
    }
}

static double share_of(const Fall *fall, double moment)
{
    return (moment - fall->lift) / (swing_s * RATE_HZ);
}

static FootStance foot_at(const Roam *roam, int side, double moment, double *lifted)
{
    FootStance foot = home(roam, side, 0);
    *lifted = 0;
    for (int i = 0; i < roam->counts[side]; i++) {
        const Fall *fall = &roam->falls[side][i];
        double k = share_of(fall, moment);
        if (k < 0) break;
        foot = fall->to;
        if (k >= 1) continue;
        double across = smooth(0, 1, k), far = v3_length(v3_sub(fall->to.place, fall->from.place));
        *lifted = bump(2 * k - 1);
        foot.place = v3_mix(fall->from.place, fall->to.place, across);
        foot.heading = mix(fall->from.heading, fall->to.heading, across);
        foot.place.y = (0.02 + 0.05 * fmin(far, 0.6)) * 16 * k * k * (1 - k) * (1 - k);
        foot.pitch = 0.22 * fmin(far / 0.5, 1) * (0.8 * bump((k - 0.72) / 0.28) - bump((k - 0.25) / 0.25));
    }
    return foot;
}

/* --- the body --- */

static Stance stance(int number, double time_s)
{
    static Roam roams[ROAM_ALL];
    Roam *roam = &roams[number];
    if (!roam->is_made) {
        roam->is_made = 1;
        make_path(roam, 977u * (unsigned)number + 12345u);
        make_steps(roam);
    }
    double moment = LEAD + time_s * RATE_HZ, lifted[SIDES];
    Moment at = moment_at(roam, moment);
    Stance s = stance_calm();
    s.root = at.place;
    s.heading = at.heading;
    for (int side = 0; side < SIDES; side++) s.feet[side] = foot_at(roam, side, moment, &lifted[side]);
    double carries = lifted[RIGHT] - lifted[LEFT];
    V3 ahead = { sin(at.heading), 0, cos(at.heading) };
    double leads = v3_dot(v3_sub(s.feet[LEFT].place, s.feet[RIGHT].place), ahead);
    s.hips.x = 0.018 * carries;
    s.hips.y -= 0.022 + 0.025 * at.speed;
    s.hips_turn.x += 0.05 * at.speed;
    s.hips_turn.y = -0.25 * leads;
    s.waist.y = 0.35 * leads;
    for (int side = 0; side < SIDES; side++) s.hands[side].wrist.z -= 0.18 * side_sign(side) * leads;
    return s;
}

/* --- one clip for each number --- */

#define NUMBERS(X) X(0) X(1) X(2) X(3) X(4) X(5) X(6) X(7) X(8) X(9) X(10) X(11) X(12) X(13) X(14) X(15)

#define STANCE(n)                           \
    static Stance stance_##n(double time_s) \
    {                                       \
        return stance(n, time_s);           \
    }
NUMBERS(STANCE)
#define CLIP(n) { "roam_" #n, ROAM_STEPS, stance_##n, NULL, NULL, 1 },
static const Clip clips[ROAM_ALL] = { NUMBERS(CLIP) };

const Clip *roam_number(int number)
{
    return &clips[number];
}
