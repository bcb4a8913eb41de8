#include "arms.h"

#define PI 3.14159265358979323846
#define BONE 0.5 /* metres, from the shoulder to the elbow and from there to the end */
#define RADIUS 0.14
#define UP 1.40 /* height of the bending row above the twisting one */
#define DEGREES (PI / 180)

/* Just short of half a turn, where both directions are equally short; beyond it dual quaternions take the other one. */
#define HALF_A_TURN (179.5 * DEGREES)

const double segment_turn = 120 * DEGREES;
const Dye hand_dye = { { 0.80, 0.42, 0.20 }, { 0.42, 0.13, 0.06 }, { 0.80, 0.66, 0.45 } };

const Arm *arm_number(int number)
{
    static const Arm arms[ARM_COUNT] = {
        { "bent",
          { -0.20, UP, 0 },
          { 0, 2 * BONE, RADIUS, 0, 0, 12, 2, { 0, BONE }, 0.16 },
          BEND,
          120 * DEGREES,
          { { 0.75, 0.66, 0.40 }, { 0.08, 0.22, 0.30 }, { 0.05, 0.12, 0.17 } } },
        { "four",
          { 0.75, UP, 0 },
          { 0, 2 * BONE, RADIUS, 0, 0, 12, 4, { 0, 0.25, 0.50, 0.75 }, 0 },
          BEND,
          40 * DEGREES,
          { { 0.72, 0.70, 0.42 }, { 0.11, 0.26, 0.10 }, { 0.06, 0.15, 0.06 } } },
        { "twisted_linear",
          { -1.05, 0, 0 },
          { 0, 2 * BONE, RADIUS, 0, 0, 12, 2, { 0, 0.75 }, 0.20 },
          TWIST,
          HALF_A_TURN,
          { { 0.78, 0.62, 0.46 }, { 0.36, 0.05, 0.05 }, { 0.20, 0.03, 0.03 } } },
        { "twisted_dual",
          { -0.45, 0, 0 },
          { 0, 2 * BONE, RADIUS, 0, 0, 12, 2, { 0, 0.75 }, 0.20 },
          TWIST,
          HALF_A_TURN,
          { { 0.72, 0.66, 0.62 }, { 0.16, 0.08, 0.34 }, { 0.09, 0.04, 0.20 } } },
    };
    return &arms[number];
}

const Segment *segment_number(int number)
{
    static const Segment segments[SEGMENT_COUNT] = {
        { "segmented",
          { -1.15, UP, 0 },
          { 0, BONE, RADIUS, 0, 1, 6, 1, { 0 }, 0 },
          { { 0.74, 0.60, 0.42 }, { 0.10, 0.14, 0.34 }, { 0.60, 0.05, 0.04 } } },
        { "segmented_lower",
          { 0, BONE, 0 },
          { 0, BONE, RADIUS, 1, 0, 6, 1, { 0 }, 0 },
          { { 0.74, 0.60, 0.42 }, { 0.10, 0.14, 0.34 }, { 0.60, 0.05, 0.04 } } },
    };
    return &segments[number];
}

V3 hand_stand(int open)
{
    return v3(open ? 1.20 : 0.45, BONE, 0);
}

V3 clip_axis(int clip)
{
    return clip == BEND ? v3(0, 0, -1) : v3(0, 1, 0);
}

const char *clip_name(int clip)
{
    return clip == BEND ? "bend" : "twist";
}
