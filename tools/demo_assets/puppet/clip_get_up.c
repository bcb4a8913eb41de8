/* Up from the back: sits up, draws the feet in, leans over them and stands. Up from the front: pushes up on hands and
 * knees, sets a foot before itself and stands. Both end over the origin in a calm stance. */
#include "clips.h"

#include <stddef.h>

/* What a moment sets. Feet: z, height and pitch of each; the hands are each other's mirror image. */
enum {
    HIPS_Y,
    HIPS_Z,
    BOW,
    WAIST,
    NOD,
    LEFT_Z,
    LEFT_Y,
    LEFT_PITCH,
    RIGHT_Z,
    RIGHT_Y,
    RIGHT_PITCH,
    KNEE,
    WRIST_X,
    WRIST_Y,
    WRIST_Z,
    ELBOW_X,
    ELBOW_Y,
    ELBOW_Z,
    CURL,
    BEND,
    TRAIL, /* of sleeves that lie on the ground: 1 they point to the feet, as robe and arms lie */
    VALUES
};

typedef struct {
    double time_s;
    double values[VALUES];
} Moment;

/* clang-format off */
static const Moment from_back[] = {
    /*        hips          bow    waist  nod    left foot            right foot           knee  wrist               elbow              curl  bend  trail */
    { 0.00, { 0.130, -0.50, -1.55,  0.00,  0.06, 0.410, 0.00, 1.30,   0.395, 0.00, 1.25,   1.57, 0.300, -0.260,  0.00, 0.80, -0.10, -0.40, 0.30, 0.05, 1.0 } },
    { 0.35, { 0.130, -0.50, -1.50,  0.10,  0.40, 0.380, 0.00, 1.20,   0.300, 0.00, 0.90,   1.57, 0.310, -0.250, -0.02, 0.80, -0.10, -0.50, 0.20, 0.05, 1.0 } },
    { 0.95, { 0.125, -0.46, -0.62,  0.45,  0.35, 0.120, 0.01, 0.40,  -0.010, 0.02, 0.10,   1.30, 0.330, -0.210, -0.16, 0.60,  0.00, -0.80, 0.05, -0.60, 0.7 } },
    { 1.40, { 0.150, -0.38,  0.05,  0.50,  0.10, 0.000, 0.00, 0.00,  -0.012, 0.00, 0.00,   0.90, 0.300, -0.200,  0.05, 0.80,  0.00, -0.60, 0.20, -0.30, 0.5 } },
    { 1.95, { 0.340, -0.17,  0.75,  0.45, -0.25, -0.010, 0.00, 0.00, -0.012, 0.00, 0.00,   0.40, 0.260, -0.130,  0.32, 0.85, -0.15, -0.50, 0.30, 0.10, 0.3 } },
    { 2.55, { 0.660, -0.09,  0.55,  0.25, -0.25, -0.012, 0.00, 0.00, -0.012, 0.00, 0.00,   0.10, 0.260, -0.170,  0.27, 0.85, -0.15, -0.50, 0.36, 0.12, 0.0 } },
    { 3.20, { 0.876, -0.012, 0.06,  0.05, -0.09, -0.012, 0.00, 0.00, -0.012, 0.00, 0.00,   0.00, 0.255, -0.215,  0.195, 0.85, -0.15, -0.50, 0.38, 0.12, 0.0 } },
};
static const Moment from_front[] = {
    { 0.00, { 0.130, -0.40,  1.56,  0.00, -0.05, -1.390, 0.00, -1.55, -1.380, 0.00, -1.55, -1.57, 0.310, 0.080,  0.08, 0.90, -0.35, -0.20, 0.05, -1.25, 1.0 } },
    { 0.35, { 0.135, -0.40,  1.54, -0.05, -0.25, -1.380, 0.00, -1.55, -1.370, 0.00, -1.55, -1.57, 0.290, 0.100,  0.10, 0.90, -0.35, -0.30, 0.05, -1.30, 1.0 } },
    { 0.95, { 0.400, -0.44,  1.40,  0.02, -0.30, -1.080, 0.00, -1.50, -1.060, 0.00, -1.50, -0.60, 0.230, 0.190,  0.46, 0.90, -0.20, -0.30, 0.05, -1.30, 0.9 } },
    { 1.50, { 0.440, -0.42,  1.28,  0.10, -0.20, -0.350, 0.07, -0.50, -0.880, 0.00, -1.45, -0.10, 0.230, 0.170,  0.46, 0.90, -0.20, -0.30, 0.05, -1.20, 0.9 } },
    { 1.95, { 0.500, -0.26,  0.85,  0.35, -0.20, -0.012, 0.00,  0.00, -0.560, 0.00, -1.20,  0.00, 0.250, -0.080, 0.36, 0.85, -0.15, -0.50, 0.20, -0.20, 0.5 } },
    { 2.45, { 0.690, -0.13,  0.55,  0.25, -0.25, -0.012, 0.00,  0.00, -0.260, 0.06, -0.60,  0.00, 0.260, -0.170, 0.27, 0.85, -0.15, -0.50, 0.36, 0.12, 0.0 } },
    { 3.10, { 0.876, -0.012, 0.06,  0.05, -0.09, -0.012, 0.00,  0.00, -0.012, 0.00,  0.00,  0.00, 0.255, -0.215, 0.195, 0.85, -0.15, -0.50, 0.38, 0.12, 0.0 } },
};
/* clang-format on */
enum { STEPS_BACK = 96, STEPS_FRONT = 93 };

