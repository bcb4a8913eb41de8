/* ragdoll_pose.h: converts between poses of a skeleton and bodies of a ragdoll, to fall and to get up.
 *
 *   noh_ragdoll_fit_make     how the bodies of a rig lie on the joints of its skeleton
 *   noh_ragdoll_from_pose    bodies from a pose: to place a doll, and goals to drive it
 *   noh_ragdoll_motions_of   velocities from two poses
 *   noh_ragdoll_to_pose      a pose from bodies
 *   noh_ragdoll_similarity   how similarly two dolls lie, to choose the clip to get up with
 *   noh_ragdoll_place_under  place the character so that its pose lies where the doll does
 *
 * To fall: place the bodies from the last visible pose, with velocities from the pose before it; then each step's
 * bodies make the pose. To get up: choose the clip whose first pose lies most like the doll, place the character under
 * the doll, and let the remaining difference of the two poses decay.
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
    uint32_t joints[NOH_RAGDOLL_BODIES_MAX];         /* the joint where each body begins */
    noh_ragdoll_pose bodies[NOH_RAGDOLL_BODIES_MAX]; /* in the space of the joint, metres */
} noh_ragdoll_fit;

/* Transform from model space to the space of bodies: position + rotation * (metres * point). */
typedef struct noh_ragdoll_frame {
    float position[3], rotation[4]; /* rotation: unit */
    float metres;                   /* metres per unit of the skeleton, as the rig was made with; above 0 */
} noh_ragdoll_frame;

/* Make a fit.
 * rig  from noh_ragdoll_rig_make, with this skeleton and unit */
void noh_ragdoll_fit_make(const noh_ragdoll_rig *rig, const noh_skeleton *skeleton, float metres, noh_ragdoll_fit *fit);

/* Compute the bodies from a pose.
 * shapes  local[skeleton->joint_count]; bodies[fit->body_count] */
void noh_ragdoll_from_pose(const noh_ragdoll_fit *fit, const noh_skeleton *skeleton, const noh_transform *local,
                           const noh_ragdoll_frame *frame, noh_ragdoll_pose *bodies);

/* Compute the velocities of bodies between two poses; spins take the shorter arc.
 * shapes  before, now, motions: [count]
 * ranges  seconds above 0: the time between the two */
void noh_ragdoll_motions_of(const noh_ragdoll_pose *before, const noh_ragdoll_pose *now, uint32_t count, float seconds,
                            noh_ragdoll_motion *motions);

/* Turn joints so that bodies have the given orientations, and move the joint of the first body to it. Bones keep their
 * lengths; joints without a body keep their pose.
 * shapes  bodies, weights: [fit->body_count]; weights 0..1: 0 keeps the pose; NULL: all 1. local[skeleton->joint_count]
 *         read and written */
void noh_ragdoll_to_pose(const noh_ragdoll_fit *fit, const noh_skeleton *skeleton, const noh_ragdoll_frame *frame,
                         const noh_ragdoll_pose *bodies, const float *weights, noh_transform *local);

/* Compare how the first bodies of two dolls lie (on the front, back or side, or upright), whatever their place and
 * heading. Returns the cosine of the angle between their up directions: 1 equal, -1 opposite. */
float noh_ragdoll_similarity(const noh_ragdoll_pose *a, const noh_ragdoll_pose *b);

/* Place and turn a character so that its pose lies where a doll does: the first bodies above each other, the others on
 * the same side. Turns about +Y only, and keeps the frame's height.
 * shapes  pose[count] the character's bodies, from noh_ragdoll_from_pose with *frame; doll[count]; frame: read and
 *         changed */
void noh_ragdoll_place_under(const noh_ragdoll_pose *pose, const noh_ragdoll_pose *doll, uint32_t count,
                             noh_ragdoll_frame *frame);

#ifdef __cplusplus
}
#endif

#endif
