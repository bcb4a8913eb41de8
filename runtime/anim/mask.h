/* mask.h: weights per joint and per float, a byte each (row C16.7).
 *
 * 255 = full weight, 0 = not touched. A mask of a set is uint8_t[joint_count +
 * float_count]; these fill one in memory of the caller's, at load. */
#ifndef NOH_ANIM_MASK_H
#define NOH_ANIM_MASK_H

#include "anim/blend.h"
#include "anim/motion.h"
#include "anim/skeleton.h"

#ifdef __cplusplus
extern "C" {
#endif

/* All entries, joints and floats. */
void noh_mask_fill(uint8_t *mask, uint32_t count, uint8_t value);

/* A joint and everything below it. ranges  joint < skeleton->joint_count */
void noh_mask_subtree(uint8_t *mask, const noh_skeleton *skeleton, uint32_t joint, uint8_t value);

/* 255 - every entry. */
void noh_mask_invert(uint8_t *mask, uint32_t count);

/* A set's mask as blending takes it; index 0 is none, n is the set's mask n - 1. */
noh_mask_view noh_mask_of(const noh_anim_set *set, uint32_t index);

#ifdef __cplusplus
}
#endif

#endif
