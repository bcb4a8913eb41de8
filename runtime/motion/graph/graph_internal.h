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

/* ======== graphs ========
 * An animation graph in a fixed array.
 *
 * Nodes are stored in post-order: each node directly follows the subtrees of its children; the last node produces the
 * pose. Evaluation runs in stored order, without recursion, with noh_graph_buffers pose buffers. Nodes of weight 0 are
 * not sampled.
 *
 *   CLIP      a clip: one track of the internal controller, which keeps time, events and sync groups
 *   BLEND     a * (1 - t) + b * t
 *   ADD       a + t * (b as a difference): b's clips are differences already (NOH_CLIP_ADDITIVE), or are taken against
 *             the bind pose, or against the first frame of a clip
 *   MASK      b over a where the mask allows, by t
 *   SPACE_1D, SPACE_2D   blends of several clips by one or two parameters
 *   MACHINE   one of the children at a time; transitions cross-fade, or switch immediately and let the difference decay
 *             (inertialization)
 *   SELECT    the child whose number a parameter holds; a change cross-fades, or switches by inertia
 *   ONE_SHOT  b plays once over a, where the mask allows, each time a parameter triggers it
 * t, x and y are parameters of the instance, or constants. A clip that animates no joints, or no floats, leaves them to
 * the other children of a node.
 *
 * An instance is one block without pointers: clone it with one memcpy. Weights and transitions are decided at the start
 * of a step; the controller runs the rest of the step, including events (clip.h).
 *
 * source  animation trees: Granberg 2009, chapter 16
 *
 * Threads: an instance and a scratch belong to one thread at a time; graph and set are read-only and shared. */

/* Check a graph once, before making instances.
 * errors  ARG a count or pointer, or a set over NOH_JOINTS_MAX or NOH_FLOATS_MAX; DATA a node (where: its index); LIMIT
 *         more pose buffers than NOH_GRAPH_BUFFERS_MAX */
noh_result noh_graph_check(const noh_graph *graph, const noh_clip_set *set, noh_error *error);

/* Get the number of pose buffers that evaluating a checked graph needs. */
uint32_t noh_graph_buffers(const noh_graph *graph);

/* Size and make an instance, aligned to NOH_MEMORY_ALIGN, with all clips at their starts and all machines in their
 * first states. The size is 0 for a graph that noh_graph_check rejects.
 * errors  as noh_graph_check; ARG memory NULL or misaligned, or the desc of a clip; MEMORY need: the bytes */
size_t noh_graph_state_size(const noh_graph *graph, const noh_clip_set *set);
noh_result noh_graph_state_init(void *memory, size_t bytes, const noh_graph *graph, const noh_clip_set *set,
                                noh_graph_state **state, noh_error *error);

/* Get the internal controller, with one track per clip node. */
noh_controller *noh_graph_controller(noh_graph_state *state);

/* Set or get a parameter.
 * errors  ARG param, or a value that is not finite */
noh_result noh_graph_set_param(noh_graph_state *state, uint32_t param, float value);
float noh_graph_param(const noh_graph_state *state, uint32_t param);

/* Get the state that a machine is in or fades to: for a MACHINE or SELECT the number of the child, for a ONE_SHOT 1
 * while it plays, until it fades out. `machine` is the node's `index`. */
uint32_t noh_graph_machine_state(const noh_graph_state *state, uint32_t machine);

/* Take transitions, compute weights, advance time. The callback may set parameters; changes that it makes to the
 * internal tracks last until the next step.
 * returns  the number of events delivered */
uint32_t noh_graph_step(noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set, uint32_t ticks,
                        noh_event_fn fn, void *user);

/* Take the root displacement since the last call, with the weights of joint 0: blends by their weights, MASK and
 * ONE_SHOT by their mask at joint 0. The additive input of ADD and clips that animate no joints do not count. Zero
 * without set->roots. All roots of a set must have the same up axis. */
noh_root_pose noh_graph_root_motion(noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set);

/* Working memory for posing. It holds no state, so instances of a graph that are posed one after another share it. */
typedef struct noh_graph_scratch {
    noh_pose_scratch pose;
    noh_transform *poses[NOH_GRAPH_BUFFERS_MAX];
    float *float_poses[NOH_GRAPH_BUFFERS_MAX];
} noh_graph_scratch;

/* Size and make a scratch for a checked graph, aligned to NOH_MEMORY_ALIGN. The size is 0 for a set over NOH_JOINTS_MAX
 * or NOH_FLOATS_MAX.
 * errors  ARG the set is over a limit, or memory NULL or misaligned; MEMORY need: the bytes */
size_t noh_graph_scratch_size(const noh_graph *graph, const noh_clip_set *set);
noh_result noh_graph_scratch_init(void *memory, size_t bytes, const noh_graph *graph, const noh_clip_set *set,
                                  noh_graph_scratch *scratch, noh_error *error);

/* Compute the present pose. This begins the inertial transitions of the last step; a step that is not posed before the
 * next one switches without inertia.
 * shapes  pose[joint_count], floats[float_count] of the set */
void noh_graph_pose(noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set, noh_graph_scratch *scratch,
                    noh_transform *pose, float *floats);

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
