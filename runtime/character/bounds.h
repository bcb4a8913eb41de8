/* bounds.h: where a character is, from its joints: for visibility and for the distance that detail is chosen by.
 *
 *   noh_sphere_of_joints     a box and a sphere around a posed skeleton
 *   noh_sphere_of_skeleton   how far any pose can reach from the root: before there is a pose
 *   noh_margins_add          the margins that both want, out of a pack's mesh
 *
 * Both hold all vertices: a skinned vertex is a weighted mean of the places that its joints would put it,
 * each within that joint's margin of the joint, and a sphere and a box hold the means of what they hold.
 * A margin is the largest distance of a vertex to a joint that it hangs on, in the bind pose, with all
 * morph targets counted in as far as their weights are expected to go; below 0: nothing hangs on the joint. */
#ifndef NOH_CHARACTER_BOUNDS_H
#define NOH_CHARACTER_BOUNDS_H

#include "anim/skeleton.h"
#include "mesh/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_bounds {
    float low[3], high[3];  /* the box; low above high: nothing is there */
    float centre[3], radius; /* the sphere */
} noh_bounds;

/* Bounds of a pose, in the space of the matrices.
 * shapes  model[joint_count][12] of noh_local_to_model, margin_m[the skeleton's joint_count]
 * ranges  joint_count up to the skeleton's: the first so many were posed, all roots among them. What hangs on
 *         another joint is bounded around the nearest joint above it that was: as far as the bind pose's bones reach.
 *         A margin grows by the longest axis of its joint's matrix, which must not shear */
void noh_sphere_of_joints(const noh_skeleton *skeleton, const float *model, const float *margin_m, uint32_t joint_count, noh_bounds *bounds);

/* The farthest that a vertex can come from the position of its root joint (the joint above it that has no
 * parent), whatever the rotations: the longest chain of bind translations, and the margin at its end.
 * ranges  poses that keep the bind pose's translations and scales of 1 below the roots */
float noh_sphere_of_skeleton(const noh_skeleton *skeleton, const float *margin_m);

/* Grow margins to hold what a mesh hangs on the joints: the farthest corner of each joint's box (noh_mesh.joint_boxes),
 * grown by the targets' boxes, brought into the joint's space. Begin with -1 for every joint; add each mesh that is
 * drawn. A rigid mesh hangs on no joint. For skins of matrices: dual quaternions may leave the bounds a little.
 * shapes  weights[target_count] the farthest from 0 that each target is expected to go, all at once; NULL: 1 each;
 *         margin_m[joint_count of the skeleton of the mesh's skin], in the unit of its joints */
void noh_margins_add(const noh_mesh *mesh, const float *weights, float *margin_m);

#ifdef __cplusplus
}
#endif

#endif
