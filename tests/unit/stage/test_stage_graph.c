/* Graphs that actors play: the poses of the graph alone to the bit, keys in the order of time, root motion, states put
 * back, and no byte for kinds without them. The pack is demo/puppet_levels.noh with its graph "moves". */
#include "support/clip_bank_fixture.h"
#include "support/stage_fixture.h"

#include <math.h>
#include "motion/graph/graph_internal.h"
#include "motion/graph/graph_pack_internal.h"
#include "noh/graph.h"
#include "noh/low_motion.h"

#define FRAMES 240u

static noh_error said;

typedef struct ball { /* the indices that a game looks up once */
    uint32_t speed, attention, act, bow, dances, bows;
} ball;

/* The graph of the pack, and the same one made in code. */
static int in_code;
static noh_pack made_in_code;
static const noh_pack *both[2];

static void make_moves(void)
{
    static const char *const acts[] = { "go", "dance" }, *const paces[] = { "stand", "stroll", "hurry", "look_round" };
    static const char *const dances[] = { "paces", "dance" }, *const bows[] = { "acts", "bowing" };
    static const float points[] = { 0.0f, 0.0f, 0.5f, 0.0f, 0.9f, 0.0f, 0.0f, 1.0f };
    static const noh_graph_param_desc params[] = {
        { .name = "speed", .maximum = 0.9f },
        { .name = "attention", .maximum = 1.0f },
        { .name = "act", .kind = NOH_PARAM_ENUM, .values = acts, .value_count = 2 },
        { .name = "bow", .kind = NOH_PARAM_TRIGGER },
    };
    static const noh_graph_node_desc nodes[] = {
        { .name = "bows",
          .kind = NOH_NODE_ONE_SHOT,
          .children = bows,
          .child_count = 2,
          .param = "bow",
          .curve = NOH_CURVE_SMOOTHSTEP,
          .fade_ticks = 12000,
          .fade_out_ticks = 24000 },
        { .name = "acts",
          .kind = NOH_NODE_SELECT,
          .children = dances,
          .child_count = 2,
          .param = "act",
          .flags = NOH_TRANSITION_INERTIAL | NOH_TRANSITION_KEEP,
          .fade_ticks = 19200 },
        { .name = "paces",
          .kind = NOH_NODE_SPACE_2D,
          .children = paces,
          .child_count = 4,
          .points = points,
          .param = "speed",
          .param_y = "attention" },
        { .name = "stand", .clip = "idle" },
        { .name = "stroll", .clip = "walk", .sync = "feet" },
        { .name = "hurry", .clip = "walk", .sync = "feet", .speed = 117965 },
        { .name = "look_round" },
        { .name = "dance" },
        { .name = "bowing", .clip = "bow", .loop = NOH_LOOP_ONCE },
    };
    const noh_graph_desc desc = { .name = "moves",
                                  .nodes = nodes,
                                  .params = params,
                                  .node_count = TEST_COUNT(nodes),
                                  .param_count = TEST_COUNT(params) };
    static uint8_t memory[4096];
    const size_t bytes = noh_graph_size(&desc);
    assert_true(bytes > 0 && bytes + 64u < sizeof memory);
    if (noh_graph_init(memory + (64u - (uintptr_t)memory % 64u), bytes, &desc, &made_in_code, &said))
        fail_msg("%s", said.what);
}

static void open_cast(cast *c, uint32_t actors)
{
    memset(c, 0, sizeof *c);
    cast_map(c, PUPPETS, "demo/puppet_levels.noh");
    if (in_code) {
        both[0] = &c->packs[0];
        both[1] = &made_in_code;
        c->kinds[0].clip_packs = both;
        c->kinds[0].clip_pack_count = 2;
        make_moves();
    }
    c->kinds[0].mesh = &c->packs[0];
    c->kinds[0].actor_count = actors;
    c->kinds[0].root_axes = NOH_ROOT_GROUND;
    c->kinds[0].inertia = 1;
    c->kinds[0].graphs = noh_graph_module("moves");
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 1;
}

