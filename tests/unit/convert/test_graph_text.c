/* test_graph_text.c: animation graphs from text files. */
#include "support/graph_fixture.h"

#include "dump/dump_graph.h"
#include "noh/base.h"
#include "noh/graph.h"
#include "noh/pack.h"

/* The message and line of a text that is refused; binding it to clips "walk", "run", "wave" and joints "root", "head".
 */
static void refused(const char *text, uint32_t line, const char *what)
{
    const char *path = test_path("bad.graph");
    raw_set *set = raw_set_new(2, 3);
    graph_file *file = NULL;
    model_error error = { "", "" };
    uint32_t at = 0;
    int failed;
    set->skeleton.joints[0].name = model_string("root");
    set->skeleton.joints[1].name = model_string("head");
    set->clips[0].name = model_string("walk");
    set->clips[1].name = model_string("run");
    set->clips[2].name = model_string("wave");
    test_write_file(path, text, strlen(text));
    failed = graph_text_read(path, &file, &at, &error);
    if (!failed) failed = graph_text_bind(file, &set, 1, &at, &error);
    if (!failed || at != line || !strstr(error.what, what)) {
        fail_msg("'%s': %u: '%s' instead of %u: '%s'", text, at, error.what, line, what);
    }
    assert_string_equal(error.where, "");
    graph_text_free(file);
    raw_set_free(set);
}

/* Text that is read, with a clip "walk" that loops and "run" that ends; the warnings, one a line. */
static void warns(const char *text, int all_loop, const char *what)
{
    const char *path = test_path("warned.graph");
    raw_set *set = raw_set_new(2, 2);
    model *m = model_new();
    graph_file *file = NULL;
    model_error error = { "", "" };
    uint32_t at = 0;
    char all[2048] = "";
    set->skeleton.joints[0].name = model_string("root");
    set->skeleton.joints[1].name = model_string("head");
    set->clips[0].name = model_string("walk");
    set->clips[1].name = model_string("run");
    set->clips[0].loop = 1;
    test_write_file(path, text, strlen(text));
    if (graph_text_read(path, &file, &at, &error) || graph_text_bind(file, &set, 1, &at, &error)) {
        fail_msg("%u: %s", (unsigned)at, error.what);
    }
    assert_int_equal(graph_text_warn(file, &set, 1, all_loop, "a.graph", m), 0);
    for (uint32_t i = 0; i < m->warning_count; i++) {
        strcat(all, m->warnings[i]);
        strcat(all, "\n");
    }
    assert_string_equal(all, what);
    graph_text_free(file);
    raw_set_free(set);
    model_free(m);
}

static void what_waits_for_the_end_of_a_loop_is_warned_of(void **state)
{
    static const char *const by_walk = "a.graph:5: `from walk to run when ending` is never true: 'walk' loops, so it "
                                       "never ends: give the clip loop=once\n";
    (void)state;
    warns("graph a\nclip walk\nclip run\nmachine m walk run\nfrom walk to run when ending\n", 0, by_walk);
    warns("graph a\nclip walk loop=ping-pong\nclip run\nmachine m walk run\nfrom walk to run when ending\n", 0,
          by_walk);
    warns("graph a\nclip walk loop=once\nclip run\nmachine m walk run\nfrom walk to run when ending\n", 1, "");
    warns("graph a\nclip walk\nclip run\nmachine m walk run\nfrom run to walk when ending\n", 0, "");
    warns("graph a\nclip walk\nclip run\nmachine m walk run\nfrom run to walk when ending\n", 1,
          "a.graph:5: `from run to walk when ending` is never true: 'run' loops, so it never ends: give the clip "
          "loop=once\n");
    warns("graph a\nclip walk\nclip run paused=yes\nmachine m walk run\nfrom run to walk when ending\n", 0,
          "a.graph:5: `from run to walk when ending` is never true: 'run' is paused, so it never ends: remove "
          "paused=yes\n");
    /* from any state: one that ends is enough, except for the one that it leads to */
    warns("graph a\nclip walk\nclip run\nclip w walk\nmachine m walk run w\nfrom any to w when ending\n", 0, "");
    warns("graph a\nclip walk\nclip run\nmachine m walk run\nfrom any to run when ending\n", 0,
          "a.graph:5: `from any to run when ending` is never true: 'walk' loops, so it never ends: give the clip "
          "loop=once\n");
    /* a state of several clips ends with its first */
    warns("graph a\nnumber v 0 1\nclip walk\nclip run\nclip r run\nblend b walk run by=v\nmachine m b r\n"
          "from b to r when ending\n",
          0,
          "a.graph:8: `from b to r when ending` is never true: 'walk' loops, so it never ends: give the clip "
          "loop=once\n");
    warns("graph a\ntrigger t\nclip walk\nclip run paused=yes\none-shot s walk run on=t\n", 0,
          "a.graph:5: the one-shot 's' never ends: 'run' is paused, so it never ends: remove paused=yes\n");
    warns("graph a\ntrigger t\nclip run\nclip walk\none-shot s run walk on=t\n", 1, "");
}

