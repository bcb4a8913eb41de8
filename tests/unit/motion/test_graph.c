/* Tests of runtime/graph/graph*.c. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "support/clip_set_fixture.h"
#include "motion/graph/graph_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/graph.h"
#include "noh/low_motion.h"

/* machine( blend1d(walk, run), jump, mask(add(walk, lean), wave), blend2d of four ) */
enum { CLIP_NODES = 11, NODES = 17, PARAMS = 6 };
enum { P_SPEED, P_JUMP, P_LAYERS, P_LEAN, P_X, P_Y };

typedef struct rig {
    scene s;
    noh_graph g;
    noh_graph_node nodes[NODES];
    uint16_t children[NODES];
    noh_track_desc clips[CLIP_NODES];
    noh_graph_transition transitions[6];
    float thresholds[2], defaults[PARAMS], points[8];
    uint8_t triangles[3 * NOH_BLEND_SPACE_TRIANGLES_MAX];
    noh_blend_space_2d space;
    uint32_t child_count;
} rig;

static uint32_t add_node(rig *r, noh_node_kind kind, uint32_t n, const uint32_t *children)
{
    noh_graph_node *node = &r->nodes[r->g.node_count];
    memset(node, 0, sizeof *node);
    node->kind = (uint16_t)kind;
    node->param = node->param_y = NOH_GRAPH_NONE;
    node->first_child = (uint16_t)r->g.child_count;
    node->child_count = (uint16_t)n;
    for (uint32_t i = 0; i < n; i++) r->children[r->g.child_count++] = (uint16_t)children[i];
    return r->g.node_count++;
}

static uint32_t add_clip(rig *r, uint32_t clip, uint32_t sync)
{
    uint32_t node = add_node(r, NOH_NODE_CLIP, 0, NULL);
    r->nodes[node].index = (uint16_t)r->g.clip_count;
    r->clips[r->g.clip_count].clip = clip;
    r->clips[r->g.clip_count++].sync_group = sync;
    return node;
}

static void transition(rig *r, uint32_t i, uint32_t from, uint32_t to, noh_condition when, uint32_t param,
                       float threshold, uint32_t ticks, uint32_t flags)
{
    noh_graph_transition *t = &r->transitions[i];
    t->from = (uint16_t)from;
    t->to = (uint16_t)to;
    t->condition = (uint16_t)when;
    t->param = (uint16_t)param;
    t->threshold = threshold;
    t->duration_ticks = ticks;
    t->flags = (uint16_t)flags;
    r->g.transition_count = i + 1u;
}

static void rig_nodes(rig *r)
{
    uint32_t c[4], states[4];
    c[0] = add_clip(r, WALK, 1);
    c[1] = add_clip(r, RUN, 1);
    states[0] = add_node(r, NOH_NODE_SPACE_1D, 2, c);
    r->nodes[states[0]].param = P_SPEED;
    states[1] = add_clip(r, JUMP, 0);
    c[0] = add_clip(r, WALK, 0);
    c[1] = add_clip(r, LEAN, 0);
    c[0] = add_node(r, NOH_NODE_ADD, 2, c);
    r->nodes[c[0]].param = P_LEAN;
    c[1] = add_clip(r, WAVE, 0);
    states[2] = add_node(r, NOH_NODE_MASK, 2, c);
    r->nodes[states[2]].value = 0.8f;
    r->nodes[states[2]].mask = 1;
    for (uint32_t i = 0; i < 4; i++) c[i] = add_clip(r, i, 0);
    states[3] = add_node(r, NOH_NODE_SPACE_2D, 4, c);
    r->nodes[states[3]].param = P_X;
    r->nodes[states[3]].param_y = P_Y;
    c[0] = add_node(r, NOH_NODE_MACHINE, 4, states);
    r->nodes[c[0]].item_count = 6;
    r->g.machine_count = 1;
    c[1] = add_clip(r, POSE, 0);
    c[0] = add_node(r, NOH_NODE_BLEND, 2, c); /* the root: all of it, and none of the last clip */
}

