/* graph_state_internal.h (private to graph/): the parts of an instance that graph.c makes and graph_step.c changes. */
#ifndef NOH_GRAPH_GRAPH_STATE_INTERNAL_H
#define NOH_GRAPH_GRAPH_STATE_INTERNAL_H

#include "motion/graph/graph_weights_internal.h"

float *noh_graph_state_params(noh_graph_state *state);
noh_machine *noh_graph_state_machines(noh_graph_state *state);
noh_graph_view noh_graph_view_of(const noh_graph_state *state, const noh_graph *graph);

/* The head of a new instance of a checked graph. Of the set only the counts are read. */
void noh_graph_state_head(const noh_graph *graph, const noh_clip_set *set, noh_graph_state *head);

/* The child that a SELECT's parameter asks for. */
uint32_t noh_graph_choice(const noh_graph_state *state, const noh_graph_node *node);

noh_result noh_graph_start_subtree(noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set,
                                   uint32_t node, noh_error *error);
void noh_graph_weigh_tracks(noh_graph_state *state, const noh_graph *graph);

#endif
