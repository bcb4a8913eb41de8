/* Tests of flow fields (crowd_flow.c): they lead to their goals by short ways past any walls, in bounded
 * slices, and with the same bits however they are built and followed. */
#include "noh/base.h"
#include "noh/crowd.h"
#include "noh/low_core.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

#define SIDE 32.0f

/* Walls with gaps on alternating sides: the way from one end to the other is as long as all of them. */
static const noh_crowd_obstacle comb[4] = {
    { { -16.0f, -9.6f }, { 12.0f, -9.6f }, 0.1f },
    { { -12.0f, -3.2f }, { 16.0f, -3.2f }, 0.0f },
    { { -16.0f, 3.2f }, { 12.0f, 3.2f }, 0.1f },
    { { -12.0f, 9.6f }, { 16.0f, 9.6f }, 0.0f },
};

static noh_crowd_desc desc_of(uint32_t agents, uint32_t fields, uint32_t walls)
{
    noh_crowd_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.agent_max = agents;
    desc.origin[0] = desc.origin[1] = -0.5f * SIDE;
    desc.extent[0] = desc.extent[1] = SIDE;
    desc.obstacles = comb;
    desc.obstacle_count = walls;
    desc.field_count = fields;
    desc.field_radius = 0.25f;
    return desc;
}

static noh_crowd *made(const noh_crowd_desc *desc)
{
    const size_t bytes = noh_crowd_size(desc);
    noh_crowd *crowd = NULL;
    void *memory = malloc(bytes ? bytes : 1);
    assert_int_equal(noh_crowd_init(memory, bytes, desc, &crowd, NULL), NOH_OK);
    return crowd;
}

/* Of all directions of a field. */
static uint32_t hash_of(const noh_crowd *crowd, uint32_t field)
{
    uint32_t hash = 0;
    for (uint32_t i = 0; i < 64u * 64u; i++) {
        const float at[2] = { -15.75f + 0.5f * (float)(i % 64u), -15.75f + 0.5f * (float)(i / 64u) };
        float way[2] = { 0.0f, 0.0f };
        (void)noh_crowd_field_at(crowd, field, at, way);
        hash = noh_crc32c(hash, way, sizeof way);
    }
    return hash;
}

static float apart(const float a[2], const float b[2])
{
    return sqrtf((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]));
}

/* How far it is to the goal by a field, in steps of a tenth; -1: it ends elsewhere. */
static float length_of(const noh_crowd *crowd, uint32_t field, float x, float z, const float goal[2])
{
    float at[2] = { x, z }, way[2];
    for (uint32_t i = 0; i < 2000u; i++) {
        if (apart(at, goal) < 0.75f) return 0.1f * (float)i + apart(at, goal);
        if (!noh_crowd_field_at(crowd, field, at, way)) return -1.0f;
        at[0] += 0.1f * way[0];
        at[1] += 0.1f * way[1];
    }
    return -1.0f;
}

/* ---- ways ---- */

static void without_walls_it_leads_straight(void **state)
{
    static const float goal[2] = { 3.3f, -4.1f };
    const noh_crowd_desc desc = desc_of(1, 1, 0);
    noh_crowd *crowd = made(&desc);
    float worst = 0.0f, longest = 0.0f;
    (void)state;
    noh_crowd_field_aim(crowd, 0, goal);
    assert_int_equal(noh_crowd_field_build(crowd, 1000000), 0);
    for (uint32_t i = 0; i < 64u * 64u; i++) {
        const float at[2] = { -15.6f + 0.49f * (float)(i % 64u), -15.6f + 0.49f * (float)(i / 64u) };
        const float far = apart(at, goal);
        float way[2];
        assert_true(noh_crowd_field_at(crowd, 0, at, way));
        if (far < 2.0f) continue;
        worst = fmaxf(worst, 1.0f - ((goal[0] - at[0]) * way[0] + (goal[1] - at[1]) * way[1]) / far);
        longest = fmaxf(longest, length_of(crowd, 0, at[0], at[1], goal) / far);
    }
    print_message("furthest off: %.1f degrees; the longest way is %.4f of the straight one\n",
                  57.2957795 * acos(1.0 - (double)worst), (double)longest);
    assert_true(worst < 0.02f); /* 11.5 degrees */
    assert_true(longest > 0.9f && longest < 1.02f);
    free(crowd);
}

