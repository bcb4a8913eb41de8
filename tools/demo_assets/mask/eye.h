/* The eyeballs. */
#ifndef MASK_EYE_H
#define MASK_EYE_H

#include "model.h"

#define BALL_RADIUS 0.0180

void eyes_build(Model *model);
V3 ball_place(const Seed *seed, const Pose *pose);
V3 ball_centre(int side);

/* Depth of the ball's front at (x, y); falls away steeply outside the ball. */
double ball_front(int side, double x, double y);

/* The same for a shell that lies `lift` outside the ball. */
double ball_shell(int side, double x, double y, double lift);

/* Angle from the ball's axis to the edge of the iris and of the pupil. */
#define IRIS_ANGLE 0.345
#define PUPIL_ANGLE 0.165

#endif
