/* Tests of the nodes that choose: SELECT and ONE_SHOT (graph_step.c). */
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

/* one_shot( select(walk, run, wave), jump ) */
enum { N_WALK, N_RUN, N_WAVE, N_SELECT, N_JUMP, N_SHOT, NODES };
enum { T_WALK, T_RUN, T_WAVE, T_JUMP, TRACKS };
enum { P_CHOICE, P_JUMP, PARAMS };
enum { M_SELECT, M_SHOT };

#define FADE 4800u
#define IN 2400u
#define OUT 3600u
#define JUMP_TICKS 36000u

typedef struct stage {
    scene s;
    noh_graph g;
    noh_graph_node nodes[NODES];
    uint16_t children[NODES];
    noh_track_desc clips[TRACKS];
    float defaults[PARAMS];
    ALIGNED uint8_t memory[4096], scratch_memory[40000];
    noh_graph_state *state;
    noh_graph_scratch scratch;
    noh_transform pose[JOINTS];
    float floats[FLOATS];
    uint32_t fired[8]; /* by key */
} stage;

static void describe(stage *g)
{
    static const uint16_t children[] = { N_WALK, N_RUN, N_WAVE, N_SELECT, N_JUMP };
    static const uint16_t tracks[NODES] = { T_WALK, T_RUN, T_WAVE, M_SELECT, T_JUMP, M_SHOT };
    memset(g, 0, sizeof *g);
    scene_open(&g->s);
    memcpy(g->children, children, sizeof children);
    for (uint32_t i = 0; i < NODES; i++) {
        g->nodes[i].param = g->nodes[i].param_y = NOH_GRAPH_NONE;
        g->nodes[i].index = tracks[i];
    }
    g->clips[T_RUN].clip = RUN, g->clips[T_WAVE].clip = WAVE, g->clips[T_JUMP].clip = JUMP;
    g->nodes[N_SELECT].kind = NOH_NODE_SELECT, g->nodes[N_SELECT].child_count = 3;
    g->nodes[N_SELECT].param = P_CHOICE, g->nodes[N_SELECT].fade_ticks = FADE;
    g->nodes[N_SHOT].kind = NOH_NODE_ONE_SHOT, g->nodes[N_SHOT].first_child = 3, g->nodes[N_SHOT].child_count = 2;
    g->nodes[N_SHOT].param = P_JUMP, g->nodes[N_SHOT].value = 0.5f;
    g->nodes[N_SHOT].fade_ticks = IN, g->nodes[N_SHOT].fade_out_ticks = OUT;
    g->g.node_count = NODES, g->g.child_count = 5, g->g.clip_count = TRACKS, g->g.machine_count = 2;
    g->g.param_count = PARAMS;
    g->g.nodes = g->nodes, g->g.children = g->children, g->g.clips = g->clips, g->g.param_defaults = g->defaults;
}

static void open_stage(stage *g)
{
    assert_int_equal(noh_graph_state_init(g->memory, sizeof g->memory, &g->g, &g->s.set, &g->state, NULL), NOH_OK);
    assert_int_equal(
        noh_graph_scratch_init(g->scratch_memory, sizeof g->scratch_memory, &g->g, &g->s.set, &g->scratch, NULL),
        NOH_OK);
}

static stage *new_stage(void)
{
    static stage g;
    describe(&g);
    open_stage(&g);
    return &g;
}

static void count(void *user, const noh_event *e)
{
    ((stage *)user)->fired[e->key - ((stage *)user)->s.events]++;
}

static void step(stage *g, uint32_t ticks)
{
    (void)noh_graph_step(g->state, &g->g, &g->s.set, ticks, count, g);
}

static void param(stage *g, uint32_t p, float value)
{
    assert_int_equal(noh_graph_set_param(g->state, p, value), NOH_OK);
}

static const noh_track *track(stage *g, uint32_t i)
{
    return noh_controller_track(noh_graph_controller(g->state), i);
}

static uint32_t take_pose(stage *g)
{
    uint32_t samples = g->s.samples;
    noh_graph_pose(g->state, &g->g, &g->s.set, &g->scratch, g->pose, g->floats);
    return g->s.samples - samples;
}

