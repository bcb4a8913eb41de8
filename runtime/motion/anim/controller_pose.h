/* controller_pose.h: poses and root motion of a controller, and inertial transitions.
 *
 * Posing reads the controller and writes only to the caller's buffers, so one scratch serves any number of instances in
 * turn. (In Granberg 2009, chapter 4, all clones of a controller write one tree of joints, and each must be drawn
 * before the next is posed.)
 *
 * Threads: a controller and a scratch belong to one thread at a time. Several threads may pose controllers of one set,
 * each with its own scratch, if set->sample allows it. With a noh_clip_bank give each thread its own view
 * (clip_bank.h). */
#ifndef NOH_ANIM_CONTROLLER_POSE_H
#define NOH_ANIM_CONTROLLER_POSE_H

#include "motion/pose/blend.h"
#include "motion/anim/controller.h"
#include "motion/anim/root_motion.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Working memory for posing. It holds no state between calls, so instances of a set that are posed one after another
 * share it. The exception: between noh_controller_inertia_capture and _begin it holds the captured poses. */
typedef struct noh_pose_scratch {
    noh_blend blend;
    noh_transform *sample;             /* [joint_count] */
    float *below;                      /* [joint_count] weights of the low group */
    float *float_sample, *float_below; /* [float_count] */
    noh_transform *captured[4];        /* [joint_count] each: source, source before, target, target before */
    float *float_captured[4];
} noh_pose_scratch;

/* Size and make a scratch, aligned to NOH_MEMORY_ALIGN. `inertial` 1 adds memory for the four poses of a transition.
 * The size is 0 for a set over NOH_JOINTS_MAX or NOH_FLOATS_MAX.
 * errors  ARG the set is over a limit, or memory NULL or misaligned; MEMORY need: the bytes */
size_t noh_pose_scratch_size(const noh_clip_set *set, int inertial);
noh_result noh_pose_scratch_init(void *memory, size_t bytes, const noh_clip_set *set, int inertial,
                                 noh_pose_scratch *scratch, noh_error *error);

/* Compute the pose at the controller's clock: the low group, the high group over it by the priority blend, additive
 * tracks in order, then the remaining transition offsets. Clips with NOH_CLIP_FLOATS_ONLY do not affect joints; clips
 * without floats do not affect floats. A single unmasked track reproduces its clip bit for bit.
 * shapes  pose[joint_count], floats[float_count] of the set */
void noh_controller_pose(const noh_controller *c, const noh_clip_set *set, noh_pose_scratch *scratch,
                         noh_transform *pose, float *floats);

/* Take the root displacement since the last call, with the weights of joint 0. Additive tracks and clips that animate
 * no joints do not count. A seek does not move the root and discards the track's displacement since the last call. Zero
 * without set->roots. All roots of a set must have the same up axis. */
noh_root_pose noh_controller_root_motion(noh_controller *c, const noh_clip_set *set);

/* A root displacement for clips whose motion is played elsewhere, such as by a graph: clips from first_clip on move the
 * root by `moved`. */
typedef struct noh_given_root {
    uint32_t first_clip;
    noh_root_pose moved;
} noh_given_root;
noh_root_pose noh_controller_root_motion_given(noh_controller *c, const noh_clip_set *set, const noh_given_root *given);

/* Make an inertial transition around any change of the tracks:
 *   noh_controller_inertia_capture(c, set, &scratch);
 *   ... start, stop, set weights ...
 *   noh_controller_inertia_begin(c, set, &scratch, duration_ticks);
 * A transition may begin while another one runs: the captured pose includes it.
 * errors  ARG no room (needs NOH_CONTROLLER_INERTIAL and a scratch made with inertial); duration 0 */
noh_result noh_controller_inertia_capture(const noh_controller *c, const noh_clip_set *set, noh_pose_scratch *scratch,
                                          noh_error *error);
noh_result noh_controller_inertia_begin(noh_controller *c, const noh_clip_set *set, noh_pose_scratch *scratch,
                                        uint32_t duration_ticks, noh_error *error);

/* Building blocks for graph_pose.c, which poses tracks itself: add the offsets that remained `ago` ticks ago; store
 * offsets computed from the four captured poses. */
#define NOH_INERTIA_BEFORE_TICKS 480 /* speeds are differences over this many ticks before the switch */
void noh_controller_inertia_add(const noh_controller *c, int64_t ago, noh_transform *pose, float *floats);
void noh_controller_inertia_store(noh_controller *c, const noh_pose_scratch *scratch, uint32_t duration_ticks);

#ifdef __cplusplus
}
#endif

#endif
