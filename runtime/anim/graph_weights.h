/* graph_weights.h (private to anim/): what every node of a graph weighs. */
#ifndef NOH_ANIM_GRAPH_WEIGHTS_H
#define NOH_ANIM_GRAPH_WEIGHTS_H

#include "anim/graph.h"

typedef struct noh_graph_view {
    const noh_graph *graph;
    const float *params;
    const noh_machine *machines;
    int before; /* as it was before the transitions that wait for a pose */
} noh_graph_view;

const float *noh_graph_params_of(const noh_graph_state *state);
const noh_machine *noh_graph_machines_of(const noh_graph_state *state);

/* A node's t or x. */
float noh_graph_amount(const noh_graph_view *view, const noh_graph_node *node);

/* What each child counts in its node: shapes local[child_count]. ADD and MASK: 1 and t. */
void noh_graph_child_weights(const noh_graph_view *view, const noh_graph_node *node, float *local);

/* Products of these from the root down, and which nodes are not shut out by a machine.
 * shapes  weights[node_count], active[node_count] */
void noh_graph_weights(const noh_graph_view *view, float *weights, uint8_t *active);

/* The first node of a subtree; it is a clip. */
uint32_t noh_graph_first_of(const noh_graph *graph, uint32_t node);

#endif