static void rig_open(rig *r)
{
    memset(r, 0, sizeof *r);
    scene_open(&r->s);
    rig_nodes(r);
    transition(r, 0, 0, 1, NOH_WHEN_TRIGGERED, P_JUMP, 0.5f, 4800, 0);
    transition(r, 1, 1, 0, NOH_WHEN_ENDING, 0, 0.0f, 9600, 0);
    transition(r, 2, 0, 2, NOH_WHEN_ABOVE, P_LAYERS, 0.5f, 9600, NOH_TRANSITION_INERTIAL);
    transition(r, 3, 2, 0, NOH_WHEN_BELOW, P_LAYERS, 0.5f, 9600, NOH_TRANSITION_INERTIAL | NOH_TRANSITION_KEEP);
    transition(r, 4, NOH_GRAPH_NONE, 3, NOH_WHEN_ABOVE, P_X, 2.0f, 0, 0);
    transition(r, 5, 3, 0, NOH_WHEN_BELOW, P_X, 2.0f, 0, 0);
    r->thresholds[1] = 1.0f;
    r->points[0] = 3, r->points[2] = 4, r->points[5] = 1, r->points[4] = 3, r->points[6] = 4, r->points[7] = 1;
    r->space.point_count = 4;
    r->space.points = r->points;
    r->space.triangles = r->triangles;
    assert_int_equal(noh_blend_space_2d_triangulate(4, r->points, r->triangles, &r->space.triangle_count, NULL),
                     NOH_OK);
    r->g.threshold_count = 2;
    r->g.space_count = 1;
    r->g.param_count = PARAMS;
    r->g.nodes = r->nodes;
    r->g.children = r->children;
    r->g.clips = r->clips;
    r->g.transitions = r->transitions;
    r->g.thresholds = r->thresholds;
    r->g.spaces = &r->space;
    r->g.param_defaults = r->defaults;
    r->defaults[P_LEAN] = 0.5f;
}

typedef struct stage {
    rig r;
    ALIGNED uint8_t memory[8192], scratch_memory[40000];
    noh_graph_state *state;
    noh_graph_scratch scratch;
    noh_transform pose[JOINTS], last[JOINTS];
    float floats[FLOATS];
} stage;

static void stage_open(stage *g)
{
    rig_open(&g->r);
    assert_int_equal(noh_graph_check(&g->r.g, &g->r.s.set, NULL), NOH_OK);
    assert_int_equal(noh_graph_state_init(g->memory, sizeof g->memory, &g->r.g, &g->r.s.set, &g->state, NULL), NOH_OK);
    assert_int_equal(
        noh_graph_scratch_init(g->scratch_memory, sizeof g->scratch_memory, &g->r.g, &g->r.s.set, &g->scratch, NULL),
        NOH_OK);
}

static void step(stage *g, uint32_t ticks)
{
    (void)noh_graph_step(g->state, &g->r.g, &g->r.s.set, ticks, NULL, NULL);
}
static void param(stage *g, uint32_t p, float value)
{
    assert_int_equal(noh_graph_set_param(g->state, p, value), NOH_OK);
}

/* Take the pose; the one before is in `last`. Returns how many clips were sampled. */
static uint32_t take_pose(stage *g)
{
    uint32_t samples = g->r.s.samples;
    memcpy(g->last, g->pose, sizeof g->last);
    noh_graph_pose(g->state, &g->r.g, &g->r.s.set, &g->scratch, g->pose, g->floats);
    return g->r.s.samples - samples;
}

static const noh_track *track(stage *g, uint32_t i)
{
    return noh_controller_track(noh_graph_controller(g->state), i);
}

static void clip_pose(stage *g, uint32_t slot, noh_transform *pose, float *floats)
{
    const noh_track *t = track(g, slot);
    scene_pose(&g->r.s, t->clip, noh_track_clip_tick(t, &g->r.s.clips[t->clip], 0), pose, floats);
}

/* ---- checking ---- */

static void bad_graph(rig *r, noh_result result, const char *what)
{
    noh_error error;
    assert_int_equal(noh_graph_check(&r->g, &r->s.set, &error), result);
    assert_int_equal(strncmp(error.what, what, strlen(what)), 0);
    assert_int_equal(noh_graph_state_size(&r->g, &r->s.set), 0);
    rig_open(r);
}

/* What is exactly at its limit is good. */
static void limits_themselves_are_allowed(void **state)
{
    rig r;
    (void)state;
    rig_open(&r);
    r.space.triangle_count = NOH_BLEND_SPACE_TRIANGLES_MAX;
    for (uint32_t i = 0; i < sizeof r.triangles; i++) r.triangles[i] = (uint8_t)(1u + i % 3u);
    r.points[0] = NOH_BLEND_SPACE_COORDINATE_MAX, r.points[7] = -NOH_BLEND_SPACE_COORDINATE_MAX;
    r.thresholds[0] = -NOH_BLEND_SPACE_COORDINATE_MAX, r.thresholds[1] = NOH_BLEND_SPACE_COORDINATE_MAX;
    assert_int_equal(noh_graph_check(&r.g, &r.s.set, NULL), NOH_OK);
    r.space.triangle_count++;
    bad_graph(&r, NOH_ERR_DATA, "space triangles");
}

