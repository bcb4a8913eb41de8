/* Tests of time.c, ping_pong.c and tracks.c: where a track is, in integers. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "support/clip_set_fixture.h"
#include "motion/anim/time_internal.h"
#include "motion/anim/tracks_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

static noh_track started(const scene *s, noh_track_desc d)
{
    noh_track t;
    memset(&t, 0, sizeof t);
    assert_int_equal(noh_track_start(&t, &s->set, &d, NULL), NOH_OK);
    return t;
}

/* Each loop mode at, before and behind its edges: clip position and leg, in ticks. */
static void clips_fold_positions(void **state)
{
    static const struct {
        noh_loop loop;
        int64_t at, clip, leg;
    } rows[] = {
        { NOH_LOOP_ONCE, -5, 0, 0 },         { NOH_LOOP_ONCE, 40, 40, 0 },         { NOH_LOOP_ONCE, 100, 100, 0 },
        { NOH_LOOP_ONCE, 130, 100, 0 },      { NOH_LOOP_REPEAT, 0, 0, 0 },         { NOH_LOOP_REPEAT, 100, 0, 1 },
        { NOH_LOOP_REPEAT, 130, 30, 1 },     { NOH_LOOP_REPEAT, -30, 70, -1 },     { NOH_LOOP_PING_PONG, 100, 100, 1 },
        { NOH_LOOP_PING_PONG, 130, 70, 1 },  { NOH_LOOP_PING_PONG, 200, 0, 2 },    { NOH_LOOP_PING_PONG, 230, 30, 2 },
        { NOH_LOOP_PING_PONG, -30, 30, -1 }, { NOH_LOOP_PING_PONG, -130, 70, -2 },
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        assert_int_equal(noh_time_clip(noh_position_of(rows[i].at), 100, rows[i].loop), noh_position_of(rows[i].clip));
        assert_int_equal(noh_time_legs(noh_position_of(rows[i].at), 100, rows[i].loop), rows[i].leg);
    }
    assert_int_equal(noh_time_clip(noh_position_of(7), 0, NOH_LOOP_REPEAT), 0); /* a pose: no duration */
    assert_int_equal(noh_time_advance(noh_position_of(90), 2 * NOH_SPEED_ONE, 10, 100, NOH_LOOP_ONCE),
                     noh_position_of(100));
    assert_int_equal(noh_time_advance(noh_position_of(9), -NOH_SPEED_ONE, 10, 100, NOH_LOOP_ONCE), 0);
    assert_int_equal(noh_time_advance(noh_position_of(9), -NOH_SPEED_ONE, 10, 100, NOH_LOOP_REPEAT),
                     noh_position_of(-1));
}

/* A huge position is brought near 0 by whole cycles of two durations: neither the place nor the direction of a
 * ping-pong clip may change, in odd passes or in even ones. */
static void rebasing_keeps_place_and_direction(void **state)
{
    const int64_t d = noh_position_of(100);
    (void)state;
    for (int64_t k = 0; k < 4; k++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            const int64_t p = sign * (NOH_POSITION_MAX / d * d + (k + 2) * d + 777),
                          less = p - noh_time_rebase(p, 100, NOH_LOOP_PING_PONG);
            assert_true(less > -2 * d && less < 2 * d);
            assert_int_equal(noh_time_clip(p, 100, NOH_LOOP_PING_PONG), noh_time_clip(less, 100, NOH_LOOP_PING_PONG));
            assert_int_equal(noh_time_legs(p, 100, NOH_LOOP_PING_PONG) & 1,
                             noh_time_legs(less, 100, NOH_LOOP_PING_PONG) & 1);
        }
    }
    assert_int_equal(noh_time_rebase(NOH_POSITION_MAX, 100, NOH_LOOP_REPEAT), 0);
    assert_int_equal(noh_time_rebase(NOH_POSITION_MAX + 7, 100, NOH_LOOP_ONCE), 0);
}

