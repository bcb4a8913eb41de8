/* graph_link.c: resolves the names of a graph. What needs no hint is left to the library (graph_desc.c). */
#include <stdio.h>
#include <string.h>

#include "convert/base/nearest.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_motion.h"
#include "graph_internal.h"

#define LOOP_ONCE 1u /* noh_loop */

/* Where the names of one kind lie: the name is the first field of their records. */
typedef struct name_table {
    const char *kind;
    const void *records;
    size_t stride;
    uint32_t count;
} name_table;

static const char *name_at(const name_table *t, uint32_t i)
{
    const char *name;
    memcpy(&name, (const char *)t->records + i * t->stride, sizeof name);
    return name;
}

static int resolve(graph_reader *r, const name_table *t, graph_ref *ref)
{
    const char *candidates[NOH_GRAPH_NODES_MAX];
    char hint[GRAPH_HINT];
    for (uint32_t i = 0; i < t->count; ++i) {
        candidates[i] = name_at(t, i);
        if (strcmp(candidates[i], ref->name) == 0) {
            ref->index = i;
            return 0;
        }
    }
    return graph_fail(r, ref->line, "there is no %s '%.60s'%s", t->kind, ref->name,
                      graph_hint(ref->name, candidates, t->count, hint));
}

static name_table nodes_of(const graph_def *g)
{
    const name_table t = { "node", g->nodes, sizeof g->nodes[0], g->node_count };
    return t;
}

static name_table params_of(const graph_def *g)
{
    const name_table t = { "parameter", g->params, sizeof g->params[0], g->param_count };
    return t;
}

static name_table masks_of(const graph_def *g)
{
    const name_table t = { "mask", g->masks, sizeof g->masks[0], g->mask_count };
    return t;
}

/* ---- parameters ---- */

static int wants(graph_reader *r, const graph_ref *ref, int suits, const char *what)
{
    return suits ? 0 : graph_fail(r, ref->line, "'%.60s' must be %s here", ref->name, what);
}

/* A select has a child for each value. */
static int check_choice(graph_reader *r, const graph_def *g, const graph_node *n)
{
    const graph_param *p = &g->params[n->by[0].index];
    if (wants(r, &n->by[0], p->kind == NOH_PARAM_ENUM || p->kind == NOH_PARAM_INTEGER, "an enum or an integer"))
        return 1;
    if (p->kind == NOH_PARAM_ENUM && p->value_count != n->child_count)
        return graph_fail(r, n->line, "'%.60s' has %u children, and '%.60s' %u values", n->name, n->child_count,
                          p->name, p->value_count);
    if (p->minimum < 0.0f || p->maximum > (float)(n->child_count - 1u))
        return graph_fail(r, n->line, "'%.60s' has children 0 to %u, and '%.60s' goes from %.9g to %.9g", n->name,
                          n->child_count - 1u, p->name, (double)p->minimum, (double)p->maximum);
    return 0;
}

static int link_params(graph_reader *r, graph_def *g, graph_node *n)
{
    const name_table params = params_of(g);
    for (int i = 0; i < 2; ++i) {
        const graph_param *p;
        if (!n->by[i].name) continue;
        if (resolve(r, &params, &n->by[i])) return 1;
        p = &g->params[n->by[i].index];
        if (n->kind == NOH_PACK_NODE_ONE_SHOT) {
            if (wants(r, &n->by[i], p->kind == NOH_PARAM_TRIGGER, "a trigger")) return 1;
        } else if (n->kind != NOH_PACK_NODE_SELECT) {
            if (wants(r, &n->by[i], p->kind == NOH_PARAM_NUMBER || p->kind == NOH_PARAM_INTEGER, "a number")) return 1;
        }
    }
    return n->kind == NOH_PACK_NODE_SELECT ? check_choice(r, g, n) : 0;
}

/* ---- children ---- */

static int link_children(graph_reader *r, graph_def *g, uint32_t index)
{
    const name_table nodes = nodes_of(g);
    graph_node *n = &g->nodes[index];
    for (uint32_t i = 0; i < n->child_count; ++i) {
        graph_node *child;
        if (resolve(r, &nodes, &n->children[i].node)) return 1;
        child = &g->nodes[n->children[i].node.index];
        if (child->parent != NOH_NONE)
            return graph_fail(r, n->line, "'%.60s' is already a child of '%.60s': define another node", child->name,
                              g->nodes[child->parent].name);
        child->parent = index;
    }
    return 0;
}

/* ---- nodes ---- */

static int check_space(graph_reader *r, const graph_node *n)
{
    for (uint32_t i = 1; i < n->child_count; ++i) {
        if (!(n->children[i].at[0] > n->children[i - 1].at[0]))
            return graph_fail(r, n->line, "coordinates in a blend space must increase: '%.60s' is not above '%.60s'",
                              n->children[i].node.name, n->children[i - 1].node.name);
    }
    return 0;
}

/* The clip that ends a shot: it plays once unless the text says otherwise. */
static int check_one_shot(graph_reader *r, graph_def *g, const graph_node *n)
{
    graph_node *first = &g->nodes[n->children[1].node.index];
    for (uint32_t i = 0; first->child_count && i < g->node_count; ++i) /* circles are refused later */
        first = &g->nodes[first->children[0].node.index];
    if (!first->loop) first->loop = LOOP_ONCE;
    return first->loop == LOOP_ONCE
               ? 0
               : graph_fail(r, n->line, "'%.60s' never ends, so '%.60s' would not end either: give the clip loop=once",
                            first->name, n->name);
}

static int link_state(graph_reader *r, const graph_node *machine, graph_ref *ref)
{
    const name_table states = { "state", machine->children, sizeof machine->children[0], machine->child_count };
    return ref->name ? resolve(r, &states, ref) : 0;
}

static int link_transition(graph_reader *r, graph_def *g, graph_transition *t)
{
    const name_table params = params_of(g);
    const graph_node *machine = &g->nodes[t->machine];
    if (link_state(r, machine, &t->from) || link_state(r, machine, &t->to)) return 1;
    if (t->from.name && t->from.index == t->to.index)
        return graph_fail(r, t->to.line, "a transition from '%.60s' to itself", t->to.name);
    if (!t->param.name) return 0;
    if (resolve(r, &params, &t->param)) return 1;
    return wants(r, &t->param, (g->params[t->param.index].kind == NOH_PARAM_TRIGGER) == (t->condition == 2),
                 t->condition == 2 ? "a trigger, or above or below a number," : "a number, an integer or an enum");
}

static int link_node(graph_reader *r, graph_def *g, uint32_t index)
{
    const name_table masks = masks_of(g);
    graph_node *n = &g->nodes[index];
    return link_children(r, g, index) || link_params(r, g, n) || (n->mask.name && resolve(r, &masks, &n->mask));
}

int graph_link(graph_reader *r, graph_def *g)
{
    if (!g->node_count) return graph_fail(r, g->line, "the graph '%.60s' has no nodes", g->name);
    for (uint32_t i = 0; i < g->node_count; ++i)
        if (link_node(r, g, i)) return 1;
    for (uint32_t i = 0; i < g->transition_count; ++i)
        if (link_transition(r, g, &g->transitions[i])) return 1;
    for (uint32_t i = 0; i < g->node_count; ++i) {
        const graph_node *n = &g->nodes[i];
        if (n->kind == NOH_PACK_NODE_SPACE_1D && check_space(r, n)) return 1;
        if (n->kind == NOH_PACK_NODE_ONE_SHOT && check_one_shot(r, g, n)) return 1;
    }
    return 0;
}