/* Through all gaps: the shortest way, from wall's end to wall's end, is 101.7 m. */
static void it_leads_through_every_gap(void **state)
{
    static const float goal[2] = { 0.0f, 13.0f };
    const noh_crowd_desc desc = desc_of(1, 1, 4);
    noh_crowd *crowd = made(&desc);
    (void)state;
    noh_crowd_field_aim(crowd, 0, goal);
    assert_int_equal(noh_crowd_field_build(crowd, 1000000), 0);
    const float length = length_of(crowd, 0, 0.0f, -13.0f, goal);
    print_message("the way through the comb: %.2f m\n", (double)length);
    assert_true(length > 101.5f && length < 105.5f);
    for (uint32_t i = 0; i < 64u * 64u; i++) {
        const float x = -15.75f + 0.5f * (float)(i % 64u), z = -15.75f + 0.5f * (float)(i / 64u);
        assert_true(length_of(crowd, 0, x, z, goal) >= 0.0f);
    }
    free(crowd);
}

static void what_is_walled_in_leads_nowhere(void **state)
{
    static const noh_crowd_obstacle cell[4] = { { { -2.0f, -2.0f }, { 2.0f, -2.0f }, 0.0f },
                                                { { 2.0f, -2.0f }, { 2.0f, 2.0f }, 0.0f },
                                                { { 2.0f, 2.0f }, { -2.0f, 2.0f }, 0.0f },
                                                { { -2.0f, 2.0f }, { -2.0f, -2.0f }, 0.0f } };
    static const float goal[2] = { 10.0f, 0.0f }, inside[2] = { 0.3f, 0.1f };
    noh_crowd_desc desc = desc_of(1, 2, 4);
    float way[2] = { 7.0f, 7.0f };
    desc.obstacles = cell;
    noh_crowd *crowd = made(&desc);
    (void)state;
    noh_crowd_field_aim(crowd, 0, goal);
    noh_crowd_field_aim(crowd, 1, inside);
    assert_int_equal(noh_crowd_field_build(crowd, 1000000), 0);
    assert_false(noh_crowd_field_at(crowd, 0, inside, way));
    assert_false(noh_crowd_field_at(crowd, 1, goal, way));
    assert_true(way[0] == 7.0f);
    assert_true(noh_crowd_field_at(crowd, 0, (float[2]){ -2.3f, 0.0f }, way));
    assert_true(noh_crowd_field_at(crowd, 1, (float[2]){ -1.7f, 0.0f }, way) && way[0] > 0.0f);
    free(crowd);
}

static void one_walks_through_a_maze_and_stops(void **state)
{
    static const float goal[2] = { 0.0f, 13.0f };
    const noh_crowd_agent a = { { 0.0f, -13.0f }, { 0.0f, 0.0f }, { 5.0f, 5.0f }, 0.25f, 1.3f, 0, 0 };
    const noh_crowd_desc desc = desc_of(1, 1, 4);
    noh_crowd *crowd = made(&desc);
    noh_crowd_agent now = a;
    uint32_t steps = 0;
    (void)state;
    assert_int_equal(noh_crowd_add(crowd, 0, &a, NULL), NOH_OK);
    noh_crowd_field_aim(crowd, 0, goal);
    noh_crowd_follow(crowd, 0, 0);
    assert_int_equal(noh_crowd_field_build(crowd, 1000000), 0);
    while (apart(now.position, goal) > 0.05f && steps < 30u * 120u) {
        noh_crowd_step(crowd, NOH_CROWD_STEP_TICKS);
        steps++;
        assert_true(noh_crowd_agent_stepped(crowd, 0, &now));
    }
    print_message("there in %.1f s\n", (double)steps / 30.0);
    assert_true(steps < 30u * 90u);
    assert_true(now.goal[0] == goal[0] && now.goal[1] == goal[1]);
    for (int i = 0; i < 60; i++) noh_crowd_step(crowd, NOH_CROWD_STEP_TICKS);
    assert_true(noh_crowd_agent_stepped(crowd, 0, &now));
    assert_true(fabsf(now.velocity[0]) + fabsf(now.velocity[1]) < 0.01f);
    noh_crowd_follow(crowd, 0, NOH_NONE);
    assert_true(noh_crowd_agent_stepped(crowd, 0, &now) && now.goal[0] == 5.0f);
    free(crowd);
}

