/* stage_graph_internal.h: the graphs of a kind and of its actors, a module of the stage. */
#ifndef NOH_STAGE_STAGE_GRAPH_INTERNAL_H
#define NOH_STAGE_STAGE_GRAPH_INTERNAL_H

#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/graph.h"
#include "noh/noh.h"
#include "stage/cast/stage_internal.h"

#ifdef __cplusplus
extern "C" {
#endif

/* State of an actor: the graph that it plays. Its instance follows, in as many bytes as the largest of the kind takes.
 * A track of the actor's controller stands for it: graph g plays while one is on clip noh_stage_clip_count + g. */
typedef struct noh_stage_graph_slot {
    uint32_t graph; /* 1 + index in the kind's; 0: none was played yet */
    uint32_t reserved[3];
} noh_stage_graph_slot;

NOH_STATIC_ASSERT(sizeof(noh_stage_graph_slot) == 16, stage_graph_slot);

/* What a kind's actors share. */
typedef struct noh_stage_graphs {
    uint32_t count;
    noh_graph_pack **graphs;   /* [count] */
    noh_stage_sampler sampler; /* of the kind's set */
} noh_stage_graphs;

/* NULL: the kind has no graphs. */
static inline const noh_stage_graphs *noh_stage_graphs_of(const noh_stage_kind *k)
{
    return k->modules[NOH_SLOT_SOURCE].shared;
}

/* What an actor plays. graph NULL: none. */
typedef struct noh_stage_playing {
    const noh_graph_pack *graph;
    noh_graph_state *state;
    const noh_track *track; /* of the actor's controller */
} noh_stage_playing;

noh_stage_playing noh_stage_playing_of(const noh_stage_kind *k, uint32_t index);
/* From now on a set samples through `sampler`: what it sampled before, and the poses that are made for graphs. */
void noh_stage_wrap(const noh_stage_kind *k, noh_clip_set *set, noh_stage_sampler *sampler);
/* Which graph an index of a parameter or machine belongs to; *index becomes that in the graph. 0: past the last. */
int noh_stage_in_graph(const noh_stage_kind *k, noh_name what, uint32_t *index, uint32_t *graph);
uint32_t noh_stage_graph_names(const noh_stage_kind *k, noh_name what); /* how many */
noh_result noh_stage_check_graph(const noh_stage_kind *k, const void *slot, noh_error *error);

extern const noh_source_type noh_stage_graph_source;

#ifdef __cplusplus
}
#endif

#endif
