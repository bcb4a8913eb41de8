/* graph_desc.c: a graph's text becomes the structs of a graph made in code, which the library checks and lays out. */
#include <stdlib.h>

#include "noh/base.h"
#include "noh/graph.h"
#include "graph_internal.h"

typedef struct description {
    noh_graph_desc d;
    noh_graph_node_desc nodes[NOH_GRAPH_NODES_MAX];
    const char *children[NOH_GRAPH_NODES_MAX][NOH_GRAPH_CHILDREN_MAX];
    float points[NOH_GRAPH_NODES_MAX][2 * NOH_GRAPH_CHILDREN_MAX];
    noh_graph_transition_desc transitions[NOH_GRAPH_TRANSITIONS_MAX];
    noh_graph_param_desc params[NOH_GRAPH_PARAMS_MAX];
    noh_graph_mask_desc masks[NOH_MASKS_MAX];
    const char *values[NOH_GRAPH_NAMES_MAX];
    noh_graph_joint_desc joints[NOH_GRAPH_NAMES_MAX];
} description;

static void describe_node(const graph_def *g, uint32_t index, description *d)
{
    const graph_node *from = &g->nodes[index];
    noh_graph_node_desc *to = &d->nodes[index];
    const uint32_t width = from->kind == NOH_NODE_SPACE_2D ? 2 : 1;
    to->name = from->name;
    to->kind = (noh_node_kind)from->kind;
    to->children = d->children[index];
    to->child_count = from->child_count;
    to->points = d->points[index];
    for (uint32_t i = 0; i < from->child_count; ++i) {
        d->children[index][i] = from->children[i].node.name;
        for (uint32_t k = 0; k < width; ++k) d->points[index][width * i + k] = from->children[i].at[k];
    }
    to->param = from->by[0].name;
    to->param_y = from->by[1].name;
    to->value = from->value;
    to->mask = from->mask.name;
    to->clip = from->reference ? g->names[from->reference - 1].name : from->clip;
    to->sync = from->sync;
    to->speed = from->speed;
    to->start_tick = from->start_tick;
    to->loop = (noh_loop)from->loop;
    to->paused = from->paused;
    to->transitions = d->transitions + from->first_transition;
    to->transition_count = from->transition_count;
    to->curve = (noh_curve)from->curve;
    to->flags = from->flags;
    to->fade_ticks = from->fade_ticks;
    to->fade_out_ticks = from->fade_out_ticks;
}

static void describe_transition(const graph_transition *from, noh_graph_transition_desc *to)
{
    to->from = from->from.name;
    to->to = from->to.name;
    to->condition = (noh_condition)from->condition;
    to->param = from->param.name;
    to->threshold = from->threshold;
    to->duration_ticks = from->duration_ticks;
    to->curve = (noh_curve)from->curve;
    to->flags = from->flags;
}

static void describe(const graph_def *g, description *d)
{
    d->d.name = g->name;
    d->d.nodes = d->nodes;
    d->d.params = d->params;
    d->d.masks = d->masks;
    d->d.node_count = g->node_count;
    d->d.param_count = g->param_count;
    d->d.mask_count = g->mask_count;
    for (uint32_t i = 0; i < g->node_count; ++i) describe_node(g, i, d);
    for (uint32_t i = 0; i < g->transition_count; ++i) describe_transition(&g->transitions[i], &d->transitions[i]);
    for (uint32_t i = 0; i < g->name_count; ++i) {
        d->values[i] = d->joints[i].joint = g->names[i].name;
        d->joints[i].weight = (uint8_t)g->names[i].weight;
        d->joints[i].subtree = (uint8_t)g->names[i].subtree;
    }
    for (uint32_t i = 0; i < g->param_count; ++i) {
        const graph_param *p = &g->params[i];
        d->params[i] = (noh_graph_param_desc){ p->name,    p->kind, p->minimum,    p->maximum,
                                               p->initial, NULL,    p->value_count };
        d->params[i].values = d->values + p->first_value;
    }
    for (uint32_t i = 0; i < g->mask_count; ++i) {
        const graph_mask *m = &g->masks[i];
        d->masks[i] = (noh_graph_mask_desc){ m->name, d->joints + m->first_joint, m->joint_count, (uint8_t)m->floats };
    }
}

int graph_make(graph_reader *r, graph_def *g)
{
    noh_error why = { NOH_ERR_MEMORY, "there is not enough memory to read this file", 0, 0 };
    description *d = calloc(1, sizeof *d);
    size_t bytes;
    int failed = 1;
    if (d) {
        describe(g, d);
        bytes = noh_graph_size(&d->d);
        g->bytes = malloc(bytes ? bytes : 1);
        failed = !g->bytes || noh_graph_init(g->bytes, bytes, &d->d, &g->pack, &why) != NOH_OK;
    }
    free(d);
    return failed
               ? graph_fail(r,
                            why.result == NOH_ERR_ARG && why.where < g->node_count ? g->nodes[why.where].line : g->line,
                            "%.200s", why.what)
               : 0;
}