/* ---- slices ---- */

/* A cell at a time, in steps, or at once. */
static void slices_change_nothing(void **state)
{
    static const float goals[2][2] = { { 0.0f, 13.0f }, { -14.0f, -1.0f } };
    static const uint32_t visits[4] = { 1, 100, 4097, 1000000 };
    uint32_t first = 0;
    (void)state;
    for (uint32_t k = 0; k < 4u; k++) {
        const noh_crowd_desc desc = desc_of(1, 2, 4);
        noh_crowd *crowd = made(&desc);
        uint32_t slices = 0;
        for (uint32_t i = 0; i < 2u; i++) noh_crowd_field_aim(crowd, i, goals[i]);
        while (noh_crowd_field_build(crowd, visits[k])) slices++;
        print_message("%u cells at a time: %u slices\n", visits[k], slices);
        const uint32_t hash = hash_of(crowd, 0) ^ (hash_of(crowd, 1) << 1);
        if (!k) first = hash;
        assert_int_equal(hash, first);
        assert_true(slices <= 2u * 20u * 64u * 64u / visits[k]);
        free(crowd);
    }
}

/* Until another is built the one before is followed; before the first there is none. */
static void what_was_built_stays_until_the_next_is(void **state)
{
    static const float goal[2] = { 10.0f, 0.0f }, other[2] = { -10.0f, 0.0f }, at[2] = { 0.0f, 0.0f };
    noh_crowd_desc desc = desc_of(1, 1, 0);
    float way[2];
    desc.field_visits = 500;
    noh_crowd *crowd = made(&desc);
    uint32_t steps = 0;
    (void)state;
    noh_crowd_field_aim(crowd, 0, goal);
    while (!noh_crowd_field_at(crowd, 0, at, way) && steps++ < 1000u) noh_crowd_step(crowd, NOH_CROWD_STEP_TICKS);
    assert_true(steps > 20u && steps < 200u);
    assert_true(way[0] > 0.99f);
    noh_crowd_field_aim(crowd, 0, other);
    for (steps = 0; steps < 1000u && way[0] > 0.0f; steps++) {
        assert_true(way[0] > 0.99f);
        noh_crowd_step(crowd, NOH_CROWD_STEP_TICKS);
        assert_true(noh_crowd_field_at(crowd, 0, at, way));
    }
    assert_true(steps > 20u && steps < 200u);
    assert_true(way[0] < -0.99f);
    free(crowd);
}

/* ---- bits, refusals, memory ---- */

static uint32_t hash_after(uint32_t jobs, uint32_t turn, uint32_t steps)
{
    noh_crowd_desc desc = desc_of(120, 3, 4);
    desc.job_count = jobs;
    noh_crowd *crowd = made(&desc);
    for (uint32_t i = 0; i < 120u; i++) {
        const float x = -14.0f + 2.4f * (float)(i % 12u), z = -15.0f + 0.6f * (float)(i / 12u);
        const noh_crowd_agent a = { { x, z }, { 0.0f, 0.0f }, { -x, -z }, 0.25f, 1.3f, i % 6u ? 0 : NOH_CROWD_ORCA, i };
        const uint32_t index = (i * 7u + turn) % 120u;
        assert_int_equal(noh_crowd_add(crowd, index, &a, NULL), NOH_OK);
        noh_crowd_follow(crowd, index, i % 4u < 3u ? i % 4u : NOH_NONE);
    }
    for (uint32_t i = 0; i < 3u; i++) noh_crowd_field_aim(crowd, i, (float[2]){ 4.0f * (float)i, 13.0f });
    for (uint32_t step = 0; step < steps; step++) {
        if (step == 200u) noh_crowd_field_aim(crowd, 1, (float[2]){ -13.0f, 0.0f });
        (void)noh_crowd_begin(crowd, NOH_CROWD_STEP_TICKS);
        for (uint32_t count; (count = noh_crowd_jobs(crowd)) > 0;) {
            for (uint32_t i = count; i > 0; i--) noh_crowd_job(crowd, i - 1u);
        }
    }
    const uint32_t hash = noh_crowd_hash(crowd);
    free(crowd);
    return hash;
}

