/* Rotations as unit quaternions. */
#ifndef PUPPET_QUAT_H
#define PUPPET_QUAT_H

#include "shared/maths.h"

typedef struct {
    double x, y, z, w;
} Quat;

Quat quat_none(void);
Quat quat_about(V3 axis, double angle); /* axis: of length 1 */
Quat quat_turn(V3 angles);              /* about z, then x, then y; radians */
Quat quat_multiply(Quat a, Quat b);     /* first b, then a */
Quat quat_inverse(Quat q);
V3 quat_rotate(Quat q, V3 v);

/* The shortest turn from one direction to another, both of length 1, but at most `limit`. */
Quat quat_between(V3 from, V3 to, double limit);

/* The turn that brings direction a to b, and the half plane of `side_a` about it to the half plane of `side_b`. */
Quat quat_align(V3 a, V3 side_a, V3 b, V3 side_b);

#endif
