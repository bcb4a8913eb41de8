#include "info_graph.h"

#include <stdio.h>

#include "cli/message.h"

static const char *const kinds[] = {
    "clip", "blend", "add", "layer", "space", "space", "machine", "select", "one-shot"
};

static const char *text_of(const noh_pack_graph *g, uint32_t name)
{
    return noh_pack_string(g->pack, name);
}

static void print_param(const noh_pack_graph *g, const noh_pack_graph_param *p)
{
    printf("  parameter '%s': ", text_of(g, p->name));
    if (p->kind == NOH_PARAM_TRIGGER) {
        printf("a trigger\n");
    } else if (p->kind == NOH_PARAM_ENUM) {
        for (uint32_t i = 0; i < p->value_count; i++) {
            printf("%s%s", i ? ", " : "", text_of(g, g->names[p->first_value + i].name));
        }
        printf("; initially %s\n", text_of(g, g->names[p->first_value + (uint32_t)p->initial].name));
    } else {
        printf("%.6g to %.6g%s; initially %.6g\n", (double)p->minimum, (double)p->maximum,
               p->kind == NOH_PARAM_INTEGER ? ", whole" : "", (double)p->initial);
    }
}

/* The parameters that a node follows, and its mask. */
static void print_inputs(const noh_pack_graph *g, const noh_pack_graph_node *n)
{
    if (n->param != NOH_PACK_GRAPH_NONE) {
        printf(n->kind == NOH_PACK_NODE_ONE_SHOT ? " on '%s'" : " by '%s'", text_of(g, g->params[n->param].name));
    }
    if (n->param_y != NOH_PACK_GRAPH_NONE) printf(" and '%s'", text_of(g, g->params[n->param_y].name));
    if (n->mask) printf(", mask '%s'", text_of(g, g->masks[n->mask - 1u].name));
    if (n->kind == NOH_PACK_NODE_ADD && n->item_count) {
        printf(", relative to '%s'", text_of(g, g->names[n->first_item].name));
    }
    if (n->kind == NOH_PACK_NODE_MACHINE) printf(", %u transition%s", n->item_count, plural(n->item_count));
    if (n->kind == NOH_PACK_NODE_CLIP) {
        const noh_pack_graph_clip *c = &g->clips[n->index];
        printf(" '%s'", text_of(g, c->name));
        if (c->speed != NOH_SPEED_ONE) printf(" at speed %.4g", (double)c->speed / NOH_SPEED_ONE);
        if (c->sync_group) printf(", in step with group %u", c->sync_group);
    }
}

/* Not deeper than a graph has nodes: the checker of packs has seen that it is a tree. */
static void print_node(const noh_pack_graph *g, uint32_t index, int depth)
{
    const noh_pack_graph_node *n = &g->nodes[index];
    printf("  %*s%s '%s'", 2 * depth, "", kinds[n->kind], text_of(g, n->name));
    print_inputs(g, n);
    printf("\n");
    for (uint32_t i = 0; i < n->child_count; i++) {
        print_node(g, g->children[n->first_child + i], depth + 1);
    }
}

int info_print_graph(const pack_file *file, uint32_t index)
{
    noh_pack_graph g;
    const noh_pack_graph_header *h;
    noh_error error = { NOH_OK, "", 0, 0 };
    if (noh_pack_graph_at(&file->pack, index, &g, &error)) {
        return tool_fail_error(file->path, &error);
    }
    h = g.header;
    printf("graph '%s': %u node%s, %u clip%s, %u parameter%s, %u mask%s, %u transition%s\n", g.name, h->node_count,
           plural(h->node_count), h->clip_count, plural(h->clip_count), h->param_count, plural(h->param_count),
           h->mask_count, plural(h->mask_count), h->transition_count, plural(h->transition_count));
    for (uint32_t i = 0; i < h->param_count; i++) {
        print_param(&g, &g.params[i]);
    }
    print_node(&g, h->node_count - 1u, 0);
    return 0;
}

static void json_param(json *j, const noh_pack_graph *g, const noh_pack_graph_param *p)
{
    static const char *const names[] = { "number", "integer", "enum", "trigger" };
    json_open(j, NULL, '{');
    json_text(j, "name", text_of(g, p->name));
    json_text(j, "kind", names[p->kind]);
    json_number(j, "min", (double)p->minimum);
    json_number(j, "max", (double)p->maximum);
    json_number(j, "initial", (double)p->initial);
    json_open(j, "values", '[');
    for (uint32_t i = 0; i < p->value_count; i++) {
        json_text(j, NULL, text_of(g, g->names[p->first_value + i].name));
    }
    json_close(j, ']');
    json_close(j, '}');
}

static void json_node(json *j, const noh_pack_graph *g, const noh_pack_graph_node *n)
{
    json_open(j, NULL, '{');
    json_text(j, "name", text_of(g, n->name));
    json_text(j, "kind", kinds[n->kind]);
    if (n->kind == NOH_PACK_NODE_CLIP) json_text(j, "clip", text_of(g, g->clips[n->index].name));
    json_open(j, "children", '[');
    for (uint32_t i = 0; i < n->child_count; i++) {
        json_text(j, NULL, text_of(g, g->nodes[g->children[n->first_child + i]].name));
    }
    json_close(j, ']');
    json_close(j, '}');
}

int info_json_graph(json *j, const pack_file *file, uint32_t index)
{
    noh_pack_graph g;
    noh_error error = { NOH_OK, "", 0, 0 };
    if (noh_pack_graph_at(&file->pack, index, &g, &error)) {
        return tool_fail_error(file->path, &error);
    }
    json_open(j, NULL, '{');
    json_text(j, "name", g.name);
    json_open(j, "params", '[');
    for (uint32_t i = 0; i < g.header->param_count; i++) {
        json_param(j, &g, &g.params[i]);
    }
    json_close(j, ']');
    json_open(j, "nodes", '[');
    for (uint32_t i = 0; i < g.header->node_count; i++) {
        json_node(j, &g, &g.nodes[i]);
    }
    json_close(j, ']');
    json_integer(j, "transitions", g.header->transition_count);
    json_integer(j, "masks", g.header->mask_count);
    json_close(j, '}');
    return 0;
}
