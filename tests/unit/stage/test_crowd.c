/* Tests of runtime/stage/crowd/: agents that arrive, pass each other, and stay out of walls; the same bits however they are
 * stepped. Scenes with bounds are in cli/crowd.sh.
 * cross: long, minutes of a crowd */
#include "noh/base.h"
#include "noh/crowd.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

#define SECOND 48000u

static noh_crowd *made(const noh_crowd_desc *desc)
{
    const size_t bytes = noh_crowd_size(desc);
    noh_crowd *crowd = NULL;
    void *memory = malloc(bytes ? bytes : 1);
    assert_int_equal(noh_crowd_init(memory, bytes, desc, &crowd, NULL), NOH_OK);
    return crowd;
}

static noh_crowd_desc field_of(uint32_t agents, float side)
{
    noh_crowd_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.agent_max = agents;
    desc.origin[0] = desc.origin[1] = -0.5f * side;
    desc.extent[0] = desc.extent[1] = side;
    return desc;
}

static void put(noh_crowd *crowd, uint32_t index, float x, float z, float to_x, float to_z)
{
    const noh_crowd_agent a = { { x, z }, { 0.0f, 0.0f }, { to_x, to_z }, 0.25f, 1.3f, 0, index };
    assert_int_equal(noh_crowd_add(crowd, index, &a, NULL), NOH_OK);
}

static noh_crowd_agent stepped(const noh_crowd *crowd, uint32_t index)
{
    noh_crowd_agent a;
    assert_true(noh_crowd_agent_stepped(crowd, index, &a));
    return a;
}

static float apart(const float a[2], const float b[2])
{
    return sqrtf((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]));
}

static void run(noh_crowd *crowd, float seconds)
{
    for (uint32_t i = 0; i < (uint32_t)(seconds * 30.0f); i++) noh_crowd_step(crowd, NOH_CROWD_STEP_TICKS);
}

/* The nearest that two of them come within a time. */
static float nearest(noh_crowd *crowd, uint32_t count, float seconds)
{
    float least = 1e9f;
    for (uint32_t step = 0; step < (uint32_t)(seconds * 30.0f); step++) {
        noh_crowd_step(crowd, NOH_CROWD_STEP_TICKS);
        for (uint32_t i = 0; i < count; i++) {
            for (uint32_t j = 0; j < i; j++) {
                const noh_crowd_agent a = stepped(crowd, i), b = stepped(crowd, j);
                least = fminf(least, apart(a.position, b.position));
            }
        }
    }
    return least;
}

/* ---- what agents do ---- */

static void one_walks_straight_and_stops(void **state)
{
    const noh_crowd_desc desc = field_of(4, 40.0f);
    noh_crowd *crowd = made(&desc);
    float fastest = 0.0f, furthest = -10.0f;
    (void)state;
    put(crowd, 2, -10.0f, 0.0f, 3.0f, 0.0f);
    for (int i = 0; i < 30 * 14; i++) {
        noh_crowd_step(crowd, NOH_CROWD_STEP_TICKS);
        const noh_crowd_agent a = stepped(crowd, 2);
        fastest = fmaxf(fastest, a.velocity[0]);
        furthest = fmaxf(furthest, a.position[0]);
        assert_float_equal(a.position[1], 0.0f, 1e-4f);
    }
    assert_float_equal(fastest, 1.3f, 1e-3f);
    assert_true(furthest < 3.01f);
    assert_float_equal(stepped(crowd, 2).position[0], 3.0f, 0.01f);
    assert_true(fabsf(stepped(crowd, 2).velocity[0]) < 0.01f);
    free(crowd);
}

static void two_who_meet_pass_on_the_right(void **state)
{
    const noh_crowd_desc desc = field_of(2, 40.0f);
    noh_crowd *crowd = made(&desc);
    float most = 0.0f;
    (void)state;
    put(crowd, 0, -8.0f, 0.0f, 8.0f, 0.0f);
    put(crowd, 1, 8.0f, 0.0f, -8.0f, 0.0f);
    for (int i = 0; i < 30 * 16; i++) {
        noh_crowd_step(crowd, NOH_CROWD_STEP_TICKS);
        const noh_crowd_agent a = stepped(crowd, 0), b = stepped(crowd, 1);
        assert_true(apart(a.position, b.position) > 0.499f);
        if (fabsf(a.position[0]) < 0.1f) most = a.position[1];
    }
    assert_true(most < -0.2f); /* x to the right and z up as seen from below: the right hand is at -z */
    assert_float_equal(stepped(crowd, 0).position[0], 8.0f, 0.05f);
    assert_float_equal(stepped(crowd, 1).position[0], -8.0f, 0.05f);
    free(crowd);
}

