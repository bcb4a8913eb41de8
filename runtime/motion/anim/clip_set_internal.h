/* clip_set_internal.h (private to anim/, graph/ and character/): the counts of a set that determine the sizes of other
 * objects; reference poses of additive clips. */
#ifndef NOH_ANIM_CLIP_SET_INTERNAL_H
#define NOH_ANIM_CLIP_SET_INTERNAL_H

#include "noh/clip.h"

/* Get a mask of a set as blending takes it: index 0 is no mask, n is the set's mask n - 1. */
noh_mask_view noh_clip_set_mask(const noh_clip_set *set, uint32_t index);

/* Get a message if joints or floats exceed a limit, else NULL: products of either with a struct's size then fit in 32
 * bits. */
const char *noh_clip_set_excess(const noh_clip_set *set);

/* Get the reference pose of additive clips (controller_pose.c).
 * reference  0: the bind pose and the floats' defaults; else 1 + index of the clip whose first frame it is; joints and
 *            floats that the clip does not animate are as for 0
 * shapes     pose[joint_count], floats[the set's float_count] */
void noh_reference_pose(const noh_clip_set *set, uint32_t reference, uint32_t joint_count, noh_transform *pose,
                        float *floats);

#endif