static void counts_and_pointers_broken_in_turn(void **state)
{
    rig r;
    (void)state;
    rig_open(&r);
    r.g.node_count = 0;
    bad_graph(&r, NOH_ERR_ARG, "node_count");
    r.g.node_count = NOH_GRAPH_NODES_MAX + 1u;
    bad_graph(&r, NOH_ERR_ARG, "node_count");
    r.g.clip_count = 0;
    bad_graph(&r, NOH_ERR_ARG, "clip_count");
    r.g.clip_count = NOH_TRACKS_MAX + 1u;
    bad_graph(&r, NOH_ERR_ARG, "clip_count");
    r.g.clip_count = CLIP_NODES - 1u;
    bad_graph(&r, NOH_ERR_DATA, "clip index");
    r.g.child_count = NOH_GRAPH_NODES_MAX;
    bad_graph(&r, NOH_ERR_ARG, "child_count");
    r.g.machine_count = NODES + 1u;
    bad_graph(&r, NOH_ERR_ARG, "machine_count");
    r.g.machine_count = 2;
    bad_graph(&r, NOH_ERR_DATA, "machine_count");
    r.g.param_count = NOH_GRAPH_PARAMS_MAX + 1u;
    bad_graph(&r, NOH_ERR_ARG, "param_count");
    r.g.nodes = NULL;
    bad_graph(&r, NOH_ERR_ARG, "nodes");
    r.g.children = NULL;
    bad_graph(&r, NOH_ERR_ARG, "children");
    r.g.clips = NULL;
    bad_graph(&r, NOH_ERR_ARG, "clips");
    r.g.transitions = NULL;
    bad_graph(&r, NOH_ERR_ARG, "transitions");
    r.g.thresholds = NULL;
    bad_graph(&r, NOH_ERR_ARG, "thresholds");
    r.g.spaces = NULL;
    bad_graph(&r, NOH_ERR_ARG, "spaces");
    r.defaults[2] = NAN;
    bad_graph(&r, NOH_ERR_ARG, "param_defaults");
}