/* Ended is said of a clip that has played to its end, not of one that was started there. */
static void what_was_placed_at_the_end_has_not_ended(void **state)
{
    scene s;
    noh_track t;
    (void)state;
    scene_open(&s);
    t = started(&s, (noh_track_desc){ .clip = JUMP, .position_ticks = 36000 });
    assert_false(noh_track_ended(&t, &s.clips[JUMP]));
    t.placed = 0; /* it has moved */
    assert_true(noh_track_ended(&t, &s.clips[JUMP]));
    t.speed_now = -NOH_SPEED_ONE; /* backwards the end is the start */
    assert_false(noh_track_ended(&t, &s.clips[JUMP]));
    t.position = 0;
    assert_true(noh_track_ended(&t, &s.clips[JUMP]));
    t.loop = NOH_LOOP_REPEAT;
    assert_false(noh_track_ended(&t, &s.clips[JUMP]));
}

/* The first tick by which the next key has been passed: rounded up, for any speed, both ways. */
static void the_next_key_is_counted_in_whole_ticks(void **state)
{
    scene s;
    (void)state;
    scene_open(&s);
    s.clips[WALK].first_event = 0;
    s.clips[WALK].event_count = 1;
    s.events[0].tick = 100;
    for (int32_t speed = 1000; speed < 4 * NOH_SPEED_ONE; speed += 3331) {
        noh_track t = started(&s, (noh_track_desc){ .clip = WALK, .speed = speed });
        int64_t next = noh_track_next_event(&t, &s.set, 1 << 20);
        assert_true(next * speed >= noh_position_of(100) && (next - 1) * speed < noh_position_of(100));
        t = started(&s, (noh_track_desc){ .clip = WALK, .speed = -speed, .position_ticks = 200 });
        next = noh_track_next_event(&t, &s.set, 1 << 20);
        assert_true(next * speed >= noh_position_of(100) && (next - 1) * speed < noh_position_of(100));
        assert_int_equal(noh_track_next_event(&t, &s.set, next - 1), 0);
    }
}

/* Some ticks ago a track was where its rate brought it from. */
static void the_tick_some_time_ago(void **state)
{
    scene s;
    noh_track t;
    (void)state;
    scene_open(&s);
    t = started(&s, (noh_track_desc){ .clip = WALK, .position_ticks = 1000, .speed = 2 * NOH_SPEED_ONE });
    assert_int_equal(noh_track_clip_tick(&t, &s.clips[WALK], 0), 1000);
    assert_int_equal(noh_track_clip_tick(&t, &s.clips[WALK], 300), 400);
    assert_int_equal(noh_track_clip_tick(&t, &s.clips[WALK], 600), 48000 - 200);
}

/* Zero in a desc is the default; the flags begin a track silent or paused. */
static void descs_have_defaults(void **state)
{
    scene s;
    noh_track t;
    (void)state;
    scene_open(&s);
    t = started(&s, (noh_track_desc){ .clip = WAVE });
    assert_true(t.weight == 1.0f && t.speed == NOH_SPEED_ONE && t.mode == NOH_TRACK_ON && t.loop == NOH_LOOP_PING_PONG);
    assert_true(t.placed && t.position == 0 && t.root_position == 0);
    t = started(&s, (noh_track_desc){ .clip = JUMP,
                                      .flags = NOH_TRACK_SILENT | NOH_TRACK_PAUSED | NOH_TRACK_ADDITIVE,
                                      .position_ticks = 99999 });
    assert_true(t.weight == 0.0f && t.speed == 0 && t.speed_now == 0 && t.flags == NOH_TRACK_ADDITIVE);
    assert_int_equal(t.position, noh_position_of(36000)); /* held at the end of a clip that plays once */
}

static void ramps_end_and_ping_pong_goes_on(void **state)
{
    (void)state;
    assert_true(noh_ramp(0, 10) == 0.0f && noh_ramp(5, 10) == 0.5f && noh_ramp(11, 10) == 1.0f &&
                noh_ramp(0, 0) == 1.0f);
    for (int64_t t = -30; t < 30; t++) {
        const int64_t phase = (t + 300) % 20;
        assert_true(noh_ping_pong(t, 10) == (float)(phase <= 10 ? phase : 20 - phase) / 10.0f);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clips_fold_positions),
        cmocka_unit_test(rebasing_keeps_place_and_direction),
        cmocka_unit_test(what_was_placed_at_the_end_has_not_ended),
        cmocka_unit_test(the_next_key_is_counted_in_whole_ticks),
        cmocka_unit_test(the_tick_some_time_ago),
        cmocka_unit_test(descs_have_defaults),
        cmocka_unit_test(ramps_end_and_ping_pong_goes_on),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
