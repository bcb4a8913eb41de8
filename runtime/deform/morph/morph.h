/* morph.h: morph targets accumulated on the CPU: the reference for every GPU path, the fallback where there is none,
 * and the surface that picking sees.
 *
 * Only differences are accumulated, in three layers (position, normal, tangent), one accumulation texel for each vertex
 * that any target moves. For each target, in index order, and each of its delta texels:
 *   layer += weight * delta
 * with one product and one sum per value, never fused. noh_morph_accumulate is what the library was compiled for (AVX2,
 * SSE2, NEON, else scalar); noh_morph_kernel_find asks the processor for more. Each gives the scalar bits.
 *
 * source  Microsoft, SparseMorphTargets (DirectX SDK): additive blending of sparse rectangles into three render
 * targets. There the accumulator begins as the mesh; here it begins at 0, so that half floats round the small
 *         differences and not the coordinates. The loop over targets outside, over moved vertices inside: Granberg,
 *         Character Animation with Direct3D, 2009, chapter 8 (whose listing indexes the weights by vertex)
 *
 * Threads: no state; any thread, each with layers of its own. */
#ifndef NOH_DEFORM_MORPH_H
#define NOH_DEFORM_MORPH_H

#include "core/base/arena.h"
#include "core/base/half.h"
#include "core/mesh/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Accumulated differences of one instance, model units. The layers are adjacent in memory, each
 * [morph_height << morph_width_log2][3]. */
typedef struct noh_morph_layers {
    float *position, *normal;
    float *tangent; /* NULL: two layers, tangents are not morphed. The bind pose's are still turned with the normal */
} noh_morph_layers;

/* Exact bytes of three layers of a mesh; 0 for a mesh that no target moves. Two layers take two thirds of it. */
size_t noh_morph_layers_size(const noh_mesh *mesh);

/* Place three layers in memory[bytes], aligned to NOH_MEMORY_ALIGN, and clear them. A mesh without accumulation texels
 * needs none: memory may then be NULL.
 * errors  ARG memory is NULL or misaligned; MEMORY it is too small; need: the exact bytes */
noh_result noh_morph_layers_init(void *memory, size_t bytes, const noh_mesh *mesh, noh_morph_layers *layers,
                                 noh_error *error);

/* Accumulate all targets whose weight is not zero into cleared layers.
 * shapes  weights[target_count]
 * ranges  any finite value; below 0 and above 1 extrapolate */
void noh_morph_accumulate(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers);

/* The same in plain C: the reference of the SIMD paths. */
void noh_morph_accumulate_scalar(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers);

#define NOH_MORPH_GROUP 16u /* accumulation texels that follow each other, from a multiple of it on */

/* The inner loops, for one set of instructions. All give the same bits. */
typedef struct noh_morph_kernel {
    const char *name; /* "avx2", "sse2", "neon" or "scalar" */
    void (*accumulate)(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers);
    /* The same for groups of NOH_MORPH_GROUP texels that are not 0 in groups[]; what others hold is undefined after it,
     * but never read */
    void (*accumulate_some)(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers,
                            const uint8_t *groups);
    /* noh_morph_finish (morph_finish.h) */
    void (*finish)(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count, void *out);
} noh_morph_kernel;

/* The fastest kernel of this processor, or the one of a name, for tests and benches. AVX2 is asked of the processor,
 * even where the library was compiled without it: ask once and keep the answer, since that takes microseconds on a
 * virtual machine.
 * name    NULL: the fastest
 * errors  UNSUPPORTED this processor, or this build, has none of that name; *kernel is untouched. Never for NULL */
noh_result noh_morph_kernel_find(const char *name, noh_morph_kernel *kernel, noh_error *error);

/* The contents of a half-float accumulator that a GPU blends into: the sum is rounded to half after each target. */
void noh_morph_accumulate_f16(const noh_mesh *mesh, const float *weights, noh_half_mode mode,
                              const noh_morph_layers *layers);

/* Round finished layers to half once: the gather path's half-float result. */
void noh_morph_round_f16(const noh_mesh *mesh, noh_half_mode mode, const noh_morph_layers *layers);

/* "scalar", "sse2", "avx2" or "neon": what noh_morph_accumulate was compiled to. */
const char *noh_morph_simd(void);

/* The vertex as drawn: position, normal, tangent and texture coordinates of the bind pose plus their differences. The
 * normal is made unit, the tangent orthogonal to it and unit; its handedness stays. A direction that vanishes becomes
 * the bind pose's.
 * ranges  index below vertex_count */
void noh_morph_vertex(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t index, noh_vertex *out);

/* Add to uv[2], those of the bind pose, what the targets change of a vertex's texture coordinates: noh_morph_vertex has
 * done so. Nothing in a mesh without NOH_MESH_UV_TARGETS.
 * ranges  index below vertex_count */
void noh_morph_uv(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t index, float uv[2]);

/* Only its position, in the same bits. layers NULL: that of the bind pose. */
void noh_morph_position(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t index, float out[3]);

/* The same without layers: each target that moves the vertex is looked up by its rectangles. For a few vertices, where
 * there is no memory for layers.
 * shapes  weights[target_count] */
void noh_morph_position_by(const noh_mesh *mesh, const float *weights, uint32_t index, float out[3]);

/* The work that these weights cause: targets whose weight is not 0, their rectangles, delta texels and pairs. For cost
 * models and reports. */
typedef struct noh_morph_cost {
    uint32_t targets, rects, texels, pairs;
} noh_morph_cost;
noh_morph_cost noh_morph_cost_of(const noh_mesh *mesh, const float *weights);

#ifdef __cplusplus
}
#endif

#endif
