/* transfer.h: precomputed radiance transfer of a mesh that deforms: the light that each vertex receives from an
 * environment, in 4 to 8 bytes, and shading with it on the CPU, the reference for the GPU.
 *
 *   noh_transfer_of           the transfer of a mesh
 *   noh_transfer_accumulate   change of occlusion by targets
 *   noh_transfer_lobe         one vertex, decoded
 *   noh_lobe_turn             the lobe of a rotated surface
 *   noh_lobe_shade            the light that it receives
 *   noh_transfer_shade        the light on one vertex as drawn
 *
 * The light reaching a vertex is a function of direction: the cosine to the normal where the sky is visible, 0 where
 * the mesh itself blocks it. It is stored as a lobe, symmetric about an axis: its integral (occlusion) and for each
 * band the mean of a Legendre polynomial. To turn a lobe with the surface, only its axis is turned; light may turn
 * freely, because it is a factor. Axes are bent towards the open side: with axes along the normal
 * (NOH_TRANSFER_ON_NORMAL) the shape adds little to the occlusion. Targets that open a mouth or lower a brow change the
 * occlusion: one stored difference for each vertex and target that moves it, summed by weight like positions.
 *
 * This is valid for surfaces that turn and for occlusion by targets; an arm in front of the face casts no shadow.
 *
 * source   Sloan, Luna, Snyder: Local, deformable precomputed radiance transfer, SIGGRAPH 2005 (zonal harmonics about
 *          their own axes); Microsoft, SparseMorphTargets sample (about the normal); Landis: Production-ready global
 *          illumination, SIGGRAPH course 16, 2002 (the bent normal)
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

/* The transfer of a vertex. */
typedef struct noh_lobe {
    float occlusion;               /* 0..1 */
    float axis[3];                 /* unit, model space */
    float shape[NOH_SH_ORDER_MAX]; /* by band; the first is 1 */
} noh_lobe;

/* Get the transfer of a mesh.
 * errors  NOT_FOUND the pack has no transfer for this mesh: it was built without --transfer; *transfer is untouched */
noh_result noh_transfer_of(const noh_mesh *mesh, noh_transfer *transfer, noh_error *error);

/* Add weight * change of occlusion for all targets with nonzero weights, in the order of noh_morph_accumulate: the
 * reference for the fourth component of positions in accumulators (gl_morph.h). Clear the layer first.
 * shapes  weights[target_count], occlusion[morph_height << morph_width_log2] of the mesh's level
 * ranges  weights are finite; the mesh has a transfer */
void noh_transfer_accumulate(const noh_mesh *mesh, const float *weights, float *occlusion);

/* Decode the lobe of a vertex in the bind pose.
 * ranges  vertex below vertex_count of the mesh */
void noh_transfer_lobe(const noh_mesh *mesh, const noh_transfer *transfer, uint32_t vertex, noh_lobe *lobe);

/* Turn the lobe's axis by the smallest rotation from `from` to `to`; does nothing for opposite directions.
 * ranges  both unit */
void noh_lobe_turn(noh_lobe *lobe, const float from[3], const float to[3]);

/* The light reflected by a white matte surface with this lobe: the sum over bands of shape times the light along the
 * axis. If the orders of light and transfer differ, the lower one is used. May be below 0 opposite a sharp lamp, by a
 * few per cent of it.
 * ranges  order: of the transfer, 1..NOH_SH_ORDER_MAX */
void noh_lobe_shade(const noh_lobe *lobe, uint32_t order, const noh_light *light, float rgb[3]);

/* The light on a vertex as drawn.
 * normal     its deformed unit normal, in the space of the light
 * occlusion  the layer of noh_transfer_accumulate; NULL: the bind pose */
void noh_transfer_shade(const noh_mesh *mesh, const noh_transfer *transfer, uint32_t vertex, const float normal[3],
                        const float *occlusion, const noh_light *light, float rgb[3]);

#ifdef __cplusplus
}
#endif

#endif