static void bad_lines_are_refused_with_their_number(void **state)
{
    (void)state;
    refused("", 0, "the file has no graph");
    refused("# nothing\n\n", 0, "the file has no graph");
    refused("clip walk\n", 1, "the first statement must be: graph NAME");
    refused("graph a\ngraph a\n", 1, "has no nodes");
    refused("graph a\nclip walk\ngraph a\n", 3, "the graph 'a' is given twice; the first is in line 1");
    refused("graph a\nclpi walk\n", 2, "no statement begins with 'clpi'; did you mean 'clip'?");
    refused("graph a\nclip \"walk\n", 2, "a quote is not closed");
    refused("graph a\nclip \"\"\n", 2, "a name is empty");
    refused("graph a\nclip\n", 2, "a name is missing");
    refused("graph a\nclip walk walk walk\n", 2, "one word too many");
    refused("graph a\nclip walk sped=2\n", 2, "no option 'sped', or has it twice; did you mean 'speed'?");
    refused("graph a\nclip walk speed=2 speed=2\n", 2, "has it twice");
    refused("graph a\nclip walk speed=fast\n", 2, "'fast' is not a number");
    refused("graph a\nclip walk speed=0\n", 2, "the speed of 'walk' is 0");
    refused("graph a\nclip walk speed=300\n", 2, "must be -256 to 256");
    refused("graph a\nclip walk loop=repeats\n", 2, "did you mean 'repeat'?");
    refused("graph a\nclip walk\nclip walk\n", 3, "the node 'walk' is given twice; the first is in line 2");
    refused("graph a\nclip any\n", 2, "'any' means every state");
}

static void parameters_are_checked(void **state)
{
    (void)state;
    refused("graph a\nnumber x 1\n", 2, "the highest value is missing");
    refused("graph a\nnumber x 2 1\n", 2, "the range of 'x' is empty");
    refused("graph a\nnumber x 0 1 initial=2\n", 2, "must be 0 to 1");
    refused("graph a\nnumber x 0 1e39\n", 2, "too large");
    refused("graph a\ninteger x 0 1.5\n", 2, "whole numbers");
    refused("graph a\nnumber 2x 0 1\n", 2, "reads as a number");
    refused("graph a\nnumber \"x y\" 0 1\n", 2, "it has a blank");
    refused("graph a\nenum e\n", 2, "'e' has no values");
    refused("graph a\nenum e a b a\n", 2, "the value 'a' twice");
    refused("graph a\nenum e calm glad initial=glda\n", 2, "did you mean 'glad'?");
    refused("graph a\ntrigger t\nnumber t 0 1\n", 3, "the parameter 't' is given twice; the first is in line 2");
    refused("graph a\nmask m\nbelow head weight=2\n", 3, "must be 0 to 1");
    refused("graph a\nbelow head\n", 2, "belongs to a mask");
    refused("graph a\nmask m\nclip walk\njoint head\n", 4, "belongs to a mask");
    refused("graph a\nmask m\nmask m\n", 3, "the mask 'm' is given twice; the first is in line 2");
}

#define TWO "graph a\nnumber v 0 1\nenum e p q\ntrigger t\nmask m\nclip walk\nclip run\n" /* 7 lines */

