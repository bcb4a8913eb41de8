/* Tests of crowd_round.c and of doors in crowd_plan.c: whatever the shape of what is in the way, an agent
 * gets round it without a flow field; crowds that meet in a narrow door all get through.
 * cross: long, ten thousand steps take minutes under an emulator */
#include "noh/base.h"
#include "noh/crowd.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

#define WALL(a, b, c, d)         \
    {                            \
        { a, b }, { c, d }, 0.1f \
    }

typedef struct shape {
    const char *name;
    uint32_t count;
    float from[2], to[2], seconds; /* enough of them */
    noh_crowd_obstacle walls[8];
} shape;

static const shape shapes[] = {
    { "U", 3, { -1, 0 }, { 5, 0 }, 40, { WALL(0, -4, 0, 4), WALL(0, -4, -5, -4), WALL(0, 4, -5, 4) } },
    { "deep U", 3, { -3, 0.5f }, { 5, 0 }, 50, { WALL(0, -2, 0, 2), WALL(0, -2, -9, -2), WALL(0, 2, -9, 2) } },
    { "goal in a U", 3, { -5, 0 }, { 1, 0 }, 40, { WALL(0, -4, 0, 4), WALL(0, -4, 5, -4), WALL(0, 4, 5, 4) } },
    { "corner", 2, { -4, 0 }, { 3, 6 }, 50, { WALL(0, -6, 0, 3), WALL(0, 3, -6, 3) } },
    { "spiral",
      4,
      { -3, 0 },
      { 5, 0 },
      70,
      { WALL(0, -3, 0, 3), WALL(0, 3, -6, 3), WALL(-6, 3, -6, -3), WALL(-6, -3, -2, -3) } },
    { "segments",
      8,
      { -5, 0 },
      { 5, 0 },
      40,
      { WALL(0, -8, 0, -6), WALL(0, -6, 0, -4), WALL(0, -4, 0, -2), WALL(0, -2, 0, 0), WALL(0, 0, 0, 2),
        WALL(0, 2, 0, 4), WALL(0, 4, 0, 6), WALL(0, 6, 0, 8) } },
    { "zigzag",
      7,
      { -5, 0 },
      { 6, 0 },
      40,
      { WALL(0, -8, 1, -6), WALL(1, -6, 0, -4), WALL(0, -4, 1, -2), WALL(1, -2, 0, 0), WALL(0, 0, 1, 2),
        WALL(1, 2, 0, 4), WALL(0, 4, 1, 6) } },
    { "comb",
      4,
      { -5, 0 },
      { 10, 0 },
      90,
      { WALL(0, -8, 0, 5), WALL(2, -5, 2, 8), WALL(4, -8, 4, 5), WALL(6, -5, 6, 8) } },
    { "room",
      5,
      { 8, 2 },
      { 1, 1 },
      70,
      { WALL(-3, -3, 3, -3), WALL(3, -3, 3, 3), WALL(3, 3, -3, 3), WALL(-3, 3, -3, 0.4f), WALL(-3, -0.4f, -3, -3) } },
    { "door of two agents' radii and 4 cm",
      2,
      { -5, 3 },
      { 5, -2 },
      40,
      { WALL(0, -8, 0, -0.37f), WALL(0, 0.37f, 0, 8) } },
};

static noh_crowd *made(const noh_crowd_obstacle *walls, uint32_t count, uint32_t agents)
{
    noh_crowd_desc desc;
    noh_crowd *crowd = NULL;
    memset(&desc, 0, sizeof desc);
    desc.agent_max = agents;
    desc.origin[0] = desc.origin[1] = -20.0f;
    desc.extent[0] = desc.extent[1] = 40.0f;
    desc.obstacles = walls;
    desc.obstacle_count = count;
    const size_t bytes = noh_crowd_size(&desc);
    assert_int_equal(noh_crowd_init(malloc(bytes), bytes, &desc, &crowd, NULL), NOH_OK);
    return crowd;
}

static void put(noh_crowd *crowd, uint32_t index, const float from[2], const float to[2])
{
    const noh_crowd_agent a = { { from[0], from[1] }, { 0.0f, 0.0f }, { to[0], to[1] }, 0.25f, 1.4f, 0, index };
    assert_int_equal(noh_crowd_add(crowd, index, &a, NULL), NOH_OK);
}

static float off(const noh_crowd *crowd, uint32_t index, const float to[2])
{
    noh_crowd_agent a;
    assert_true(noh_crowd_agent_stepped(crowd, index, &a));
    return hypotf(a.position[0] - to[0], a.position[1] - to[1]);
}

static void run(noh_crowd *crowd, float seconds)
{
    for (uint32_t i = 0; i < (uint32_t)(seconds * 30.0f); i++) noh_crowd_step(crowd, NOH_CROWD_STEP_TICKS);
}

