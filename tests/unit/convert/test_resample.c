/* test_resample.c: raw clips at other rates, and whether they loop. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/clips/loop_check.h"
#include "convert/model/model_build.h"
#include "convert/clips/rcl.h"
#include "convert/clips/raw_set.h"
#include "convert/clips/resample.h"

/* A root that travels along x by 2 a frame and turns about z by 10 degrees a frame; a child 10
 * away on its y axis; a float group. */
static raw_set *moving(uint32_t frames, double sample_rate_hz)
{
    raw_set *set = raw_set_new(2, 1);
    assert_non_null(set);
    raw_clip *clip = &set->clips[0];
    set->skeleton.joints[0].name = model_string("root");
    set->skeleton.joints[1].name = model_string("child");
    set->skeleton.joints[1].parent = 0;
    set->skeleton.joints[1].translation[1] = 10.0f;
    assert_int_equal(raw_clip_alloc(clip, frames, 2), 0);
    clip->name = model_string("moving");
    clip->sample_rate_hz = sample_rate_hz;
    clip->floats = test_zeros(sizeof *clip->floats);
    clip->float_count = 1;
    assert_int_equal(raw_floats_alloc(&clip->floats[0], frames, 2), 0);
    clip->floats[0].name = model_string("face");
    clip->floats[0].radius = test_zeros(2 * sizeof(float));
    clip->floats[0].radius[0] = 0.5f;
    for (uint32_t f = 0; f < frames; ++f) {
        const double half = (double)f * 5.0 * 3.14159265358979323846 / 180.0;
        float *q = clip->rotations + (size_t)f * 8, *t = clip->translations + (size_t)f * 6,
              *s = clip->scales + (size_t)f * 6;
        const float sign = f % 2 ? -1.0f : 1.0f; /* readers leave no such signs; here they are to be mended */
        q[2] = sign * (float)sin(half);
        q[3] = sign * (float)cos(half);
        q[7] = 1.0f;
        t[0] = 2.0f * (float)f;
        t[4] = 10.0f;
        for (int i = 0; i < 6; ++i) s[i] = 1.0f;
        clip->floats[0].values[f * 2] = (float)f;
        clip->floats[0].values[f * 2 + 1] = -(float)f;
    }
    return set;
}

static raw_clip resampled(const raw_clip *clip, double sample_rate_hz)
{
    raw_clip out;
    model_error error = { "", "" };
    if (raw_clip_resample(clip, sample_rate_hz, &out, &error)) fail_msg("refused: %s", error.what);
    return out;
}

static void twice_the_rate_keeps_every_frame(void **state)
{
    (void)state;
    raw_set *set = moving(13, 30.0);
    raw_clip out = resampled(&set->clips[0], 60.0);
    assert_int_equal(out.frame_count, 25);
    assert_true(out.sample_rate_hz == 60.0);
    assert_string_equal(out.name, "moving");
    for (size_t f = 0; f < 13; ++f) {
        const float *a = set->clips[0].rotations + f * 8, *b = out.rotations + f * 16;
        assert_true(fabsf(a[2]) == fabsf(b[2]) && fabsf(a[3]) == fabsf(b[3]));
        assert_memory_equal(set->clips[0].translations + f * 6, out.translations + f * 12, 24);
        assert_memory_equal(set->clips[0].floats[0].values + f * 2, out.floats[0].values + f * 4, 8);
    }
    for (size_t f = 1; f < 25; ++f) { /* the signs are mended, the middles in the middle */
        const float *a = out.rotations + f * 8 - 8, *b = out.rotations + f * 8;
        assert_true(fabsf(a[2] * b[2] + a[3] * b[3] - cosf(2.5f * 0.0174532925f)) < 1e-6f);
        assert_true(fabsf(out.translations[f * 6] - (float)f) < 1e-6f);
    }
    assert_true(out.floats[0].radius[0] == 0.5f);
    raw_clip_clear(&out);
    raw_set_free(set);
}

static void other_rates_keep_the_length(void **state)
{
    (void)state;
    raw_set *set = moving(22, 30.0); /* 0.7 s */
    static const double rates[] = { 1.0, 7.0, 24.0, 29.97, 31.0, 60.0, 120.0, 1000.0 };
    for (size_t i = 0; i < TEST_COUNT(rates); ++i) {
        raw_clip out = resampled(&set->clips[0], rates[i]);
        assert_int_equal(out.frame_count, (uint32_t)fmax(floor(0.7 * rates[i] + 0.5), 1.0) + 1);
        assert_true(fabs(raw_clip_duration_s(&out) - 0.7) < 1e-12);
        assert_memory_equal(out.translations, set->clips[0].translations, 24);
        assert_memory_equal(out.translations + (size_t)(out.frame_count - 1) * 6, set->clips[0].translations + 21 * 6,
                            24);
        raw_clip_clear(&out);
    }
    raw_set_free(set);
}

