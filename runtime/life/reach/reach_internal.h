/* reach_internal.h: the private part of low_life.h. */
#ifndef NOH_SIM_REACH_INTERNAL_H
#define NOH_SIM_REACH_INTERNAL_H

#include "noh/body.h"
#include "noh/low_life.h"

#ifdef __cplusplus
extern "C" {
#endif

/* noh_reach_rig_make for a body whose front is known.
 * front    noh_feet_front */
noh_result noh_reach_rig_find(const noh_ragdoll_source *source, uint32_t front, noh_reach_rig *rig, noh_error *error);

/* Advance time, and bend a pose's arms.
 * local    [joint_count]; changes the rotations of upper arms and forearms
 * points   [NOH_REACH_ARMS_MAX][3] in model space, finite; used for hands that reach or return
 * seconds  since the last step, 0..
 * cut      1: hands are in their final place immediately */
void noh_reach_step(noh_reach *reach, const noh_reach_rig *rig, const noh_skeleton *skeleton, noh_transform *local,
                    float points[NOH_REACH_ARMS_MAX][3], float seconds, int cut);

/* Check a state that comes from outside.
 * returns  NULL if it may be used, else a constant message */
const char *noh_reach_check(const noh_reach *reach);

#ifdef __cplusplus
}
#endif

#endif
