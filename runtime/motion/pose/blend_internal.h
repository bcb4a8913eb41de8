/* blend_internal.h: weighted sums of poses. */
#ifndef NOH_POSE_BLEND_INTERNAL_H
#define NOH_POSE_BLEND_INTERNAL_H

#include "noh/low_motion.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== blending ========
 * Weighted blends of poses, layers over them, and additive differences.
 *
 *   noh_blend_begin, noh_blend_add (for each pose), noh_blend_finish       pose = sum of w * pose / sum of w
 *   noh_blend_begin_over, noh_blend_add (for each pose), noh_blend_cover   lay a sum over the pose below
 *   noh_pose_mix, noh_floats_mix          two poses, masked
 *   noh_pose_difference, noh_pose_add, noh_floats_add   additive layers
 *
 * Every joint and every float has its own sum of weights. So a mask on one track, or a clip that does not animate a
 * joint, leaves the other tracks at full weight there. Where the sum is 0 the result is the bind pose (for a float, its
 * default). A quaternion is negated if it points away from the sum so far. With two tracks this equals alignment to the
 * first one; with more, unlike that alignment, the sum can never vanish, and nothing depends on a first track that has
 * faded out.
 *
 * source  Granberg 2009, chapter 5, blends two clips with weights w and 1 - w; sums that are not divided by their
 *         weight, or that add q and -q, shrink or cancel
 *
 * Threads: pure functions of their arguments; any thread. */

void noh_blend_begin(noh_blend *blend);

/* Begin a sum that noh_blend_cover will lay over the pose of the sum in `blend`. */
void noh_blend_begin_over(noh_blend *blend);

/* Add one pose. Joints that a clip does not animate, or that a mask excludes, are skipped: the pose neither moves them
 * nor dilutes the other poses there.
 * shapes  pose[joint_count], floats[float_count]; NULL: not animated
 * ranges  weight > 0 */
void noh_blend_add(noh_blend *blend, const noh_transform *pose, const float *floats, float weight, noh_mask_view mask);

/* Divide the sums by their weights.
 * shapes  bind_pose[joint_count], defaults[float_count] (NULL: zeros), pose[joint_count], floats[float_count] */
void noh_blend_finish(const noh_blend *blend, const noh_transform *bind_pose, const float *defaults,
                      noh_transform *pose, float *floats);

/* Lay a sum begun by noh_blend_begin_over over the pose below, in place. Each joint is covered by `amount` times the
 * mean mask of the poses added there (sum of w * mask / sum of w), fully where the pose below has no weight. With
 * `full` 1 the sum of w counts as at least 1, and so does a pose below without weight, which is the bind pose.
 * shapes  pose[joint_count], floats[float_count] */
void noh_blend_cover(const noh_blend *blend, float amount, noh_transform *pose, float *floats);

void noh_floats_mix(uint32_t count, const float *a, const float *b, float t, const uint8_t *mask, float *out);

void noh_floats_add(uint32_t count, const float *difference, float weight, const uint8_t *mask, float *floats);

#ifdef __cplusplus
}
#endif

#endif
