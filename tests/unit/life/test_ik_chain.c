/* Tests of ik_chain.c: each solver on the same thousand targets, limits, lines, and what is refused. */
#include "life/reach/ik_chain_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_core.h"

#include <math.h>
#include <string.h>

#include "support/support.h"

#define JOINTS 6u
#define BONE 0.1f
#define DEGREE (3.14159265358979f / 180.0f)

static const float root[3] = { 0.0f, 0.0f, 0.0f };
static float bones[3 * JOINTS], start[4 * JOINTS];

/* Bones that hang down and bend a little, as a tail does. */
static noh_ik_chain tail(float bend)
{
    const float by[3] = { -bend, 0.0f, bend };
    for (uint32_t j = 0; j < JOINTS; j++) {
        bones[3 * j] = bones[3 * j + 2] = 0.0f;
        bones[3 * j + 1] = -BONE;
        noh_quat_from_rotation(by, start + 4 * j);
    }
    return (noh_ik_chain){ JOINTS, root, NULL, bones, NULL, NULL };
}

static void end_of(const noh_ik_chain *c, const float *rotations, float end[3])
{
    float q[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
    if (c->root_rotation) memcpy(q, c->root_rotation, sizeof q);
    memcpy(end, c->root, 3 * sizeof *end);
    for (uint32_t j = 0; j < c->count; j++) {
        float bone[3];
        noh_quat_mul(q, rotations + 4 * j, q);
        noh_quat_rotate(q, c->bones + 3 * j, bone);
        for (int i = 0; i < 3; i++) end[i] += bone[i];
    }
}

static float apart(const float a[3], const float b[3])
{
    const float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return sqrtf(x * x + y * y + z * z);
}

static void random_target(test_random *random, float least, float most, float target[3])
{
    float length = 0.0f, size = test_random_float(random, least, most);
    while (length < 0.1f || length > 1.0f) {
        for (int i = 0; i < 3; i++) target[i] = test_random_float(random, -1.0f, 1.0f);
        length = apart(target, root);
    }
    for (int i = 0; i < 3; i++) target[i] *= size / length;
}

/* How many of a thousand are not reached to a millimetre in 60 iterations; what it prints is for the README. */
static uint32_t solve_a_thousand(noh_ik_solver solver, const char *name)
{
    test_random random = test_random_from(1);
    const noh_ik_chain chain = tail(0.15f);
    uint32_t failed = 0, iterations = 0;
    float turned = 0.0f;
    for (int n = 0; n < 1000; n++) {
        float target[3], rotations[4 * JOINTS], end[3];
        noh_ik_chain_result result;
        memcpy(rotations, start, sizeof rotations);
        random_target(&random, 0.1f, 0.55f, target);
        assert_int_equal(noh_ik_chain_solve(&chain, solver, target, 0.001f, 60, rotations, &result, NULL), NOH_OK);
        end_of(&chain, rotations, end);
        assert_true(fabsf(apart(end, target) - result.missed) < 1e-5f);
        failed += result.missed > 0.001f;
        iterations += result.iterations;
        for (uint32_t j = 0; j < JOINTS; j++) {
            const float dot = noh_quat_dot(rotations + 4 * j, start + 4 * j);
            turned += 2.0f * acosf(fminf(fabsf(dot), 1.0f)) / DEGREE / (1000.0f * JOINTS);
        }
    }
    print_message("# %s: %.1f iterations, %u of 1000 not reached, each joint turned by %.0f degrees\n", name,
                  (double)iterations / 1000.0, failed, (double)turned);
    return failed;
}

static void each_solver_reaches(void **state)
{
    (void)state;
    assert_true(solve_a_thousand(NOH_IK_CCD, "CCD") <= 50); /* it curls up where the target is near the root */
    assert_int_equal(solve_a_thousand(NOH_IK_FABRIK, "FABRIK"), 0);
    assert_int_equal(solve_a_thousand(NOH_IK_DLS, "DLS"), 0);
}

static void what_is_out_of_reach_is_pointed_at(void **state)
{
    const float target[3] = { 0.6f, 0.8f, 0.0f };
    (void)state;
    for (int s = NOH_IK_CCD; s <= NOH_IK_DLS; s++) {
        const noh_ik_chain chain = tail(0.15f);
        float rotations[4 * JOINTS];
        noh_ik_chain_result result;
        memcpy(rotations, start, sizeof rotations);
        assert_int_equal(noh_ik_chain_solve(&chain, (noh_ik_solver)s, target, 0.001f, 200, rotations, &result, NULL),
                         NOH_OK);
        assert_true(result.missed >= 0.4f - 1e-4f && result.missed < 0.41f);
    }
}

static float missed_after(const noh_ik_chain *chain, noh_ik_solver solver, const float target[3], uint32_t iterations)
{
    float rotations[4 * JOINTS];
    noh_ik_chain_result result;
    memcpy(rotations, start, sizeof rotations);
    assert_int_equal(noh_ik_chain_solve(chain, solver, target, 0.001f, iterations, rotations, &result, NULL), NOH_OK);
    return result.missed;
}

/* A straight chain and a target on its line: nothing says to which side to bend. The iteration after the first that
 * brings it no nearer finds it bent. */
static void a_straight_chain_bends(void **state)
{
    const float target[3] = { 0.0f, -0.3f, 0.0f };
    (void)state;
    for (int s = NOH_IK_CCD; s <= NOH_IK_DLS; s++) {
        const noh_ik_chain chain = tail(0.0f);
        float before = 0.3f, missed = missed_after(&chain, (noh_ik_solver)s, target, 1);
        uint32_t count = 1;
        for (; missed < 0.999f * before; missed = missed_after(&chain, (noh_ik_solver)s, target, ++count)) {
            before = missed;
        }
        assert_true(missed_after(&chain, (noh_ik_solver)s, target, count + 1u) < 0.5f * missed);
        assert_true(missed_after(&chain, (noh_ik_solver)s, target, 100) <= 0.001f);
    }
}

/* Swing and twist of a joint, by other ways than the library's: where its bone points, and what is left of the turn. */
static void measure(const float q[4], const float bone[3], float *swing, float *twist)
{
    float to[3], axis[3], back[4], rest[4], length = apart(bone, root), sine = 0.0f, cosine = 0.0f;
    noh_quat_rotate(q, bone, to);
    axis[0] = bone[1] * to[2] - bone[2] * to[1];
    axis[1] = bone[2] * to[0] - bone[0] * to[2];
    axis[2] = bone[0] * to[1] - bone[1] * to[0];
    for (int i = 0; i < 3; i++) {
        sine += axis[i] * axis[i];
        cosine += bone[i] * to[i];
    }
    *swing = atan2f(sqrtf(sine), cosine);
    for (int i = 0; i < 3; i++) axis[i] *= sine > 0.0f ? *swing / sqrtf(sine) : 0.0f;
    noh_quat_from_rotation(axis, back);
    noh_quat_conjugate(back, back);
    noh_quat_mul(back, q, rest);
    noh_quat_to_rotation(rest, axis);
    *twist = (axis[0] * bone[0] + axis[1] * bone[1] + axis[2] * bone[2]) / length;
}

static void limits_hold(void **state)
{
    test_random random = test_random_from(2);
    noh_ik_limit limits[JOINTS];
    uint32_t reached = 0;
    (void)state;
    for (uint32_t j = 0; j < JOINTS; j++) {
        limits[j] = (noh_ik_limit){ NOH_IK_LIMIT_SWING | NOH_IK_LIMIT_TWIST, 40.0f * DEGREE, -10.0f * DEGREE,
                                    20.0f * DEGREE };
    }
    for (int n = 0; n < 3000; n++) {
        noh_ik_chain chain = tail(0.15f);
        float target[3], rotations[4 * JOINTS];
        noh_ik_chain_result result;
        chain.limits = limits;
        memcpy(rotations, start, sizeof rotations);
        random_target(&random, 0.2f, 0.55f, target);
        target[1] = -fabsf(target[1]);
        assert_int_equal(
            noh_ik_chain_solve(&chain, (noh_ik_solver)(n % 3), target, 0.001f, 60, rotations, &result, NULL), NOH_OK);
        reached += result.missed <= 0.001f;
        for (uint32_t j = 0; j < JOINTS; j++) {
            float swing, twist;
            measure(rotations + 4 * j, bones + 3 * j, &swing, &twist);
            assert_true(swing <= 40.05f * DEGREE && twist >= -10.05f * DEGREE && twist <= 20.05f * DEGREE);
        }
    }
    print_message("# within limits %u of 3000 are reached\n", reached);
    assert_true(reached > 1500);
}

/* A joint that may not turn at all stays in its bind rotation. */
static void a_limit_of_nothing_is_the_bind_rotation(void **state)
{
    const noh_ik_limit limit = { NOH_IK_LIMIT_SWING | NOH_IK_LIMIT_TWIST, 0.0f, 0.0f, 0.0f };
    const float bone[3] = { 0.1f, 0.2f, -0.1f };
    test_random random = test_random_from(3);
    (void)state;
    for (int n = 0; n < 1000; n++) {
        float bind[4], q[4], by[3];
        for (int i = 0; i < 3; i++) by[i] = test_random_float(&random, -2.0f, 2.0f);
        noh_quat_from_rotation(by, bind);
        for (int i = 0; i < 3; i++) by[i] = test_random_float(&random, -2.0f, 2.0f);
        noh_quat_from_rotation(by, q);
        noh_ik_limit_apply(&limit, bone, bind, q);
        assert_true(fabsf(noh_quat_dot(q, bind)) > 0.99999f);
    }
}

/* Bones without length, all joints in one place, targets on the root: finite. */
static void nothing_makes_it_a_nan(void **state)
{
    test_random random = test_random_from(4);
    (void)state;
    for (int n = 0; n < 30000; n++) {
        noh_ik_chain chain = tail(0.15f);
        float target[3] = { 0.0f, 0.0f, 0.0f }, rotations[4 * JOINTS];
        noh_ik_chain_result result;
        for (uint32_t j = 0; j < 3 * JOINTS; j++) {
            const uint32_t kind = test_random_below(&random, 4);
            bones[j] = kind == 0 ? 0.0f : kind == 1 ? 1e-12f : test_random_float(&random, -1.0f, 1.0f);
        }
        if (n % 5) random_target(&random, 0.0f, n % 7 ? 1.0f : 1e6f, target);
        memcpy(rotations, start, sizeof rotations);
        assert_int_equal(noh_ik_chain_solve(&chain, (noh_ik_solver)(n % 3), target, 1e-4f, 8, rotations, &result, NULL),
                         NOH_OK);
        assert_true(result.missed >= 0.0f);
        for (uint32_t j = 0; j < JOINTS; j++) {
            assert_true(fabsf(noh_quat_dot(rotations + 4 * j, rotations + 4 * j) - 1.0f) < 1e-4f);
        }
    }
}

static void bad_values_are_refused(void **state)
{
    noh_ik_chain chain = tail(0.1f);
    const float target[3] = { 0.0f, 0.0f, 0.0f }, nowhere[3] = { NAN, 0.0f, 0.0f };
    float rotations[4 * JOINTS], before[4 * JOINTS];
    noh_ik_chain_result result;
    noh_error error;
    (void)state;
    memcpy(rotations, start, sizeof rotations);
    memcpy(before, start, sizeof before);
    assert_int_equal(noh_ik_chain_solve(&chain, NOH_IK_CCD, nowhere, 1e-3f, 9, rotations, &result, &error),
                     NOH_ERR_ARG);
    assert_non_null(strstr(error.what, "finite"));
    chain.count = NOH_IK_JOINTS_MAX + 1u;
    assert_int_equal(noh_ik_chain_solve(&chain, NOH_IK_CCD, target, 1e-3f, 9, rotations, &result, &error), NOH_ERR_ARG);
    chain.count = 0;
    assert_int_equal(noh_ik_chain_solve(&chain, NOH_IK_CCD, target, 1e-3f, 9, rotations, &result, &error), NOH_ERR_ARG);
    assert_memory_equal(rotations, before, sizeof before);
}

int main(int argument_count, char **arguments)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_solver_reaches),
        cmocka_unit_test(what_is_out_of_reach_is_pointed_at),
        cmocka_unit_test(a_straight_chain_bends),
        cmocka_unit_test(limits_hold),
        cmocka_unit_test(a_limit_of_nothing_is_the_bind_rotation),
        cmocka_unit_test(nothing_makes_it_a_nan),
        cmocka_unit_test(bad_values_are_refused),
    };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
