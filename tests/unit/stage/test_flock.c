/* Tests of flock.c: what the source writes, and what is right; and flocks in a crowd. */
#include "stage/crowd/crowd_internal.h"
#include "noh/base.h"
#include "noh/crowd.h"
#include "noh/low_stage.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/support.h"

static float length_of(const float v[2])
{
    return sqrtf(v[0] * v[0] + v[1] * v[1]);
}

/* ---- the source's formulas, as it has them ---- */

/* -toNeighbor * 5 * (1 - d / 3): the vector is not made unit, and d counts heights. */
static void literal_repel(const float to[3], float force[2])
{
    const float d = sqrtf(to[0] * to[0] + to[1] * to[1] + to[2] * to[2]), f = 1.0f - d / 3.0f;
    force[0] += -to[0] * 5.0f * f;
    force[1] += -to[2] * 5.0f * f;
}

/* v = obstacle - agent; f = 1 - (d / r * 3); v f 10 */
static void literal_avoid(const float to[2], float radius, float force[2])
{
    const float d = length_of(to);
    if (d >= radius * 3.0f) return;
    const float f = 1.0f - (d / radius * 3.0f);
    force[0] += to[0] / d * f * 10.0f;
    force[1] += to[1] / d * f * 10.0f;
}

/* acc = normalize(sum); v = normalize(v + acc dt) * 2 */
static void literal_turn(float velocity[2], const float sum[2], float seconds)
{
    const float size = length_of(sum);
    velocity[0] = velocity[0] / 2.0f + sum[0] / size * seconds;
    velocity[1] = velocity[1] / 2.0f + sum[1] / size * seconds;
    const float speed = length_of(velocity);
    velocity[0] *= 2.0f / speed;
    velocity[1] *= 2.0f / speed;
}

/* ---- each error, and what is right ---- */

static void repulsion_is_strongest_at_contact(void **state)
{
    float before = INFINITY, literal_near = 0.0f, literal_far = 0.0f;
    (void)state;
    for (int i = 1; i < 300; i++) {
        const float d = 0.01f * (float)i, to[2] = { 0.6f * d, -0.8f * d };
        float force[2] = { 0.0f, 0.0f };
        noh_flock_repel(to, force);
        assert_float_equal(length_of(force), 5.0f * (1.0f - d / 3.0f), 1e-5f);
        assert_true(force[0] <= 0.0f && force[1] >= 0.0f && length_of(force) < before);
        before = length_of(force);
    }
    const float near[3] = { 0.01f, 0.0f, 0.0f }, far[3] = { 1.5f, 0.0f, 0.0f };
    float a[2] = { 0.0f, 0.0f }, b[2] = { 0.0f, 0.0f };
    literal_repel(near, a);
    literal_repel(far, b);
    literal_near = length_of(a);
    literal_far = length_of(b);
    assert_true(literal_near < 0.06f && literal_far > 3.7f); /* stronger where it is further */
}

/* An agent 2.9 m higher on stairs is as near on the ground. */
static void heights_are_no_distance(void **state)
{
    const float level[3] = { 0.6f, 0.0f, 0.0f }, above[3] = { 0.6f, 2.9f, 0.0f }, to[2] = { 0.6f, 0.0f };
    float a[2] = { 0.0f, 0.0f }, b[2] = { 0.0f, 0.0f }, ours[2] = { 0.0f, 0.0f };
    (void)state;
    literal_repel(level, a);
    literal_repel(above, b);
    assert_true(fabsf(b[0]) < 0.1f * fabsf(a[0]));
    noh_flock_repel(to, ours); /* is not told heights */
    assert_float_equal(ours[0], -4.0f, 1e-5f);
}

static void coincident_agents_part(void **state)
{
    const float none[2] = { 0.0f, 0.0f };
    (void)state;
    assert_true(isnan(none[0] / length_of(none))); /* of the source's normalize */
    for (uint32_t id = 0; id < 100u; id++) {
        float a[2] = { 0.0f, 0.0f }, b[2] = { 0.0f, 0.0f };
        assert_true(noh_flock_apart(none, 1.0f, id, id + 7u, a));
        assert_true(noh_flock_apart(none, 1.0f, id + 7u, id, b));
        assert_float_equal(length_of(a), 0.5f, 1e-5f);
        assert_true(a[0] == -b[0] && a[1] == -b[1]);
    }
}

static noh_crowd *flock(uint32_t flags, uint32_t turn);

/* Three in a row, parted in place, one pair after the other: where they end depends on their order. Read and written
 * apart they end alike, and so does a crowd that meets a post. */
