/* States of a stage that somebody tampered with: whatever bits are flipped and whatever words are put in, the state is
 * refused with a message, or frames go on: joints and weights are numbers, and the bits are the same for one job and
 * for four. The stage has all modules that save something: graphs, faces, gazes, feet, hands, springs, ragdolls and
 * motion matching, in the middle of walks, falls, staggers and fades. NOH_LONG=1: every word.
 * cross: long, thousands of frames */
#include "support/stage_fixture.h"

#include <math.h>

#include "noh/body.h"
#include "noh/low_life.h"
#include "noh/modules.h"

enum { GAZE, FEET, REACH, PARTS };
enum { WALKERS, MATCHED, KINDS };
#define ROAM 1u /* the second file and pack of the cast */
#define BODIES 4u
#define ACTORS (BODIES + 1u)
#define BEFORE 130u /* frames before the state is saved */

typedef struct scene {
    cast c;
    noh_kind_gaze gaze;
    noh_kind_feet feet;
    noh_reach_rig arms;
    noh_modifier parts[PARTS];
    noh_kind_ragdoll ragdoll;
    noh_kind_face face;
    noh_kind_match match;
    noh_world world;
    noh_plane floor;
    noh_actor actors[ACTORS];
} scene;

static noh_error said;

static void make_parts(scene *s)
{
    noh_ragdoll_source source = { .pack = &s->c.packs[PUPPETS], .metres = 1.0f };
    assert_int_equal(noh_pack_skeleton_at(source.pack, 0, &source.joints, NULL, NULL), NOH_OK);
    assert_int_equal(noh_gaze_rig_make(source.pack, 0, &s->gaze.rig, NULL), NOH_OK);
    assert_int_equal(noh_feet_rig_make(&source, &s->feet.rig, NULL), NOH_OK);
    assert_int_equal(noh_reach_rig_make(&source, &s->arms, NULL), NOH_OK);
    s->floor.normal[1] = 1.0f;
    s->world.planes = &s->floor;
    s->world.plane_count = 1;
    s->feet.ground.world = &s->world;
    s->parts[GAZE] = noh_gaze_modifier(&s->gaze);
    s->parts[FEET] = noh_feet_modifier(&s->feet);
    s->parts[REACH] = noh_reach_modifier(&s->arms);
    s->ragdoll.count = 2;
    s->ragdoll.world = &s->world;
    for (int e = 0; e < 2; e++) { /* of the puppet's mask */
        s->face.face.eyes[e][0] = e ? -0.035f : 0.035f;
        s->face.face.eyes[e][1] = 1.55f;
        s->face.face.eyes[e][2] = 0.11f;
    }
}

static void open_scene(scene *s, uint32_t jobs)
{
    cast *c = &s->c;
    noh_kind_desc *k = c->kinds;
    memset(s, 0, sizeof *s);
    cast_map(c, PUPPETS, "demo/puppet_levels.noh");
    cast_map(c, ROAM, "demo/roam.noh");
    make_parts(s);
    for (uint32_t i = 0; i < KINDS; i++) {
        k[i].mesh = &c->packs[PUPPETS];
        k[i].root_axes = NOH_ROOT_GROUND;
        k[i].root_up = 1;
        k[i].inertia = 1;
    }
    k[WALKERS].actor_count = BODIES;
    k[WALKERS].graphs = noh_graph_module("moves");
    k[WALKERS].face = noh_face_module(&s->face);
    k[WALKERS].ragdoll = noh_ragdoll_module(&s->ragdoll);
    k[WALKERS].springs = noh_springs_module(&s->world);
    k[WALKERS].modifiers = s->parts;
    k[WALKERS].modifier_count = PARTS;
    k[MATCHED].actor_count = 1;
    k[MATCHED].clips = &c->packs[ROAM];
    k[MATCHED].match = noh_match_module(&s->match);
    c->desc.kinds = k;
    c->desc.kind_count = KINDS;
    c->desc.job_count = jobs;
    cast_make(c, NULL);
}

static void close_scene(scene *s)
{
    cast_close_stage(&s->c);
    for (int i = 0; i < 2; i++) noh_file_unmap(&s->c.files[i]);
}

