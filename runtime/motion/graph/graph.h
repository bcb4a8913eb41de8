/* graph.h: an animation graph in a fixed array.
 *
 * Nodes are stored in post-order: each node directly after the subtrees of its children; the last one gives the pose.
 * They are evaluated in stored order, without recursion, with as many pose buffers as noh_graph_buffers counts
 * beforehand. Nodes of weight 0 are not sampled.
 *
 *   CLIP      a clip: one track of the controller inside, which keeps time, events and sync groups
 *   BLEND     a * (1 - t) + b * t
 *   ADD       a + t * (b as a difference): b's clips are differences already (NOH_CLIP_ADDITIVE), or are taken against
 *             the bind pose, or against the first frame of a clip
 *   MASK      b over a where the mask allows, by t
 *   SPACE_1D, SPACE_2D   see blend_space.h
 *   MACHINE   one of the children at a time; transitions cross-fade, or switch at once and let the difference decay
 *             (inertial_internal.h)
 *   SELECT    the child whose number a parameter holds; a change of it cross-fades, or switches by inertia
 *   ONE_SHOT  b plays once over a, where the mask allows, each time that a parameter triggers it
 * t, x and y are parameters of the instance, or constants. A clip that animates no joints, or no floats, leaves them to
 * the other children of a node.
 *
 * An instance is one block without pointers: cloning it is one memcpy. Weights and transitions are decided at the start
 * of a step; the rest of the step, events included, is the controller's (controller.h).
 *
 * source  animation trees: Granberg 2009, chapter 16
 *
 * Threads: an instance, and a scratch, belong to one thread at a time; graph and set are read-only and shared. */
#ifndef NOH_GRAPH_GRAPH_H
#define NOH_GRAPH_GRAPH_H

#include "motion/graph/blend_space.h"
#include "motion/anim/controller_pose.h"
#include "core/base/limits.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_GRAPH_NONE 0xffffu

typedef enum noh_node_kind {
    NOH_NODE_CLIP = 0,
    NOH_NODE_BLEND,
    NOH_NODE_ADD,
    NOH_NODE_MASK,
    NOH_NODE_SPACE_1D,
    NOH_NODE_SPACE_2D,
    NOH_NODE_MACHINE,
    NOH_NODE_SELECT,
    NOH_NODE_ONE_SHOT
} noh_node_kind;

typedef struct noh_graph_node {
    uint16_t kind;
    uint16_t first_child, child_count; /* in the graph's children */
    uint16_t param;   /* t, x, SELECT's number or ONE_SHOT's trigger; t and x may be NOH_GRAPH_NONE: `value` */
    uint16_t param_y; /* SPACE_2D */
    /* SPACE_1D: its thresholds, one per child; SPACE_2D: its space; MACHINE: its transitions; ADD: item_count 1: the
     * clip of the set whose first frame is the reference, 0: the bind pose is */
    uint16_t first_item, item_count;
    uint16_t mask;       /* MASK, ONE_SHOT: 1 + index in the set's masks; ONE_SHOT also 0: everywhere */
    uint16_t index;      /* CLIP: its number among the clips; MACHINE, SELECT, ONE_SHOT: among these, in stored order */
    uint8_t curve;       /* SELECT, ONE_SHOT: noh_curve of the fades */
    uint8_t flags;       /* SELECT: NOH_TRANSITION_* */
    float value;         /* ONE_SHOT: it is triggered by a parameter above this */
    uint32_t fade_ticks; /* SELECT: a change; ONE_SHOT: fading in. 0: at once, and not inertial */
    uint32_t fade_out_ticks; /* ONE_SHOT */
} noh_graph_node;

typedef enum noh_condition {
    NOH_WHEN_ABOVE = 0, /* param > threshold */
    NOH_WHEN_BELOW,     /* param < threshold */
    NOH_WHEN_TRIGGERED, /* param > threshold; taking the transition sets the parameter to 0 */
    NOH_WHEN_ENDING     /* the state's first clip plays ONCE and ends within the transition's duration, or has ended */
} noh_condition;

