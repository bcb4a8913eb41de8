/* pack_graph.h: the chunk of an animation graph. */
#ifndef NOH_CONVERT_PACK_PACK_GRAPH_H
#define NOH_CONVERT_PACK_PACK_GRAPH_H

#include "convert/base/byte_buffer.h"
#include "convert/graph/graph_text.h"
#include "noh/pack.h"

/* Append the bytes of a graph's chunk. */
void pack_graph(const graph_def *g, string_table *strings, byte_buffer *out);

/* Bind every graph of a finished pack to its clips, as a game does: a graph that the runtime would refuse is an error.
 * 0, or 1 and a filled error. */
int pack_check_graphs(const noh_pack *pack, model_error *error);

#endif
