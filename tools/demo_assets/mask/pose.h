/* A pose: how far each muscle of the face is pulled, 0 at rest, 1 fully. */
#ifndef MASK_POSE_H
#define MASK_POSE_H

#include "shared/sides.h"

typedef struct {
    double brow_inner_up;
    double brow_down[SIDES], brow_outer_up[SIDES];
    double blink[SIDES], squint[SIDES], wide[SIDES];
    double look_up[SIDES], look_down[SIDES], look_in[SIDES], look_out[SIDES];
    double cheek_puff, cheek_squint[SIDES], sneer[SIDES];
    double jaw_open, jaw_forward, jaw_side; /* jaw_side: +1 is the left */
    double smile[SIDES], frown[SIDES], dimple[SIDES], stretch[SIDES], press[SIDES];
    double upper_up[SIDES], lower_down[SIDES];
    double pucker, funnel, roll_upper, roll_lower, shrug_upper, shrug_lower;
    double mouth_side, mouth_close, tongue_out;
    double tongue_up; /* its tip to the upper teeth; the mask has no such target */
    double grin;      /* lips part before the teeth, and Nell's cheeks rise */
    double nothing;
} Pose;

#endif
