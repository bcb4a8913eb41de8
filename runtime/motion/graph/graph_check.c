/* Checks a graph, and counts the pose buffers it needs. */
#include <string.h>

#include "core/base/math_internal.h"
#include "motion/anim/clip_set_internal.h"
#include "core/base/assert_internal.h"
#include "motion/anim/tracks_internal.h"
#include "motion/graph/graph_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/graph.h"
#include "noh/low_motion.h"
#include "motion/graph/graph_weights_internal.h"

static int is_coordinate(float x)
{
    return x >= -NOH_BLEND_SPACE_COORDINATE_MAX && x <= NOH_BLEND_SPACE_COORDINATE_MAX;
}

static const char *bad_count(const noh_graph *g)
{
    if (g->node_count == 0 || g->node_count > NOH_GRAPH_NODES_MAX) return "node_count must be 1 to NOH_GRAPH_NODES_MAX";
    if (g->clip_count == 0 || g->clip_count > NOH_TRACKS_MAX) return "clip_count must be 1 to NOH_TRACKS_MAX";
    if (g->child_count >= NOH_GRAPH_NODES_MAX) return "child_count must be below NOH_GRAPH_NODES_MAX";
    if (g->machine_count > g->node_count) return "machine_count is above node_count";
    if (g->param_count > NOH_GRAPH_PARAMS_MAX) return "param_count is above NOH_GRAPH_PARAMS_MAX";
    if (!g->nodes) return "nodes is NULL";
    if (!g->children && g->child_count) return "children is NULL";
    if (!g->clips) return "clips is NULL";
    if (!g->transitions && g->transition_count) return "transitions is NULL";
    if (!g->thresholds && g->threshold_count) return "thresholds is NULL";
    if (!g->spaces && g->space_count) return "spaces is NULL";
    for (uint32_t i = 0; g->param_defaults && i < g->param_count; i++) {
        if (!noh_is_finite(g->param_defaults[i])) return "param_defaults has a value that is not finite";
    }
    return NULL;
}

static int in_range(uint32_t first, uint32_t count, uint32_t all)
{
    return first <= all && count <= all - first;
}

static int bad_param(const noh_graph *g, uint16_t param)
{
    return param != NOH_GRAPH_NONE && param >= g->param_count;
}

static const char *bad_clip(const noh_graph *g, const noh_clip_set *set, const noh_graph_node *n)
{
    noh_track unused;
    noh_error why = { NOH_OK, NULL, 0, 0 };
    memset(&unused, 0, sizeof unused);
    if (n->index >= g->clip_count) return "clip index must be below clip_count";
    (void)noh_track_start(&unused, set, &g->clips[n->index], &why);
    return why.what;
}

static const char *bad_space_1d(const noh_graph *g, const noh_graph_node *n)
{
    if (!in_range(n->first_item, n->child_count, g->threshold_count))
        return "thresholds of the node lie outside the graph's thresholds";
    for (uint32_t i = 0; i < n->child_count; i++) {
        const float *t = g->thresholds + n->first_item + i;
        if (!is_coordinate(t[0]) || (i > 0 && !(t[0] > t[-1])))
            return "thresholds must increase, within NOH_BLEND_SPACE_COORDINATE_MAX";
    }
    return NULL;
}

static const char *bad_space_2d(const noh_graph *g, const noh_graph_node *n)
{
    const noh_blend_space_2d *s;
    if (n->first_item >= g->space_count) return "space must be below space_count";
    s = &g->spaces[n->first_item];
    if (bad_param(g, n->param_y)) return "param_y must be below param_count";
    if (s->point_count != n->child_count || !s->points) return "space points are NULL, or not one per child";
    if (s->triangle_count > NOH_BLEND_SPACE_TRIANGLES_MAX || (s->triangle_count && !s->triangles))
        return "space triangles are NULL, or more than NOH_BLEND_SPACE_TRIANGLES_MAX";
    for (uint32_t i = 0; i < s->point_count; i++) {
        if (!is_coordinate(s->points[2u * i]) || !is_coordinate(s->points[2u * i + 1u]))
            return "space point is not finite, or beyond NOH_BLEND_SPACE_COORDINATE_MAX";
    }
    for (uint32_t i = 0; i < s->triangle_count; i++) {
        const uint8_t *t = s->triangles + 3u * i;
        if (t[0] >= s->point_count || t[1] >= s->point_count || t[2] >= s->point_count)
            return "space triangle names a point that does not exist";
    }
    return NULL;
}

