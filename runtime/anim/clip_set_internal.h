/* clip_set_internal.h (private to anim/, graph/ and character/): the counts of a set that the sizes of other objects
 * follow from. */
#ifndef NOH_ANIM_CLIP_SET_INTERNAL_H
#define NOH_ANIM_CLIP_SET_INTERNAL_H

#include "anim/clip_set.h"

/* What is over a limit, joints or floats; NULL: nothing, and products of either with a struct's size fit 32 bits. */
const char *noh_clip_set_excess(const noh_clip_set *set);

#endif
