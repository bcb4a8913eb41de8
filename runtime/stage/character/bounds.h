/* bounds.h: where a character is, from its joints: for culling, and for the distance that LOD levels are chosen by.
 * With the weights that it shows (stage_bounds.c) the radii are those at weight 0, and targets add their boxes.
 *
 *   noh_joint_bounds          a box and a sphere around a posed skeleton
 *   noh_skeleton_radius       a radius that no pose exceeds, for when there is no pose yet
 *   noh_mesh_add_joint_radii  the joint radii that both take, out of a pack's mesh
 *
 * Box and sphere contain every vertex. A skinned vertex is a weighted mean of the positions that its joints give it;
 * each of these lies within the joint's radius of the joint; and boxes and spheres are convex, so they contain the mean
 * of points that they contain. A joint's radius (joint_radius_m[joint]) is the largest distance, in the bind pose, from
 * the joint to a vertex that it moves, with all morph targets at the weights that they are expected to reach; below 0:
 * the joint moves no vertex.
 *
 * Threads: pure functions of their arguments; any thread. */
#ifndef NOH_CHARACTER_BOUNDS_H
#define NOH_CHARACTER_BOUNDS_H

#include "motion/pose/skeleton.h"
#include "core/mesh/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_bounds {
    float low[3], high[3];   /* the box; low above high: empty */
    float centre[3], radius; /* the sphere */
    float stretch;           /* the most that a joint's matrix stretches a length; 0: empty */
} noh_bounds;

/* Bounds of a pose, in the space of the matrices.
 * shapes  model[joint_count][12] of noh_local_to_model; joint_radius_m[the skeleton's joint_count]
 * ranges  joint_count at most the skeleton's: the joints that were posed, all roots among them. The vertices of any
 *         other joint are bounded around its nearest posed ancestor, in a radius that grows by the lengths and scales of
 *         the bind pose's bones in between. A radius is scaled by the most that its joint's matrix stretches */
void noh_joint_bounds(const noh_skeleton *skeleton, const float *model, const float *joint_radius_m,
                      uint32_t joint_count, noh_bounds *bounds);

/* The largest distance from a root joint to a vertex below it, whatever the rotations: the longest chain of bind
 * translations plus the radius at its end.
 * ranges  poses that keep the bind pose's translations, and scales of 1, below the roots */
float noh_skeleton_radius(const noh_skeleton *skeleton, const float *joint_radius_m);

/* Raise the joint radii until they contain a mesh: each becomes at least the distance of the farthest corner of the
 * joint's box (noh_mesh.joint_boxes), grown by the targets' boxes, in the joint's space. Begin with -1 for every joint
 * and add each mesh that is drawn. A rigid mesh adds nothing. The radii hold for linear blend skinning; dual
 * quaternions may exceed them a little.
 * shapes  weights[target_count]: the weight farthest from 0 that each target is expected to reach, all at once; NULL: 1
 *         each; joint_radius_m[joint_count of the skin's skeleton]
 * units   those of the joints' matrices */
void noh_mesh_add_joint_radii(const noh_mesh *mesh, const float *weights, float *joint_radius_m);

#ifdef __cplusplus
}
#endif

#endif