/* The slope of a value at a moment: that between its neighbours, 0 at the ends and where the value turns back. */
static double slope(const Moment *moments, int count, int i, int value)
{
    if (i == 0 || i == count - 1) {
        return 0;
    }
    const Moment *before = &moments[i - 1], *now = &moments[i], *after = &moments[i + 1];
    double rise1 = (now->values[value] - before->values[value]) / (now->time_s - before->time_s);
    double rise2 = (after->values[value] - now->values[value]) / (after->time_s - now->time_s);
    return rise1 * rise2 <= 0 ? 0 : 2 * rise1 * rise2 / (rise1 + rise2);
}

/* Through the moments, without going beyond them. */
static double value_at(const Moment *moments, int count, double time_s, int value)
{
    int i = 0;
    time_s = clamp(time_s, 0, moments[count - 1].time_s);
    while (i + 2 < count && time_s >= moments[i + 1].time_s) {
        i++;
    }
    double span = moments[i + 1].time_s - moments[i].time_s, k = (time_s - moments[i].time_s) / span;
    double a = moments[i].values[value], b = moments[i + 1].values[value];
    double p = span * slope(moments, count, i, value), q = span * slope(moments, count, i + 1, value);
    return a + k * (p + k * (3 * (b - a) - 2 * p - q + k * (2 * (a - b) + p + q)));
}

static Stance rising(const Moment *moments, int count, double time_s, double feet)
{
    double v[VALUES];
    for (int i = 0; i < VALUES; i++) {
        v[i] = value_at(moments, count, time_s, i);
    }
    Stance s = stance_calm();
    s.hips = v3(0, v[HIPS_Y] - joint_place(HIPS).y, v[HIPS_Z]);
    s.hips_turn = v3(v[BOW], 0, 0);
    s.waist = v3(v[WAIST], 0, 0);
    s.head = v3(v[NOD], 0, 0);
    s.hang = v3_unit(v3(0, -1.1 + v[TRAIL], feet * v[TRAIL]));
    for (int side = 0; side < SIDES; side++) {
        FootStance *foot = &s.feet[side];
        HandStance *hand = &s.hands[side];
        const double *at = &v[side == LEFT ? LEFT_Z : RIGHT_Z];
        foot->place.z = at[0];
        foot->place.y = at[1];
        foot->pitch = at[2];
        foot->knee = v[KNEE];
        hand->wrist = v3(v[WRIST_X], v[WRIST_Y], v[WRIST_Z]);
        hand->elbow = v3(v[ELBOW_X], v[ELBOW_Y], v[ELBOW_Z]);
        hand->curl = v[CURL];
        hand->bend = v[BEND];
    }
    return s;
}

static Stance stance_back(double time_s)
{
    return rising(from_back, sizeof from_back / sizeof from_back[0], time_s, 1);
}

static Stance stance_front(double time_s)
{
    return rising(from_front, sizeof from_front / sizeof from_front[0], time_s, -1);
}

const Clip clip_get_up_back = { "get_up_back", STEPS_BACK, stance_back, NULL, NULL, 1 };
const Clip clip_get_up_front = { "get_up_front", STEPS_FRONT, stance_front, NULL, NULL, 1 };
