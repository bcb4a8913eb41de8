/* A looser bound is never larger, nor is more effort: bytes of made-up and real clips over bounds, from tight to loose.
 * With NOH_LONG set all real clips, all of them over all bounds. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>

#include "support/clip_fixture.h"
#include "support/support.h"
#include "convert/clips/rcl.h"

/* From tight to loose: what keeps to one bound keeps to the next. (At ten thirds of the distance a turn moves points
 * ten thirds as far.) */
typedef struct bound {
    double error_cm, shell_cm;
} bound;
static const bound quick_bounds[] = { { 0.01, 3.0 }, { 0.1, 10.0 }, { 1.0, 10.0 } };
static const bound long_bounds[] = { { 0.001, 3.0 }, { 0.003, 3.0 }, { 0.01, 3.0 }, { 0.02, 3.0 }, { 0.1, 10.0 },
                                     { 0.2, 10.0 },  { 0.4, 10.0 },  { 1.0, 10.0 }, { 3.0, 10.0 }, { 10.0, 10.0 } };

static size_t bytes_at(const raw_set *set, const bound *b, uint32_t effort)
{
    model_error error;
    byte_buffer out;
    clip_options o;
    size_t bytes;
    memset(&o, 0, sizeof o);
    memset(&out, 0, sizeof out);
    o.error_cm = b->error_cm;
    o.shell_cm = b->shell_cm;
    o.effort = effort;
    if (clip_encode(&set->skeleton, &set->clips[0], &o, &out, NULL, &error)) fail_msg("%s", error.what);
    bytes = out.count;
    buffer_free(&out);
    return bytes;
}

/* Takes the set. bytes_max: of any bound. */
static void looser_is_never_larger(raw_set *set, const char *name, int at_all_bounds, size_t bytes_max)
{
    const bound *bounds = at_all_bounds ? long_bounds : quick_bounds;
    const size_t count = at_all_bounds ? TEST_COUNT(long_bounds) : TEST_COUNT(quick_bounds);
    size_t before = SIZE_MAX;
    for (size_t i = 0; i < count; i++) {
        const size_t bytes = bytes_at(set, &bounds[i], 0);
        if (bytes > before)
            fail_msg("%s: %u bytes at %g cm, %g cm from each joint, %u at the tighter bound before", name,
                     (unsigned)bytes, bounds[i].error_cm, bounds[i].shell_cm, (unsigned)before);
        if (bytes > bytes_max) fail_msg("%s: %u bytes", name, (unsigned)bytes);
        before = bytes;
    }
    raw_set_free(set);
}

/* Takes the set. More effort is never larger, and by itself it is 2. */
static void effort_is_never_larger(raw_set *set, const char *name)
{
    size_t bytes[4];
    for (uint32_t effort = 0; effort < 4u; effort++) bytes[effort] = bytes_at(set, &quick_bounds[0], effort);
    print_message("%s: %u, %u, %u bytes\n", name, (unsigned)bytes[1], (unsigned)bytes[2], (unsigned)bytes[3]);
    assert_true(bytes[2] <= bytes[1] && bytes[3] <= bytes[2]);
    assert_true(bytes[3] < bytes[1]);
    assert_int_equal(bytes[0], bytes[2]);
    raw_set_free(set);
}

static void efforts(void **state)
{
    raw_set *fast = fixture_swing(8, 90, 2, 15.0f, 0.5, 0.3);
    (void)state;
    test_skip_emulated("the encoder");
    fast->clips[0].sample_rate_hz = 120.0; /* where longer segments are tried */
    effort_is_never_larger(fast, "at 120 Hz");
    effort_is_never_larger(fixture_swing(12, 40, 1, 12.0f, 0.8, 0.3), "at 30 Hz");
}

/* Still, except for a strike of `length` frames in the middle. */
static raw_set *strikes(uint32_t frames, uint32_t length)
{
    raw_set *set = fixture_swing(12, frames, 1, 40.0f, 3.0, 0.0);
    const uint32_t first = (frames - length) / 2u, last = first + length;
    for (uint32_t f = 0; f < frames; f++) {
        const uint32_t from = f < first ? first : f > last ? last : f;
        for (uint32_t j = 0; j < 12u; j++)
            memcpy(fixture_rotation(&set->clips[0], f, j), fixture_rotation(&set->clips[0], from, j),
                   4u * sizeof(float));
    }
    return set;
}

