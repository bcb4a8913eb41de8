/* check_graph.c: the checker of animation graphs, called when one is opened and not by noh_pack_open: a program without
 * graphs does not carry it. What depends on the clips (that they exist, that the clip of a one-shot ends) is checked
 * when a graph is bound to them. */
#include "core/pack/check_internal.h"
#include "core/base/math_internal.h"
#include "core/base/assert_internal.h"
#include "core/pack/pack_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"

#include <stddef.h>

/* A chunk's arrays. */
typedef struct graph_view {
    const noh_check *check;
    const noh_pack_graph_header *h;
    const noh_pack_graph_node *nodes;
    const uint16_t *children;
    const noh_pack_graph_clip *clips;
    const noh_pack_graph_transition *transitions;
    const float *points;
    const noh_pack_graph_space *spaces;
    const uint8_t *triangles;
    const noh_pack_graph_param *params;
    const noh_pack_graph_mask *masks;
    const noh_pack_graph_name *names;
} graph_view;

/* Where a record or value lies in the chunk. */
static uint64_t place_of(const graph_view *g, const void *record)
{
    return (uint64_t)((const uint8_t *)record - g->check->bytes);
}

static noh_result fail_at(const graph_view *g, const char *what, const void *place)
{
    return noh_check_fail(g->check, what, place_of(g, place));
}

/* A row for noh_check_fields. */
#define FIELD(type, field, wrong)      \
    {                                  \
        offsetof(type, field), (wrong) \
    }
#define NODE(field, wrong) FIELD(noh_pack_graph_node, field, wrong)
#define HEAD(field, wrong) FIELD(noh_pack_graph_header, field, wrong)
#define CHECK(rows, what, record) \
    noh_check_fields(g->check, rows, sizeof rows / sizeof rows[0], what, place_of(g, record))

/* Whether a range that begins at `first` is too long; a start past the end is reported separately. */
static int too_long(uint32_t first, uint32_t count, uint32_t all)
{
    return first <= all && count > all - first;
}

static int is_coordinate(float x)
{
    return x >= -NOH_BLEND_SPACE_COORDINATE_MAX && x <= NOH_BLEND_SPACE_COORDINATE_MAX; /* not where it is NaN */
}

/* ---- nodes ---- */

/* What a kind has; the other fields are 0, or name no parameter. */
#define HAS_PARAM 1u
#define HAS_PARAM_Y 2u
#define HAS_ITEMS 4u
#define HAS_MASK 8u
#define HAS_INDEX 16u
#define HAS_CURVE 32u
#define HAS_FLAGS 64u
#define HAS_VALUE 128u
#define HAS_FADE 256u
#define HAS_FADE_OUT 512u
#define NEEDS_PARAM 1024u
#define PAIR 2048u /* has two children */

static const uint16_t kinds[NOH_PACK_NODE_ONE_SHOT + 1u] = {
    HAS_INDEX,
    HAS_PARAM | HAS_VALUE | PAIR,
    HAS_PARAM | HAS_VALUE | HAS_ITEMS | PAIR,
    HAS_PARAM | HAS_VALUE | HAS_MASK | PAIR,
    HAS_PARAM | HAS_VALUE | HAS_ITEMS,
    HAS_PARAM | HAS_PARAM_Y | HAS_VALUE | HAS_ITEMS,
    HAS_ITEMS | HAS_INDEX,
    HAS_PARAM | NEEDS_PARAM | HAS_INDEX | HAS_CURVE | HAS_FLAGS | HAS_FADE,
    HAS_PARAM | NEEDS_PARAM | HAS_INDEX | HAS_CURVE | HAS_VALUE | HAS_MASK | HAS_FADE | HAS_FADE_OUT | PAIR,
};

