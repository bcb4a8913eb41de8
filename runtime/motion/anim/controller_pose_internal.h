/* controller_pose_internal.h: the private part of clip.h. */
#ifndef NOH_ANIM_CONTROLLER_POSE_INTERNAL_H
#define NOH_ANIM_CONTROLLER_POSE_INTERNAL_H

#include "noh/base.h"
#include "noh/clip.h"

#ifdef __cplusplus
extern "C" {
#endif

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
