/* bounds.h: the bounding box of a deformed mesh, computed without reading its vertices.
 *
 * The pack holds for each joint the box of the bind positions that it moves, and for each target the box of its
 * differences. A vertex moved by several joints lies in the hull of the positions that each joint alone would give it.
 * So the union of the joints' boxes, grown by the weighted boxes of the targets and moved by the joints, contains every
 * vertex. A small margin covers rounding in the vertices' arithmetic.
 *
 * Dual quaternions leave that hull: joints that turn against each other put a vertex on an arc. Its points are at most
 * 0.62 times as far from the hull as the joints put the vertex apart (Jung's theorem, for turns of up to 180 degrees
 * about one centre); the largest such distance is found over all pairs of joints whose boxes overlap. If joints also
 * move or stretch against each other, the bound is tested, not proven.
 *
 * A box is 6 floats: minimum x, y, z, then maximum x, y, z. Boxes of skinned meshes are in model space.
 *
 * Threads: no state; any thread. */
#ifndef NOH_DEFORM_BOUNDS_H
#define NOH_DEFORM_BOUNDS_H

#include "core/mesh/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Compute the box of the targets' offsets of any vertex, before joints move it; contains 0.
 * shapes  weights[target_count], of any size and sign; NULL: no morph targets */
void noh_mesh_target_box(const noh_mesh *mesh, const float *weights, float box[6]);

/* Compute the box of a rigid mesh.
 * shapes  world[12], NULL: mesh space; weights[target_count], NULL: no morph targets */
void noh_mesh_box(const noh_mesh *mesh, const float *world, const float *weights, float box[6]);
/* Compute the box of a rigid mesh from a given box of target offsets (noh_mesh_target_box); box may be deltas. */
void noh_mesh_moved_box(const noh_mesh *mesh, const float *world, const float deltas[6], float box[6]);

/* Compute the box of a skinned mesh.
 * shapes  matrices[skin's joint_count][12] (noh_skin_matrices); weights as above */
void noh_skin_box(const noh_mesh *mesh, const float *matrices, const float *weights, float box[6]);

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