#define NOH_TRANSITION_INERTIAL 1u /* switch at once; the difference decays over the duration */
#define NOH_TRANSITION_KEEP 2u /* the state's clips continue where they stopped; else they start from the beginning */

/* Tested in stored order; the first whose condition holds is taken. While a cross-fade runs, none is. */
typedef struct noh_graph_transition {
    uint16_t from, to;  /* children of the machine; from NOH_GRAPH_NONE: any but `to` */
    uint16_t condition; /* noh_condition */
    uint16_t param;     /* not used by ENDING */
    float threshold;
    uint32_t duration_ticks; /* 0: at once, and not inertial */
    uint16_t curve;          /* noh_curve, of a cross-fade */
    uint16_t flags;          /* NOH_TRANSITION_* */
} noh_graph_transition;

/* SELECT takes the number from its parameter, rounded to the nearest and held in 0..child_count - 1, at the start of a
 * step; when it is entered, without a fade. Back to the child that it fades from, the fade turns round; to a third one
 * it waits for the end of the fade. A child starts from its beginning unless NOH_TRANSITION_KEEP is set.
 *
 * ONE_SHOT is triggered at the start of a step, which sets the parameter to 0: b starts from its beginning and fades
 * in. It fades out so that it is gone when its first clip, which has to play ONCE, has ended; that clip is played to
 * its very end, so every callback key of it fires exactly once. A trigger that comes while it plays waits until it is
 * gone. While it does not play, b's clips do not either, and fire nothing. */

NOH_STATIC_ASSERT(sizeof(noh_graph_node) == 32, graph_node_bytes);

/* Shared by all instances; borrowed and constant. */
typedef struct noh_graph {
    uint32_t node_count, child_count, clip_count;
    uint32_t machine_count; /* nodes that keep a noh_machine: MACHINE, SELECT, ONE_SHOT */
    uint32_t transition_count, threshold_count, space_count, param_count;
    const noh_graph_node *nodes; /* [node_count] */
    const uint16_t *children;    /* [child_count] indices of nodes */
    const noh_track_desc *clips; /* [clip_count]; clip, position, speed, loop, sync group and PAUSED are used */
    const noh_graph_transition *transitions; /* [transition_count] */
    const float *thresholds;                 /* [threshold_count] */
    const noh_blend_space_2d *spaces;        /* [space_count] */
    const float *param_defaults;             /* [param_count]; NULL: all 0 */
} noh_graph;

/* The state of a MACHINE, SELECT or ONE_SHOT: 16 bytes. */
typedef struct noh_machine {
    uint16_t current, previous; /* previous: NOH_GRAPH_NONE when no transition runs */
    uint32_t elapsed, duration; /* of a cross-fade, ticks */
    uint8_t curve;
    uint8_t switched; /* 1: an inertial transition begins with the next pose */
    uint8_t reserved[2];
} noh_machine;

/* The head of an instance's block. */
typedef struct noh_graph_state {
    uint32_t bytes;
    uint32_t node_count, param_count, machine_count; /* of the graph it was made for */
    uint32_t params_offset, machines_offset, controller_offset;
    uint32_t inertia_ticks; /* duration of the inertial transition that begins with the next pose; 0: none */
} noh_graph_state;

/* Check a graph once, before instances are made of it.
 * errors  ARG a count or pointer, or a set over NOH_JOINTS_MAX or NOH_FLOATS_MAX; DATA a node (where: its index); LIMIT
 * more pose buffers than NOH_GRAPH_BUFFERS_MAX */
noh_result noh_graph_check(const noh_graph *graph, const noh_clip_set *set, noh_error *error);

/* Pose buffers that evaluating a checked graph needs. */
uint32_t noh_graph_buffers(const noh_graph *graph);

/* ---- instances ---- */

/* Exact bytes of an instance (0 for a graph that noh_graph_check refuses), and an instance in memory[bytes], aligned to
 * NOH_MEMORY_ALIGN: all clips at their starts, all machines in their first states.
 * errors  those of noh_graph_check; ARG memory NULL or misaligned, or the desc of a clip; MEMORY need: the bytes */
