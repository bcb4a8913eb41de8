/* corrective.h: correctives and in-betweens: targets whose weights follow from other targets.
 *
 *   noh_correctives_bind   get the correctives of a mesh from its pack
 *   noh_correctives_apply  compute their weights
 *
 * An open mouth that smiles is more than an open mouth plus a smile: a corrective is a target that is added while both
 * show. Its weight is the product of one factor per driver (a target that drives it). The factor is 0 at a driver
 * weight of 0 and 1 at the driver weight at which the corrective was modelled, its peak. With a peak of 1 the factor is
 * the driver's weight. A peak below 1 makes an in-between: the factor falls to 0 again at the next peak of correctives
 * with the same drivers, or at 1, and rises from the previous peak. So a corrective has weight 1 where all drivers are
 * at their peaks, 0 where any driver is at 0 or at another peak, and is continuous.
 *
 * Deltas of correctives are what is missing from the sum of all other targets, as modelling tools export them. Drivers
 * come from a recipe (`corrective TARGET DRIVER [PEAK] ...`, `noh build --recipe`, or glTF extras), or from names: with
 * targets jawOpen, smile and jawOpen_smile, the last is a corrective of the others, and jawOpen50 is an in-between. A
 * stage applies correctives after clips, faces and held floats.
 *
 * source   Lewis and others, "Practice and Theory of Blendshape Facial Models", Eurographics 2014, section 4.2 and 4.3
 * Threads  no state; any thread */
#ifndef NOH_FACE_CORRECTIVE_H
#define NOH_FACE_CORRECTIVE_H

#include "core/mesh/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One driver of one corrective. The terms of a corrective are consecutive. */
typedef struct noh_corrective_term {
    uint16_t target, driver;
    float from, peak, to; /* driver weights: 0 up to `from`, 1 at the peak, 0 from `to` on; to = peak: stays 1 */
} noh_corrective_term;

/* Get the terms of a mesh's correctives. Skips correctives for which the mesh lacks a target.
 * shapes   terms[term_max]
 * returns  the number of terms; terms past term_max are not written */
uint32_t noh_correctives_bind(const noh_mesh *mesh, noh_corrective_term *terms, uint32_t term_max);

/* Set the weights of correctives from the weights of their drivers, which are clamped to 0..1.
 * shapes  weights[as many as the terms refer to] */
void noh_correctives_apply(const noh_corrective_term *terms, uint32_t term_count, float *weights);

#ifdef __cplusplus
}
#endif

#endif
