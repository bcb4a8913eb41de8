/* lod_joints_weights.h (private to lod_joints_fit.c): which joints move a point, and by what weights. */
#ifndef NOH_CONVERT_LOD_LOD_JOINTS_WEIGHTS_H
#define NOH_CONVERT_LOD_LOD_JOINTS_WEIGHTS_H

#include <stddef.h>
#include <stdint.h>

#include "lod_joints_fit.h"

/* What is known of a point. */
typedef struct joint_columns {
    uint32_t joint_count;
    size_t width;           /* numbers of a column */
    const float *predicted; /* [joint_count][width] what each joint alone does to the point */
    const float *wanted;    /* [width] */
    const uint16_t *parent; /* [joint_count] */
    uint16_t of;            /* only joints with this parent count */
    double share;           /* the most that weights add up to */
    uint32_t slots;         /* 1..JOINTS_PER_VERTEX: the most joints; where all are used, weights add up to the share */
} joint_columns;

/* Choose joints and weights for which the weighted columns come nearest to what is wanted. joint, weight: from the
 * last round; weights of 0 are unused slots. left: scratch, [width] */
void joint_weigh(const joint_columns *c, uint8_t joint[JOINTS_PER_VERTEX], float weight[JOINTS_PER_VERTEX],
                 float *left);
double joint_dot(const float *a, const float *b, size_t count);

#endif
