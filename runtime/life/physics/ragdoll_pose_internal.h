/* ragdoll_pose_internal.h: the private part of low_life.h. */
#ifndef NOH_SIM_RAGDOLL_POSE_INTERNAL_H
#define NOH_SIM_RAGDOLL_POSE_INTERNAL_H

#include "noh/low_life.h"

#ifdef __cplusplus
extern "C" {
#endif

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