static void one_that_holds_its_place_is_walked_around(void **state)
{
    const noh_crowd_desc desc = field_of(8, 40.0f);
    const noh_crowd_agent post = { { 0.0f, 0.0f }, { 1.0f, 0.0f }, { 5.0f, 5.0f }, 0.25f, 0.0f, 0, 77 };
    noh_crowd *crowd = made(&desc);
    (void)state;
    for (uint32_t i = 1; i < 8u; i++) put(crowd, i, -6.0f - (float)i, 0.1f * (float)i, 8.0f, 0.6f * (float)i);
    assert_int_equal(noh_crowd_add(crowd, 0, &post, NULL), NOH_OK);
    assert_true(nearest(crowd, 8, 20.0f) > 0.49f);
    assert_true(apart(stepped(crowd, 0).position, post.position) == 0.0f);
    for (uint32_t i = 1; i < 8u; i++) assert_true(stepped(crowd, i).position[0] > 7.0f);
    free(crowd);
}

/* All in one place: no direction is NaN, and agents that must part do. */
static void coincident_agents_part(void **state)
{
    const noh_crowd_desc desc = field_of(9, 40.0f);
    noh_crowd *crowd = made(&desc);
    (void)state;
    for (uint32_t i = 0; i < 9u; i++) put(crowd, i, 0.0f, 0.0f, 0.0f, 0.0f);
    run(crowd, 6.0f);
    assert_true(nearest(crowd, 9, 0.1f) > 0.45f);
    for (uint32_t i = 0; i < 9u; i++) assert_true(fabsf(stepped(crowd, i).position[0]) < 3.0f);
    free(crowd);
}

/* ---- walls ---- */

static const noh_crowd_obstacle box[5] = {
    { { -2.0f, -2.0f }, { 2.0f, -2.0f }, 0.1f }, { { 2.0f, -2.0f }, { 2.0f, 2.0f }, 0.1f },
    { { 2.0f, 2.0f }, { -2.0f, 2.0f }, 0.1f },   { { -2.0f, 2.0f }, { -2.0f, -2.0f }, 0.1f },
    { { 0.0f, 6.0f }, { 0.0f, 6.0f }, 1.0f },
};

static float outside_box(const float at[2])
{
    const float x = fmaxf(fabsf(at[0]) - 2.0f, 0.0f), z = fmaxf(fabsf(at[1]) - 2.0f, 0.0f);
    return sqrtf(x * x + z * z) - 0.1f;
}

/* From everywhere around it, goals right behind it. */
static void none_is_stuck_on_a_convex_obstacle(void **state)
{
    noh_crowd_desc desc = field_of(72, 60.0f);
    (void)state;
    desc.reach = 6.0f;
    desc.obstacles = box;
    desc.obstacle_count = 5;
    for (uint32_t way = 0; way < 72u; way++) {
        const float angle = 0.0872665f * (float)way, x = 12.0f * cosf(angle), z = 12.0f * sinf(angle);
        noh_crowd *crowd = made(&desc);
        put(crowd, 0, x, z, -x, -z);
        for (int i = 0; i < 30 * 30; i++) {
            noh_crowd_step(crowd, NOH_CROWD_STEP_TICKS);
            const float *at = stepped(crowd, 0).position, post[2] = { 0.0f, 6.0f };
            assert_true(outside_box(at) > 0.249f);
            assert_true(apart(at, post) > 1.249f);
        }
        const float goal[2] = { -x, -z };
        if (apart(stepped(crowd, 0).position, goal) > 0.1f) fail_msg("from %u degrees it did not arrive", 5u * way);
        free(crowd);
    }
}

