/* vmc_rig.h: bones of the VMC protocol (vmc.h) on a skeleton of other proportions, axes and names.
 *
 * A bone's rotation is the sender's, from a T to the pose, in the axes of the model; joints that are no bones keep the
 * pose they have. Arms that rest below a T, by more than 10 degrees, are raised to one first. The hips' place is scaled
 * by the length of the legs. */
#ifndef NOH_NOH_CAPTURE_VMC_RIG_H
#define NOH_NOH_CAPTURE_VMC_RIG_H

#include "capture/vmc.h"
#include "noh/clip.h"

/* A joint that is a bone. Rotations are of the bind pose, in model space. */
typedef struct vmc_joint {
    uint32_t joint, bone;
    float from[4]; /* before the bone's rotation: the inverse of what is above it */
    float to[4];   /* after it */
} vmc_joint;

typedef struct vmc_rig {
    uint32_t joint_count, bone_count;              /* joint_count: of the skeleton */
    vmc_joint bones[VMC_BONES];                    /* [bone_count] */
    int faces_back;                                /* the model looks along -z */
    float legs;                                    /* length, model units; 0: none were found */
    float hips_from[4], hips_scale, hips_above[3]; /* the space of the hips' joint: rotation (inverse), scale, place */
} vmc_rig;

/* Find a skeleton's bones by the names of its joints (convert/base/names.h).
 * names  [skeleton->joint_count]; NULL entries have none */
void vmc_rig_make(vmc_rig *rig, const noh_skeleton *skeleton, const char *const *names);

/* Change the joints whose bones were received.
 * shapes  local[rig->joint_count] */
void vmc_rig_pose(const vmc_rig *rig, const vmc *v, noh_transform *local);

#endif