/* As it stands, and turned and mirrored. */
static void every_shape_is_walked_round(void **state)
{
    (void)state;
    for (size_t s = 0; s < TEST_COUNT(shapes); s++) {
        for (int way = 0; way < 8; way++) {
            const double angle = 0.7 * way, c = cos(angle), n = sin(angle), flip = way & 1 ? -1.0 : 1.0;
            noh_crowd_obstacle walls[8];
            float ends[2][2];
            for (uint32_t i = 0; i < shapes[s].count + 1u; i++) {
                const int last = i == shapes[s].count;
                const float *from[2] = { last ? shapes[s].from : shapes[s].walls[i].from,
                                         last ? shapes[s].to : shapes[s].walls[i].to };
                for (int e = 0; e < 2; e++) {
                    float *out = last ? ends[e] : e ? walls[i].to : walls[i].from;
                    const double x = (double)from[e][0], z = flip * (double)from[e][1];
                    out[0] = (float)(c * x - n * z);
                    out[1] = (float)(n * x + c * z);
                }
                if (!last) walls[i].radius = shapes[s].walls[i].radius;
            }
            noh_crowd *crowd = made(walls, shapes[s].count, 1);
            put(crowd, 0, ends[0], ends[1]);
            run(crowd, shapes[s].seconds);
            if (off(crowd, 0, ends[1]) > 0.1f)
                fail_msg("%s, turned %d: %g m off", shapes[s].name, way, off(crowd, 0, ends[1]));
            free(crowd);
        }
    }
}

/* Walls of any length, met anywhere. */
static void a_straight_wall_is_walked_round(void **state)
{
    static const float halves[] = { 1, 2, 2.5f, 3, 4, 6, 9 }, offsets[] = { 0, 0.001f, 0.1f, 0.5f, 1, 2 };
    (void)state;
    for (size_t l = 0; l < TEST_COUNT(halves); l++) {
        for (size_t o = 0; o < TEST_COUNT(offsets); o++) {
            const noh_crowd_obstacle wall = WALL(0, -halves[l], 0, halves[l]);
            const float from[2] = { -5.0f, offsets[o] }, to[2] = { 5.0f, offsets[o] };
            noh_crowd *crowd = made(&wall, 1, 1);
            put(crowd, 0, from, to);
            run(crowd, 30.0f);
            if (off(crowd, 0, to) > 0.1f) fail_msg("half of %g m, at %g", halves[l], offsets[o]);
            free(crowd);
        }
    }
}

/* A goal that nobody can stand on is the nearest free place; one that is shut in is walked round, and walls hold. */
static void goals_that_cannot_be_reached(void **state)
{
    const noh_crowd_obstacle walls[] = { WALL(-3, -3, 3, -3), WALL(3, -3, 3, 3), WALL(3, 3, -3, 3),
                                         WALL(-3, 3, -3, -3) };
    const float from[2] = { -8.0f, 0.3f }, shut[2] = { 1.0f, 1.0f };
    (void)state;
    for (int i = 0; i < 3; i++) {
        const float to[2] = { -3.2f + 0.1f * (float)i, 2.0f }, stands[2] = { -3.35f, 2.0f };
        noh_crowd *crowd = made(walls, 4, 1);
        put(crowd, 0, from, to);
        run(crowd, 20.0f);
        if (off(crowd, 0, stands) > 0.1f) fail_msg("goal %d: %g m off", i, off(crowd, 0, stands));
        free(crowd);
    }
    noh_crowd *crowd = made(walls, 4, 1);
    float least = 100.0f, most = 0.0f;
    put(crowd, 0, from, shut);
    for (int i = 0; i < 60; i++) {
        const float middle[2] = { 0.0f, 0.0f };
        run(crowd, 1.0f);
        least = fminf(least, off(crowd, 0, middle));
        if (i > 10) most = fmaxf(most, off(crowd, 0, middle));
    }
    assert_true(least > 3.3f && most < 5.5f);
    free(crowd);
}

/* A hall whose two halves a door joins; nobody can go round. returns how many of both sides are through */
static uint32_t meet(uint32_t left, uint32_t right, float clear, double angle, float seconds)
{
    const float h = 0.5f * clear + 0.1f;
    const float plan[6][4] = { { 0, -8, 0, -h }, { 0, h, 0, 8 },  { -9, -8, 9, -8 },
                               { 9, -8, 9, 8 },  { 9, 8, -9, 8 }, { -9, 8, -9, -8 } };
    const float c = (float)cos(angle), n = (float)sin(angle);
    noh_crowd_obstacle walls[6];
    uint32_t through = 0;
    for (int i = 0; i < 6; i++) {
        for (int e = 0; e < 2; e++) {
            float *out = e ? walls[i].to : walls[i].from;
            out[0] = c * plan[i][2 * e] - n * plan[i][2 * e + 1];
            out[1] = n * plan[i][2 * e] + c * plan[i][2 * e + 1];
        }
        walls[i].radius = 0.1f;
    }
    noh_crowd *crowd = made(walls, 6, left + right);
    for (uint32_t i = 0; i < left + right; i++) {
        const uint32_t k = i < left ? i : i - left;
        const float x = (i < left ? -1.0f : 1.0f) * (2.5f + 0.6f * (float)(k / 4u)),
                    z = 0.6f * ((float)(k % 4u) - 1.5f);
        const float from[2] = { c * x - n * z, n * x + c * z }, to[2] = { -c * x - n * z, -n * x + c * z };
        put(crowd, i, from, to);
    }
    run(crowd, seconds);
    for (uint32_t i = 0; i < left + right; i++) {
        noh_crowd_agent a;
        (void)noh_crowd_agent_stepped(crowd, i, &a);
        const float x = c * a.position[0] + n * a.position[1];
        through += i < left ? x > 0.3f : x < -0.3f;
    }
    free(crowd);
    return through;
}

