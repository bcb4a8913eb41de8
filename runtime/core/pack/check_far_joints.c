/* check_far_joints.c: the checker of virtual joints. */
#include "core/pack/check_internal.h"

#include <stddef.h>

#include "noh/base.h"
#include "noh/format.h"

static noh_result check_header(const noh_check *check, const noh_far_joints_header *h, const noh_mesh_header *mesh)
{
    const uint32_t skin_joints = noh_check_skin_joints(check->pack, mesh->skin);
    const noh_check_field fields[] = {
        { offsetof(noh_far_joints_header, level), !h->level || h->level >= mesh->level_count },
        { offsetof(noh_far_joints_header, joint_count), !h->joint_count || h->joint_count > NOH_FAR_JOINTS_MAX },
        { offsetof(noh_far_joints_header, target_count), h->target_count != mesh->target_count },
        { offsetof(noh_far_joints_header, first_joint),
          h->first_joint > skin_joints || h->joint_count > skin_joints - h->first_joint },
        { offsetof(noh_far_joints_header, normal_error), !(h->normal_error >= 0.0f && h->normal_error <= 4.0f) },
        { offsetof(noh_far_joints_header, normal_error_p99),
          !(h->normal_error_p99 >= 0.0f && h->normal_error_p99 <= h->normal_error) },
    };
    noh_result result = noh_check_fields(check, fields, sizeof fields / sizeof fields[0],
                                         "virtual joints do not fit their mesh and its skin", 0);
    return result ? result
                  : noh_check_reserved(check, offsetof(noh_far_joints_header, reserved),
                                       sizeof h->reserved / sizeof h->reserved[0]);
}

/* Levels that they move have no accumulation texels. */
static noh_result check_level(const noh_check *check, const noh_far_joints_header *h, const noh_mesh_header *mesh)
{
    for (uint32_t k = h->level > mesh->level_first ? h->level - mesh->level_first : 0u;
         k < noh_check_levels_there(mesh); k++) {
        if (mesh[k].touched_count) {
            return noh_check_fail(check, "virtual joints move a level that has accumulation texels",
                                  offsetof(noh_far_joints_header, level));
        }
    }
    return NOH_OK;
}

static noh_result check_values(const noh_check *check, const noh_far_joints_header *h)
{
    const float *scales = (const float *)(const void *)(check->bytes + h->scales_offset);
    const uint32_t *motions = (const uint32_t *)(const void *)(check->bytes + h->motions_offset);
    noh_result result = noh_check_floats(check, (const float *)(const void *)(check->bytes + h->centres_offset),
                                         3u * h->joint_count, "centre of a virtual joint is not finite");
    if (!result) {
        result = noh_check_floats(check, scales, 2u * h->joint_count, "scale of a virtual joint is not finite");
    }
    for (uint32_t i = 0; !result && i < 2u * h->joint_count; i++) {
        if (scales[i] < 0.0f) {
            result = noh_check_fail(check, "scale of a virtual joint is below 0", h->scales_offset + 4ull * i);
        }
    }
    for (uint32_t i = 0; !result && i < 2u * h->joint_count * h->target_count; i++) {
        if (motions[i] >> 30) {
            result = noh_check_fail(check, "motion of a virtual joint has bits above its three numbers",
                                    h->motions_offset + 4ull * i);
        }
    }
    return result;
}

noh_result noh_check_far_joints(noh_check *check)
{
    const noh_far_joints_header *h = (const noh_far_joints_header *)(const void *)check->bytes;
    const noh_mesh_header *mesh;
    noh_result result = noh_check_head(check, sizeof *h);
    if (result) return result;
    mesh = noh_check_subject(check, NOH_CHUNK_FAR_JOINTS, NOH_CHUNK_MESH);
    if (!mesh || mesh->skin == NOH_NONE || mesh->flags & NOH_MESH_DUAL_QUATERNION) {
        return noh_check_fail(check,
                              "virtual joints name a missing mesh or one not skinned by matrices, or are out of "
                              "order",
                              offsetof(noh_far_joints_header, mesh));
    }
    result = check_header(check, h, mesh);
    if (!result) result = check_level(check, h, mesh);
    if (!result) result = noh_check_array(check, offsetof(noh_far_joints_header, centres_offset), h->joint_count, 12);
    if (!result) result = noh_check_array(check, offsetof(noh_far_joints_header, scales_offset), h->joint_count, 8);
    if (!result) {
        result = noh_check_array(check, offsetof(noh_far_joints_header, motions_offset),
                                 (uint64_t)h->joint_count * h->target_count, 8);
    }
    if (!result) result = noh_check_end(check);
    return result ? result : check_values(check, h);
}