/* An agent that many push, and that runs, does not get through a wall. */
static void none_gets_through_a_wall(void **state)
{
    static const noh_crowd_obstacle wall = { { 0.0f, -20.0f }, { 0.0f, 20.0f }, 0.0f };
    noh_crowd_desc desc = field_of(200, 60.0f);
    (void)state;
    desc.obstacles = &wall;
    desc.obstacle_count = 1;
    noh_crowd *crowd = made(&desc);
    for (uint32_t i = 0; i < 200u; i++) {
        const float row = (float)(i / 20u), column = (float)(i % 20u) - 10.0f;
        const noh_crowd_agent a = { { -0.5f - row, column }, { 9.0f, 0.0f }, { 5.0f, 0.0f }, 0.25f, 3.75f, 0, i };
        assert_int_equal(noh_crowd_add(crowd, i, &a, NULL), NOH_OK);
    }
    for (int step = 0; step < 300; step++) {
        float before[200];
        for (uint32_t i = 0; i < 200u; i++) before[i] = stepped(crowd, i).position[0];
        noh_crowd_step(crowd, NOH_CROWD_STEP_TICKS);
        for (uint32_t i = 0; i < 200u; i++) { /* past its ends they may get */
            const noh_crowd_agent a = stepped(crowd, i);
            if (fabsf(a.position[1]) > 19.0f) continue;
            assert_true(fabsf(a.position[0]) > 0.249f && (a.position[0] > 0.0f) == (before[i] > 0.0f));
        }
    }
    free(crowd);
}

/* ---- time, threads, order ---- */

static noh_crowd *mixed(uint32_t jobs, uint32_t turn)
{
    static const noh_crowd_obstacle posts[2] = { { { 3.0f, 1.0f }, { -4.0f, 2.0f }, 0.2f },
                                                 { { 0.0f, -5.0f }, { 0.0f, -5.0f }, 1.0f } };
    noh_crowd_desc desc = field_of(300, 20.0f);
    uint32_t seed = 9;
    desc.job_count = jobs;
    desc.obstacles = posts;
    desc.obstacle_count = 2;
    noh_crowd *crowd = made(&desc);
    for (uint32_t i = 0; i < 290u; i++) {
        float r[4];
        for (int k = 0; k < 4; k++) {
            seed = seed * 1664525u + 1013904223u;
            r[k] = (float)(seed >> 8) * (20.0f / 16777216.0f) - 10.0f;
        }
        const noh_crowd_agent a = { { r[0], r[1] },
                                    { 0.0f, 0.0f },
                                    { r[2], r[3] },
                                    0.2f + 0.01f * (float)(i % 9u),
                                    i % 31u ? 1.0f + 0.02f * (float)(i % 20u) : 0.0f,
                                    i % 5u ? 0 : NOH_CROWD_ORCA,
                                    i };
        assert_int_equal(noh_crowd_add(crowd, (i * 7u + turn) % 300u, &a, NULL), NOH_OK);
    }
    return crowd;
}

static uint32_t hash_after(noh_crowd *crowd, float seconds)
{
    run(crowd, seconds);
    const uint32_t hash = noh_crowd_hash(crowd);
    free(crowd);
    return hash;
}

/* Jobs in reverse: any order, any number. */
static uint32_t hash_of_jobs(uint32_t jobs, float seconds)
{
    noh_crowd *crowd = mixed(jobs, 0);
    for (uint32_t step = 0; step < (uint32_t)(seconds * 30.0f); step++) {
        noh_crowd_begin(crowd, NOH_CROWD_STEP_TICKS);
        for (uint32_t count; (count = noh_crowd_jobs(crowd)) > 0;) {
            for (uint32_t i = count; i > 0; i--) noh_crowd_job(crowd, i - 1u);
        }
    }
    return hash_after(crowd, 0.0f);
}

static void bits_depend_on_neither_order_nor_jobs(void **state)
{
    const uint32_t hash = hash_after(mixed(1, 0), 20.0f);
    (void)state;
    assert_int_not_equal(hash, hash_after(mixed(1, 0), 19.0f));
    assert_int_equal(hash_of_jobs(1, 20.0f), hash);
    assert_int_equal(hash_of_jobs(4, 20.0f), hash);
    assert_int_equal(hash_of_jobs(64, 20.0f), hash);
    assert_int_equal(hash_after(mixed(3, 11), 20.0f), hash); /* other indices, the same ids */
    assert_int_equal(hash_after(mixed(1, 299), 20.0f), hash);
}

