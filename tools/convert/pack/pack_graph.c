#include "pack_graph.h"

#include <string.h>

#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"

typedef struct packer {
    const graph_def *g;
    string_table *strings;
    byte_buffer *out;
    size_t base;
    uint32_t place[NOH_GRAPH_NODES_MAX]; /* of each node of the text in the chunk's order */
    noh_pack_graph_header h;
    uint32_t next_reference; /* among the names, behind values and joints */
} packer;

/* Append one record after the name that it begins with. */
static void append(packer *p, void *record, size_t bytes, const char *name)
{
    uint32_t head[2];
    head[0] = string_offset(p->strings, name);
    head[1] = string_hash(name);
    memcpy(record, head, sizeof head);
    buffer_append(p->out, record, bytes);
}

static uint32_t begin(packer *p)
{
    buffer_align(p->out, 16);
    return (uint32_t)(p->out->count - p->base);
}

static const graph_node *node_at(const packer *p, uint32_t i)
{
    return &p->g->nodes[p->g->order[i]];
}

static uint16_t param_of(const graph_ref *ref)
{
    return (uint16_t)(ref->name ? ref->index : NOH_PACK_GRAPH_NONE);
}

/* ---- nodes ---- */

static void set_items(packer *p, const graph_node *from, noh_pack_graph_node *to)
{
    switch (from->kind) {
    case NOH_PACK_NODE_ADD:
        to->first_item = (uint16_t)(from->reference ? p->next_reference++ : 0u);
        to->item_count = from->reference != 0;
        break;
    case NOH_PACK_NODE_SPACE_1D:
        to->first_item = (uint16_t)p->h.point_count;
        to->item_count = (uint16_t)from->child_count;
        p->h.point_count += from->child_count;
        break;
    case NOH_PACK_NODE_SPACE_2D:
        to->first_item = (uint16_t)p->h.space_count++;
        to->item_count = 1;
        p->h.point_count += 2u * from->child_count;
        break;
    case NOH_PACK_NODE_MACHINE:
        to->first_item = (uint16_t)p->h.transition_count;
        to->item_count = (uint16_t)from->transition_count;
        p->h.transition_count += from->transition_count;
        break;
    default: break;
    }
}

static void append_node(packer *p, const graph_node *from)
{
    noh_pack_graph_node to;
    memset(&to, 0, sizeof to);
    to.kind = (uint16_t)from->kind;
    to.first_child = (uint16_t)p->h.child_count;
    to.child_count = (uint16_t)from->child_count;
    p->h.child_count += from->child_count;
    to.param = param_of(&from->by[0]);
    to.param_y = param_of(&from->by[1]);
    to.mask = (uint16_t)(from->mask.name ? from->mask.index + 1u : 0u);
    to.index = (uint16_t)(from->kind == NOH_PACK_NODE_CLIP      ? p->h.clip_count++
                          : from->kind >= NOH_PACK_NODE_MACHINE ? p->h.machine_count++
                                                                : 0u);
    to.curve = (uint8_t)from->curve;
    to.flags = (uint8_t)from->flags;
    to.value = from->value;
    to.fade_ticks = from->fade_ticks;
    to.fade_out_ticks = from->fade_out_ticks;
    set_items(p, from, &to);
    append(p, &to, sizeof to, from->name);
}

static void append_children(packer *p, const graph_node *from)
{
    for (uint32_t i = 0; i < from->child_count; i++) {
        const uint16_t child = (uint16_t)p->place[from->children[i].node.index];
        buffer_append(p->out, &child, sizeof child);
    }
}

/* ---- tables ---- */

/* The number of a sync group: groups are counted in the order of the clips. 0: none. */
static uint8_t sync_group(const packer *p, const graph_node *clip)
{
    const char *seen[NOH_SYNC_GROUPS_MAX];
    uint32_t count = 0;
    for (uint32_t i = 0; i < p->g->node_count && clip->sync; i++) {
        const graph_node *n = node_at(p, i);
        uint32_t k = 0;
        while (n->sync && k < count && strcmp(seen[k], n->sync) != 0) k++;
        if (n->sync && k == count) seen[count++] = n->sync;
        if (n == clip) return (uint8_t)(k + 1u);
    }
    return 0;
}