static void close_cast(cast *c)
{
    cast_close_stage(c);
    noh_file_unmap(&c->files[0]);
}

static ball names_of(const noh_stage *s)
{
    ball b;
    b.speed = noh_stage_find(s, 0, NOH_NAME_PARAMETER, "speed");
    b.attention = noh_stage_find(s, 0, NOH_NAME_PARAMETER, "attention");
    b.act = noh_stage_find(s, 0, NOH_NAME_PARAMETER, "act");
    b.bow = noh_stage_find(s, 0, NOH_NAME_PARAMETER, "bow");
    b.bows = noh_stage_find(s, 0, NOH_NAME_MACHINE, "bows");
    b.dances = noh_stage_find(s, 0, NOH_NAME_MACHINE, "acts");
    return b;
}

static noh_actor enter(const cast *c)
{
    static const noh_appearance posed = { .posed = 1 };
    noh_actor actor;
    assert_int_equal(noh_stage_spawn(c->stage, 0, NULL, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(c->stage, actor, &posed, NULL), NOH_OK);
    return actor;
}

static void set(const cast *c, noh_actor actor, uint32_t parameter, float value)
{
    if (noh_actor_set_parameter(c->stage, actor, parameter, value, &said) != NOH_OK) fail_msg("%s", said.what);
}

static void play(const cast *c, noh_actor actor, uint32_t layer, const noh_play *how)
{
    if (noh_actor_play_graph(c->stage, actor, layer, "moves", how, &said) != NOH_OK) fail_msg("%s", said.what);
}

static void frame(const cast *c, uint32_t ticks)
{
    assert_int_equal(noh_stage_frame(c->stage, ticks, NULL, NULL, NULL, NULL), NOH_OK);
}

/* What happens in a show, by frame. */
static float speed_at(uint32_t f)
{
    return f < 20u ? 0.0f : f < 140u ? 0.0075f * (float)(f - 20u) : 0.3f;
}

static void direct(const cast *c, noh_actor actor, const ball *b, uint32_t f)
{
    set(c, actor, b->speed, speed_at(f));
    set(c, actor, b->attention, f < 90u ? 0.01f * (float)f : 0.0f);
    if (f == 60u || f == 200u) set(c, actor, b->bow, 1.0f);
    if (f == 100u) set(c, actor, b->act, (float)noh_stage_find_value(c->stage, 0, b->act, "dance"));
    if (f == 150u) set(c, actor, b->act, (float)noh_stage_find_value(c->stage, 0, b->act, "go"));
}

/* ---- against the graph alone ---- */

typedef struct alone {
    noh_clip_bank *bank;
    noh_graph_pack *made;
    noh_graph_state *state;
    noh_graph_scratch scratch;
    void *memory[2];
    noh_transform pose[NOH_JOINTS_MAX];
    float floats[NOH_FLOATS_MAX];
    uint32_t keys;
} alone;

static void open_alone(const noh_pack *pack, alone *a)
{
    noh_clip_bank_desc bank;
    noh_graph_pack_desc desc;
    size_t bytes;
    memset(a, 0, sizeof *a);
    memset(&bank, 0, sizeof bank);
    memset(&desc, 0, sizeof desc);
    bank.clips = pack;
    bank.track_count = 6;
    bank.root_axes = NOH_ROOT_GROUND;
    bank.root_up = 1;
    a->bank = test_clip_bank(&bank);
    desc.pack = pack;
    desc.set = &a->bank->clips;
    bytes = noh_graph_pack_size(&desc, NULL);
    assert_int_equal(noh_graph_pack_init(test_aligned(NULL, bytes), bytes, &desc, &a->made, NULL), NOH_OK);
    bytes = noh_graph_state_size(&a->made->graph, &a->made->clips);
    a->memory[0] = test_aligned(NULL, bytes);
    assert_int_equal(noh_graph_state_init(a->memory[0], bytes, &a->made->graph, &a->made->clips, &a->state, NULL),
                     NOH_OK);
    bytes = noh_graph_scratch_size(&a->made->graph, &a->made->clips);
    a->memory[1] = test_aligned(NULL, bytes);
    assert_int_equal(noh_graph_scratch_init(a->memory[1], bytes, &a->made->graph, &a->made->clips, &a->scratch, NULL),
                     NOH_OK);
}

static void close_alone(alone *a)
{
    free(a->memory[0]);
    free(a->memory[1]);
    free(a->made);
    free(a->bank);
}

static void count_key(void *user, const noh_event *event)
{
    alone *a = user;
    (void)event;
    a->keys++;
}

static void set_alone(alone *a, const char *name, float value)
{
    assert_int_equal(noh_graph_pack_set_param(a->made, a->state, noh_graph_pack_find_param(a->made, name), value),
                     NOH_OK);
}

static void direct_alone(alone *a, uint32_t f)
{
    set_alone(a, "speed", speed_at(f));
    set_alone(a, "attention", f < 90u ? 0.01f * (float)f : 0.0f);
    if (f == 60u || f == 200u) set_alone(a, "bow", 1.0f);
    if (f == 100u) set_alone(a, "act", 1.0f);
    if (f == 150u) set_alone(a, "act", 0.0f);
}

static void same_joints(const cast *c, noh_actor actor, const float *modelled, uint32_t f)
{
    noh_place here;
    assert_int_equal(noh_actor_place(c->stage, actor, &here, NULL), NOH_OK);
    for (uint32_t j = 0; j < c->plan.kinds[0].joint_count; j++) {
        float matrix[12];
        assert_int_equal(noh_actor_joint(c->stage, actor, j, matrix, NULL), NOH_OK);
        if (memcmp(matrix, modelled + 12u * j, sizeof matrix) != 0)
            fail_msg("frame %u: joint %u differs", (unsigned)f, (unsigned)j);
    }
}

/* An actor without root motion shows the poses and floats of the graph, evaluated by hand, to the bit; and hears as
 * many keys. */
static void an_actor_shows_the_graphs_own_pose(void **state)
{
    static float modelled[12u * NOH_JOINTS_MAX];
    noh_skeleton skeleton;
    noh_actor actor;
    uint32_t heard = 0, moved = 0;
    alone *a = calloc(1, sizeof *a);
    ball b;
    cast c;
    (void)state;
    open_cast(&c, 1);
    c.kinds[0].root_axes |= NOH_ROOT_BY_GAME;
    cast_make(&c, NULL);
    open_alone(&c.packs[0], a);
    b = names_of(c.stage);
    actor = enter(&c);
    play(&c, actor, 0, NULL);
    assert_int_equal(noh_pack_skeleton_at(&c.packs[0], 0, &skeleton, NULL, NULL), NOH_OK);
    for (uint32_t f = 0; f < FRAMES; f++) {
        noh_root_pose by_hand, told;
        uint32_t count;
        direct(&c, actor, &b, f);
        frame(&c, 801);
        (void)noh_stage_events(c.stage, &count);
        heard += count;
        direct_alone(a, f);
        (void)noh_graph_step(a->state, &a->made->graph, &a->made->clips, 801, count_key, a);
        by_hand = noh_graph_root_motion(a->state, &a->made->graph, &a->made->clips);
        assert_int_equal(noh_actor_root(c.stage, actor, &told, NULL), NOH_OK);
        assert_memory_equal(&by_hand, &told, sizeof told);
        moved += told.translation[2] > 0.001;
        noh_graph_pose(a->state, &a->made->graph, &a->made->clips, &a->scratch, a->pose, a->floats);
        noh_local_to_model(&skeleton, a->pose, skeleton.joint_count, modelled);
        same_joints(&c, actor, modelled, f);
        assert_memory_equal(noh_actor_floats(c.stage, actor), a->floats, 4u * c.plan.kinds[0].float_count);
    }
    assert_true(heard > 4 && heard == a->keys && moved > 40);
    close_alone(a);
    free(a);
    close_cast(&c);
}

/* A blend space at a clip's own point walks as far as the clip does, and at the point of a faster one as much farther.
 */
static void a_graph_walks_as_far_as_its_clips(void **state)
{
    noh_actor actors[3];
    noh_place places[3];
    ball b;
    cast c;
    (void)state;
    open_cast(&c, 3);
    cast_make(&c, NULL);
    b = names_of(c.stage);
    for (int i = 0; i < 3; i++) {
        actors[i] = enter(&c);
        if (i) play(&c, actors[i], 0, NULL);
        if (i) set(&c, actors[i], b.speed, i == 1 ? 0.5f : 0.9f);
    }
    assert_int_equal(noh_actor_play(c.stage, actors[0], 0, "walk", NULL, NULL), NOH_OK);
    for (uint32_t f = 0; f < 180; f++) assert_int_equal(noh_stage_step(c.stage, 800, NULL, NULL, NULL), NOH_OK);
    for (int i = 0; i < 3; i++) assert_int_equal(noh_actor_place(c.stage, actors[i], &places[i], NULL), NOH_OK);
    assert_true(places[0].position[2] > 1.0f);
    assert_true(fabsf(places[1].position[2] - places[0].position[2]) < 1e-4f);
    assert_true(fabsf(places[2].position[2] - 1.8f * places[0].position[2]) < 0.02f);
    close_cast(&c);
}

/* ---- names, and what is refused ---- */

static void graphs_have_names(void **state)
{
    const noh_graph_pack *made = NULL;
    noh_actor actor;
    ball b;
    cast c;
    (void)state;
    open_cast(&c, 2);
    c.kinds[0].graphs = noh_graph_module("mo*");
    cast_make(&c, NULL);
    b = names_of(c.stage);
    assert_null(noh_stage_name(c.stage, 0, NOH_NAME_GRAPH, 1));
    assert_int_equal(noh_stage_find(c.stage, 0, NOH_NAME_GRAPH, "moves"), 0);
    assert_string_equal(noh_stage_name(c.stage, 0, NOH_NAME_PARAMETER, b.act), "act");
    assert_null(noh_stage_name(c.stage, 0, NOH_NAME_PARAMETER, 4));
    assert_string_equal(noh_stage_name(c.stage, 0, NOH_NAME_MACHINE, b.bows), "bows");
    assert_int_equal(noh_stage_find_value(c.stage, 0, b.act, "dance"), 1);
    assert_int_equal(noh_stage_find_value(c.stage, 0, b.act, "sleep"), NOH_NONE);
    assert_int_equal(noh_stage_find(c.stage, 0, NOH_NAME_CLIP, ""), NOH_NONE); /* what stands for a graph has no name */
    actor = enter(&c);
    assert_int_equal(noh_actor_set_parameter(c.stage, actor, b.speed, 1.0f, &said), NOH_ERR_NOT_FOUND);
    assert_non_null(strstr(said.what, "plays no graph"));
    assert_null(noh_actor_state(c.stage, actor, b.bows));
    assert_null(noh_actor_graph(c.stage, actor, &made));
    play(&c, actor, 0, NULL);
    assert_non_null(noh_actor_graph(c.stage, actor, &made));
    assert_string_equal(made->source.name, "moves");
    assert_string_equal(noh_actor_state(c.stage, actor, b.dances), "paces");
    set(&c, actor, b.speed, 7.0f);
    assert_true(noh_actor_parameter(c.stage, actor, b.speed) == 0.9f); /* held within its range */
    assert_int_equal(noh_actor_set_parameter(c.stage, actor, 99, 1.0f, &said), NOH_ERR_NOT_FOUND);
    assert_int_equal(noh_actor_set_parameter(c.stage, actor, b.speed, NAN, &said), NOH_ERR_ARG);
    set(&c, actor, b.bow, 1.0f);
    frame(&c, 800);
    assert_string_equal(noh_actor_state(c.stage, actor, b.bows), "bowing");
    close_cast(&c);
}

static void refused(const cast *c, noh_actor actor, const char *graph, uint32_t layer, noh_play how, noh_result result)
{
    assert_int_equal(noh_actor_play_graph(c->stage, actor, layer, graph, &how, &said), result);
}

static void what_a_graph_cannot_do_is_refused(void **state)
{
    noh_actor actor;
    cast c;
    (void)state;
    open_cast(&c, 1);
    c.kinds[0].graphs = noh_graph_module("moves none_such");
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, &said), NOH_ERR_NOT_FOUND);
    assert_non_null(strstr(said.what, "graphs of a kind"));
    c.kinds[0].graphs = noh_graph_module("moves");
    cast_make(&c, NULL);
    actor = enter(&c);
    refused(&c, actor, "movse", 0, (noh_play){ 0 }, NOH_ERR_NOT_FOUND);
    refused(&c, actor, "moves", 2, (noh_play){ 0 }, NOH_ERR_ARG); /* a layer that adds */
    refused(&c, actor, "moves", 9, (noh_play){ 0 }, NOH_ERR_ARG);
    refused(&c, actor, "moves", 0, (noh_play){ .speed = 65536 }, NOH_ERR_ARG);
    refused(&c, actor, "moves", 0, (noh_play){ .flags = NOH_PLAY_PHASE }, NOH_ERR_ARG);
    assert_null(noh_actor_graph(c.stage, actor, NULL));
    assert_int_equal(noh_stage_despawn(c.stage, actor, NULL), NOH_OK);
    refused(&c, actor, "moves", 0, (noh_play){ 0 }, NOH_ERR_NOT_FOUND);
    close_cast(&c);
}

