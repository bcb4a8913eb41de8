/* graph_internal.h: the private part of low_motion.h. */
#ifndef NOH_GRAPH_GRAPH_INTERNAL_H
#define NOH_GRAPH_GRAPH_INTERNAL_H

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/graph.h"
#include "noh/low_motion.h"

#ifdef __cplusplus
extern "C" {
#endif

/* SELECT reads its parameter at the start of a step, rounded and clamped to 0..child_count - 1; when the node is
 * entered, without a fade. A change back to the child that it fades from reverses the fade; a change to a third child
 * waits for the end of the fade. A child starts from its beginning unless NOH_TRANSITION_KEEP is set.
 *
 * ONE_SHOT is triggered at the start of a step, which sets the parameter to 0: b starts from its beginning and fades
 * in. It fades out so that the fade ends with b's first clip, which must play ONCE and reaches its very end, so each of
 * its callback keys fires exactly once. A trigger while it plays waits for the end. While it does not play, b's clips
 * do not play and fire no keys. */

NOH_STATIC_ASSERT(sizeof(noh_graph_node) == 32, graph_node_bytes);

/* The state of a MACHINE, SELECT or ONE_SHOT. */
typedef struct noh_machine {
    uint16_t current, previous; /* previous: NOH_GRAPH_NONE when no transition runs */
    uint32_t elapsed, duration; /* of a cross-fade, ticks */
    uint8_t curve;
    uint8_t switched; /* 1: an inertial transition begins with the next pose */
    uint8_t reserved[2];
} noh_machine;

/* ---- instances ---- */

/* First half of a step, for callers that also play other controllers and want all keys in time order: take transitions
 * and compute the weights for the next `ticks`. Then call noh_controller_step on the internal controller for these
 * ticks in total, in as many pieces as you like. */
void noh_graph_decide(noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set, uint32_t ticks);

/* Check a block from outside, such as a saved game, before any other call. A block that passes cannot make a call
 * overrun its memory, overflow or hang.
 * errors  ARG memory NULL or misaligned; DATA not an instance of this graph and set (where: the machine, track or
 *         change) */
noh_result noh_graph_state_check(const void *memory, size_t bytes, const noh_graph *graph, const noh_clip_set *set,
                                 noh_error *error);

/* ---- poses ---- */

/* Compute the pose `ago` ticks before now, assuming the present weights and speeds. Does not begin inertial
 * transitions: call noh_graph_pose first for that. */
void noh_graph_pose_ago(const noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set,
                        noh_graph_scratch *scratch, int64_t ago, noh_transform *pose, float *floats);

#ifdef __cplusplus
}
#endif

#endif
