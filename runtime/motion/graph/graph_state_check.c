/* graph_state_check.c: checks that a block of bytes is an instance of a graph. */
#include "motion/graph/graph_state_internal.h"

#include "core/base/arena_internal.h"
#include "core/base/assert_internal.h"
#include "motion/anim/controller_internal.h"
#include "motion/graph/graph_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/graph.h"
#include "core/base/math_internal.h"

static const char *bad_head(const noh_graph_state *s, const noh_graph_state *made, size_t bytes)
{
    if (bytes < made->bytes || s->bytes != made->bytes) return "graph: its size does not match its counts";
    if (s->node_count != made->node_count || s->param_count != made->param_count ||
        s->machine_count != made->machine_count)
        return "graph: the instance was made with another graph";
    return s->params_offset != made->params_offset || s->machines_offset != made->machines_offset ||
                   s->controller_offset != made->controller_offset
               ? "graph: bad offset of a table"
               : NULL;
}

static const char *bad_machine(const noh_graph_node *n, const noh_machine *m)
{
    const uint32_t states = n->child_count;
    if (m->current >= states || (m->previous != NOH_GRAPH_NONE && m->previous >= states))
        return "graph: a machine is in a state that it does not have";
    if (m->curve > NOH_CURVE_SMOOTHSTEP || m->switched > 1u) return "graph: a machine has a bad curve or flag";
    return m->previous != NOH_GRAPH_NONE && (m->duration == 0 || m->elapsed > m->duration)
               ? "graph: a machine's fade is past its end"
               : NULL;
}

static noh_result check_machines(const noh_graph_state *s, const noh_graph *g, noh_error *error)
{
    const noh_machine *machines = noh_graph_machines_of(s);
    for (uint32_t i = 0; i < g->node_count; i++) {
        const noh_graph_node *n = &g->nodes[i];
        const char *what = noh_graph_is_machine(n->kind) ? bad_machine(n, &machines[n->index]) : NULL;
        if (what) return noh_fail(error, NOH_ERR_DATA, what, n->index, 0);
    }
    for (uint32_t i = 0; i < g->param_count; i++) {
        if (!noh_is_finite(noh_graph_params_of(s)[i]))
            return noh_fail(error, NOH_ERR_DATA, "graph: a parameter is not finite", i, 0);
    }
    return NOH_OK;
}

noh_result noh_graph_state_check(const void *memory, size_t bytes, const noh_graph *graph, const noh_clip_set *set,
                                 noh_error *error)
{
    const noh_graph_state *s = memory;
    noh_graph_state made;
    noh_result result = noh_arena_check(memory, 0, error);
    const char *what;
    NOH_ASSERT(graph && set);
    if (result != NOH_OK) {
        return result;
    }
    noh_graph_state_head(graph, set, &made);
    what = bytes < sizeof *s ? "graph: too few bytes" : bad_head(s, &made, bytes);
    if (what) {
        return noh_fail(error, NOH_ERR_DATA, what, 0, 0);
    }
    result = check_machines(s, graph, error);
    if (result == NOH_OK) {
        result = noh_controller_check((const uint8_t *)memory + s->controller_offset,
                                      s->params_offset - s->controller_offset, set, error);
    }
    if (result == NOH_OK && noh_graph_controller_of(s)->track_count != graph->clip_count) {
        return noh_fail(error, NOH_ERR_DATA, "graph: its controller does not have one track per clip", 0,
                        graph->clip_count);
    }
    return result == NOH_OK && s->inertia_ticks && !noh_graph_controller_of(s)->inertia_offset
               ? noh_fail(error, NOH_ERR_DATA, "graph: an inertial transition runs without room for one", 0, 0)
               : result;
}