static noh_result check_absent(const graph_view *g, const noh_pack_graph_node *n, uint32_t has)
{
    const noh_check_field rows[] = {
        NODE(param, !(has & HAS_PARAM) && n->param != NOH_PACK_GRAPH_NONE),
        NODE(param_y, !(has & HAS_PARAM_Y) && n->param_y != NOH_PACK_GRAPH_NONE),
        NODE(first_item, !(has & HAS_ITEMS) && n->first_item),
        NODE(item_count, !(has & HAS_ITEMS) && n->item_count),
        NODE(mask, !(has & HAS_MASK) && n->mask),
        NODE(index, !(has & HAS_INDEX) && n->index),
        NODE(curve, !(has & HAS_CURVE) && n->curve),
        NODE(flags, !(has & HAS_FLAGS) && n->flags),
        NODE(value, !(has & HAS_VALUE) && n->value != 0.0f),
        NODE(fade_ticks, !(has & HAS_FADE) && n->fade_ticks),
        NODE(fade_out_ticks, !(has & HAS_FADE_OUT) && n->fade_out_ticks),
    };
    return CHECK(rows, "graph node has a field that its kind does not have", n);
}

static noh_result check_values(const graph_view *g, const noh_pack_graph_node *n, uint32_t has)
{
    const uint32_t params = g->h->param_count;
    const noh_check_field missing[] = {
        NODE(param, (n->param != NOH_PACK_GRAPH_NONE || (has & NEEDS_PARAM)) && n->param >= params),
        NODE(param_y, n->param_y != NOH_PACK_GRAPH_NONE && n->param_y >= params),
        NODE(mask, n->mask > g->h->mask_count || (n->kind == NOH_PACK_NODE_MASK && !n->mask)),
    };
    const noh_check_field unknown[] = {
        NODE(value, !noh_is_finite(n->value)),
        NODE(curve, n->curve > 1u),
        NODE(flags, n->flags > 3u),
        NODE(fade_ticks, (n->flags & 1u) && !n->fade_ticks),
    };
    noh_result result = CHECK(missing, "graph node names a missing parameter or mask", n);
    return result ? result
                  : CHECK(unknown,
                          "graph node has a value that is not finite, an unknown curve or flags, or is inertial "
                          "without a time",
                          n);
}

static noh_result check_children(const graph_view *g, const noh_pack_graph_node *n, uint32_t has)
{
    const noh_check_field suits[] = {
        NODE(child_count, (n->kind == NOH_PACK_NODE_CLIP) == (n->child_count != 0) ||
                              n->child_count > NOH_GRAPH_CHILDREN_MAX || ((has & PAIR) && n->child_count != 2u)),
    };
    const noh_check_field range[] = {
        NODE(first_child, n->first_child > g->h->child_count),
        NODE(child_count, too_long(n->first_child, n->child_count, g->h->child_count)),
    };
    noh_result result = CHECK(suits, "graph node has children that do not suit its kind", n);
    return result ? result : CHECK(range, "graph node's children are not in the chunk", n);
}

static noh_result check_thresholds(const graph_view *g, const noh_pack_graph_node *n)
{
    const float *points = g->points + n->first_item;
    const noh_check_field rows[] = {
        NODE(first_item, n->first_item > g->h->point_count),
        NODE(item_count, n->item_count != n->child_count || too_long(n->first_item, n->item_count, g->h->point_count)),
    };
    noh_result result = CHECK(
        rows, "number of points in a blend space differs from its children, or a point is outside the chunk", n);
    for (uint32_t i = 0; i < n->item_count && !result; i++) {
        if (!is_coordinate(points[i]) || (i && !(points[i] > points[i - 1u])))
            result = fail_at(g, "points of a blend space do not rise, or are not finite", points + i);
    }
    return result;
}

static noh_result check_space_values(const graph_view *g, const noh_pack_graph_space *s)
{
    const float *points = g->points + s->first_point;
    const uint8_t *triangles = g->triangles + 3u * (size_t)s->first_triangle;
    for (uint32_t i = 0; i < 2u * s->point_count; i++) {
        if (!is_coordinate(points[i])) return fail_at(g, "point of a blend space is not finite", points + i);
    }
    for (uint32_t i = 0; i < 3u * s->triangle_count; i++) {
        if (triangles[i] >= s->point_count)
            return fail_at(g, "triangle of a blend space names a missing point", triangles + i);
    }
    return NOH_OK;
}