static void nodes_are_checked(void **state)
{
    (void)state;
    refused(TWO, 7, "'run': it is the child of no node, and neither is 'walk'");
    refused(TWO "blend b walk\n", 8, "a second node is missing");
    refused(TWO "blend b walk run\n", 8, "'b' needs by=PARAMETER");
    refused(TWO "blend b walk run by=2\n", 8, "must be 0 to 1");
    refused(TWO "blend b walk ruin by=v\n", 8, "there is no node 'ruin'; did you mean 'run'?");
    refused(TWO "blend b walk walk by=v\n", 8, "'walk' is already a child of 'b'");
    refused(TWO "blend b walk run by=w\n", 8, "there is no parameter 'w'; did you mean 'v'?");
    refused(TWO "blend b walk run by=t\n", 8, "'t' must be a number here");
    refused(TWO "layer b walk run by=v\n", 8, "'b' needs mask=MASK");
    refused(TWO "add b walk run by=v reference=wlak\n", 8, "no input has a clip 'wlak'; did you mean 'walk'?");
    refused(TWO "blend b walk run by=v reference=walk\n", 8, "no option 'reference'");
    refused(TWO "layer b walk run by=v mask=n\n", 8, "there is no mask 'n'");
    refused(TWO "space b walk 0 run by=v\n", 8, "the place of a node is missing");
    refused(TWO "space b walk 1 run 1 by=v\n", 8, "'run' is not above 'walk'");
    refused(TWO "space b walk 1 1 run 1 1 by=v,v\n", 8, "two points are equal");
    refused(TWO "space b walk 1 1 run 1 by=v,v\n", 8, "the second coordinate of a node is missing");
    refused(TWO "select b walk run by=v\n", 8, "'v' must be an enum or an integer here");
    refused(TWO "select b walk run by=e fade=0.1 inertia=0.1\n", 8, "fade or inertia, not both");
    refused(TWO "clip c wave\nselect b walk run c by=e\n", 9, "'b' has 3 children, and 'e' 2 values");
    refused(TWO "integer i 0 2\nselect b walk run by=i\n", 9, "'b' has children 0 to 1, and 'i' goes from 0 to 2");
    refused(TWO "one-shot b walk run\n", 8, "'b' needs on=TRIGGER");
    refused(TWO "one-shot b walk run on=v\n", 8, "'v' must be a trigger here");
    refused(TWO "clip c wave loop=repeat\nblend d walk run by=v\none-shot b d c on=t\n", 10, "'c' never ends");
    refused("graph a\nnumber v 0 1\nclip walk\nblend b c walk by=v\nblend c b d by=v\nclip d run\n", 5,
            "'c': it is its own descendant");
    refused("graph a\nnumber v 0 1\nclip walk\nblend b c d by=v\nblend c b e by=v\nclip d run\nclip e run\n", 5,
            "'c': it is its own descendant");
}

static void transitions_are_checked(void **state)
{
    (void)state;
    refused(TWO "from walk to run when ending\n", 8, "'from' belongs to a machine");
    refused(TWO "machine b walk run\nfrom walk run\n", 9, "'to' is missing");
    refused(TWO "machine b walk run\nfrom walk to run\n", 9, "'when' is missing");
    refused(TWO "machine b walk run\nfrom walk to run when v\n", 9, "'v' must be a trigger, or above or below");
    refused(TWO "machine b walk run\nfrom walk to run when v over 1\n", 9, "'over' is neither above nor below");
    refused(TWO "machine b walk run\nfrom walk to run when t above 1\n", 9, "'t' must be a number");
    refused(TWO "machine b walk run\nfrom wlak to run when t\n", 9, "no state 'wlak'; did you mean 'walk'?");
    refused(TWO "machine b walk run\nfrom run to run when t\n", 9, "from 'run' to itself");
    refused(TWO "machine b walk run\nfrom any to run when t fade=-1\n", 9, "must be 0 to 3600");
    refused(TWO "machine b walk run\nfrom any to run when ending fade=1 entre=keep\n", 9, "did you mean 'enter'?");
}

