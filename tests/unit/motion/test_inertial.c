/* Tests of inertial.c: the quintic in closed form, and offsets with their speeds. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "support/clip_set_fixture.h"
#include "motion/pose/inertial_internal.h"

#define DURATION 0.4f
#define BEFORE 0.01f

/* Without speed the quintic of Bollo's talk is 1 - 10 s^3 + 15 s^4 - 6 s^5; at speeds at which it would overshoot it
 * ends at t1 = -5 x0 / v0 and is (1 - t / t1)^5. */
static void decay_is_the_quintic(void **state)
{
    (void)state;
    for (int i = 0; i <= 100; i++) {
        const double s = (double)i / 100.0, still = 2.0 * (1.0 + s * s * s * (-10.0 + s * (15.0 - 6.0 * s)));
        const double fast = 2.0 * pow(1.0 - s, 5.0), t1 = 5.0 * 2.0 / 50.0;
        assert_true(fabs((double)noh_inertia_decay(2.0f, 0.0f, (float)(s * (double)DURATION), DURATION) - still) <
                    2e-5);
        assert_true(fabs((double)noh_inertia_decay(2.0f, -50.0f, (float)(s * t1), DURATION) - fast) < 2e-5);
    }
}

/* x0, v0, and at the end neither speed nor acceleration: by differences. */
static void decay_keeps_its_speed_at_the_start(void **state)
{
    (void)state;
    for (int v = 0; v <= 24; v += 3) {
        const double v0 = -(double)v, h = 1e-3, d = (double)DURATION, end = v0 < 0.0 && -5.0 / v0 < d ? -5.0 / v0 : d;
        const double first = ((double)noh_inertia_decay(1.0f, (float)v0, (float)h, DURATION) - 1.0) / h;
        const double last = (double)noh_inertia_decay(1.0f, (float)v0, (float)(end - 0.01 * end), DURATION);
        assert_true(fabs(first - v0) < 0.6);
        assert_true(last >= 0.0 && last < 2e-5);
    }
}

static noh_transform posed(float angle, float x, float scale)
{
    const float turn[3] = { 0.0f, 0.0f, angle };
    noh_transform t;
    memset(&t, 0, sizeof t);
    noh_quat_from_rotation(turn, t.rotation);
    t.translation[0] = x;
    t.scale[0] = scale;
    t.scale[1] = t.scale[2] = 1.0f;
    return t;
}

/* Each of the three parts has its own length and speed: here all shrink, each at its own pace. */
static void each_part_has_its_own_offset_and_speed(void **state)
{
    const noh_transform target = posed(0.5f, 1.0f, 1.0f), target_before = posed(0.45f, 0.9f, 1.02f);
    const noh_transform source = posed(0.8f, 3.0f, 1.5f), source_before = posed(0.77f, 2.95f, 1.55f);
    noh_inertia_joint o;
    (void)state;
    noh_inertia_begin(1, &source, &source_before, &target, &target_before, BEFORE, &o);
    assert_true(fabsf(o.rotation[2] - 0.3f) < 1e-6f && fabsf(o.translation[0] - 2.0f) < 1e-6f &&
                fabsf(o.scale[0] - 0.5f) < 1e-6f);
    assert_true(fabsf(o.rotation_speed - (0.3f - 0.32f) / BEFORE) < 1e-3f);
    assert_true(fabsf(o.translation_speed - (2.0f - 2.05f) / BEFORE) < 1e-3f);
    assert_true(fabsf(o.scale_speed - (0.5f - 0.53f) / BEFORE) < 1e-3f);
}

/* An offset that is growing is stopped, not followed: otherwise it would overshoot its start. */
static void growing_offsets_are_stopped(void **state)
{
    const noh_transform target = posed(0.0f, 0.0f, 1.0f), source = posed(0.3f, 2.0f, 1.5f),
                        source_before = posed(0.2f, 1.9f, 1.4f);
    const float offset[2] = { 0.5f, -0.5f }, offset_before[2] = { 0.4f, -0.4f }, none[2] = { 0.0f, 0.0f };
    noh_inertia_joint o;
    noh_inertia_float f[2];
    (void)state;
    noh_inertia_begin(1, &source, &source_before, &target, &target, BEFORE, &o);
    assert_true(o.rotation_speed == 0.0f && o.translation_speed == 0.0f && o.scale_speed == 0.0f);
    noh_inertia_begin_floats(2, offset, offset_before, none, none, BEFORE, f);
    assert_true(f[0].speed == 0.0f && f[1].speed == 0.0f);
}

