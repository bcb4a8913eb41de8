/* bounds.h: the bounds of the figures, for the page's camera. */
#ifndef NOH_PLATFORM_WEB_BOUNDS_H
#define NOH_PLATFORM_WEB_BOUNDS_H

#include "noh/noh.h"
#include "noh/pack.h"

/* The world box of the stage's first actors as posed in the last frame, without morphs: min, then max. It contains the
 * coarsest LOD level, as for pictures of the tool.
 * shapes  matrices[joints of the pack's largest skin][12]
 * face  1: only of what targets move; low is above high where nothing is */
void web_bounds(const noh_stage *stage, const noh_pack *pack, uint32_t actor_count, float *matrices, int face,
                float box[6]);

#endif