static void clips_and_joints_are_those_of_the_inputs(void **state)
{
    (void)state;
    refused("graph a\nclip wlak\n", 2, "no input has a clip 'wlak'; did you mean 'walk'?");
    refused("graph a\nmask m\n\n  below haed\nclip walk\n", 4, "no input has a joint 'haed'; did you mean 'head'?");
    refused("graph a\nclip walk\ngraph b\nclip x zzzzzz\n", 4, "no input has a clip 'zzzzzz'");
}

/* ---- what comes out ---- */

static noh_pack_graph graph_of(const set_fixture *x, uint32_t index)
{
    noh_pack_graph g;
    assert_int_equal(noh_pack_graph_at(&x->pack, index, &g, NULL), NOH_OK);
    return g;
}

static void equal_texts_make_equal_packs(void **state)
{
    set_fixture a = graph_fixture_pack(GRAPH_FIXTURE_TEXT), b = graph_fixture_pack(GRAPH_FIXTURE_TEXT);
    (void)state;
    assert_int_equal(a.pack.byte_count, b.pack.byte_count);
    assert_memory_equal(a.bytes, b.bytes, a.pack.byte_count);
    free(a.bytes);
    free(b.bytes);
}

/* Nodes may be defined in any order. */
static void the_order_of_nodes_does_not_matter(void **state)
{
    set_fixture a = graph_fixture_pack("graph g\nnumber v 0 1\nclip p clip0\nclip q clip1\nblend r p q by=v\n"),
                b = graph_fixture_pack("graph g\nblend r p q by=v\nclip q clip1\nclip p clip0\n# more\nnumber v 0 1\n");
    (void)state;
    assert_memory_equal(a.bytes, b.bytes, a.pack.byte_count);
    free(a.bytes);
    free(b.bytes);
}

/* The text that noh dump writes makes the same pack. */
static void a_dumped_graph_builds_to_the_same_bytes(void **state)
{
    set_fixture a = graph_fixture_pack(GRAPH_FIXTURE_TEXT "graph \"another one\"\nclip \"a b\" clip0 start=0.0001\n"),
                b;
    byte_buffer text = { NULL, 0, 0, 0 };
    (void)state;
    assert_int_equal(a.pack.runs[NOH_CHUNK_GRAPH].count, 2);
    for (uint32_t i = 0; i < 2; i++) {
        const noh_pack_graph g = graph_of(&a, i);
        dump_graph(&text, &g);
    }
    buffer_append(&text, "", 1);
    b = graph_fixture_pack((const char *)text.bytes);
    assert_int_equal(a.pack.byte_count, b.pack.byte_count);
    assert_memory_equal(a.bytes, b.bytes, a.pack.byte_count);
    buffer_free(&text);
    free(a.bytes);
    free(b.bytes);
}

static void names_may_have_blanks(void **state)
{
    set_fixture x = graph_fixture_pack(
        "graph \"my hero\" # a comment\r\nclip \"long walk\" clip0\nclip run clip1\nnumber v 0 1\n"
        "\n\tspace s \"long walk\" 0 run 1 by=v\n");
    const noh_pack_graph g = graph_of(&x, 0);
    (void)state;
    assert_string_equal(g.name, "my hero");
    assert_string_equal(noh_pack_string(&x.pack, g.nodes[0].name), "long walk");
    assert_true(g.points[1] == 1.0f);
    free(x.bytes);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(bad_lines_are_refused_with_their_number),
    cmocka_unit_test(what_waits_for_the_end_of_a_loop_is_warned_of),
    cmocka_unit_test(parameters_are_checked),
    cmocka_unit_test(nodes_are_checked),
    cmocka_unit_test(transitions_are_checked),
    cmocka_unit_test(clips_and_joints_are_those_of_the_inputs),
    cmocka_unit_test(equal_texts_make_equal_packs),
    cmocka_unit_test(the_order_of_nodes_does_not_matter),
    cmocka_unit_test(a_dumped_graph_builds_to_the_same_bytes),
    cmocka_unit_test(names_may_have_blanks),
};

TEST_MAIN(tests, NULL, NULL)
