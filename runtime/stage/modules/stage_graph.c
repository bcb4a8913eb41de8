/* stage_graph.c: the graphs of a kind: which, how many bytes, made, and their names. */
#include <string.h>

#include "core/base/arena_internal.h"
#include "core/base/assert_internal.h"
#include "motion/graph/graph_pack_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/graph.h"
#include "noh/low_core.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "core/base/name_internal.h"
#include "stage/modules/stage_graph_internal.h"

/* ---- which ---- */

typedef struct graph_list {
    const noh_pack *packs[NOH_STAGE_GRAPHS_MAX];
    uint32_t indices[NOH_STAGE_GRAPHS_MAX];
    uint32_t count; /* of named graphs; may exceed NOH_STAGE_GRAPHS_MAX */
} graph_list;

static const char *name_at(const noh_pack *pack, uint32_t graph)
{
    return noh_pack_chunk_name(pack, pack->runs[NOH_CHUNK_GRAPH].first + graph);
}

static uint32_t pack_count(const noh_kind_desc *d)
{
    return d->clip_packs ? d->clip_pack_count : 1u;
}

static const noh_pack *pack_at(const noh_kind_desc *d, uint32_t i)
{
    return d->clip_packs ? d->clip_packs[i] : d->clips;
}

/* A graph of the same name in a later pack replaces it, as with clips. */
static int is_replaced(const noh_kind_desc *d, uint32_t pack, const char *name)
{
    for (uint32_t i = pack + 1u; i < pack_count(d); i++) {
        if (noh_pack_graph_find(pack_at(d, i), name) != NOH_NONE) return 1;
    }
    return 0;
}

static int is_listed(const graph_list *list, const char *name)
{
    for (uint32_t i = 0; i < list->count && i < NOH_STAGE_GRAPHS_MAX; i++) {
        if (noh_names_equal(name_at(list->packs[i], list->indices[i]), name)) return 1;
    }
    return 0;
}

static int add_matches(const noh_kind_desc *d, const noh_stage_word *word, graph_list *list)
{
    int found = 0;
    for (uint32_t p = 0; p < pack_count(d); p++) {
        const noh_pack *pack = pack_at(d, p);
        for (uint32_t g = 0; g < pack->runs[NOH_CHUNK_GRAPH].count; g++) {
            const char *name = name_at(pack, g);
            if (!noh_stage_word_matches(word, name) || is_replaced(d, p, name)) continue;
            found = 1;
            if (is_listed(list, name)) continue;
            if (list->count < NOH_STAGE_GRAPHS_MAX) {
                list->packs[list->count] = pack;
                list->indices[list->count] = g;
            }
            list->count++;
        }
    }
    return found;
}

static noh_result list_graphs(const noh_kind_desc *d, const char *names, uint32_t kind, graph_list *list,
                              noh_error *error)
{
    const char *at = names;
    noh_stage_word word;
    memset(list, 0, sizeof *list);
    while (noh_stage_next_word(&at, &word)) {
        if (word.takes_out || !add_matches(d, &word, list)) {
            return noh_fail(error, NOH_ERR_NOT_FOUND,
                            "graphs of a kind: a name that no graph of its packs has: noh info lists them", kind, 0);
        }
    }
    return list->count <= NOH_STAGE_GRAPHS_MAX
               ? NOH_OK
               : noh_fail(error, NOH_ERR_LIMIT, "a kind has more graphs than NOH_STAGE_GRAPHS_MAX", kind, list->count);
}

static noh_graph_pack_desc graph_desc(const noh_kind_desc *d, const graph_list *list, uint32_t i,
                                      const noh_clip_set *set)
{
    noh_graph_pack_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.pack = list->packs[i];
    desc.graph = list->indices[i];
    desc.set = set;
    desc.mesh = d->mesh;
    desc.skeleton = d->skeleton;
    return desc;
}

static int is_there(const noh_kind_desc *d, const void *names)
{
    const char *at = names;
    noh_stage_word word;
    (void)d;
    return noh_stage_next_word(&at, &word);
}