static const char *bad_transition(const noh_graph *g, const noh_graph_node *n, const noh_graph_transition *t)
{
    if (t->to >= n->child_count || (t->from != NOH_GRAPH_NONE && t->from >= n->child_count) || t->from == t->to)
        return "transition states: `from` and `to` must be two different children of the machine";
    if (t->condition > NOH_WHEN_ENDING) return "transition condition is not a noh_condition";
    if (t->condition != NOH_WHEN_ENDING && t->param >= g->param_count)
        return "transition param must be below param_count";
    if (!noh_is_finite(t->threshold)) return "transition threshold is not finite";
    if (t->curve > NOH_CURVE_SMOOTHSTEP) return "transition curve is not a noh_curve";
    if (t->flags & ~(NOH_TRANSITION_INERTIAL | NOH_TRANSITION_KEEP))
        return "transition flags must be bits of NOH_TRANSITION_*";
    if ((t->flags & NOH_TRANSITION_INERTIAL) && t->duration_ticks == 0)
        return "transition duration is 0: an inertial transition needs one";
    return NULL;
}

static const char *bad_machine(const noh_graph *g, const noh_graph_node *n)
{
    const char *what = NULL;
    if (n->index >= g->machine_count) return "machine index must be below machine_count";
    if (!in_range(n->first_item, n->item_count, g->transition_count))
        return "transitions of the machine lie outside the graph's transitions";
    for (uint32_t i = 0; i < n->item_count && !what; i++) {
        what = bad_transition(g, n, &g->transitions[n->first_item + i]);
    }
    return what;
}

static const char *bad_select(const noh_graph *g, const noh_graph_node *n)
{
    if (n->index >= g->machine_count) return "machine index must be below machine_count";
    if (n->param >= g->param_count) return "param of SELECT and ONE_SHOT must be below param_count";
    if (n->curve > NOH_CURVE_SMOOTHSTEP) return "curve is not a noh_curve";
    if (n->flags & ~(NOH_TRANSITION_INERTIAL | NOH_TRANSITION_KEEP)) return "flags must be bits of NOH_TRANSITION_*";
    if ((n->flags & NOH_TRANSITION_INERTIAL) && n->fade_ticks == 0)
        return "fade_ticks is 0: an inertial change needs a duration";
    return NULL;
}

static const char *bad_one_shot(const noh_graph *g, const noh_clip_set *set, const noh_graph_node *n)
{
    if (n->flags) return "flags of ONE_SHOT must be 0";
    if (n->mask > set->mask_count) return "mask is above mask_count of the set";
    return bad_select(g, n);
}

static const char *bad_children(const noh_graph *g, const noh_graph_node *n)
{
    int pair = n->kind == NOH_NODE_BLEND || n->kind == NOH_NODE_ADD || n->kind == NOH_NODE_MASK ||
               n->kind == NOH_NODE_ONE_SHOT;
    if (n->kind > NOH_NODE_ONE_SHOT) return "kind is not a noh_node_kind";
    if (n->kind == NOH_NODE_CLIP ? n->child_count != 0 : n->child_count == 0)
        return "child_count does not match the node's kind";
    if (n->child_count > NOH_GRAPH_CHILDREN_MAX || (pair && n->child_count != 2))
        return "child_count does not match the node's kind";
    return in_range(n->first_child, n->child_count, g->child_count)
               ? NULL
               : "children of the node lie outside the graph's children";
}

static const char *bad_node(const noh_graph *g, const noh_clip_set *set, const noh_graph_node *n)
{
    const char *what = bad_children(g, n);
    if (what) return what;
    if (!noh_is_finite(n->value)) return "value is not finite";
    if (n->kind != NOH_NODE_CLIP && !noh_graph_is_machine(n->kind) && bad_param(g, n->param))
        return "param must be below param_count";
    switch (n->kind) {
    case NOH_NODE_CLIP: return bad_clip(g, set, n);
    case NOH_NODE_MASK:
        return n->mask == 0 || n->mask > set->mask_count ? "mask must be 1 to mask_count of the set" : NULL;
    case NOH_NODE_ADD:
        return n->item_count > 1u || (n->item_count && n->first_item >= set->clip_count)
                   ? "the reference of ADD is not a clip of the set"
                   : NULL;
    case NOH_NODE_SPACE_1D: return bad_space_1d(g, n);
    case NOH_NODE_SPACE_2D: return bad_space_2d(g, n);
    case NOH_NODE_MACHINE: return bad_machine(g, n);
    case NOH_NODE_SELECT: return bad_select(g, n);
    case NOH_NODE_ONE_SHOT: return bad_one_shot(g, set, n);
    default: return NULL;
    }
}

/* Post-order, checked with a stack of finished subtrees as in a postfix calculator: a node's children must be the
 * topmost ones, in order, and are replaced by the node. One subtree, the whole graph, must remain. It follows that
 * every node has one parent and that the graph has no cycle. */
