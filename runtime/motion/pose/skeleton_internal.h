/* skeleton_internal.h: the order of a skeleton's joints. Threads: no state; any thread. */
#ifndef NOH_POSE_SKELETON_INTERNAL_H
#define NOH_POSE_SKELETON_INTERNAL_H

#include "core/base/compiler_internal.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

/* Whether `joint` is `above` or one of its descendants; NOH_JOINT_ROOT is below itself alone. */
NOH_UNUSED static inline int noh_joint_is_below(const noh_skeleton *k, uint32_t joint, uint32_t above)
{
    while (joint != above && joint != NOH_JOINT_ROOT) joint = k->parents[joint];
    return joint == above;
}

#endif
