/* Calls of a stage in any order, right ones and wrong ones: what a game does when nobody has read the documents. A
 * failed call has a message and changes nothing; the driver refuses none of what the stage asks for; a context may be
 * lost at any call, within a frame too, and its restore may fail; and all of it leaves the state of a stage whose
 * context was never lost. Runs on the null platform. The seeds are printed. */
#include "support/stage_fixture.h"

#include "gpu/gpu.h"
#include "null.h"

#include <math.h>

#define HASHES_MAX 4096u
#define KNOWN 64u

/* Kinds after the kinds of the cast. */
enum { COATS = CAST_KINDS, ROAMERS, ALL_KINDS };
#define EACH 3u /* of coats and roamers */

typedef struct game {
    cast c;
    noh_file files[2]; /* of coats and roamers */
    noh_pack packs[2];
    noh_kind_desc kinds[ALL_KINDS];
    gpu g;
    test_random calls;      /* draws what is called: the same for both stages */
    test_random driver;     /* draws when contexts are lost, and what refuses a restore */
    noh_actor known[KNOWN]; /* present and past */
    uint8_t *saved;         /* a copy of the state, size bytes */
    size_t saved_bytes;
    int in_frame, lost, loses;
    uint32_t kind_count, actor_count; /* actors: at most */
    uint32_t view_count, done, failed, losses, refusals;
    uint64_t hashes[HASHES_MAX];
    uint32_t hash_count;
} game;

static uint32_t below(game *g, uint32_t n)
{
    return test_random_below(&g->calls, n);
}

/* A number that is mostly fine. */
static float number(game *g)
{
    switch (below(g, 40)) {
    case 0: return NAN;
    case 1: return -INFINITY;
    case 2: return 3e38f;
    default: return (float)below(g, 4001) * 0.005f - 10.0f;
    }
}

static noh_actor somebody(game *g)
{
    if (below(g, 12) == 0) return (noh_actor){ below(g, UINT32_MAX) };
    return below(g, 6) ? noh_stage_actor_at(g->c.stage, below(g, g->actor_count)) : g->known[below(g, KNOWN)];
}

static noh_place somewhere(game *g)
{
    noh_place place;
    memset(&place, 0, sizeof place);
    for (int i = 0; i < 3; i++) place.position[i] = number(g);
    if (below(g, 2))
        for (int i = 0; i < 4; i++) place.rotation[i] = number(g);
    place.scale = below(g, 3) ? 0.0f : number(g);
    return place;
}

static const char *some_clip(game *g)
{
    static const char *const clips[] = { "walk", "dance", "speak", "blink", "bow", "no such clip", "" };
    return clips[below(g, TEST_COUNT(clips))];
}

/* ---- what can be called ---- */

static noh_result call_spawn(game *g, noh_error *error)
{
    const noh_place place = somewhere(g);
    noh_actor actor = { 0 };
    const noh_result result = noh_stage_spawn(g->c.stage, below(g, 12) ? below(g, g->kind_count) : g->kind_count,
                                              below(g, 3) ? &place : NULL, &actor, error);
    if (!result) g->known[below(g, KNOWN)] = actor;
    return result;
}

static noh_result call_despawn(game *g, noh_error *error)
{
    return noh_stage_despawn(g->c.stage, somebody(g), error);
}

static noh_result call_place(game *g, noh_error *error)
{
    const noh_place place = somewhere(g);
    return noh_actor_set_place(g->c.stage, somebody(g), &place, error);
}

static noh_result call_cut(game *g, noh_error *error)
{
    return noh_actor_cut(g->c.stage, somebody(g), error);
}

static noh_result call_look(game *g, noh_error *error)
{
    noh_appearance look;
    memset(&look, 0, sizeof look);
    look.hidden = below(g, 8) == 0;
    look.posed = below(g, 4) == 0;
    look.pixels = below(g, 3) ? 0.0f : number(g);
    look.level = below(g, 6);
    look.texture_set = below(g, 6) == 0;
    look.wrinkle_models = below(g, 6) ? 0 : (uint8_t)below(g, 256);
    for (int i = 0; i < 4; i++) look.tint[i] = (uint8_t)below(g, 256);
    return noh_actor_set_appearance(g->c.stage, somebody(g), &look, error);
}

