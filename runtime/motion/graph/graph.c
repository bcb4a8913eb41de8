/* graph.c: the state of a graph: a controller with one track per clip, parameters, and the state of each machine. The
 * graph itself is constant and shared. A state holds no pointers, so it can be copied. */
#include "core/base/assert_internal.h"
#include "motion/anim/controller_internal.h"
#include "motion/anim/tracks_internal.h"
#include "motion/graph/graph_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/graph.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"

#include <string.h>

#include "motion/graph/graph_state_internal.h"

/* ---- memory ---- */

typedef struct layout {
    size_t params, machines, controller, bytes;
} layout;

static noh_controller_desc controller_desc(const noh_graph_shape *g, const noh_clip_set *set)
{
    noh_controller_desc d;
    memset(&d, 0, sizeof d);
    d.set = set;
    d.track_count = g->clip_count;
    d.change_count = 1; /* the minimum: the graph sets weights itself */
    d.flags = g->inertial ? NOH_CONTROLLER_INERTIAL : 0u;
    return d;
}

static size_t place(noh_arena *arena, size_t bytes, size_t alignment)
{
    (void)noh_arena_carve(arena, bytes, alignment);
    return arena->used - bytes;
}

static layout layout_of(const noh_graph_shape *g, const noh_clip_set *set)
{
    noh_arena arena = noh_arena_measure();
    noh_controller_desc d = controller_desc(g, set);
    layout l;
    (void)place(&arena, sizeof(noh_graph_state), 8);
    l.controller = place(&arena, noh_controller_size(&d), 16);
    l.params = place(&arena, g->param_count * sizeof(float), 4);
    l.machines = place(&arena, g->machine_count * sizeof(noh_machine), 4);
    l.bytes = arena.used;
    return l;
}

size_t noh_graph_shape_state_size(const noh_graph_shape *shape, const noh_clip_set *set)
{
    const noh_controller_desc d = controller_desc(shape, set);
    return noh_controller_size(&d) ? layout_of(shape, set).bytes : 0;
}

size_t noh_graph_state_size(const noh_graph *graph, const noh_clip_set *set)
{
    noh_graph_shape shape;
    NOH_ASSERT(graph && set);
    if (noh_graph_check(graph, set, NULL) != NOH_OK) {
        return 0;
    }
    shape = noh_graph_shape_of(graph);
    return noh_graph_shape_state_size(&shape, set);
}

noh_controller *noh_graph_controller(noh_graph_state *state)
{
    NOH_ASSERT(state);
    return (noh_controller *)(void *)((uint8_t *)state + state->controller_offset);
}

float *noh_graph_state_params(noh_graph_state *s)
{
    return (float *)(void *)((uint8_t *)s + s->params_offset);
}

noh_machine *noh_graph_state_machines(noh_graph_state *s)
{
    return (noh_machine *)(void *)((uint8_t *)s + s->machines_offset);
}

noh_graph_view noh_graph_view_of(const noh_graph_state *s, const noh_graph *g)
{
    noh_graph_view v = { NULL, NULL, NULL, 0 };
    v.graph = g;
    v.params = noh_graph_params_of(s);
    v.machines = noh_graph_machines_of(s);
    return v;
}

/* Give each track its clip's weight and mode: in the pose, playing outside of it, or off. */
void noh_graph_weigh_tracks(noh_graph_state *s, const noh_graph *g)
{
    noh_graph_view v = noh_graph_view_of(s, g);
    float weights[NOH_GRAPH_NODES_MAX];
    uint8_t active[NOH_GRAPH_NODES_MAX];
    noh_controller *c = noh_graph_controller(s);
    noh_graph_weights(&v, weights, active);
    for (uint32_t i = 0; i < g->node_count; i++) {
        if (g->nodes[i].kind == NOH_NODE_CLIP) {
            noh_track_mode mode = weights[i] > 0.0f ? NOH_TRACK_ON : NOH_TRACK_TIME_ONLY;
            (void)noh_controller_set_weight(c, g->nodes[i].index, weights[i]);
            (void)noh_controller_set_mode(c, g->nodes[i].index, active[i] ? mode : NOH_TRACK_OFF);
        }
    }
}

static noh_result start_clip(noh_graph_state *s, const noh_graph *g, const noh_clip_set *set, uint32_t index,
                             noh_error *error)
{
    noh_track_desc d = g->clips[index];
    d.flags &= NOH_TRACK_PAUSED;
    d.group = NOH_GROUP_LOW;
    d.mask = 0;
    return noh_controller_start(noh_graph_controller(s), set, index, &d, error);
}

