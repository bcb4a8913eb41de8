/* transfer.h: precomputed light of a mesh that deforms: how each vertex answers to light from all around, in 4 to 8
 * bytes, and shading by it on the CPU: the reference of the GPU.
 *
 *   noh_transfer_of           the transfer of a mesh
 *   noh_transfer_accumulate   what a face's targets change of its occlusion
 *   noh_transfer_lobe         one vertex, decoded
 *   noh_lobe_turn             the lobe as the surface has turned
 *   noh_lobe_shade            the light that it receives
 *   noh_transfer_shade        all of it for one vertex
 *
 * What reaches a vertex is a function of direction: the cosine to the normal where the sky is seen, 0 where the mesh
 * itself is in the way. It is stored as a lobe, round about an axis: its integral (occlusion) and for each band the
 * mean of a Legendre polynomial. A lobe turns with the surface, since only its axis does; and light turns freely, since
 * it is a factor. Axes are bent towards what is open: about the normal (NOH_TRANSFER_ON_NORMAL) the same bytes are
 * worth little more than their occlusion. Targets that open a mouth or draw down a brow change occlusion in place: one
 * stored difference for each vertex and target that moves it, summed by weight like positions.
 *
 * Holds for surfaces that turn and for what targets occlude; an arm that comes before the face casts no shadow here.
 *
 * source   Sloan, Luna, Snyder: Local, deformable precomputed radiance transfer, SIGGRAPH 2005 (zonal harmonics about
 *          an axis of their own); Microsoft, SparseMorphTargets sample (about the normal); Landis: Production-ready
 *          global illumination, SIGGRAPH course 16, 2002 (the bent normal)
 * Threads: no state; any thread. */
#ifndef NOH_LIGHT_TRANSFER_H
#define NOH_LIGHT_TRANSFER_H

#include "gl/light/environment.h"
#include "core/mesh/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The transfer of a mesh, at every LOD level. A view: valid as long as the pack and its bytes are. Shapes are in
 * format.h. */
typedef struct noh_transfer {
    const noh_transfer_header *header;
    const uint8_t *records;
    const float *scales;
    const int8_t *deltas;
} noh_transfer;

/* A vertex's answer to light. */
typedef struct noh_lobe {
    float occlusion;               /* 0..1 */
    float axis[3];                 /* unit, model space */
    float shape[NOH_SH_ORDER_MAX]; /* by band; the first is 1 */
} noh_lobe;

/* errors  NOT_FOUND  the pack has no transfer for this mesh: it was built without --transfer; *transfer is untouched */
noh_result noh_transfer_of(const noh_mesh *mesh, noh_transfer *transfer, noh_error *error);

/* Add weight * difference of occlusion for all targets whose weight is not zero, in the order of noh_morph_accumulate:
 * the reference of the fourth component that accumulators have beside positions (gl_morph.h). Clear the layer first.
 * shapes  weights[target_count], occlusion[morph_height << morph_width_log2] of the mesh's level
 * ranges  weights are finite; the mesh has a transfer */
void noh_transfer_accumulate(const noh_mesh *mesh, const float *weights, float *occlusion);

/* The lobe of a vertex in the bind pose.
 * ranges  vertex below vertex_count of the mesh */
void noh_transfer_lobe(const noh_mesh *mesh, const noh_transfer *transfer, uint32_t vertex, noh_lobe *lobe);

/* Turn the axis by the smallest rotation that takes `from` to `to`; opposite directions turn nothing.
 * ranges  both unit */
void noh_lobe_turn(noh_lobe *lobe, const float from[3], const float to[3]);

/* The light that a white matte surface of this lobe reflects: the sum over bands of shape and of the light in the axis.
 * The light's order need not be the transfer's: the lower one counts. May be below 0 behind a sharp lamp, by a few per
 * cent of it.
 * ranges  order 1..NOH_SH_ORDER_MAX, of the transfer */
void noh_lobe_shade(const noh_lobe *lobe, uint32_t order, const noh_light *light, float rgb[3]);

/* A vertex as it is drawn: `normal` is its unit normal now, in the space that the light is in; `occlusion` the layer of
 * noh_transfer_accumulate, or NULL in the bind pose. */
void noh_transfer_shade(const noh_mesh *mesh, const noh_transfer *transfer, uint32_t vertex, const float normal[3],
                        const float *occlusion, const noh_light *light, float rgb[3]);

#ifdef __cplusplus
}
#endif

#endif
