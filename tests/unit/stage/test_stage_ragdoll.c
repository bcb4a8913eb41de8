/* Ragdolls of actors: a puppet that walks, is hit, falls and lies; how many may fall; states saved, put back and
 * tampered with; the same bits for any number of jobs. */
#include "support/stage_fixture.h"

#include <math.h>

static noh_error said;

static const noh_plane floor_plane = { { 0.0f, 1.0f, 0.0f }, 0.0f };
static const noh_world ground = { .planes = &floor_plane, .plane_count = 1, .friction = 0.6f };

static void open_cast(cast *c, uint32_t actors, const noh_kind_ragdoll *ragdoll, uint32_t jobs)
{
    memset(c, 0, sizeof *c);
    cast_map(c, PUPPETS, "demo/puppet_levels.noh");
    c->kinds[0].mesh = &c->packs[0];
    c->kinds[0].actor_count = actors;
    c->kinds[0].root_axes = NOH_ROOT_GROUND;
    c->kinds[0].root_up = 1;
    c->kinds[0].ragdoll = ragdoll;
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 1;
    c->desc.job_count = jobs;
}

static void close_cast(cast *c)
{
    cast_close_stage(c);
    noh_file_unmap(&c->files[0]);
}

static noh_actor enter(const cast *c, float x)
{
    const noh_look posed = { .posed = 1 };
    const noh_place place = { { x, 0.0f, 0.0f }, { 0, 0, 0, 0 }, 0.0f };
    noh_actor actor;
    assert_int_equal(noh_stage_spawn(c->stage, 0, &place, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(c->stage, actor, 0, "walk", NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_look(c->stage, actor, &posed, NULL), NOH_OK);
    return actor;
}

static void run(const cast *c, uint32_t frames)
{
    for (uint32_t f = 0; f < frames; f++) {
        assert_int_equal(noh_stage_frame(c->stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
    }
}

static void joint_at(const cast *c, noh_actor actor, const char *name, float out[3])
{
    float matrix[12];
    const uint32_t joint = noh_stage_find(c->stage, 0, NOH_NAME_JOINT, name);
    assert_true(joint != NOH_NONE);
    assert_int_equal(noh_actor_joint(c->stage, actor, joint, matrix, NULL), NOH_OK);
    for (int i = 0; i < 3; i++) out[i] = matrix[4 * i + 3];
}

static float distance(const float a[3], const float b[3])
{
    return sqrtf((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

/* From step to step no joint leaps, and none changes its speed but by what gravity and the ground do; it lies within
 * eight seconds, on the ground and not under it, and its place is where it lies. */
static void who_walks_falls_and_lies(void **state)
{
    static const char *const names[] = { "head", "hand.L", "hand.R", "foot.L", "foot.R", "hips" };
    const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    float before[TEST_COUNT(names)][3], now[3];
    uint32_t frames = 0;
    noh_place place;
    noh_actor actor;
    cast c;
    (void)state;
    open_cast(&c, 1, &ragdoll, 1);
    cast_make(&c, NULL);
    actor = enter(&c, 0.0f);
    run(&c, 40);
    assert_int_equal(noh_actor_falls(c.stage, actor), 0);
    assert_int_equal(noh_actor_fall(c.stage, actor, &said), NOH_OK);
    assert_int_equal(noh_actor_falls(c.stage, actor), 1);
    for (size_t i = 0; i < TEST_COUNT(names); i++) joint_at(&c, actor, names[i], before[i]);
    for (; frames < 480 && noh_actor_falls(c.stage, actor) == 1; frames++) {
        run(&c, 1);
        for (size_t i = 0; i < TEST_COUNT(names); i++) {
            joint_at(&c, actor, names[i], now);
            assert_true(distance(before[i], now) < 0.2f); /* 12 m/s */
            assert_true(now[1] > -0.03f);
            memcpy(before[i], now, sizeof now);
        }
    }
    assert_int_equal(noh_actor_falls(c.stage, actor), 2);
    assert_true(before[0][1] < 0.5f && before[5][1] < 0.5f);
    assert_int_equal(noh_actor_place(c.stage, actor, &place, NULL), NOH_OK);
    assert_true(hypotf(place.position[0] - before[5][0], place.position[2] - before[5][2]) < 0.3f);
    print_message("lies after %.2f s, its head at %.0f mm\n", (double)frames / 60.0, 1000.0 * (double)before[0][1]);
    close_cast(&c);
}

/* The first frame of the fall goes on as the walk did: velocities come from the last two poses. Without a floor: that
 * would brake the feet. */
static void speeds_are_handed_over(void **state)
{
    const noh_kind_ragdoll ragdoll = { .count = 1 };
    float at[3][3];
    noh_actor actor;
    cast c;
    (void)state;
    open_cast(&c, 1, &ragdoll, 1);
    cast_make(&c, NULL);
    actor = enter(&c, 0.0f);
    run(&c, 40);
    joint_at(&c, actor, "hips", at[0]);
    run(&c, 1);
    joint_at(&c, actor, "hips", at[1]);
    assert_int_equal(noh_actor_fall(c.stage, actor, NULL), NOH_OK);
    run(&c, 1);
    joint_at(&c, actor, "hips", at[2]);
    assert_true(distance(at[0], at[1]) > 0.005f); /* it walks */
    for (int i = 0; i < 3; i++) assert_true(fabsf(at[2][i] - 2.0f * at[1][i] + at[0][i]) < 0.006f);
    close_cast(&c);
}

static void a_hit_pushes(void **state)
{
    static const float impulse[3] = { 60.0f, 0.0f, 0.0f };
    const noh_kind_ragdoll ragdoll = { .count = 2, .world = &ground };
    float point[3], pushed[3], left[3];
    noh_actor actors[2];
    cast c;
    (void)state;
    open_cast(&c, 2, &ragdoll, 1);
    cast_make(&c, NULL);
    actors[0] = enter(&c, 0.0f);
    actors[1] = enter(&c, 0.0f);
    run(&c, 20);
    joint_at(&c, actors[0], "chest", point);
    assert_int_equal(noh_actor_fall(c.stage, actors[1], NULL), NOH_OK);
    assert_int_equal(noh_actor_hit(c.stage, actors[0], point, impulse, NULL), NOH_OK);
    run(&c, 30);
    joint_at(&c, actors[0], "chest", pushed);
    joint_at(&c, actors[1], "chest", left);
    assert_true(pushed[0] > left[0] + 0.15f);
    close_cast(&c);
}

static void what_cannot_fall_is_told(void **state)
{
    static const float zero[3] = { 0.0f, 0.0f, 0.0f }, bad[3] = { 0.0f, NAN, 0.0f };
    noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    noh_actor actors[2], gone = { 0 };
    cast c;
    (void)state;
    open_cast(&c, 2, &ragdoll, 1);
    cast_make(&c, NULL);
    actors[0] = enter(&c, 0.0f);
    actors[1] = enter(&c, 2.0f);
    assert_int_equal(noh_actor_fall(c.stage, gone, NULL), NOH_ERR_NOT_FOUND);
    assert_int_equal(noh_actor_hit(c.stage, actors[0], bad, zero, NULL), NOH_ERR_ARG);
    assert_int_equal(noh_actor_falls(c.stage, actors[0]), 0);
    assert_int_equal(noh_actor_fall(c.stage, actors[0], NULL), NOH_OK); /* out of the bind pose: not shown yet */
    assert_int_equal(noh_actor_fall(c.stage, actors[1], &said), NOH_ERR_LIMIT);
    assert_int_equal(said.need, 2);
    assert_int_equal(noh_stage_despawn(c.stage, actors[0], NULL), NOH_OK); /* its doll is free again */
    assert_int_equal(noh_actor_fall(c.stage, actors[1], &said), NOH_OK);
    cast_close_stage(&c);
    c.kinds[0].ragdoll = NULL;
    cast_make(&c, NULL);
    actors[0] = enter(&c, 0.0f);
    assert_int_equal(noh_actor_fall(c.stage, actors[0], &said), NOH_ERR_ARG);
    cast_close_stage(&c);
    ragdoll.count = 0;
    c.kinds[0].ragdoll = &ragdoll;
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, &said), NOH_ERR_ARG);
    close_cast(&c);
}

static void every_byte_is_planned(void **state)
{
    const noh_kind_ragdoll ragdoll = { .count = 3, .world = &ground };
    noh_stage_bytes list[64];
    uint64_t sum = 0;
    noh_stage *made = NULL;
    cast c;
    (void)state;
    open_cast(&c, 5, &ragdoll, 2);
    assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
    for (uint32_t i = noh_stage_plan_parts(&c.desc, NULL, &c.plan, list, 64); i-- > 0;) sum += list[i].cpu_bytes;
    assert_true(sum == c.plan.cpu_bytes);
    c.memory = test_aligned(NULL, (size_t)c.plan.cpu_bytes);
    assert_int_equal(noh_stage_init(c.memory, (size_t)c.plan.cpu_bytes - 1u, NULL, &c.desc, &c.plan, &made, NULL),
                     NOH_ERR_MEMORY);
    assert_int_equal(noh_stage_init(c.memory, (size_t)c.plan.cpu_bytes, NULL, &c.desc, &c.plan, &c.stage, NULL),
                     NOH_OK);
    close_cast(&c);
}

/* Five fall one after another. */
static uint64_t five_fall(uint32_t jobs, int restored)
{
    static const float impulse[3] = { 20.0f, 10.0f, -30.0f };
    const noh_kind_ragdoll ragdoll = { .count = 5, .world = &ground };
    noh_actor actors[5];
    uint64_t hash;
    size_t bytes;
    void *copy = NULL;
    cast c;
    open_cast(&c, 5, &ragdoll, jobs);
    cast_make(&c, NULL);
    for (uint32_t i = 0; i < 5; i++) actors[i] = enter(&c, 1.1f * (float)i);
    for (uint32_t i = 0; i < 5; i++) {
        const float point[3] = { 1.1f * (float)i, 1.0f, 0.1f };
        run(&c, 7);
        assert_int_equal(noh_actor_hit(c.stage, actors[i], point, impulse, NULL), NOH_OK);
        if (i == 2 && restored) {
            copy = test_aligned(noh_stage_state(c.stage, &bytes), (size_t)c.plan.state_bytes);
            run(&c, 90);
            assert_int_equal(noh_stage_set_state(c.stage, copy, (size_t)c.plan.state_bytes, NULL), NOH_OK);
        }
    }
    run(&c, 60);
    hash = noh_stage_hash(c.stage);
    if (copy) { /* any bit of the dolls may be wrong: refused, or finite */
        uint8_t *state = copy;
        for (size_t at = 0; at < (size_t)c.plan.state_bytes; at += 61) {
            state[at] ^= 0x80;
            (void)noh_stage_set_state(c.stage, state, (size_t)c.plan.state_bytes, NULL);
            state[at] ^= 0x80;
        }
        memset(state + c.plan.state_bytes / 2u, 0xff, c.plan.state_bytes / 2u);
        assert_int_equal(noh_stage_set_state(c.stage, state, (size_t)c.plan.state_bytes, NULL), NOH_ERR_DATA);
        free(copy);
    }
    close_cast(&c);
    return hash;
}

static void the_same_bits_for_any_jobs_and_after_a_restore(void **state)
{
    (void)state;
    const uint64_t one = five_fall(1, 0);
    assert_true(one == five_fall(3, 0));
    assert_true(one == five_fall(1, 1));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(who_walks_falls_and_lies),
    cmocka_unit_test(speeds_are_handed_over),
    cmocka_unit_test(a_hit_pushes),
    cmocka_unit_test(what_cannot_fall_is_told),
    cmocka_unit_test(every_byte_is_planned),
    cmocka_unit_test(the_same_bits_for_any_jobs_and_after_a_restore),
};

TEST_MAIN(tests, NULL, NULL)
