/* bounds_internal.h: bounds of a character from its joints, for culling and for the distance used by LOD. When morph
 * weights are known (stage_bounds.c), the radii are for weight 0 and targets add their boxes.
 *
 *   noh_joint_bounds          a box and a sphere around a posed skeleton
 *   noh_skeleton_radius       a radius that no pose exceeds, for use before the first pose
 *   noh_mesh_add_joint_radii  joint radii for both, from a pack's mesh
 *
 * Box and sphere contain every vertex. A skinned vertex is a weighted mean of the positions that its joints give it,
 * and each position lies within its joint's radius; boxes and spheres are convex, so they contain the mean too. A
 * joint's radius (joint_radius_m[joint]) is the largest distance, in the bind pose, from the joint to a vertex that it
 * moves, with all morph targets at their largest expected weights; below 0: the joint moves no vertex.
 *
 * Threads: pure functions of their arguments; any thread. */
#ifndef NOH_CHARACTER_BOUNDS_INTERNAL_H
#define NOH_CHARACTER_BOUNDS_INTERNAL_H

#include "noh/clip.h"
#include "noh/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_bounds {
    float low[3], high[3];   /* the box; low above high: empty */
    float centre[3], radius; /* the sphere */
    float stretch;           /* largest stretch of a length by a joint's matrix; 0: empty */
} noh_bounds;

/* Compute the bounds of a pose, in the space of the matrices. Vertices of joints that were not posed are bounded around
 * the nearest posed ancestor; their radius grows by the lengths and scales of the bones between them in the bind pose.
 * Each radius is scaled by its joint's largest stretch.
 * shapes  model[joint_count][12] of noh_local_to_model; joint_radius_m[joint_count of the skeleton]
 * ranges  joint_count: the number of joints posed, including all roots; at most the skeleton's */
void noh_joint_bounds(const noh_skeleton *skeleton, const float *model, const float *joint_radius_m,
                      uint32_t joint_count, noh_bounds *bounds);

/* The largest distance from a root joint to a vertex below it, for any rotations: the longest chain of bind
 * translations plus the radius at its end.
 * ranges  poses that keep the bind pose's translations and scales of 1 below the roots */
float noh_skeleton_radius(const noh_skeleton *skeleton, const float *joint_radius_m);

#ifdef __cplusplus
}
#endif

#endif
