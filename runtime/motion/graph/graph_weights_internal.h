/* graph_weights_internal.h (private to graph/): the weight of every node of a graph. */
#ifndef NOH_GRAPH_GRAPH_WEIGHTS_INTERNAL_H
#define NOH_GRAPH_GRAPH_WEIGHTS_INTERNAL_H

#include "motion/graph/graph_internal.h"
#include "noh/clip.h"
#include "noh/graph.h"
#include "noh/low_motion.h"

/* Compute the weights of clips along one parameter.
 * shapes  thresholds[count] increasing, weights[count]
 * ranges  |thresholds| <= NOH_BLEND_SPACE_COORDINATE_MAX; x is clamped to the first and last threshold, NaN counts as
 *         the first */
void noh_blend_space_1d_weights(uint32_t count, const float *thresholds, float x, float *weights);

typedef struct noh_graph_view {
    const noh_graph *graph;
    const float *params;
    const noh_machine *machines;
    int before; /* 1: the state before the inertial transitions that begin with the next pose */
} noh_graph_view;

const noh_controller *noh_graph_controller_of(const noh_graph_state *state);
const float *noh_graph_params_of(const noh_graph_state *state);
const noh_machine *noh_graph_machines_of(const noh_graph_state *state);

/* Whether nodes of a kind keep a noh_machine. */
static inline int noh_graph_is_machine(uint32_t kind)
{
    return kind == NOH_NODE_MACHINE || kind == NOH_NODE_SELECT || kind == NOH_NODE_ONE_SHOT;
}

/* Nodes in an array with a stride: nodes in packs begin with their names. */
typedef struct noh_graph_nodes {
    const uint8_t *first; /* a noh_graph_node */
    size_t stride;
    uint32_t count;
} noh_graph_nodes;

static inline const noh_graph_node *noh_graph_node_at(const noh_graph_nodes *nodes, uint32_t i)
{
    return (const noh_graph_node *)(const void *)(nodes->first + i * nodes->stride);
}

/* noh_graph_buffers for nodes that were checked. */
uint32_t noh_graph_count_buffers(const noh_graph_nodes *nodes, const uint16_t *children);

/* Whether any change of state may be inertial, so that instances and scratches need room for it. */
int noh_graph_is_inertial(const noh_graph *graph);

/* The inputs for the sizes of instances and scratches. */
typedef struct noh_graph_shape {
    uint32_t clip_count, param_count, machine_count, buffer_count;
    int inertial;
} noh_graph_shape;

noh_graph_shape noh_graph_shape_of(const noh_graph *graph); /* of a checked graph */
size_t noh_graph_shape_state_size(const noh_graph_shape *shape, const noh_clip_set *set);
size_t noh_graph_shape_scratch_size(const noh_graph_shape *shape, const noh_clip_set *set);

/* Get a node's t or x. */
float noh_graph_amount(const noh_graph_view *view, const noh_graph_node *node);

/* Compute the weight of each child in its node. ADD and MASK: 1 and t.
 * shapes  local[child_count] */
void noh_graph_child_weights(const noh_graph_view *view, const noh_graph_node *node, float *local);

/* Compute the products of these weights from the root down, and which nodes are in play: all except nodes in inactive
 * states of a machine.
 * shapes  weights[node_count], active[node_count] */
void noh_graph_weights(const noh_graph_view *view, float *weights, uint8_t *active);

/* The first node of a subtree; it is a clip. */
uint32_t noh_graph_first_of(const noh_graph *graph, uint32_t node);

#endif