static uint32_t count_graphs(const noh_kind_desc *d, const void *names)
{
    graph_list list;
    return list_graphs(d, names, 0, &list, NULL) == NOH_OK ? list.count : 0;
}

/* ---- bytes ---- */

typedef struct tables {
    noh_stage_graphs *shared;
    noh_graph_pack **graphs;
    noh_clip_entry *clips;
    noh_root_track *roots;
    float *errors;
} tables;

/* Tables with a row for each clip of the bank and each graph. */
static size_t carve_tables(noh_arena *arena, uint32_t graphs, uint32_t clips, int has_roots, tables *t)
{
    const size_t rows = (size_t)clips + graphs;
    t->shared = noh_arena_carve(arena, sizeof *t->shared, 16);
    t->graphs = noh_arena_carve(arena, graphs * sizeof *t->graphs, 16);
    t->clips = noh_arena_carve(arena, rows * sizeof *t->clips, 16);
    t->roots = noh_arena_carve(arena, has_roots ? rows * sizeof *t->roots : 0u, 16);
    t->errors = noh_arena_carve(arena, rows * NOH_UPDATE_RATE_COUNT * sizeof *t->errors, 16);
    return noh_aligned(arena->used);
}

/* Two poses of an actor, and what playing a copy ahead and evaluating it takes. */
static size_t scratch_size(const noh_clip_set *set, size_t state_bytes, size_t evaluation_bytes)
{
    return 2u *
               (noh_aligned(set->joint_count * sizeof(noh_transform)) + noh_aligned(set->float_count * sizeof(float))) +
           noh_aligned(state_bytes) + noh_aligned(evaluation_bytes);
}

static noh_result measure(const noh_kind_desc *d, const void *names, const noh_stage_needs *n, noh_module_needs *needs,
                          noh_error *error)
{
    noh_arena arena = noh_arena_measure();
    size_t state_bytes = 0, evaluation_bytes = 0;
    graph_list list;
    tables unused;
    noh_result result = list_graphs(d, names, n->kind, &list, error);
    if (result != NOH_OK) {
        return result;
    }
    if (!n->has_clips) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        "graphs of a kind: none of its packs has clips for them: set clips or clip_packs", n->kind, 0);
    }
    needs->kind_bytes = carve_tables(&arena, list.count, n->shape.clip_count, noh_stage_root_axes(d) != 0, &unused);
    for (uint32_t i = 0; i < list.count && result == NOH_OK; i++) {
        const noh_graph_pack_desc desc = graph_desc(d, &list, i, &n->shape);
        noh_graph_pack_needs own;
        result = noh_graph_pack_measure(&desc, &own, error);
        if (result != NOH_OK) break;
        needs->kind_bytes += noh_aligned(own.bytes);
        state_bytes = own.state_bytes > state_bytes ? own.state_bytes : state_bytes;
        evaluation_bytes = own.scratch_bytes > evaluation_bytes ? own.scratch_bytes : evaluation_bytes;
    }
    needs->actor_bytes = sizeof(noh_stage_graph_slot) + noh_aligned(state_bytes);
    needs->scratch_bytes = scratch_size(&n->shape, state_bytes, evaluation_bytes);
    return result;
}

/* ---- made ---- */

/* The clip that stands for a graph: it never ends, and what no clip of the graph animates is left to others. */
static void add_clip(noh_stage_kind *k, const noh_graph_pack *g, const tables *t)
{
    noh_clip_entry *entry = &t->clips[k->set.clip_count];
    uint32_t lacks = NOH_CLIP_FLOATS_ONLY | NOH_CLIP_JOINTS_ONLY;
    for (uint32_t c = 0; c < g->graph.clip_count; c++) lacks &= g->clips.clips[g->graph.clips[c].clip].flags;
    memset(entry, 0, sizeof *entry);
    entry->duration_ticks = NOH_DURATION_MAX;
    entry->loop = NOH_LOOP_REPEAT;
    entry->flags = lacks;
    if (k->set.roots) memset(&t->roots[k->set.clip_count], 0, sizeof *t->roots);
    k->set.clip_count++;
}

