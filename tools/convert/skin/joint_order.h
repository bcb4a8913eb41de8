/* joint_order.h: an order of joints in which each level of detail is a prefix (row C16.4).
 *
 * Joints without a parent come first, then the others by their extent, falling: the longest chain of bind
 * translations from a joint to one below it. A joint with none below it counts as long as the bone that leads to it, up to an
 * eighth of the longest chain, so that a foot's tip is not a thumb, nor a handle of IK a limb. Extents within 1/2000 of the largest of each other are one class, whose
 * joints stay in the source's order: left and right must not change places for what a file rounds. The order
 * depends on parents and bind translations alone, so that packs built apart agree. */
#ifndef NOH_CONVERT_JOINT_ORDER_H
#define NOH_CONVERT_JOINT_ORDER_H

#include "pack/format.h"
#include "convert/motion/raw_clip.h"

/* Put the joints of all sets into that order: skeletons, tracks, and what the model's skins name. After all files are
 * joined: until then joints count as their files have them. 0, or 1 when out of memory. */
int joint_order_sets(raw_set **sets, uint32_t set_count, model *m);

/* Levels of detail of a skeleton: all joints, then about 60, 35, 20 and 10 % of them, each cut where the extent falls
 * most near there; never between joints of one class, never without all that have no parent. Fewer where
 * there is no such place: a skeleton of another order has the levels that it allows.
 * shapes  counts[NOH_JOINT_LEVELS_MAX]
 * returns how many levels; 0 when out of memory */
uint32_t joint_levels(const raw_skeleton *skeleton, uint32_t *counts);

#endif