static uint64_t bytes_of(const cast *c, const char *part)
{
    noh_stage_bytes parts[64];
    const uint32_t count = noh_stage_plan_parts(&c->desc, NULL, &c->plan, parts, 64);
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < count; i++) bytes += strcmp(parts[i].what, part) ? 0 : parts[i].cpu_bytes;
    return bytes;
}

/* A kind without graphs has no byte of them; one with graphs is counted to the byte. */
static void no_graph_costs_nothing(void **state)
{
    uint64_t with, without, parts = 0;
    noh_stage_bytes list[64];
    noh_stage *made = NULL;
    cast c;
    (void)state;
    open_cast(&c, 3);
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
    with = c.plan.cpu_bytes;
    assert_true(bytes_of(&c, "graphs") > 0);
    for (uint32_t i = noh_stage_plan_parts(&c.desc, NULL, &c.plan, list, 64); i-- > 0;) parts += list[i].cpu_bytes;
    assert_true(parts == with);
    c.memory = test_aligned(NULL, (size_t)with);
    assert_int_equal(noh_stage_init(c.memory, (size_t)with - 1u, NULL, &c.desc, &c.plan, &made, NULL), NOH_ERR_MEMORY);
    cast_close_stage(&c);
    c.kinds[0].graphs = noh_graph_module(NULL);
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
    without = c.plan.cpu_bytes;
    assert_true(without < with && bytes_of(&c, "graphs") == 0);
    c.kinds[0].graphs = noh_graph_module(""); /* none is named */
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
    assert_true(c.plan.cpu_bytes == without);
    close_cast(&c);
}