static void join_tables(noh_stage_kind *k, uint32_t graph_count, const tables *t)
{
    const noh_clip_set *clips = &k->bank->clips;
    const size_t row = NOH_UPDATE_RATE_COUNT * sizeof(float);
    memcpy(t->clips, clips->clips, clips->clip_count * sizeof *t->clips);
    k->set.clips = t->clips;
    if (clips->roots) {
        memcpy(t->roots, clips->roots, clips->clip_count * sizeof *t->roots);
        k->set.roots = t->roots;
    }
    memset(t->errors, 0, (clips->clip_count + graph_count) * row);
    if (k->table.update_error_m) {
        memcpy(t->errors, k->table.update_error_m, clips->clip_count * row);
        k->table.update_error_m = t->errors;
    }
}

static noh_result init(noh_stage_kind *k, const void *names, noh_error *error)
{
    uint8_t *at = k->modules[NOH_SLOT_SOURCE].shared;
    noh_arena arena = noh_arena_over(at, SIZE_MAX);
    graph_list list;
    tables t;
    noh_result result = list_graphs(k->desc, names, 0, &list, error);
    if (result != NOH_OK) {
        return result;
    }
    at += carve_tables(&arena, list.count, k->bank->clips.clip_count, noh_stage_root_axes(k->desc) != 0, &t);
    t.shared->count = list.count;
    t.shared->graphs = t.graphs;
    join_tables(k, list.count, &t);
    for (uint32_t i = 0; i < list.count && result == NOH_OK; i++) {
        const noh_graph_pack_desc desc = graph_desc(k->desc, &list, i, &k->bank->clips);
        const size_t bytes = noh_graph_pack_size(&desc, error);
        result = noh_graph_pack_init(at, bytes, &desc, &t.graphs[i], error);
        at += noh_aligned(bytes);
        if (result == NOH_OK) add_clip(k, t.graphs[i], &t);
    }
    noh_stage_wrap(k, &k->set, &t.shared->sampler);
    return result;
}

noh_module noh_graph_module(const char *names)
{
    static const noh_module_type graphs = {
        .slot = NOH_SLOT_SOURCE,
        .kind_name = "graphs",
        .hash = count_graphs,
        .is_there = is_there,
        .measure = measure,
        .init = init,
        .check = noh_stage_check_graph,
        .source = &noh_stage_graph_source,
    };
    return (noh_module){ names ? &graphs : NULL, names };
}

/* ---- names ---- */

/* Parameters and machines are counted through all graphs, one after another. */
static uint32_t count_in(const noh_graph_pack *g, noh_name what)
{
    return what == NOH_NAME_PARAMETER ? g->graph.param_count : g->graph.machine_count;
}

int noh_stage_in_graph(const noh_stage_kind *k, noh_name what, uint32_t *index, uint32_t *graph)
{
    const noh_stage_graphs *all = noh_stage_graphs_of(k);
    for (uint32_t g = 0; all && g < all->count; g++) {
        const uint32_t count = count_in(all->graphs[g], what);
        if (*index < count) {
            *graph = g;
            return 1;
        }
        *index -= count;
    }
    return 0;
}

uint32_t noh_stage_graph_names(const noh_stage_kind *k, noh_name what)
{
    const noh_stage_graphs *all = noh_stage_graphs_of(k);
    uint32_t count = 0;
    if (!all) return 0;
    if (what == NOH_NAME_GRAPH) return all->count;
    for (uint32_t g = 0; g < all->count; g++) count += count_in(all->graphs[g], what);
    return count;
}

uint32_t noh_stage_find_value(const noh_stage *stage, uint32_t kind, uint32_t parameter, const char *name)
{
    uint32_t graph, index = parameter;
    const noh_stage_kind *k;
    NOH_ASSERT(stage && name && kind < stage->desc.kind_count);
    k = &stage->kinds[kind];
    return noh_stage_in_graph(k, NOH_NAME_PARAMETER, &index, &graph)
               ? noh_graph_pack_find_value(noh_stage_graphs_of(k)->graphs[graph], index, name)
               : NOH_NONE;
}
