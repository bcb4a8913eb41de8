/* morph_internal.h: the private part of deform.h. */
#ifndef NOH_DEFORM_MORPH_INTERNAL_H
#define NOH_DEFORM_MORPH_INTERNAL_H

#include "noh/base.h"
#include "noh/deform.h"
#include "noh/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Compute what a half-float accumulator on a GPU contains after blending: the sum is rounded to half after each
 * target. */
void noh_morph_accumulate_f16(const noh_mesh *mesh, const float *weights, noh_half_mode mode,
                              const noh_morph_layers *layers);

/* Accumulate in plain C: the reference for the SIMD paths. */
void noh_morph_accumulate_scalar(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers);

/* Find the fastest kernel of this processor, or a kernel by name, for tests and benches. Queries the processor for AVX2
 * even if the library was compiled without it. Call once and keep the result: on a virtual machine the query takes
 * microseconds.
 * name    NULL: the fastest
 * errors  UNSUPPORTED this processor, or this build, has no kernel of that name; *kernel is unchanged. Never for
 *         NULL */
noh_result noh_morph_kernel_find(const char *name, noh_morph_kernel *kernel, noh_error *error);

/* Round finished layers to half once: the result of the gather path with half floats. */
void noh_morph_round_f16(const noh_mesh *mesh, noh_half_mode mode, const noh_morph_layers *layers);

/* Get the instruction set that noh_morph_accumulate was compiled for: "scalar", "sse2", "avx2" or "neon". */
const char *noh_morph_simd(void);

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