static noh_result call_attach(game *g, noh_error *error)
{
    const noh_actor parent = below(g, 3) ? somebody(g) : (noh_actor){ 0 };
    return noh_actor_attach(g->c.stage, somebody(g), parent, below(g, 40), error);
}

static noh_result call_play(game *g, noh_error *error)
{
    noh_play play;
    memset(&play, 0, sizeof play);
    play.fade_ticks = below(g, 3) * 4000u;
    play.speed = (int32_t)below(g, 400000) - 200000;
    play.start_ticks = (int64_t)below(g, 100000) - 50000;
    play.weight = below(g, 3) ? 0.0f : number(g);
    play.sync_group = below(g, 12);
    play.flags = below(g, 3) ? 0u : below(g, 32);
    return noh_actor_play(g->c.stage, somebody(g), below(g, 4), some_clip(g), below(g, 4) ? &play : NULL, error);
}

static noh_result call_stop(game *g, noh_error *error)
{
    return noh_actor_stop(g->c.stage, somebody(g), below(g, 4), below(g, 20000), error);
}

static noh_result call_hold(game *g, noh_error *error)
{
    const float amount = below(g, 4) ? (float)below(g, 101) * 0.01f : number(g);
    return noh_actor_hold_float(g->c.stage, somebody(g), below(g, 70), number(g), amount, error);
}

static noh_result call_graph(game *g, noh_error *error)
{
    const char *name = below(g, 2) ? "moves" : "no such graph";
    return noh_actor_play_graph(g->c.stage, somebody(g), below(g, 4), name, NULL, error);
}

static noh_result call_parameter(game *g, noh_error *error)
{
    return noh_actor_set_parameter(g->c.stage, somebody(g), below(g, 6), number(g), error);
}

/* Coats, and then the actors of motion matching, are the last ones. */
static noh_actor one_of(game *g, uint32_t kind)
{
    const uint32_t first = g->actor_count - g->kinds[ROAMERS].actor_count -
                           (kind == COATS ? g->kinds[COATS].actor_count : 0u);
    if (g->kind_count < ALL_KINDS || below(g, 4) == 0) return somebody(g);
    return noh_stage_actor_at(g->c.stage, first + below(g, g->kinds[kind].actor_count));
}

static noh_result call_wear(game *g, noh_error *error)
{
    const noh_actor wearer = below(g, 2) ? one_of(g, ROAMERS) : somebody(g);
    return noh_actor_wear(g->c.stage, one_of(g, COATS), wearer, error);
}

static noh_result call_match(game *g, noh_error *error)
{
    static const char *const tags[] = { NULL, "", "first", "no such tag" };
    noh_match_goal goal;
    memset(&goal, 0, sizeof goal);
    for (int i = 0; i < 3; i++) goal.velocity[i] = number(g);
    if (below(g, 3) == 0) goal.facing[0] = number(g), goal.facing[2] = number(g);
    goal.tags = tags[below(g, TEST_COUNT(tags))];
    return noh_actor_match(g->c.stage, one_of(g, ROAMERS), below(g, 6) ? &goal : NULL, error);
}

static noh_result call_shift(game *g, noh_error *error)
{
    float by[3];
    for (int i = 0; i < 3; i++) by[i] = number(g);
    return noh_stage_shift_origin(g->c.stage, by, error);
}

/* The game's own modifier: a joint goes round a point, by its state. */
typedef struct round_trip {
    float at, speed;
    uint32_t calls, reserved;
} round_trip;

static void go_round(noh_modifier_work *work)
{
    round_trip *trip = work->state;
    if (work->cut) trip->at = 0.0f;
    trip->at = fmodf(trip->at + trip->speed * (float)work->ticks / (float)NOH_TICKS_PER_SECOND, 6.0f);
    trip->calls++;
    work->local[1].translation[0] += 0.01f * trip->at;
}

static const char *check_trip(const void *user, const void *state)
{
    const round_trip *trip = state;
    (void)user;
    return trip->at > -7.0f && trip->at < 7.0f && trip->speed >= -50.0f && trip->speed <= 50.0f ? NULL : "a bad trip";
}

