/* Tests of graph_root.c: how far a graph moves its character. Each clip goes straight ahead at a speed of its own, or
 * stands, or has no joints at all. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "support/clip_set_fixture.h"
#include "motion/anim/root_motion_internal.h"
#include "motion/graph/graph_internal.h"
#include "noh/graph.h"
#include "noh/low_motion.h"

enum { STROLL, SPRINT, CLIMB, FACE, OWN_CLIPS };

#define SECOND 48000u

typedef struct world {
    noh_clip_set set;
    noh_clip_entry clips[OWN_CLIPS];
    noh_root_track roots[OWN_CLIPS];
    noh_transform bind[2];
    uint8_t masks[2][2];
    noh_graph graph;
    noh_graph_node nodes[8];
    noh_track_desc tracks[4];
    uint16_t children[8];
    ALIGNED uint8_t memory[4096];
    noh_graph_state *state;
} world;

/* Metres a second along x, y and z. */
static const float speeds[OWN_CLIPS][3] = { { 0, 0, 1 }, { 0, 0, 4 }, { 2, 0, 0 }, { 8, 0, 8 } };

static void sample(void *user, uint32_t clip, uint32_t tick, uint32_t joints, noh_transform *pose, uint32_t floats,
                   float *values)
{
    const world *w = user;
    (void)floats, (void)values;
    for (uint32_t j = 0; j < joints; j++) pose[j] = w->bind[j];
    for (int i = 0; i < 3; i++) pose[0].translation[i] = speeds[clip][i] * (float)tick / (float)SECOND;
}

static void open_world(world *w)
{
    memset(w, 0, sizeof *w);
    for (int j = 0; j < 2; j++) {
        w->bind[j].rotation[3] = w->bind[j].scale[0] = w->bind[j].scale[1] = w->bind[j].scale[2] = 1.0f;
    }
    for (uint32_t i = 0; i < OWN_CLIPS; i++) {
        w->clips[i].duration_ticks = 10u * SECOND;
        w->clips[i].loop = NOH_LOOP_REPEAT;
    }
    w->masks[0][0] = 51; /* a fifth of the root */
    w->masks[1][1] = 255;
    w->set.clip_count = OWN_CLIPS;
    w->set.joint_count = 2;
    w->set.mask_count = 2;
    w->set.masks = w->masks[0];
    w->set.clips = w->clips;
    w->set.bind_pose = w->bind;
    w->set.sample = sample;
    w->set.user = w;
    assert_int_equal(noh_clip_set_check(&w->set, NULL), NOH_OK);
    for (uint32_t i = 0; i < OWN_CLIPS; i++) {
        assert_int_equal(noh_root_track_measure(&w->set, i, NOH_ROOT_GROUND, 1, &w->roots[i], NULL), NOH_OK);
    }
    w->clips[FACE].flags |= NOH_CLIP_FLOATS_ONLY;
    w->set.roots = w->roots;
    w->graph.nodes = w->nodes;
    w->graph.children = w->children;
    w->graph.clips = w->tracks;
}

static uint16_t clip(world *w, uint32_t of)
{
    noh_graph_node *n = &w->nodes[w->graph.node_count];
    memset(n, 0, sizeof *n);
    n->kind = NOH_NODE_CLIP;
    n->param = n->param_y = NOH_GRAPH_NONE;
    n->index = (uint16_t)w->graph.clip_count;
    w->tracks[w->graph.clip_count++].clip = of;
    return (uint16_t)w->graph.node_count++;
}

static uint16_t pair(world *w, noh_node_kind kind, uint16_t a, uint16_t b, float value, uint16_t mask)
{
    noh_graph_node *n = &w->nodes[w->graph.node_count];
    memset(n, 0, sizeof *n);
    n->kind = (uint16_t)kind;
    n->param = n->param_y = NOH_GRAPH_NONE;
    n->value = value;
    n->mask = mask;
    n->first_child = (uint16_t)w->graph.child_count;
    n->child_count = 2;
    w->children[w->graph.child_count++] = a;
    w->children[w->graph.child_count++] = b;
    return (uint16_t)w->graph.node_count++;
}