static void bits_are_those_of_every_processor(void **state)
{
    (void)state;
    assert_int_equal(hash_after(mixed(1, 0), 30.0f), 0x8eba7216u);
}

static void a_copy_goes_on(void **state)
{
    const noh_crowd_desc desc = field_of(300, 20.0f);
    noh_crowd *crowd = mixed(1, 0), *copy;
    (void)state;
    run(crowd, 3.0f);
    noh_crowd_desc with = desc;
    static const noh_crowd_obstacle posts[2] = { { { 3.0f, 1.0f }, { -4.0f, 2.0f }, 0.2f },
                                                 { { 0.0f, -5.0f }, { 0.0f, -5.0f }, 1.0f } };
    with.obstacles = posts;
    with.obstacle_count = 2;
    const size_t bytes = noh_crowd_size(&with);
    copy = malloc(bytes);
    memcpy(copy, crowd, bytes);
    assert_int_equal(hash_after(crowd, 5.0f), hash_after(copy, 5.0f));
}

/* What is shown moves evenly in frames of any length, and steps do not depend on them. */
static void frames_are_interpolated(void **state)
{
    const noh_crowd_desc desc = field_of(1, 40.0f);
    noh_crowd *crowd = made(&desc), *whole = made(&desc);
    noh_crowd_agent before, now;
    (void)state;
    put(crowd, 0, -10.0f, 0.0f, 15.0f, 0.0f);
    put(whole, 0, -10.0f, 0.0f, 15.0f, 0.0f);
    run(crowd, 4.0f);
    run(whole, 4.0f);
    assert_true(noh_crowd_agent_at(crowd, 0, &before));
    for (int i = 0; i < 1000; i++) {
        noh_crowd_step(crowd, 333u);
        assert_true(noh_crowd_agent_at(crowd, 0, &now));
        assert_float_equal(now.position[0] - before.position[0], 1.3f * 333.0f / 48000.0f, 2e-5f);
        before = now;
    }
    for (int i = 0; i < 333 * 1000 / 1600; i++) noh_crowd_step(whole, NOH_CROWD_STEP_TICKS);
    assert_int_equal(noh_crowd_hash(crowd), noh_crowd_hash(whole));
    assert_int_equal(noh_crowd_step(crowd, 100u * SECOND), NOH_CROWD_STEPS_MAX);
    free(crowd);
    free(whole);
}

/* ---- what is refused, and memory ---- */

static void bad_values_are_refused(void **state)
{
    noh_crowd_desc desc = field_of(10, 20.0f);
    noh_crowd *crowd = made(&desc);
    noh_error error;
    const noh_crowd_agent good = { { 0.0f, 0.0f }, { 0.0f, 0.0f }, { 1.0f, 1.0f }, 0.25f, 1.3f, 0, 0 };
    const uint32_t before = noh_crowd_hash(crowd);
    noh_crowd_agent a;
    (void)state;
#define REFUSED(field, value)                                                                         \
    (a = good, a.field = (value), assert_int_equal(noh_crowd_add(crowd, 3, &a, &error), NOH_ERR_ARG), \
     assert_int_equal(error.where, 3))
    REFUSED(position[0], NAN);
    REFUSED(position[1], INFINITY);
    REFUSED(velocity[0], NAN);
    REFUSED(goal[1], 2e6f);
    REFUSED(radius, 0.0f);
    REFUSED(radius, 1.6f);
    REFUSED(speed, -1.0f);
    REFUSED(speed, 4.0f);
    REFUSED(speed, NAN);
#undef REFUSED
    assert_int_equal(noh_crowd_hash(crowd), before);
    assert_false(noh_crowd_agent_at(crowd, 3, &a));
    static const noh_crowd_obstacle wrong[] = { { { 0.0f, 0.0f }, { 1.0f, 0.0f }, -0.1f },
                                                { { 0.0f, 0.0f }, { 1.0f, 0.0f }, 2e6f },
                                                { { 0.0f, 0.0f }, { 1.0f, 0.0f }, NAN },
                                                { { 0.0f, NAN }, { 1.0f, 0.0f }, 0.1f },
                                                { { 0.0f, 0.0f }, { -2e6f, 0.0f }, 0.1f } };
    desc.obstacle_count = 1;
    for (size_t i = 0; i < TEST_COUNT(wrong); i++) {
        desc.obstacles = &wrong[i];
        assert_int_equal(noh_crowd_size(&desc), 0);
        assert_int_equal(noh_crowd_init(crowd, 100, &desc, &crowd, &error), NOH_ERR_ARG);
    }
    desc.obstacle_count = 0;
    desc.extent[1] = 0.0f;
    assert_int_equal(noh_crowd_size(&desc), 0);
    assert_int_equal(noh_crowd_init(crowd, 100, &desc, &crowd, &error), NOH_ERR_ARG);
    desc = field_of(NOH_CROWD_AGENTS_MAX + 1u, 20.0f);
    assert_int_equal(noh_crowd_init(crowd, 100, &desc, &crowd, &error), NOH_ERR_LIMIT);
    assert_int_equal(error.need, NOH_CROWD_AGENTS_MAX + 1u);
    free(crowd);
}