static noh_result call_modifier(game *g, noh_error *error)
{
    round_trip *trip = noh_actor_modifier(g->c.stage, one_of(g, ROAMERS), below(g, 3));
    const float speed = (float)below(g, 100) - 50.0f;
    (void)error;
    assert_true(!trip || !g->in_frame);
    if (trip) trip->speed = speed;
    return NOH_OK;
}

/* What asks may be called at any time; what it says must be finite. */
static noh_result call_ask(game *g, noh_error *error)
{
    const noh_actor actor = somebody(g);
    float numbers[12] = { 0 };
    noh_result result;
    noh_place place;
    switch (below(g, 4)) {
    case 0: result = noh_actor_joint(g->c.stage, actor, below(g, 50), numbers, error); break;
    case 1: result = noh_actor_sphere(g->c.stage, actor, numbers, error); break;
    case 2:
        result = noh_actor_place(g->c.stage, actor, &place, error);
        if (!result) memcpy(numbers, place.position, sizeof place.position);
        break;
    default: {
        noh_actor_detail detail;
        result = noh_actor_detail_of(g->c.stage, actor, &detail, error);
        if (!result) numbers[0] = detail.error_m, numbers[1] = detail.fade;
    }
    }
    for (int i = 0; i < 12; i++) assert_true(isfinite(numbers[i]));
    return result;
}

static noh_result call_pick(game *g, noh_error *error)
{
    const float from[3] = { number(g), number(g), number(g) }, to[3] = { number(g), number(g), number(g) };
    noh_stage_hit hit;
    if (g->in_frame) return NOH_OK;
    return noh_stage_pick(g->c.stage, from, to, number(g), &hit, error);
}

static noh_result call_step(game *g, noh_error *error)
{
    return noh_stage_step(g->c.stage, below(g, 20) ? CAST_STEP : below(g, 200000), NULL, NULL, error);
}

static noh_result call_begin(game *g, noh_error *error)
{
    noh_stage_view views[3];
    const uint32_t count = below(g, 4);
    noh_result result;
    for (uint32_t i = 0; i < 3; i++) {
        views[i] = cast_view(below(g, 400), 2.0f + (float)below(g, 50));
        views[i].cut = below(g, 10) == 0;
        if (below(g, 4) == 0) views[i].height_px = 0;
        if (below(g, 30) == 0) views[i].view_projection[below(g, 16)] = number(g);
    }
    result = below(g, 3) ? noh_stage_frame_begin(g->c.stage, views, count, error)
                         : noh_stage_frame_between(g->c.stage, views, count, (float)below(g, 13) * 0.1f - 0.1f, error);
    if (!result) g->in_frame = 1, g->view_count = count;
    return result;
}

static noh_result call_jobs(game *g, noh_error *error)
{
    const uint32_t count = g->in_frame ? noh_stage_jobs(g->c.stage) : 0;
    (void)error;
    for (uint32_t i = 0; i < count; i++) noh_stage_job(g->c.stage, count - 1u - i);
    return NOH_OK;
}

static noh_result call_end(game *g, noh_error *error)
{
    const noh_result result = noh_stage_frame_end(g->c.stage, error);
    assert_int_equal(result == NOH_OK, g->in_frame);
    g->in_frame = 0;
    return result;
}

/* The driver refuses one of the next calls: the context is as good as lost. */
static void refuse_a_draw(game *g)
{
    static const char *const functions[] = { "glDrawElements", "glUseProgram", "glBindBuffer", "glBufferSubData" };
    const char *function = functions[test_random_below(&g->driver, TEST_COUNT(functions))];
    assert_true(noh_null_refuse(g->g.context, function, test_random_below(&g->driver, 4), GL_OUT_OF_MEMORY));
    g->lost = 1;
    g->losses++;
}

static noh_result call_draw(game *g, noh_error *error)
{
    const noh_pass pass = (noh_pass)below(g, 4);
    noh_draw draws[8];
    if (g->loses && !g->lost && test_random_below(&g->driver, 16) == 0) refuse_a_draw(g);
    (void)noh_stage_list_draws(g->c.stage, below(g, 4), pass == NOH_PASS_BLENDED, draws, 8);
    return noh_stage_draw(g->c.stage, pass, below(g, 4), NULL, error);
}