static void the_order_of_agents_changes_nothing(void **state)
{
    static const int orders[2][3] = { { 0, 1, 2 }, { 2, 1, 0 } };
    float literal[2][3], ours[2][3];
    (void)state;
    for (int o = 0; o < 2; o++) {
        const float start[3] = { 0.0f, 0.4f, 0.9f };
        float next[3];
        memcpy(literal[o], start, sizeof start);
        for (int i = 0; i < 3; i++) {
            const int a = orders[o][i];
            float *x = literal[o], move[2] = { 0.0f, 0.0f };
            for (int b = 0; b < 3; b++) {
                const float to[2] = { start[b] - start[a], 0.0f };
                if (b == a) continue;
                (void)noh_flock_apart(to, 1.0f, (uint32_t)a, (uint32_t)b, move);
                if (fabsf(x[b] - x[a]) >= 1.0f) continue;
                const float middle = 0.5f * (x[a] + x[b]), side = x[b] > x[a] ? 0.5f : -0.5f;
                x[a] = middle - side;
                x[b] = middle + side;
            }
            next[a] = start[a] + move[0];
        }
        memcpy(ours[o], next, sizeof next);
    }
    assert_true(fabsf(literal[0][0] - literal[1][0]) > 0.05f);
    assert_memory_equal(ours[0], ours[1], sizeof ours[0]);
    noh_crowd *forth = flock(0, 0), *back = flock(0, 31);
    for (int i = 0; i < 300; i++) {
        noh_crowd_step(forth, NOH_CROWD_STEP_TICKS);
        noh_crowd_step(back, NOH_CROWD_STEP_TICKS);
    }
    assert_int_equal(noh_crowd_hash(forth), noh_crowd_hash(back));
    free(forth);
    free(back);
}

static void sums_of_pushes_keep_their_size(void **state)
{
    const float weak[2] = { 0.1f, 0.0f }, strong[2] = { 9.0f, 0.0f };
    float a[2] = { 0.0f, 2.0f }, b[2] = { 0.0f, 2.0f };
    (void)state;
    literal_turn(a, weak, 0.1f);
    literal_turn(b, strong, 0.1f);
    assert_memory_equal(a, b, sizeof a); /* a weak push is a strong one */
    float gentle[2] = { 0.0f, 0.05f }, hard[2] = { 0.0f, 0.05f };
    noh_flock_turn(gentle, weak, 2.0f, 3.0f, 0.1f);
    noh_flock_turn(hard, strong, 2.0f, 3.0f, 0.1f);
    assert_float_equal(gentle[0], 0.1f, 1e-6f);
    assert_true(hard[0] > 0.29f);
}

/* Pushes that cancel, or none at all: the source divides by the length of nothing, and its agent is lost for ever. */
static void no_push_stays_finite(void **state)
{
    const float none[2] = { 0.0f, 0.0f };
    float literal[2] = { 0.0f, 2.0f }, ours[2] = { 0.0f, 2.0f };
    (void)state;
    literal_turn(literal, none, 0.1f);
    assert_true(isnan(literal[0]) && isnan(literal[1]));
    for (int i = 0; i < 100; i++) {
        noh_flock_turn(ours, none, 2.0f, 3.0f, 0.1f);
        assert_true(isfinite(ours[0]) && isfinite(ours[1]) && length_of(ours) <= 2.0f);
    }
    noh_flock_turn(ours, none, 2.0f, 3.0f, 0.1f); /* from rest, to rest */
    assert_true(ours[0] == 0.0f && ours[1] == 0.0f);
    const float both[2] = { 1.0f, 0.0f }, mirrored[2] = { -1.0f, 0.0f };
    float force[2] = { 0.0f, 0.0f }, still[2] = { 0.0f, 0.0f };
    noh_flock_repel(both, force);
    noh_flock_repel(mirrored, force);
    noh_flock_turn(still, force, 2.0f, 3.0f, 0.1f);
    assert_true(still[0] == 0.0f && still[1] == 0.0f);
}

static void agents_stop_at_their_goals(void **state)
{
    const float none[2] = { 0.0f, 0.0f }, back[2] = { -0.001f, 0.0f };
    float literal[2] = { 2.0f, 0.0f }, ours[2] = { 2.0f, 0.0f };
    (void)state;
    for (int i = 0; i < 100; i++) literal_turn(literal, back, 0.01f);
    assert_float_equal(length_of(literal), 2.0f, 1e-4f);
    for (int i = 0; i < 100; i++) noh_flock_turn(ours, none, 2.0f, 3.0f, 0.01f);
    assert_true(length_of(ours) == 0.0f);
}

