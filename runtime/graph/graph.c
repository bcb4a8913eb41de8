#include "graph/graph.h"

#include <string.h>

#include "graph/graph_weights_internal.h"
#include "base/arena.h"

/* ---- memory ---- */

typedef struct layout {
    size_t params, machines, controller, bytes;
} layout;

static noh_controller_desc controller_desc(const noh_graph *g, const noh_clip_set *set)
{
    noh_controller_desc d;
    memset(&d, 0, sizeof d);
    d.set = set;
    d.track_count = g->clip_count;
    d.change_count = 1; /* the least: the graph sets weights by itself */
    for (uint32_t i = 0; i < g->transition_count; i++) {
        d.flags |= g->transitions[i].flags & NOH_TRANSITION_INERTIAL ? NOH_CONTROLLER_INERTIAL : 0u;
    }
    return d;
}

static size_t place(noh_arena *arena, size_t bytes, size_t alignment)
{
    (void)noh_arena_carve(arena, bytes, alignment);
    return arena->used - bytes;
}

static layout layout_of(const noh_graph *g, const noh_clip_set *set)
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

size_t noh_graph_state_size(const noh_graph *graph, const noh_clip_set *set)
{
    NOH_ASSERT(graph && set);
    return noh_graph_check(graph, set, NULL) == NOH_OK ? layout_of(graph, set).bytes : 0;
}

noh_controller *noh_graph_controller(noh_graph_state *state)
{
    NOH_ASSERT(state);
    return (noh_controller *)(void *)((uint8_t *)state + state->controller_offset);
}

static float *params_of(noh_graph_state *s)
{
    return (float *)(void *)((uint8_t *)s + s->params_offset);
}

static noh_machine *machines_of(noh_graph_state *s)
{
    return (noh_machine *)(void *)((uint8_t *)s + s->machines_offset);
}

static noh_graph_view view_of(const noh_graph_state *s, const noh_graph *g)
{
    noh_graph_view v = { NULL, NULL, NULL, 0 };
    v.graph = g;
    v.params = noh_graph_params_of(s);
    v.machines = noh_graph_machines_of(s);
    return v;
}

