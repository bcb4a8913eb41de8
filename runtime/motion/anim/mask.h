/* mask.h: weights per joint and per float, one byte each (track masks: Granberg 2009, chapter 16).
 *
 * 255 = full weight, 0 = excluded. A mask of a set is uint8_t[joint_count + float_count]. Fill masks in your own memory
 * at load time.
 *
 * Threads: pure functions of their arguments; any thread. */
#ifndef NOH_ANIM_MASK_H
#define NOH_ANIM_MASK_H

#include "motion/pose/blend.h"
#include "motion/anim/clip_set.h"
#include "motion/pose/skeleton.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Set all entries. */
void noh_mask_fill(uint8_t *mask, uint32_t count, uint8_t value);

/* Set the entries of a joint and all its descendants.
 * ranges  joint below skeleton->joint_count */
void noh_mask_subtree(uint8_t *mask, const noh_skeleton *skeleton, uint32_t joint, uint8_t value);

/* Replace every entry v by 255 - v. */
void noh_mask_invert(uint8_t *mask, uint32_t count);

/* Get a mask of a set as blending takes it: index 0 is no mask, n is the set's mask n - 1. */
noh_mask_view noh_clip_set_mask(const noh_clip_set *set, uint32_t index);

#ifdef __cplusplus
}
#endif

#endif
