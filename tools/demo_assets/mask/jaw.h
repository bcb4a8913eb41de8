/* The jaw turns about a hinge in front of the ears. */
#ifndef MASK_JAW_H
#define MASK_JAW_H

#include "face.h"

/* How far a point of the face follows the jaw, 0 to 1: in a pose whose mouth_close is 1 both lips stay together. */
double jaw_weight(FacePoint point, const Pose *pose);

V3 jaw_move(V3 at, double weight, const Pose *pose);

#endif