static void clip_pose(stage *g, uint32_t t, noh_transform *pose, float *floats)
{
    scene_pose(&g->s, track(g, t)->clip, noh_track_clip_tick(track(g, t), &g->s.clips[track(g, t)->clip], 0), pose,
               floats);
}

/* ---- select ---- */

static void a_select_shows_the_child_of_its_number(void **state)
{
    static const struct {
        float value;
        uint32_t child;
    } cases[] = { { -7.0f, 0 }, { 0.4f, 0 }, { 0.6f, 1 }, { 1.0f, 1 },
                  { 1.49f, 1 }, { 1.5f, 2 }, { 2.0f, 2 }, { 3e38f, 2 } };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        static stage g;
        noh_transform want[JOINTS];
        float floats[FLOATS];
        describe(&g);
        g.defaults[P_CHOICE] = cases[i].value;
        open_stage(&g); /* at once: a select is entered without a fade */
        assert_int_equal(noh_graph_machine_state(g.state, M_SELECT), cases[i].child);
        step(&g, 1000);
        assert_int_equal(take_pose(&g), 1);
        clip_pose(&g, cases[i].child, want, floats);
        assert_true(pose_apart(g.pose, want, JOINTS) < 1e-6);
        for (uint32_t t = 0; t < 3; t++) assert_int_equal(track(&g, t)->mode == NOH_TRACK_OFF, t != cases[i].child);
    }
}

static void a_change_of_choice_cross_fades(void **state)
{
    stage *g = new_stage();
    noh_transform a[JOINTS], b[JOINTS], want[JOINTS];
    float floats[FLOATS];
    (void)state;
    step(g, 7000);
    param(g, P_CHOICE, 1.0f);
    for (uint32_t i = 1; i <= 4; i++) {
        step(g, FADE / 4u);
        assert_int_equal(noh_graph_machine_state(g->state, M_SELECT), 1);
        assert_int_equal(take_pose(g), i < 4 ? 2 : 1);
        clip_pose(g, T_WALK, a, floats);
        clip_pose(g, T_RUN, b, floats);
        noh_pose_mix(JOINTS, a, b, (float)i / 4.0f, NULL, want);
        assert_true(pose_apart(g->pose, want, JOINTS) < 2e-6);
        assert_int_equal(track(g, T_RUN)->position, noh_position_of(i * (FADE / 4u))); /* from its beginning */
    }
    assert_int_equal(track(g, T_WALK)->mode, NOH_TRACK_OFF);
}

/* Back to where it came from a fade turns round without a jump of the weights; a third child waits for its end. */
static void a_fade_of_a_select_turns_round(void **state)
{
    stage *g = new_stage();
    (void)state;
    param(g, P_CHOICE, 1.0f);
    step(g, FADE / 4u);
    step(g, FADE / 4u);
    step(g, FADE / 4u);
    assert_true(track(g, T_RUN)->weight == 0.75f);
    param(g, P_CHOICE, 0.0f);
    step(g, FADE / 4u);
    assert_int_equal(noh_graph_machine_state(g->state, M_SELECT), 0);
    assert_true(track(g, T_RUN)->weight == 0.5f && track(g, T_WALK)->weight == 0.5f);
    assert_int_equal(track(g, T_WALK)->position, noh_position_of(FADE)); /* it never began again */
    param(g, P_CHOICE, 2.0f);
    step(g, FADE / 4u);
    assert_int_equal(noh_graph_machine_state(g->state, M_SELECT), 0);
    step(g, FADE / 4u);
    step(g, FADE / 4u);
    assert_int_equal(noh_graph_machine_state(g->state, M_SELECT), 2);
    assert_true(track(g, T_WAVE)->weight == 0.25f && track(g, T_WALK)->weight == 0.75f);
}

