/* graph_weights_internal.h (private to graph/): the weight of every node of a graph. */
#ifndef NOH_GRAPH_GRAPH_WEIGHTS_INTERNAL_H
#define NOH_GRAPH_GRAPH_WEIGHTS_INTERNAL_H

#include "graph/graph.h"

typedef struct noh_graph_view {
    const noh_graph *graph;
    const float *params;
    const noh_machine *machines;
    int before; /* 1: as it was before the inertial transitions that begin with the next pose */
} noh_graph_view;

const float *noh_graph_params_of(const noh_graph_state *state);
const noh_machine *noh_graph_machines_of(const noh_graph_state *state);

/* Whether nodes of a kind keep a noh_machine. */
static inline int noh_graph_is_machine(uint32_t kind)
{
    return kind == NOH_NODE_MACHINE || kind == NOH_NODE_SELECT || kind == NOH_NODE_ONE_SHOT;
}

/* Whether any change of state may be inertial, so that instances and scratches need room for it. */
int noh_graph_is_inertial(const noh_graph *graph);

/* A node's t or x. */
float noh_graph_amount(const noh_graph_view *view, const noh_graph_node *node);

/* The weight of each child in its node. ADD and MASK: 1 and t.
 * shapes  local[child_count] */
void noh_graph_child_weights(const noh_graph_view *view, const noh_graph_node *node, float *local);

/* The products of these weights from the root down, and which nodes are in play: all but those in states that their
 * machine is not in.
 * shapes  weights[node_count], active[node_count] */
void noh_graph_weights(const noh_graph_view *view, float *weights, uint8_t *active);

/* The first node of a subtree; it is a clip. */
uint32_t noh_graph_first_of(const noh_graph *graph, uint32_t node);

#endif
