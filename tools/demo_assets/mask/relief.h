/* The relief: an egg-shaped head, and the features that stand out from it. */
#ifndef MASK_RELIEF_H
#define MASK_RELIEF_H

#include "face.h"

/* Depth of the bare head at (x, y): no nose, no lips, no sockets. */
double head_depth(double x, double y);

/* How far the features stand out at a point of the closed face plane. They
 * belong to the skin, so they travel with it when a pose drags it. */
double relief(FacePoint point, const Pose *pose);

/* Edge of the red above (+1) or below (-1) the line between the lips. */
double lip_edge(double s, int side);

#endif
