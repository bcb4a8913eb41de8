/* How the puppet stands: a few controls, and the joints that follow from them. Limbs are posed by two-bone inverse
 * kinematics, so feet stay where they are put. */
#ifndef PUPPET_STANCE_H
#define PUPPET_STANCE_H

#include "joints.h"
#include "shared/quat.h"

/* Metres and radians. Turns: x bows forward, y turns to the left, z leans to the right. */
typedef struct {
    V3 place;       /* of the sole below the ankle, in the scene */
    double heading; /* to the left, from +z */
    double pitch;   /* above 0 the toes are raised, below 0 the heel */
    double knee;    /* where the knee points: 0 ahead, above 0 upwards */
} FootStance;

typedef struct {
    V3 wrist;           /* in the chest's frame; x counts outwards on both sides */
    V3 elbow;           /* where the elbow points, likewise */
    double roll;        /* of the hand about its length: above 0 the thumb goes down */
    double bend;        /* of the wrist: above 0 towards the palm */
    double curl, thumb; /* of the fingers: 0 is straight, 1 a fist */
} HandStance;

typedef struct {
    V3 root;
    double heading;
    V3 hips, hips_turn; /* offset and turn relative to their place above the root */
    V3 waist, head;     /* turns, spread over spine and chest, neck and head */
    double jaw;         /* radians open */
    FootStance feet[SIDES];
    HandStance hands[SIDES];
    V3 hang;         /* where sleeves hang to at rest; of length 1 */
    V3 drift[SIDES]; /* of each sleeve, where it hangs towards instead of straight down; of length 1 */
} Stance;

/* What the file stores: turns relative to the parent, and places of root and hips. */
typedef struct {
    Quat turn[JOINT_COUNT];
    V3 root, hips; /* relative to the parent */
} Posed;

/* A calm stance at the origin, knees slightly bent, hands before the thighs. */
Stance stance_calm(void);

/* wrists: receives their positions in the scene; may be NULL. */
Posed stance_solve(const Stance *stance, V3 wrists[SIDES]);

#endif
