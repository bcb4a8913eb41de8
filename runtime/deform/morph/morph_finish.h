/* morph_finish.h: final vertices in the formats of a pack's attributes, for a vertex buffer that replaces the mesh's
 * own, so that no shader adds anything.
 *
 *   noh_morph_finished_stride   bytes of a vertex
 *   noh_morph_finish            vertices from accumulated layers
 *   noh_morph_finish_scalar     the same in plain C: the reference
 *
 * A finished vertex has its position as three floats, with the bits of noh_morph_vertex; its normal as an octahedral
 * pair of 16-bit integers; and, if the mesh has tangents, its tangent as such a pair with the handedness in the lowest
 * bit, like the mesh's own attributes. Each pair is the nearest one to the direction: a decoded normal is within
 * NOH_FINISHED_NORMAL_ERROR of noh_morph_vertex's, a tangent within NOH_FINISHED_TANGENT_ERROR. Every processor gives
 * the scalar bits. Texture coordinates stay in the mesh's own buffer; for targets that change them
 * (NOH_MESH_UV_TARGETS) use noh_morph_uv.
 *
 * source  the octahedron: Meyer, Suessmuth, Sussner, Stamminger, Greiner: On floating-point normal vectors, 2010;
 *         errors of its pairs: Cigolle et al., A Survey of Efficient Representations for Independent Unit Vectors, 2014
 *
 * Threads: no state; any thread. */
#ifndef NOH_DEFORM_MORPH_FINISH_H
#define NOH_DEFORM_MORPH_FINISH_H

#include "deform/morph/morph.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Radians. Half a step of 1 / 32767 along both axes is up to 6.5e-5 where the octahedron is nearest to its centre; the
 * second number of a tangent has steps twice as large. */
#define NOH_FINISHED_NORMAL_ERROR 6.6e-5f
#define NOH_FINISHED_TANGENT_ERROR 1.1e-4f

/* Get the bytes of a finished vertex: 20 with tangents, else 16. */
uint32_t noh_morph_finished_stride(const noh_mesh *mesh);

/* Finish the vertices first to first + count - 1. Writes in order and never reads `out`, which may be mapped GPU
 * memory.
 * layers  accumulated; without a tangent layer the bind pose's tangents turn with the normal. NULL: the bind pose
 * shapes  out[count][noh_morph_finished_stride(mesh)], aligned to 4
 * ranges  first + count at most vertex_count */
void noh_morph_finish(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count, void *out);
void noh_morph_finish_scalar(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count,
                             void *out);

#ifdef __cplusplus
}
#endif

#endif
