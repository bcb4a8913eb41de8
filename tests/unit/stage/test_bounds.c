/* Tests of runtime/stage/character/bounds.c: every vertex that a skeleton moves is inside its bounds. */
#include "support/support.h"

#include "support/clip_set_fixture.h"
#include "core/base/math_internal.h"
#include "stage/character/bounds_internal.h"

/* Random poses, random points within each joint's radius in the bind pose, skinned by random weights: all are inside.
 * Where only a prefix of the joints is posed, the vertices of the others move with their nearest posed ancestor. */
static void bounds_hold_every_skinned_vertex(void **state)
{
    test_random r = test_random_from(14);
    scene s;
    float bind[JOINTS * 12], matrices[JOINTS * 12], radius[JOINTS];
    (void)state;
    scene_open(&s);
    noh_local_to_model(&s.skeleton, s.bind, JOINTS, bind);
    for (int round = 0; round < 200; round++) {
        uint32_t count = round % 2 ? JOINTS : 1u + test_random_below(&r, JOINTS);
        noh_transform pose[JOINTS];
        noh_bounds b;
        memcpy(pose, s.bind, sizeof pose);
        for (uint32_t j = 0; j < JOINTS; j++) {
            float v[3] = { test_random_float(&r, -2, 2), test_random_float(&r, -2, 2), test_random_float(&r, -2, 2) };
            if (j < count) noh_quat_from_rotation(v, pose[j].rotation);
            radius[j] = test_random_below(&r, 5) ? test_random_float(&r, 0.0f, 0.2f) : -1.0f;
        }
        noh_local_to_model(&s.skeleton, pose, JOINTS, matrices);
        noh_joint_bounds(&s.skeleton, matrices, radius, count, &b);
        for (int v = 0; v < 200; v++) {
            uint32_t j = test_random_below(&r, JOINTS), at = j;
            float direction[3] = { test_random_float(&r, -1, 1), test_random_float(&r, -1, 1),
                                   test_random_float(&r, -1, 1) };
            float p[3], out[3], far2 = 0.0f;
            noh_normalize3(direction, (const float[3]){ 1, 0, 0 });
            if (radius[j] < 0.0f) continue;
            while (at >= count) at = s.parents[at];
            for (int i = 0; i < 3; i++)
                p[i] = bind[12 * j + 4u * (uint32_t)i + 3] + direction[i] * radius[j]; /* in the bind pose */
            for (int i = 0; i < 3; i++) p[i] -= bind[12 * at + 4u * (uint32_t)i + 3]; /* to the joint that carries it */
            for (uint32_t i = 0; i < 3; i++) {
                const float *m = matrices + 12 * at + 4 * i;
                out[i] = m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3];
                far2 += (out[i] - b.centre[i]) * (out[i] - b.centre[i]);
                assert_true(out[i] >= b.low[i] - 1e-6f && out[i] <= b.high[i] + 1e-6f);
            }
            assert_true(sqrtf(far2) <= b.radius * 1.000001f);
            for (uint32_t i = 0; i < 3; i++) out[i] -= matrices[4 * i + 3];
            assert_true(sqrtf(noh_dot3(out, out)) <= noh_skeleton_radius(&s.skeleton, radius));
        }
    }
}

static void bounds_of_nothing(void **state)
{
    scene s;
    float matrices[JOINTS * 12], radius[JOINTS];
    noh_bounds b;
    (void)state;
    scene_open(&s);
    noh_local_to_model(&s.skeleton, s.bind, JOINTS, matrices);
    for (uint32_t j = 0; j < JOINTS; j++) radius[j] = -1.0f;
    noh_joint_bounds(&s.skeleton, matrices, radius, JOINTS, &b);
    assert_true(b.low[0] > b.high[0] && b.radius == 0.0f);
    assert_true(noh_skeleton_radius(&s.skeleton, radius) == 0.0f);
    radius[0] = 0.5f;
    noh_joint_bounds(&s.skeleton, matrices, radius, JOINTS, &b);
    assert_true(fabsf(b.radius - 0.5f) < 1e-5f && fabsf(b.high[1] - 0.5f) < 1e-5f);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounds_hold_every_skinned_vertex),
        cmocka_unit_test(bounds_of_nothing),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
