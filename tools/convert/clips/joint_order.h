/* joint_order.h: an order of joints in which each LOD level is a prefix.
 *
 * Joints without a parent come first, then the others by falling extent: the longest chain of bind translations from a
 * joint to one below it. A joint with none below it has the length of the translation that leads to it, but at most an
 * eighth of the longest chain, so that a foot's tip does not rank with a thumb, nor an IK handle with a limb. A
 * parent's extent is at least its child's, so every prefix is a skeleton of its own. Extents that differ by less than
 * 1/2000 of the largest form one class, whose joints stay in the source's order: left and right must not change places
 * because a file was rounded. The order depends on parents and bind translations alone, so packs that are built apart
 * agree. */
#ifndef NOH_CONVERT_CLIPS_JOINT_ORDER_H
#define NOH_CONVERT_CLIPS_JOINT_ORDER_H

#include "convert/clips/raw_clip.h"

/* Put the joints of all sets into that order: in skeletons, in tracks and in the model's skins. To be called once all
 * files are joined: until then joints are numbered as in their files. 0, or 1 when out of memory. */
int joint_order_sets(raw_set **sets, uint32_t set_count, model *m);

/* LOD levels of a skeleton: all joints, then about 60, 35, 20 and 10 % of them, each cut where the extent falls most
 * near that share; never between joints of one class, and never without all joints that have no parent. Where no such
 * cut exists the level is left out, so a skeleton in another order has fewer.
 * shapes   counts[NOH_LOD_LEVELS_MAX]
 * returns  how many levels; 0 when out of memory */
uint32_t joint_levels(const raw_skeleton *skeleton, uint32_t *counts);

#endif