/* A turn to the side within a second, in four steps and in a hundred. */
static void turns_do_not_depend_on_the_step(void **state)
{
    const float side[2] = { 0.0f, 2.0f };
    float literal[2][2] = { { -2.0f, 0.1f }, { -2.0f, 0.1f } }, ours[2][2] = { { -2.0f, 0.1f }, { -2.0f, 0.1f } };
    (void)state;
    for (int k = 0; k < 2; k++) {
        const int steps = k ? 100 : 4;
        for (int i = 0; i < steps; i++) {
            literal_turn(literal[k], side, 1.0f / (float)steps);
            noh_flock_turn(ours[k], side, 2.0f, 2.0f, 1.0f / (float)steps);
        }
    }
    assert_true(fabsf(literal[0][0] - literal[1][0]) > 0.02f);
    assert_float_equal(ours[0][0], ours[1][0], 1e-4f);
    assert_float_equal(ours[0][1], ours[1][1], 1e-4f);
}

/* d / r * 3 is (d / r) * 3, where d / (3 r) is meant. With the direction put right, an obstacle would pull from a third
 * of its radius on, the more the further away, and let go at three radii. */
static void obstacles_push_hardest_when_near(void **state)
{
    (void)state;
    for (float radius = 0.5f; radius < 4.0f; radius *= 2.0f) {
        float literal_away = 0.0f, away = 0.0f;
        for (int i = 1; i < 300; i++) {
            const float to[2] = { 0.0f, 0.01f * radius * (float)i };
            float literal[2] = { 0.0f, 0.0f }, ours[2] = { 0.0f, 0.0f };
            literal_avoid(to, radius, literal);
            noh_flock_avoid(to, radius, ours);
            literal_away = literal[1]; /* it took the way to the obstacle for the way from it */
            away = -ours[1];
            assert_true(i < 33 ? literal_away > 0.0f : i < 34 || literal_away < 0.0f);
            assert_true(away > 0.0f && away <= 10.0f);
        }
        assert_true(literal_away < -79.0f); /* pulled hardest where it ends */
        assert_true(away < 0.05f);          /* fades out there */
    }
}

static void obstacles_push_away(void **state)
{
    float before = INFINITY;
    (void)state;
    for (int i = 1; i < 300; i++) {
        const float d = 0.01f * (float)i, to[2] = { d, 0.0f };
        float force[2] = { 0.0f, 0.0f };
        noh_flock_avoid(to, 1.0f, force);
        assert_float_equal(force[0], -10.0f * (1.0f - d / 3.0f), 1e-4f); /* away from it, less where it is further */
        assert_true(length_of(force) < before);
        before = length_of(force);
    }
    const float inside[2] = { 0.2f, 0.0f }, at[2] = { 1.0f, 0.0f }, far[2] = { 2.99f, 0.0f };
    float a[2] = { 0.0f, 0.0f }, b[2] = { 0.0f, 0.0f }, c[2] = { 0.0f, 0.0f };
    literal_avoid(inside, 1.0f, a);
    literal_avoid(at, 1.0f, b);
    literal_avoid(far, 1.0f, c);
    assert_true(a[0] > 0.0f);                /* it attracts */
    assert_float_equal(b[0], -20.0f, 1e-4f); /* repels by ten times what a unit has */
    assert_true(c[0] < -79.0f);              /* and most where it ends */
}

/* ---- flocks in a crowd ---- */

