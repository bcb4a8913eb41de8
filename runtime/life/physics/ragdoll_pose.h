/* ragdoll_pose.h: between the pose of a skeleton and the bodies of a ragdoll: falling, and getting up.
 *
 *   noh_ragdoll_fit_make     how the bodies of a rig lie on the joints of its skeleton
 *   noh_ragdoll_from_pose    where bodies are, as a pose has them: to place a doll, and goals for it to follow
 *   noh_ragdoll_motions_of   velocities, from two poses
 *   noh_ragdoll_to_pose      a pose, as bodies are
 *   noh_ragdoll_likeness     how alike two dolls lie: which clip gets up from here
 *   noh_ragdoll_place_under  where the character stands, so that a pose of its lies where a doll does
 *
 * A character falls: its bodies are placed where the last pose shown had them, with the velocities from the one before
 * it; then each step's bodies make the pose. It gets up: of the clips that begin on the ground the one that lies most
 * like the doll, the character placed under the doll, and the difference that is left between the two poses decays.
 *
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 7, "Updating the Character Mesh", which sets
 *          bones to their bodies: they then stretch as far as joints are apart
 * Threads: no state; any thread. */
#ifndef NOH_SIM_RAGDOLL_POSE_H
#define NOH_SIM_RAGDOLL_POSE_H

#include "motion/pose/skeleton.h"
#include "life/physics/ragdoll.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How bodies lie on joints: the same for all poses. */
typedef struct noh_ragdoll_fit {
    uint32_t body_count;
    uint32_t joints[NOH_RAGDOLL_BODIES_MAX];         /* where each body begins */
    noh_ragdoll_pose bodies[NOH_RAGDOLL_BODIES_MAX]; /* in the space of its joint, metres */
} noh_ragdoll_fit;

/* Model space in the space of bodies: a point is there at position + rotation * (metres * point). */
typedef struct noh_ragdoll_frame {
    float position[3], rotation[4]; /* rotation: unit */
    float metres;                   /* of one unit of the skeleton, as the rig was made with; above 0 */
} noh_ragdoll_frame;

/* rig  of noh_ragdoll_rig_make, from this skeleton with this length of its unit */
void noh_ragdoll_fit_make(const noh_ragdoll_rig *rig, const noh_skeleton *skeleton, float metres, noh_ragdoll_fit *fit);

/* shapes  local[skeleton->joint_count]; bodies[fit->body_count] */
void noh_ragdoll_from_pose(const noh_ragdoll_fit *fit, const noh_skeleton *skeleton, const noh_transform *local,
                           const noh_ragdoll_frame *frame, noh_ragdoll_pose *bodies);

/* The velocities at which bodies come from one pose to the next; spins along the shorter arc.
 * shapes  before, now, motions: [count]
 * ranges  seconds above 0: of the time between the two */
void noh_ragdoll_motions_of(const noh_ragdoll_pose *before, const noh_ragdoll_pose *now, uint32_t count, float seconds,
                            noh_ragdoll_motion *motions);

/* Turn joints so that bodies lie as they are told to, and move that of the first body there. Bones keep their lengths;
 * joints without a body of their own keep what the pose has for them.
 * shapes  bodies, weights: [fit->body_count]; weights 0..1: 0 leaves what the pose has; NULL: all 1.
 *         local[skeleton->joint_count] read and written */
void noh_ragdoll_to_pose(const noh_ragdoll_fit *fit, const noh_skeleton *skeleton, const noh_ragdoll_frame *frame,
                         const noh_ragdoll_pose *bodies, const float *weights, noh_transform *local);

/* How alike the first bodies of two dolls lie, wherever they are and whichever way they head: on the front, on the
 * back, on a side, upright. The cosine of the angle between what is up for them: 1 alike, -1 the opposite. */
float noh_ragdoll_likeness(const noh_ragdoll_pose *a, const noh_ragdoll_pose *b);

/* Where a character is to stand, and how it is to head, so that a pose of its lies where a doll does: the first bodies
 * over each other, and the others on the same side of them. Turns about +Y alone, and keeps the frame's height.
 * shapes  pose[count] its bodies as from_pose gives them for *frame; doll[count]; frame: read and changed */
void noh_ragdoll_place_under(const noh_ragdoll_pose *pose, const noh_ragdoll_pose *doll, uint32_t count,
                             noh_ragdoll_frame *frame);

#ifdef __cplusplus
}
#endif

#endif