static noh_result check_space(const graph_view *g, const noh_pack_graph_node *n)
{
    const noh_pack_graph_space *s = g->spaces + n->first_item;
    const noh_check_field rows[] = {
        NODE(first_item, n->first_item >= g->h->space_count),
        NODE(item_count, n->item_count != 1u),
    };
    noh_result result = CHECK(rows, "graph node names a missing blend space", n);
    if (!result) {
        const noh_check_field ranges[] = {
            FIELD(noh_pack_graph_space, first_point, s->first_point > g->h->point_count),
            FIELD(noh_pack_graph_space, point_count,
                  s->point_count != n->child_count || too_long(s->first_point, 2u * s->point_count, g->h->point_count)),
            FIELD(noh_pack_graph_space, first_triangle, s->first_triangle > g->h->triangle_count),
            FIELD(noh_pack_graph_space, triangle_count,
                  s->triangle_count > NOH_BLEND_SPACE_TRIANGLES_MAX ||
                      too_long(s->first_triangle, s->triangle_count, g->h->triangle_count)),
        };
        result = CHECK(ranges,
                       "blend space does not have one point for each child, or its points or triangles are not in the "
                       "chunk",
                       s);
    }
    return result ? result : check_space_values(g, s);
}

static noh_result check_transition(const graph_view *g, const noh_pack_graph_node *n,
                                   const noh_pack_graph_transition *t)
{
    const noh_check_field states[] = {
        FIELD(noh_pack_graph_transition, from, t->from != NOH_PACK_GRAPH_NONE && t->from >= n->child_count),
        FIELD(noh_pack_graph_transition, to, t->to >= n->child_count || t->to == t->from),
    };
    const noh_check_field unknown[] = {
        FIELD(noh_pack_graph_transition, condition, t->condition > 3u),
        FIELD(noh_pack_graph_transition, param,
              t->condition == 3u ? t->param != NOH_PACK_GRAPH_NONE : t->param >= g->h->param_count),
        FIELD(noh_pack_graph_transition, threshold, !noh_is_finite(t->threshold)),
        FIELD(noh_pack_graph_transition, duration_ticks, (t->flags & 1u) && !t->duration_ticks),
        FIELD(noh_pack_graph_transition, curve, t->curve > 1u),
        FIELD(noh_pack_graph_transition, flags, t->flags > 3u),
    };
    noh_result result = CHECK(states, "transition is not between two states of its machine", t);
    return result ? result
                  : CHECK(unknown,
                          "transition has an unknown condition, curve or flags, a missing parameter, a "
                          "threshold that is not finite, or is inertial without a time",
                          t);
}

static noh_result check_transitions(const graph_view *g, const noh_pack_graph_node *n)
{
    const noh_check_field rows[] = {
        NODE(first_item, n->first_item > g->h->transition_count),
        NODE(item_count, too_long(n->first_item, n->item_count, g->h->transition_count)),
    };
    noh_result result = CHECK(rows, "transitions of a machine are not in the chunk", n);
    for (uint32_t i = 0; i < n->item_count && !result; i++) {
        result = check_transition(g, n, g->transitions + n->first_item + i);
    }
    return result;
}

static noh_result check_reference(const graph_view *g, const noh_pack_graph_node *n)
{
    const noh_check_field rows[] = {
        NODE(first_item, n->item_count ? n->first_item >= g->h->name_count : n->first_item != 0),
        NODE(item_count, n->item_count > 1u),
    };
    return CHECK(rows, "graph node adds relative to a clip whose name is not in the chunk", n);
}

static noh_result check_items(const graph_view *g, const noh_pack_graph_node *n)
{
    switch (n->kind) {
    case NOH_PACK_NODE_ADD: return check_reference(g, n);
    case NOH_PACK_NODE_SPACE_1D: return check_thresholds(g, n);
    case NOH_PACK_NODE_SPACE_2D: return check_space(g, n);
    case NOH_PACK_NODE_MACHINE: return check_transitions(g, n);
    default: return NOH_OK;
    }
}

