/* joint_points.h: a sample of the vertices that a skeleton moves, on which a clip's error is measured. */
#ifndef NOH_CONVERT_SKIN_JOINT_POINTS_H
#define NOH_CONVERT_SKIN_JOINT_POINTS_H

#include "character/time_lod_points.h"
#include "convert/model/model.h"

#define JOINT_POINTS 256u /* at most, and one more for each joint */

typedef struct joint_points {
    noh_time_lod_points points; /* point_count 0: no mesh is bound to the skeleton */
    noh_time_hold *holds;       /* its own */
} joint_points;

/* Choose those that move most: of each joint the farthest that it moves, in all and along its axes, weighted; the
 * extremes of the box; then always the vertex farthest from all that were chosen (farthest-point sampling).
 * m       NULL: no meshes; else bound (skins.h)
 * errors  1: out of memory; nothing is then left open */
int joint_points_choose(const model *m, uint32_t set, uint32_t joint_count, joint_points *out);

void joint_points_free(joint_points *p);

#endif
