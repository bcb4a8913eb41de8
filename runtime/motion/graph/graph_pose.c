/* The pose of a graph: graph_internal.h, noh_graph_scratch_* and noh_graph_pose. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "motion/anim/controller_pose_internal.h"
#include "motion/anim/root_motion_internal.h"
#include "motion/graph/graph_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/graph.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "motion/graph/graph_weights_internal.h"
#include "motion/anim/clip_set_internal.h"
#include "motion/pose/blend_internal.h"

#define NO_BUFFER 255u
#define LACKS (NOH_CLIP_FLOATS_ONLY | NOH_CLIP_JOINTS_ONLY)

/* ---- scratch ---- */

static size_t pose_bytes(const noh_clip_set *set)
{
    return set->joint_count * sizeof(noh_transform);
}

size_t noh_graph_shape_scratch_size(const noh_graph_shape *shape, const noh_clip_set *set)
{
    noh_arena arena = noh_arena_measure();
    if (noh_clip_set_excess(set)) {
        return 0;
    }
    (void)noh_arena_carve(&arena, noh_pose_scratch_size(set, shape->inertial), 16);
    for (uint32_t i = 0; i < shape->buffer_count; i++) {
        (void)noh_arena_carve(&arena, pose_bytes(set), 4);
        (void)noh_arena_carve(&arena, set->float_count * sizeof(float), 4);
    }
    return arena.used;
}

size_t noh_graph_scratch_size(const noh_graph *graph, const noh_clip_set *set)
{
    NOH_ASSERT(graph && set);
    const noh_graph_shape shape = noh_graph_shape_of(graph);
    return noh_graph_shape_scratch_size(&shape, set);
}

noh_result noh_graph_scratch_init(void *memory, size_t bytes, const noh_graph *graph, const noh_clip_set *set,
                                  noh_graph_scratch *scratch, noh_error *error)
{
    NOH_ASSERT(graph && set && scratch);
    const char *what = noh_clip_set_excess(set);
    size_t pose_need = noh_pose_scratch_size(set, noh_graph_is_inertial(graph));
    noh_arena arena;
    noh_result result = what ? noh_fail(error, NOH_ERR_ARG, what, 0, 0)
                             : noh_arena_open(&arena, memory, bytes, noh_graph_scratch_size(graph, set), error);
    if (result != NOH_OK) {
        return result;
    }
    memset(scratch, 0, sizeof *scratch);
    result = noh_pose_scratch_init(noh_arena_carve(&arena, pose_need, 16), pose_need, set, noh_graph_is_inertial(graph),
                                   &scratch->pose, error);
    for (uint32_t i = 0; i < noh_graph_buffers(graph); i++) {
        scratch->poses[i] = (noh_transform *)noh_arena_carve(&arena, pose_bytes(set), 4);
        scratch->float_poses[i] = (float *)noh_arena_carve(&arena, set->float_count * sizeof(float), 4);
    }
    return result;
}

/* ---- evaluation ---- */

typedef struct evaluation {
    noh_graph_view view;
    const noh_clip_set *set;
    const noh_controller *c;
    noh_graph_scratch *scratch;
    int64_t ago;
    uint32_t taken; /* a bit per buffer */
    float weights[NOH_GRAPH_NODES_MAX];
    uint8_t buffer[NOH_GRAPH_NODES_MAX]; /* the buffer with a node's pose, or NO_BUFFER */
    /* NOH_CLIP_FLOATS_ONLY, NOH_CLIP_JOINTS_ONLY: what no clip in the buffer's pose animates */
    uint8_t lacks[NOH_GRAPH_BUFFERS_MAX];
} evaluation;

static uint8_t take_buffer(evaluation *e)
{
    uint8_t i = 0;
    while (e->taken >> i & 1u) {
        i++; /* terminates: noh_graph_buffers counted the buffers */
    }
    e->taken |= 1u << i;
    return i;
}

static void free_buffer(evaluation *e, uint8_t buffer)
{
    e->taken &= ~(1u << buffer);
}

static void evaluate_clip(evaluation *e, uint32_t i)
{
    const noh_track *t = noh_controller_track(e->c, e->view.graph->nodes[i].index);
    uint8_t buffer = take_buffer(e);
    noh_root_sample_rest(e->set, t->clip, noh_track_clip_tick(t, &e->set->clips[t->clip], e->ago),
                         e->c->lod_joint_count, e->scratch->poses[buffer], e->scratch->float_poses[buffer]);
    e->buffer[i] = buffer;
    e->lacks[buffer] = (uint8_t)(e->set->clips[t->clip].flags & LACKS);
}

/* The children that have a pose, and their weights. */
typedef struct parts {
    uint32_t count;
    uint8_t buffers[3];
    float weights[3];
} parts;