/* ---- keys ---- */

typedef struct listener {
    const cast *c;
    ball names;
    uint32_t count, late;
    int64_t last;
    float most;
} listener;

static void on_key(void *user, noh_stage *stage, const noh_stage_event *event)
{
    listener *l = user;
    noh_error error;
    l->late += event->clock < l->last;
    l->last = event->clock;
    l->most = event->weight > l->most ? event->weight : l->most;
    l->count++;
    /* A key of the graph may set its parameters, but not begin it again. */
    assert_int_equal(noh_actor_set_parameter(stage, event->actor, l->names.attention, 0.5f, NULL), NOH_OK);
    if (event->layer == 0) {
        assert_int_equal(noh_actor_play_graph(stage, event->actor, 0, "moves", NULL, &error), NOH_ERR_ARG);
    }
}

/* The keys of the graph and of a clip that plays with it come in the order of time, also in steps of many of them,
 * and with the weight that the graph has on its layer. */
static void keys_come_in_the_order_of_time(void **state)
{
    const noh_play half = { .weight = 0.5f, .fade_ticks = 1 };
    listener l;
    noh_actor actor;
    cast c;
    (void)state;
    open_cast(&c, 1);
    cast_make(&c, NULL);
    actor = enter(&c);
    memset(&l, 0, sizeof l);
    l.c = &c;
    l.names = names_of(c.stage);
    play(&c, actor, 0, &half);
    assert_int_equal(noh_actor_play(c.stage, actor, 1, "dance", &half, NULL), NOH_OK);
    set(&c, actor, l.names.speed, 0.5f);
    for (int i = 0; i < 10; i++) {
        const noh_stage_event *events;
        uint32_t count;
        l.last = 0;
        assert_int_equal(noh_stage_step(c.stage, 3u * NOH_TICKS_PER_SECOND, on_key, &l, NULL), NOH_OK);
        events = noh_stage_events(c.stage, &count);
        for (uint32_t e = 1; e < count; e++) assert_true(events[e].clock >= events[e - 1u].clock);
    }
    assert_int_equal(l.late, 0);
    assert_true(l.count > 80 && l.most <= 0.5f);
    close_cast(&c);
}