/* Effort 2 finds that what is still is cheap in a segment of its own; at high rates short segments are not tried. */
static void short_segments_where_motion_is_sudden(void **state)
{
    raw_set *set = strikes(48, 5);
    model_error error;
    clip_report plain, usual;
    clip_options o;
    byte_buffer out;
    (void)state;
    test_skip_emulated("the encoder");
    memset(&o, 0, sizeof o);
    memset(&out, 0, sizeof out);
    o.effort = 1;
    assert_int_equal(clip_encode(&set->skeleton, &set->clips[0], &o, &out, &plain, &error), 0);
    o.effort = 2;
    assert_int_equal(clip_encode(&set->skeleton, &set->clips[0], &o, &out, &usual, &error), 0);
    print_message("%u segments, %u bytes; %u segments, %u bytes\n", plain.segment_count, (unsigned)plain.bytes,
                  usual.segment_count, (unsigned)usual.bytes);
    assert_int_equal(plain.segment_count, 2);
    assert_true(usual.segment_count > 2u && usual.bytes * 10u < plain.bytes * 9u);
    set->clips[0].sample_rate_hz = 120.0;
    assert_int_equal(clip_encode(&set->skeleton, &set->clips[0], &o, &out, &usual, &error), 0);
    assert_int_equal(usual.segment_count, 2);
    buffer_free(&out);
    raw_set_free(set);
}

/* What comes into being: its root grows from (almost) nothing in some frames, or shrinks to it. */
static raw_set *grows(float least, uint32_t branch, int at, int shrinks)
{
    raw_set *set = fixture_swing(20, 60, branch, 15.0f, 0.5, 0.3);
    for (uint32_t f = 0; f < 60u; f++) {
        const uint32_t step = shrinks ? 59u - f : f;
        float *s = fixture_scale(&set->clips[0], f, (uint32_t)at);
        s[0] = s[1] = s[2] = step >= 12u ? 1.0f : least + (1.0f - least) * (float)step / 12.0f;
        for (uint32_t j = 1; j < 20u; j++)
            fixture_translation(&set->clips[0], f, j)[0] += 0.3f * (float)sin(0.3 * (double)f + (double)j);
    }
    return set;
}

/* Where a parent's scale is near zero, the correction for its error is without bound; the correction for a few frames
 * used to store all tracks raw, 13 KB of them. */
static void clips_that_grow_from_nothing(void **state)
{
    const int at_all_bounds = getenv("NOH_LONG") != NULL || !test_is_sanitized();
    (void)state;
    test_skip_emulated("the encoder");
    looser_is_never_larger(grows(0.001f, 2, 0, 0), "from a thousandth", at_all_bounds, 8000);
    looser_is_never_larger(grows(0.0f, 2, 0, 0), "from nothing", at_all_bounds, 8000);
    looser_is_never_larger(grows(1e-5f, 2, 3, 1), "to a hundred-thousandth", at_all_bounds, 8000);
}

static const char *const real_clips[] = { "Knight__Walking_A", "Fox__Walk", "RobotExpressive__Wave",
                                          /* from here on when long only */
                                          "CesiumMan", "Fox__Run", "Fox__Survey", "Knight__1H_Melee_Attack_Chop",
                                          "Knight__2H_Melee_Attack_Spin", "Knight__Cheer", "Knight__Death_B",
                                          "Knight__Jump_Full_Long", "Knight__Lie_StandUp", "Knight__Running_A",
                                          "Knight__Spellcast_Long", "Knight__Unarmed_Melee_Attack_Kick", "Knight__Idle",
                                          "Knight__Walking_Backwards", "RobotExpressive__Dance",
                                          "RobotExpressive__Walking", "ad_zombie", "cmu_01_01", "cmu_01_03",
                                          "cmu_indian_04", "cmu_martial_03", "cmu_salsa_01" };
#define REAL_CLIPS_QUICK 3u

static void known_clips(void **state)
{
    const int is_long = getenv("NOH_LONG") != NULL;
    const size_t count = is_long ? TEST_COUNT(real_clips) : REAL_CLIPS_QUICK;
    const char *base = getenv("NOH_ASSETS");
    (void)state;
    test_skip_emulated("the encoder");
    for (size_t i = 0; i < count; i++) {
        char path[512];
        raw_set *set = NULL;
        model_error error;
        snprintf(path, sizeof path, "%s/clips/%s.rcl", base && *base ? base : "../shared/assets", real_clips[i]);
        if (rcl_read(path, &set, &error)) {
            print_message("SKIP: %s is not there (set NOH_ASSETS to the assets' folder)\n", path);
            skip();
        }
        if (set->clips[0].sample_rate_hz > 60.0) fixture_decimate(&set->clips[0], 4);
        looser_is_never_larger(set, real_clips[i], is_long || i == 0u, SIZE_MAX);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clips_that_grow_from_nothing),
        cmocka_unit_test(known_clips),
        cmocka_unit_test(efforts),
        cmocka_unit_test(short_segments_where_motion_is_sudden),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
