/* morph.h: morph targets accumulated on the CPU.
 *
 * The reference for every GPU path, the fallback where there is none, and the
 * surface that picking uses. What is accumulated is deltas only, in three
 * layers (position, normal, tangent), one texel per touched vertex (rows A4-A7,
 * C8.3): layer += weight * (target - base), targets in index order, one product
 * and one sum per value, never fused. The SIMD path is chosen when the library
 * is compiled (AVX2, SSE2, NEON, else scalar); all give the scalar bits. */
#ifndef NOH_DEFORM_MORPH_H
#define NOH_DEFORM_MORPH_H

#include "base/half.h"
#include "mesh/mesh.h"

/* Accumulated deltas of one instance. The three layers lie one behind another,
 * each [morph_height << morph_width_log2][3] floats. */
typedef struct noh_morph_layers {
    float *position, *normal, *tangent;
} noh_morph_layers;

/* Exact bytes of the layers of a mesh; 0 for a mesh that no target touches. */
size_t noh_morph_layers_size(const noh_mesh *mesh);

/* Place the layers in memory[bytes], 4-byte aligned, and clear them.
 * errors  MEMORY with the bytes needed */
noh_result noh_morph_layers_init(void *memory, size_t bytes, const noh_mesh *mesh, noh_morph_layers *layers, noh_error *error);

/* Accumulate all targets whose weight is not zero into cleared layers.
 * shapes  weights[target_count], any finite value */
void noh_morph_accumulate(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers);

/* The same in plain C: what the others are held equal to. */
void noh_morph_accumulate_scalar(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers);

/* What a GPU leaves in a half-float accumulator that it blends into: after each
 * target the sum is rounded to half in the given mode. */
void noh_morph_accumulate_f16(const noh_mesh *mesh, const float *weights, noh_half_mode mode, const noh_morph_layers *layers);

/* Round finished layers to half once: the gather path's half-float result. */
void noh_morph_round_f16(const noh_mesh *mesh, noh_half_mode mode, const noh_morph_layers *layers);

/* "scalar", "sse2", "avx2" or "neon": what noh_morph_accumulate was compiled to. */
const char *noh_morph_simd(void);

/* The vertex as drawn: base + deltas, normal and tangent made unit again, the
 * tangent orthogonal to the normal, its handedness untouched (row A11). */
void noh_morph_vertex(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t index, noh_vertex *out);

/* Its position alone: base + delta. layers NULL: the base. */
void noh_morph_position(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t index, float out[3]);

/* One column of the work: (vertex, target) pairs that these weights touch, and the
 * texels and rectangles that hold them. For cost models and reports. */
typedef struct noh_morph_cost {
    uint32_t targets, rects, texels, pairs;
} noh_morph_cost;
noh_morph_cost noh_morph_cost_of(const noh_mesh *mesh, const float *weights);

#endif