static noh_result call_save(game *g, noh_error *error)
{
    size_t bytes;
    const void *state = noh_stage_state(g->c.stage, &bytes);
    (void)error;
    if (g->in_frame) return NOH_OK;
    assert_true(bytes == g->saved_bytes);
    memcpy(g->saved, state, bytes);
    return NOH_OK;
}

/* A state as it was saved, or with one of its words overwritten: taken, if it still makes sense, or refused. */
static noh_result call_load(game *g, noh_error *error)
{
    uint8_t *copy = test_aligned(g->saved, g->saved_bytes);
    noh_result result;
    if (below(g, 2)) {
        const uint32_t word = below(g, UINT32_MAX);
        memcpy(copy + 4u * below(g, (uint32_t)(g->saved_bytes / 4u)), &word, 4);
    }
    result = noh_stage_set_state(g->c.stage, copy, g->saved_bytes, error);
    free(copy);
    return result;
}

typedef struct call {
    noh_result (*make)(game *g, noh_error *error);
    uint32_t often;
    int state;    /* it changes the state where it succeeds, and nothing else may */
    int in_frame; /* it belongs between the beginning of a frame and its end */
} call;

static const call calls[] = {
    { call_spawn, 8, 1, 0 }, { call_despawn, 2, 1, 0 }, { call_place, 4, 1, 0 },  { call_cut, 1, 1, 0 },
    { call_look, 3, 1, 0 },  { call_attach, 3, 1, 0 },  { call_play, 10, 1, 0 },  { call_stop, 2, 1, 0 },
    { call_hold, 4, 1, 0 },  { call_graph, 2, 1, 0 },   { call_step, 10, 1, 0 },  { call_parameter, 1, 1, 0 },
    { call_ask, 4, 0, 0 },   { call_pick, 1, 0, 0 },    { call_begin, 12, 1, 0 }, { call_jobs, 8, 1, 1 },
    { call_end, 14, 1, 1 },  { call_draw, 8, 0, 0 },    { call_save, 1, 0, 0 },   { call_load, 1, 1, 0 },
    { call_wear, 4, 1, 0 },  { call_match, 3, 1, 0 },   { call_shift, 1, 1, 0 },  { call_modifier, 1, 1, 0 },
};

/* Mostly one that fits: a frame is begun and ended in turn, and within it little else may be called. */
static const call *some_call(game *g)
{
    const call *c;
    do {
        uint32_t sum = 0, which;
        for (size_t i = 0; i < TEST_COUNT(calls); i++) sum += calls[i].often;
        which = below(g, sum);
        for (c = calls; which >= c->often; c++) which -= c->often;
    } while (c->in_frame != g->in_frame && below(g, 8));
    return c;
}

/* ---- the context ---- */

static void no_violation(game *g)
{
    noh_null_report report;
    noh_null_report_of(g->g.context, &report);
    if (report.violations) fail_msg("%s", report.first);
}

/* A new context with the old one's table. */
static void renew(game *g)
{
    char message[256];
    g->g.platform->destroy(g->g.context);
    assert_int_equal(g->g.platform->create(NULL, &g->g.context, message, sizeof message), NOH_OK);
    assert_int_equal(noh_gl_api_load(&g->g.gl, g->g.platform->get_proc, g->g.context, NULL), NOH_OK);
}

/* Restored, after as many refusals as the driver feels like: each of them leaves nothing behind. */
static void restore(game *g)
{
    static const char *const functions[] = { "glGenBuffers",  "glTexStorage2D", "glTexStorage3D",
                                             "glLinkProgram", "glBufferData",   "glGenVertexArrays" };
    for (uint32_t tries = test_random_below(&g->driver, 3); tries; tries--) {
        const char *function = functions[test_random_below(&g->driver, TEST_COUNT(functions))];
        noh_error error = { NOH_OK, NULL, 0, 0 };
        noh_null_report report;
        noh_result result;
        renew(g); /* calls that follow a refusal may be refused, too */
        assert_true(noh_null_refuse(g->g.context, function, test_random_below(&g->driver, 20), GL_OUT_OF_MEMORY));
        result = noh_stage_restore(g->c.stage, &error);
        if (!noh_null_refused(g->g.context)) continue;
        assert_int_not_equal(result, NOH_OK);
        assert_non_null(error.what);
        noh_null_report_of(g->g.context, &report);
        for (int kind = 0; kind < NOH_NULL_KINDS; kind++) assert_int_equal(report.live[kind], 0);
        g->refusals++;
    }
    renew(g);
    assert_int_equal(noh_stage_restore(g->c.stage, NULL), NOH_OK);
    g->lost = 0;
}

