/* controller_pose.h: a controller's pose, its root motion, and transitions by inertia.
 *
 * Posing reads a controller and writes only to buffers of the caller's, so one scratch serves any number of instances
 * in turn (Granberg 2009, chapter 4, lets all clones of a controller write one tree of joints, and must draw each
 * before the next is posed).
 *
 * Threads: a controller and a scratch belong to one thread at a time. Several threads may pose controllers of one set,
 * each with its own scratch, where set->sample allows it: of a noh_clip_bank hand each thread its view (clip_bank.h).
 */
#ifndef NOH_ANIM_CONTROLLER_POSE_H
#define NOH_ANIM_CONTROLLER_POSE_H

#include "motion/pose/blend.h"
#include "motion/anim/controller.h"
#include "motion/anim/root_motion.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Working memory of posing: no state, so one serves all instances of a set that are posed one after another. Only
 * between noh_controller_inertia_capture and _begin it holds what was captured. */
typedef struct noh_pose_scratch {
    noh_blend blend;
    noh_transform *sample;             /* [joint_count] */
    float *below;                      /* [joint_count] weights of the low group */
    float *float_sample, *float_below; /* [float_count] */
    noh_transform *captured[4];        /* [joint_count] each: source, source before, target, target before */
    float *float_captured[4];
} noh_pose_scratch;

/* Exact bytes of a scratch (0 for a set over NOH_JOINTS_MAX or NOH_FLOATS_MAX), and a scratch in memory[bytes], aligned
 * to NOH_MEMORY_ALIGN. `inertial` 1: with room for the four poses of a transition.
 * errors  ARG such a set, or memory NULL or misaligned; MEMORY need: the bytes */
size_t noh_pose_scratch_size(const noh_clip_set *set, int inertial);
noh_result noh_pose_scratch_init(void *memory, size_t bytes, const noh_clip_set *set, int inertial,
                                 noh_pose_scratch *scratch, noh_error *error);

/* The pose at the controller's clock: the low group, the high group over it by the priority blend, additive tracks in
 * their order, then what is left of a transition. Clips that animate no joints (NOH_CLIP_FLOATS_ONLY) take no part in
 * joints, and those without floats none in floats. One unmasked track alone gives its clip to the bit.
 * shapes  pose[joint_count], floats[float_count] of the set */
void noh_controller_pose(const noh_controller *c, const noh_clip_set *set, noh_pose_scratch *scratch,
                         noh_transform *pose, float *floats);

/* Root displacement since the last call, weighted as the pose is at joint 0; additive tracks do not count, nor do clips
 * that animate no joints. A seek does not move the root, and drops what its track has moved since the last call. Zero
 * without set->roots. All roots of a set must have the same up axis. */
noh_root_pose noh_controller_root_motion(noh_controller *c, const noh_clip_set *set);

/* The same where some clips of the set stand for motion that is played elsewhere, such as a graph's: those from
 * first_clip on move the root by `moved`. */
typedef struct noh_given_root {
    uint32_t first_clip;
    noh_root_pose moved;
} noh_given_root;
noh_root_pose noh_controller_root_motion_given(noh_controller *c, const noh_clip_set *set, const noh_given_root *given);

/* A transition, wrapped around any change of the tracks:
 *   noh_controller_inertia_capture(c, set, &scratch);
 *   ... start, stop, set weights: what plays from now on ...
 *   noh_controller_inertia_begin(c, set, &scratch, duration_ticks);
 * A transition may begin while another one runs: the captured pose includes it.
 * errors  ARG no room (NOH_CONTROLLER_INERTIAL, scratch made with inertial); duration 0 */
noh_result noh_controller_inertia_capture(const noh_controller *c, const noh_clip_set *set, noh_pose_scratch *scratch,
                                          noh_error *error);
noh_result noh_controller_inertia_begin(noh_controller *c, const noh_clip_set *set, noh_pose_scratch *scratch,
                                        uint32_t duration_ticks, noh_error *error);

/* Parts of these calls, for graph_pose.c, which poses tracks in its own way: add the offsets that were left `ago` ticks
 * before now; store offsets from the four captured poses. */
#define NOH_INERTIA_BEFORE_TICKS 480 /* speeds are differences over this many ticks before the switch */
void noh_controller_inertia_add(const noh_controller *c, int64_t ago, noh_transform *pose, float *floats);
void noh_controller_inertia_store(noh_controller *c, const noh_pose_scratch *scratch, uint32_t duration_ticks);

#ifdef __cplusplus
}
#endif

#endif
