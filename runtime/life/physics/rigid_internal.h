/* rigid_internal.h: the private part of body.h. */
#ifndef NOH_SIM_RIGID_INTERNAL_H
#define NOH_SIM_RIGID_INTERNAL_H

#include "noh/body.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_RIGID_STEP_TICKS 80u /* 1/600 s */

/* Collide a point mass, moved by noh_point_move, with a world. It leaves an overlap by the depth that its velocity
 * caused, and any further depth at NOH_PUSH_OUT_SPEED. Its velocity towards an obstacle is reversed by the world's
 * restitution; its velocity along it is reduced by friction. For noh_verlet_move: velocity = (position - before) /
 * seconds, and afterwards before = position - seconds * velocity. Use it for the ends of springs and rods
 * (noh_distance_keep).
 * ranges   radius 0.., seconds above 0: of the preceding move
 * returns  whether it touched something */
int noh_point_touch(const noh_world *world, float radius, float position[3], float velocity[3], float seconds);

#ifdef __cplusplus
}
#endif

#endif