size_t noh_graph_state_size(const noh_graph *graph, const noh_clip_set *set);
noh_result noh_graph_state_init(void *memory, size_t bytes, const noh_graph *graph, const noh_clip_set *set,
                                noh_graph_state **state, noh_error *error);

/* The controller inside, with one track per clip node. */
noh_controller *noh_graph_controller(noh_graph_state *state);

/* Set and read a parameter.
 * errors  ARG param, or a value that is not finite */
noh_result noh_graph_set_param(noh_graph_state *state, uint32_t param, float value);
float noh_graph_param(const noh_graph_state *state, uint32_t param);

/* The state that a machine is in or fades to, as a child of its node: of a MACHINE its state, of a SELECT the child
 * chosen, of a ONE_SHOT 1 while it plays, until it fades out. `machine` is the node's `index`. */
uint32_t noh_graph_machine_state(const noh_graph_state *state, uint32_t machine);

/* Take transitions, find weights, move time on. The callback may set parameters; changes that it makes to the tracks
 * inside last until the next step.
 * returns  how many events were delivered */
uint32_t noh_graph_step(noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set, uint32_t ticks,
                        noh_event_fn fn, void *user);

/* The two halves of a step, for whom plays other things beside a graph and wants all keys in the order of time:
 * _decide takes transitions and finds the weights of the next `ticks`; then noh_controller_step moves the controller
 * inside by so many, in as many pieces as you like. */
void noh_graph_decide(noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set, uint32_t ticks);

/* Root displacement since the last call, weighted as joint 0 of the pose is: blends by their weights, a MASK or a
 * ONE_SHOT by its mask at joint 0, and what ADD adds does not count; nor do clips that animate no joints. Zero without
 * set->roots. All roots of a set must have the same up axis. */
noh_root_pose noh_graph_root_motion(noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set);

/* Check a block from outside, such as a saved game, before any other call: with one that passes no call overruns its
 * memory, overflows or hangs.
 * errors  ARG memory NULL or misaligned; DATA not an instance of this graph and set (where: the machine, track or
 *         change) */
noh_result noh_graph_state_check(const void *memory, size_t bytes, const noh_graph *graph, const noh_clip_set *set,
                                 noh_error *error);

/* ---- poses ---- */

/* Working memory of posing: no state, so one serves all instances of a graph that are posed one after another. */
typedef struct noh_graph_scratch {
    noh_pose_scratch pose;
    noh_transform *poses[NOH_GRAPH_BUFFERS_MAX];
    float *float_poses[NOH_GRAPH_BUFFERS_MAX];
} noh_graph_scratch;

/* Exact bytes of a scratch for a checked graph (0 for a set over NOH_JOINTS_MAX or NOH_FLOATS_MAX), and a scratch in
 * memory[bytes], aligned to NOH_MEMORY_ALIGN.
 * errors  ARG such a set, or memory NULL or misaligned; MEMORY need: the bytes */
size_t noh_graph_scratch_size(const noh_graph *graph, const noh_clip_set *set);
noh_result noh_graph_scratch_init(void *memory, size_t bytes, const noh_graph *graph, const noh_clip_set *set,
                                  noh_graph_scratch *scratch, noh_error *error);

/* The present pose. It begins the inertial transitions of the last step; a step that is not posed before the next one
 * switches without inertia.
 * shapes  pose[joint_count], floats[float_count] of the set */
void noh_graph_pose(noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set, noh_graph_scratch *scratch,
                    noh_transform *pose, float *floats);

/* The pose `ago` ticks before now: all clips were where they were then, had they had their present weights and speeds.
 * Begin what noh_graph_pose would begin by calling that first. */
void noh_graph_pose_ago(const noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set,
                        noh_graph_scratch *scratch, int64_t ago, noh_transform *pose, float *floats);

#ifdef __cplusplus
}
#endif

#endif
