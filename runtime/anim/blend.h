/* blend.h: poses by weight (row C5.4), layers over them, differences added to them.
 *
 *   noh_blend_begin .. noh_blend_add .. noh_blend_finish   pose = sum of w * pose / sum of w
 *   noh_blend_cover      lay a sum over a pose
 *   noh_pose_mix         two poses, masked
 *   noh_pose_difference, noh_pose_add   additive layers
 *
 * Every joint and every float has its own sum of weights, so that a mask on one
 * track leaves the others their full say there. Where nothing weighs anything the
 * bind pose (a float's default) stands. A quaternion is negated where it points away
 * from the sum so far: with two tracks that is the first track's hemisphere; with
 * more, unlike alignment to the first alone, the sum can never vanish, and it does
 * not hang on a first track that has faded to nothing. */
#ifndef NOH_ANIM_BLEND_H
#define NOH_ANIM_BLEND_H

#include <stdint.h>

#include "anim/pose.h"
#include "base/assert.h"

/* Sums in the making. Borrowed arrays; joint_count may be fewer than they hold. */
typedef struct noh_blend {
    uint32_t joint_count, float_count;
    noh_transform *sum;    /* [joint_count] */
    float *weights;        /* [joint_count] */
    float *float_sum;      /* [float_count] */
    float *float_weights;  /* [float_count] */
    float *totals;         /* [joint_count] of a sum begun by noh_blend_begin_over; else not touched */
    float *float_totals;   /* [float_count] likewise */
    int covers;            /* 1: begun by noh_blend_begin_over */
} noh_blend;

/* A mask, 255 = full weight; NULL arrays mean full weight everywhere (row C16.7). */
typedef struct noh_mask_view {
    const uint8_t *joints; /* [joint_count] */
    const uint8_t *floats; /* [float_count] */
} noh_mask_view;

void noh_blend_begin(noh_blend *blend);

/* Begin a sum that noh_blend_cover will lay over the pose of the sum that `blend` holds. */
void noh_blend_begin_over(noh_blend *blend);

/* Add one pose. What a clip does not animate, or a mask leaves out, takes no part at all: it neither moves a joint nor
 * dilutes what others do there.
 * shapes  pose[joint_count], floats[float_count]; NULL: not animated
 * ranges  weight > 0 */
void noh_blend_add(noh_blend *blend, const noh_transform *pose, const float *floats, float weight, noh_mask_view mask);

/* Divide by the weights. defaults may be NULL: zero. */
void noh_blend_finish(const noh_blend *blend, const noh_transform *bind_pose, const float *defaults, noh_transform *pose, float *floats);

/* Lay a sum begun by noh_blend_begin_over over the pose below, in place. Each joint is covered by `amount` times the
 * mean mask of the poses that take part there (sum of w * mask / sum of w), wholly where the pose below has no weight.
 * shapes  pose[joint_count], floats[float_count] */
void noh_blend_cover(const noh_blend *blend, float amount, noh_transform *pose, float *floats);

/* out = a at 0, b at 1; out may be either. The mask scales t. */
void noh_pose_mix(uint32_t joint_count, const noh_transform *a, const noh_transform *b, float t, const uint8_t *mask, noh_transform *out);
void noh_floats_mix(uint32_t count, const float *a, const float *b, float t, const uint8_t *mask, float *out);

/* What takes the reference to the pose: rotation = inverse(reference) * pose, the
 * difference of translations, the ratio of scales (1 where the reference's is 0).
 * out may be pose. */
void noh_pose_difference(uint32_t joint_count, const noh_transform *reference, const noh_transform *pose, noh_transform *out);

/* Add weight times a difference, in place: pose * rotation, + translation, * scale. */
void noh_pose_add(uint32_t joint_count, const noh_transform *difference, float weight, const uint8_t *mask, noh_transform *pose);
void noh_floats_add(uint32_t count, const float *difference, float weight, const uint8_t *mask, float *floats);

#endif
