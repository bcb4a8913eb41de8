/* morph.h: morph targets accumulated on the CPU: the reference for every GPU path, the fallback without one, and the
 * surface used for picking.
 *
 * Only differences are accumulated, in three layers (position, normal, tangent), one accumulation texel for each vertex
 * that any target moves. For each target, in index order, and each of its delta texels:
 *   layer += weight * delta
 * with one product and one sum per value, never fused. noh_morph_accumulate uses the instructions that the library was
 * compiled for (AVX2, SSE2, NEON, else scalar); noh_morph_kernel_find queries the processor for more. All give the
 * scalar bits.
 *
 * source  Microsoft, SparseMorphTargets (DirectX SDK): additive blending of sparse rectangles into three render
 *         targets. There the accumulator starts as the mesh; here it starts at 0, so that half floats round the small
 *         differences and not the coordinates. The outer loop over targets, the inner one over moved vertices:
 *         Granberg, Character Animation with Direct3D, 2009, chapter 8 (whose listing indexes the weights by vertex)
 *
 * Threads: no state; any thread, each with its own layers. */
#ifndef NOH_DEFORM_MORPH_H
#define NOH_DEFORM_MORPH_H

#include "core/base/arena.h"
#include "core/base/half.h"
#include "core/mesh/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Accumulated differences of one instance, in model units. The layers are adjacent in memory, each [morph_height <<
 * morph_width_log2][3]. */
typedef struct noh_morph_layers {
    float *position, *normal;
    float *tangent; /* NULL: two layers; tangents are not morphed, but the bind pose's still turn with the normal */
} noh_morph_layers;

/* Exact size of three layers of a mesh in bytes; 0 for a mesh that no target moves. Two layers take two thirds of
 * it. */
size_t noh_morph_layers_size(const noh_mesh *mesh);

/* Place three layers in memory[bytes], aligned to NOH_MEMORY_ALIGN, and clear them. For a mesh without accumulation
 * texels memory may be NULL.
 * errors  ARG memory NULL or misaligned; MEMORY too small (need: the bytes) */
noh_result noh_morph_layers_init(void *memory, size_t bytes, const noh_mesh *mesh, noh_morph_layers *layers,
                                 noh_error *error);

/* Accumulate all targets whose weight is not zero into cleared layers.
 * shapes  weights[target_count]
 * ranges  any finite value; below 0 and above 1 extrapolate */
void noh_morph_accumulate(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers);

/* Accumulate in plain C: the reference for the SIMD paths. */
void noh_morph_accumulate_scalar(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers);

#define NOH_MORPH_GROUP 16u /* size of an aligned group of consecutive accumulation texels */

/* The inner loops for one instruction set. All give the same bits. */
typedef struct noh_morph_kernel {
    const char *name; /* "avx2", "sse2", "neon" or "scalar" */
    void (*accumulate)(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers);
    /* Accumulate only groups of NOH_MORPH_GROUP texels with groups[] not 0; texels of other groups become undefined,
     * but are never read */
    void (*accumulate_some)(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers,
                            const uint8_t *groups);
    /* noh_morph_finish (morph_finish.h) */
    void (*finish)(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count, void *out);
} noh_morph_kernel;

/* Find the fastest kernel of this processor, or a kernel by name, for tests and benches. Queries the processor for AVX2
 * even if the library was compiled without it. Call once and keep the result: on a virtual machine the query takes
 * microseconds.
 * name    NULL: the fastest
 * errors  UNSUPPORTED this processor, or this build, has no kernel of that name; *kernel is unchanged. Never for
 *         NULL */
noh_result noh_morph_kernel_find(const char *name, noh_morph_kernel *kernel, noh_error *error);

/* Compute what a half-float accumulator on a GPU contains after blending: the sum is rounded to half after each
 * target. */
void noh_morph_accumulate_f16(const noh_mesh *mesh, const float *weights, noh_half_mode mode,
                              const noh_morph_layers *layers);

/* Round finished layers to half once: the result of the gather path with half floats. */
void noh_morph_round_f16(const noh_mesh *mesh, noh_half_mode mode, const noh_morph_layers *layers);

/* Get the instruction set that noh_morph_accumulate was compiled for: "scalar", "sse2", "avx2" or "neon". */
const char *noh_morph_simd(void);

/* Compute a vertex as drawn: position, normal, tangent and texture coordinates of the bind pose plus their differences.
 * The normal is normalised; the tangent is made orthogonal to it and normalised, and keeps its handedness. A direction
 * that vanishes becomes the bind pose's.
 * ranges  index below vertex_count */
void noh_morph_vertex(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t index, noh_vertex *out);

/* Add the targets' change of a vertex's texture coordinates to uv[2], the coordinates of the bind pose.
 * noh_morph_vertex includes this. Does nothing for a mesh without NOH_MESH_UV_TARGETS.
 * ranges  index below vertex_count */
void noh_morph_uv(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t index, float uv[2]);

/* Compute only the position of a vertex, with the same bits. layers NULL: the bind pose. */
void noh_morph_position(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t index, float out[3]);

/* Compute a position without layers: searches the rectangles of every target for the vertex. For a few vertices, when
 * there is no memory for layers.
 * shapes  weights[target_count] */
void noh_morph_position_by(const noh_mesh *mesh, const float *weights, uint32_t index, float out[3]);

/* The work that a set of weights causes: targets with a weight other than 0, and their rectangles, delta texels and
 * pairs. For cost models and reports. */
typedef struct noh_morph_cost {
    uint32_t targets, rects, texels, pairs;
} noh_morph_cost;
noh_morph_cost noh_morph_cost_of(const noh_mesh *mesh, const float *weights);

#ifdef __cplusplus
}
#endif

#endif
