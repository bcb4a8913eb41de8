/* gaze_internal.h: the private part of low_life.h. */
#ifndef NOH_SIM_GAZE_INTERNAL_H
#define NOH_SIM_GAZE_INTERNAL_H

#include "noh/body.h"
#include "noh/low_life.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Whether a joint is a head by its name, and not the end of one, a forehead or a lamp. */
int noh_name_is_head(const char *name);

/* noh_gaze_rig_make for a body whose front is known.
 * front    noh_feet_front */
noh_result noh_gaze_rig_find(const noh_ragdoll_source *source, uint32_t front, noh_gaze_rig *rig, noh_error *error);

/* Make a look ahead.
 * shapes  ahead[3], unit: direction of the head at rest */
void noh_ik_look_init(noh_ik_look *look, const float ahead[3]);

/* Advance time and turn the look towards a target along a great circle, never beyond the cone. Targets outside the cone
 * are approached as far as the cone allows. Within 20 degrees of straight behind, the look stays over the shoulder from
 * which the target came, instead of turning from side to side with every small motion.
 * ranges   angle_max, from ahead: up to a right angle; speed_max in radians a second; seconds >= 0
 * ahead    unit; of the animated pose, in the space of the head's parent
 * target   from the head, any length; NULL or 0: no target
 * rotation turns ahead to the look
 * source   Granberg 2009, chapter 11, "Look-At Inverse Kinematics" */
void noh_ik_look_step(noh_ik_look *look, float angle_max, float speed_max, const float ahead[3], const float *target,
                      float seconds, float rotation[4]);

/* Advance time, and turn a pose.
 * local    [joint_count], from a clip; changes the rotations of the rig's joints and eyes
 * target   in model space, finite; NULL: ahead
 * seconds  since the last step, 0..
 * cut      1: look there immediately, as a new noh_gaze does */
void noh_gaze_step(noh_gaze *gaze, const noh_gaze_rig *rig, const noh_skeleton *skeleton, noh_transform *local,
                   const float *target, float seconds, int cut);

/* Check a state that comes from outside.
 * returns  NULL if it may be used, else a constant message */
const char *noh_gaze_check(const noh_gaze *gaze);

#ifdef __cplusplus
}
#endif

#endif