static void keys_are_copied(void **state)
{
    (void)state;
    raw_set *set = moving(11, 10.0);
    raw_event event = { (char *)(void *)"step", 0.95, { 7 }, 0.5f, 0 };
    assert_int_equal(raw_clip_add_event(&set->clips[0], &event), 0);
    set->clips[0].loop = 1;
    raw_clip out = resampled(&set->clips[0], 5.0), cut;
    model_error error;
    assert_int_equal(out.event_count, 1);
    assert_true(out.events[0].time_s == 0.95 && out.events[0].payload[0] == 7 && out.loop);
    assert_int_equal(raw_clip_decimate(&set->clips[0], 4, &cut, &error), 0); /* frames 0, 4, 8: 0.8 s */
    assert_int_equal(cut.frame_count, 3);
    assert_true(cut.sample_rate_hz == 2.5 && cut.events[0].time_s == raw_clip_duration_s(&cut));
    assert_memory_equal(cut.translations + 12, set->clips[0].translations + 8 * 6, 24);
    raw_clip_clear(&out);
    raw_clip_clear(&cut);
    raw_set_free(set);
}

static void one_frame_stays_one(void **state)
{
    (void)state;
    raw_set *set = moving(1, 30.0);
    raw_clip out = resampled(&set->clips[0], 60.0);
    assert_int_equal(out.frame_count, 1);
    raw_clip_clear(&out);
    raw_set_free(set);
}

static void impossible_rates_are_refused(void **state)
{
    (void)state;
    raw_set *set = moving(31, 30.0);
    raw_clip out;
    model_error error = { "", "" };
    assert_int_equal(raw_clip_resample(&set->clips[0], 0.0, &out, &error), 1);
    assert_int_equal(raw_clip_resample(&set->clips[0], -1.0, &out, &error), 1);
    assert_int_equal(raw_clip_resample(&set->clips[0], (double)NAN, &out, &error), 1);
    assert_int_equal(raw_clip_resample(&set->clips[0], 1e9, &out, &error), 1);
    set->clips[0].sample_rate_hz = 1e-3;
    assert_int_equal(raw_clip_resample(&set->clips[0], 1e6, &out, &error), 1);
    assert_non_null(strstr(error.what, "more frames than the limit"));
    assert_int_equal(raw_clip_decimate(&set->clips[0], 0, &out, &error), 1);
    raw_set_free(set);
}

/* --- loops --- */

static raw_loop_check check(const raw_set *set)
{
    raw_loop_check out;
    assert_int_equal(raw_clip_check_loop(&set->skeleton, &set->clips[0], 3.0, &out), 0);
    return out;
}

static void a_full_turn_closes(void **state)
{
    (void)state;
    raw_set *set = moving(37, 30.0); /* 360 degrees, and 72 along x */
    raw_loop_check c = check(set);
    assert_true(fabs(c.difference_cm - 72.0) < 1e-4);
    assert_true(c.in_place_cm < 1e-4);
    assert_true(c.float_cm == 18.0 && c.float_units == 0.0);
    for (size_t f = 0; f < 37; ++f) set->clips[0].translations[f * 6] = 0.0f;
    c = check(set);
    assert_true(c.difference_cm < 1e-4);
    raw_set_free(set);
}

static void half_a_turn_does_not(void **state)
{
    (void)state;
    raw_set *set = moving(19, 30.0);
    for (size_t f = 0; f < 19; ++f) set->clips[0].translations[f * 6] = 0.0f;
    raw_loop_check c = check(set);
    assert_int_equal(c.joint, 1);
    assert_true(fabs(c.difference_cm - 26.0) < 1e-4); /* the child's point 13 from the root */
    set->skeleton.unit_cm = 100.0;
    c = check(set);
    assert_true(fabs(c.difference_cm - 2006.0) < 1e-2); /* the shell is in centimetres */
    raw_set_free(set);
}

static void growing_shows_at_the_shell(void **state)
{
    (void)state;
    raw_set *set = moving(2, 30.0);
    float *s = set->clips[0].scales + 9;
    memset(set->clips[0].translations + 6, 0, 12);
    memcpy(set->clips[0].rotations + 8, set->clips[0].rotations, 16);
    s[0] = 1.5f;
    raw_loop_check c = check(set);
    assert_int_equal(c.joint, 1);
    assert_true(fabs(c.difference_cm - 1.5) < 1e-6);
    raw_set_free(set);
}

static void real_loops(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        int closes;
    } clips[] = { { "clips/Knight__Walking_A.rcl", 1 },
                  { "clips/Fox__Survey.rcl", 1 },
                  { "clips/Knight__Death_B.rcl", 0 },
                  { "clips/cmu_01_01.rcl", 0 } };
    for (size_t i = 0; i < TEST_COUNT(clips); ++i) {
        raw_set *set = NULL;
        model_error error = { "", "" };
        assert_int_equal(rcl_read(test_asset(clips[i].name), &set, &error), 0);
        raw_loop_check c = check(set);
        print_message("%s: %.4f cm at joint %u, in place %.4f cm\n", clips[i].name, c.difference_cm, c.joint,
                      c.in_place_cm);
        assert_int_equal(c.difference_cm < 0.01, clips[i].closes);
        raw_set_free(set);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(twice_the_rate_keeps_every_frame),
    cmocka_unit_test(other_rates_keep_the_length),
    cmocka_unit_test(keys_are_copied),
    cmocka_unit_test(one_frame_stays_one),
    cmocka_unit_test(impossible_rates_are_refused),
    cmocka_unit_test(a_full_turn_closes),
    cmocka_unit_test(half_a_turn_does_not),
    cmocka_unit_test(growing_shows_at_the_shell),
    cmocka_unit_test(real_loops),
};

TEST_MAIN(tests, NULL, NULL)
