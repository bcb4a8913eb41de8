/* Tests of graph_weights.c: the weight of each node. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "support/clip_set_fixture.h"
#include "motion/graph/graph_weights_internal.h"
#include "motion/graph/graph_internal.h"

static noh_graph_node node_of(noh_node_kind kind, uint32_t first_child, uint32_t child_count, float value)
{
    noh_graph_node n;
    memset(&n, 0, sizeof n);
    n.kind = (uint16_t)kind;
    n.first_child = (uint16_t)first_child;
    n.child_count = (uint16_t)child_count;
    n.param = n.param_y = NOH_GRAPH_NONE;
    n.value = value;
    return n;
}

/* Amounts outside 0..1 are held at its ends, NaN at 0. */
static void amounts_are_held(void **state)
{
    static const float given[] = { -3.0f, 0.0f, 0.25f, 1.0f, 7.0f, NAN },
                       held[] = { 0.0f, 0.0f, 0.25f, 1.0f, 1.0f, 0.0f };
    const noh_graph graph = { 0 };
    const noh_graph_view view = { &graph, NULL, NULL, 0 };
    (void)state;
    for (size_t i = 0; i < sizeof given / sizeof given[0]; i++) {
        const noh_graph_node blend = node_of(NOH_NODE_BLEND, 0, 2, given[i]),
                             add = node_of(NOH_NODE_ADD, 0, 2, given[i]);
        float local[2];
        noh_graph_child_weights(&view, &blend, local);
        assert_true(local[0] == 1.0f - held[i] && local[1] == held[i]);
        noh_graph_child_weights(&view, &add, local);
        assert_true(local[0] == 1.0f && local[1] == held[i]);
    }
}

/* A machine is in one state, or fades along its curve; an inertial switch shows the old state until the pose is taken.
 */
static void machines_fade_along_their_curve(void **state)
{
    const noh_graph graph = { 0 };
    const noh_graph_node node = node_of(NOH_NODE_MACHINE, 0, 3, 0.0f);
    noh_machine m = { 2, NOH_GRAPH_NONE, 0, 0, 0, 0, { 0, 0 } };
    noh_graph_view view = { &graph, NULL, &m, 0 };
    float local[3];
    (void)state;
    noh_graph_child_weights(&view, &node, local);
    assert_true(local[0] == 0.0f && local[1] == 0.0f && local[2] == 1.0f);
    m = (noh_machine){ 2, 1, 25, 100, NOH_CURVE_LINEAR, 0, { 0, 0 } };
    noh_graph_child_weights(&view, &node, local);
    assert_true(local[0] == 0.0f && local[1] == 0.75f && local[2] == 0.25f);
    m.curve = NOH_CURVE_SMOOTHSTEP;
    noh_graph_child_weights(&view, &node, local);
    assert_true(local[1] == 0.84375f && local[2] == 0.15625f);
    m.switched = 1;
    noh_graph_child_weights(&view, &node, local);
    assert_true(local[1] == 0.0f && local[2] == 1.0f);
    view.before = 1;
    noh_graph_child_weights(&view, &node, local);
    assert_true(local[1] == 1.0f && local[2] == 0.0f);
}

/* Weights multiply from the root down. A product that would underflow stays above zero, because what a parent asks for
 * must be sampled. Zero stays zero. */
static void products_never_vanish(void **state)
{
    static const uint16_t children[4] = { 0, 1, 2, 3 };
    noh_graph_node nodes[5] = { node_of(NOH_NODE_CLIP, 0, 0, 0), node_of(NOH_NODE_CLIP, 0, 0, 0),
                                node_of(NOH_NODE_CLIP, 0, 0, 0), node_of(NOH_NODE_BLEND, 0, 2, 1e-30f),
                                node_of(NOH_NODE_BLEND, 2, 2, 1e-30f) };
    noh_graph graph;
    noh_graph_view view = { &graph, NULL, NULL, 0 };
    float weights[5];
    uint8_t active[5];
    (void)state;
    memset(&graph, 0, sizeof graph);
    graph.node_count = 5;
    graph.nodes = nodes;
    graph.children = children;
    noh_graph_weights(&view, weights, active);
    assert_true(weights[4] == 1.0f && weights[3] == 1e-30f && weights[2] == 1.0f);
    assert_true(weights[0] > 0.0f && weights[1] > 0.0f && weights[1] < 1e-30f);
    nodes[3].value = 0.0f;
    noh_graph_weights(&view, weights, active);
    assert_true(weights[0] == 1e-30f && weights[1] == 0.0f);
    for (int i = 0; i < 5; i++) assert_int_equal(active[i], 1);
}

/* Only the state that a machine is in and the one that it is leaving have weight. */
static void machines_shut_the_other_states_out(void **state)
{
    static const uint16_t children[3] = { 0, 1, 2 };
    const noh_graph_node nodes[4] = { node_of(NOH_NODE_CLIP, 0, 0, 0), node_of(NOH_NODE_CLIP, 0, 0, 0),
                                      node_of(NOH_NODE_CLIP, 0, 0, 0), node_of(NOH_NODE_MACHINE, 0, 3, 0) };
    const noh_machine m = { 2, 0, 10, 100, NOH_CURVE_LINEAR, 0, { 0, 0 } };
    noh_graph graph;
    const noh_graph_view view = { &graph, NULL, &m, 0 };
    float weights[4];
    uint8_t active[4];
    (void)state;
    memset(&graph, 0, sizeof graph);
    graph.node_count = 4;
    graph.nodes = nodes;
    graph.children = children;
    noh_graph_weights(&view, weights, active);
    assert_true(active[0] == 1 && active[1] == 0 && active[2] == 1 && active[3] == 1);
    assert_int_equal(noh_graph_first_of(&graph, 3), 0);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(amounts_are_held),
        cmocka_unit_test(machines_fade_along_their_curve),
        cmocka_unit_test(products_never_vanish),
        cmocka_unit_test(machines_shut_the_other_states_out),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
