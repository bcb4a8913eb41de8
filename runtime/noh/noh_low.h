/* noh_low.h: the parts from which noh.h is built, for engines that do not use a stage.
 * It may change between minor versions; the other headers change less often.
 *
 *   low_core.h    memory, small mathematics, texels
 *   low_motion.h  clip caches, poses, blend spaces
 *   low_life.h    ragdolls, springs, hair, feet, rays
 *   low_stage.h   levels of detail, palettes, rules of a flock
 *   low_gl.h      meshes, morph targets, palettes and a plain renderer on the GPU */
#ifndef NOH_LOW_H
#define NOH_LOW_H

#include "low_core.h"
#include "low_motion.h"
#include "low_life.h"
#include "low_stage.h"
#include "low_gl.h"

#endif
