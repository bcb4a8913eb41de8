/* rig_internal.h: joints of a pose, and skin in the bind pose, for rigs and solvers of whole bodies. Threads: no state;
 * any thread. */
#ifndef NOH_SIM_RIG_INTERNAL_H
#define NOH_SIM_RIG_INTERNAL_H

#include "core/base/compiler_internal.h"
#include "life/physics/ragdoll_rig_internal.h"
#include "motion/pose/skeleton_internal.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/pack.h"
#include "core/base/vector_internal.h"
#include "noh/body.h"

/* Get a fraction of a rotation about its axis: `share` 0..1 of the angle. Shares of consecutive joints add up. */
void noh_ik_share(const float rotation[4], float share, float out[4]);

/* The transform of a pose's joint in model space. */
NOH_UNUSED static inline void noh_rig_joint(const noh_skeleton *k, const noh_transform *local, uint32_t joint,
                                            float position[3], float rotation[4])
{
    noh_skeleton posed = *k;
    posed.bind_pose = local;
    noh_ragdoll_bind(&posed, joint, position, rotation);
}

/* The way from a joint of a pose to the next of its limb, in model space. */
NOH_UNUSED static inline void noh_rig_bone(const noh_skeleton *k, const noh_transform *local, uint32_t joint,
                                           uint32_t next, float bone[3])
{
    float at[3], unused[4];
    noh_rig_joint(k, local, joint, at, unused);
    noh_rig_joint(k, local, next, bone, unused);
    noh_sub3(bone, at, bone);
}

/* Turn a joint with its descendants, in model space. */
NOH_UNUSED static inline void noh_rig_turn(const noh_skeleton *k, noh_transform *local, uint32_t joint,
                                           const float by[4])
{
    float *own = local[joint].rotation, carrier[4] = { 0.0f, 0.0f, 0.0f, 1.0f }, back[4], unused[3];
    if (k->parents[joint] != NOH_JOINT_ROOT) noh_rig_joint(k, local, k->parents[joint], unused, carrier);
    noh_quat_conjugate(carrier, back);
    noh_quat_mul(carrier, own, own);
    noh_quat_mul(by, own, own);
    noh_quat_mul(back, own, own);
    noh_quat_normalize(own);
}

/* The same by an axis times radians. */
NOH_UNUSED static inline void noh_rig_rotate(const noh_skeleton *k, noh_transform *local, uint32_t joint,
                                             const float rotation[3])
{
    float by[4];
    noh_quat_from_rotation(rotation, by);
    noh_rig_turn(k, local, joint, by);
}

#endif
