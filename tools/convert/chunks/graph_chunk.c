/* graph_chunk.c: animation graphs, of a text. */
#include "chunk_maker.h"

#include "convert/pack/pack_graph.h"

/* The graphs, and whether the inputs have what they name. */
static int read_graphs(const convert_options *options, const source *s, void **made, convert_failure *failure)
{
    graph_file *graphs = NULL;
    if (!options->texts[NOH_CHUNK_GRAPH]) return 0;
    failure->file = options->texts[NOH_CHUNK_GRAPH];
    const int failed = graph_text_read(options->texts[NOH_CHUNK_GRAPH], &graphs, &failure->line, &failure->error) ||
                       graph_text_bind(graphs, s->sets, s->set_count, &failure->line, &failure->error);
    *made = graphs;
    if (!failed && graph_text_warn(graphs, s->sets, s->set_count, options->clip.check_loops,
                                   options->texts[NOH_CHUNK_GRAPH], s->m)) {
        return model_fail_memory(&failure->error);
    }
    return failed;
}

static void write_graphs(pack_writer *w, const void *made)
{
    const graph_file *graphs = made;
    for (uint32_t i = 0; graphs && i < graphs->count; i++) {
        chunk_begin(w, NOH_CHUNK_GRAPH, graphs->graphs[i]->name);
        pack_graph(graphs->graphs[i], &w->strings, &w->out);
        chunk_end(w);
    }
}

static void free_graphs(void *made)
{
    graph_text_free(made);
}

const chunk_maker chunk_graph = { read_graphs, 0, free_graphs, write_graphs, pack_check_graphs };