static void bits_depend_on_neither_order_nor_jobs(void **state)
{
    const uint32_t hash = hash_after(1, 0, 600);
    (void)state;
    assert_int_not_equal(hash, hash_after(1, 0, 599));
    assert_int_equal(hash_after(4, 31, 600), hash);
    assert_int_equal(hash, 0x4220803fu); /* of every processor */
}

static void bad_values_are_refused(void **state)
{
    noh_crowd_desc desc = desc_of(1, NOH_CROWD_FIELDS_MAX + 1u, 0);
    noh_crowd *crowd = NULL;
    noh_error error;
    (void)state;
    assert_int_equal(noh_crowd_init(&desc, 8, &desc, &crowd, &error), NOH_ERR_LIMIT);
    desc = desc_of(1, 1, 0);
    desc.field_cell = 0.01f;
    assert_int_equal(noh_crowd_size(&desc), 0);
    assert_int_equal(noh_crowd_init(&desc, 8, &desc, &crowd, &error), NOH_ERR_LIMIT);
    desc.field_cell = NAN;
    assert_int_equal(noh_crowd_init(&desc, 8, &desc, &crowd, &error), NOH_ERR_ARG);
    desc.field_cell = -1.0f;
    assert_int_equal(noh_crowd_init(&desc, 8, &desc, &crowd, &error), NOH_ERR_ARG);
    desc = desc_of(1, 1, 0);
    desc.field_radius = 1.6f;
    assert_int_equal(noh_crowd_init(&desc, 8, &desc, &crowd, &error), NOH_ERR_ARG);
    desc = desc_of(1, 1, 0);
    desc.extent[0] = 1e6f;
    assert_int_equal(noh_crowd_init(&desc, 8, &desc, &crowd, &error), NOH_ERR_LIMIT);
}

static void their_memory_is_as_told(void **state)
{
    const noh_crowd_desc none = desc_of(100, 0, 4), one = desc_of(100, 1, 4), four = desc_of(100, 4, 4);
    const size_t cells = 64u * 64u;
    (void)state;
    assert_true(noh_crowd_size(&one) - noh_crowd_size(&none) - (2136u + 24u + 6u * cells) < 24u);
    /* both rounded up to 16 */
    assert_true(noh_crowd_size(&four) + 15u - noh_crowd_size(&one) - 3u * (24u + cells) < 31u);
}

/* Goals outside, agents outside, a goal in a wall. */
static void extremes_stay_finite(void **state)
{
    static const float goals[4][2] = { { NAN, 0.0f }, { 1e30f, -INFINITY }, { -12.0f, -3.2f }, { 5.0f, 5.0f } };
    const noh_crowd_desc desc = desc_of(8, 4, 4);
    noh_crowd *crowd = made(&desc);
    (void)state;
    for (uint32_t i = 0; i < 8u; i++) {
        const noh_crowd_agent a = { { 200.0f * (float)i, -90.0f }, { 0.0f, 0.0f }, { 0.0f, 0.0f }, 0.25f, 1.3f, 0, i };
        assert_int_equal(noh_crowd_add(crowd, i, &a, NULL), NOH_OK);
        noh_crowd_follow(crowd, i, i % 4u);
    }
    for (uint32_t i = 0; i < 4u; i++) noh_crowd_field_aim(crowd, i, goals[i]);
    for (int i = 0; i < 300; i++) noh_crowd_step(crowd, NOH_CROWD_STEP_TICKS);
    for (uint32_t i = 0; i < 8u; i++) {
        noh_crowd_agent a;
        assert_true(noh_crowd_agent_stepped(crowd, i, &a));
        assert_true(isfinite(a.position[0]) && isfinite(a.position[1]) && fabsf(a.velocity[0]) < 3.0f);
    }
    free(crowd);
}

int main(int argument_count, char **arguments)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_walls_it_leads_straight),
        cmocka_unit_test(it_leads_through_every_gap),
        cmocka_unit_test(what_is_walled_in_leads_nowhere),
        cmocka_unit_test(one_walks_through_a_maze_and_stops),
        cmocka_unit_test(slices_change_nothing),
        cmocka_unit_test(what_was_built_stays_until_the_next_is),
        cmocka_unit_test(bits_depend_on_neither_order_nor_jobs),
        cmocka_unit_test(bad_values_are_refused),
        cmocka_unit_test(their_memory_is_as_told),
        cmocka_unit_test(extremes_stay_finite),
    };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