/* Give each track its clip's weight and mode: in the pose, playing outside of it, or off. */
static void weigh_tracks(noh_graph_state *s, const noh_graph *g)
{
    noh_graph_view v = view_of(s, g);
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

/* Reset a subtree: clips to their starts, machines to their first states. */
static noh_result start_subtree(noh_graph_state *s, const noh_graph *g, const noh_clip_set *set, uint32_t node,
                                noh_error *error)
{
    noh_result result = NOH_OK;
    for (uint32_t i = noh_graph_first_of(g, node); i <= node && result == NOH_OK; i++) {
        const noh_graph_node *n = &g->nodes[i];
        if (n->kind == NOH_NODE_CLIP) {
            noh_track_desc d = g->clips[n->index];
            d.flags &= NOH_TRACK_PAUSED;
            d.group = NOH_GROUP_LOW;
            d.mask = 0;
            result = noh_controller_start(noh_graph_controller(s), set, n->index, &d, error);
        } else if (n->kind == NOH_NODE_MACHINE) {
            noh_machine *m = &machines_of(s)[n->index];
            memset(m, 0, sizeof *m);
            m->previous = NOH_GRAPH_NONE;
        }
    }
    return result;
}

static void fill_state(noh_graph_state *s, const noh_graph *g, layout l)
{
    memset(s, 0, l.bytes);
    s->bytes = (uint32_t)l.bytes;
    s->node_count = g->node_count;
    s->param_count = g->param_count;
    s->machine_count = g->machine_count;
    s->params_offset = (uint32_t)l.params;
    s->machines_offset = (uint32_t)l.machines;
    s->controller_offset = (uint32_t)l.controller;
    if (g->param_defaults && g->param_count) {
        memcpy(params_of(s), g->param_defaults, g->param_count * sizeof(float));
    }
}

noh_result noh_graph_state_init(void *memory, size_t bytes, const noh_graph *graph, const noh_clip_set *set,
                                noh_graph_state **state, noh_error *error)
{
    noh_result result = noh_graph_check(graph, set, error);
    noh_controller_desc d;
    noh_graph_state *s = (noh_graph_state *)memory;
    noh_controller *c;
    noh_arena arena;
    layout l;
    NOH_ASSERT(graph && set && state);
    if (result != NOH_OK) {
        return result;
    }
    l = layout_of(graph, set);
    d = controller_desc(graph, set);
    result = noh_arena_open(&arena, memory, bytes, l.bytes, error);
    if (result != NOH_OK) {
        return result;
    }
    fill_state(s, graph, l);
    result = noh_controller_init((uint8_t *)memory + l.controller, noh_controller_size(&d), &d, &c, error);
    result = result == NOH_OK ? start_subtree(s, graph, set, graph->node_count - 1, error) : result;
    if (result == NOH_OK) {
        weigh_tracks(s, graph);
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
    params_of(state)[param] = value;
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

/* ---- state machines ---- */

/* Whether a state's first clip ends within that many ticks, or has ended. */
static int is_ending(noh_graph_state *s, const noh_graph *g, const noh_clip_set *set, uint32_t child, uint32_t ticks)
{
    const noh_graph_node *clip = &g->nodes[noh_graph_first_of(g, child)];
    const noh_track *t = noh_controller_track(noh_graph_controller(s), clip->index);
    int64_t end = t->speed < 0 ? 0 : noh_position_of(set->clips[t->clip].duration_ticks);
    int64_t left = end - t->position, speed = t->speed < 0 ? -(int64_t)t->speed : t->speed;
    return t->loop == NOH_LOOP_ONCE && (left < 0 ? -left : left) <= speed * (int64_t)ticks;
}

static int holds(noh_graph_state *s, const noh_graph *g, const noh_clip_set *set, const noh_graph_node *node,
                 const noh_graph_transition *t)
{
    const noh_machine *m = &machines_of(s)[node->index];
    if (m->current == t->to || (t->from != NOH_GRAPH_NONE && t->from != m->current)) {
        return 0;
    }
    switch (t->condition) {
    case NOH_WHEN_ABOVE:
    case NOH_WHEN_TRIGGERED: return params_of(s)[t->param] > t->threshold;
    case NOH_WHEN_BELOW: return params_of(s)[t->param] < t->threshold;
    default: return is_ending(s, g, set, g->children[node->first_child + m->current], t->duration_ticks);
    }
}

/* Take a transition: the new state starts from its beginning, unless it keeps its place; the old one fades out, or is
 * left at once and its difference decays. */
static void take(noh_graph_state *s, const noh_graph *g, const noh_clip_set *set, const noh_graph_node *node,
                 const noh_graph_transition *t)
{
    noh_machine *m = &machines_of(s)[node->index];
    if (!(t->flags & NOH_TRANSITION_KEEP)) {
        (void)start_subtree(s, g, set, g->children[node->first_child + t->to], NULL); /* checked at init */
    }
    m->previous = t->duration_ticks ? m->current : (uint16_t)NOH_GRAPH_NONE;
    m->current = t->to;
    m->elapsed = 0;
    m->duration = t->duration_ticks;
    m->curve = (uint8_t)t->curve;
    if (t->flags & NOH_TRANSITION_INERTIAL) {
        m->switched = 1;
        s->inertia_ticks = t->duration_ticks;
    }
    if (t->condition == NOH_WHEN_TRIGGERED) {
        params_of(s)[t->param] = 0.0f;
    }
}

static void take_first(noh_graph_state *s, const noh_graph *g, const noh_clip_set *set, const noh_graph_node *node)
{
    for (uint32_t i = 0; i < node->item_count; i++) {
        const noh_graph_transition *t = &g->transitions[node->first_item + i];
        if (holds(s, g, set, node, t)) {
            take(s, g, set, node, t);
            return;
        }
    }
}

/* Inertial transitions that still wait for a pose: there was none since the last step, so they switch without inertia.
 */
static void drop_switches(noh_graph_state *s)
{
    for (uint32_t i = 0; i < s->machine_count; i++) {
        noh_machine *m = &machines_of(s)[i];
        if (m->switched) {
            m->switched = 0;
            m->previous = NOH_GRAPH_NONE;
        }
    }
    s->inertia_ticks = 0;
}

/* Run the machines in play, outer ones first (parents come after their children): entering a state resets the machines
 * inside it. */
static void run_machines(noh_graph_state *s, const noh_graph *g, const noh_clip_set *set)
{
    noh_graph_view v = view_of(s, g);
    float weights[NOH_GRAPH_NODES_MAX];
    uint8_t active[NOH_GRAPH_NODES_MAX];
    noh_graph_weights(&v, weights, active);
    for (uint32_t i = g->node_count; i-- > 0;) {
        const noh_graph_node *node = &g->nodes[i];
        if (node->kind == NOH_NODE_MACHINE && active[i] && machines_of(s)[node->index].previous == NOH_GRAPH_NONE) {
            take_first(s, g, set, node);
        }
    }
}

static void run_fades(noh_graph_state *s, uint32_t ticks)
{
    for (uint32_t i = 0; i < s->machine_count; i++) {
        noh_machine *m = &machines_of(s)[i];
        if (m->previous == NOH_GRAPH_NONE || m->switched) {
            continue;
        }
        if (ticks >= m->duration - m->elapsed) {
            m->previous = NOH_GRAPH_NONE;
        } else {
            m->elapsed += ticks;
        }
    }
}

uint32_t noh_graph_step(noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set, uint32_t ticks,
                        noh_event_fn fn, void *user)
{
    NOH_ASSERT(state && graph && set);
    NOH_VALIDATE(noh_graph_check(graph, set, NULL) == NOH_OK);
    NOH_ASSERT(state->node_count == graph->node_count && state->param_count == graph->param_count);
    drop_switches(state);
    run_machines(state, graph, set);
    run_fades(state, ticks);
    weigh_tracks(state, graph);
    return noh_controller_step(noh_graph_controller(state), set, ticks, fn, user);
}