/* ---- a game ---- */

static void map_more(game *g, uint32_t which, const char *name)
{
    const char *build = getenv("NOH_BUILD");
    char path[1024];
    snprintf(path, sizeof path, "%s/demo/%s.noh", build ? build : "build", name);
    assert_int_equal(noh_file_map(path, &g->files[which], NULL), NOH_OK);
    g->packs[which] = test_open(g->files[which].data, g->files[which].bytes);
}

/* Coats for those with joints, and puppets that go by motion matching with a modifier of the game's. */
static void add_kinds(game *g)
{
    static const noh_modifier trips = {
        .name = "trip", .modify = go_round, .check = check_trip, .state_bytes = sizeof(round_trip)
    };
    noh_kind_desc *coats = &g->kinds[COATS], *roamers = &g->kinds[ROAMERS];
    map_more(g, 0, "coat");
    map_more(g, 1, "roam");
    g->kind_count = ALL_KINDS;
    coats->mesh = &g->packs[0];
    coats->worn_by = 1u << PUPPETS | 1u << ROAMERS;
    coats->springs = noh_springs_module(NULL);
    *roamers = g->kinds[PUPPETS];
    memset(&roamers->graphs, 0, sizeof roamers->graphs);
    roamers->clips = &g->packs[1];
    roamers->match = noh_match_module(NULL);
    roamers->modifiers = &trips;
    roamers->modifier_count = 1;
    coats->actor_count = roamers->actor_count = EACH;
}

/* alone: one actor of each kind, as finished vertices want it */
static void open_game(game *g, uint32_t seed, uint32_t path, int alone, int loses)
{
    noh_gl_device device;
    memset(g, 0, sizeof *g);
    g->calls = test_random_from(seed);
    g->driver = test_random_from(seed + 1000u);
    g->loses = loses;
    assert_int_equal(gpu_open(&g->g, "null"), 0);
    g->g.caps.mrt3 = g->g.caps.layered = g->g.caps.render_f32 = g->g.caps.render_f16 = 1;
    g->g.caps.blend_f32 = g->g.caps.blend_f16 = g->g.caps.blend_f32_exact = 1;
    cast_open(&g->c);
    g->c.kinds[PUPPETS].graphs = noh_graph_module("*");
    g->c.kinds[PUPPETS].inertia = 1;
    g->c.kinds[MASKS].visible_max = alone ? 1 : 4;
    memcpy(g->kinds, g->c.kinds, sizeof g->c.kinds);
    g->kind_count = CAST_KINDS;
    if (alone || path == NOH_MORPH_AUTO) add_kinds(g); /* in some stages: they take time */
    g->c.desc.kinds = g->kinds;
    g->c.desc.kind_count = g->kind_count;
    for (uint32_t i = 0; i < g->kind_count; i++) {
        if (alone) g->kinds[i].actor_count = 1;
        g->actor_count += g->kinds[i].actor_count;
    }
    g->c.desc.slot_moves = 3;
    g->c.desc.job_count = 3;
    g->c.desc.morph_path = path;
    g->c.desc.motion = g->c.desc.sort_blended = seed % 2u == 0;
    g->c.desc.gpu = &noh_stage_on_gl;
    device = (noh_gl_device){ &g->g.gl, &g->g.caps, &g->g.ledger, NULL, 0 };
    cast_make(&g->c, &device);
    (void)noh_stage_state(g->c.stage, &g->saved_bytes);
    g->saved = test_aligned(noh_stage_state(g->c.stage, &g->saved_bytes), g->saved_bytes);
}