static const char *bad_order(const noh_graph *g, uint32_t *where)
{
    uint16_t done[NOH_GRAPH_NODES_MAX];
    uint32_t count = 0;
    for (uint32_t i = 0; i < g->node_count; i++) {
        const noh_graph_node *n = &g->nodes[i];
        *where = i;
        if (n->child_count > count) return "node order: a node must directly follow its children";
        count -= n->child_count;
        for (uint32_t k = 0; k < n->child_count; k++) {
            if (g->children[n->first_child + k] != done[count + k])
                return "node order: a node must directly follow its children";
        }
        done[count++] = (uint16_t)i;
    }
    return count == 1 ? NULL : "more than one root: all nodes must be descendants of the last one";
}

/* Clips and machines are numbered in stored order, so each number is used once. */
static const char *bad_indices(const noh_graph *g, uint32_t *where)
{
    uint32_t clips = 0, machines = 0;
    for (uint32_t i = 0; i < g->node_count; i++) {
        const noh_graph_node *n = &g->nodes[i];
        *where = i;
        if (n->kind == NOH_NODE_CLIP && n->index != clips++)
            return "clip index: CLIP nodes must be numbered in stored order";
        if (noh_graph_is_machine(n->kind) && n->index != machines++)
            return "machine index: machines must be numbered in stored order";
    }
    return clips != g->clip_count         ? "clip_count is not the number of CLIP nodes"
           : machines != g->machine_count ? "machine_count is not the number of MACHINE, SELECT and ONE_SHOT nodes"
                                          : NULL;
}

/* The clip that determines the end of a one-shot, the first of its subtree, must end. Call after bad_order. */
static const char *bad_shots(const noh_graph *g, const noh_clip_set *set, uint32_t *where)
{
    for (uint32_t i = 0; i < g->node_count; i++) {
        const noh_graph_node *n = &g->nodes[i];
        const noh_track_desc *clip;
        *where = i;
        if (n->kind != NOH_NODE_ONE_SHOT) continue;
        clip = &g->clips[g->nodes[noh_graph_first_of(g, g->children[n->first_child + 1u])].index];
        if ((clip->loop == NOH_LOOP_OF_CLIP ? set->clips[clip->clip].loop : (uint32_t)clip->loop) != NOH_LOOP_ONCE)
            return "ONE_SHOT: the first clip of its second child must play ONCE";
    }
    return NULL;
}

noh_result noh_graph_check(const noh_graph *graph, const noh_clip_set *set, noh_error *error)
{
    NOH_ASSERT(graph && set);
    const char *what = bad_count(graph);
    uint32_t where = 0;
    what = what ? what : noh_clip_set_excess(set);
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, 0, 0);
    }
    for (; where < graph->node_count && !what; where++) {
        what = bad_node(graph, set, &graph->nodes[where]);
    }
    where -= what != NULL; /* the loop has gone on by one */
    what = what ? what : bad_order(graph, &where);
    what = what ? what : bad_indices(graph, &where);
    what = what ? what : bad_shots(graph, set, &where);
    if (!what && noh_graph_buffers(graph) > NOH_GRAPH_BUFFERS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT,
                        "the graph needs more than NOH_GRAPH_BUFFERS_MAX pose buffers: make it less deep", 0,
                        noh_graph_buffers(graph));
    }
    return what ? noh_fail(error, NOH_ERR_DATA, what, where, 0) : NOH_OK;
}

/* The number of a node's children that can have weight at the same time. */
static uint32_t live_children(const noh_graph_node *n)
{
    uint32_t most = n->kind == NOH_NODE_SPACE_2D ? 3u : 2u;
    return n->child_count < most ? n->child_count : most;
}

uint32_t noh_graph_count_buffers(const noh_graph_nodes *nodes, const uint16_t *children)
{
    uint16_t need[NOH_GRAPH_NODES_MAX];
    NOH_ASSERT(nodes->count > 0 && nodes->count <= NOH_GRAPH_NODES_MAX);
    for (uint32_t i = 0; i < nodes->count; i++) {
        const noh_graph_node *n = noh_graph_node_at(nodes, i);
        need[i] = 1;
        for (uint32_t k = 0; k < n->child_count; k++) {
            /* While a child is evaluated, the buffers of its earlier siblings wait, at most one less than can have
             * weight: the numbering of Sethi and Ullman (1970) for registers, with a fixed order of children. */
            uint32_t waiting = k < live_children(n) - 1 ? k : live_children(n) - 1;
            uint32_t depth = need[children[n->first_child + k]] + waiting;
            need[i] = (uint16_t)(depth > need[i] ? depth : need[i]);
        }
    }
    return need[nodes->count - 1];
}

uint32_t noh_graph_buffers(const noh_graph *graph)
{
    const noh_graph_nodes nodes = { (const uint8_t *)graph->nodes, sizeof *graph->nodes, graph->node_count };
    return noh_graph_count_buffers(&nodes, graph->children);
}
