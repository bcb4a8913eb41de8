/* ragdoll_rig.h: a ragdoll out of a character: its skeleton, its joints' names and its skin.
 *
 *   noh_ragdoll_find_rows   which joints begin a body, and what they can do, by their names
 *   noh_ragdoll_rig_make    bodies and joints out of such rows
 *
 * Nothing is in metres by hand: capsules lie along bones, as thick as the skin round them; masses follow from their
 * volumes and from the height. Angles count from the bind pose.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 7, whose boxes are in metres by hand
 * Threads: no state; any thread. */
#ifndef NOH_SIM_RAGDOLL_RIG_H
#define NOH_SIM_RAGDOLL_RIG_H

#include "core/mesh/mesh.h"
#include "motion/pose/skeleton.h"
#include "life/physics/ragdoll.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum noh_ragdoll_toward { /* where a bone goes as it bends */
                                  NOH_RAGDOLL_FORWARD = 0,
                                  NOH_RAGDOLL_BACKWARD,
                                  NOH_RAGDOLL_UPWARD
} noh_ragdoll_toward;

/* A body, which begins at a joint and has all joints below it that have no row of their own. */
typedef struct noh_ragdoll_row {
    uint32_t joint;
    uint32_t hinge;  /* 1: it only bends, and its angles count from the straight limb, not from the bind pose */
    uint32_t toward; /* noh_ragdoll_toward */
    float bend_min, bend_max; /* radians, -pi..0 and 0..pi */
    float side;               /* to both sides, 0..pi */
    float twist;              /* both ways, 0..pi */
    float friction;           /* N m in a body of 70 kg, 0.. */
} noh_ragdoll_row;

/* What a rig is made of. */
typedef struct noh_ragdoll_source {
    const noh_pack *pack; /* its names; and the skinned meshes of that skeleton */
    uint32_t skeleton;
    noh_skeleton joints; /* noh_pack_skeleton_at */
    float metres;        /* of one unit of the skeleton: noh_skeleton_header.unit_cm / 100 */
    float mass;          /* kilograms; default (0) 70 for a height of 1.75 m, by its cube */
} noh_ragdoll_source;

/* Pelvis, spine, chest, head, upper arms, forearms, hands, thighs, shins and feet, as far as joints have such names:
 * 'LeftUpLeg', 'thigh.L', 'L_UpperArm'; 'L_Hip' over a knee, 'L_Shoulder' over an elbow. The pelvis is where the thighs
 * meet, the chest where the upper arms do. Limits are those of people.
 * A pack with a table of its own (noh build --ragdoll) has the rows of that instead, for a skeleton with its joints.
 * shapes  rows[NOH_RAGDOLL_BODIES_MAX]; *count of them, by rising joint
 * source  limits after clinical ranges of motion, rounded
 * errors  NOT_FOUND there are no two thighs: rows are to be made by hand */
noh_result noh_ragdoll_find_rows(const noh_ragdoll_source *source, noh_ragdoll_row *rows, uint32_t *count,
                                 noh_error *error);

/* The rig, in metres, at rest in the bind pose, with masses stabilised.
 * errors  ARG rows do not hang together: the first is not above all others, a joint is not there or not in order, or a
 *         number is out of its range (where: the row); LIMIT more than NOH_RAGDOLL_BODIES_MAX */
noh_result noh_ragdoll_rig_make(const noh_ragdoll_source *source, const noh_ragdoll_row *rows, uint32_t count,
                                noh_ragdoll_rig *rig, noh_error *error);

/* A joint in the bind pose, in the skeleton's unit. */
void noh_ragdoll_bind(const noh_skeleton *skeleton, uint32_t joint, float position[3], float rotation[4]);

#ifdef __cplusplus
}
#endif

#endif
