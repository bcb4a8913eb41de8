/* pack_graph_check.c: the graphs of a finished pack, bound to its clips as a game binds them. */
#include <stdio.h>
#include <stdlib.h>

#include "motion/graph/graph_pack_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/graph.h"
#include "noh/pack.h"
#include "pack_graph.h"

/* Reports the error of a graph. */
static int refuse(const noh_pack_graph *g, const noh_error *why, model_error *error)
{
    const char *node = why->result == NOH_ERR_DATA && why->where < g->header->node_count
                           ? noh_pack_string(g->pack, g->nodes[why->where].name)
                           : "";
    snprintf(error->where, sizeof error->where, "graph '%.50s'%s%.50s%s", g->name, *node ? ", node '" : "", node,
             *node ? "'" : "");
    snprintf(error->what, sizeof error->what, "%s", why->what);
    return 1;
}

static int bind_graph(const noh_pack *pack, const noh_clip_bank *bank, uint32_t skeleton, uint32_t index,
                      noh_error *why)
{
    noh_graph_pack_desc desc = { pack, index, &bank->clips, pack, skeleton };
    noh_graph_pack *made;
    const size_t bytes = noh_graph_pack_size(&desc, why);
    void *memory = bytes ? malloc(bytes) : NULL;
    noh_result result = memory ? noh_graph_pack_init(memory, bytes, &desc, &made, why) : NOH_ERR_MEMORY;
    free(memory);
    return result != NOH_OK;
}

/* The clips of a skeleton; NULL where there are none that fit. */
static noh_clip_bank *open_bank(const noh_pack *pack, uint32_t skeleton, noh_error *why)
{
    noh_clip_bank_desc desc = { .clips = pack, .skeleton = skeleton, .cached_segment_count = 2 };
    noh_clip_bank *bank = NULL;
    const size_t bytes = noh_clip_bank_size(&desc, why);
    void *memory = bytes ? malloc(bytes) : NULL;
    if (!memory || noh_clip_bank_init(memory, bytes, &desc, &bank, why)) {
        free(memory);
        return NULL;
    }
    return bank;
}

int pack_check_graphs(const noh_pack *pack, model_error *error)
{
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_GRAPH].count; i++) {
        noh_error why = { NOH_OK, "", 0, 0 };
        noh_pack_graph g;
        int failed = 1;
        if (noh_pack_graph_at(pack, i, &g, &why)) {
            return model_fail(error, "",
                              "the built graph does not open: %s (byte %llu); this is a bug in noh: please report it",
                              why.what, (unsigned long long)why.where);
        }
        for (uint32_t s = 0;
             s < (pack->runs[NOH_CHUNK_SKELETON].count ? pack->runs[NOH_CHUNK_SKELETON].count : 1u) && failed; s++) {
            noh_clip_bank *bank = open_bank(pack, s, &why);
            failed = !bank || bind_graph(pack, bank, s, i, &why);
            free(bank);
        }
        if (failed) return refuse(&g, &why, error);
    }
    return 0;
}
