/* corrective.h: correctives and in-betweens: targets whose weights follow from those of others.
 *
 *   noh_correctives_bind  those of a mesh, as its pack tells them
 *   noh_correct           their weights
 *
 * An open mouth that smiles is not an open mouth and a smile added up: a corrective is the target that is added while
 * both show. Its weight is the product of one factor for each target that drives it. The factor is 0 at a driver's
 * weight of 0 and 1 at the weight at which the corrective was modelled, its peak. Up to a peak of 1 the factor is the
 * driver's weight. A peak below 1 makes an in-between: the factor falls to 0 again at the next peak of correctives
 * with the same drivers, or at 1, and rises from the peak before. So a corrective has weight 1 where all drivers are at
 * their peaks, 0 where one of them is at 0 or at another peak, and nowhere a jump.
 *
 * Deltas of correctives are what is missing beside all others, as modelling tools export them. Which targets drive
 * which is told by a recipe (`corrective TARGET DRIVER [PEAK] ...`, `noh build --recipe`, or glTF extras), or by names:
 * of targets jawOpen, smile and jawOpen_smile the last is a corrective of the others, and jawOpen50 is an in-between.
 * A stage applies them to what clips, faces and held floats say.
 *
 * source   Lewis and others, "Practice and Theory of Blendshape Facial Models", Eurographics 2014, section 4.2 and 4.3
 * Threads  no state; any thread */
#ifndef NOH_FACE_CORRECTIVE_H
#define NOH_FACE_CORRECTIVE_H

#include "core/mesh/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One driver of one corrective. Those of a corrective stand together. */
typedef struct noh_corrective_term {
    uint16_t target, driver;
    float from, peak, to; /* weights of the driver: 0 up to `from`, 1 at the peak, 0 from `to` on; to = peak: stays 1 */
} noh_corrective_term;

/* The terms of a mesh's correctives. One that the mesh has not all targets for is left out.
 * shapes   terms[term_max]
 * returns  how many there are; those past term_max are not written */
uint32_t noh_correctives_bind(const noh_mesh *mesh, noh_corrective_term *terms, uint32_t term_max);

/* Set the weights of correctives by those of their drivers, which count as 0..1.
 * shapes  weights[as many as the terms refer to] */
void noh_correct(const noh_corrective_term *terms, uint32_t term_count, float *weights);

#ifdef __cplusplus
}
#endif

#endif