static parts parts_of(evaluation *e, const noh_graph_node *node)
{
    float local[NOH_GRAPH_CHILDREN_MAX];
    parts p = { 0, { 0, 0, 0 }, { 0.0f, 0.0f, 0.0f } };
    noh_graph_child_weights(&e->view, node, local);
    for (uint32_t k = 0; k < node->child_count && p.count < 3; k++) {
        uint8_t buffer = e->buffer[e->view.graph->children[node->first_child + k]];
        if (buffer != NO_BUFFER) {
            p.buffers[p.count] = buffer;
            p.weights[p.count++] = local[k];
        }
    }
    return p;
}

/* Blend the children by weight, as a controller blends tracks, into the first child's buffer. */
static void sum_parts(evaluation *e, const parts *p)
{
    static const noh_mask_view everywhere = { NULL, NULL };
    noh_blend *b = &e->scratch->pose.blend;
    uint8_t lacks = LACKS;
    if (p->count < 2) {
        return;
    }
    noh_blend_begin(b);
    for (uint32_t k = 0; k < p->count; k++) {
        uint8_t buffer = p->buffers[k];
        noh_blend_add(b, e->lacks[buffer] & NOH_CLIP_FLOATS_ONLY ? NULL : e->scratch->poses[buffer],
                      e->lacks[buffer] & NOH_CLIP_JOINTS_ONLY ? NULL : e->scratch->float_poses[buffer], p->weights[k],
                      everywhere);
        lacks = (uint8_t)(lacks & e->lacks[buffer]);
    }
    e->lacks[p->buffers[0]] = lacks;
    noh_blend_finish(b, e->set->bind_pose, e->set->float_defaults, e->scratch->poses[p->buffers[0]],
                     e->scratch->float_poses[p->buffers[0]]);
}

/* The first clip of a subtree. It decides for all of them: whether they are differences, and from which bind pose. */
static uint32_t first_clip(const evaluation *e, uint32_t node)
{
    const noh_graph *g = e->view.graph;
    return noh_controller_track(e->c, g->nodes[noh_graph_first_of(g, node)].index)->clip;
}

/* Add the second child as a difference: directly, or relative to the reference pose. */
static void add_part(evaluation *e, const noh_graph_node *node, const parts *p)
{
    uint32_t joints = e->c->lod_joint_count, floats = e->set->float_count;
    noh_transform *over = e->scratch->poses[p->buffers[1]];
    float *float_over = e->scratch->float_poses[p->buffers[1]];
    const uint32_t clip = first_clip(e, e->view.graph->children[node->first_child + 1u]);
    if (!(e->set->clips[clip].flags & NOH_CLIP_ADDITIVE)) {
        noh_transform *pose = e->scratch->pose.sample;
        float *values = e->scratch->pose.float_sample;
        noh_reference_pose(e->set, clip, node->item_count ? node->first_item + 1u : 0u, joints, pose, values);
        noh_pose_difference(joints, pose, over, over);
        for (uint32_t i = 0; i < floats; i++) float_over[i] -= values[i];
    }
    if (!(e->lacks[p->buffers[1]] & NOH_CLIP_FLOATS_ONLY)) {
        noh_pose_add(joints, over, p->weights[1], NULL, e->scratch->poses[p->buffers[0]]);
    }
    if (!(e->lacks[p->buffers[1]] & NOH_CLIP_JOINTS_ONLY)) {
        noh_floats_add(floats, float_over, p->weights[1], NULL, e->scratch->float_poses[p->buffers[0]]);
    }
    e->lacks[p->buffers[0]] &= e->lacks[p->buffers[1]];
}

/* Lay the second child over the first where the mask allows; joints and floats that it does not animate stay as in the
 * first. */
static void mask_part(evaluation *e, const noh_graph_node *node, const parts *p)
{
    noh_mask_view mask = noh_clip_set_mask(e->set, node->mask);
    noh_transform *base = e->scratch->poses[p->buffers[0]];
    float *float_base = e->scratch->float_poses[p->buffers[0]];
    if (!(e->lacks[p->buffers[1]] & NOH_CLIP_FLOATS_ONLY)) {
        noh_pose_mix(e->c->lod_joint_count, base, e->scratch->poses[p->buffers[1]], p->weights[1], mask.joints, base);
    }
    if (!(e->lacks[p->buffers[1]] & NOH_CLIP_JOINTS_ONLY)) {
        noh_floats_mix(e->set->float_count, float_base, e->scratch->float_poses[p->buffers[1]], p->weights[1],
                       mask.floats, float_base);
    }
    e->lacks[p->buffers[0]] &= e->lacks[p->buffers[1]];
}

