/* joint_points.h: a sample of the vertices that a skeleton moves, on which a clip's error is measured. */
#ifndef NOH_CONVERT_SKIN_JOINT_POINTS_H
#define NOH_CONVERT_SKIN_JOINT_POINTS_H

#include "stage/character/time_lod_internal.h"
#include "noh/low_stage.h"
#include "convert/model/model.h"

#define JOINT_POINTS 256u /* the most chosen, not counting one for each joint */

typedef struct joint_points {
    noh_time_lod_points points; /* point_count 0: no mesh is bound to the skeleton */
    noh_time_hold *holds;       /* its own */
} joint_points;

/* Choose the vertices that move most: for each joint the farthest that it moves, in any direction and along its axes,
 * by distance times weight; the extremes of the bounding box; then, again and again, the vertex farthest from all
 * chosen so far (farthest-point sampling).
 * m       NULL: no meshes; else bound (skins.h)
 * errors  1: out of memory; there is then nothing to free */
int joint_points_choose(const model *m, uint32_t set, uint32_t joint_count, joint_points *out);

void joint_points_free(joint_points *p);

#endif