static void a_kept_child_goes_on_where_it_was(void **state)
{
    static stage g;
    int64_t left_at;
    (void)state;
    describe(&g);
    g.nodes[N_SELECT].fade_ticks = 0;
    g.nodes[N_SELECT].flags = NOH_TRANSITION_KEEP;
    open_stage(&g);
    step(&g, 5000);
    left_at = track(&g, T_WALK)->position;
    param(&g, P_CHOICE, 1.0f);
    step(&g, 3000);
    assert_int_equal(track(&g, T_WALK)->position, left_at);
    param(&g, P_CHOICE, 0.0f);
    step(&g, 1);
    assert_int_equal(track(&g, T_WALK)->position - left_at, noh_position_of(1));
}

static void a_select_may_switch_by_inertia(void **state)
{
    static stage g;
    noh_transform last[JOINTS], run[JOINTS];
    float floats[FLOATS];
    (void)state;
    describe(&g);
    g.nodes[N_SELECT].flags = NOH_TRANSITION_INERTIAL;
    open_stage(&g);
    step(&g, 20000);
    (void)take_pose(&g);
    memcpy(last, g.pose, sizeof last);
    param(&g, P_CHOICE, 1.0f);
    step(&g, 1);
    (void)take_pose(&g);
    assert_true(pose_apart(g.pose, last, JOINTS) < 1e-3); /* no jump */
    clip_pose(&g, T_RUN, run, floats);
    assert_true(pose_apart(g.pose, run, JOINTS) > 0.05);
    step(&g, FADE);
    assert_int_equal(take_pose(&g), 1); /* the new child alone, and nothing is left of the old one */
    clip_pose(&g, T_RUN, run, floats);
    assert_true(pose_apart(g.pose, run, JOINTS) < 1e-5);
}

/* ---- one-shot ---- */

static void a_one_shot_fades_in_and_out_by_the_end_of_its_clip(void **state)
{
    stage *g = new_stage();
    noh_transform below[JOINTS], over[JOINTS], want[JOINTS];
    float floats[FLOATS];
    uint32_t played = 0;
    (void)state;
    step(g, 1000);
    assert_int_equal(take_pose(g), 1);
    assert_int_equal(track(g, T_JUMP)->mode, NOH_TRACK_OFF);
    param(g, P_JUMP, 1.0f);
    while (played < JUMP_TICKS) {
        float weight;
        step(g, 600);
        played += 600;
        assert_true(noh_graph_param(g->state, P_JUMP) == 0.0f); /* used up */
        weight = played < IN                        ? (float)played / (float)IN
                 : played < JUMP_TICKS - OUT + 600u ? 1.0f
                                                    : (float)(JUMP_TICKS - played) / (float)OUT;
        assert_true(fabsf(track(g, T_JUMP)->weight - weight) < 1e-6f);
        assert_true(track(g, T_WALK)->weight == 1.0f); /* covered, not stopped */
        assert_int_equal(take_pose(g), weight > 0.0f ? 2 : 1);
        clip_pose(g, T_WALK, below, floats);
        clip_pose(g, T_JUMP, over, floats);
        noh_pose_mix(JOINTS, below, over, weight, NULL, want);
        assert_true(pose_apart(g->pose, want, JOINTS) < 2e-6);
    }
    assert_int_equal(track(g, T_JUMP)->position, noh_position_of(JUMP_TICKS)); /* to its very end */
    assert_int_equal(noh_graph_machine_state(g->state, M_SHOT), 0);
    step(g, 600);
    assert_int_equal(track(g, T_JUMP)->mode, NOH_TRACK_OFF);
}