/* At the switch the pose is the old one; later each part follows its own decay. */
static void the_pose_starts_at_the_source(void **state)
{
    const noh_transform target = posed(0.5f, 1.0f, 1.0f), source = posed(0.8f, 3.0f, 1.5f);
    const noh_transform source_before = posed(0.9f, 3.02f, 1.9f);
    noh_inertia_joint o;
    noh_transform pose = target;
    (void)state;
    noh_inertia_begin(1, &source, &source_before, &target, &target, BEFORE, &o);
    noh_inertia_apply(1, &o, 0.0f, DURATION, &pose);
    assert_true(pose_apart(&pose, &source, 1) < 1e-6);
    for (int i = 1; i < 10; i++) {
        const float t = 0.1f * (float)i * DURATION;
        float turn[3];
        pose = target;
        noh_inertia_apply(1, &o, t, DURATION, &pose);
        noh_quat_to_rotation(pose.rotation, turn);
        assert_true(fabsf(turn[2] - (0.5f + noh_inertia_decay(0.3f, o.rotation_speed, t, DURATION))) < 1e-5f);
        assert_true(fabsf(pose.translation[0] - (1.0f + noh_inertia_decay(2.0f, o.translation_speed, t, DURATION))) <
                    1e-5f);
        assert_true(fabsf(pose.scale[0] - (1.0f + noh_inertia_decay(0.5f, o.scale_speed, t, DURATION))) < 1e-5f);
    }
    pose = target;
    noh_inertia_apply(1, &o, DURATION, DURATION, &pose);
    assert_memory_equal(&pose, &target, sizeof pose);
}

/* The rotation that is added turns the target's pose from outside: source = offset * target. */
static void rotations_are_added_from_outside(void **state)
{
    const float a[3] = { 0.9f, 0.0f, 0.2f }, b[3] = { 0.0f, 1.1f, -0.3f };
    noh_transform target = posed(0.0f, 0.0f, 1.0f), source = target, pose;
    noh_inertia_joint o;
    (void)state;
    noh_quat_from_rotation(a, target.rotation);
    noh_quat_from_rotation(b, source.rotation);
    noh_inertia_begin(1, &source, &source, &target, &target, BEFORE, &o);
    pose = target;
    noh_inertia_apply(1, &o, 0.0f, DURATION, &pose);
    assert_true(pose_apart(&pose, &source, 1) < 1e-6);
}

/* A float below its target decays as one above it does, mirrored. */
static void floats_decay_on_both_sides(void **state)
{
    const float source[2] = { 0.8f, 0.2f }, source_before[2] = { 0.83f, 0.17f }, target[2] = { 0.5f, 0.5f };
    noh_inertia_float f[2];
    (void)state;
    noh_inertia_begin_floats(2, source, source_before, target, target, BEFORE, f);
    assert_true(fabsf(f[0].offset - 0.3f) < 1e-6f && fabsf(f[1].offset + 0.3f) < 1e-6f);
    assert_true(fabsf(f[0].speed + 3.0f) < 1e-3f && fabsf(f[1].speed + 3.0f) < 1e-3f);
    for (int i = 0; i <= 10; i++) {
        const float t = 0.1f * (float)i * DURATION, left = noh_inertia_decay(0.3f, f[0].speed, t, DURATION);
        float floats[2] = { 0.5f, 0.5f };
        noh_inertia_apply_floats(2, f, t, DURATION, floats);
        assert_true(fabsf(floats[0] - 0.5f - left) < 1e-5f && fabsf(floats[1] - 0.5f + left) < 1e-5f);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(decay_is_the_quintic),
        cmocka_unit_test(decay_keeps_its_speed_at_the_start),
        cmocka_unit_test(each_part_has_its_own_offset_and_speed),
        cmocka_unit_test(growing_offsets_are_stopped),
        cmocka_unit_test(the_pose_starts_at_the_source),
        cmocka_unit_test(rotations_are_added_from_outside),
        cmocka_unit_test(floats_decay_on_both_sides),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
