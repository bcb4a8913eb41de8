/* A stage takes its own states, whatever the game has set: each setter either refuses a number, and changes nothing,
 * or the states of the frames that follow are taken, with the same hash. The numbers are the largest that states may
 * have, larger ones, and none. The stage has all modules that save something.
 * cross: long, thousands of frames */
#include "support/busy_stage.h"

#include "core/base/math_internal.h"
#include "life/physics/ragdoll_internal.h"
#include "stage/modules/stage_ragdoll_internal.h"

#include <float.h>
#include <math.h>

static void fill(float *out, uint32_t count, float v)
{
    for (uint32_t i = 0; i < count; i++) out[i] = v;
}

#define SETTER(name) static noh_result name(noh_stage *stage, const noh_actor *actors, float v)

SETTER(place_of_a_walker)
{
    noh_place place = { .scale = 1.0f };
    fill(place.position, 3, v);
    return noh_actor_set_place(stage, actors[0], &place, NULL);
}

SETTER(place_of_a_fallen)
{
    noh_place place = { .scale = 1.0f };
    fill(place.position, 3, v);
    return noh_actor_set_place(stage, actors[1], &place, NULL);
}

SETTER(place_of_a_staggering)
{
    noh_place place = { .scale = 1.0f };
    fill(place.position, 3, v);
    return noh_actor_set_place(stage, actors[2], &place, NULL);
}

SETTER(place_and_scale)
{
    noh_place place = { .scale = v };
    fill(place.position, 3, v);
    return noh_actor_set_place(stage, actors[0], &place, NULL);
}

SETTER(scale)
{
    const noh_place place = { .scale = v };
    return noh_actor_set_place(stage, actors[0], &place, NULL);
}