/* Keys at the start, in the fades, and at the end: once for each time that it plays, however time is cut. */
static void every_key_of_a_one_shot_fires_once(void **state)
{
    static const uint32_t ticks[] = { 0, 1, IN, 20000, JUMP_TICKS - OUT, JUMP_TICKS - 1u, JUMP_TICKS };
    uint32_t seed = 5;
    (void)state;
    for (int round = 0; round < 400; round++) {
        stage *g = new_stage();
        const uint32_t longest = round % 4 == 0 ? 100000u : round % 4 == 1 ? 9000u : 800u;
        g->s.clips[JUMP].first_event = 0;
        g->s.clips[JUMP].event_count = 7;
        for (uint32_t i = 0; i < 7; i++) g->s.events[i].tick = ticks[i];
        step(g, 777);
        for (uint32_t shots = 1; shots <= 2; shots++) {
            uint32_t waited = 0;
            param(g, P_JUMP, 1.0f);
            do {
                seed = seed * 1664525u + 1013904223u;
                step(g, 1u + (seed >> 8) % longest);
            } while (track(g, T_JUMP)->mode != NOH_TRACK_OFF && waited++ < 100000u);
            for (uint32_t i = 0; i < 7; i++) assert_int_equal(g->fired[i], shots);
        }
        step(g, 200000);
        for (uint32_t i = 0; i < 7; i++) assert_int_equal(g->fired[i], 2);
    }
}

static void a_trigger_waits_until_the_shot_is_gone(void **state)
{
    stage *g = new_stage();
    uint32_t steps = 0, starts = 0;
    int64_t last = 0;
    (void)state;
    param(g, P_JUMP, 1.0f);
    step(g, 600);
    param(g, P_JUMP, 1.0f);
    for (; steps < 2u * (JUMP_TICKS / 600u) - 1u; steps++) {
        starts += track(g, T_JUMP)->position < last;
        last = track(g, T_JUMP)->position;
        assert_true((noh_graph_param(g->state, P_JUMP) > 0.0f) == (starts == 0));
        step(g, 600);
    }
    assert_int_equal(starts, 1);
    step(g, 600);
    step(g, 600);
    assert_int_equal(track(g, T_JUMP)->mode, NOH_TRACK_OFF);
}

static void a_masked_one_shot_leaves_the_rest_alone(void **state)
{
    static stage g;
    noh_transform below[JOINTS], over[JOINTS];
    float floats[FLOATS];
    (void)state;
    describe(&g);
    g.nodes[N_SHOT].mask = 1; /* the upper half */
    open_stage(&g);
    param(&g, P_JUMP, 1.0f);
    step(&g, IN);
    step(&g, 5000);
    assert_int_equal(take_pose(&g), 2);
    clip_pose(&g, T_WALK, below, floats);
    clip_pose(&g, T_JUMP, over, floats);
    assert_true(pose_apart(g.pose, below, JOINTS / 2u) < 1e-6);
    assert_true(pose_apart(g.pose + JOINTS / 2u, over + JOINTS / 2u, JOINTS / 2u) < 1e-6);
    assert_true(pose_apart(g.pose + JOINTS / 2u, below + JOINTS / 2u, JOINTS / 2u) > 0.05);
}

/* A shot without fades covers all from the first step to the end of its clip. */
static void a_one_shot_may_cut(void **state)
{
    static stage g;
    (void)state;
    describe(&g);
    g.nodes[N_SHOT].fade_ticks = g.nodes[N_SHOT].fade_out_ticks = 0;
    open_stage(&g);
    param(&g, P_JUMP, 1.0f);
    step(&g, JUMP_TICKS - 1u);
    assert_true(track(&g, T_JUMP)->weight == 1.0f);
    step(&g, 1);
    assert_true(track(&g, T_JUMP)->weight == 1.0f);
    step(&g, 1);
    assert_int_equal(track(&g, T_JUMP)->mode, NOH_TRACK_OFF);
}

/* ---- both ---- */

/* The same parameters at the same steps give the same bits, from a copy of the block too: it holds no pointers. */
static void a_replay_has_equal_bits(void **state)
{
    static stage g;
    static ALIGNED uint8_t saved[4096];
    noh_transform first[200][JOINTS];
    (void)state;
    for (int run = 0; run < 2; run++) {
        uint32_t seed = 9;
        if (run == 0) {
            describe(&g);
            g.nodes[N_SELECT].curve = NOH_CURVE_SMOOTHSTEP;
            open_stage(&g);
            for (int i = 0; i < 3; i++) step(&g, 500);
            param(&g, P_JUMP, 1.0f);
            step(&g, 500);
            memcpy(saved, g.state, g.state->bytes);
        } else {
            memset(g.memory, 0xee, sizeof g.memory);
            g.state = (noh_graph_state *)(void *)saved;
        }
        for (int i = 0; i < 200; i++) {
            seed = seed * 1664525u + 1013904223u;
            if (seed >> 28 == 3) param(&g, P_CHOICE, (float)(seed >> 16 & 3u));
            if (seed >> 28 == 5) param(&g, P_JUMP, 1.0f);
            step(&g, 800);
            (void)take_pose(&g);
            if (run == 0)
                memcpy(first[i], g.pose, sizeof g.pose);
            else
                assert_memory_equal(first[i], g.pose, sizeof g.pose);
        }
    }
}