static void crowds_pass_through_a_door(void **state)
{
    static const struct {
        uint32_t left, right;
        float clear, seconds;
    } cases[] = { { 4, 4, 0.6f, 200 },  { 4, 4, 0.54f, 240 }, { 1, 1, 0.6f, 20 }, { 12, 12, 0.6f, 300 },
                  { 12, 3, 0.6f, 200 }, { 8, 8, 0.8f, 200 },  { 12, 0, 0.6f, 60 } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        for (int turn = 0; turn < 8; turn++) {
            const uint32_t all = cases[i].left + cases[i].right;
            const uint32_t through = meet(cases[i].left, cases[i].right, cases[i].clear, 0.55 * turn, cases[i].seconds);
            if (through != all)
                fail_msg("%u against %u, turned %d: %u through", cases[i].left, cases[i].right, turn, through);
        }
    }
}

/* Who waits in a queue along the wall of a door goes on waiting, and does not walk away. */
static void a_queue_at_a_door_stays_there(void **state)
{
    const noh_crowd_obstacle walls[] = { WALL(-19, 0, -0.9f, 0), WALL(0.9f, 0, 19, 0) };
    (void)state;
    for (int shift = 0; shift < 2; shift++) {
        noh_crowd *crowd = made(walls, 2, 160);
        uint32_t out = 0;
        for (uint32_t i = 0; i < 160u; i++) {
            const float x = 0.7f * ((float)(i % 16u) - 7.5f) + 0.05f * (float)shift, half = 0.53f;
            const float from[2] = { x, -1.5f - 0.7f * (float)(i / 16u) };
            const float to[2] = { x < -half ? -half : x > half ? half : x, 0.5f };
            put(crowd, i, from, to);
        }
        for (int step = 0; step < 30 * 40 && out < 160u; step++) {
            noh_crowd_step(crowd, NOH_CROWD_STEP_TICKS);
            for (uint32_t i = 0; i < 160u; i++) {
                noh_crowd_agent a;
                if (!noh_crowd_agent_stepped(crowd, i, &a)) continue;
                if (fabsf(a.position[0]) > 9.0f) fail_msg("agent %u walks away, shift %d", i, shift);
                if (a.position[1] < 0.0f) continue;
                noh_crowd_remove(crowd, i);
                out++;
            }
        }
        if (out != 160u) fail_msg("%u out, shift %d", out, shift);
        free(crowd);
    }
}

/* Of two ways past a wall the shorter one is a gap in which somebody stands: all take the other. */
static void who_stands_in_a_gap_is_walked_round(void **state)
{
    const noh_crowd_obstacle walls[] = { WALL(0, -3, 0, 3), WALL(0, 3.75f, 0, 9.75f) };
    (void)state;
    for (uint32_t count = 1; count < 6u; count += 2u) {
        for (int o = 0; o < 8; o++) {
            noh_crowd *crowd = made(walls, 2, count + 1u);
            const noh_crowd_agent stands = { { 0, 3.375f }, { 0, 0 }, { 0, 3.375f }, 0.25f, 0.0f, 0, 100 };
            assert_int_equal(noh_crowd_add(crowd, count, &stands, NULL), NOH_OK);
            for (uint32_t i = 0; i < count; i++) {
                const float x = 5.0f + 0.6f * (float)i, z = 0.5f * (float)o;
                const float from[2] = { -x, z }, to[2] = { x, z };
                put(crowd, i, from, to);
            }
            run(crowd, 60.0f);
            for (uint32_t i = 0; i < count; i++) {
                noh_crowd_agent a;
                assert_true(noh_crowd_agent_stepped(crowd, i, &a));
                if (a.position[0] < 0.3f) fail_msg("agent %u of %u, at %d: does not get past", i, count, o);
            }
            free(crowd);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_straight_wall_is_walked_round), cmocka_unit_test(every_shape_is_walked_round),
        cmocka_unit_test(goals_that_cannot_be_reached),    cmocka_unit_test(crowds_pass_through_a_door),
        cmocka_unit_test(a_queue_at_a_door_stays_there),   cmocka_unit_test(who_stands_in_a_gap_is_walked_round),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
