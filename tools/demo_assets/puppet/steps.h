/* Footsteps along a path: each foot stays exactly where it was put until it is lifted. */
#ifndef PUPPET_STEPS_H
#define PUPPET_STEPS_H

#include "stance.h"

/* Where the body is at a time: the place on the floor, and where it looks. */
typedef struct {
    V3 place;
    double heading;
} Spot;

typedef struct {
    double lift_s, land_s; /* a foot's steps are in the order of their times */
    double height;         /* of the sole, at most */
    double heel;           /* how far the heel leads the way up, radians */
} Step;

enum { STEPS_MAX = 24 };

/* Steps of both feet within one period. */
typedef struct {
    double period_s;
    Spot (*path)(double time_s); /* also before 0 and after the period */
    double apart;                /* of each foot from the middle */
    int count[SIDES];
    Step steps[SIDES][STEPS_MAX];
} Gait;

/* A foot is put where the body will be half way between its landing and its next lift. */
FootStance gait_foot(const Gait *gait, int side, double time_s);

#endif
