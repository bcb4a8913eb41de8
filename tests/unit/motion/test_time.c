/* Tests of time.c: time at the ends of its range; the rest is in test_controller.c. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "motion/anim/time_internal.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define SLACK 16384.0L /* long double may have 53 bits */

static const int64_t positions[] = { INT64_MIN, INT64_MIN + 1, -((int64_t)1 << 62), -65536,        -1,       0,
                                     1,         65536,         (int64_t)1 << 62,    INT64_MAX - 1, INT64_MAX };
static const uint32_t durations[] = { 0, 1, 2, 3, 48000, 999983, NOH_DURATION_MAX };

/* In the clip for every position, and a whole number of cycles from what it was. */
static void every_position_lies_in_its_clip(void **state)
{
    (void)state;
    for (size_t p = 0; p < COUNT(positions); p++) {
        for (size_t d = 0; d < COUNT(durations); d++) {
            const int64_t duration = noh_position_of(durations[d]);
            for (int loop = NOH_LOOP_ONCE; loop <= NOH_LOOP_PING_PONG; loop++) {
                const int64_t at = noh_time_clip(positions[p], durations[d], (noh_loop)loop);
                assert_true(at >= 0 && at <= duration);
                if (loop != NOH_LOOP_REPEAT || duration == 0) continue;
                assert_true(at < duration);
                assert_true(((uint64_t)positions[p] - (uint64_t)at) % 65536u == 0u);
                assert_int_equal(positions[p] % duration + (positions[p] % duration < 0 ? duration : 0), at);
            }
        }
    }
    assert_int_equal(noh_time_clip(INT64_MIN, 3, NOH_LOOP_REPEAT),
                     65536); /* 2^63 = 2^47 ticks, 2 more than a multiple of 3 */
    assert_int_equal(noh_time_clip(INT64_MIN, 1, NOH_LOOP_PING_PONG), 0); /* an even number of legs back */
    assert_int_equal(noh_time_clip(INT64_MIN + 65536, 1, NOH_LOOP_PING_PONG), 65536);
}

/* What passes the range is held at its end; what fits is exact. */
/* Ping-pong is even about 0: what lies below 0 is played as what lies above it. */
static void ping_pong_is_mirrored_at_zero(void **state)
{
    (void)state;
    for (int64_t position = 0; position < 7 * 3 * 65536; position += 977) {
        const int64_t leg = position / (3 * 65536), rest = position % (3 * 65536);
        assert_int_equal(noh_time_clip(position, 3, NOH_LOOP_PING_PONG), leg % 2 ? 3 * 65536 - rest : rest);
        assert_int_equal(noh_time_clip(-position, 3, NOH_LOOP_PING_PONG),
                         noh_time_clip(position, 3, NOH_LOOP_PING_PONG));
    }
}

static void advancing_never_overflows(void **state)
{
    static const int64_t rates[] = { INT64_MIN, -(256 * 65536), -1, 0, 1, 65536, 256 * 65536, INT64_MAX };
    static const int64_t ticks[] = { 0, 1, 48000, 0xffffffff, (int64_t)1 << 40, INT64_MAX, -1 };
    (void)state;
    for (size_t p = 0; p < COUNT(positions); p++) {
        for (size_t r = 0; r < COUNT(rates); r++) {
            for (size_t t = 0; t < COUNT(ticks); t++) {
                const long double exact = (long double)positions[p] + (long double)rates[r] * (long double)ticks[t];
                const int64_t to = noh_time_advance(positions[p], rates[r], ticks[t], 1000, NOH_LOOP_REPEAT);
                const int fits = (uint64_t)to == (uint64_t)positions[p] + (uint64_t)rates[r] * (uint64_t)ticks[t];
                if (exact > 0x1p63L + SLACK) {
                    assert_int_equal(to, INT64_MAX);
                } else if (exact < -0x1p63L - SLACK) {
                    assert_int_equal(to, INT64_MIN);
                } else if (exact < 0x1p63L - SLACK && exact > -0x1p63L + SLACK) {
                    assert_true(fits);
                } else {
                    assert_true(fits || to == INT64_MAX || to == INT64_MIN);
                }
            }
        }
    }
    assert_int_equal(noh_time_advance(INT64_MAX, 65536, 48000, 10, NOH_LOOP_ONCE), 10 * 65536);
    assert_int_equal(noh_time_advance(INT64_MIN, -65536, 48000, 10, NOH_LOOP_ONCE), 0);
}

