/* dump_graph.h: the animation graph of a pack as the text that `noh build --graph` reads. */
#ifndef NOH_NOH_DUMP_DUMP_GRAPH_H
#define NOH_NOH_DUMP_DUMP_GRAPH_H

#include "convert/base/byte_buffer.h"
#include "noh/graph.h"

/* Append the text; built again, it gives the same chunk. */
void dump_graph(byte_buffer *out, const noh_pack_graph *g);

#endif
