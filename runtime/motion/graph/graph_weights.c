#include "motion/graph/graph_weights_internal.h"
#include "motion/anim/changes_internal.h"
#include "motion/graph/graph_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/graph.h"
#include "noh/low_motion.h"

#include <string.h>

const noh_controller *noh_graph_controller_of(const noh_graph_state *state)
{
    return (const noh_controller *)(const void *)((const uint8_t *)state + state->controller_offset);
}

const float *noh_graph_params_of(const noh_graph_state *state)
{
    return (const float *)(const void *)((const uint8_t *)state + state->params_offset);
}

const noh_machine *noh_graph_machines_of(const noh_graph_state *state)
{
    return (const noh_machine *)(const void *)((const uint8_t *)state + state->machines_offset);
}

float noh_graph_amount(const noh_graph_view *view, const noh_graph_node *node)
{
    return node->param == NOH_GRAPH_NONE ? node->value : view->params[node->param];
}

static float held(float t)
{
    return t > 0.0f ? (t < 1.0f ? t : 1.0f) : 0.0f;
}

/* One state has all the weight, or two share it during a cross-fade. In an inertial transition the old state has it in
 * the view before the switch, the new one in the view after. */
static void machine_weights(const noh_graph_view *view, const noh_graph_node *node, float *local)
{
    const noh_machine *m = &view->machines[node->index];
    memset(local, 0, node->child_count * sizeof *local);
    if (m->previous == NOH_GRAPH_NONE) {
        local[m->current] = 1.0f;
    } else if (m->switched) {
        local[view->before ? m->previous : m->current] = 1.0f;
    } else {
        float t = noh_curve_at((noh_curve)m->curve, (float)m->elapsed / (float)m->duration);
        local[m->previous] = 1.0f - t;
        local[m->current] = t;
    }
}

void noh_graph_child_weights(const noh_graph_view *view, const noh_graph_node *node, float *local)
{
    const noh_graph *g = view->graph;
    int has_amount = node->kind != NOH_NODE_CLIP && !noh_graph_is_machine(node->kind);
    float t = has_amount ? noh_graph_amount(view, node) : 0.0f;
    switch (node->kind) {
    case NOH_NODE_BLEND:
        local[0] = 1.0f - held(t);
        local[1] = held(t);
        break;
    case NOH_NODE_ADD:
    case NOH_NODE_MASK:
        local[0] = 1.0f;
        local[1] = held(t);
        break;
    case NOH_NODE_SPACE_1D:
        noh_blend_space_1d_weights(node->child_count, g->thresholds + node->first_item, t, local);
        break;
    case NOH_NODE_SPACE_2D:
        noh_blend_space_2d_weights(&g->spaces[node->first_item], t,
                                   node->param_y == NOH_GRAPH_NONE ? 0.0f : view->params[node->param_y], local);
        break;
    case NOH_NODE_MACHINE:
    case NOH_NODE_SELECT: machine_weights(view, node, local); break;
    case NOH_NODE_ONE_SHOT:
        machine_weights(view, node, local);
        local[0] = 1.0f; /* the child below is covered, not faded */
        break;
    default: break;
    }
}

/* Whether a child is in play: in a machine only the present state and the one it leaves; the child below a one-shot
 * always is. */
static int lets_live(const noh_graph_view *view, const noh_graph_node *node, uint32_t child)
{
    const noh_machine *m;
    if (!noh_graph_is_machine(node->kind) || (node->kind == NOH_NODE_ONE_SHOT && child == 0)) {
        return 1;
    }
    m = &view->machines[node->index];
    return child == m->current || child == m->previous;
}

/* A product that is 0 only if a factor is: an underflow would skip the sampling of a node whose parent expects its
 * pose. */
static float product(float a, float b)
{
    float p = a * b;
    return a > 0.0f && b > 0.0f && p < 1e-37f ? 1e-37f : p;
}

void noh_graph_weights(const noh_graph_view *view, float *weights, uint8_t *active)
{
    const noh_graph *g = view->graph;
    weights[g->node_count - 1] = 1.0f;
    active[g->node_count - 1] = 1;
    for (uint32_t i = g->node_count; i-- > 0;) { /* parents come after their children */
        const noh_graph_node *node = &g->nodes[i];
        float local[NOH_GRAPH_CHILDREN_MAX];
        noh_graph_child_weights(view, node, local);
        for (uint32_t k = 0; k < node->child_count; k++) {
            uint32_t child = g->children[node->first_child + k];
            weights[child] = product(weights[i], local[k]);
            active[child] = (uint8_t)(active[i] && lets_live(view, node, k));
        }
    }
}

/* In post-order a subtree begins with its first child's subtree, so it begins with a leaf. */
uint32_t noh_graph_first_of(const noh_graph *graph, uint32_t node)
{
    while (graph->nodes[node].child_count) {
        node = graph->children[graph->nodes[node].first_child]; /* lower each time */
    }
    return node;
}

int noh_graph_is_inertial(const noh_graph *graph)
{
    uint32_t any = 0;
    for (uint32_t i = 0; i < graph->transition_count; i++) {
        any |= graph->transitions[i].flags & NOH_TRANSITION_INERTIAL;
    }
    for (uint32_t i = 0; i < graph->node_count; i++) {
        any |= graph->nodes[i].kind == NOH_NODE_SELECT ? graph->nodes[i].flags & NOH_TRANSITION_INERTIAL : 0u;
    }
    return any != 0;
}

noh_graph_shape noh_graph_shape_of(const noh_graph *graph)
{
    noh_graph_shape shape;
    shape.clip_count = graph->clip_count;
    shape.param_count = graph->param_count;
    shape.machine_count = graph->machine_count;
    shape.buffer_count = noh_graph_buffers(graph);
    shape.inertial = noh_graph_is_inertial(graph);
    return shape;
}
