/* root_motion.h: the root's way over the ground, taken out of the pose (row C16.5).
 *
 * Of the root joint's transform the chosen part E (some axes of the translation, and
 * the heading: the twist about the up axis) is what the character does in the world;
 * the rest stays in its pose, so that world * E * rest is where the root was. From
 * position a to b of a motion the character moves by
 *   inverse(E(a)) * E(b)                                    within one pass
 *   inverse(E(a)) * E(end) * L^(n-1) * inverse(E(0)) * E(b)  over n seams,  L = inverse(E(0)) * E(end)
 * and L^n has a closed form, so that a million passes are as exact as one: headings
 * are 32-bit fractions of a turn that add without rounding, and the sum of the n
 * moves is that of a geometric series of rotations.
 *   noh_root_at       where a motion has come since its start, after any number of passes
 *   noh_controller_root_motion (controller_pose.h)   what all tracks moved since the last call, by weight */
#ifndef NOH_ANIM_ROOT_MOTION_H
#define NOH_ANIM_ROOT_MOTION_H

#include "anim/motion.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_ROOT_X 1u
#define NOH_ROOT_Y 2u
#define NOH_ROOT_Z 4u
#define NOH_ROOT_HEADING 8u
#define NOH_ROOT_GROUND (NOH_ROOT_X | NOH_ROOT_Z | NOH_ROOT_HEADING) /* for y up */

/* A move in the plane or along the up axis: turn about the up axis, then translate. */
typedef struct noh_root_pose {
    double translation[3]; /* model units */
    uint32_t turn;         /* fraction of a turn, counter-clockwise seen from the tip of the up axis */
    uint32_t reserved;
} noh_root_pose;

/* What is taken out of one motion. Plain data. */
typedef struct noh_root_track {
    uint32_t axes; /* NOH_ROOT_*; 0: nothing */
    uint32_t up;   /* 0, 1, 2: x, y, z */
    noh_root_pose start, end, loop; /* E(0), E(duration), L */
} noh_root_track;

/* E of a root joint's transform, and the transform without it. */
noh_root_pose noh_root_extract(uint32_t axes, uint32_t up, const noh_transform *root);
void noh_root_remove(uint32_t axes, uint32_t up, noh_transform *root);

/* Sample a motion as it is posed: without its root motion, if the set has any.
 * shapes  pose[joint_count], floats[the set's float_count] */
void noh_root_sample_rest(const noh_anim_set *set, uint32_t motion, uint32_t clip_tick, uint32_t joint_count, noh_transform *pose, float *floats);

/* First b, in the frame of a. */
noh_root_pose noh_root_compose(uint32_t up, const noh_root_pose *a, const noh_root_pose *b);
noh_root_pose noh_root_inverse(uint32_t up, const noh_root_pose *a);

/* a composed with itself n times; n < 0: its inverse. Closed form. */
noh_root_pose noh_root_power(uint32_t up, const noh_root_pose *a, int64_t n);

/* Sample a motion's ends. Joint 0 is the root.
 * errors  ARG motion, axes, up */
noh_result noh_root_track_measure(const noh_anim_set *set, uint32_t motion, uint32_t axes, uint32_t up, noh_root_track *track, noh_error *error);

/* From one unwrapped position to another. */
noh_root_pose noh_root_between(const noh_anim_set *set, const noh_root_track *track, uint32_t motion, noh_loop loop, int64_t from, int64_t to);

/* From position 0. */
noh_root_pose noh_root_at(const noh_anim_set *set, const noh_root_track *track, uint32_t motion, noh_loop loop, int64_t position);

#ifdef __cplusplus
}
#endif

#endif
