/* The named morph targets: each is one pose. */
#ifndef MASK_TARGETS_H
#define MASK_TARGETS_H

#include "pose.h"

int target_count(void);
const char *target_name(int target);
Pose target_pose(int target);
int target_find(const char *name); /* -1 if there is none */

#endif
