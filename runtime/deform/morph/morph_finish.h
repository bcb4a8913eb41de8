/* morph_finish.h: vertices as they are drawn, in the formats of a pack's attributes: for a vertex buffer that takes the
 * place of the mesh's own, so that no shader adds anything.
 *
 *   noh_morph_finished_stride   bytes of a vertex
 *   noh_morph_finish            vertices out of accumulated layers
 *   noh_morph_finish_scalar     the same in plain C: the reference
 *
 * A finished vertex is its position as three floats, in the bits of noh_morph_vertex; its normal as an octahedral pair
 * of 16-bit integers; and where the mesh has tangents its tangent as such a pair with the handedness in the lowest bit,
 * as the mesh's own attributes are. Each pair is the nearest one to the direction: a decoded normal is within
 * NOH_FINISHED_NORMAL_ERROR of noh_morph_vertex's, a tangent within NOH_FINISHED_TANGENT_ERROR. The scalar bits
 * everywhere, whatever instructions the processor has. Texture coordinates stay those of the mesh: what targets change
 * of them (NOH_MESH_UV_TARGETS) is noh_morph_uv's.
 *
 * source  the octahedron: Meyer, Suessmuth, Sussner, Stamminger, Greiner: On floating-point normal vectors, 2010; errors
 *         of its pairs: Cigolle et al., A Survey of Efficient Representations for Independent Unit Vectors, 2014
 *
 * Threads: no state; any thread. */
#ifndef NOH_DEFORM_MORPH_FINISH_H
#define NOH_DEFORM_MORPH_FINISH_H

#include "deform/morph/morph.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Radians. Half a step of 1 / 32767 along both axes is up to 6.5e-5 where the octahedron is nearest to the middle; the
 * second number of a tangent has steps twice as wide. */
#define NOH_FINISHED_NORMAL_ERROR 6.6e-5f
#define NOH_FINISHED_TANGENT_ERROR 1.1e-4f

/* Bytes of a finished vertex: 20 with tangents, else 16. */
uint32_t noh_morph_finished_stride(const noh_mesh *mesh);

/* Finish the vertices first to first + count - 1. They are written in order, and only written: `out` may be mapped
 * memory of a GPU.
 * layers  accumulated; without tangents those of the bind pose are turned with the normal. NULL: the bind pose
 * shapes  out[count][noh_morph_finished_stride(mesh)], aligned to 4
 * ranges  first + count at most vertex_count */
void noh_morph_finish(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count, void *out);
void noh_morph_finish_scalar(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count,
                             void *out);

#ifdef __cplusplus
}
#endif

#endif
