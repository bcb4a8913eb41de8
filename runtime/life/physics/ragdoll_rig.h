/* ragdoll_rig.h: makes a ragdoll from a character: skeleton, joint names and skin.
 *
 *   noh_ragdoll_find_rows   find the joints that begin a body, and their limits, by name
 *   noh_ragdoll_rig_make    make bodies and joints from such rows
 *
 * No dimensions are set by hand: capsules lie along bones and are as thick as the skin around them; masses follow from
 * their volumes and the height. Angles count from the bind pose.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 7, whose boxes are sized by hand
 * Threads: no state; any thread. */
#ifndef NOH_SIM_RAGDOLL_RIG_H
#define NOH_SIM_RAGDOLL_RIG_H

#include "core/mesh/mesh.h"
#include "motion/pose/skeleton.h"
#include "life/physics/ragdoll.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Direction of a bone as it bends. */
typedef enum noh_ragdoll_toward {
    NOH_RAGDOLL_FORWARD = 0,
    NOH_RAGDOLL_BACKWARD,
    NOH_RAGDOLL_UPWARD
} noh_ragdoll_toward;

/* A body: it begins at a joint and includes all joints below it that have no row of their own. */
typedef struct noh_ragdoll_row {
    uint32_t joint;
    uint32_t hinge;  /* 1: it only bends, and its angles count from the straight limb, not from the bind pose */
    uint32_t toward; /* noh_ragdoll_toward */
    float bend_min, bend_max; /* radians, -pi..0 and 0..pi */
    float side;               /* to either side, 0..pi */
    float twist;              /* in either direction, 0..pi */
    float friction;           /* N m for a body of 70 kg, 0.. */
} noh_ragdoll_row;

/* Inputs of a rig. */
typedef struct noh_ragdoll_source {
    const noh_pack *pack; /* joint names and skinned meshes of the skeleton */
    uint32_t skeleton;
    noh_skeleton joints; /* noh_pack_skeleton_at */
    float metres;        /* metres per unit of the skeleton: noh_skeleton_header.unit_cm / 100 */
    float mass;          /* kilograms; default (0) 70 for a height of 1.75 m, scaled by its cube */
} noh_ragdoll_source;

/* Find pelvis, spine, chest, head, upper arms, forearms, hands, thighs, shins and feet by joint names such as
 * 'LeftUpLeg', 'thigh.L', 'L_UpperArm', or 'L_Hip' above a knee, 'L_Shoulder' above an elbow. The pelvis is where the
 * thighs meet, the chest where the upper arms meet. Limits are human. If the pack has its own table (noh build
 * --ragdoll), its rows are used for a skeleton with its joints.
 * shapes  rows[NOH_RAGDOLL_BODIES_MAX]; *count of them, by increasing joint
 * source  limits after clinical ranges of motion, rounded
 * errors  NOT_FOUND there are no two thighs: make rows by hand */
noh_result noh_ragdoll_find_rows(const noh_ragdoll_source *source, noh_ragdoll_row *rows, uint32_t *count,
                                 noh_error *error);

/* Make the rig, in metres, at rest in the bind pose, with stabilised masses.
 * errors  ARG rows are not one tree: the first is not above all others, a joint does not exist or is out of order, or a
 *         number is out of its range (where: the row); LIMIT more than NOH_RAGDOLL_BODIES_MAX */
noh_result noh_ragdoll_rig_make(const noh_ragdoll_source *source, const noh_ragdoll_row *rows, uint32_t count,
                                noh_ragdoll_rig *rig, noh_error *error);

/* Get a joint's transform in the bind pose, in the skeleton's unit. */
void noh_ragdoll_bind(const noh_skeleton *skeleton, uint32_t joint, float position[3], float rotation[4]);

#ifdef __cplusplus
}
#endif

#endif