static void close_files(game *g)
{
    cast_close(&g->c);
    for (int i = 0; i < 2; i++) noh_file_unmap(&g->files[i]);
    free(g->saved);
}

static void close_game(game *g)
{
    noh_null_report report;
    cast_close_stage(&g->c);
    noh_null_report_of(g->g.context, &report);
    for (int kind = 0; kind < NOH_NULL_KINDS; kind++) assert_int_equal(report.live[kind], 0);
    close_files(g);
    gpu_close(&g->g);
}

/* One call, and what must hold after it. */
static void one_call(game *g)
{
    const call *c = some_call(g);
    const uint64_t before = g->in_frame ? 0 : noh_stage_hash(g->c.stage);
    const int in_frame = g->in_frame;
    noh_error error = { NOH_OK, NULL, 0, 0 };
    const noh_result result = c->make(g, &error);
    g->done++;
    if (result) {
        g->failed++;
        assert_non_null(error.what);
        assert_true(result == NOH_ERR_ARG || result == NOH_ERR_NOT_FOUND || result == NOH_ERR_LIMIT ||
                    result == NOH_ERR_DATA);
    }
    if (!in_frame && !g->in_frame && (result || !c->state)) assert_true(noh_stage_hash(g->c.stage) == before);
    if (!g->lost) no_violation(g);
    if (g->in_frame) return;
    if (g->hash_count < HASHES_MAX) g->hashes[g->hash_count++] = noh_stage_hash(g->c.stage);
    if (g->lost) restore(g);
}

static void play(game *g, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (g->loses && !g->lost && test_random_below(&g->driver, 60) == 0) {
            g->lost = 1;
            g->losses++;
        }
        one_call(g);
    }
    assert_true(g->failed > g->done / 10u && g->failed < g->done * 6u / 10u);
}

static void calls_in_any_order(void **state)
{
    static const uint32_t paths[] = { NOH_MORPH_AUTO, NOH_MORPH_MRT, NOH_MORPH_PER_LAYER, NOH_MORPH_GATHER,
                                      NOH_MORPH_CPU,  NOH_MORPH_CPU, NOH_MORPH_DIRECT };
    const uint32_t count = getenv("NOH_LONG") ? 40000u : test_is_sanitized() ? 600u : 1500u;
    game *steady = test_zeros(sizeof *steady), *losing = test_zeros(sizeof *losing);
    (void)state;
    for (uint32_t i = 0; i < TEST_COUNT(paths); i++) {
        const uint32_t seed = 11u + i;
        open_game(steady, seed, paths[i], i == 5, 0);
        play(steady, count);
        close_game(steady);
        open_game(losing, seed, paths[i], i == 5, 1);
        play(losing, count);
        close_game(losing);
        print_message("# seed %u: %u calls, %u failed, %u lost contexts, %u refused restores\n", (unsigned)seed,
                      (unsigned)losing->done, (unsigned)losing->failed, (unsigned)losing->losses,
                      (unsigned)losing->refusals);
        assert_true(losing->losses > count / 200u && losing->refusals > 0);
        assert_int_equal(steady->hash_count, losing->hash_count);
        assert_memory_equal(steady->hashes, losing->hashes, steady->hash_count * sizeof *steady->hashes);
    }
    free(steady);
    free(losing);
}

/* There is no new context: the table that deletes nothing is copied over the game's, and the ledger is empty. */
static void a_lost_stage_is_deleted(void **state)
{
    game *g = test_zeros(sizeof *g);
    noh_gl_ledger nothing;
    noh_null_report before, after;
    (void)state;
    memset(&nothing, 0, sizeof nothing);
    open_game(g, 1, NOH_MORPH_MRT, 0, 0);
    play(g, 200);
    noh_null_report_of(g->g.context, &before);
    g->g.gl = *noh_gl_lost_api();
    cast_close_stage(&g->c);
    noh_null_report_of(g->g.context, &after);
    assert_memory_equal(&before, &after, sizeof before);
    assert_memory_equal(&g->g.ledger, &nothing, sizeof nothing);
    close_files(g);
    renew(g);
    gpu_close(&g->g);
    free(g);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(calls_in_any_order),
                                        cmocka_unit_test(a_lost_stage_is_deleted) };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
