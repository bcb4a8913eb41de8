/* haircut_internal.h: the private part of low_life.h. */
#ifndef NOH_SIM_HAIRCUT_INTERNAL_H
#define NOH_SIM_HAIRCUT_INTERNAL_H

#include "noh/body.h"
#include "noh/low_life.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Get the number of strips to draw at a number of pixels per metre: all from 500 up, proportionally fewer below, none
 * at 25 and below, where hair covers only a few pixels and is painted on the head. */
uint32_t noh_haircut_strips(const noh_haircut *cut, float pixels_per_metre);

/* Get the opacity of strips over hair painted on the head: 1 from 50 pixels per metre up, 0 at 25. */
float noh_haircut_fade(float pixels_per_metre);

/* A point of the middle line of a strip, and where the strip goes there: what the vertex shader computes (hair.vert),
 * within the precision of the GPU's sines.
 * shapes  points: of noh_hair_points
 * ranges  strip below noh_pack_hair_header.strip_count; along 0 the root to 1 the tip */
void noh_haircut_vertex(const noh_haircut *cut, const float *points, uint32_t strip, float along, float position[3],
                        float tangent[3]);

#ifdef __cplusplus
}
#endif

#endif
