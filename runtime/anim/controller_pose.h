/* controller_pose.h: a controller's pose, its root motion, and transitions by inertia.
 *
 * Reads a controller; writes only to buffers of the caller's, which any number of
 * instances can use in turn (row C4.4). */
#ifndef NOH_ANIM_CONTROLLER_POSE_H
#define NOH_ANIM_CONTROLLER_POSE_H

#include "anim/blend.h"
#include "anim/controller.h"
#include "anim/root_motion.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Working memory of posing: not state, one for all instances of a set that are posed
 * one after another. Between noh_controller_inertia_capture and _begin it holds what was captured. */
typedef struct noh_pose_scratch {
    noh_blend blend;
    noh_transform *sample;      /* [joint_count] */
    float *below;               /* [joint_count] weights of the low group */
    float *float_sample, *float_below; /* [float_count] */
    noh_transform *captured[4]; /* [joint_count] each: source, source before, target, target before */
    float *float_captured[4];
} noh_pose_scratch;

/* inertial: with room for the four poses of a transition.
 * errors of init  ARG memory NULL or not 16-byte aligned; MEMORY need: the bytes */
size_t noh_pose_scratch_size(const noh_anim_set *set, int inertial);
noh_result noh_pose_scratch_init(void *memory, size_t bytes, const noh_anim_set *set, int inertial, noh_pose_scratch *scratch, noh_error *error);

/* The pose at the controller's clock: low group, high group over it by the priority
 * blend, additive tracks in their order, what is left of a transition. One track
 * alone, unmasked, is its motion to the bit.
 * shapes  pose[joint_count], floats[float_count] of the set */
void noh_controller_pose(const noh_controller *c, const noh_anim_set *set, noh_pose_scratch *scratch, noh_transform *pose, float *floats);

/* What the tracks moved the root since they were last asked, weighted as the pose is
 * (joint 0; additive tracks aside). Seeks do not move; what a track had moved since
 * the last call and before a seek is dropped with it. Zero without set->roots. The
 * up axis is that of the first track that has any. */
noh_root_pose noh_controller_root_motion(noh_controller *c, const noh_anim_set *set);

/* A transition, around any change of the tracks:
 *   noh_controller_inertia_capture(c, set, &scratch);
 *   ... start, stop, weigh: what is to play from now on, alone ...
 *   noh_controller_inertia_begin(c, set, &scratch, duration_ticks);
 * A transition may begin while another one is on: the captured pose includes it.
 * errors  ARG no room (NOH_CONTROLLER_INERTIAL, scratch made with inertial); duration 0 */
noh_result noh_controller_inertia_capture(const noh_controller *c, const noh_anim_set *set, noh_pose_scratch *scratch, noh_error *error);
noh_result noh_controller_inertia_begin(noh_controller *c, const noh_anim_set *set, noh_pose_scratch *scratch, uint32_t duration_ticks,
                                        noh_error *error);

/* The parts of these, for what poses tracks in its own way (graph_pose.c): add what is
 * left, `ago` ticks before now; store offsets from the four captured poses. */
#define NOH_INERTIA_BEFORE_TICKS 480 /* how far before the switch the speeds are taken */
void noh_controller_inertia_add(const noh_controller *c, int64_t ago, noh_transform *pose, float *floats);
void noh_controller_inertia_store(noh_controller *c, const noh_pose_scratch *scratch, uint32_t duration_ticks);

#ifdef __cplusplus
}
#endif

#endif
