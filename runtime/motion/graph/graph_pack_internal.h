/* graph_pack_internal.h: the private part of low_motion.h. */
#ifndef NOH_GRAPH_GRAPH_PACK_INTERNAL_H
#define NOH_GRAPH_GRAPH_PACK_INTERNAL_H

#include "noh/base.h"
#include "noh/graph.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Sizes of a graph and its instances, computed from counts before there are clips. */
typedef struct noh_graph_pack_needs {
    size_t bytes;         /* noh_graph_pack_size */
    size_t state_bytes;   /* noh_graph_state_size */
    size_t scratch_bytes; /* noh_graph_scratch_size */
} noh_graph_pack_needs;

/* Get the sizes of a graph and its instances.
 * errors  as noh_graph_pack_size */
noh_result noh_graph_pack_measure(const noh_graph_pack_desc *desc, noh_graph_pack_needs *needs, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