/* Clips are numbered in stored order, and so are machines, selects and one-shots. */
static int takes_number(const noh_pack_graph_node *n, uint32_t *clips, uint32_t *machines)
{
    return n->kind == NOH_PACK_NODE_CLIP      ? n->index == (*clips)++
           : n->kind >= NOH_PACK_NODE_MACHINE ? n->index == (*machines)++
                                              : 1;
}

static noh_result check_node(const graph_view *g, const noh_pack_graph_node *n)
{
    noh_result result = noh_check_name(g->check, n->name, n->name_hash, place_of(g, &n->name));
    if (result) return result;
    if (n->kind > NOH_PACK_NODE_ONE_SHOT) return fail_at(g, "graph node of an unknown kind", &n->kind);
    result = check_absent(g, n, kinds[n->kind]);
    if (!result) result = check_values(g, n, kinds[n->kind]);
    if (!result) result = check_children(g, n, kinds[n->kind]);
    return result ? result : check_items(g, n);
}

static noh_result check_nodes(const graph_view *g)
{
    uint32_t clips = 0, machines = 0;
    for (uint32_t i = 0; i < g->h->node_count; i++) {
        noh_result result = check_node(g, g->nodes + i);
        if (result) return result;
        if (!takes_number(g->nodes + i, &clips, &machines))
            return fail_at(g, "graph nodes are not numbered in their order", &g->nodes[i].index);
    }
    const noh_check_field rows[] = { HEAD(clip_count, clips != g->h->clip_count),
                                     HEAD(machine_count, machines != g->h->machine_count) };
    return CHECK(rows, "count of clips or machines differs from the count of their nodes", g->h);
}

/* Children first, checked with a stack of finished subtrees: a node's children are the topmost ones, in order, and the
 * node takes their place. One subtree is left, so every node has one parent and there is no circle. */
static noh_result check_order(const graph_view *g)
{
    uint16_t done[NOH_GRAPH_NODES_MAX];
    uint32_t count = 0;
    for (uint32_t i = 0; i < g->h->node_count; i++) {
        const noh_pack_graph_node *n = g->nodes + i;
        if (n->child_count > count) return fail_at(g, "graph node does not follow its children", &n->child_count);
        count -= n->child_count;
        for (uint32_t k = 0; k < n->child_count; k++) {
            const uint16_t *child = g->children + n->first_child + k;
            if (*child != done[count + k]) return fail_at(g, "graph node does not follow its children", child);
        }
        done[count++] = (uint16_t)i;
    }
    return count == 1u ? NOH_OK : fail_at(g, "graph has more than one root", &g->h->node_count);
}

/* ---- tables ---- */

static noh_result check_clips(const graph_view *g)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < g->h->clip_count && !result; i++) {
        const noh_pack_graph_clip *c = g->clips + i;
        const noh_check_field rows[] = {
            FIELD(noh_pack_graph_clip, speed, !c->speed),
            FIELD(noh_pack_graph_clip, loop, c->loop > 3u),
            FIELD(noh_pack_graph_clip, sync_group, c->sync_group > NOH_SYNC_GROUPS_MAX),
            FIELD(noh_pack_graph_clip, paused, c->paused > 1u),
            FIELD(noh_pack_graph_clip, reserved, c->reserved != 0),
        };
        result = noh_check_name(g->check, c->name, c->name_hash, place_of(g, &c->name));
        if (!result) result = CHECK(rows, "clip of a graph has no speed, or an unknown loop, sync group or flag", c);
    }
    return result;
}

