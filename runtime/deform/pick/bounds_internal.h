/* bounds_internal.h: the private part of deform.h. */
#ifndef NOH_DEFORM_BOUNDS_INTERNAL_H
#define NOH_DEFORM_BOUNDS_INTERNAL_H

#include "noh/deform.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Compute the box of the targets' offsets of any vertex, before joints move it; contains 0.
 * shapes  weights[target_count], of any size and sign; NULL: no morph targets */
void noh_mesh_target_box(const noh_mesh *mesh, const float *weights, float box[6]);

/* Compute the box of a rigid mesh from a given box of target offsets (noh_mesh_target_box); box may be deltas. */
void noh_mesh_moved_box(const noh_mesh *mesh, const float *world, const float deltas[6], float box[6]);

/* Compute for each joint the box of the vertices that it moves, as if it alone moved them; empty if it moves none.
 * shapes  boxes[skin's joint_count][6] */
void noh_skin_joint_boxes(const noh_mesh *mesh, const float *matrices, const float *weights, float *boxes);

/* Make an empty box (minimum above maximum); unite two boxes (out may be a or b); test whether a box is empty. */
void noh_box_empty(float box[6]);
void noh_box_unite(const float a[6], const float b[6], float out[6]);
static inline int noh_box_is_empty(const float box[6])
{
    return box[0] > box[3];
}

#ifdef __cplusplus
}
#endif

#endif
