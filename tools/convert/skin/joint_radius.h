/* joint_radius.h: the radius of what each joint moves. */
#ifndef NOH_CONVERT_SKIN_JOINT_RADIUS_H
#define NOH_CONVERT_SKIN_JOINT_RADIUS_H

#include "convert/clips/moved_vertices.h"

/* For each joint of a set's skeleton, the distance of the farthest vertex that it moves with a weight of at least
 * MOVED_WEIGHT_LEAST, in the bind pose and in the joint's own space; -1 if it moves none.
 * m        NULL: no meshes; else bound (skins.h)
 * out      [joint_count]
 * returns  0 if no mesh is bound to the skeleton: all are -1 */
int joint_radius(const model *m, uint32_t set, uint32_t joint_count, float *out);

#endif