/* The range, and where the values of an ENUM are. */
static noh_result check_param(const graph_view *g, const noh_pack_graph_param *p)
{
    const int is_enum = p->kind == NOH_PARAM_ENUM, is_trigger = p->kind == NOH_PARAM_TRIGGER;
    const float most = is_enum ? (float)p->value_count - 1.0f : 1.0f;
    const noh_check_field kind[] = {
        FIELD(noh_pack_graph_param, kind, p->kind > NOH_PARAM_TRIGGER),
        FIELD(noh_pack_graph_param, reserved, p->reserved != 0),
    };
    const noh_check_field values[] = {
        FIELD(noh_pack_graph_param, first_value, is_enum ? p->first_value > g->h->name_count : p->first_value != 0),
        FIELD(noh_pack_graph_param, value_count,
              is_enum ? !p->value_count || too_long(p->first_value, p->value_count, g->h->name_count)
                      : p->value_count != 0),
    };
    const noh_check_field range[] = {
        FIELD(noh_pack_graph_param, minimum,
              !noh_is_finite(p->minimum) || ((is_enum || is_trigger) && p->minimum != 0.0f)),
        FIELD(noh_pack_graph_param, maximum,
              !noh_is_finite(p->maximum) || ((is_enum || is_trigger) && p->maximum != most)),
        FIELD(noh_pack_graph_param, initial,
              !(p->minimum <= p->initial && p->initial <= p->maximum) || (is_trigger && p->initial != 0.0f)),
    };
    noh_result result = CHECK(kind, "parameter of an unknown kind, or a reserved field is not zero", p);
    if (!result) result = CHECK(values, "parameter has values that are not in the chunk", p);
    return result ? result : CHECK(range, "range of a parameter does not fit its kind, or its default is outside", p);
}

static noh_result check_params(const graph_view *g)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < g->h->param_count && !result; i++) {
        const noh_pack_graph_param *p = g->params + i;
        result = noh_check_name(g->check, p->name, p->name_hash, place_of(g, &p->name));
        if (!result) result = check_param(g, p);
    }
    return result;
}

static noh_result check_masks(const graph_view *g)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < g->h->mask_count && !result; i++) {
        const noh_pack_graph_mask *m = g->masks + i;
        const noh_check_field rows[] = {
            FIELD(noh_pack_graph_mask, first_joint, m->first_joint > g->h->name_count),
            FIELD(noh_pack_graph_mask, joint_count, too_long(m->first_joint, m->joint_count, g->h->name_count)),
            FIELD(noh_pack_graph_mask, reserved[0], m->reserved[0] != 0),
            FIELD(noh_pack_graph_mask, reserved[1], m->reserved[1] != 0),
            FIELD(noh_pack_graph_mask, reserved[2], m->reserved[2] != 0),
        };
        result = noh_check_name(g->check, m->name, m->name_hash, place_of(g, &m->name));
        if (!result)
            result = CHECK(rows, "mask has joints that are not in the chunk, or a reserved field is not zero", m);
    }
    return result;
}

static noh_result check_names(const graph_view *g)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < g->h->name_count && !result; i++) {
        const noh_pack_graph_name *n = g->names + i;
        const noh_check_field rows[] = {
            FIELD(noh_pack_graph_name, subtree, n->subtree > 1u),
            FIELD(noh_pack_graph_name, reserved[0], n->reserved[0] != 0),
            FIELD(noh_pack_graph_name, reserved[1], n->reserved[1] != 0),
        };
        result = noh_check_name(g->check, n->name, n->name_hash, place_of(g, &n->name));
        if (!result) result = CHECK(rows, "name of a graph has unknown flags, or a reserved field is not zero", n);
    }
    return result;
}

/* ---- the chunk ---- */

