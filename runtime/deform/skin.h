/* skin.h: skinned meshes on the CPU, after their morph targets (row C8.7).
 *
 * The reference for the GPU, the fallback where there is none, and the surface that
 * picking uses. For each vertex, with its joints' matrices M_i and weights w_i, which
 * sum to 1 (rows C3.2, E1-E3):
 *   M = w_0 M_0 + w_1 M_1 + ... in this order, one product and one sum per element
 *   position = M (p, 1)
 *   normal   = unit(s C n), C the cofactors of M's 3 x 3 part, s the sign of its
 *              determinant: the inverse transpose (rows C3.8, E4), also where an axis
 *              has no length
 *   tangent  = unit(M t), its handedness times s
 * Meshes with NOH_MESH_DUAL_QUATERNION want dual_quaternion.h instead. The SIMD path is
 * chosen when the library is compiled; all give the bits of noh_skin_vertex. */
#ifndef NOH_DEFORM_SKIN_H
#define NOH_DEFORM_SKIN_H

#include "deform/morph.h"

/* What moves the vertices of a skin's meshes, made once per instance and frame: model[joint] * inverse bind.
 * shapes  model[the skeleton's joint_count][12] (noh_local_to_model), matrices[skin's joint_count][12] */
void noh_skin_matrices(const noh_skin *skin, const float *model, float *matrices);

/* One vertex as drawn, in model space. layers NULL: no morphs. */
void noh_skin_vertex(const noh_mesh *mesh, const float *matrices, const noh_morph_layers *layers, uint32_t index, noh_vertex *out);

/* Its position alone, in the same bits. */
void noh_skin_position(const noh_mesh *mesh, const float *matrices, const noh_morph_layers *layers, uint32_t index, float out[3]);

/* Vertices first..first+count-1 of a skinned mesh, in model space.
 * shapes  matrices[skin's joint_count][12]; positions[count][3], normals[count][3] unit, tangents[count][4] unit
 *         and handedness, zeros where the mesh has none; each may be NULL: not wanted. layers NULL: no morphs */
void noh_skin_vertices(const noh_mesh *mesh, const float *matrices, const noh_morph_layers *layers, uint32_t first,
                       uint32_t count, float *positions, float *normals, float *tangents);

/* "scalar", "sse2", "avx2" or "neon": what noh_skin_vertices was compiled to. */
const char *noh_skin_simd(void);

#endif
