/* check_skeleton.c: the checker of skeletons. */
#include "core/base/math_internal.h"
#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"

#include <stddef.h>

/* How large the bind pose gets along the chain that leads to a joint: a bound of the scales' product, and of how far
 * from the root a point of it lies. */
static int is_chain_bounded(const float *bind, const uint16_t *parents, uint32_t joint)
{
    float scale = 1.0f, reach = 0.0f;
    for (uint32_t j = joint;; j = parents[j]) {
        const float *t = bind + 10u * (size_t)j + 4;
        float largest = 0.0f;
        for (int k = 0; k < 3; k++) {
            const float s = t[3 + k] < 0.0f ? -t[3 + k] : t[3 + k];
            if (s > largest) largest = s;
        }
        scale *= largest > 1.0f ? largest : 1.0f;
        reach *= largest;
        for (int k = 0; k < 3; k++) reach += t[k] < 0.0f ? -t[k] : t[k];
        if (!(scale <= NOH_NUMBER_MAX && reach <= NOH_NUMBER_MAX)) return 0;
        if (parents[j] == NOH_PACK_JOINT_ROOT) return 1;
    }
}

static noh_result check_bind(const noh_check *check, const noh_skeleton_header *h)
{
    const uint16_t *parents = (const uint16_t *)(const void *)(check->bytes + h->parents_offset);
    const float *bind = (const float *)(const void *)(check->bytes + h->bind_offset);
    noh_result result = noh_check_floats(check, bind, h->joint_count * 10u, "bind pose is not finite");
    for (uint32_t j = 0; !result && j < h->joint_count; j++) {
        if (is_chain_bounded(bind, parents, j)) continue;
        result = noh_check_fail(check, "bind pose of a joint and its ancestors is larger than 10^12",
                                h->bind_offset + 40ull * j);
    }
    return result;
}

static noh_result check_joints(const noh_check *check, const noh_skeleton_header *h)
{
    const uint16_t *parents = (const uint16_t *)(const void *)(check->bytes + h->parents_offset);
    const float *bind = (const float *)(const void *)(check->bytes + h->bind_offset);
    const uint32_t *names = (const uint32_t *)(const void *)(check->bytes + h->names_offset);
    for (uint32_t j = 0; j < h->joint_count; j++) {
        const float *q = bind + 10u * (size_t)j;
        float square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        if (parents[j] != NOH_PACK_JOINT_ROOT && parents[j] >= j) {
            return noh_check_fail(check, "joint comes before its parent", h->parents_offset + 2ull * j);
        }
        if (!(square > 0.99f && square < 1.01f)) {
            return noh_check_fail(check, "bind rotation is not a unit quaternion", h->bind_offset + 40ull * j);
        }
        if (names[j] >= check->pack->string_bytes) {
            return noh_check_fail(check, "joint's name lies outside the strings", h->names_offset + 4ull * j);
        }
    }
    return check_bind(check, h);
}

/* The joint counts of the LOD levels: falling, and no level lacks a joint without a parent. After check_joints. */
static noh_result check_levels(const noh_check *check, const noh_skeleton_header *h)
{
    const uint16_t *parents = (const uint16_t *)(const void *)(check->bytes + h->parents_offset);
    const uint32_t *counts = (const uint32_t *)(const void *)(check->bytes + h->levels_offset);
    for (uint32_t i = 0; i < h->level_count; i++) {
        if (!counts[i] || (i ? counts[i] >= counts[i - 1] : counts[i] != h->joint_count)) {
            return noh_check_fail(check, "joint levels do not begin with all joints, or do not fall",
                                  h->levels_offset + 4ull * i);
        }
    }
    for (uint32_t j = counts[h->level_count - 1]; j < h->joint_count; j++) {
        if (parents[j] == NOH_PACK_JOINT_ROOT) {
            return noh_check_fail(check, "joint level leaves out a joint that has no parent",
                                  h->parents_offset + 2ull * j);
        }
    }
    return NOH_OK;
}

noh_result noh_check_skeleton(noh_check *check)
{
    const noh_skeleton_header *h = (const noh_skeleton_header *)(const void *)check->bytes;
    noh_result result = noh_check_head(check, sizeof *h);
    if (result) {
        return result;
    }
    if (!h->joint_count || h->joint_count > NOH_JOINTS_MAX) {
        return noh_check_fail(check, "joint count is zero or over the limit",
                              offsetof(noh_skeleton_header, joint_count));
    }
    if (!(h->unit_cm > 0.0f) || !noh_is_finite(h->unit_cm)) {
        return noh_check_fail(check, "unit of a skeleton is not a length", offsetof(noh_skeleton_header, unit_cm));
    }
    if (!h->level_count || h->level_count > NOH_LOD_LEVELS_MAX) {
        return noh_check_fail(check, "count of joint levels is zero or over the limit",
                              offsetof(noh_skeleton_header, level_count));
    }
    result = noh_check_array(check, offsetof(noh_skeleton_header, parents_offset), h->joint_count, 2);
    if (!result) result = noh_check_array(check, offsetof(noh_skeleton_header, bind_offset), h->joint_count, 40);
    if (!result) result = noh_check_array(check, offsetof(noh_skeleton_header, names_offset), h->joint_count, 4);
    if (!result) result = noh_check_array(check, offsetof(noh_skeleton_header, levels_offset), h->level_count, 4);
    if (!result) result = noh_check_end(check);
    if (!result) result = check_joints(check, h);
    return result ? result : check_levels(check, h);
}