static void frame(const scene *s, uint32_t f)
{
    const noh_stage_view view = cast_view(f, 5.0f);
    assert_int_equal(noh_stage_frame(s->c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
}

static void enter(scene *s)
{
    const noh_match_goal goal = { .velocity = { 0.3f, 0.0f, 0.8f } };
    const noh_appearance posed = { .posed = 1 };
    noh_stage *stage = s->c.stage;
    for (uint32_t i = 0; i < ACTORS; i++) {
        const noh_place place = { { 1.2f * (float)i - 2.0f, 0.0f, -0.4f * (float)i }, { 0, 0, 0, 1 }, 1.0f };
        assert_int_equal(noh_stage_spawn(stage, i < BODIES ? WALKERS : MATCHED, &place, &s->actors[i], NULL), NOH_OK);
        assert_int_equal(noh_actor_set_appearance(stage, s->actors[i], &posed, NULL), NOH_OK);
    }
    for (uint32_t i = 0; i + 1u < BODIES; i++)
        assert_int_equal(noh_actor_play(stage, s->actors[i], 0, i ? "walk" : "dance", NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_play_graph(stage, s->actors[BODIES - 1u], 0, "moves", NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_match(stage, s->actors[BODIES], &goal, NULL), NOH_OK);
    assert_int_equal(noh_actor_hold_float(stage, s->actors[0], 1, 0.5f, 0.5f, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_emotion(stage, s->actors[0], "joy", 0.8f, 9000, 0, 9000, NULL), NOH_OK);
}

/* Until one lies or falls, one staggers, one looks, reaches and changes its clip by inertia. */
static void play(scene *s)
{
    const noh_play leap = { .fade_ticks = 24000, .flags = NOH_PLAY_INERTIA };
    const float ahead[3] = { 0.4f, 1.3f, 2.0f };
    noh_stage *stage = s->c.stage;
    for (uint32_t f = 0; f < BEFORE; f++) {
        noh_gaze *gaze = noh_actor_modifier(stage, s->actors[2], GAZE);
        noh_reach *reach = noh_actor_modifier(stage, s->actors[2], REACH);
        memcpy(gaze->point, ahead, sizeof ahead);
        memcpy(reach->hands[0].point, ahead, sizeof ahead);
        gaze->looks = 1;
        reach->hands[0].wants = 1;
        if (f == 60) assert_int_equal(noh_actor_look_at(stage, s->actors[0], ahead, NULL), NOH_OK);
        if (f == 90) assert_int_equal(noh_actor_fall(stage, s->actors[1], NULL), NOH_OK);
        if (f == BEFORE - 6u) {
            const float push[3] = { 4.0f, 0.0f, 6.0f };
            noh_place at;
            assert_int_equal(noh_actor_place(stage, s->actors[2], &at, NULL), NOH_OK);
            at.position[1] += 1.1f;
            assert_int_equal(noh_actor_hit(stage, s->actors[2], at.position, push, NULL), NOH_OK);
            assert_int_equal(noh_actor_play(stage, s->actors[0], 0, "bow", &leap, NULL), NOH_OK);
        }
        frame(s, f);
    }
}

/* What is shown is numbers. Returns what is not, or NULL. */
static const char *bad_number(const scene *s)
{
    for (uint32_t i = 0; i < ACTORS; i++) {
        const noh_actor actor = noh_stage_actor_at(s->c.stage, i);
        const uint32_t kind = i < BODIES ? WALKERS : MATCHED;
        const float *floats;
        float m[12];
        if (!actor.id) continue;
        floats = noh_actor_floats(s->c.stage, actor);
        for (uint32_t f = 0; floats && noh_stage_name(s->c.stage, kind, NOH_NAME_FLOAT, f); f++)
            if (!isfinite(floats[f])) return "a float";
        for (uint32_t j = 0; noh_actor_joint(s->c.stage, actor, j, m, NULL) == NOH_OK; j++)
            for (int k = 0; k < 12; k++)
                if (!isfinite(m[k])) return "a joint";
        noh_place place;
        assert_int_equal(noh_actor_place(s->c.stage, actor, &place, NULL), NOH_OK);
        for (int k = 0; k < 3; k++)
            if (!isfinite(place.position[k])) return "a place";
    }
    return NULL;
}

typedef struct tampered {
    scene one, four;
    uint8_t *good, *bad;
    size_t bytes;
    uint32_t taken, refused;
} tampered;

static void take(tampered *t, size_t at)
{
    const char *what;
    const noh_result result = noh_stage_set_state(t->one.c.stage, t->bad, t->bytes, &said);
    assert_int_equal(noh_stage_set_state(t->four.c.stage, t->bad, t->bytes, NULL), result);
    if (result != NOH_OK) {
        assert_int_equal(result, NOH_ERR_DATA);
        assert_non_null(said.what);
        t->refused++;
        return;
    }
    t->taken++;
    for (uint32_t f = 0; f < 2; f++) {
        frame(&t->one, f);
        frame(&t->four, f);
        what = bad_number(&t->one);
        if (what) fail_msg("with byte %zu of the state changed %s is no number", at, what);
        if (noh_stage_hash(t->one.c.stage) != noh_stage_hash(t->four.c.stage))
            fail_msg("with byte %zu of the state changed, four jobs make other bits than one", at);
    }
}

/* Puts 4 bytes into the state, and the right ones back. */
static void with_word(tampered *t, size_t at, uint32_t word)
{
    if (memcmp(t->good + at, &word, 4) == 0) return;
    memcpy(t->bad + at, &word, 4);
    take(t, at);
    memcpy(t->bad + at, t->good + at, 4);
}

static void whatever_is_in_a_state(void **state)
{
    static const uint32_t words[] = { 0x7fc00000u,
                                      0x7f800000u,
                                      0xff800000u,
                                      0x7149f2cau,
                                      0xf149f2cau,
                                      0x00000001u,
                                      0xffffffffu,
                                      0x7fffffffu,
                                      0x80000000u,
                                      0x00000000u,
                                      0x5368d4a5u /* 10^12 */,
                                      0x7f7fffffu,
                                      0x0000ffffu };
    test_random r = test_random_from(45);
    const int all = getenv("NOH_LONG") != NULL;
    tampered t;
    (void)state;
    memset(&t, 0, sizeof t);
    open_scene(&t.one, 1);
    open_scene(&t.four, 4);
    enter(&t.one);
    play(&t.one);
    assert_int_equal(noh_actor_body(t.one.c.stage, t.one.actors[1]), NOH_BODY_FALLS);
    assert_int_equal(noh_actor_body(t.one.c.stage, t.one.actors[2]), NOH_BODY_STAGGERS);
    t.good = test_aligned(noh_stage_state(t.one.c.stage, &t.bytes), (size_t)t.one.c.plan.state_bytes);
    t.bad = test_aligned(t.good, t.bytes);
    for (size_t at = 0; at + 4u <= t.bytes; at += all ? 4u : 4u * (1u + test_random_below(&r, 100))) {
        for (uint32_t i = 0; i < (all ? TEST_COUNT(words) : 1u); i++)
            with_word(&t, at, words[all ? i : test_random_below(&r, TEST_COUNT(words))]);
        for (uint32_t i = 0; i < (all ? 32u : 1u); i++) {
            uint32_t word;
            memcpy(&word, t.good + at, 4);
            with_word(&t, at, word ^ 1u << (all ? i : test_random_below(&r, 32)));
        }
    }
    print_message("%zu bytes: %u taken, %u refused\n", t.bytes, t.taken, t.refused);
    assert_true(t.taken > 50 && t.refused > 50);
    free(t.good);
    free(t.bad);
    close_scene(&t.one);
    close_scene(&t.four);
}

/* Places from the game are as safe as states. */
static void a_scale_out_of_range_is_refused(void **state)
{
    static const float refused[] = { -1.0f, 1e-13f, 1e-45f, 2e12f, NAN, INFINITY }, taken[] = { 0.0f, 1e-12f, 1e12f };
    scene s;
    (void)state;
    open_scene(&s, 1);
    enter(&s);
    for (size_t i = 0; i < TEST_COUNT(refused) + TEST_COUNT(taken); i++) {
        const int bad = i < TEST_COUNT(refused);
        const noh_place place = { .scale = bad ? refused[i] : taken[i - TEST_COUNT(refused)] };
        assert_int_equal(noh_actor_set_place(s.c.stage, s.actors[0], &place, NULL), bad ? NOH_ERR_ARG : NOH_OK);
        frame(&s, 1);
        assert_null(bad_number(&s));
    }
    close_scene(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(whatever_is_in_a_state),
                                        cmocka_unit_test(a_scale_out_of_range_is_refused) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
