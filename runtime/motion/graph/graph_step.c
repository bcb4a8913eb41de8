/* graph_step.c: changes over time: the states of machines, selects and one-shots, their fades, and the step. */
#include "motion/graph/graph_state_internal.h"
#include "core/base/assert_internal.h"
#include "motion/graph/graph_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/graph.h"
#include "noh/low_motion.h"

/* ---- state machines ---- */

/* Whether a state's first clip ends within `ticks`, or has ended. */
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
    const noh_machine *m = &noh_graph_state_machines(s)[node->index];
    if (m->current == t->to || (t->from != NOH_GRAPH_NONE && t->from != m->current)) {
        return 0;
    }
    switch (t->condition) {
    case NOH_WHEN_ABOVE:
    case NOH_WHEN_TRIGGERED: return noh_graph_state_params(s)[t->param] > t->threshold;
    case NOH_WHEN_BELOW: return noh_graph_state_params(s)[t->param] < t->threshold;
    default: return is_ending(s, g, set, g->children[node->first_child + m->current], t->duration_ticks);
    }
}

/* A change of state: where to, and how. */
typedef struct change {
    uint32_t to, ticks;
    uint32_t curve, flags; /* noh_curve, NOH_TRANSITION_* */
} change;

/* Enter a state: it starts from its beginning unless KEEP is set; the old state fades out, or is left immediately and
 * its difference decays. */
static void enter(noh_graph_state *s, const noh_graph *g, const noh_clip_set *set, const noh_graph_node *node,
                  change to)
{
    noh_machine *m = &noh_graph_state_machines(s)[node->index];
    if (!(to.flags & NOH_TRANSITION_KEEP)) {
        (void)noh_graph_start_subtree(s, g, set, g->children[node->first_child + to.to], NULL); /* checked at init */
    }
    m->previous = to.ticks ? m->current : (uint16_t)NOH_GRAPH_NONE;
    m->current = (uint16_t)to.to;
    m->elapsed = 0;
    m->duration = to.ticks;
    m->curve = (uint8_t)to.curve;
    if (to.flags & NOH_TRANSITION_INERTIAL) {
        m->switched = 1;
        s->inertia_ticks = to.ticks;
    }
}

static void take(noh_graph_state *s, const noh_graph *g, const noh_clip_set *set, const noh_graph_node *node,
                 const noh_graph_transition *t)
{
    const change to = { t->to, t->duration_ticks, t->curve, t->flags };
    enter(s, g, set, node, to);
    if (t->condition == NOH_WHEN_TRIGGERED) {
        noh_graph_state_params(s)[t->param] = 0.0f;
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

static void run_machine(noh_graph_state *s, const noh_graph *g, const noh_clip_set *set, const noh_graph_node *node)
{
    if (noh_graph_state_machines(s)[node->index].previous == NOH_GRAPH_NONE) {
        take_first(s, g, set, node);
    }
}

/* Select the child given by the parameter. A fade reverses where it stands: both curves have c(1 - t) = 1 - c(t), so
 * the weights do not jump. */
static void run_select(noh_graph_state *s, const noh_graph *g, const noh_clip_set *set, const noh_graph_node *node)
{
    noh_machine *m = &noh_graph_state_machines(s)[node->index];
    const change to = { noh_graph_choice(s, node), node->fade_ticks, node->curve, node->flags };
    if (to.to == m->current) {
        return;
    }
    if (m->previous == NOH_GRAPH_NONE) {
        enter(s, g, set, node, to);
    } else if (m->previous == to.to) {
        m->previous = m->current;
        m->current = (uint16_t)to.to;
        m->elapsed = m->duration - m->elapsed;
    }
}

/* Fade in when triggered, and out so that the fade ends with the clip. */
static void run_one_shot(noh_graph_state *s, const noh_graph *g, const noh_clip_set *set, const noh_graph_node *node)
{
    const noh_machine *m = &noh_graph_state_machines(s)[node->index];
    float *trigger = &noh_graph_state_params(s)[node->param];
    const change in = { 1, node->fade_ticks, node->curve, 0 };
    /* the child below continues to play */
    const change out = { 0, node->fade_out_ticks, node->curve, NOH_TRANSITION_KEEP };
    if (m->previous != NOH_GRAPH_NONE) {
        return;
    }
    if (m->current) {
        if (is_ending(s, g, set, g->children[node->first_child + 1u], out.ticks)) enter(s, g, set, node, out);
    } else if (*trigger > node->value) {
        enter(s, g, set, node, in);
        *trigger = 0.0f;
    }
}

/* Inertial transitions that still wait for a pose: there was none since the last step, so they switch without
 * inertia. */
static void drop_switches(noh_graph_state *s)
{
    for (uint32_t i = 0; i < s->machine_count; i++) {
        noh_machine *m = &noh_graph_state_machines(s)[i];
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
    noh_graph_view v = noh_graph_view_of(s, g);
    float weights[NOH_GRAPH_NODES_MAX];
    uint8_t active[NOH_GRAPH_NODES_MAX];
    noh_graph_weights(&v, weights, active);
    for (uint32_t i = g->node_count; i-- > 0;) {
        const noh_graph_node *node = &g->nodes[i];
        if (!active[i]) {
            continue;
        }
        switch (node->kind) {
        case NOH_NODE_MACHINE: run_machine(s, g, set, node); break;
        case NOH_NODE_SELECT: run_select(s, g, set, node); break;
        case NOH_NODE_ONE_SHOT: run_one_shot(s, g, set, node); break;
        default: break;
        }
    }
}

/* Advance a node's fade. A one-shot that has faded out stays in play for the rest of this step, at weight 0, so that
 * its clip reaches its end. */
static void run_fade(noh_machine *m, int is_shot, uint32_t ticks)
{
    if (m->previous == NOH_GRAPH_NONE || m->switched) {
        return;
    }
    if (ticks < m->duration - m->elapsed) {
        m->elapsed += ticks;
    } else if (is_shot && !m->current && m->elapsed < m->duration) {
        m->elapsed = m->duration;
    } else {
        m->previous = NOH_GRAPH_NONE;
    }
}

static void run_fades(noh_graph_state *s, const noh_graph *g, uint32_t ticks)
{
    for (uint32_t i = 0; i < g->node_count; i++) {
        const noh_graph_node *node = &g->nodes[i];
        if (noh_graph_is_machine(node->kind)) {
            run_fade(&noh_graph_state_machines(s)[node->index], node->kind == NOH_NODE_ONE_SHOT, ticks);
        }
    }
}

void noh_graph_decide(noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set, uint32_t ticks)
{
    NOH_ASSERT(state && graph && set);
    NOH_VALIDATE(noh_graph_check(graph, set, NULL) == NOH_OK);
    NOH_ASSERT(state->node_count == graph->node_count && state->param_count == graph->param_count);
    drop_switches(state);
    run_machines(state, graph, set);
    run_fades(state, graph, ticks);
    noh_graph_weigh_tracks(state, graph);
}

uint32_t noh_graph_step(noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set, uint32_t ticks,
                        noh_event_fn fn, void *user)
{
    noh_graph_decide(state, graph, set, ticks);
    return noh_controller_step(noh_graph_controller(state), set, ticks, fn, user);
}
