/* graph_state_internal.h (private to graph/): functions on an instance shared by graph.c and graph_step.c. */
#ifndef NOH_GRAPH_GRAPH_STATE_INTERNAL_H
#define NOH_GRAPH_GRAPH_STATE_INTERNAL_H

#include "motion/graph/graph_weights_internal.h"
#include "motion/graph/graph_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/graph.h"

float *noh_graph_state_params(noh_graph_state *state);
noh_machine *noh_graph_state_machines(noh_graph_state *state);
noh_graph_view noh_graph_view_of(const noh_graph_state *state, const noh_graph *graph);

/* Fill the head of a new instance of a checked graph. Reads only the counts of the set. */
void noh_graph_state_head(const noh_graph *graph, const noh_clip_set *set, noh_graph_state *head);

/* Get the child selected by a SELECT's parameter. */
uint32_t noh_graph_choice(const noh_graph_state *state, const noh_graph_node *node);

noh_result noh_graph_start_subtree(noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set,
                                   uint32_t node, noh_error *error);
void noh_graph_weigh_tracks(noh_graph_state *state, const noh_graph *graph);

#endif
