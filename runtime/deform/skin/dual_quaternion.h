/* dual_quaternion.h: skinning that keeps volume where joints twist.
 *
 * Linear blending of matrices flattens the mesh between two joints that twist against each other ("candy wrapper");
 * blending rigid motions as dual quaternions does not.
 *
 * A joint's matrix M (position = A p + t) is split as A = R H, R a rotation and H symmetric (polar decomposition):
 * first the mesh is stretched, then it moves rigidly. r_i = R_i as a quaternion (x, y, z, w); d_i = 1/2 (t_i, 0) r_i
 * For a vertex with weights w_i, joint 0 the strongest:
 *   s_i  = +1, or -1 where dot(r_i, r_0) < 0        (r and -r are one rotation: take the shorter way)
 *   H    = w_0 H_0 + w_1 H_1 + ...                  (stretches are blended linearly)
 *   r    = w_0 s_0 r_0 + ...,  d = w_0 s_0 d_0 + ...
 *   r, d are divided by |r|
 *   t    = 2 (r_w d - d_w r + cross(r, d)), the vector parts except for _w   (d's component along r cancels)
 *   position = rotate(r, H p) + t
 *   normal   = unit(rotate(r, s C n)), C the cofactors of H, s the sign of its determinant
 *   tangent  = unit(rotate(r, H t)), its handedness times s
 *   rotate(r, v) = v + 2 cross(r, cross(r, v) + r_w v)
 * A single joint moves its vertices exactly as its matrix does, including scale and mirroring.
 *
 * source  Kavan, Collins, Zara, O'Sullivan: Geometric skinning with approximate dual quaternion blending, 2008,
 *         including the stretch in a first phase (section 4.2)
 *
 * Threads: no state; any thread. */
#ifndef NOH_DEFORM_DUAL_QUATERNION_H
#define NOH_DEFORM_DUAL_QUATERNION_H

#include "deform/morph/morph.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One joint: its rigid motion in 2 x 4 floats, and its stretch. */
typedef struct noh_dual_quaternion {
    float real[4]; /* xyzw, unit */
    float dual[4];
    float stretch[9]; /* [3][3] rows, symmetric */
} noh_dual_quaternion;

/* Split a matrix of 3 rows of 4. If its axes vanish or lie in a plane the rotation is undefined: it is then the
 * identity, and all of A is stretch. */
void noh_dual_quaternion_from_matrix(const float matrix[12], noh_dual_quaternion *out);

/* Split the matrices of all joints of a skin, once per instance and frame (noh_skin_matrices).
 * shapes  matrices[count][12], out[count] */
void noh_skin_dual_quaternions(const float *matrices, uint32_t count, noh_dual_quaternion *out);

/* Compute a vertex as drawn, in model space.
 * shapes  joints[skin's joint_count]; layers NULL: no morph targets
 * ranges  index below vertex_count, of a skinned mesh */
void noh_skin_vertex_dual(const noh_mesh *mesh, const noh_dual_quaternion *joints, const noh_morph_layers *layers,
                          uint32_t index, noh_vertex *out);

/* Compute only the position of a vertex, with the same bits. */
void noh_skin_position_dual(const noh_mesh *mesh, const noh_dual_quaternion *joints, const noh_morph_layers *layers,
                            uint32_t index, float out[3]);

/* Skin a range of vertices; parameters as for noh_skin_vertices. */
void noh_skin_vertices_dual(const noh_mesh *mesh, const noh_dual_quaternion *joints, const noh_morph_layers *layers,
                            uint32_t first, uint32_t count, float *positions, float *normals, float *tangents);

#ifdef __cplusplus
}
#endif

#endif