static void append_clip(packer *p, const graph_node *from)
{
    noh_pack_graph_clip to;
    memset(&to, 0, sizeof to);
    to.start_tick = from->start_tick;
    to.speed = from->speed;
    to.loop = (uint8_t)from->loop;
    to.sync_group = sync_group(p, from);
    to.paused = (uint8_t)from->paused;
    append(p, &to, sizeof to, from->clip);
}

static void append_transitions(packer *p, const graph_node *machine)
{
    for (uint32_t i = 0; i < machine->transition_count; i++) {
        const graph_transition *from = &p->g->transitions[machine->first_transition + i];
        noh_pack_graph_transition to;
        memset(&to, 0, sizeof to);
        to.from = param_of(&from->from);
        to.to = (uint16_t)from->to.index;
        to.condition = (uint16_t)from->condition;
        to.param = param_of(&from->param);
        to.threshold = from->threshold;
        to.duration_ticks = from->duration_ticks;
        to.curve = (uint16_t)from->curve;
        to.flags = (uint16_t)from->flags;
        buffer_append(p->out, &to, sizeof to);
    }
}

static void append_points(packer *p, const graph_node *n)
{
    const uint32_t width = n->kind == NOH_PACK_NODE_SPACE_1D ? 1u : n->kind == NOH_PACK_NODE_SPACE_2D ? 2u : 0u;
    for (uint32_t i = 0; i < n->child_count; i++) {
        buffer_append(p->out, n->children[i].at, width * sizeof(float));
    }
}

/* The triangles of a space; it was triangulated when it was read, so that does not fail. */
static uint32_t triangles_of(const graph_node *n, uint8_t triangles[3 * NOH_BLEND_SPACE_TRIANGLES_MAX])
{
    float points[2 * NOH_GRAPH_CHILDREN_MAX];
    uint32_t count = 0;
    for (uint32_t i = 0; i < n->child_count; i++) {
        memcpy(points + 2u * i, n->children[i].at, sizeof n->children[i].at);
    }
    (void)noh_blend_space_2d_triangulate(n->child_count, points, triangles, &count, NULL);
    return count;
}

/* `first_point` runs over the spaces of both kinds. */
static void append_space(packer *p, const graph_node *n, uint32_t *first_point)
{
    uint8_t triangles[3 * NOH_BLEND_SPACE_TRIANGLES_MAX];
    if (n->kind == NOH_PACK_NODE_SPACE_2D) {
        noh_pack_graph_space to;
        to.first_point = (uint16_t)*first_point;
        to.point_count = (uint16_t)n->child_count;
        to.first_triangle = (uint16_t)p->h.triangle_count;
        to.triangle_count = (uint16_t)triangles_of(n, triangles);
        p->h.triangle_count += to.triangle_count;
        buffer_append(p->out, &to, sizeof to);
    }
    *first_point += n->kind == NOH_PACK_NODE_SPACE_1D   ? n->child_count
                    : n->kind == NOH_PACK_NODE_SPACE_2D ? 2u * n->child_count
                                                        : 0u;
}

static void append_triangles(packer *p, const graph_node *n)
{
    uint8_t triangles[3 * NOH_BLEND_SPACE_TRIANGLES_MAX];
    if (n->kind == NOH_PACK_NODE_SPACE_2D) {
        buffer_append(p->out, triangles, 3u * (size_t)triangles_of(n, triangles));
    }
}

static void append_param(packer *p, const graph_param *from)
{
    noh_pack_graph_param to;
    memset(&to, 0, sizeof to);
    to.minimum = from->minimum;
    to.maximum = from->maximum;
    to.initial = from->initial;
    to.kind = (uint16_t)from->kind;
    to.first_value = (uint16_t)(from->value_count ? p->h.name_count : 0u);
    to.value_count = (uint16_t)from->value_count;
    p->h.name_count += from->value_count;
    append(p, &to, sizeof to, from->name);
}

