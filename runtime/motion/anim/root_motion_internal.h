/* root_motion_internal.h: the private part of low_motion.h. */
#ifndef NOH_ANIM_ROOT_MOTION_INTERNAL_H
#define NOH_ANIM_ROOT_MOTION_INTERNAL_H

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Sample a clip for its pose: without root motion, if the set extracts it.
 * shapes  pose[joint_count], floats[the set's float_count] */
void noh_root_sample_rest(const noh_clip_set *set, uint32_t clip, uint32_t clip_tick, uint32_t joint_count,
                          noh_transform *pose, float *floats);

/* Compose a with itself n times; for n < 0 its inverse, -n times. Closed form: constant time, no drift. */
noh_root_pose noh_root_power(uint32_t up, const noh_root_pose *a, int64_t n);

/* Measure a root track from both ends of its clip. Joint 0 is the root.
 * errors  ARG clip, axes, up */
noh_result noh_root_track_measure(const noh_clip_set *set, uint32_t clip, uint32_t axes, uint32_t up,
                                  noh_root_track *track, noh_error *error);

/* Displacement from one unwrapped position to another. */
noh_root_pose noh_root_between(const noh_clip_set *set, const noh_root_track *track, uint32_t clip, noh_loop loop,
                               int64_t from, int64_t to);

#ifdef __cplusplus
}
#endif

#endif
