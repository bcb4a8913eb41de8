/* skin.h: skinned meshes on the CPU, after morph targets: the reference for the GPU, the fallback without one, and the
 * surface used for picking.
 *
 * For each vertex, with its joints' matrices M_i and weights w_i, which sum to 1:
 *   M = w_0 M_0 + w_1 M_1 + ... in this order, one product and one sum per element
 *   position = M (p, 1)
 *   normal   = unit(s C n), C the cofactors of M's 3 x 3 part, s the sign of its determinant
 *   tangent  = unit(M t), its handedness times s
 * s C is the inverse transpose times the absolute determinant: normals stay orthogonal to the surface under any scale,
 * and unlike the inverse, the cofactors exist where an axis has no length.
 *
 * Meshes with NOH_MESH_DUAL_QUATERNION use dual_quaternion.h instead. The SIMD path is chosen when the library is
 * compiled; each gives the bits of noh_skin_vertex.
 *
 * source  Granberg, Character Animation with Direct3D, 2009, chapters 3 and 8 (whose shader moves normals by M itself);
 *         the implied last weight: Microsoft, Geometry Blending, DirectX 9.0 documentation
 *
 * Threads: no state; any thread. */
#ifndef NOH_DEFORM_SKIN_H
#define NOH_DEFORM_SKIN_H

#include "deform/morph/morph.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Compute the matrices for vertices of a skin's meshes: model[joint] * inverse bind, once per instance and frame.
 * shapes  model[the skeleton's joint_count][12] (noh_local_to_model), matrices[skin's joint_count][12] */
void noh_skin_matrices(const noh_skin *skin, const float *model, float *matrices);

/* Compute a vertex as drawn, in model space. layers NULL: no morph targets.
 * ranges  index below vertex_count, of a skinned mesh */
void noh_skin_vertex(const noh_mesh *mesh, const float *matrices, const noh_morph_layers *layers, uint32_t index,
                     noh_vertex *out);

/* Compute only the position of a vertex, with the same bits. */
void noh_skin_position(const noh_mesh *mesh, const float *matrices, const noh_morph_layers *layers, uint32_t index,
                       float out[3]);

/* Skin vertices first..first+count-1 of a skinned mesh, in model space.
 * shapes  matrices[skin's joint_count][12]; positions[count][3], normals[count][3] unit, tangents[count][4] unit and
 *         handedness, zeros if the mesh has none; each may be NULL: not wanted. layers NULL: no morph targets
 * ranges  first + count at most vertex_count */
void noh_skin_vertices(const noh_mesh *mesh, const float *matrices, const noh_morph_layers *layers, uint32_t first,
                       uint32_t count, float *positions, float *normals, float *tangents);

/* Get the instruction set that noh_skin_vertices was compiled for: "scalar", "sse2", "avx2" or "neon". */
const char *noh_skin_simd(void);

#ifdef __cplusplus
}
#endif

#endif