static uint32_t random_of(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static noh_crowd *flock(uint32_t flags, uint32_t turn)
{
    static const noh_crowd_obstacle post = { { 0.0f, 4.0f }, { 0.0f, 4.0f }, 0.8f };
    noh_crowd_desc desc;
    uint32_t seed = 5;
    noh_crowd *crowd = NULL;
    memset(&desc, 0, sizeof desc);
    desc.agent_max = 80;
    desc.origin[0] = desc.origin[1] = -50.0f;
    desc.extent[0] = desc.extent[1] = 100.0f;
    desc.obstacles = &post;
    desc.obstacle_count = 1;
    const size_t bytes = noh_crowd_size(&desc);
    void *memory = malloc(bytes);
    assert_int_equal(noh_crowd_init(memory, bytes, &desc, &crowd, NULL), NOH_OK);
    for (uint32_t i = 0; i < 80u; i++) {
        const float angle = (float)(random_of(&seed) % 6283u) * 1e-3f;
        const noh_crowd_agent a = { { (float)(i % 9u) * 1.5f - 6.0f, (float)(i / 9u) * 1.5f - 6.0f },
                                    { 1.5f * cosf(angle), 1.5f * sinf(angle) },
                                    { 0.0f, 30.0f },
                                    0.25f,
                                    1.5f,
                                    flags,
                                    i };
        assert_int_equal(noh_crowd_add(crowd, (i * 3u + turn) % 80u, &a, NULL), NOH_OK);
    }
    return crowd;
}

/* How alike their directions are: 1, all the same. And the distance of the two nearest. */
static float polarisation(const noh_crowd *crowd, float *nearest)
{
    float sum[2] = { 0.0f, 0.0f };
    *nearest = INFINITY;
    for (uint32_t i = 0; i < 80u; i++) {
        noh_crowd_agent a, b;
        assert_true(noh_crowd_agent_stepped(crowd, i, &a));
        const float speed = fmaxf(length_of(a.velocity), 1e-6f);
        sum[0] += a.velocity[0] / speed / 80.0f;
        sum[1] += a.velocity[1] / speed / 80.0f;
        for (uint32_t j = 0; j < i; j++) {
            assert_true(noh_crowd_agent_stepped(crowd, j, &b));
            *nearest = fminf(*nearest, hypotf(a.position[0] - b.position[0], a.position[1] - b.position[1]));
        }
    }
    return length_of(sum);
}

static void a_flock_turns_one_way(void **state)
{
    noh_crowd *together = flock(NOH_CROWD_FLOCK, 0);
    float nearest;
    (void)state;
    assert_true(polarisation(together, &nearest) < 0.3f);
    for (int i = 0; i < 30 * 6; i++) {
        noh_crowd_step(together, NOH_CROWD_STEP_TICKS);
        (void)polarisation(together, &nearest);
        assert_true(nearest > 0.45f);
    }
    const float after = polarisation(together, &nearest);
    print_message("a flock's directions after six seconds: %.3f alike, %.2f m apart\n", (double)after, (double)nearest);
    assert_true(after > 0.9f);
    free(together);
}

/* How alike their directions are after three seconds, where half want to go one way, half another. */
static float alike(uint32_t flags)
{
    static const float goals[2][2] = { { -1000.0f, 1000.0f }, { 1000.0f, 1000.0f } };
    noh_crowd *crowd = flock(flags, 0);
    float nearest, result;
    for (uint32_t i = 0; i < 80u; i++) noh_crowd_set_goal(crowd, i, goals[i * 3u / 2u % 2u]);
    for (int i = 0; i < 30 * 3; i++) noh_crowd_step(crowd, NOH_CROWD_STEP_TICKS);
    result = polarisation(crowd, &nearest);
    free(crowd);
    return result;
}

static void a_flock_goes_along_where_a_crowd_parts(void **state)
{
    (void)state;
    const float apart = alike(NOH_CROWD_FORCES), together = alike(NOH_CROWD_FLOCK);
    print_message("two ways at right angles: a flock's are %.3f alike, a crowd's %.3f\n", (double)together,
                  (double)apart);
    assert_true(apart < 0.75f && together > 0.8f);
}

static void flocks_have_the_same_bits_in_any_order(void **state)
{
    static const uint32_t flags[2] = { NOH_CROWD_FORCES, NOH_CROWD_FLOCK };
    (void)state;
    for (int k = 0; k < 2; k++) {
        noh_crowd *a = flock(flags[k], 0), *b = flock(flags[k], 31);
        for (int i = 0; i < 300; i++) {
            noh_crowd_step(a, NOH_CROWD_STEP_TICKS);
            noh_crowd_step(b, NOH_CROWD_STEP_TICKS);
        }
        assert_int_equal(noh_crowd_hash(a), noh_crowd_hash(b));
        free(a);
        free(b);
    }
}

int main(int argument_count, char **arguments)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(repulsion_is_strongest_at_contact),
        cmocka_unit_test(heights_are_no_distance),
        cmocka_unit_test(coincident_agents_part),
        cmocka_unit_test(the_order_of_agents_changes_nothing),
        cmocka_unit_test(sums_of_pushes_keep_their_size),
        cmocka_unit_test(no_push_stays_finite),
        cmocka_unit_test(agents_stop_at_their_goals),
        cmocka_unit_test(turns_do_not_depend_on_the_step),
        cmocka_unit_test(obstacles_push_hardest_when_near),
        cmocka_unit_test(obstacles_push_away),
        cmocka_unit_test(a_flock_turns_one_way),
        cmocka_unit_test(a_flock_goes_along_where_a_crowd_parts),
        cmocka_unit_test(flocks_have_the_same_bits_in_any_order),
    };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
