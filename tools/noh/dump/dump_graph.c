#include "dump_graph.h"

#include <string.h>
#include "noh/low_motion.h"

/* A name as a word of its own: in quotes where it would not be read as one. */
static void put_text(byte_buffer *out, const char *text)
{
    const int quoted = !*text || *text == '#' || strpbrk(text, " \t=") != NULL;
    buffer_print(out, quoted ? " \"%s\"" : " %s", text);
}

static void put_name(byte_buffer *out, const noh_pack_graph *g, uint32_t name)
{
    put_text(out, noh_pack_string(g->pack, name));
}

static double seconds(uint32_t ticks)
{
    return (double)ticks / NOH_TICKS_PER_SECOND;
}

static const char *param_name(const noh_pack_graph *g, uint32_t param)
{
    return noh_pack_string(g->pack, g->params[param].name);
}

/* ---- parameters, masks ---- */

static void put_param(byte_buffer *out, const noh_pack_graph *g, const noh_pack_graph_param *p)
{
    static const char *const kinds[] = { "number", "integer", "enum", "trigger" };
    buffer_print(out, "%s", kinds[p->kind]);
    put_name(out, g, p->name);
    if (p->kind <= NOH_PARAM_INTEGER) {
        buffer_print(out, " %.9g %.9g initial=%.9g", (double)p->minimum, (double)p->maximum, (double)p->initial);
    }
    for (uint32_t i = 0; i < p->value_count; i++) {
        put_name(out, g, g->names[p->first_value + i].name);
    }
    if (p->kind == NOH_PARAM_ENUM) {
        buffer_print(out, " initial=%s",
                     noh_pack_string(g->pack, g->names[p->first_value + (uint32_t)p->initial].name));
    }
    buffer_print(out, "\n");
}

static void put_mask(byte_buffer *out, const noh_pack_graph *g, const noh_pack_graph_mask *m)
{
    buffer_print(out, "mask");
    put_name(out, g, m->name);
    buffer_print(out, " floats=%.6g\n", m->floats / 255.0);
    for (uint32_t i = 0; i < m->joint_count; i++) {
        const noh_pack_graph_name *joint = &g->names[m->first_joint + i];
        buffer_print(out, joint->subtree ? "  below" : "  joint");
        put_name(out, g, joint->name);
        buffer_print(out, " weight=%.6g\n", joint->weight / 255.0);
    }
}

/* ---- nodes ---- */

static void put_clip(byte_buffer *out, const noh_pack_graph *g, const noh_pack_graph_clip *c)
{
    static const char *const loops[] = { "clip", "once", "repeat", "ping-pong" };
    put_name(out, g, c->name);
    if (c->speed != NOH_SPEED_ONE) buffer_print(out, " speed=%.12g", (double)c->speed / NOH_SPEED_ONE);
    if (c->loop) buffer_print(out, " loop=%s", loops[c->loop]);
    if (c->sync_group) buffer_print(out, " sync=group%u", c->sync_group);
    if (c->start_tick) buffer_print(out, " start=%.12g", seconds(c->start_tick));
    if (c->paused) buffer_print(out, " paused=yes");
}

static void put_children(byte_buffer *out, const noh_pack_graph *g, const noh_pack_graph_node *n)
{
    for (uint32_t i = 0; i < n->child_count; i++) {
        put_name(out, g, g->nodes[g->children[n->first_child + i]].name);
        if (n->kind == NOH_PACK_NODE_SPACE_1D) {
            buffer_print(out, " %.9g", (double)g->points[n->first_item + i]);
        } else if (n->kind == NOH_PACK_NODE_SPACE_2D) {
            const float *at = g->points + g->spaces[n->first_item].first_point + 2u * i;
            buffer_print(out, " %.9g %.9g", (double)at[0], (double)at[1]);
        }
    }
}

static void put_amount(byte_buffer *out, const noh_pack_graph *g, const noh_pack_graph_node *n)
{
    if (n->param == NOH_PACK_GRAPH_NONE) {
        buffer_print(out, " by=%.9g", (double)n->value);
    } else {
        buffer_print(out, " by=%s", param_name(g, n->param));
    }
    if (n->param_y != NOH_PACK_GRAPH_NONE) buffer_print(out, ",%s", param_name(g, n->param_y));
}