/* ---- layers ---- */

static float farthest(const cast *c, noh_actor actor, float *last)
{
    float most = 0.0f;
    for (uint32_t j = 0; j < c->plan.kinds[0].joint_count; j++) {
        float m[12], d = 0.0f;
        assert_int_equal(noh_actor_joint(c->stage, actor, j, m, NULL), NOH_OK);
        for (int i = 0; i < 3; i++) {
            const float step = m[4 * i + 3] - last[3u * j + (uint32_t)i];
            d += step * step;
            last[3u * j + (uint32_t)i] = m[4 * i + 3];
        }
        most = d > most ? d : most;
    }
    return sqrtf(most);
}

/* From a clip into the graph, by a fade and by inertia, and out again: no joint leaps. */
static void clips_and_graphs_fade_into_each_other(void **state)
{
    const noh_play leap = { .fade_ticks = 14400, .flags = NOH_PLAY_INERTIA };
    static float last[3u * NOH_JOINTS_MAX];
    noh_actor actor;
    float most = 0.0f;
    ball b;
    cast c;
    (void)state;
    open_cast(&c, 1);
    cast_make(&c, NULL);
    b = names_of(c.stage);
    actor = enter(&c);
    assert_int_equal(noh_actor_play(c.stage, actor, 0, "dance", NULL, NULL), NOH_OK);
    for (uint32_t f = 0; f < 400; f++) {
        float moved;
        if (f == 60) play(&c, actor, 0, NULL);
        if (f == 61) set(&c, actor, b.speed, 0.5f);
        if (f == 120) play(&c, actor, 0, &leap); /* begins again */
        if (f == 180) assert_int_equal(noh_actor_play(c.stage, actor, 0, "dance", NULL, NULL), NOH_OK);
        if (f == 240) play(&c, actor, 0, &leap);
        if (f == 300) assert_int_equal(noh_actor_play(c.stage, actor, 0, "idle", &leap, NULL), NOH_OK);
        if (f == 220 || f == 310) assert_null(noh_actor_graph(c.stage, actor, NULL)); /* has faded out: costs no step */
        frame(&c, 800);
        moved = farthest(&c, actor, last);
        if (f > 0 && moved > most) most = moved;
    }
    assert_true(most > 0.005f && most < 0.12f);
    close_cast(&c);
}

