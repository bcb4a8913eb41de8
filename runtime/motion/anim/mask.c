#include "core/base/assert_internal.h"
#include "motion/anim/clip_set_internal.h"
#include "motion/pose/skeleton_internal.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

#include <string.h>

void noh_mask_fill(uint8_t *mask, uint32_t count, uint8_t value)
{
    NOH_ASSERT(mask || !count);
    if (count) {
        memset(mask, value, count);
    }
}

void noh_mask_subtree(uint8_t *mask, const noh_skeleton *skeleton, uint32_t joint, uint8_t value)
{
    NOH_ASSERT(joint < skeleton->joint_count);
    for (uint32_t i = joint; i < skeleton->joint_count; i++) {
        if (noh_joint_is_below(skeleton, i, joint)) {
            mask[i] = value;
        }
    }
}

noh_mask_view noh_clip_set_mask(const noh_clip_set *set, uint32_t index)
{
    noh_mask_view view = { NULL, NULL };
    NOH_ASSERT(set && index <= set->mask_count);
    if (index) {
        size_t stride = (size_t)set->joint_count + set->float_count;
        view.joints = set->masks + (index - 1u) * stride;
        view.floats = view.joints + set->joint_count;
    }
    return view;
}
