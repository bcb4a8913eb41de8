/* Frames between two steps of a stage: places and poses are mixed, an actor that leaps does not smear, and what is
 * asked agrees with what shows. */
#include "support/stage_fixture.h"

#include <math.h>

#define STEP (NOH_TICKS_PER_SECOND / 30)
#define JOINTS_MAX 64u

static const noh_appearance posed = { .posed = 1 };
static noh_error said;

static void step(cast *c)
{
    assert_int_equal(noh_stage_step(c->stage, STEP, NULL, NULL, NULL), NOH_OK);
}

static void between(cast *c, float alpha)
{
    const noh_stage_view view = cast_view(0, 6.0f);
    assert_int_equal(noh_stage_frame_between(c->stage, &view, 1, alpha, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame_end(c->stage, NULL), NOH_OK);
}

static noh_actor enter(cast *c, uint32_t kind, const char *clip)
{
    noh_actor actor;
    assert_int_equal(noh_stage_spawn(c->stage, kind, NULL, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(c->stage, actor, &posed, NULL), NOH_OK);
    if (clip) assert_int_equal(noh_actor_play(c->stage, actor, 0, clip, NULL, NULL), NOH_OK);
    return actor;
}

static void go(cast *c, noh_actor actor, float x)
{
    const noh_place place = { { x, 0.0f, 0.0f }, { 0, 0, 0, 0 }, 0.0f };
    assert_int_equal(noh_actor_set_place(c->stage, actor, &place, NULL), NOH_OK);
}

/* Where the last frame shows it: by its sphere, whose centre its clips do not move. */
static float shown_x(const cast *c, noh_actor actor)
{
    float sphere[4];
    assert_int_equal(noh_actor_sphere(c->stage, actor, sphere, NULL), NOH_OK);
    return sphere[0];
}

static float asked_x(const cast *c, noh_actor actor, float alpha)
{
    noh_place place;
    assert_int_equal(noh_actor_place_between(c->stage, actor, alpha, &place, NULL), NOH_OK);
    return place.position[0];
}

static uint32_t joints(const cast *c, noh_actor actor, float *out)
{
    const uint32_t count = c->plan.kinds[PUPPETS].joint_count;
    assert_true(count > 10 && count <= JOINTS_MAX);
    for (uint32_t j = 0; j < count; j++) {
        assert_int_equal(noh_actor_joint(c->stage, actor, j, out + 12u * (size_t)j, NULL), NOH_OK);
    }
    return 12u * count;
}

/* ---- places ---- */

static void places_are_mixed(void **state)
{
    const noh_place first = { { 1.0f, 2.0f, 4.0f }, { 0, 0, 0, 1 }, 1.0f };
    const noh_place second = { { 3.0f, 6.0f, 0.0f }, { 0, 1, 0, 0 }, 2.0f };
    noh_place place;
    noh_actor actor;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    actor = enter(&c, MASKS, NULL);
    assert_int_equal(noh_actor_set_place(c.stage, actor, &first, NULL), NOH_OK);
    step(&c);
    assert_int_equal(noh_actor_set_place(c.stage, actor, &second, NULL), NOH_OK);
    step(&c);
    assert_int_equal(noh_actor_place_between(c.stage, actor, 0.0f, &place, NULL), NOH_OK);
    assert_memory_equal(&place, &first, sizeof place);
    assert_int_equal(noh_actor_place_between(c.stage, actor, 1.0f, &place, NULL), NOH_OK);
    assert_memory_equal(&place, &second, sizeof place);
    assert_int_equal(noh_actor_place_between(c.stage, actor, 0.5f, &place, NULL), NOH_OK);
    assert_true(place.position[0] == 2.0f && place.position[1] == 4.0f && place.position[2] == 2.0f);
    assert_true(place.scale == 1.5f && fabsf(place.rotation[1] - sqrtf(0.5f)) < 1e-6f);
    assert_int_equal(noh_actor_place_between(c.stage, actor, 1.5f, &place, &said), NOH_ERR_ARG);
    assert_int_equal(noh_actor_place_between(c.stage, actor, NAN, &place, &said), NOH_ERR_ARG);
    assert_int_equal(noh_stage_frame_between(c.stage, NULL, 0, -0.1f, &said), NOH_ERR_ARG);
    assert_non_null(strstr(said.what, "alpha"));
    assert_int_equal(noh_stage_frame_between(c.stage, NULL, 0, NAN, &said), NOH_ERR_ARG);
    between(&c, 1.0f); /* the refused ones have begun no frame */
    cast_close(&c);
}

/* Whether a game sets places before its steps or behind them, what shows moves evenly, and stops where it stops. */
static void places_are_set_before_steps_or_behind(void **state)
{
    (void)state;
    for (int behind = 0; behind < 2; behind++) {
        float last = -1.0f, x;
        noh_actor actor;
        cast c;
        cast_open(&c);
        cast_make(&c, NULL);
        actor = enter(&c, MASKS, NULL);
        between(&c, 1.0f);
        last = shown_x(&c, actor);
        for (int s = 1; s <= 12; s++) {
            if (behind) step(&c);
            if (s <= 6) go(&c, actor, (float)s);
            if (!behind) step(&c);
            for (int f = 0; f < 4; f++) {
                between(&c, 0.25f * (float)f);
                x = shown_x(&c, actor);
                assert_true(x >= last && x - last < 0.2501f);
                if (s > 1 && s <= 6)
                    assert_true(fabsf(asked_x(&c, actor, 0.25f * (float)f) - x) < 1e-5f + fabsf(x) * 0.1f);
                last = x;
            }
        }
        assert_true(fabsf(asked_x(&c, actor, 0.0f) - 6.0f) < 1e-6f && asked_x(&c, actor, 1.0f) == 6.0f);
        cast_close(&c);
    }
}

static void whoever_leaps_does_not_smear(void **state)
{
    float pose[2][12 * JOINTS_MAX];
    noh_actor actor, other;
    uint32_t count;
    cast c;
    (void)state;
    cast_open(&c);
    c.kinds[PUPPETS].root_axes = 0;
    cast_make(&c, NULL);
    actor = enter(&c, PUPPETS, "walk");
    step(&c);
    go(&c, actor, 1.0f);
    step(&c);
    between(&c, 0.5f);
    go(&c, actor, 9.0f);
    assert_int_equal(noh_actor_cut(c.stage, actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(c.stage, actor, 0, "dance", &(noh_play){ .fade_ticks = 1 }, NULL), NOH_OK);
    assert_true(asked_x(&c, actor, 0.0f) == 9.0f && asked_x(&c, actor, 0.5f) == 9.0f);
    between(&c, 0.25f);
    count = joints(&c, actor, pose[0]);
    between(&c, 1.0f);
    (void)joints(&c, actor, pose[1]);
    assert_memory_equal(pose[0], pose[1], count * sizeof(float)); /* nor does its pose */
    step(&c);
    assert_true(asked_x(&c, actor, 0.0f) == 9.0f);
    assert_int_equal(noh_stage_spawn(c.stage, PUPPETS, &(noh_place){ .position = { 5, 0, 0 } }, &other, NULL), NOH_OK);
    assert_true(asked_x(&c, other, 0.25f) == 5.0f);
    assert_int_equal(noh_stage_despawn(c.stage, other, NULL), NOH_OK);
    assert_int_equal(noh_actor_cut(c.stage, other, NULL), NOH_ERR_NOT_FOUND);
    cast_close(&c);
}

/* Root motion is on its way like any other: half of a step is shown half way. */
static void a_walk_is_shown_on_its_way(void **state)
{
    noh_place at[3];
    noh_actor actor;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    actor = enter(&c, PUPPETS, "walk");
    for (int s = 0; s < 20; s++) step(&c);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(noh_actor_place_between(c.stage, actor, 0.5f * (float)i, &at[i], NULL), NOH_OK);
    }
    assert_true(fabsf(at[2].position[2] - at[0].position[2]) > 0.01f);
    for (int i = 0; i < 3; i++) {
        assert_true(fabsf(at[1].position[i] - 0.5f * (at[0].position[i] + at[2].position[i])) < 1e-6f);
    }
    cast_close(&c);
}

/* ---- poses ---- */

/* At alpha 1 a frame shows the pose of the last step, at 0 the pose of the step before it, to the bit, and half way the
 * mean of the two. */
static void poses_are_mixed(void **state)
{
    float exact[2][12 * JOINTS_MAX], shown[12 * JOINTS_MAX], moved = 0.0f;
    noh_actor actor, twin;
    cast c, plain;
    (void)state;
    cast_open(&c);
    cast_open(&plain);
    c.kinds[PUPPETS].root_axes = plain.kinds[PUPPETS].root_axes = 0;
    cast_make(&c, NULL);
    cast_make(&plain, NULL);
    actor = enter(&c, PUPPETS, "dance");
    twin = enter(&plain, PUPPETS, "dance");
    for (uint32_t s = 0; s < 60; s++) {
        const float alphas[3] = { 0.0f, 0.5f, 1.0f };
        uint32_t count;
        step(&c);
        step(&plain);
        memcpy(exact[0], exact[1], sizeof exact[0]);
        assert_int_equal(noh_stage_frame_begin(plain.stage, NULL, 0, NULL), NOH_OK);
        assert_int_equal(noh_stage_frame_end(plain.stage, NULL), NOH_OK);
        count = joints(&plain, twin, exact[1]);
        for (uint32_t a = 0; a < 2u + s % 2u; a++) { /* in every second step none is shown at alpha 1 */
            between(&c, alphas[a]);
            (void)joints(&c, actor, shown);
            for (uint32_t i = 0; i < count && s; i++) {
                const float want = exact[0][i] + (exact[1][i] - exact[0][i]) * alphas[a];
                if (a == 1 ? fabsf(shown[i] - want) > 1e-6f : shown[i] != exact[a / 2u][i])
                    fail_msg("step %u, alpha %g: %g for %g", (unsigned)s, (double)alphas[a], (double)shown[i],
                             (double)want);
                moved = fmaxf(moved, fabsf(exact[1][i] - exact[0][i]));
            }
        }
    }
    assert_true(moved > 0.05f);
    cast_close(&plain);
    cast_close(&c);
}

/* An actor in full detail is posed once in a step, however many frames show it; and at once when a clip begins. */
static void a_step_is_posed_once(void **state)
{
    noh_actor actor;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    actor = enter(&c, PUPPETS, "walk");
    step(&c);
    between(&c, 0.0f);
    for (int s = 0; s < 10; s++) {
        step(&c);
        for (int f = 0; f < 5; f++) {
            between(&c, 0.1f + 0.2f * (float)f);
            assert_int_equal(noh_stage_stats_of(c.stage)->updated, f == 0);
        }
    }
    assert_int_equal(noh_actor_play(c.stage, actor, 0, "bow", NULL, NULL), NOH_OK);
    between(&c, 0.9f);
    assert_int_equal(noh_stage_stats_of(c.stage)->updated, 1);
    cast_close(&c);
}

/* Steps and frames of any lengths: what shows never leaps, at any rate of posing. */
static void nothing_leaps(void **state)
{
    static const float distances[] = { 3.0f, 30.0f, 90.0f };
    test_random r = test_random_from(41);
    (void)state;
    for (uint32_t d = 0; d < TEST_COUNT(distances); d++) {
        float last[12 * JOINTS_MAX], now[12 * JOINTS_MAX];
        const noh_appearance seen = { .pixels = 1.0f };
        uint32_t stepped = 0, wanted = 0, updates = 0;
        noh_actor actor;
        cast c;
        cast_open(&c);
        cast_make(&c, NULL);
        actor = enter(&c, PUPPETS, "walk");
        assert_int_equal(noh_actor_set_appearance(c.stage, actor, &seen, NULL), NOH_OK);
        for (uint32_t f = 0; f < 1500; f++) {
            const uint32_t ticks = 200u + test_random_below(&r, 700);
            float worst = 0.0f, alpha;
            noh_stage_view view;
            noh_place place;
            uint32_t count;
            for (wanted += ticks; stepped < wanted; stepped += STEP) step(&c);
            alpha = 1.0f - (float)(stepped - wanted) / (float)STEP;
            assert_int_equal(noh_actor_place_between(c.stage, actor, alpha, &place, NULL), NOH_OK);
            noh_view_orbit(&view, place.position, 0.3f, 0.1f, distances[d], 640, 360);
            assert_int_equal(noh_stage_frame_between(c.stage, &view, 1, alpha, NULL), NOH_OK);
            assert_int_equal(noh_stage_frame_end(c.stage, NULL), NOH_OK);
            updates += noh_stage_stats_of(c.stage)->updated;
            count = joints(&c, actor, now);
            for (uint32_t i = 0; i < count && f > 2; i++) worst = fmaxf(worst, fabsf(now[i] - last[i]));
            if (worst > 0.25f) fail_msg("%g m, frame %u: %g", (double)distances[d], (unsigned)f, (double)worst);
            memcpy(last, now, sizeof now);
        }
        assert_true(updates < 1500u && updates > 100u);
        cast_close(&c);
    }
}

/* ---- what agrees ---- */

static void whatever_hangs_on_a_joint_is_where_that_is_shown(void **state)
{
    const noh_place up = { { 0.0f, 0.25f, 0.0f }, { 0, 0, 0, 0 }, 0.5f };
    float joint[12], sphere[4];
    noh_actor puppet, mask;
    noh_place place;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    puppet = enter(&c, PUPPETS, "dance");
    mask = enter(&c, MASKS, NULL);
    step(&c);
    assert_int_equal(noh_actor_set_place(c.stage, mask, &up, NULL), NOH_OK);
    assert_int_equal(noh_actor_attach(c.stage, mask, puppet, 20, NULL), NOH_OK);
    assert_true(asked_x(&c, mask, 0.0f) == 0.0f);
    for (int s = 0; s < 5; s++) {
        go(&c, puppet, (float)s);
        step(&c);
        between(&c, 0.3f);
    }
    assert_int_equal(noh_actor_joint(c.stage, puppet, 20, joint, NULL), NOH_OK);
    assert_int_equal(noh_actor_sphere(c.stage, puppet, sphere, NULL), NOH_OK);
    assert_true(fabsf(joint[3] - sphere[0]) < sphere[3]);
    assert_int_equal(noh_actor_attach(c.stage, mask, (noh_actor){ 0 }, 0, NULL), NOH_OK); /* it stays where it showed */
    for (int i = 0; i < 3; i++) {
        const float want = joint[4 * i + 1] * 0.25f + joint[4 * i + 3];
        assert_int_equal(noh_actor_place_between(c.stage, mask, 0.5f * (float)i, &place, NULL), NOH_OK);
        assert_true(fabsf(place.position[i] - want) < 1e-5f);
    }
    cast_close(&c);
}

/* A ray meets an actor where it shows, not where its last step took it; a frame culls it by that too. */
static void picked_and_culled_where_it_shows(void **state)
{
    const float down[3] = { 0.0f, 0.0f, -1.0f };
    float sphere[4], from[3];
    noh_stage_hit hit;
    noh_actor actor;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    actor = enter(&c, MASKS, NULL);
    assert_int_equal(noh_actor_sphere(c.stage, actor, sphere, NULL), NOH_OK);
    step(&c);
    go(&c, actor, 400.0f); /* out of the picture */
    step(&c);
    for (int i = 0; i < 2; i++) {
        memcpy(from, sphere, sizeof from);
        from[2] += 5.0f;
        between(&c, i ? 1.0f : 0.0f);
        assert_int_equal(noh_stage_pick(c.stage, from, down, 50.0f, &hit, NULL), i ? NOH_ERR_NOT_FOUND : NOH_OK);
        assert_int_equal(noh_stage_stats_of(c.stage)->seen, !i);
        from[0] += 400.0f;
        assert_int_equal(noh_stage_pick(c.stage, from, down, 50.0f, &hit, NULL), NOH_ERR_NOT_FOUND);
    }
    cast_close(&c);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_are_mixed),
        cmocka_unit_test(places_are_set_before_steps_or_behind),
        cmocka_unit_test(whoever_leaps_does_not_smear),
        cmocka_unit_test(a_walk_is_shown_on_its_way),
        cmocka_unit_test(poses_are_mixed),
        cmocka_unit_test(a_step_is_posed_once),
        cmocka_unit_test(nothing_leaps),
        cmocka_unit_test(whatever_hangs_on_a_joint_is_where_that_is_shown),
        cmocka_unit_test(picked_and_culled_where_it_shows),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