static void positions_of_ticks_are_held(void **state)
{
    (void)state;
    assert_int_equal(noh_position_of(3), 3 * 65536);
    assert_int_equal(noh_position_of(-3), -3 * 65536);
    assert_int_equal(noh_position_of((int64_t)1 << 46), (int64_t)1 << 62);
    assert_int_equal(noh_position_of(INT64_MAX), INT64_MAX / 65536 * 65536);
    assert_int_equal(noh_position_of(INT64_MIN), -(INT64_MAX / 65536 * 65536));
}

static void rebasing_keeps_the_place(void **state)
{
    (void)state;
    for (size_t p = 0; p < COUNT(positions); p++) {
        for (size_t d = 0; d < COUNT(durations); d++) {
            for (int loop = NOH_LOOP_ONCE; loop <= NOH_LOOP_PING_PONG; loop++) {
                const int64_t less = positions[p] - noh_time_rebase(positions[p], durations[d], (noh_loop)loop);
                assert_int_equal(noh_time_clip(less, durations[d], (noh_loop)loop),
                                 noh_time_clip(positions[p], durations[d], (noh_loop)loop));
            }
        }
    }
}

static void seconds_become_the_nearest_tick(void **state)
{
    (void)state;
    assert_int_equal(noh_ticks_from_seconds(1.0 / 30.0), 1600);
    assert_int_equal(noh_ticks_from_seconds(-0.5), -24000);
    assert_int_equal(noh_ticks_from_seconds(0.75 / 48000.0), 1);
    assert_int_equal(noh_ticks_from_seconds(1e9), 48000000000000LL);
    assert_int_equal(noh_ticks_from_seconds(1.1e9), 0);
    assert_int_equal(noh_ticks_from_seconds((double)NAN), 0);
}

/* Frames of any length: after minutes the ticks equal the ticks of the sum, where rounding each frame is far off. */
static void a_clock_does_not_drift(void **state)
{
    (void)state;
    static const double rates[] = { 144.0, 59.94, 30.0, 1000.0, 7.0 };
    for (size_t r = 0; r < COUNT(rates); r++) {
        noh_frame_clock clock = { 0.0 };
        const uint32_t frames = (uint32_t)(rates[r] * 1020.0); /* 17 minutes */
        const double expected = (double)frames / rates[r] * 48000.0;
        double sum = 0.0, rounded = 0.0;
        for (uint32_t i = 0; i < frames; i++) {
            sum += (double)noh_frame_clock_advance(&clock, 1.0 / rates[r]);
            rounded += (double)noh_ticks_from_seconds(1.0 / rates[r]);
        }
        assert_true(fabs(sum - expected) <= 0.501);
        if (r == 0) assert_true(expected - rounded > 48000.0); /* a second */
    }
}

static void bad_seconds_are_no_time(void **state)
{
    (void)state;
    noh_frame_clock clock = { 0.0 };
    assert_int_equal(noh_frame_clock_advance(&clock, -1.0), 0);
    assert_int_equal(noh_frame_clock_advance(&clock, (double)NAN), 0);
    assert_true(clock.left_ticks == 0.0);
    assert_int_equal(noh_frame_clock_advance(&clock, 0.375 / 48000.0), 0);
    assert_int_equal(noh_frame_clock_advance(&clock, 0.375 / 48000.0), 1);
    assert_true(clock.left_ticks < 0.0);
    assert_int_equal(noh_frame_clock_advance(&clock, 1e30), 3600 * 48000);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_clock_does_not_drift),          cmocka_unit_test(bad_seconds_are_no_time),
    cmocka_unit_test(every_position_lies_in_its_clip), cmocka_unit_test(ping_pong_is_mirrored_at_zero),
    cmocka_unit_test(advancing_never_overflows),       cmocka_unit_test(positions_of_ticks_are_held),
    cmocka_unit_test(rebasing_keeps_the_place),        cmocka_unit_test(seconds_become_the_nearest_tick),
};

int main(void)
{
    return cmocka_run_group_tests(tests, NULL, NULL);
}
