/* clip_set_internal.h (private to anim/, graph/ and character/): the counts of a set that the sizes of other objects
 * follow from; reference poses of additive clips. */
#ifndef NOH_ANIM_CLIP_SET_INTERNAL_H
#define NOH_ANIM_CLIP_SET_INTERNAL_H

#include "motion/anim/clip_set.h"

/* What is over a limit, joints or floats; NULL: nothing, and products of either with a struct's size fit 32 bits. */
const char *noh_clip_set_excess(const noh_clip_set *set);

/* The pose that additive clips are differences from (controller_pose.c).
 * reference  0: the bind pose and the floats' defaults; else 1 + index of the clip whose first frame it is, which has
 *            these where it animates nothing
 * shapes     pose[joint_count], floats[the set's float_count] */
void noh_reference_pose(const noh_clip_set *set, uint32_t reference, uint32_t joint_count, noh_transform *pose,
                        float *floats);

#endif