static void evaluate_node(evaluation *e, uint32_t i)
{
    const noh_graph_node *node = &e->view.graph->nodes[i];
    parts p = parts_of(e, node);
    if (node->kind == NOH_NODE_ADD && p.count == 2) {
        add_part(e, node, &p);
    } else if (node->kind == NOH_NODE_MASK || node->kind == NOH_NODE_ONE_SHOT) {
        if (p.count == 2) mask_part(e, node, &p);
    } else if (node->kind != NOH_NODE_ADD) {
        sum_parts(e, &p);
    }
    for (uint32_t k = 1; k < p.count; k++) {
        free_buffer(e, p.buffers[k]);
    }
    e->buffer[i] = p.count ? p.buffers[0] : (uint8_t)NO_BUFFER;
}

/* In post-order, evaluation is a loop over an array: children come before their node and leave their poses in buffers;
 * the node combines them in the first one's buffer and frees the others. `before`: the state before the inertial
 * transitions that begin now. */
static void evaluate(const noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set,
                     noh_graph_scratch *scratch, int before, int64_t ago, noh_transform *pose, float *floats)
{
    evaluation e;
    uint8_t active[NOH_GRAPH_NODES_MAX], buffer;
    memset(&e, 0, sizeof e);
    e.view.graph = graph;
    e.view.params = noh_graph_params_of(state);
    e.view.machines = noh_graph_machines_of(state);
    e.view.before = before;
    e.set = set;
    e.c = noh_graph_controller_of(state);
    e.scratch = scratch;
    e.ago = ago;
    scratch->pose.blend.joint_count = e.c->lod_joint_count;
    scratch->pose.blend.float_count = set->float_count;
    noh_graph_weights(&e.view, e.weights, active);
    for (uint32_t i = 0; i < graph->node_count; i++) {
        e.buffer[i] = NO_BUFFER;
        if (e.weights[i] > 0.0f && graph->nodes[i].kind == NOH_NODE_CLIP) {
            evaluate_clip(&e, i);
        } else if (e.weights[i] > 0.0f) {
            evaluate_node(&e, i);
        }
    }
    buffer = e.buffer[graph->node_count - 1];
    memcpy(pose, scratch->poses[buffer], e.c->lod_joint_count * sizeof *pose);
    for (uint32_t i = e.c->lod_joint_count; i < set->joint_count; i++) {
        pose[i] = set->bind_pose[i];
    }
    if (set->float_count) {
        memcpy(floats, scratch->float_poses[buffer], set->float_count * sizeof *floats);
    }
}

/* ---- transitions by inertia ---- */

/* As for a controller's transitions: four poses, before and after the switch, now and a moment ago; their differences
 * become the offsets that decay. The offsets of a running transition belong to the poses before the switch. */
static void begin_inertia(noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set,
                          noh_graph_scratch *scratch)
{
    noh_controller *c = noh_graph_controller(state);
    noh_pose_scratch *p = &scratch->pose;
    noh_machine *machines = (noh_machine *)(void *)((uint8_t *)state + state->machines_offset);
    for (int k = 0; k < 4; k++) { /* source, source before, target, target before */
        int64_t ago = k & 1 ? NOH_INERTIA_BEFORE_TICKS : 0;
        evaluate(state, graph, set, scratch, k < 2, ago, p->captured[k], p->float_captured[k]);
        if (k < 2) {
            noh_controller_inertia_add(c, ago, p->captured[k], p->float_captured[k]);
        }
    }
    noh_controller_inertia_store(c, p, state->inertia_ticks);
    for (uint32_t i = 0; i < state->machine_count; i++) {
        if (machines[i].switched) {
            machines[i].switched = 0;
            machines[i].previous = NOH_GRAPH_NONE;
        }
    }
    state->inertia_ticks = 0;
}

void noh_graph_pose_ago(const noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set,
                        noh_graph_scratch *scratch, int64_t ago, noh_transform *pose, float *floats)
{
    NOH_ASSERT(state && graph && set && scratch && (!set->joint_count || pose) && (!set->float_count || floats));
    NOH_VALIDATE(noh_graph_check(graph, set, NULL) == NOH_OK);
    NOH_ASSERT(state->node_count == graph->node_count);
    evaluate(state, graph, set, scratch, 0, ago, pose, floats);
    noh_controller_inertia_add(noh_graph_controller_of(state), ago, pose, floats);
}

void noh_graph_pose(noh_graph_state *state, const noh_graph *graph, const noh_clip_set *set, noh_graph_scratch *scratch,
                    noh_transform *pose, float *floats)
{
    NOH_ASSERT(state && graph && set && scratch && state->node_count == graph->node_count);
    if (state->inertia_ticks) {
        begin_inertia(state, graph, set, scratch);
    }
    noh_graph_pose_ago(state, graph, set, scratch, 0, pose, floats);
}
