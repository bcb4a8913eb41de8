/* deform.h: where the figures are, for the page's camera. */
#ifndef NOH_PLATFORM_WEB_BOUNDS_H
#define NOH_PLATFORM_WEB_BOUNDS_H

#include "noh/noh.h"
#include "noh/pack.h"

/* The box in the world of the stage's first actors as they were posed in the last frame, without morphs: min, then max.
 * Of the coarsest LOD level, as the tool frames its pictures.
 * shapes  matrices[joints of the pack's largest skin][12] */
void web_bounds(const noh_stage *stage, const noh_pack *pack, uint32_t actor_count, float *matrices, float box[6]);

#endif