static void put_change(byte_buffer *out, uint32_t ticks, uint32_t curve, uint32_t flags)
{
    if (ticks) buffer_print(out, flags & NOH_TRANSITION_INERTIAL ? " inertia=%.12g" : " fade=%.12g", seconds(ticks));
    if (curve) buffer_print(out, " curve=smooth");
    if (flags & NOH_TRANSITION_KEEP) buffer_print(out, " enter=keep");
}

static void put_mask_of(byte_buffer *out, const noh_pack_graph *g, const noh_pack_graph_node *n)
{
    if (n->mask) buffer_print(out, " mask=%s", noh_pack_string(g->pack, g->masks[n->mask - 1u].name));
}

static void put_one_shot(byte_buffer *out, const noh_pack_graph *g, const noh_pack_graph_node *n)
{
    buffer_print(out, " on=%s", param_name(g, n->param));
    if (n->fade_ticks) buffer_print(out, " in=%.12g", seconds(n->fade_ticks));
    if (n->fade_out_ticks) buffer_print(out, " out=%.12g", seconds(n->fade_out_ticks));
    if (n->curve) buffer_print(out, " curve=smooth");
    put_mask_of(out, g, n);
}

static void put_transition(byte_buffer *out, const noh_pack_graph *g, const noh_pack_graph_node *n,
                           const noh_pack_graph_transition *t)
{
    buffer_print(out, "  from");
    if (t->from == NOH_PACK_GRAPH_NONE) {
        buffer_print(out, " any");
    } else {
        put_name(out, g, g->nodes[g->children[n->first_child + t->from]].name);
    }
    buffer_print(out, " to");
    put_name(out, g, g->nodes[g->children[n->first_child + t->to]].name);
    buffer_print(out, " when %s", t->condition == NOH_WHEN_ENDING ? "ending" : param_name(g, t->param));
    if (t->condition <= NOH_WHEN_BELOW) {
        buffer_print(out, " %s %.9g", t->condition == NOH_WHEN_ABOVE ? "above" : "below", (double)t->threshold);
    }
    put_change(out, t->duration_ticks, t->curve, t->flags);
    buffer_print(out, "\n");
}

static void put_node(byte_buffer *out, const noh_pack_graph *g, const noh_pack_graph_node *n)
{
    static const char *const kinds[] = { "clip",  "blend",   "add",    "layer",   "space",
                                         "space", "machine", "select", "one-shot" };
    buffer_print(out, "%s", kinds[n->kind]);
    put_name(out, g, n->name);
    put_children(out, g, n);
    if (n->kind == NOH_PACK_NODE_CLIP) put_clip(out, g, &g->clips[n->index]);
    if (n->kind >= NOH_PACK_NODE_BLEND && n->kind <= NOH_PACK_NODE_SPACE_2D) put_amount(out, g, n);
    if (n->kind == NOH_PACK_NODE_MASK) put_mask_of(out, g, n);
    if (n->kind == NOH_PACK_NODE_ADD && n->item_count) {
        buffer_print(out, " reference=%s", noh_pack_string(g->pack, g->names[n->first_item].name));
    }
    if (n->kind == NOH_PACK_NODE_SELECT) {
        put_amount(out, g, n);
        put_change(out, n->fade_ticks, n->curve, n->flags);
    }
    if (n->kind == NOH_PACK_NODE_ONE_SHOT) put_one_shot(out, g, n);
    buffer_print(out, "\n");
    for (uint32_t i = 0; n->kind == NOH_PACK_NODE_MACHINE && i < n->item_count; i++) {
        put_transition(out, g, n, &g->transitions[n->first_item + i]);
    }
}

void dump_graph(byte_buffer *out, const noh_pack_graph *g)
{
    const noh_pack_graph_header *h = g->header;
    buffer_print(out, "graph");
    put_text(out, g->name);
    buffer_print(out, "\n");
    for (uint32_t i = 0; i < h->param_count; i++) put_param(out, g, &g->params[i]);
    for (uint32_t i = 0; i < h->mask_count; i++) put_mask(out, g, &g->masks[i]);
    for (uint32_t i = 0; i < h->node_count; i++) put_node(out, g, &g->nodes[i]);
}
