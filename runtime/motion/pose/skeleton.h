/* skeleton.h: joints, parents first, so that one pass over them computes model matrices. The arrays are borrowed.
 *
 * Threads: read-only; any number of threads may share one. */
#ifndef NOH_POSE_SKELETON_H
#define NOH_POSE_SKELETON_H

#include "motion/pose/pose.h"
#include "core/base/limits.h"
#include "core/base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_JOINT_ROOT 0xffffu /* parent of a joint without one */

typedef struct noh_skeleton {
    uint32_t joint_count;           /* 1..NOH_JOINTS_MAX */
    const uint16_t *parents;        /* [joint_count], each below its joint's own index, or NOH_JOINT_ROOT */
    const noh_transform *bind_pose; /* [joint_count], local */
    const float *inverse_bind;      /* [joint_count][12], see local_to_model.h; NULL: all identity */
} noh_skeleton;

/* Check a skeleton of your own; noh_pack_open checks skeletons in packs.
 * errors  ARG a count or pointer, named; DATA (where: the joint) a parent that does not come first, a value that is not
 *         finite, a rotation that is not unit */
noh_result noh_skeleton_check(const noh_skeleton *skeleton, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
