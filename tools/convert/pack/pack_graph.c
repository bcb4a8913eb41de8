#include "pack_graph.h"

#include <string.h>

#include "noh/format.h"
#include "noh/pack.h"

/* The names that an array's records begin with, of the graph's own pack, become names of this one. */
static void rename_records(const noh_pack *from, string_table *strings, uint8_t *records, uint32_t count, size_t stride)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t name;
        memcpy(&name, records + i * stride, sizeof name);
        name = string_offset(strings, noh_pack_string(from, name));
        memcpy(records + i * stride, &name, sizeof name);
    }
}

void pack_graph(const graph_def *g, string_table *strings, byte_buffer *out)
{
    const noh_pack_chunk *chunk = &g->pack.chunks[g->pack.runs[NOH_CHUNK_GRAPH].first];
    const noh_pack_graph_header *h = noh_pack_chunk_at(&g->pack, NOH_CHUNK_GRAPH, 0);
    const size_t base = out->count;
    uint8_t *to;
    buffer_append(out, h, chunk->bytes);
    if (out->failed) return;
    to = (uint8_t *)out->bytes + base;
    rename_records(&g->pack, strings, to + h->nodes_offset, h->node_count, sizeof(noh_pack_graph_node));
    rename_records(&g->pack, strings, to + h->clips_offset, h->clip_count, sizeof(noh_pack_graph_clip));
    rename_records(&g->pack, strings, to + h->params_offset, h->param_count, sizeof(noh_pack_graph_param));
    rename_records(&g->pack, strings, to + h->masks_offset, h->mask_count, sizeof(noh_pack_graph_mask));
    rename_records(&g->pack, strings, to + h->names_offset, h->name_count, sizeof(noh_pack_graph_name));
}