static noh_result check_counts(const noh_check *check, const noh_pack_graph_header *h)
{
    const noh_check_field rows[] = {
        HEAD(node_count, !h->node_count || h->node_count > NOH_GRAPH_NODES_MAX),
        HEAD(child_count, h->child_count != h->node_count - 1u),
        HEAD(clip_count, h->clip_count > NOH_TRACKS_MAX),
        HEAD(transition_count, h->transition_count > NOH_GRAPH_TRANSITIONS_MAX),
        HEAD(point_count, h->point_count > 2u * NOH_GRAPH_NODES_MAX),
        HEAD(space_count, h->space_count > NOH_GRAPH_NODES_MAX),
        HEAD(triangle_count, h->triangle_count > 2u * NOH_GRAPH_NODES_MAX),
        HEAD(param_count, h->param_count > NOH_GRAPH_PARAMS_MAX),
        HEAD(mask_count, h->mask_count > NOH_MASKS_MAX),
        HEAD(name_count, h->name_count > NOH_GRAPH_NAMES_MAX),
        HEAD(reserved[0], h->reserved[0] != 0),
        HEAD(reserved[1], h->reserved[1] != 0),
        HEAD(reserved[2], h->reserved[2] != 0),
    };
    return noh_check_fields(
        check, rows, sizeof rows / sizeof rows[0],
        "count of a graph is zero, over the limit or not one less than its nodes, or a reserved field "
        "is not zero",
        0);
}

#define ARRAY(name, stride) \
    noh_check_array(check, offsetof(noh_pack_graph_header, name##s_offset), h->name##_count, stride)

static noh_result check_arrays(noh_check *check, const noh_pack_graph_header *h)
{
    noh_result result = ARRAY(node, sizeof(noh_pack_graph_node));
    if (!result) result = noh_check_array(check, offsetof(noh_pack_graph_header, children_offset), h->child_count, 2);
    if (!result) result = ARRAY(clip, sizeof(noh_pack_graph_clip));
    if (!result) result = ARRAY(transition, sizeof(noh_pack_graph_transition));
    if (!result) result = ARRAY(point, 4);
    if (!result) result = ARRAY(space, sizeof(noh_pack_graph_space));
    if (!result) result = ARRAY(triangle, 3);
    if (!result) result = ARRAY(param, sizeof(noh_pack_graph_param));
    if (!result) result = ARRAY(mask, sizeof(noh_pack_graph_mask));
    if (!result) result = ARRAY(name, sizeof(noh_pack_graph_name));
    return result ? result : noh_check_end(check);
}

static graph_view view_of(const noh_check *check, const noh_pack_graph_header *h)
{
    graph_view g;
    g.check = check;
    g.h = h;
    g.nodes = (const noh_pack_graph_node *)(const void *)(check->bytes + h->nodes_offset);
    g.children = (const uint16_t *)(const void *)(check->bytes + h->children_offset);
    g.clips = (const noh_pack_graph_clip *)(const void *)(check->bytes + h->clips_offset);
    g.transitions = (const noh_pack_graph_transition *)(const void *)(check->bytes + h->transitions_offset);
    g.points = (const float *)(const void *)(check->bytes + h->points_offset);
    g.spaces = (const noh_pack_graph_space *)(const void *)(check->bytes + h->spaces_offset);
    g.triangles = check->bytes + h->triangles_offset;
    g.params = (const noh_pack_graph_param *)(const void *)(check->bytes + h->params_offset);
    g.masks = (const noh_pack_graph_mask *)(const void *)(check->bytes + h->masks_offset);
    g.names = (const noh_pack_graph_name *)(const void *)(check->bytes + h->names_offset);
    return g;
}

noh_result noh_pack_check_graph(const noh_pack *pack, uint32_t index, noh_error *error)
{
    const noh_pack_chunk *c = &pack->chunks[pack->runs[NOH_CHUNK_GRAPH].first + index];
    const uint8_t *bytes = pack->bytes + c->offset;
    const noh_pack_graph_header *h = (const noh_pack_graph_header *)(const void *)bytes;
    noh_check check = { pack, bytes, c->bytes, c->offset, 0, error, NULL };
    noh_result result;
    graph_view g;
    NOH_ASSERT(index < pack->runs[NOH_CHUNK_GRAPH].count);
    result = noh_check_head(&check, sizeof *h);
    if (!result) result = check_counts(&check, h);
    if (!result) result = check_arrays(&check, h);
    if (result) return result;
    g = view_of(&check, h);
    result = check_names(&g);
    if (!result) result = check_clips(&g);
    if (!result) result = check_params(&g);
    if (!result) result = check_masks(&g);
    if (!result) result = check_nodes(&g);
    return result ? result : check_order(&g);
}