static void append_mask(packer *p, const graph_mask *from)
{
    noh_pack_graph_mask to;
    memset(&to, 0, sizeof to);
    to.first_joint = (uint16_t)p->h.name_count;
    to.joint_count = (uint16_t)from->joint_count;
    to.floats = (uint8_t)from->floats;
    p->h.name_count += from->joint_count;
    append(p, &to, sizeof to, from->name);
}

static void append_names(packer *p, uint32_t first, uint32_t count)
{
    for (uint32_t i = first; i < first + count; i++) {
        const graph_name *from = &p->g->names[i];
        noh_pack_graph_name to;
        memset(&to, 0, sizeof to);
        to.weight = (uint8_t)from->weight;
        to.subtree = (uint8_t)from->subtree;
        append(p, &to, sizeof to, from->name);
    }
}

/* ---- the chunk ---- */

static void append_tree(packer *p)
{
    const uint32_t count = p->g->node_count;
    uint32_t first_point = 0;
    p->h.nodes_offset = begin(p);
    for (uint32_t i = 0; i < count; i++) append_node(p, node_at(p, i));
    p->h.children_offset = begin(p);
    for (uint32_t i = 0; i < count; i++) append_children(p, node_at(p, i));
    p->h.clips_offset = begin(p);
    for (uint32_t i = 0; i < count; i++) {
        if (node_at(p, i)->kind == NOH_PACK_NODE_CLIP) append_clip(p, node_at(p, i));
    }
    p->h.transitions_offset = begin(p);
    for (uint32_t i = 0; i < count; i++) append_transitions(p, node_at(p, i));
    p->h.points_offset = begin(p);
    for (uint32_t i = 0; i < count; i++) append_points(p, node_at(p, i));
    p->h.spaces_offset = begin(p);
    for (uint32_t i = 0; i < count; i++) append_space(p, node_at(p, i), &first_point);
    p->h.triangles_offset = begin(p);
    for (uint32_t i = 0; i < count; i++) append_triangles(p, node_at(p, i));
}

static void append_tables(packer *p)
{
    const graph_def *g = p->g;
    p->h.param_count = g->param_count;
    p->h.mask_count = g->mask_count;
    p->h.params_offset = begin(p);
    for (uint32_t i = 0; i < g->param_count; i++) append_param(p, &g->params[i]);
    p->h.masks_offset = begin(p);
    for (uint32_t i = 0; i < g->mask_count; i++) append_mask(p, &g->masks[i]);
    p->h.names_offset = begin(p);
    for (uint32_t i = 0; i < g->param_count; i++) append_names(p, g->params[i].first_value, g->params[i].value_count);
    for (uint32_t i = 0; i < g->mask_count; i++) append_names(p, g->masks[i].first_joint, g->masks[i].joint_count);
    for (uint32_t i = 0; i < g->node_count; i++) {
        const uint32_t reference = node_at(p, i)->reference;
        if (!reference) continue;
        append_names(p, reference - 1u, 1);
        p->h.name_count++;
    }
}

void pack_graph(const graph_def *g, string_table *strings, byte_buffer *out)
{
    packer p;
    memset(&p, 0, sizeof p);
    p.g = g;
    p.strings = strings;
    p.out = out;
    p.base = out->count;
    p.h.node_count = g->node_count;
    for (uint32_t i = 0; i < g->node_count; i++) {
        p.place[g->order[i]] = i;
    }
    for (uint32_t i = 0; i < g->param_count; i++) p.next_reference += g->params[i].value_count;
    for (uint32_t i = 0; i < g->mask_count; i++) p.next_reference += g->masks[i].joint_count;
    buffer_append(out, &p.h, sizeof p.h);
    append_tree(&p);
    append_tables(&p);
    if (!out->failed) {
        memcpy(out->bytes + p.base, &p.h, sizeof p.h);
    }
}