/* NaN and far goals are clamped; agents outside of the grid still find each other. */
static void extremes_stay_finite(void **state)
{
    const noh_crowd_desc desc = field_of(40, 3.0f);
    const float goals[3][2] = { { NAN, 1e30f }, { -INFINITY, 0.0f }, { 9e5f, 9e5f } };
    noh_crowd *crowd = made(&desc);
    (void)state;
    for (uint32_t i = 0; i < 40u; i++) {
        put(crowd, i, 500.0f + 0.3f * (float)(i % 7u), -800.0f, 500.0f, -790.0f);
        noh_crowd_set_goal(crowd, i, goals[i % 3u]);
        noh_crowd_set_speed(crowd, i, i % 2u ? NAN : 1e9f);
    }
    run(crowd, 10.0f);
    for (uint32_t i = 0; i < 40u; i++) {
        const noh_crowd_agent a = stepped(crowd, i);
        assert_true(isfinite(a.position[0]) && isfinite(a.position[1]) && fabsf(a.velocity[0]) < 6.0f);
    }
    free(crowd);
}

static void ten_thousand_take_less_than_promised(void **state)
{
    noh_crowd_desc desc = field_of(10000, 200.0f);
    (void)state;
    print_message("10,000 agents on 200 x 200 m: %zu bytes\n", noh_crowd_size(&desc));
    assert_true(noh_crowd_size(&desc) <= 96u * 10000u);
    desc.extent[0] = 1e6f;
    assert_true(noh_crowd_size(&desc) <= 96u * 10000u);
}

static void removed_agents_are_gone(void **state)
{
    const noh_crowd_desc desc = field_of(2, 40.0f);
    noh_crowd *crowd = made(&desc);
    noh_crowd_agent a;
    (void)state;
    put(crowd, 0, -3.0f, 0.0f, 8.0f, 0.0f);
    put(crowd, 1, 3.0f, 0.0f, -8.0f, 0.0f);
    noh_crowd_remove(crowd, 1);
    assert_false(noh_crowd_agent_stepped(crowd, 1, &a));
    for (int i = 0; i < 300; i++) {
        noh_crowd_step(crowd, NOH_CROWD_STEP_TICKS);
        assert_true(stepped(crowd, 0).position[1] == 0.0f);
    }
    free(crowd);
}

/* A crowd whose origin moves, there and back, moves exactly like one whose origin stays: agents, what they aim at,
 * walls, grids and flow fields. */