static void memory_is_exact(void **state)
{
    static stage g;
    noh_graph_state *s = NULL;
    noh_error error;
    size_t size;
    (void)state;
    describe(&g);
    size = noh_graph_state_size(&g.g, &g.s.set);
    memset(g.memory, 0xa5, sizeof g.memory);
    assert_int_equal(noh_graph_state_init(g.memory, size - 1u, &g.g, &g.s.set, &s, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, size);
    assert_int_equal(g.memory[0], 0xa5);
    assert_int_equal(noh_graph_state_init(g.memory, size, &g.g, &g.s.set, &g.state, NULL), NOH_OK);
    param(&g, P_JUMP, 1.0f);
    for (int i = 0; i < 50; i++) step(&g, 900);
    for (size_t i = size; i < sizeof g.memory; i++) assert_int_equal(g.memory[i], 0xa5);
}

static void bad(stage *g, const char *what)
{
    noh_error error;
    assert_int_equal(noh_graph_check(&g->g, &g->s.set, &error), NOH_ERR_DATA);
    assert_int_equal(strncmp(error.what, what, strlen(what)), 0);
    describe(g);
}

static void fields_broken_in_turn(void **state)
{
    static stage g;
    (void)state;
    describe(&g);
    g.nodes[N_SELECT].param = NOH_GRAPH_NONE;
    bad(&g, "param");
    g.nodes[N_SHOT].param = PARAMS;
    bad(&g, "param");
    g.nodes[N_SELECT].curve = 2;
    bad(&g, "curve");
    g.nodes[N_SELECT].flags = 4;
    bad(&g, "flags");
    g.nodes[N_SHOT].flags = NOH_TRANSITION_KEEP;
    bad(&g, "flags");
    g.nodes[N_SELECT].flags = NOH_TRANSITION_INERTIAL;
    g.nodes[N_SELECT].fade_ticks = 0;
    bad(&g, "fade_ticks");
    g.nodes[N_SHOT].mask = MASKS + 1u;
    bad(&g, "mask");
    g.nodes[N_SHOT].child_count = 1;
    bad(&g, "child_count");
    g.nodes[N_SHOT].index = 0;
    bad(&g, "machine index");
    g.nodes[N_SHOT].index = 2;
    bad(&g, "machine index");
    g.clips[T_JUMP].loop = NOH_LOOP_REPEAT;
    bad(&g, "ONE_SHOT");
    g.clips[T_JUMP].clip = WALK;
    bad(&g, "ONE_SHOT");
    assert_int_equal(noh_graph_check(&g.g, &g.s.set, NULL), NOH_OK);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_select_shows_the_child_of_its_number),
        cmocka_unit_test(a_change_of_choice_cross_fades),
        cmocka_unit_test(a_fade_of_a_select_turns_round),
        cmocka_unit_test(a_kept_child_goes_on_where_it_was),
        cmocka_unit_test(a_select_may_switch_by_inertia),
        cmocka_unit_test(a_one_shot_fades_in_and_out_by_the_end_of_its_clip),
        cmocka_unit_test(every_key_of_a_one_shot_fires_once),
        cmocka_unit_test(a_trigger_waits_until_the_shot_is_gone),
        cmocka_unit_test(a_masked_one_shot_leaves_the_rest_alone),
        cmocka_unit_test(a_one_shot_may_cut),
        cmocka_unit_test(a_replay_has_equal_bits),
        cmocka_unit_test(memory_is_exact),
        cmocka_unit_test(fields_broken_in_turn),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
