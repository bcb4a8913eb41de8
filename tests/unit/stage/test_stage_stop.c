/* Layers: what additive ones add; stopping what plays: every kind of layer fades to what lies below it, a base layer to the bind pose, its root motion
 * and its graph with it; nothing leaps, whatever is stopped, played or stopped again meanwhile. */
#include "noh/low_core.h"
#include "stage/cast/stage_internal.h"
#include "support/stage_fixture.h"

#include <math.h>

#define FADE 24000u
#define FADE_FRAMES 30u
#define MOST 64u

enum { BODY, UPPER, OVER, ADD, LAYERS };

static noh_error said;

static void open_stage(cast *c)
{
    static const noh_layer_desc layers[LAYERS] = { { .name = "body" },
                                                   { .name = "upper", .joints = "chest" },
                                                   { .name = "over", .mode = NOH_LAYER_OVER, .joints = "upper_arm.L" },
                                                   { .name = "add", .mode = NOH_LAYER_ADD } };
    memset(c, 0, sizeof *c);
    cast_map(c, PUPPETS, "demo/puppet_levels.noh");
    c->kinds[0].mesh = &c->packs[0];
    c->kinds[0].actor_count = 3;
    c->kinds[0].root_axes = NOH_ROOT_GROUND | NOH_ROOT_HEADING;
    c->kinds[0].graphs = noh_graph_module("moves");
    c->kinds[0].layers = layers;
    c->kinds[0].layer_count = LAYERS;
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 1;
    cast_make(c, NULL);
}

static void close_stage(cast *c)
{
    cast_close_stage(c);
    noh_file_unmap(&c->files[0]);
}