static void the_origin_may_move(void **state)
{
    static const noh_crowd_obstacle wall = { { -1.0f, 0.0f }, { 4.0f, 0.0f }, 0.1f };
    const float goal[2] = { 3.0f, 4.0f };
    noh_crowd_desc desc = field_of(8, 20.0f);
    noh_crowd *still, *moved;
    float worst = 0.0f, by[2] = { 0.0f, 0.0f };
    (void)state;
    desc.obstacles = &wall;
    desc.obstacle_count = 1;
    desc.field_count = 1;
    desc.field_radius = 0.3f;
    still = made(&desc);
    moved = made(&desc);
    for (uint32_t i = 0; i < 2; i++) {
        noh_crowd *c = i ? moved : still;
        put(c, 0, 0.5f, -3.0f, 0.5f, -3.0f);
        put(c, 1, -4.0f, 3.0f, 4.0f, 2.5f);
        noh_crowd_field_aim(c, 0, goal);
        while (noh_crowd_field_build(c, 100000)) {}
        noh_crowd_follow(c, 0, 0);
    }
    for (int i = 0; i < 300; i++) {
        if (i % 60 == 20) {
            const float way[2] = { i % 120 == 20 ? 64.0f : -64.0f, i % 120 == 20 ? -32.0f : 32.0f };
            noh_crowd_shift_origin(moved, way);
            by[0] += way[0], by[1] += way[1];
        }
        noh_crowd_step(still, NOH_CROWD_STEP_TICKS);
        noh_crowd_step(moved, NOH_CROWD_STEP_TICKS);
        for (uint32_t k = 0; k < 2; k++) {
            noh_crowd_agent a = stepped(still, k), b = stepped(moved, k);
            b.position[0] += by[0], b.position[1] += by[1], b.goal[0] += by[0], b.goal[1] += by[1];
            worst = fmaxf(worst, fmaxf(apart(a.position, b.position), apart(a.goal, b.goal)));
        }
    }
    assert_true(worst < 0.05f); /* a cell may be entered one step earlier */
    {
        const noh_crowd_agent a = stepped(still, 0);
        assert_true(apart(a.position, goal) < 0.5f); /* it came around the wall */
    }
    free(still);
    free(moved);
}

/* 100 km from the origin agents go as far as at it, though a step of theirs is less than ten floats there. */
static void far_away_is_like_here(void **state)
{
    const float far_off[2] = { 100000.0f, -250000.0f }, goal[2] = { 3.0f, 4.0f };
    noh_crowd *crowds[2];
    float worst = 0.0f;
    (void)state;
    for (uint32_t c = 0; c < 2; c++) {
        const float x = c ? far_off[0] : 0.0f, z = c ? far_off[1] : 0.0f, to[2] = { goal[0] + x, goal[1] + z };
        const noh_crowd_obstacle wall = { { -1.0f + x, z }, { 4.0f + x, z }, 0.125f };
        noh_crowd_desc desc = field_of(8, 20.0f);
        desc.origin[0] += x;
        desc.origin[1] += z;
        desc.obstacles = &wall;
        desc.obstacle_count = 1;
        desc.field_count = 1;
        desc.field_radius = 0.3f;
        crowds[c] = made(&desc);
        put(crowds[c], 0, 0.5f + x, -3.0f + z, 0.5f + x, -3.0f + z);
        put(crowds[c], 1, -4.0f + x, 3.0f + z, 4.0f + x, 2.5f + z);
        noh_crowd_field_aim(crowds[c], 0, to);
        while (noh_crowd_field_build(crowds[c], 100000)) {}
        noh_crowd_follow(crowds[c], 0, 0);
    }
    for (int i = 0; i < 300; i++) {
        for (uint32_t c = 0; c < 2; c++) noh_crowd_step(crowds[c], NOH_CROWD_STEP_TICKS);
        for (uint32_t k = 0; k < 2; k++) {
            noh_crowd_agent a = stepped(crowds[0], k), b = stepped(crowds[1], k);
            b.position[0] -= far_off[0], b.position[1] -= far_off[1];
            worst = fmaxf(worst, apart(a.position, b.position));
        }
    }
    print_message("100 km away: %.3g m beside\n", (double)worst);
    assert_true(worst < 0.02f); /* told in floats: 8 mm */
    free(crowds[0]);
    free(crowds[1]);
}

int main(int argument_count, char **arguments)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(far_away_is_like_here),
        cmocka_unit_test(the_origin_may_move),
        cmocka_unit_test(one_walks_straight_and_stops),
        cmocka_unit_test(two_who_meet_pass_on_the_right),
        cmocka_unit_test(one_that_holds_its_place_is_walked_around),
        cmocka_unit_test(coincident_agents_part),
        cmocka_unit_test(none_is_stuck_on_a_convex_obstacle),
        cmocka_unit_test(none_gets_through_a_wall),
        cmocka_unit_test(bits_depend_on_neither_order_nor_jobs),
        cmocka_unit_test(bits_are_those_of_every_processor),
        cmocka_unit_test(a_copy_goes_on),
        cmocka_unit_test(frames_are_interpolated),
        cmocka_unit_test(bad_values_are_refused),
        cmocka_unit_test(extremes_stay_finite),
        cmocka_unit_test(ten_thousand_take_less_than_promised),
        cmocka_unit_test(removed_agents_are_gone),
    };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