/* On an over layer with a mask the graph has the head alone; what is below stays with the clip. */
static void a_graph_plays_on_a_layer(void **state)
{
    const noh_layer_desc layers[] = { { .name = "body" },
                                      { .name = "head", .mode = NOH_LAYER_OVER, .joints = "neck" } };
    uint32_t head, foot;
    float with[12], without[12], head_with[12], head_without[12];
    noh_actor actor, other;
    ball b;
    cast c;
    (void)state;
    open_cast(&c, 2);
    c.kinds[0].layers = layers;
    c.kinds[0].layer_count = 2;
    cast_make(&c, NULL);
    b = names_of(c.stage);
    head = noh_stage_find(c.stage, 0, NOH_NAME_JOINT, "head");
    foot = noh_stage_find(c.stage, 0, NOH_NAME_JOINT, "foot_l");
    if (foot == NOH_NONE) foot = 1;
    actor = enter(&c);
    other = enter(&c);
    assert_int_equal(noh_actor_play(c.stage, actor, 0, "walk", NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(c.stage, other, 0, "walk", NULL, NULL), NOH_OK);
    play(&c, actor, 1, NULL);
    set(&c, actor, b.attention, 1.0f);
    for (int f = 0; f < 100; f++) frame(&c, 800);
    assert_true(head != NOH_NONE);
    assert_int_equal(noh_actor_joint(c.stage, actor, foot, with, NULL), NOH_OK);
    assert_int_equal(noh_actor_joint(c.stage, other, foot, without, NULL), NOH_OK);
    for (int i = 0; i < 12; i++) assert_true(fabsf(with[i] - without[i]) < 1e-5f); /* a sum of one rounds */
    assert_int_equal(noh_actor_joint(c.stage, actor, head, head_with, NULL), NOH_OK);
    assert_int_equal(noh_actor_joint(c.stage, other, head, head_without, NULL), NOH_OK);
    assert_true(memcmp(head_with, head_without, sizeof with) != 0);
    close_cast(&c);
}

/* ---- states ---- */

#define CAST 12u

static void crowd_frame(const cast *c, const ball *b, uint32_t f)
{
    const noh_stage_view view = cast_view(f, 3.0f + 0.5f * (float)(f % 60u));
    for (uint32_t i = 0; i < CAST; i++) {
        const noh_actor actor = noh_stage_actor_at(c->stage, i);
        if (!actor.id) continue;
        if (noh_actor_graph(c->stage, actor, NULL)) direct(c, actor, b, (f + 17u * i) % FRAMES);
        if ((f + 31u * i) % 97u == 0) (void)noh_actor_play(c->stage, actor, 0, "idle", NULL, NULL);
        if ((f + 31u * i) % 97u == 60u) play(c, actor, 0, NULL);
    }
    assert_int_equal(noh_stage_frame(c->stage, 790u + f % 20u, &view, NULL, NULL, NULL), NOH_OK);
}

static void open_crowd(cast *c, uint32_t jobs)
{
    open_cast(c, CAST);
    c->desc.job_count = jobs;
    cast_make(c, NULL);
    for (uint32_t i = 0; i < CAST; i++) {
        const noh_place place = { { 1.1f * (float)(i % 4u) - 2.0f, 0.0f, -1.5f * (float)(i / 4u) },
                                  { 0, 0, 0, 0 },
                                  0.0f };
        noh_actor actor;
        assert_int_equal(noh_stage_spawn(c->stage, 0, &place, &actor, NULL), NOH_OK);
        play(c, actor, 0, NULL);
    }
}

/* A state put back is followed by the same frames, whatever was between; and so is a fork with other jobs. */
static void a_state_put_back_plays_on_the_same(void **state)
{
    static uint64_t hashes[160]; /* of the pack's graph, and then of the one made in code */
    uint8_t *saved;
    size_t bytes;
    ball b;
    cast c, fork;
    (void)state;
    open_crowd(&c, 1);
    open_crowd(&fork, 5);
    b = names_of(c.stage);
    for (uint32_t f = 0; f < 130; f++) crowd_frame(&c, &b, f);
    saved = test_aligned(noh_stage_state(c.stage, &bytes), (size_t)c.plan.state_bytes);
    for (uint32_t f = 130; f < 290; f++) {
        crowd_frame(&c, &b, f);
        if (in_code && noh_stage_hash(c.stage) != hashes[f - 130]) fail_msg("frame %u differs in code", (unsigned)f);
        hashes[f - 130] = noh_stage_hash(c.stage);
    }
    assert_int_equal(noh_stage_set_state(c.stage, saved, bytes, NULL), NOH_OK);
    assert_int_equal(noh_stage_set_state(fork.stage, saved, bytes, NULL), NOH_OK);
    for (uint32_t f = 130; f < 290; f++) {
        crowd_frame(&c, &b, f);
        crowd_frame(&fork, &b, f);
        if (noh_stage_hash(c.stage) != hashes[f - 130]) fail_msg("frame %u differs after restoring", (unsigned)f);
        if (noh_stage_hash(fork.stage) != hashes[f - 130]) fail_msg("frame %u of the fork differs", (unsigned)f);
    }
    free(saved);
    close_cast(&fork);
    close_cast(&c);
}

/* A broken state is refused, or played without harm (under the sanitizers: without a read outside). */
static void a_broken_state_does_no_harm(void **state)
{
    test_random r = test_random_from(5);
    uint32_t refusals = 0;
    uint8_t *saved;
    size_t bytes;
    ball b;
    cast c;
    (void)state;
    open_crowd(&c, 2);
    b = names_of(c.stage);
    for (uint32_t f = 0; f < 65; f++) crowd_frame(&c, &b, f);
    saved = test_aligned(noh_stage_state(c.stage, &bytes), (size_t)c.plan.state_bytes);
    for (int i = 0; i < 400; i++) {
        uint8_t *broken = test_aligned(saved, bytes);
        for (int k = 0; k < 3; k++)
            broken[test_random_below(&r, (uint32_t)bytes)] ^= (uint8_t)(1u << test_random_below(&r, 8));
        if (noh_stage_set_state(c.stage, broken, bytes, NULL) == NOH_OK) {
            assert_int_equal(noh_stage_frame(c.stage, 800, NULL, NULL, NULL, NULL), NOH_OK);
        } else {
            refusals++;
        }
        free(broken);
    }
    assert_int_equal(noh_stage_set_state(c.stage, saved, bytes, NULL), NOH_OK);
    assert_true(refusals > 10 && refusals < 400);
    free(saved);
    close_cast(&c);
}

/* The poses of the pack's graph, in a stage whose graph was made in code; its bytes are counted. */
static void a_graph_made_in_code_is_the_same(void **state)
{
    uint64_t plain;
    cast c;
    open_cast(&c, 3);
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
    plain = c.plan.cpu_bytes;
    close_cast(&c);
    in_code = 1;
    open_cast(&c, 3);
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
    assert_int_equal(c.plan.cpu_bytes, plain);
    close_cast(&c);
    an_actor_shows_the_graphs_own_pose(state);
    a_state_put_back_plays_on_the_same(state);
    in_code = 0;
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_actor_shows_the_graphs_own_pose),
        cmocka_unit_test(graphs_have_names),
        cmocka_unit_test(a_graph_walks_as_far_as_its_clips),
        cmocka_unit_test(what_a_graph_cannot_do_is_refused),
        cmocka_unit_test(no_graph_costs_nothing),
        cmocka_unit_test(keys_come_in_the_order_of_time),
        cmocka_unit_test(clips_and_graphs_fade_into_each_other),
        cmocka_unit_test(a_graph_plays_on_a_layer),
        cmocka_unit_test(a_state_put_back_plays_on_the_same),
        cmocka_unit_test(a_graph_made_in_code_is_the_same),
        cmocka_unit_test(a_broken_state_does_no_harm),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
