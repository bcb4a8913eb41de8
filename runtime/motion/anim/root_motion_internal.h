/* root_motion_internal.h: the private part of low_motion.h. */
#ifndef NOH_ANIM_ROOT_MOTION_INTERNAL_H
#define NOH_ANIM_ROOT_MOTION_INTERNAL_H

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Get the displacement that undoes a. */
noh_root_pose noh_root_inverse(uint32_t up, const noh_root_pose *a);

/* ======== root motion ========
 * Root displacement, extracted from the pose.
 *
 * A chosen part E of the root joint's transform (some axes of the translation, and the heading: the twist about the up
 * axis) moves the character in the world. The rest stays in the pose, so that world * E * rest is the original root.
 * From position a to b of a clip the character moves by
 *   inverse(E(a)) * E(b)                                         within one pass
 *   inverse(E(a)) * E(end) * L^(n-1) * inverse(E(0)) * E(b)      across n seams, L = inverse(E(0)) * E(end)
 * Headings count from the clip's own axes: the yaw of the first frame stays in the pose. So a clip that walks along z
 * moves its character along z, whatever direction its first frame faces.
 * E(0) and E(end) come from the source clip if the set has them (root_ends); sampled values blend towards them within
 * NOH_ROOT_SEAM_TICKS of either end. So a loop that closes in the source never drifts, however lossy its compression.
 * L^n has a closed form, so a million passes are as exact as one: headings are 32-bit fractions of a turn, which add
 * without rounding, and the sum of the n displacements is a geometric series of rotations.
 *
 *   noh_root_between  displacement from one position to another, over any number of passes
 *   noh_controller_root_motion (clip.h)   weighted displacement of all tracks since the last call
 *
 * source  Granberg 2009, chapter 16, names root motion; adding its displacements in floats drifts
 *
 * Threads: pure functions; those that call the set's `sample` may run where it may (clip.h). */

#define NOH_ROOT_SEAM_TICKS 200u /* 1/240 s: less than a frame, so no position is off by more than its clip's error */

/* Split the root joint's transform: extract returns E, with the heading relative to the model's axes; remove leaves the
 * transform without E, except for `facing` of its heading. */
noh_root_pose noh_root_extract(uint32_t axes, uint32_t up, const noh_transform *root);
void noh_root_remove(uint32_t axes, uint32_t up, uint32_t facing, noh_transform *root);

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