static void node_fields_broken_in_turn(void **state)
{
    rig r;
    uint32_t machine = NODES - 3u, space2 = machine - 1u, mask = 8;
    (void)state;
    rig_open(&r);
    assert_int_equal(r.nodes[machine].kind, NOH_NODE_MACHINE);
    assert_int_equal(r.nodes[space2].kind, NOH_NODE_SPACE_2D);
    assert_int_equal(r.nodes[mask].kind, NOH_NODE_MASK);
    r.nodes[2].kind = NOH_NODE_ONE_SHOT + 1;
    bad_graph(&r, NOH_ERR_DATA, "kind");
    r.nodes[0].child_count = 1;
    bad_graph(&r, NOH_ERR_DATA, "child_count");
    r.nodes[mask].child_count = 1;
    bad_graph(&r, NOH_ERR_DATA, "child_count");
    r.nodes[machine].child_count = NOH_GRAPH_CHILDREN_MAX + 1u;
    bad_graph(&r, NOH_ERR_DATA, "child_count");
    r.nodes[2].first_child = 400;
    bad_graph(&r, NOH_ERR_DATA, "children of the node lie outside");
    r.nodes[2].value = INFINITY;
    bad_graph(&r, NOH_ERR_DATA, "value");
    r.nodes[2].param = PARAMS;
    bad_graph(&r, NOH_ERR_DATA, "param");
    r.nodes[0].index = CLIP_NODES;
    bad_graph(&r, NOH_ERR_DATA, "clip index");
    r.nodes[0].index = 1;
    bad_graph(&r, NOH_ERR_DATA, "clip index");
    r.clips[4].clip = 99;
    bad_graph(&r, NOH_ERR_DATA, "clip is not a clip");
    r.clips[4].speed = NOH_SPEED_MAX + 1; /* the track's own words */
    bad_graph(&r, NOH_ERR_DATA, "speed is above NOH_SPEED_MAX");
    r.nodes[mask].mask = 0;
    bad_graph(&r, NOH_ERR_DATA, "mask");
    r.nodes[mask].mask = MASKS + 1u;
    bad_graph(&r, NOH_ERR_DATA, "mask");
    r.nodes[2].first_item = 1;
    bad_graph(&r, NOH_ERR_DATA, "thresholds of the node lie outside");
    r.thresholds[1] = 0.0f;
    bad_graph(&r, NOH_ERR_DATA, "thresholds must increase");
    r.thresholds[0] = NAN;
    bad_graph(&r, NOH_ERR_DATA, "thresholds must increase");
    r.nodes[space2].first_item = 1;
    bad_graph(&r, NOH_ERR_DATA, "space");
    r.nodes[space2].param_y = PARAMS;
    bad_graph(&r, NOH_ERR_DATA, "param_y");
    r.space.point_count = 3;
    bad_graph(&r, NOH_ERR_DATA, "space points");
    r.space.triangle_count = NOH_BLEND_SPACE_TRIANGLES_MAX + 1u;
    bad_graph(&r, NOH_ERR_DATA, "space triangles");
    r.triangles[4] = 4;
    bad_graph(&r, NOH_ERR_DATA, "space triangle");
    r.points[3] = NAN;
    bad_graph(&r, NOH_ERR_DATA, "space point");
    r.nodes[machine].index = 1;
    bad_graph(&r, NOH_ERR_DATA, "machine index");
    r.nodes[machine].first_item = 1;
    bad_graph(&r, NOH_ERR_DATA, "transitions of the machine lie outside");
    r.transitions[0].to = 4;
    bad_graph(&r, NOH_ERR_DATA, "transition states");
    r.transitions[0].from = 4;
    bad_graph(&r, NOH_ERR_DATA, "transition states");
    r.transitions[0].from = 1;
    bad_graph(&r, NOH_ERR_DATA, "transition states");
    r.transitions[0].condition = 4;
    bad_graph(&r, NOH_ERR_DATA, "transition condition");
    r.transitions[0].param = PARAMS;
    bad_graph(&r, NOH_ERR_DATA, "transition param");
    r.transitions[0].threshold = NAN;
    bad_graph(&r, NOH_ERR_DATA, "transition threshold");
    r.transitions[0].curve = 2;
    bad_graph(&r, NOH_ERR_DATA, "transition curve");
    r.transitions[0].flags = 4;
    bad_graph(&r, NOH_ERR_DATA, "transition flags");
    r.transitions[2].duration_ticks = 0;
    bad_graph(&r, NOH_ERR_DATA, "transition duration");
    r.children[0] = 1;
    bad_graph(&r, NOH_ERR_DATA, "node order");
    r.children[0] = 5;
    bad_graph(&r, NOH_ERR_DATA, "node order");
    r.g.node_count = NODES - 1u;
    bad_graph(&r, NOH_ERR_DATA, "more than one root");
}

/* Random bytes in the node and child arrays: refused, or run within bounds. */
static void random_graphs_do_no_harm(void **state)
{
    static stage g;
    uint32_t seed = 3, fine = 0;
    (void)state;
    for (int round = 0; round < 30000; round++) {
        uint8_t *bytes;
        size_t size;
        rig_open(&g.r);
        seed = seed * 1664525u + 1013904223u;
        bytes = seed & 1u ? (uint8_t *)g.r.nodes : seed & 2u ? (uint8_t *)g.r.children : (uint8_t *)g.r.transitions;
        size = seed & 1u ? sizeof g.r.nodes : seed & 2u ? 2u * g.r.g.child_count : sizeof g.r.transitions;
        bytes[(seed >> 8) % size] ^= (uint8_t)(1u << (seed >> 3) % 8u);
        if (noh_graph_check(&g.r.g, &g.r.s.set, NULL) != NOH_OK) continue;
        fine++;
        assert_int_equal(noh_graph_state_init(g.memory, sizeof g.memory, &g.r.g, &g.r.s.set, &g.state, NULL), NOH_OK);
        assert_int_equal(
            noh_graph_scratch_init(g.scratch_memory, sizeof g.scratch_memory, &g.r.g, &g.r.s.set, &g.scratch, NULL),
            NOH_OK);
        for (int i = 0; i < 6; i++) {
            if (i < PARAMS) (void)noh_graph_set_param(g.state, (uint32_t)i, 0.4f + (float)(seed >> 24));
            step(&g, 1600);
            (void)take_pose(&g);
        }
    }
    assert_true(fine > 1000);
}