static noh_actor enter(const cast *c)
{
    static const noh_appearance posed = { .posed = 1 };
    noh_actor actor;
    assert_int_equal(noh_stage_spawn(c->stage, 0, NULL, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(c->stage, actor, &posed, NULL), NOH_OK);
    return actor;
}

/* A clip as good as still, in the middle of a stride. */
static void hold(const cast *c, noh_actor actor, uint32_t layer, const char *clip, float weight)
{
    const noh_play play = { .fade_ticks = 1, .speed = 1, .start_ticks = 9000, .weight = weight };
    if (noh_actor_play(c->stage, actor, layer, clip, &play, &said) != NOH_OK) fail_msg("%s", said.what);
}

static void play(const cast *c, noh_actor actor, uint32_t layer, const char *clip, uint32_t flags)
{
    const noh_play play = { .fade_ticks = FADE, .speed = 1, .start_ticks = 9000, .flags = flags };
    if (noh_actor_play(c->stage, actor, layer, clip, &play, &said) != NOH_OK) fail_msg("%s", said.what);
}

static void stop(const cast *c, noh_actor actor, uint32_t layer, uint32_t ticks)
{
    if (noh_actor_stop(c->stage, actor, layer, ticks, &said) != NOH_OK) fail_msg("%s", said.what);
}

static void frame(const cast *c)
{
    assert_int_equal(noh_stage_frame(c->stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
}

typedef struct shape {
    float joints[MOST][12];
    uint32_t count;
} shape;

/* All joints, relative to the first one. */
static shape shape_of(const cast *c, noh_actor actor)
{
    shape s;
    s.count = c->plan.kinds[0].joint_count;
    assert_true(s.count <= MOST);
    for (uint32_t j = 0; j < s.count; j++) {
        assert_int_equal(noh_actor_joint(c->stage, actor, j, s.joints[j], NULL), NOH_OK);
        for (int i = 3; j && i < 12; i += 4) s.joints[j][i] -= s.joints[0][i];
    }
    return s;
}

static float apart(const shape *a, const shape *b)
{
    float most = 0.0f;
    for (uint32_t j = 1; j < a->count; j++) {
        for (int i = 0; i < 12; i++) most = fmaxf(most, fabsf(a->joints[j][i] - b->joints[j][i]));
    }
    return most;
}

/* From a shape to another one in `frames` frames: on the way from the first on, without a leap, and all the way. */
static void goes_there(const cast *c, noh_actor actor, shape goal, uint32_t frames)
{
    shape last = shape_of(c, actor);
    const float way = apart(&last, &goal);
    float left = way;
    assert_true(way > 0.05f);
    for (uint32_t f = 0; f < frames; f++) {
        shape now;
        frame(c);
        now = shape_of(c, actor);
        if (apart(&now, &last) > 0.15f * way + 1e-4f)
            fail_msg("leaps by %g of %g in frame %u", apart(&now, &last), way, f);
        if (apart(&now, &goal) > left + 0.01f * way) fail_msg("frame %u leads away", f);
        left = apart(&now, &goal);
        if (f == frames / 2u) assert_true(left < 0.75f * way && left > 0.2f * way);
        last = now;
    }
    if (left > 2e-4f) fail_msg("%g of %g is left", left, way);
}

static void each_layer_fades_alone(void **state)
{
    for (uint32_t layer = 0; layer < LAYERS; layer++) {
        for (int weight = 0; weight < 2; weight++) {
            noh_actor actor;
            shape rest;
            cast c;
            open_stage(&c);
            actor = enter(&c);
            frame(&c);
            rest = shape_of(&c, actor);
            hold(&c, actor, layer, "bow", weight && layer < OVER ? 2.5f : 1.0f);
            if (layer == ADD) hold(&c, actor, layer, "walk", 1.0f);
            frame(&c);
            stop(&c, actor, layer, FADE);
            goes_there(&c, actor, rest, FADE_FRAMES);
            assert_null(noh_actor_track(c.stage, actor, layer));
            close_stage(&c);
        }
    }
    (void)state;
}

static void a_base_layer_fades_to_the_other_one(void **state)
{
    noh_actor actor, other;
    shape goal;
    cast c;
    (void)state;
    open_stage(&c);
    actor = enter(&c);
    other = enter(&c);
    hold(&c, actor, BODY, "walk", 1.0f);
    hold(&c, actor, UPPER, "bow", 0.3f);
    hold(&c, other, UPPER, "bow", 1.0f);
    frame(&c);
    goal = shape_of(&c, other);
    stop(&c, actor, BODY, FADE);
    goes_there(&c, actor, goal, FADE_FRAMES);
    close_stage(&c);
}

static void stopped_within_a_cross_fade(void **state)
{
    noh_actor actor;
    shape rest;
    cast c;
    (void)state;
    open_stage(&c);
    actor = enter(&c);
    frame(&c);
    rest = shape_of(&c, actor);
    hold(&c, actor, BODY, "walk", 1.0f);
    frame(&c);
    play(&c, actor, BODY, "bow", 0);
    for (uint32_t f = 0; f < 12; f++) frame(&c);
    stop(&c, actor, BODY, FADE);
    goes_there(&c, actor, rest, FADE_FRAMES);
    close_stage(&c);
}

static void stopped_twice_it_goes_on_from_where_it_is(void **state)
{
    noh_actor actor;
    shape rest;
    cast c;
    (void)state;
    open_stage(&c);
    actor = enter(&c);
    frame(&c);
    rest = shape_of(&c, actor);
    hold(&c, actor, BODY, "bow", 1.0f);
    frame(&c);
    stop(&c, actor, BODY, FADE);
    for (uint32_t f = 0; f < 12; f++) frame(&c);
    stop(&c, actor, BODY, FADE);
    goes_there(&c, actor, rest, FADE_FRAMES);
    close_stage(&c);
}

/* The same clip or another one; and stopped again while it comes back. */
static void played_again_while_it_fades(void **state)
{
    static const char *const clips[] = { "bow", "walk" };
    for (uint32_t i = 0; i < 2; i++) {
        noh_actor actor, other;
        shape rest, goal;
        cast c;
        open_stage(&c);
        actor = enter(&c);
        other = enter(&c);
        frame(&c);
        rest = shape_of(&c, actor);
        hold(&c, actor, BODY, "bow", 1.0f);
        hold(&c, other, BODY, clips[i], 1.0f);
        frame(&c);
        goal = shape_of(&c, other);
        stop(&c, actor, BODY, FADE);
        for (uint32_t f = 0; f < 15; f++) frame(&c);
        play(&c, actor, BODY, clips[i], NOH_PLAY_KEEP); /* what is on its way out is not kept */
        goes_there(&c, actor, goal, FADE_FRAMES);
        stop(&c, actor, BODY, FADE);
        for (uint32_t f = 0; f < 10; f++) frame(&c);
        play(&c, actor, BODY, clips[i], 0);
        for (uint32_t f = 0; f < 10; f++) frame(&c);
        stop(&c, actor, BODY, FADE);
        goes_there(&c, actor, rest, FADE_FRAMES);
        close_stage(&c);
    }
    (void)state;
}

/* What is left of the root motion is what is left of the pose. */
static void root_motion_fades_too(void **state)
{
    noh_actor actor, walker;
    const noh_play at_once = { .fade_ticks = 1 };
    cast c;
    (void)state;
    open_stage(&c);
    actor = enter(&c);
    walker = enter(&c);
    assert_int_equal(noh_actor_play(c.stage, actor, BODY, "walk", &at_once, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(c.stage, walker, BODY, "walk", &at_once, NULL), NOH_OK);
    frame(&c);
    stop(&c, actor, BODY, FADE);
    for (uint32_t f = 1; f <= FADE_FRAMES + 2u; f++) {
        const double t = f < FADE_FRAMES ? (double)f / FADE_FRAMES : 1.0, left = 1.0 - t * t * (3.0 - 2.0 * t);
        noh_root_pose moved, all;
        frame(&c);
        assert_int_equal(noh_actor_root(c.stage, actor, &moved, NULL), NOH_OK);
        assert_int_equal(noh_actor_root(c.stage, walker, &all, NULL), NOH_OK);
        assert_true(all.translation[2] > 1e-4);
        for (int i = 0; i < 3; i++) assert_true(fabs(moved.translation[i] - left * all.translation[i]) < 1e-8);
        assert_true(fabs((double)(int32_t)moved.turn - left * (double)(int32_t)all.turn) < 300.0);
    }
    close_stage(&c);
}

static void a_graph_fades(void **state)
{
    const noh_play at_once = { .fade_ticks = 1 };
    noh_actor actor;
    shape rest;
    uint32_t attention;
    cast c;
    (void)state;
    open_stage(&c);
    attention = noh_stage_find(c.stage, 0, NOH_NAME_PARAMETER, "attention");
    actor = enter(&c);
    frame(&c);
    rest = shape_of(&c, actor);
    assert_int_equal(noh_actor_play_graph(c.stage, actor, BODY, "moves", &at_once, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_parameter(c.stage, actor, attention, 1.0f, NULL), NOH_OK);
    frame(&c);
    stop(&c, actor, BODY, FADE);
    goes_there(&c, actor, rest, FADE_FRAMES);
    close_stage(&c);
}

/* Seen from afar poses are made seldom and mixed: the mix does not leap either. */
static void a_fade_that_is_posed_seldom(void **state)
{
    const float middle[3] = { 0.0f, 1.0f, 0.0f };
    noh_stage_view view;
    noh_appearance plain;
    noh_actor actor;
    shape rest, last;
    float way;
    cast c;
    (void)state;
    open_stage(&c);
    noh_view_orbit(&view, middle, 0.5f, 0.2f, 150.0f, 640, 360);
    actor = enter(&c);
    frame(&c);
    rest = shape_of(&c, actor);
    memset(&plain, 0, sizeof plain);
    assert_int_equal(noh_actor_set_appearance(c.stage, actor, &plain, NULL), NOH_OK);
    hold(&c, actor, BODY, "bow", 1.0f);
    for (int f = 0; f < 30; f++) assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
    last = shape_of(&c, actor);
    way = apart(&last, &rest);
    stop(&c, actor, BODY, FADE);
    for (int f = 0; f < 60; f++) {
        shape now;
        assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        now = shape_of(&c, actor);
        if (apart(&now, &last) > 0.25f * way) fail_msg("leaps by %g of %g in frame %d", apart(&now, &last), way, f);
        last = now;
    }
    assert_true(apart(&last, &rest) < 1e-3f);
    close_stage(&c);
}

/* ---- what additive layers add ---- */

static void add(const cast *c, noh_actor actor, const noh_play *play)
{
    if (noh_actor_play(c->stage, actor, ADD, "bow", play, &said) != NOH_OK) fail_msg("%s", said.what);
}

/* Relative to what plays below, or to the bind pose where nothing does, a clip is itself; relative to its own first
 * frame, which it stands on, it is nothing. */
static void a_pose_is_added_relative_to_another(void **state)
{
    const noh_play still = { .fade_ticks = 1, .speed = 1 };
    const noh_play own = { .fade_ticks = 1, .speed = 1, .start_ticks = 0 };
    const noh_play from_clip = { .fade_ticks = 1, .speed = 1, .start_ticks = 48000, .reference = "walk" };
    const noh_play from_bind = { .fade_ticks = 1, .speed = 1, .start_ticks = 48000, .flags = NOH_PLAY_FROM_BIND };
    const noh_play alone = { .fade_ticks = 1, .speed = 1, .start_ticks = 48000 };
    noh_play bad = from_clip;
    noh_actor actors[3];
    shape shapes[3], rest;
    cast c;
    (void)state;
    open_stage(&c);
    for (int i = 0; i < 3; i++) actors[i] = enter(&c);
    frame(&c);
    rest = shape_of(&c, actors[0]);
    add(&c, actors[0], &own);
    frame(&c);
    shapes[0] = shape_of(&c, actors[0]);
    assert_true(apart(&shapes[0], &rest) < 1e-3f);
    assert_int_equal(noh_actor_play(c.stage, actors[0], BODY, "walk", &still, NULL), NOH_OK);
    add(&c, actors[0], &from_clip);
    add(&c, actors[1], &from_bind);
    assert_int_equal(noh_actor_play(c.stage, actors[2], BODY, "bow", &alone, NULL), NOH_OK);
    frame(&c);
    for (int i = 0; i < 3; i++) shapes[i] = shape_of(&c, actors[i]);
    assert_true(apart(&shapes[2], &rest) > 0.1f);
    for (int i = 0; i < 2; i++) {
        if (apart(&shapes[i], &shapes[2]) > 1e-3f) fail_msg("%d: off by %g", i, apart(&shapes[i], &shapes[2]));
    }
    assert_int_equal(noh_actor_play(c.stage, actors[0], BODY, "bow", &from_clip, &said), NOH_ERR_ARG);
    bad.flags = NOH_PLAY_FROM_BIND;
    assert_int_equal(noh_actor_play(c.stage, actors[0], ADD, "bow", &bad, &said), NOH_ERR_ARG);
    bad.flags = 0, bad.reference = "none";
    assert_int_equal(noh_actor_play(c.stage, actors[0], ADD, "bow", &bad, &said), NOH_ERR_NOT_FOUND);
    close_stage(&c);
}

/* NOH_PLAY_PHASE: the clip begins at the part of its pass that the last clip has come to, however it got there; from
 * its own start if nothing played. */
static void a_clip_begins_at_the_phase_of_the_last(void **state)
{
    static const int64_t starts[] = { 0, 9000, 30000, -7000, 500000 };
    cast c;
    (void)state;
    open_stage(&c);
    const noh_actor phased = enter(&c), plain = enter(&c);
    for (size_t i = 0; i < TEST_COUNT(starts) + 1u; i++) {
        noh_play play = { .fade_ticks = 1, .speed = 1, .start_ticks = starts[i % TEST_COUNT(starts)] };
        int64_t goal = 0;
        shape shapes[2];
        stop(&c, phased, BODY, 1);
        frame(&c);
        if (i < TEST_COUNT(starts)) {
            const noh_clip_entry *clips = c.stage->kinds[0].set.clips;
            if (noh_actor_play(c.stage, phased, BODY, "walk", &play, &said) != NOH_OK) fail_msg("%s", said.what);
            frame(&c);
            const noh_track *walk = noh_actor_track(c.stage, phased, BODY);
            const uint32_t long_walk = clips[walk->clip].duration_ticks;
            const uint32_t long_bow =
                clips[noh_clip_set_find(&c.stage->kinds[0].set, noh_hash_name("bow"))].duration_ticks;
            const int64_t now = play.start_ticks % (int64_t)long_walk;
            assert_true(long_bow != long_walk);
            goal = (now < 0 ? now + long_walk : now) * long_bow / long_walk;
        }
        play.flags = NOH_PLAY_PHASE;
        assert_int_equal(noh_actor_play(c.stage, phased, BODY, "bow", &play, &said), NOH_OK);
        play.flags = 0, play.start_ticks = goal;
        assert_int_equal(noh_actor_play(c.stage, plain, BODY, "bow", &play, &said), NOH_OK);
        frame(&c);
        frame(&c);
        shapes[0] = shape_of(&c, phased), shapes[1] = shape_of(&c, plain);
        if (apart(&shapes[0], &shapes[1]) > 1e-3f) fail_msg("%d: off by %g", (int)i, apart(&shapes[0], &shapes[1]));
    }
    close_stage(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_layer_fades_alone),
        cmocka_unit_test(a_base_layer_fades_to_the_other_one),
        cmocka_unit_test(stopped_within_a_cross_fade),
        cmocka_unit_test(stopped_twice_it_goes_on_from_where_it_is),
        cmocka_unit_test(played_again_while_it_fades),
        cmocka_unit_test(root_motion_fades_too),
        cmocka_unit_test(a_graph_fades),
        cmocka_unit_test(a_fade_that_is_posed_seldom),
        cmocka_unit_test(a_pose_is_added_relative_to_another),
        cmocka_unit_test(a_clip_begins_at_the_phase_of_the_last),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