uint32_t noh_graph_choice(const noh_graph_state *state, const noh_graph_node *node)
{
    const float value = noh_graph_params_of(state)[node->param];
    return !(value > 0.0f)                            ? 0u
           : value >= (float)(node->child_count - 1u) ? node->child_count - 1u
                                                      : (uint32_t)(value + 0.5f);
}

/* Reset a subtree: clips to their starts, machines to their first states, selects to their parameter's value, one-shots
 * to rest. */
noh_result noh_graph_start_subtree(noh_graph_state *s, const noh_graph *g, const noh_clip_set *set, uint32_t node,
                                   noh_error *error)
{
    noh_result result = NOH_OK;
    for (uint32_t i = noh_graph_first_of(g, node); i <= node && result == NOH_OK; i++) {
        const noh_graph_node *n = &g->nodes[i];
        if (n->kind == NOH_NODE_CLIP) {
            result = start_clip(s, g, set, n->index, error);
        } else if (noh_graph_is_machine(n->kind)) {
            noh_machine *m = &noh_graph_state_machines(s)[n->index];
            memset(m, 0, sizeof *m);
            m->current = (uint16_t)(n->kind == NOH_NODE_SELECT ? noh_graph_choice(s, n) : 0u);
            m->previous = NOH_GRAPH_NONE;
        }
    }
    return result;
}

void noh_graph_state_head(const noh_graph *g, const noh_clip_set *set, noh_graph_state *head)
{
    const noh_graph_shape shape = noh_graph_shape_of(g);
    const layout l = layout_of(&shape, set);
    memset(head, 0, sizeof *head);
    head->bytes = (uint32_t)l.bytes;
    head->node_count = g->node_count;
    head->param_count = g->param_count;
    head->machine_count = g->machine_count;
    head->params_offset = (uint32_t)l.params;
    head->machines_offset = (uint32_t)l.machines;
    head->controller_offset = (uint32_t)l.controller;
}

static void fill_state(noh_graph_state *s, const noh_graph *g, const noh_clip_set *set)
{
    noh_graph_state head;
    noh_graph_state_head(g, set, &head);
    memset(s, 0, head.bytes);
    *s = head;
    if (g->param_defaults && g->param_count) {
        memcpy(noh_graph_state_params(s), g->param_defaults, g->param_count * sizeof(float));
    }
}

noh_result noh_graph_state_init(void *memory, size_t bytes, const noh_graph *graph, const noh_clip_set *set,
                                noh_graph_state **state, noh_error *error)
{
    noh_result result = noh_graph_check(graph, set, error);
    noh_graph_state *s = (noh_graph_state *)memory;
    noh_controller_desc d;
    noh_graph_shape shape;
    noh_controller *c;
    noh_arena arena;
    NOH_ASSERT(graph && set && state);
    if (result != NOH_OK) {
        return result;
    }
    shape = noh_graph_shape_of(graph);
    d = controller_desc(&shape, set);
    result = noh_arena_open(&arena, memory, bytes, layout_of(&shape, set).bytes, error);
    if (result != NOH_OK) {
        return result;
    }
    fill_state(s, graph, set);
    result = noh_controller_init((uint8_t *)memory + s->controller_offset, noh_controller_size(&d), &d, &c, error);
    result = result == NOH_OK ? noh_graph_start_subtree(s, graph, set, graph->node_count - 1, error) : result;
    if (result == NOH_OK) {
        noh_graph_weigh_tracks(s, graph);
        *state = s;
    }
    return result;
}

noh_result noh_graph_set_param(noh_graph_state *state, uint32_t param, float value)
{
    NOH_ASSERT(state);
    if (param >= state->param_count || value - value != 0.0f) {
        return NOH_ERR_ARG;
    }
    noh_graph_state_params(state)[param] = value;
    return NOH_OK;
}

float noh_graph_param(const noh_graph_state *state, uint32_t param)
{
    NOH_ASSERT(param < state->param_count);
    return noh_graph_params_of(state)[param];
}

uint32_t noh_graph_machine_state(const noh_graph_state *state, uint32_t machine)
{
    NOH_ASSERT(machine < state->machine_count);
    return noh_graph_machines_of(state)[machine].current;
}