static void memory_is_exact(void **state)
{
    static stage g;
    noh_graph_state *s = NULL;
    noh_error error;
    size_t size, scratch_size;
    (void)state;
    stage_open(&g);
    size = noh_graph_state_size(&g.r.g, &g.r.s.set);
    scratch_size = noh_graph_scratch_size(&g.r.g, &g.r.s.set);
    print_message("graph of %u nodes, %u clips: %lu bytes of state, %u pose buffers\n", NODES, CLIP_NODES,
                  (unsigned long)size, noh_graph_buffers(&g.r.g));
    memset(g.memory, 0xa5, sizeof g.memory);
    assert_int_equal(noh_graph_state_init(g.memory, size - 1u, &g.r.g, &g.r.s.set, &s, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, size);
    assert_int_equal(noh_graph_state_init(g.memory + 4, size, &g.r.g, &g.r.s.set, &s, &error), NOH_ERR_ARG);
    assert_null(s);
    assert_int_equal(g.memory[0], 0xa5);
    assert_int_equal(noh_graph_state_init(g.memory, size, &g.r.g, &g.r.s.set, &g.state, &error), NOH_OK);
    assert_int_equal(
        noh_graph_scratch_init(g.scratch_memory, scratch_size - 1u, &g.r.g, &g.r.s.set, &g.scratch, &error),
        NOH_ERR_MEMORY);
    assert_int_equal(error.need, scratch_size);
    assert_int_equal(noh_graph_scratch_init(NULL, scratch_size, &g.r.g, &g.r.s.set, &g.scratch, &error), NOH_ERR_ARG);
    memset(g.scratch_memory, 0xa5, sizeof g.scratch_memory);
    assert_int_equal(noh_graph_scratch_init(g.scratch_memory, scratch_size, &g.r.g, &g.r.s.set, &g.scratch, &error),
                     NOH_OK);
    param(&g, P_LAYERS, 1.0f);
    for (int i = 0; i < 20; i++) {
        step(&g, 1000);
        (void)take_pose(&g);
    }
    for (size_t i = size; i < sizeof g.memory; i++) assert_int_equal(g.memory[i], 0xa5);
    for (size_t i = scratch_size; i < sizeof g.scratch_memory; i++) assert_int_equal(g.scratch_memory[i], 0xa5);
    assert_int_equal(noh_graph_set_param(g.state, PARAMS, 0.0f), NOH_ERR_ARG);
    assert_int_equal(noh_graph_set_param(g.state, 0, NAN), NOH_ERR_ARG);
    assert_true(noh_graph_param(g.state, P_LEAN) == 0.5f);
}

/* ---- poses ---- */

static void blend_spaces_stay_in_step(void **state)
{
    static stage g;
    noh_transform a[JOINTS], b[JOINTS], want[JOINTS];
    float fa[FLOATS], fb[FLOATS];
    (void)state;
    stage_open(&g);
    for (int i = 0; i <= 10; i++) {
        float t = (float)i / 10.0f;
        param(&g, P_SPEED, t);
        step(&g, 3000);
        assert_int_equal(take_pose(&g), i == 0 || i == 10 ? 1 : 2); /* clips of weight 0 are not sampled */
        clip_pose(&g, 0, a, fa);
        clip_pose(&g, 1, b, fb);
        noh_pose_mix(JOINTS, a, b, t, NULL, want);
        assert_true(pose_apart(g.pose, want, JOINTS) < 2e-6);
        assert_true(track(&g, 0)->weight == 1.0f - t && track(&g, 1)->weight == t);
    }
    assert_int_equal(track(&g, 0)->mode, NOH_TRACK_TIME_ONLY); /* keeps step with the run */
    assert_int_equal(track(&g, 2)->mode, NOH_TRACK_OFF);       /* not in this state */
    assert_int_equal(track(&g, 2)->position, 0);
}

static void a_cross_fade_returns_at_the_end(void **state)
{
    static stage g;
    noh_transform a[JOINTS], b[JOINTS], want[JOINTS];
    float floats[FLOATS];
    (void)state;
    stage_open(&g);
    step(&g, 5000);
    param(&g, P_JUMP, 1.0f);
    for (int i = 1; i <= 4; i++) {
        step(&g, 1200);
        assert_int_equal(noh_graph_machine_state(g.state, 0), 1);
        assert_true(noh_graph_param(g.state, P_JUMP) == 0.0f); /* the trigger is used up */
        assert_int_equal(take_pose(&g), i < 4 ? 2 : 1);
        clip_pose(&g, 0, a, floats);
        clip_pose(&g, 2, b, floats);
        noh_pose_mix(JOINTS, a, b, (float)i / 4.0f, NULL, want);
        assert_true(pose_apart(g.pose, want, JOINTS) < 2e-6);
    }
    step(&g, 36000 - 4800 - 9600 - 1);
    assert_int_equal(noh_graph_machine_state(g.state, 0), 1);
    step(&g, 1); /* decided at the start of a step */
    step(&g, 1);
    assert_int_equal(noh_graph_machine_state(g.state, 0), 0);     /* 9600 ticks before its end */
    assert_int_equal(track(&g, 0)->position, noh_position_of(1)); /* started again */
}

static void layers_play_inertial_transitions(void **state)
{
    static stage g;
    noh_transform walk[JOINTS], lean[JOINTS], wave[JOINTS], want[JOINTS];
    float f0[FLOATS], f1[FLOATS], f2[FLOATS];
    double largest = 0.0, cut;
    int64_t left_at;
    (void)state;
    stage_open(&g);
    step(&g, 30000);
    (void)take_pose(&g);
    left_at = track(&g, 0)->position;
    param(&g, P_LAYERS, 1.0f);
    step(&g, 1);
    assert_int_equal(noh_graph_machine_state(g.state, 0), 2);
    (void)take_pose(&g);
    assert_true(pose_apart(g.pose, g.last, JOINTS) < 1e-3); /* one tick of play, no jump */
    clip_pose(&g, 3, walk, f0);
    cut = pose_apart(g.pose, walk, JOINTS);
    for (int i = 0; i < 30; i++) {
        step(&g, 400);
        assert_int_equal(take_pose(&g), 3); /* the new state alone */
        if (i < 24) largest = fmax(largest, pose_apart(g.pose, g.last, JOINTS));
    }
    print_message("inertial switch of a state: largest step %.3f, a cut more than %.3f\n", largest, cut);
    assert_true(largest < 0.5 * cut);
    clip_pose(&g, 3, walk, f0);
    clip_pose(&g, 4, lean, f1);
    clip_pose(&g, 5, wave, f2);
    noh_pose_difference(JOINTS, g.r.s.bind, lean, lean);
    memcpy(want, walk, sizeof want);
    noh_pose_add(JOINTS, lean, 0.5f, NULL, want);
    noh_pose_mix(JOINTS, want, wave, 0.8f, g.r.s.masks[0], want);
    assert_true(pose_apart(g.pose, want, JOINTS) < 3e-6);
    for (uint32_t i = 0; i < FLOATS; i++) {
        float base = f0[i] + 0.5f * (f1[i] - g.r.s.defaults[i]), w = 0.8f * (float)g.r.s.masks[0][JOINTS + i] / 255.0f;
        assert_true(fabsf(g.floats[i] - (base * (1.0f - w) + f2[i] * w)) < 1e-6f);
    }
    param(&g, P_LAYERS, 0.0f);
    step(&g, 0);
    assert_int_equal(noh_graph_machine_state(g.state, 0), 0);
    assert_int_equal(track(&g, 0)->position - left_at, noh_position_of(1)); /* goes on where it was left */
}

/* Half a walk, half a face: nodes leave joints to the clips that animate them, and floats too. */
static void clips_of_joints_and_of_floats_do_not_mix(void **state)
{
    static const noh_node_kind kinds[3] = { NOH_NODE_BLEND, NOH_NODE_ADD, NOH_NODE_MASK };
    static const uint16_t children[2] = { 0, 1 };
    (void)state;
    for (int k = 0; k < 3; k++) {
        ALIGNED uint8_t memory[2048], scratch_memory[16384];
        noh_track_desc clips[2] = { track_of(WALK, 0.0f), track_of(WAVE, 0.0f) };
        noh_graph_node nodes[3];
        noh_graph graph;
        noh_graph_state *it;
        noh_graph_scratch scratch;
        scene s;
        noh_transform walk[JOINTS], face[JOINTS], pose[JOINTS];
        float walk_floats[FLOATS], face_floats[FLOATS], floats[FLOATS];
        uint8_t mask[JOINTS + FLOATS];
        memset(mask, 255, sizeof mask);
        scene_open(&s);
        s.set.masks = mask;
        s.set.mask_count = 1;
        s.clips[WALK].flags = NOH_CLIP_JOINTS_ONLY;
        s.clips[WAVE].flags = NOH_CLIP_FLOATS_ONLY;
        memset(nodes, 0, sizeof nodes);
        memset(&graph, 0, sizeof graph);
        for (uint16_t i = 0; i < 3; i++) nodes[i].index = i, nodes[i].param = NOH_GRAPH_NONE;
        nodes[2].kind = (uint16_t)kinds[k];
        nodes[2].child_count = 2;
        nodes[2].mask = 1;
        nodes[2].value = 0.5f;
        graph.node_count = 3, graph.child_count = 2, graph.clip_count = 2;
        graph.nodes = nodes, graph.children = children, graph.clips = clips;
        assert_int_equal(noh_graph_state_init(memory, sizeof memory, &graph, &s.set, &it, NULL), NOH_OK);
        assert_int_equal(noh_graph_scratch_init(scratch_memory, sizeof scratch_memory, &graph, &s.set, &scratch, NULL),
                         NOH_OK);
        scene_pose(&s, WALK, 0, walk, walk_floats);
        scene_pose(&s, WAVE, 0, face, face_floats);
        noh_graph_pose(it, &graph, &s.set, &scratch, pose, floats);
        assert_true(pose_apart(pose, walk, JOINTS) < 1e-6);
        if (kinds[k] == NOH_NODE_BLEND) assert_true(floats_apart(floats, face_floats, FLOATS) < 1e-6);
    }
}

/* A blend under a mask: mask(jump, blend(walk, wave)). Of joints and floats the blend has what either of its clips has.
 */
static void a_blend_has_what_either_clip_has(void **state)
{
    static const uint16_t children[4] = { 1, 2, 0, 3 }; /* of the blend, then of the mask */
    ALIGNED uint8_t memory[4096], scratch_memory[16384];
    noh_track_desc clips[3] = { track_of(JUMP, 0.0f), track_of(WALK, 0.0f), track_of(WAVE, 0.0f) };
    noh_graph_node nodes[5];
    noh_graph graph;
    noh_graph_state *it;
    noh_graph_scratch scratch;
    scene s;
    noh_transform walk[JOINTS], face[JOINTS], pose[JOINTS];
    float walk_floats[FLOATS], face_floats[FLOATS], floats[FLOATS];
    uint8_t mask[JOINTS + FLOATS];
    (void)state;
    memset(mask, 255, sizeof mask);
    scene_open(&s);
    s.set.masks = mask;
    s.set.mask_count = 1;
    s.clips[WALK].flags = NOH_CLIP_JOINTS_ONLY;
    s.clips[WAVE].flags = NOH_CLIP_FLOATS_ONLY;
    memset(nodes, 0, sizeof nodes);
    memset(&graph, 0, sizeof graph);
    for (uint16_t i = 0; i < 3; i++) nodes[i].index = i;
    for (uint16_t i = 0; i < 5; i++) nodes[i].param = nodes[i].param_y = NOH_GRAPH_NONE;
    nodes[3].kind = NOH_NODE_BLEND;
    nodes[4].kind = NOH_NODE_MASK;
    nodes[3].child_count = nodes[4].child_count = 2;
    nodes[3].value = 0.5f;
    nodes[4].value = 1.0f;
    nodes[4].mask = 1;
    nodes[4].first_child = 2;
    graph.node_count = 5, graph.child_count = 4, graph.clip_count = 3;
    graph.nodes = nodes, graph.children = children, graph.clips = clips;
    assert_int_equal(noh_graph_state_init(memory, sizeof memory, &graph, &s.set, &it, NULL), NOH_OK);
    assert_int_equal(noh_graph_scratch_init(scratch_memory, sizeof scratch_memory, &graph, &s.set, &scratch, NULL),
                     NOH_OK);
    scene_pose(&s, WALK, 0, walk, walk_floats);
    scene_pose(&s, WAVE, 0, face, face_floats);
    noh_graph_pose(it, &graph, &s.set, &scratch, pose, floats);
    assert_true(pose_apart(pose, walk, JOINTS) < 1e-6);
    assert_true(floats_apart(floats, face_floats, FLOATS) < 1e-6);
}

static void a_state_may_be_a_space_of_two_dimensions(void **state)
{
    static stage g;
    noh_transform want[JOINTS];
    float floats[FLOATS];
    (void)state;
    stage_open(&g);
    param(&g, P_X, 4.0f);
    param(&g, P_Y, 1.0f);
    step(&g, 100);
    assert_int_equal(noh_graph_machine_state(g.state, 0), 3);
    assert_int_equal(take_pose(&g), 1);
    clip_pose(&g, 9, want, floats);
    assert_true(pose_apart(g.pose, want, JOINTS) < 1e-6);
    param(&g, P_X, 3.4f);
    param(&g, P_Y, 0.3f);
    step(&g, 100);
    assert_int_equal(take_pose(&g), 3);
    param(&g, P_X, 0.0f);
    step(&g, 100);
    assert_int_equal(noh_graph_machine_state(g.state, 0), 0);
}

static void count_event(void *user, const noh_event *e)
{
    uint32_t *counts = user;
    counts[e->track]++;
}

/* A graph's clips fire their keys by their weights in it. */
static void clips_fire_by_their_weights(void **state)
{
    static stage g;
    uint32_t counts[CLIP_NODES] = { 0 };
    (void)state;
    rig_open(&g.r);
    for (uint32_t m = 0; m < 2; m++) {
        g.r.s.clips[m].first_event = m;
        g.r.s.clips[m].event_count = 1;
        g.r.s.events[m].tick = 10000;
        g.r.s.events[m].weight_min = 0.5f;
    }
    assert_int_equal(noh_graph_state_init(g.memory, sizeof g.memory, &g.r.g, &g.r.s.set, &g.state, NULL), NOH_OK);
    param(&g, P_SPEED, 0.3f);
    (void)noh_graph_step(g.state, &g.r.g, &g.r.s.set, 480000, count_event, counts);
    assert_true(counts[0] > 5 && counts[1] == 0);
    param(&g, P_SPEED, 0.7f);
    memset(counts, 0, sizeof counts);
    (void)noh_graph_step(g.state, &g.r.g, &g.r.s.set, 480000, count_event, counts);
    assert_true(counts[0] == 0 && counts[1] > 5);
}

/* An instance is cloned by one memcpy. */
static void a_graph_is_cloned_by_memcpy(void **state)
{
    static stage g;
    static ALIGNED uint8_t copy[8192];
    noh_transform first[JOINTS];
    (void)state;
    stage_open(&g);
    param(&g, P_LAYERS, 1.0f);
    step(&g, 700);
    (void)take_pose(&g);
    memcpy(copy, g.state, g.state->bytes);
    for (int i = 0; i < 10; i++) step(&g, 480);
    (void)take_pose(&g);
    memcpy(first, g.pose, sizeof first);
    g.state = (noh_graph_state *)(void *)copy;
    memset(g.memory, 0xff, sizeof g.memory);
    for (int i = 0; i < 10; i++) step(&g, 480);
    (void)take_pose(&g);
    assert_memory_equal(first, g.pose, sizeof first);
}

static void a_switch_without_a_pose_is_taken(void **state)
{
    static stage g;
    (void)state;
    stage_open(&g);
    assert_int_equal(noh_controller_set_lod(noh_graph_controller(g.state), 0, 7), NOH_OK);
    param(&g, P_LAYERS, 1.0f);
    step(&g, 100);
    step(&g, 100); /* the inertial transition was not posed: it switched without */
    assert_int_equal(noh_graph_controller(g.state)->inertia_ticks, 0);
    assert_int_equal(take_pose(&g), 3);
    assert_memory_equal(g.pose + 7, g.r.s.bind + 7, (JOINTS - 7u) * sizeof *g.pose);
    assert_int_equal(track(&g, 0)->mode, NOH_TRACK_OFF);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(limits_themselves_are_allowed),
        cmocka_unit_test(counts_and_pointers_broken_in_turn),
        cmocka_unit_test(node_fields_broken_in_turn),
        cmocka_unit_test(random_graphs_do_no_harm),
        cmocka_unit_test(memory_is_exact),
        cmocka_unit_test(blend_spaces_stay_in_step),
        cmocka_unit_test(a_cross_fade_returns_at_the_end),
        cmocka_unit_test(layers_play_inertial_transitions),
        cmocka_unit_test(clips_of_joints_and_of_floats_do_not_mix),
        cmocka_unit_test(a_blend_has_what_either_clip_has),
        cmocka_unit_test(a_state_may_be_a_space_of_two_dimensions),
        cmocka_unit_test(clips_fire_by_their_weights),
        cmocka_unit_test(a_graph_is_cloned_by_memcpy),
        cmocka_unit_test(a_switch_without_a_pose_is_taken),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