/* It falls as fast as it has jumped. */
SETTER(fall_after_a_jump)
{
    noh_place place = { .scale = 1.0f };
    fill(place.position, 3, v);
    if (noh_actor_set_place(stage, actors[0], &place, NULL) != NOH_OK) return NOH_ERR_ARG;
    assert_int_equal(noh_stage_frame(stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_fall(stage, actors[0], NULL), NOH_OK);
    return NOH_OK;
}

SETTER(scale_of_a_fallen)
{
    const noh_place place = { .scale = v };
    return noh_actor_set_place(stage, actors[1], &place, NULL);
}

SETTER(scale_of_a_staggering)
{
    const noh_place place = { .scale = v };
    return noh_actor_set_place(stage, actors[2], &place, NULL);
}

SETTER(scale_of_a_matched)
{
    const noh_place place = { .scale = v };
    return noh_actor_set_place(stage, actors[4], &place, NULL);
}

SETTER(scale_of_a_graph)
{
    const noh_place place = { .scale = v };
    return noh_actor_set_place(stage, actors[3], &place, NULL);
}

SETTER(gaze)
{
    float at[3];
    fill(at, 3, v);
    return noh_actor_look_at(stage, actors[0], at, NULL);
}

SETTER(float_held)
{
    return noh_actor_hold_float(stage, actors[0], 0, v, 1.0f, NULL);
}

SETTER(parameter)
{
    return noh_actor_set_parameter(stage, actors[3], 0, v, NULL);
}

SETTER(hit_of_a_walker)
{
    float at[3];
    fill(at, 3, v);
    return noh_actor_hit(stage, actors[0], at, at, NULL);
}

SETTER(hit_of_a_fallen)
{
    float at[3];
    fill(at, 3, v);
    return noh_actor_hit(stage, actors[1], at, at, NULL);
}

SETTER(push_at_the_chest)
{
    float by[3];
    fill(by, 3, v);
    return noh_actor_push(stage, actors[0], NULL, by, NULL);
}

SETTER(hold_of_a_fallen)
{
    const noh_body_hold hold = { .hertz = v };
    return noh_actor_hold_body(stage, actors[1], 0, &hold, NULL);
}

SETTER(velocity_to_match)
{
    const noh_match_goal goal = { .velocity = { v, v, v } };
    return noh_actor_match(stage, actors[4], &goal, NULL);
}

SETTER(facing_to_match)
{
    const noh_match_goal goal = { .facing = { v, v, v } };
    return noh_actor_match(stage, actors[4], &goal, NULL);
}

SETTER(appearance)
{
    noh_appearance look = { .posed = 1 };
    look.pixels = v;
    fill(look.user, 4, v);
    return noh_actor_set_appearance(stage, actors[0], &look, NULL);
}

SETTER(emotion)
{
    return noh_actor_set_emotion(stage, actors[0], "joy", v, 1, 0, 1, NULL);
}

SETTER(visemes)
{
    float v15[NOH_VISEME_COUNT];
    fill(v15, NOH_VISEME_COUNT, v);
    return noh_actor_set_visemes(stage, actors[0], v15, NULL);
}

SETTER(weight)
{
    const noh_play how = { .weight = v, .fade_ticks = 1 };
    return noh_actor_play(stage, actors[0], 0, "walk", &how, NULL);
}

SETTER(origin)
{
    float by[3];
    (void)actors;
    fill(by, 3, v);
    return noh_stage_shift_origin(stage, by, NULL);
}

SETTER(origin_twice)
{
    float by[3];
    noh_result result;
    (void)actors;
    fill(by, 3, v);
    result = noh_stage_shift_origin(stage, by, NULL);
    return result == NOH_OK ? noh_stage_shift_origin(stage, by, NULL) : result;
}

#define ROW(name)      \
    {                  \
#name, 0, name \
    }
#define CLAMPED(name)  \
    {                  \
#name, 1, name \
    } /* takes any number */
static const struct {
    const char *name;
    int is_clamped;
    noh_result (*set)(noh_stage *stage, const noh_actor *actors, float v);
} setters[] = { ROW(place_of_a_walker),
                ROW(place_of_a_fallen),
                ROW(place_of_a_staggering),
                ROW(place_and_scale),
                ROW(scale),
                ROW(fall_after_a_jump),
                ROW(scale_of_a_fallen),
                ROW(scale_of_a_staggering),
                ROW(scale_of_a_matched),
                ROW(scale_of_a_graph),
                ROW(gaze),
                ROW(float_held),
                CLAMPED(parameter),
                ROW(hit_of_a_walker),
                ROW(hit_of_a_fallen),
                ROW(push_at_the_chest),
                ROW(hold_of_a_fallen),
                ROW(velocity_to_match),
                ROW(facing_to_match),
                ROW(appearance),
                ROW(emotion),
                ROW(visemes),
                ROW(weight),
                ROW(origin),
                ROW(origin_twice) };

static const float values[] = { NOH_NUMBER_MAX, -NOH_NUMBER_MAX, 1e6f,  -1e6f,   1.0f,     -1.0f, 1e-12f,
                                2e12f,          -2e12f,          1e13f, FLT_MAX, INFINITY, NAN };

typedef struct trial {
    busy_stage s;
    uint8_t *good;
    size_t bytes;
} trial;

static void open_trial(trial *t)
{
    memset(t, 0, sizeof *t);
    busy_stage_open(&t->s, 1);
    busy_stage_enter(&t->s);
    busy_stage_play(&t->s);
    t->good = test_aligned(noh_stage_state(t->s.c.stage, &t->bytes), (size_t)t->s.c.plan.state_bytes);
}

static void close_trial(trial *t)
{
    free(t->good);
    busy_stage_close(&t->s);
}

/* Saves the state and sets it. */
static void take_own(trial *t, const char *name, float v, uint32_t frame)
{
    noh_stage *stage = t->s.c.stage;
    const uint64_t hash = noh_stage_hash(stage);
    size_t bytes;
    noh_error said;
    uint8_t *copy = test_aligned(noh_stage_state(stage, &bytes), t->bytes);
    const noh_result result = noh_stage_set_state(stage, copy, bytes, &said);
    free(copy);
    if (result != NOH_OK) fail_msg("%s of %g, frame %u: %s", name, (double)v, frame, said.what);
    assert_true(noh_stage_hash(stage) == hash);
}

static void a_stage_takes_its_own_states(void **state)
{
    trial t;
    uint32_t taken = 0;
    (void)state;
    open_trial(&t);
    for (uint32_t i = 0; i < TEST_COUNT(setters) * TEST_COUNT(values); i++) {
        const float v = values[i % TEST_COUNT(values)];
        const char *name = setters[i / TEST_COUNT(values)].name;
        const int is_number = v >= -NOH_NUMBER_MAX && v <= NOH_NUMBER_MAX;
        assert_int_equal(noh_stage_set_state(t.s.c.stage, t.good, t.bytes, NULL), NOH_OK);
        const uint64_t before = noh_stage_hash(t.s.c.stage);
        if (setters[i / TEST_COUNT(values)].set(t.s.c.stage, t.s.actors, v) != NOH_OK) {
            if (noh_stage_hash(t.s.c.stage) != before)
                fail_msg("%s of %g fails and changes the state", name, (double)v);
            continue;
        }
        if (!is_number && !(setters[i / TEST_COUNT(values)].is_clamped && isfinite(v)))
            fail_msg("%s takes %g", name, (double)v);
        taken++;
        for (uint32_t f = 0; f < 12; f++) {
            take_own(&t, name, v, f);
            busy_stage_frame(&t.s, f);
        }
        take_own(&t, name, v, 12);
    }
    assert_true(taken > 80);
    close_trial(&t);
}

static float largest_of(const trial *t, uint32_t actor)
{
    noh_place place;
    float most = 0.0f;
    assert_int_equal(noh_actor_place(t->s.c.stage, t->s.actors[actor], &place, NULL), NOH_OK);
    for (int i = 0; i < 3; i++) most = fabsf(place.position[i]) > most ? fabsf(place.position[i]) : most;
    return most;
}

/* Time moves actors as far as places go, and no farther. */
static void what_moves_stays_within(void **state)
{
    const noh_place at = { .position = { NOH_NUMBER_MAX, -NOH_NUMBER_MAX, NOH_NUMBER_MAX }, .scale = 1.0f };
    const noh_place large = { .scale = NOH_NUMBER_MAX };
    trial t;
    uint32_t far = 0;
    (void)state;
    open_trial(&t);
    t.s.world.plane_count = 0;
    assert_int_equal(noh_actor_set_place(t.s.c.stage, t.s.actors[2], &large, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_place(t.s.c.stage, t.s.actors[1], &at, NULL), NOH_OK);
    for (uint32_t f = 0; f < 1600; f++) { /* the one that falls goes beyond the next float */
        assert_int_equal(noh_stage_step(t.s.c.stage, 8u * CAST_STEP, NULL, NULL, NULL), NOH_OK);
        assert_true(largest_of(&t, 1) <= NOH_NUMBER_MAX && largest_of(&t, 2) <= NOH_NUMBER_MAX);
        far += largest_of(&t, 2) == NOH_NUMBER_MAX;
        if (f % 100u == 0) take_own(&t, "a long walk", 0.0f, f);
    }
    assert_true(far > 0);
    busy_stage_frame(&t.s, 0);
    take_own(&t, "a long walk", 0.0f, 1600);
    close_trial(&t);
}

/* A state may hold the speed of a push: who staggers goes as far as places go, each way. */
static void what_staggers_stays_within(void **state)
{
    trial t;
    (void)state;
    open_trial(&t);
    for (int way = 0; way < 4; way++) {
        noh_stage_body *body = noh_stage_body_of(&t.s.c.stage->kinds[WALKERS], 2);
        assert_int_equal(noh_stage_set_state(t.s.c.stage, t.good, t.bytes, NULL), NOH_OK);
        assert_int_equal(noh_actor_body(t.s.c.stage, t.s.actors[2]), NOH_BODY_STAGGERS);
        body->of.stagger.speed[way / 2] = way & 1 ? 1e16f : -1e16f;
        take_own(&t, "a push", 0.0f, 0);
        assert_int_equal(noh_stage_step(t.s.c.stage, CAST_STEP, NULL, NULL, NULL), NOH_OK);
        assert_true(largest_of(&t, 2) == NOH_NUMBER_MAX);
        take_own(&t, "a push", 0.0f, 1);
        busy_stage_frame(&t.s, 0);
        take_own(&t, "a push", 0.0f, 2);
    }
    close_trial(&t);
}

/* An actor that is detached stays where it was shown, as far as places go. */
static void what_is_let_go_stays_within(void **state)
{
    const noh_place far = { .position = { NOH_NUMBER_MAX, -NOH_NUMBER_MAX, 0.0f }, .scale = NOH_NUMBER_MAX };
    trial t;
    (void)state;
    open_trial(&t);
    for (uint32_t i = 2; i < 4; i++)
        assert_int_equal(noh_actor_set_place(t.s.c.stage, t.s.actors[i], &far, NULL), NOH_OK);
    assert_int_equal(noh_actor_attach(t.s.c.stage, t.s.actors[2], t.s.actors[3], 0, NULL), NOH_OK);
    take_own(&t, "attached", 0.0f, 0);
    busy_stage_frame(&t.s, 0);
    take_own(&t, "attached", 0.0f, 1);
    assert_int_equal(noh_stage_despawn(t.s.c.stage, t.s.actors[3], NULL), NOH_OK);
    take_own(&t, "let go", 0.0f, 0);
    assert_true(largest_of(&t, 2) == NOH_NUMBER_MAX);
    busy_stage_frame(&t.s, 1);
    take_own(&t, "let go", 0.0f, 1);
    close_trial(&t);
}

/* Play a stage with ragdolls that are given back in each way: by dying, getting up and despawning. */
static void use_all(busy_stage *s)
{
    noh_stage *stage = s->c.stage;
    busy_stage_enter(s);
    busy_stage_play(s);
    assert_int_equal(noh_actor_kill(stage, s->actors[1], NULL), NOH_OK);
    assert_int_equal(noh_actor_fall(stage, s->actors[3], NULL), NOH_OK);
    for (uint32_t f = 0; f < 600; f++) busy_stage_frame(s, f);
    assert_int_equal(noh_actor_body(stage, s->actors[1]), NOH_BODY_LIES);
    assert_int_equal(noh_actor_get_up(stage, s->actors[3], NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_fall(stage, s->actors[0], NULL), NOH_OK);
}

static void use_nothing(busy_stage *s)
{
    for (uint32_t i = 0; i < ACTORS; i++) {
        const uint32_t kind = i < BODIES ? WALKERS : MATCHED;
        assert_int_equal(noh_stage_spawn(s->c.stage, kind, NULL, &s->actors[i], NULL), NOH_OK);
    }
    for (uint32_t f = 0; f < BEFORE + 600u; f++) busy_stage_frame(s, f);
}

/* What actors did leaves no byte in a state once they are despawned, in no module and in no pool of a module: both are
 * as in a stage whose actors did nothing, and an origin that moves finds no place in them. Slots of levels, which
 * visible actors hold, are not compared. */
static void despawned_actors_leave_nothing(void **state)
{
    const float by[3] = { 4.0f, 0.0f, -8.0f };
    busy_stage s[2];
    (void)state;
    for (int i = 0; i < 2; i++) {
        busy_stage_open(&s[i], 1);
        s[i].world.friction = 0.6f;
        (i ? use_nothing : use_all)(&s[i]);
        assert_int_equal(noh_stage_shift_origin(s[i].c.stage, by, NULL), NOH_OK);
        busy_stage_frame(&s[i], 0);
        for (uint32_t a = 0; a < ACTORS; a++)
            assert_int_equal(noh_stage_despawn(s[i].c.stage, s[i].actors[a], NULL), NOH_OK);
    }
    assert_int_equal(noh_stage_shift_origin(s[0].c.stage, by, NULL), NOH_OK);
    for (uint32_t k = 0; k < KINDS; k++) {
        const noh_stage_kind *used = &s[0].c.stage->kinds[k], *unused = &s[1].c.stage->kinds[k];
        const uint8_t *from = k ? used->characters : s[0].c.stage->state;
        const uint8_t *other = k ? unused->characters : s[1].c.stage->state;
        assert_memory_equal(from, other, (size_t)((const uint8_t *)used->pools - from));
    }
    for (int i = 0; i < 2; i++) busy_stage_close(&s[i]);
}

static void assert_refused(const busy_stage *s, const uint8_t *copy, size_t bytes, const char *why)
{
    noh_error error;
    assert_int_equal(noh_stage_set_state(s->c.stage, copy, bytes, &error), NOH_ERR_DATA);
    assert_non_null(strstr(error.what, why));
}

/* A state whose free ragdoll is not at rest is refused: else it would fall on, and equal stages had several hashes. */
static void a_free_ragdoll_rests_in_states(void **state)
{
    busy_stage s;
    size_t bytes;
    uint8_t *copy;
    (void)state;
    busy_stage_open(&s, 1);
    const uint8_t *own = noh_stage_state(s.c.stage, &bytes);
    copy = test_aligned(NULL, bytes);
    memcpy(copy, own, bytes);
    assert_int_equal(noh_stage_set_state(s.c.stage, copy, bytes, NULL), NOH_OK);
    noh_ragdolls *dolls = noh_stage_ragdoll_kind_of(&s.c.stage->kinds[WALKERS])->dolls;
    const noh_ragdoll_doll *last = &noh_ragdoll_dolls(dolls)[s.ragdoll.count - 1u];
    copy[(const uint8_t *)&last->asleep - own] = 0;
    assert_refused(&s, copy, bytes, "ragdoll that no actor has");
    free(copy);
    busy_stage_close(&s);
}

/* Two actors with one ragdoll would both move it. */
static void a_ragdoll_has_one_actor_in_states(void **state)
{
    busy_stage s;
    size_t bytes;
    uint8_t *copy;
    (void)state;
    busy_stage_open(&s, 1);
    busy_stage_enter(&s);
    busy_stage_play(&s);
    const uint8_t *own = noh_stage_state(s.c.stage, &bytes);
    const noh_stage_kind *walkers = &s.c.stage->kinds[WALKERS];
    const noh_stage_body *falls = noh_stage_body_of(walkers, 1), *walks = noh_stage_body_of(walkers, 0);
    assert_true(falls->doll && !walks->doll);
    copy = test_aligned(own, bytes);
    memcpy(copy + ((const uint8_t *)walks - own), falls, walkers->modules[NOH_SLOT_BODY].stride);
    assert_refused(&s, copy, bytes, "two actors have one ragdoll");
    free(copy);
    busy_stage_close(&s);
}

/* The places that add up over time are taken up to their limit, and refused beyond it. */
static void sums_in_states_have_a_limit(void **state)
{
    const double most = (double)NOH_SOUND_MAX;
    busy_stage s;
    size_t bytes;
    uint8_t *copy;
    (void)state;
    busy_stage_open(&s, 1);
    busy_stage_enter(&s);
    const uint8_t *own = noh_stage_state(s.c.stage, &bytes);
    copy = test_aligned(own, bytes);
    noh_stage_actor *first = (void *)(copy + ((const uint8_t *)s.c.stage->actors - own));
    first->home[0] = most;
    first->moved.translation[1] = -most;
    assert_int_equal(noh_stage_set_state(s.c.stage, copy, bytes, NULL), NOH_OK);
    first->home[0] = nextafter(most, INFINITY);
    assert_refused(&s, copy, bytes, "place is not a number");
    first->home[0] = most;
    first->moved.translation[1] = nextafter(-most, -INFINITY);
    assert_refused(&s, copy, bytes, "place is not a number");
    free(copy);
    busy_stage_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_in_states_have_a_limit),       cmocka_unit_test(a_stage_takes_its_own_states),
        cmocka_unit_test(despawned_actors_leave_nothing),    cmocka_unit_test(a_free_ragdoll_rests_in_states),
        cmocka_unit_test(a_ragdoll_has_one_actor_in_states), cmocka_unit_test(what_moves_stays_within),
        cmocka_unit_test(what_staggers_stays_within),        cmocka_unit_test(what_is_let_go_stays_within)
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
