/* The named morph targets: each is one pose. */
#ifndef MASK_TARGETS_H
#define MASK_TARGETS_H

#include "pose.h"

/* The mask has the first ones; the visemes and a corrective follow. */
enum { MASK_TARGETS = 57, ALL_TARGETS = MASK_TARGETS + 16 };

const char *target_name(int target);
Pose target_pose(int target);
int target_find(const char *name); /* -1 if there is none */

#endif
