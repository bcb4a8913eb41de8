/* States of a stage that somebody tampered with: whatever bits are flipped and whatever words are put in, the state is
 * refused with a message, or frames go on: joints and weights are numbers, and the bits are the same for one job and
 * for four. The stage has all modules that save something: graphs, faces, gazes, feet, hands, springs, ragdolls and
 * motion matching, in the middle of walks, falls, staggers and fades. NOH_LONG=1: every word.
 * cross: long, thousands of frames */
#include "support/busy_stage.h"

#include <math.h>

static noh_error said;

/* What is shown is numbers. Returns what is not, or NULL. */
static const char *bad_number(const busy_stage *s)
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
    busy_stage one, four;
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
        busy_stage_frame(&t->one, f);
        busy_stage_frame(&t->four, f);
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
                                      0x5d5e0b6bu /* 10^18 */,
                                      0x7f7fffffu,
                                      0x0000ffffu };
    test_random r = test_random_from(45);
    const int all = getenv("NOH_LONG") != NULL;
    tampered t;
    (void)state;
    memset(&t, 0, sizeof t);
    busy_stage_open(&t.one, 1);
    busy_stage_open(&t.four, 4);
    busy_stage_enter(&t.one);
    busy_stage_play(&t.one);
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
    busy_stage_close(&t.one);
    busy_stage_close(&t.four);
}

/* Places from the game are as safe as states. */
static void a_scale_out_of_range_is_refused(void **state)
{
    static const float refused[] = { -1.0f, 1e-13f, 1e-45f, 2e12f, NAN, INFINITY }, taken[] = { 0.0f, 1e-12f, 1e12f };
    busy_stage s;
    (void)state;
    busy_stage_open(&s, 1);
    busy_stage_enter(&s);
    for (size_t i = 0; i < TEST_COUNT(refused) + TEST_COUNT(taken); i++) {
        const int bad = i < TEST_COUNT(refused);
        const noh_place place = { .scale = bad ? refused[i] : taken[i - TEST_COUNT(refused)] };
        assert_int_equal(noh_actor_set_place(s.c.stage, s.actors[0], &place, NULL), bad ? NOH_ERR_ARG : NOH_OK);
        busy_stage_frame(&s, 1);
        assert_null(bad_number(&s));
    }
    busy_stage_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(whatever_is_in_a_state),
                                        cmocka_unit_test(a_scale_out_of_range_is_refused) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