/* A quarter of a second moves by these speeds, and receives once. */
static void goes(world *w, double x, double z)
{
    noh_root_pose moved;
    noh_error said;
    if (noh_graph_check(&w->graph, &w->set, &said)) fail_msg("%s", said.what);
    assert_int_equal(noh_graph_state_init(w->memory, sizeof w->memory, &w->graph, &w->set, &w->state, NULL), NOH_OK);
    for (int part = 0; part < 2; part++) {
        (void)noh_graph_step(w->state, &w->graph, &w->set, SECOND / 4u, NULL, NULL);
        moved = noh_graph_root_motion(w->state, &w->graph, &w->set);
        if (fabs(moved.translation[0] - 0.25 * x) > 1e-5 || fabs(moved.translation[2] - 0.25 * z) > 1e-5) {
            fail_msg("%g %g instead of %g %g", moved.translation[0], moved.translation[2], 0.25 * x, 0.25 * z);
        }
        assert_true(moved.translation[1] == 0.0 && moved.turn == 0);
        moved = noh_graph_root_motion(w->state, &w->graph, &w->set);
        assert_true(moved.translation[0] == 0.0 && moved.translation[2] == 0.0);
    }
}

static void blends_go_by_their_shares(void **state)
{
    static const float parts[] = { 0.0f, 0.25f, 0.5f, 1.0f };
    (void)state;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        const double p = (double)parts[i];
        world w;
        open_world(&w);
        const uint16_t a = clip(&w, SPRINT), b = clip(&w, CLIMB);
        (void)pair(&w, NOH_NODE_BLEND, a, b, parts[i], 0);
        goes(&w, 2.0 * p, 4.0 * (1.0 - p));
    }
}

/* A clip of floats alone takes nothing from a walk, at any weight and at any depth. */
static void faces_slow_nobody_down(void **state)
{
    world w;
    (void)state;
    open_world(&w);
    uint16_t a = clip(&w, SPRINT), b = clip(&w, FACE);
    (void)pair(&w, NOH_NODE_BLEND, a, b, 0.75f, 0);
    goes(&w, 0.0, 4.0);
    open_world(&w);
    a = clip(&w, FACE), b = clip(&w, SPRINT);
    a = pair(&w, NOH_NODE_BLEND, a, b, 0.25f, 0);
    b = clip(&w, CLIMB);
    (void)pair(&w, NOH_NODE_BLEND, a, b, 0.5f, 0);
    goes(&w, 1.0, 2.0);
    open_world(&w);
    a = clip(&w, FACE), b = clip(&w, FACE);
    (void)pair(&w, NOH_NODE_BLEND, a, b, 0.5f, 0);
    goes(&w, 0.0, 0.0);
}

/* What is added moves joints, not the character; what is layered moves it by the mask's part of the first joint. */
static void layers_go_by_their_mask(void **state)
{
    world w;
    (void)state;
    open_world(&w);
    uint16_t a = clip(&w, STROLL), b = clip(&w, CLIMB);
    (void)pair(&w, NOH_NODE_ADD, a, b, 1.0f, 0);
    goes(&w, 0.0, 1.0);
    for (uint16_t mask = 1; mask <= 2; mask++) {
        const double part = mask == 1 ? 0.5 * 0.2 : 0.0;
        open_world(&w);
        a = clip(&w, STROLL), b = clip(&w, CLIMB);
        (void)pair(&w, NOH_NODE_MASK, a, b, 0.5f, mask);
        goes(&w, 2.0 * part, 1.0 - part);
    }
    open_world(&w);
    a = clip(&w, STROLL), b = clip(&w, FACE);
    (void)pair(&w, NOH_NODE_MASK, a, b, 1.0f, 1);
    goes(&w, 0.0, 1.0);
}

static void without_roots_nothing_goes(void **state)
{
    world w;
    (void)state;
    open_world(&w);
    w.set.roots = NULL;
    const uint16_t a = clip(&w, STROLL), b = clip(&w, CLIMB);
    (void)pair(&w, NOH_NODE_BLEND, a, b, 0.5f, 0);
    goes(&w, 0.0, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blends_go_by_their_shares),
        cmocka_unit_test(faces_slow_nobody_down),
        cmocka_unit_test(layers_go_by_their_mask),
        cmocka_unit_test(without_roots_nothing_goes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
