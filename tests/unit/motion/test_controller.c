/* Tests of runtime/anim/controller*.c, and through the controller of tracks, changes, sync, time and inertial poses. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "motion/anim/changes_internal.h"
#include "motion/anim/controller_internal.h"
#include "motion/anim/controller_pose_internal.h"
#include "motion/anim/time_internal.h"
#include "motion/anim/tracks_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "support/clip_set_fixture.h"
#include "support/support.h"
#include "motion/pose/inertial_internal.h"
#include "motion/anim/sync_internal.h"
#include "motion/pose/blend_internal.h"

typedef struct stage {
    scene s;
    ALIGNED uint8_t memory[8192];
    ALIGNED uint8_t scratch_memory[16384];
    noh_controller *c;
    noh_pose_scratch scratch;
    noh_transform pose[JOINTS];
    float floats[FLOATS];
} stage;

static void stage_open(stage *g, uint32_t tracks, uint32_t flags)
{
    noh_controller_desc d;
    scene_open(&g->s);
    memset(&d, 0, sizeof d);
    d.set = &g->s.set;
    d.track_count = tracks;
    d.flags = flags;
    assert_int_equal(noh_controller_init(g->memory, sizeof g->memory, &d, &g->c, NULL), NOH_OK);
    assert_int_equal(
        noh_pose_scratch_init(g->scratch_memory, sizeof g->scratch_memory, &g->s.set, 1, &g->scratch, NULL), NOH_OK);
}

static void start(stage *g, uint32_t track, noh_track_desc d)
{
    assert_int_equal(noh_controller_start(g->c, &g->s.set, track, &d, NULL), NOH_OK);
}

static void step(stage *g, uint32_t ticks)
{
    (void)noh_controller_step(g->c, &g->s.set, ticks, NULL, NULL);
}

static void take_pose(stage *g)
{
    noh_controller_pose(g->c, &g->s.set, &g->scratch, g->pose, g->floats);
}

/* ---- set, descs, memory ---- */

static void bad_set(scene *s, noh_result result, const char *what)
{
    noh_error error;
    assert_int_equal(noh_clip_set_check(&s->set, &error), result);
    assert_non_null(strstr(error.what, what));
    scene_open(s);
}

static void set_fields_broken_in_turn(void **state)
{
    scene s;
    (void)state;
    scene_open(&s);
    s.set.clip_count = 0;
    bad_set(&s, NOH_ERR_ARG, "clip_count");
    s.set.joint_count = s.set.float_count = 0;
    bad_set(&s, NOH_ERR_ARG, "joint_count");
    s.set.joint_count = 0, s.set.roots = s.roots;
    bad_set(&s, NOH_ERR_ARG, "roots");
    s.set.joint_count = NOH_JOINTS_MAX + 1u;
    bad_set(&s, NOH_ERR_ARG, "joint_count");
    s.set.float_count = NOH_FLOATS_MAX + 1u;
    bad_set(&s, NOH_ERR_ARG, "float_count");
    s.set.mask_count = NOH_MASKS_MAX + 1u;
    bad_set(&s, NOH_ERR_ARG, "mask_count");
    s.set.clips = NULL;
    bad_set(&s, NOH_ERR_ARG, "clips");
    s.set.events = NULL;
    bad_set(&s, NOH_ERR_ARG, "events");
    s.set.markers = NULL;
    bad_set(&s, NOH_ERR_ARG, "markers");
    s.set.bind_pose = NULL;
    bad_set(&s, NOH_ERR_ARG, "bind_pose");
    s.set.masks = NULL;
    bad_set(&s, NOH_ERR_ARG, "masks");
    s.set.sample = NULL;
    bad_set(&s, NOH_ERR_ARG, "sample");
    s.clips[1].loop = 0;
    bad_set(&s, NOH_ERR_DATA, "loop");
    s.clips[1].loop = 4;
    bad_set(&s, NOH_ERR_DATA, "loop");
    s.clips[1].duration_ticks = 0x80000000u;
    bad_set(&s, NOH_ERR_DATA, "duration_ticks");
    s.clips[1].flags = 16;
    bad_set(&s, NOH_ERR_DATA, "flags of a clip");
    s.clips[1].first_event = 9;
    bad_set(&s, NOH_ERR_DATA, "events of a clip lie outside");
    s.clips[1].first_event = 1, s.clips[1].event_count = 0xffffffffu;
    bad_set(&s, NOH_ERR_DATA, "events of a clip lie outside");
    s.clips[1].event_count = 1, s.events[0].tick = 30001;
    bad_set(&s, NOH_ERR_DATA, "event's tick is after the end");
    s.clips[1].event_count = 2, s.events[0].tick = 5;
    bad_set(&s, NOH_ERR_DATA, "events of a clip are not in tick order");
    s.clips[1].event_count = 1, s.events[0].weight_min = NAN;
    bad_set(&s, NOH_ERR_DATA, "weight_min of an event");
    s.clips[1].first_marker = 5;
    bad_set(&s, NOH_ERR_DATA, "markers of a clip lie outside");
    s.markers[3].tick = 30000;
    bad_set(&s, NOH_ERR_DATA, "marker's tick is not before");
    s.markers[3].tick = 2000;
    bad_set(&s, NOH_ERR_DATA, "increasing tick order");
    assert_int_equal(noh_clip_set_find(&s.set, 103), 3);
    assert_int_equal(noh_clip_set_find(&s.set, 99), NOH_NONE);
}

static void bad_controller(noh_controller_desc d, const char *what)
{
    static ALIGNED uint8_t memory[65536];
    noh_controller *c = NULL;
    noh_error error;
    assert_int_equal(noh_controller_size(&d), 0);
    assert_int_equal(noh_controller_init(memory, sizeof memory, &d, &c, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, what, strlen(what)), 0);
    assert_null(c);
}

static void controller_desc_fields_broken_in_turn(void **state)
{
    scene s;
    noh_controller_desc fine, d;
    (void)state;
    scene_open(&s);
    memset(&fine, 0, sizeof fine);
    fine.set = &s.set;
    assert_true(noh_controller_size(&fine) > 0);
    d = fine, d.set = NULL;
    bad_controller(d, "set");
    d = fine, d.track_count = NOH_TRACKS_MAX + 1u;
    bad_controller(d, "track_count");
    d = fine, d.change_count = NOH_CHANGES_MAX + 1u;
    bad_controller(d, "change_count");
    d = fine, d.flags = 8;
    bad_controller(d, "flags");
    s.set.joint_count = s.set.float_count = 0;
    bad_controller(fine, "set");
}

static void memory_is_exact(void **state)
{
    stage g;
    noh_controller_desc d;
    noh_controller *c = NULL;
    noh_error error;
    size_t size;
    (void)state;
    stage_open(&g, 3, NOH_CONTROLLER_INERTIAL);
    memset(&d, 0, sizeof d);
    d.set = &g.s.set;
    d.track_count = 3;
    d.flags = NOH_CONTROLLER_INERTIAL;
    size = noh_controller_size(&d);
    memset(g.memory, 0xa5, sizeof g.memory);
    assert_int_equal(noh_controller_init(g.memory, size - 1u, &d, &c, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, size);
    assert_null(c);
    assert_int_equal(g.memory[0], 0xa5);
    assert_int_equal(noh_controller_init(g.memory + NOH_MEMORY_ALIGN / 2, size, &d, &c, &error), NOH_ERR_ARG);
    assert_int_equal(noh_controller_init(NULL, size, &d, &c, &error), NOH_ERR_ARG);
    assert_int_equal(noh_controller_init(g.memory, size, &d, &c, &error), NOH_OK);
    assert_int_equal(c->bytes, size);
    g.c = c;
    for (uint32_t t = 0; t < 3; t++) start(&g, t, track_of(t, 1.0f));
    assert_int_equal(noh_controller_inertia_capture(c, &g.s.set, &g.scratch, NULL), NOH_OK);
    assert_int_equal(noh_controller_inertia_begin(c, &g.s.set, &g.scratch, 4800, NULL), NOH_OK);
    step(&g, 1000);
    take_pose(&g);
    for (size_t i = size; i < sizeof g.memory; i++) assert_int_equal(g.memory[i], 0xa5);
}

static void scratch_memory_is_exact(void **state)
{
    scene s;
    static ALIGNED uint8_t memory[32768];
    noh_pose_scratch scratch;
    noh_error error;
    (void)state;
    scene_open(&s);
    for (int inertial = 0; inertial < 2; inertial++) {
        size_t size = noh_pose_scratch_size(&s.set, inertial);
        assert_int_equal(noh_pose_scratch_init(memory, size - 1u, &s.set, inertial, &scratch, &error), NOH_ERR_MEMORY);
        assert_int_equal(error.need, size);
        assert_int_equal(noh_pose_scratch_init(memory + 4, size, &s.set, inertial, &scratch, &error), NOH_ERR_ARG);
        assert_int_equal(noh_pose_scratch_init(memory, size, &s.set, inertial, &scratch, &error), NOH_OK);
    }
}

/* At most 64 bytes per joint and 64 per track, head, changes and offsets of a transition counted in. */
static void state_is_small(void **state)
{
    static const uint32_t joints[] = { 20, 31, 60, 1024 }, tracks[] = { 2, 4, 8 };
    scene s;
    (void)state;
    scene_open(&s);
    s.set.float_count = 0;
    for (uint32_t j = 0; j < 4; j++) {
        for (uint32_t t = 0; t < 3; t++) {
            noh_controller_desc d;
            size_t with, without;
            memset(&d, 0, sizeof d);
            s.set.joint_count = joints[j];
            d.set = &s.set;
            d.track_count = tracks[t];
            without = noh_controller_size(&d);
            d.flags = NOH_CONTROLLER_INERTIAL;
            with = noh_controller_size(&d);
            print_message("%4u joints, %u tracks: %lu bytes, %lu without room for inertia; allowed %u\n", joints[j],
                          tracks[t], (unsigned long)with, (unsigned long)without, 64u * (joints[j] + tracks[t]));
            assert_true(with <= 64u * (joints[j] + tracks[t]));
            assert_int_equal(with - without, 48u * joints[j]);
            assert_int_equal(without, sizeof(noh_controller) + tracks[t] * (sizeof(noh_track) + sizeof(noh_change)) +
                                          2u * sizeof(noh_change));
        }
    }
}

static void bad_start(stage *g, noh_track_desc d, const char *what)
{
    noh_error error;
    noh_track before = *noh_controller_track(g->c, 1);
    assert_int_equal(noh_controller_start(g->c, &g->s.set, 1, &d, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, what, strlen(what)), 0);
    assert_memory_equal(&before, noh_controller_track(g->c, 1), sizeof before);
}

static void track_desc_fields_broken_in_turn(void **state)
{
    stage g;
    noh_track_desc d;
    noh_error error;
    (void)state;
    stage_open(&g, 0, 0);
    start(&g, 1, track_of(0, 0.0f));
    d = track_of(CLIPS, 1.0f);
    bad_start(&g, d, "clip");
    d = track_of(0, 1.0f), d.position_ticks = ((int64_t)1 << 44) + 1;
    bad_start(&g, d, "position_ticks");
    d = track_of(0, 1.0f), d.speed = NOH_SPEED_MAX + 1;
    bad_start(&g, d, "speed");
    d = track_of(0, -1.0f);
    bad_start(&g, d, "weight");
    d = track_of(0, NAN);
    bad_start(&g, d, "weight");
    d = track_of(0, INFINITY);
    bad_start(&g, d, "weight");
    d = track_of(0, 1.0f), d.loop = (noh_loop)4;
    bad_start(&g, d, "loop");
    d = track_of(0, 1.0f), d.mode = (noh_track_mode)3;
    bad_start(&g, d, "mode");
    d = track_of(0, 1.0f), d.group = (noh_track_group)2;
    bad_start(&g, d, "group");
    d = track_of(0, 1.0f), d.mask = MASKS + 1u;
    bad_start(&g, d, "mask");
    d = track_of(0, 1.0f), d.lod_levels = 256;
    bad_start(&g, d, "lod_levels");
    d = track_of(0, 1.0f), d.sync_group = NOH_SYNC_GROUPS_MAX + 1u;
    bad_start(&g, d, "sync_group");
    d = track_of(WAVE, 1.0f), d.sync_group = 1;
    bad_start(&g, d, "sync_group"); /* does not repeat */
    d = track_of(0, 1.0f), d.flags = 16;
    bad_start(&g, d, "flags");
    d = track_of(0, 1.0f);
    assert_int_equal(noh_controller_start(g.c, &g.s.set, 4, &d, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, "track", strlen("track")), 0);
}

static void setters_refuse_bad_values(void **state)
{
    stage g;
    (void)state;
    stage_open(&g, 2, 0);
    assert_int_equal(noh_controller_set_speed(g.c, 2, 0), NOH_ERR_ARG);
    assert_int_equal(noh_controller_set_speed(g.c, 0, NOH_SPEED_MAX + 1), NOH_ERR_ARG);
    assert_int_equal(noh_controller_set_weight(g.c, 2, 0), NOH_ERR_ARG);
    assert_int_equal(noh_controller_set_weight(g.c, 0, -0.1f), NOH_ERR_ARG);
    assert_int_equal(noh_controller_set_weight(g.c, 0, NAN), NOH_ERR_ARG);
    assert_int_equal(noh_controller_set_mode(g.c, 2, NOH_TRACK_ON), NOH_ERR_ARG);
    assert_int_equal(noh_controller_set_mode(g.c, 0, (noh_track_mode)3), NOH_ERR_ARG);
    assert_int_equal(noh_controller_set_priority_blend(g.c, 1.1f), NOH_ERR_ARG);
    assert_int_equal(noh_controller_set_priority_blend(g.c, NAN), NOH_ERR_ARG);
    assert_int_equal(noh_controller_set_lod(g.c, 256, 0), NOH_ERR_ARG);
    assert_int_equal(noh_controller_set_lod(g.c, 0, JOINTS + 1u), NOH_ERR_ARG);
}

/* ---- time ---- */

static void time_functions_follow_their_loop_modes(void **state)
{
    int64_t d = noh_position_of(100), big = (int64_t)1 << 61;
    (void)state;
    assert_int_equal(noh_time_clip(noh_position_of(250), 100, NOH_LOOP_REPEAT), noh_position_of(50));
    assert_int_equal(noh_time_clip(noh_position_of(-30), 100, NOH_LOOP_REPEAT), noh_position_of(70));
    assert_int_equal(noh_time_clip(noh_position_of(130), 100, NOH_LOOP_PING_PONG), noh_position_of(70));
    assert_int_equal(noh_time_clip(noh_position_of(-30), 100, NOH_LOOP_PING_PONG), noh_position_of(30));
    assert_int_equal(noh_time_clip(noh_position_of(130), 100, NOH_LOOP_ONCE), d);
    assert_int_equal(noh_time_clip(d, 100, NOH_LOOP_REPEAT), 0);
    assert_int_equal(noh_time_clip(12345, 0, NOH_LOOP_REPEAT), 0);
    assert_int_equal(noh_time_legs(-1, 100, NOH_LOOP_REPEAT), -1);
    assert_int_equal(noh_time_advance(0, -5, 10, 100, NOH_LOOP_ONCE), 0);
    assert_int_equal(noh_time_rebase(d, 100, NOH_LOOP_REPEAT), 0);
    for (int sign = -1; sign <= 1; sign += 2) {
        int64_t p = sign * (big + 777), less = p - noh_time_rebase(p, 100, NOH_LOOP_PING_PONG);
        assert_true(less < 2 * d && less > -2 * d);
        assert_int_equal(noh_time_clip(p, 100, NOH_LOOP_PING_PONG), noh_time_clip(less, 100, NOH_LOOP_PING_PONG));
    }
}

/* Integer time does not drift over a day of 60 Hz frames; the same sum in floats does. */
static void time_does_not_drift(void **state)
{
    stage g;
    float seconds = 0.0f;
    (void)state;
    test_skip_emulated("a day of frames");
    stage_open(&g, 1, 0);
    start(&g, 0, track_of(RUN, 1.0f));
    for (uint32_t i = 0; i < 24u * 3600u * 60u; i++) {
        step(&g, 800);
        seconds += 1.0f / 60.0f;
    }
    assert_int_equal(noh_controller_track(g.c, 0)->position, noh_position_of(24LL * 3600 * 48000));
    assert_true(fabsf(seconds - 86400.0f) > 1000.0f);
}

static void ended_tracks_are_known(void **state)
{
    stage g;
    (void)state;
    stage_open(&g, 1, 0);
    start(&g, 0, track_of(JUMP, 1.0f));
    assert_false(noh_track_ended(noh_controller_track(g.c, 0), &g.s.clips[JUMP]));
    step(&g, 35999);
    assert_false(noh_track_ended(noh_controller_track(g.c, 0), &g.s.clips[JUMP]));
    step(&g, 1);
    assert_true(noh_track_ended(noh_controller_track(g.c, 0), &g.s.clips[JUMP]));
}

/* ---- changes over time ---- */

static noh_change_desc change_of(noh_change_kind kind, uint32_t duration)
{
    noh_change_desc d;
    memset(&d, 0, sizeof d);
    d.kind = kind;
    d.duration_ticks = duration;
    return d;
}

static void change(stage *g, noh_change_desc d)
{
    assert_int_equal(noh_controller_change(g->c, &g->s.set, &d, NULL), NOH_OK);
}

static void bad_change(stage *g, noh_change_desc d, const char *what)
{
    noh_error error;
    assert_int_equal(noh_controller_change(g->c, &g->s.set, &d, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, what, strlen(what)), 0);
}

static void change_fields_broken_in_turn(void **state)
{
    stage g;
    noh_change_desc d;
    noh_error error;
    (void)state;
    stage_open(&g, 2, 0);
    d = change_of((noh_change_kind)5, 0);
    bad_change(&g, d, "kind");
    d = change_of(NOH_CHANGE_SPEED, 0), d.track = 2;
    bad_change(&g, d, "track");
    d = change_of(NOH_CHANGE_SPEED, 0), d.curve = (noh_curve)2;
    bad_change(&g, d, "curve");
    d = change_of(NOH_CHANGE_SPEED, 0), d.speed = -NOH_SPEED_MAX - 1;
    bad_change(&g, d, "speed");
    d = change_of(NOH_CHANGE_WEIGHT, 0), d.weight = NAN;
    bad_change(&g, d, "weight");
    d = change_of(NOH_CHANGE_PRIORITY, 0), d.weight = 1.5f;
    bad_change(&g, d, "weight");
    d = change_of(NOH_CHANGE_POSITION, 0), d.position_ticks = (int64_t)1 << 45;
    bad_change(&g, d, "position_ticks");
    d = change_of(NOH_CHANGE_MODE, 0), d.mode = (noh_track_mode)3;
    bad_change(&g, d, "mode");
    d = change_of(NOH_CHANGE_MODE, 5);
    bad_change(&g, d, "duration_ticks");
    for (uint32_t i = 0; i < 4; i++) {
        d = change_of(NOH_CHANGE_SPEED, 5), d.delay_ticks = 10u + i;
        change(&g, d);
    }
    change(&g, d); /* the same tick: replaces */
    d.delay_ticks = 99;
    assert_int_equal(noh_controller_change(g.c, &g.s.set, &d, &error), NOH_ERR_LIMIT);
    assert_int_equal(g.c->changes_high_water, 4);
    assert_int_equal(noh_controller_cross_fade(g.c, &g.s.set, 0, 1, 1.0f, 10, NOH_CURVE_LINEAR, &error), NOH_ERR_LIMIT);
    assert_int_equal(noh_controller_cross_fade(g.c, &g.s.set, 0, 0, 1.0f, 10, NOH_CURVE_LINEAR, &error), NOH_ERR_ARG);
    assert_int_equal(noh_controller_cross_fade(g.c, &g.s.set, 0, 1, -1.0f, 10, NOH_CURVE_LINEAR, &error), NOH_ERR_ARG);
    assert_int_equal(noh_controller_cross_fade(g.c, &g.s.set, 0, 1, 1.0f, 10, (noh_curve)9, &error), NOH_ERR_ARG);
    step(&g, 200);
    assert_int_equal(noh_controller_change(g.c, &g.s.set, &d, &error), NOH_OK); /* room again */
}

static void a_weight_follows_its_curve(void **state)
{
    stage g;
    noh_change_desc d = change_of(NOH_CHANGE_WEIGHT, 1000);
    (void)state;
    stage_open(&g, 2, 0);
    start(&g, 0, track_of(0, 1.0f));
    d.delay_ticks = 500;
    d.weight = 0.0f;
    d.curve = NOH_CURVE_SMOOTHSTEP;
    change(&g, d);
    step(&g, 500);
    assert_true(noh_controller_track(g.c, 0)->weight == 1.0f);
    step(&g, 250);
    assert_true(fabsf(noh_controller_track(g.c, 0)->weight - (1.0f - 0.15625f)) < 1e-6f);
    step(&g, 749);
    assert_true(noh_controller_track(g.c, 0)->weight > 0.0f);
    step(&g, 1);
    assert_true(noh_controller_track(g.c, 0)->weight == 0.0f);
    d.delay_ticks = 0, d.weight = 0.5f;
    change(&g, d);
    step(&g, 100);
    assert_int_equal(noh_controller_set_weight(g.c, 0, 0.75f), NOH_OK); /* ends the change */
    step(&g, 5000);
    assert_true(noh_controller_track(g.c, 0)->weight == 0.75f);
}

/* While a speed changes, a track moves by the integral of the curve: the mean of both speeds. */
static void a_speed_change_moves_by_the_integral(void **state)
{
    static const uint32_t durations[] = { 1, 2, 7, 63, 64, 65, 1000, 48000, 1000000 };
    (void)state;
    for (uint32_t i = 0; i < 9; i++) {
        for (int curve = 0; curve < 2; curve++) {
            stage g;
            noh_change_desc d = change_of(NOH_CHANGE_SPEED, durations[i]);
            double way;
            stage_open(&g, 1, 0);
            start(&g, 0, track_of(LEAN, 1.0f));
            d.speed = -3 * NOH_SPEED_ONE;
            d.curve = (noh_curve)curve;
            change(&g, d);
            step(&g, durations[i]);
            way = (double)noh_controller_track(g.c, 0)->position / 65536.0;
            /* exact where slices are equal; a tick of both speeds' difference in 64 slices where not */
            assert_true(fabs(way + (double)durations[i]) <=
                        (durations[i] % 64u ? 2.0 + 1e-3 * durations[i] / 64.0 : 1e-4 * durations[i]));
            assert_int_equal(noh_controller_track(g.c, 0)->speed, -3 * NOH_SPEED_ONE);
        }
    }
}

static void a_position_change_arrives_exactly(void **state)
{
    static const uint32_t durations[] = { 0, 1, 2, 7, 63, 64, 65, 1000, 48000 };
    (void)state;
    for (uint32_t i = 0; i < 9; i++) {
        for (int curve = 0; curve < 2; curve++) {
            stage g;
            noh_change_desc d = change_of(NOH_CHANGE_POSITION, durations[i]);
            stage_open(&g, 1, 0);
            start(&g, 0, track_of(LEAN, 1.0f));
            step(&g, 77);
            d.position_ticks = -1234567;
            d.curve = (noh_curve)curve;
            change(&g, d);
            if (durations[i] == 1000) {
                step(&g, 500);
                assert_true(llabs(noh_controller_track(g.c, 0)->position - noh_position_of((77 - 1234567) / 2)) <
                            1300 * 65536);
                step(&g, 500);
            } else {
                step(&g, durations[i]);
            }
            assert_int_equal(noh_controller_track(g.c, 0)->position, noh_position_of(-1234567));
            step(&g, 10); /* then it plays on */
            assert_int_equal(noh_controller_track(g.c, 0)->position, noh_position_of(-1234557));
        }
    }
}

static void a_cross_fade_is_the_blend_of_both(void **state)
{
    stage g;
    (void)state;
    stage_open(&g, 2, 0);
    start(&g, 0, track_of(0, 1.0f));
    step(&g, 100);
    start(&g, 1, (noh_track_desc){ .clip = 1, .flags = NOH_TRACK_SILENT });
    assert_int_equal(noh_controller_cross_fade(g.c, &g.s.set, 0, 1, 1.0f, 4800, NOH_CURVE_LINEAR, NULL), NOH_OK);
    step(&g, 1200);
    assert_true(fabsf(noh_controller_track(g.c, 0)->weight - 0.75f) < 1e-6f);
    assert_true(fabsf(noh_controller_track(g.c, 1)->weight - 0.25f) < 1e-6f);
    step(&g, 3600);
    assert_int_equal(noh_controller_track(g.c, 0)->mode, NOH_TRACK_OFF);
    assert_true(noh_controller_track(g.c, 1)->weight == 1.0f);
}

/* ---- sync groups ---- */

static void start_synced(stage *g, uint32_t track, uint32_t clip, float weight)
{
    noh_track_desc d = track_of(clip, weight);
    d.sync_group = 3;
    start(g, track, d);
}

static double phases_apart(stage *g, uint32_t a, uint32_t b)
{
    const noh_track *ta = noh_controller_track(g->c, a), *tb = noh_controller_track(g->c, b);
    noh_phase pa = noh_sync_phase(&g->s.set, &g->s.clips[ta->clip], ta->position);
    noh_phase pb = noh_sync_phase(&g->s.set, &g->s.clips[tb->clip], tb->position);
    uint32_t count = g->s.clips[ta->clip].marker_count ? g->s.clips[ta->clip].marker_count : 1u;
    double apart = fabs((double)pa.interval + pa.fraction - (double)pb.interval - pb.fraction);
    return fmin(apart, (double)count - apart);
}

static void tracks_keep_in_step_by_markers_and_by_phase(void **state)
{
    (void)state;
    for (int markers = 0; markers < 2; markers++) {
        stage g;
        double worst = 0.0;
        int64_t before;
        stage_open(&g, 3, 0);
        if (!markers) g.s.clips[WALK].marker_count = g.s.clips[RUN].marker_count = 0;
        start_synced(&g, 0, WALK, 1.0f);
        step(&g, 26 * NOH_SYNC_TICKS);
        start_synced(&g, 1, RUN, 0.5f);
        assert_true(phases_apart(&g, 0, 1) < 1e-6); /* joined on the phase */
        for (int i = 0; i < 2000; i++) {
            noh_controller_set_weight(g.c, 1, (float)(i % 200) / 50.0f);
            step(&g, 480); /* at each multiple of NOH_SYNC_TICKS */
            worst = fmax(worst, phases_apart(&g, 0, 1));
        }
        print_message("sync by %s: phases at most %.2g of an interval apart\n", markers ? "markers" : "phase", worst);
        assert_true(worst < 1e-5);
        noh_controller_set_weight(g.c, 0, 0.0f); /* the run alone: its own speed */
        before = noh_controller_track(g.c, 1)->position;
        step(&g, 48000);
        assert_true(llabs(noh_controller_track(g.c, 1)->position - before - noh_position_of(48000)) <
                    noh_position_of(2));
        assert_int_equal(noh_controller_seek(g.c, &g.s.set, 1, 7000, NOH_SEEK_SKIP, NULL),
                         NOH_OK); /* the group goes along */
        assert_true(phases_apart(&g, 0, 1) < 1e-6);
    }
}

static void clips_with_other_markers_are_not_synced(void **state)
{
    stage g;
    noh_track_desc d = track_of(LEAN, 1.0f); /* has none */
    noh_error error;
    noh_change_desc glide = change_of(NOH_CHANGE_POSITION, 10);
    (void)state;
    stage_open(&g, 3, 0);
    start_synced(&g, 0, WALK, 1.0f);
    d.sync_group = 3;
    assert_int_equal(noh_controller_start(g.c, &g.s.set, 1, &d, &error), NOH_ERR_ARG);
    assert_int_equal(noh_controller_change(g.c, &g.s.set, &glide, &error), NOH_ERR_ARG);
    assert_int_equal(noh_controller_seek(g.c, &g.s.set, 0, 5, NOH_SEEK_FIRE, &error), NOH_ERR_ARG);
}

/* ---- poses ---- */

static void one_track_shows_its_clip(void **state)
{
    stage g;
    noh_transform want[JOINTS];
    float floats[FLOATS];
    (void)state;
    stage_open(&g, 2, 0);
    take_pose(&g); /* nothing plays: bind pose and defaults */
    assert_memory_equal(g.pose, g.s.bind, sizeof g.pose);
    assert_memory_equal(g.floats, g.s.defaults, sizeof g.floats);
    start(&g, 0, track_of(WAVE, 0.3f));
    step(&g, 31000); /* on the way back */
    take_pose(&g);
    scene_pose(&g.s, WAVE, 17000, want, floats);
    assert_memory_equal(g.pose, want, sizeof want);
    assert_memory_equal(g.floats, floats, sizeof floats);
    start(&g, 1, track_of(WAVE, 0.9f)); /* the same model_clips twice, summed */
    noh_controller_seek(g.c, &g.s.set, 1, 31000, NOH_SEEK_SKIP, NULL);
    take_pose(&g);
    assert_true(pose_apart(g.pose, want, JOINTS) < 1e-6);
    assert_true(floats_apart(g.floats, floats, FLOATS) < 1e-6);
    noh_controller_set_mode(g.c, 1, NOH_TRACK_OFF);
    noh_controller_set_mode(g.c, 0, NOH_TRACK_TIME_ONLY);
    take_pose(&g);
    assert_memory_equal(g.pose, g.s.bind, sizeof g.pose);
}

/* Priority is the blend group, not a distance. All low tracks blend, all high
 * tracks blend, then the two: the source's one sum of all weights gives another pose. */
static void priority_is_the_blend_group(void **state)
{
    stage g;
    noh_transform low[JOINTS], high[JOINTS], want[JOINTS], one_sum[JOINTS];
    float floats[FLOATS];
    (void)state;
    stage_open(&g, 3, 0);
    start(&g, 0, track_of(WALK, 3.0f));
    start(&g, 1, track_of(RUN, 1.0f));
    take_pose(&g);
    memcpy(low, g.pose, sizeof low);
    start(&g, 2, track_of(WAVE, 0.5f));
    take_pose(&g);
    memcpy(one_sum, g.pose, sizeof one_sum);
    scene_pose(&g.s, WAVE, 0, high, floats);
    start(&g, 2, (noh_track_desc){ .clip = WAVE, .weight = 0.5f, .group = NOH_GROUP_HIGH });
    for (int i = 0; i <= 4; i++) {
        float blend = (float)i / 4.0f;
        assert_int_equal(noh_controller_set_priority_blend(g.c, blend), NOH_OK);
        take_pose(&g);
        noh_pose_mix(JOINTS, low, high, blend, NULL, want);
        assert_true(pose_apart(g.pose, want, JOINTS) < 1e-6);
        assert_true(pose_apart(g.pose, one_sum, JOINTS) > 0.01);
    }
    noh_controller_set_mode(g.c, 0, NOH_TRACK_OFF); /* no low track: the high group alone, whatever the blend */
    noh_controller_set_mode(g.c, 1, NOH_TRACK_OFF);
    noh_controller_set_priority_blend(g.c, 0.25f);
    take_pose(&g);
    assert_true(pose_apart(g.pose, high, JOINTS) < 1e-6);
}

/* A masked high track covers what its mask lets through, with soft edges, and leaves the rest. */
static void a_masked_track_covers_by_its_mask(void **state)
{
    stage g;
    noh_transform low[JOINTS], high[JOINTS], want[JOINTS];
    float low_floats[FLOATS], high_floats[FLOATS], want_floats[FLOATS];
    (void)state;
    stage_open(&g, 2, 0);
    scene_pose(&g.s, WALK, 0, low, low_floats);
    scene_pose(&g.s, WAVE, 0, high, high_floats);
    start(&g, 0, track_of(WALK, 1.0f));
    for (uint32_t mask = 1; mask <= 2; mask++) {
        start(&g, 1, (noh_track_desc){ .clip = WAVE, .group = NOH_GROUP_HIGH, .mask = mask, .weight = 0.7f });
        take_pose(&g);
        noh_pose_mix(JOINTS, low, high, 1.0f, g.s.masks[mask - 1u], want);
        noh_floats_mix(FLOATS, low_floats, high_floats, 1.0f, g.s.masks[mask - 1u] + JOINTS, want_floats);
        assert_true(pose_apart(g.pose, want, JOINTS) < 2e-6);
        assert_true(floats_apart(g.floats, want_floats, FLOATS) < 1e-6);
    }
}

/* The high group covers the low one by the priority blend, and completely where no low track takes part. */
static void the_high_group_covers_what_nothing_lies_below(void **state)
{
    stage g;
    noh_transform low[JOINTS], high[JOINTS], want[JOINTS];
    float low_floats[FLOATS], high_floats[FLOATS];
    (void)state;
    stage_open(&g, 2, 0);
    scene_pose(&g.s, WALK, 0, low, low_floats);
    scene_pose(&g.s, RUN, 0, high, high_floats);
    start(&g, 0, (noh_track_desc){ .clip = WALK, .mask = 1 }); /* the upper half */
    start(&g, 1, (noh_track_desc){ .clip = RUN, .group = NOH_GROUP_HIGH, .weight = 4.0f });
    assert_int_equal(noh_controller_set_priority_blend(g.c, 0.25f), NOH_OK);
    take_pose(&g);
    for (uint32_t j = 0; j < JOINTS; j++) {
        noh_pose_mix(1, &low[j], &high[j], j < JOINTS / 2u ? 1.0f : 0.25f, NULL, &want[j]);
    }
    assert_true(pose_apart(g.pose, want, JOINTS) < 1e-6);
    for (uint32_t i = 0; i < FLOATS; i++) {
        const float t = i < 2 ? 1.0f : 0.25f;
        assert_true(fabsf(g.floats[i] - (low_floats[i] + (high_floats[i] - low_floats[i]) * t)) < 1e-6f);
    }
}

/* With NOH_CONTROLLER_COVERS a high track covers by its weight, so it can be faded in from nothing; two that fade into
 * each other cover wholly all the time; and floats come from their defaults. */
static void weights_below_one_cover_in_part(void **state)
{
    stage g;
    noh_transform low[JOINTS], high[JOINTS], other[JOINTS], want[JOINTS];
    float low_floats[FLOATS], high_floats[FLOATS], other_floats[FLOATS];
    (void)state;
    stage_open(&g, 3, NOH_CONTROLLER_COVERS);
    scene_pose(&g.s, WALK, 0, low, low_floats);
    scene_pose(&g.s, WAVE, 0, high, high_floats);
    scene_pose(&g.s, RUN, 0, other, other_floats);
    for (int i = 1; i <= 5; i++) {
        const float weight = (float)i / 4.0f, part = weight < 1.0f ? weight : 1.0f;
        start(&g, 0, (noh_track_desc){ .clip = WALK, .weight = 3.0f });
        start(&g, 1, (noh_track_desc){ .clip = WAVE, .group = NOH_GROUP_HIGH, .weight = weight });
        take_pose(&g);
        noh_pose_mix(JOINTS, low, high, part, NULL, want);
        assert_true(pose_apart(g.pose, want, JOINTS) < 1e-6);
        assert_true(fabsf(g.floats[1] - (low_floats[1] + (high_floats[1] - low_floats[1]) * part)) < 1e-6f);
        noh_controller_set_mode(g.c, 0, NOH_TRACK_OFF); /* below is the bind pose */
        take_pose(&g);
        noh_pose_mix(JOINTS, g.s.bind, high, part, NULL, want);
        assert_true(pose_apart(g.pose, want, JOINTS) < 1e-6);
        start(&g, 1, (noh_track_desc){ .clip = WAVE, .weight = weight }); /* low: joints are whole, floats in part */
        take_pose(&g);
        assert_true(pose_apart(g.pose, high, JOINTS) < 1e-6);
        assert_true(fabsf(g.floats[1] - (g.s.defaults[1] + (high_floats[1] - g.s.defaults[1]) * part)) < 1e-6f);
    }
    start(&g, 1, (noh_track_desc){ .clip = WAVE, .group = NOH_GROUP_HIGH, .weight = 0.25f });
    start(&g, 2, (noh_track_desc){ .clip = RUN, .group = NOH_GROUP_HIGH, .weight = 0.75f });
    take_pose(&g);
    noh_pose_mix(JOINTS, high, other, 0.75f, NULL, want);
    assert_true(pose_apart(g.pose, want, JOINTS) < 2e-3); /* the sum and the mix normalise at different times */
    assert_true(fabsf(g.floats[1] - (high_floats[1] * 0.25f + other_floats[1] * 0.75f)) < 1e-6f);
}

/* A single track with a mask: what the mask leaves out has the bind pose. */
static void a_masked_track_alone_leaves_the_bind_pose(void **state)
{
    stage g;
    noh_transform wave[JOINTS];
    float floats[FLOATS];
    (void)state;
    stage_open(&g, 2, 0);
    scene_pose(&g.s, WAVE, 0, wave, floats);
    start(&g, 0, (noh_track_desc){ .clip = WAVE, .mask = 1 });
    take_pose(&g);
    assert_memory_equal(g.pose, g.s.bind, JOINTS / 2u * sizeof *g.pose);
    assert_true(pose_apart(g.pose + JOINTS / 2u, wave + JOINTS / 2u, JOINTS / 2u) < 1e-6);
    assert_true(g.floats[0] == g.s.defaults[0] && fabsf(g.floats[4] - floats[4]) < 1e-6f);
}

/* A walk that moves no floats and a face that moves no joints, together: each is what it is alone. */
static void clips_of_joints_and_of_floats_do_not_mix(void **state)
{
    stage g;
    noh_transform walk[JOINTS], face[JOINTS];
    float walk_floats[FLOATS], face_floats[FLOATS];
    (void)state;
    stage_open(&g, 2, 0);
    g.s.clips[WALK].flags = NOH_CLIP_JOINTS_ONLY;
    g.s.clips[WAVE].flags = NOH_CLIP_FLOATS_ONLY;
    scene_pose(&g.s, WALK, 0, walk, walk_floats);
    scene_pose(&g.s, WAVE, 0, face, face_floats);
    start(&g, 0, track_of(WALK, 1.0f));
    start(&g, 1, track_of(WAVE, 0.4f));
    take_pose(&g);
    assert_true(pose_apart(g.pose, walk, JOINTS) < 1e-6);
    assert_true(floats_apart(g.floats, face_floats, FLOATS) < 1e-6);
    g.s.clips[WALK].flags = g.s.clips[WAVE].flags = 0;
    take_pose(&g);
    assert_true(pose_apart(g.pose, walk, JOINTS) > 1e-2 && floats_apart(g.floats, face_floats, FLOATS) > 1e-2);
}

/* The same in the high group: a speaking face neither covers the walk below nor dilutes the bow of the same group, and
 * a bow that moves no floats leaves them to the face. */
static void clips_of_joints_and_of_floats_do_not_mix_in_the_high_group(void **state)
{
    stage g;
    noh_transform low[JOINTS], bow[JOINTS], face[JOINTS];
    float low_floats[FLOATS], bow_floats[FLOATS], face_floats[FLOATS];
    (void)state;
    stage_open(&g, 3, 0);
    scene_pose(&g.s, WALK, 0, low, low_floats);
    scene_pose(&g.s, RUN, 0, bow, bow_floats);
    scene_pose(&g.s, WAVE, 0, face, face_floats);
    g.s.clips[WAVE].flags = NOH_CLIP_FLOATS_ONLY;
    start(&g, 0, track_of(WALK, 1.0f));
    start(&g, 2, (noh_track_desc){ .clip = WAVE, .weight = 3.0f, .group = NOH_GROUP_HIGH });
    take_pose(&g);
    assert_true(pose_apart(g.pose, low, JOINTS) < 1e-6 && floats_apart(g.floats, face_floats, FLOATS) < 1e-6);
    g.s.clips[RUN].flags = NOH_CLIP_JOINTS_ONLY;
    start(&g, 1, (noh_track_desc){ .clip = RUN, .weight = 0.5f, .group = NOH_GROUP_HIGH });
    take_pose(&g);
    assert_true(pose_apart(g.pose, bow, JOINTS) < 1e-6 && floats_apart(g.floats, face_floats, FLOATS) < 1e-6);
    start(&g, 2, (noh_track_desc){ .clip = WAVE, .weight = 3.0f, .flags = NOH_TRACK_ADDITIVE });
    g.s.clips[WAVE].flags |= NOH_CLIP_ADDITIVE; /* joints that it does not have are no difference either */
    take_pose(&g);
    assert_true(pose_apart(g.pose, bow, JOINTS) < 1e-6);
}

/* A high track whose mask leaves a joint out does not dilute another high track there. */
static void a_masked_track_leaves_others_their_joints(void **state)
{
    stage g;
    noh_transform run[JOINTS], wave[JOINTS], mean[JOINTS];
    float run_floats[FLOATS], wave_floats[FLOATS];
    (void)state;
    stage_open(&g, 3, 0);
    scene_pose(&g.s, RUN, 0, run, run_floats);
    scene_pose(&g.s, WAVE, 0, wave, wave_floats);
    start(&g, 0, track_of(WALK, 1.0f));
    start(&g, 1, (noh_track_desc){ .clip = RUN, .weight = 2.0f, .group = NOH_GROUP_HIGH });
    start(&g, 2, (noh_track_desc){ .clip = WAVE, .weight = 2.0f, .group = NOH_GROUP_HIGH, .mask = 1 });
    take_pose(&g);
    noh_pose_mix(JOINTS, run, wave, 0.5f, NULL, mean);
    assert_true(pose_apart(g.pose, run, JOINTS / 2u) < 1e-6); /* masks[0]: the upper half */
    assert_true(pose_apart(g.pose + JOINTS / 2u, mean + JOINTS / 2u, JOINTS / 2u) < 1e-6);
    assert_true(floats_apart(g.floats, run_floats, 2) < 1e-6);
}

/* The low group is the mean by weight: three of a walk to one of a run. */
static void tracks_count_by_weight(void **state)
{
    stage g;
    noh_transform a[JOINTS], b[JOINTS], want[JOINTS];
    float fa[FLOATS], fb[FLOATS];
    (void)state;
    stage_open(&g, 2, 0);
    scene_pose(&g.s, WALK, 0, a, fa);
    scene_pose(&g.s, RUN, 0, b, fb);
    for (int group = NOH_GROUP_LOW; group <= NOH_GROUP_HIGH; group++) {
        start(&g, 0, (noh_track_desc){ .clip = WALK, .weight = 3.0f, .group = (noh_track_group)group });
        start(&g, 1, (noh_track_desc){ .clip = RUN, .weight = 1.0f, .group = (noh_track_group)group });
        take_pose(&g);
        noh_pose_mix(JOINTS, a, b, 0.25f, NULL, want);
        assert_true(pose_apart(g.pose, want, JOINTS) < 1e-6);
        for (uint32_t i = 0; i < FLOATS; i++) assert_true(fabsf(g.floats[i] - (0.75f * fa[i] + 0.25f * fb[i])) < 1e-6f);
    }
}

static void lod_levels_leave_out_tracks_and_joints(void **state)
{
    stage g;
    noh_transform want[JOINTS];
    float floats[FLOATS];
    uint32_t samples;
    (void)state;
    stage_open(&g, 2, 0);
    start(&g, 0, track_of(WALK, 1.0f));
    start(&g, 1, (noh_track_desc){ .clip = RUN, .lod_levels = 2 });
    noh_controller_set_lod(g.c, 1, 10);
    samples = g.s.samples;
    take_pose(&g);
    assert_int_equal(g.s.samples - samples, 2);
    assert_memory_equal(g.pose + 10, g.s.bind + 10, 14 * sizeof *g.pose);
    noh_controller_set_lod(g.c, 2, 0); /* the run is for the levels 0 and 1 */
    samples = g.s.samples;
    take_pose(&g);
    assert_int_equal(g.s.samples - samples, 1);
    scene_pose(&g.s, WALK, 0, want, floats);
    assert_true(pose_apart(g.pose, want, JOINTS) < 1e-6);
}

/* An additive track over a base of WALK, whichever of the two comes first. */
static void add_differences(uint32_t additive)
{
    stage g;
    noh_transform base[JOINTS], lean[JOINTS], first[JOINTS], want[JOINTS];
    float base_floats[FLOATS], lean_floats[FLOATS], first_floats[FLOATS];
    stage_open(&g, 2, 0);
    start(&g, 1u - additive, track_of(WALK, 2.0f));
    scene_pose(&g.s, WALK, 0, base, base_floats);
    scene_pose(&g.s, LEAN, 24000, lean, lean_floats);
    scene_pose(&g.s, LEAN, 0, first, first_floats);
    for (int reference = 0; reference < 3; reference++) { /* bind pose, its own start, a difference already */
        noh_track_desc d = track_of(LEAN, 0.6f);
        const noh_transform *against = reference ? first : g.s.bind;
        d.position_ticks = 24000;
        d.flags = NOH_TRACK_ADDITIVE | (reference == 1 ? NOH_TRACK_REFERENCE_START : 0u);
        d.mask = 2;
        g.s.clips[LEAN].flags = reference == 2 ? NOH_CLIP_ADDITIVE : 0u;
        start(&g, additive, d);
        take_pose(&g);
        memcpy(want, lean, sizeof want);
        if (reference < 2) noh_pose_difference(JOINTS, against, lean, want);
        for (uint32_t j = 0; j < JOINTS; j++) {
            noh_transform t = base[j];
            float w = 0.6f * (float)g.s.masks[1][j] / 255.0f, unit[4] = { 0, 0, 0, 1 }, turn[4];
            noh_quat_nlerp(unit, want[j].rotation, w, turn);
            noh_quat_mul(t.rotation, turn, t.rotation);
            for (int k = 0; k < 3; k++) {
                t.translation[k] += w * want[j].translation[k];
                t.scale[k] *= 1.0f + w * (want[j].scale[k] - 1.0f);
            }
            want[j] = t;
        }
        assert_true(pose_apart(g.pose, want, JOINTS) < 2e-6);
        for (uint32_t i = 0; i < FLOATS; i++) {
            float from = reference == 0 ? g.s.defaults[i] : reference == 1 ? first_floats[i] : 0.0f;
            assert_true(fabsf(g.floats[i] - (base_floats[i] + 0.6f * 128.0f / 255.0f * (lean_floats[i] - from))) <
                        1e-6f);
        }
    }
}

static void additive_tracks_add_differences(void **state)
{
    (void)state;
    add_differences(1);
    add_differences(0);
}

/* Without a base an additive track lies over the bind pose: it is no base itself, alone or not. */
static void an_additive_track_alone_lies_over_the_bind_pose(void **state)
{
    stage g;
    noh_transform lean[JOINTS];
    float floats[FLOATS];
    (void)state;
    stage_open(&g, 1, 0);
    start(&g, 0,
          (noh_track_desc){ .clip = LEAN, .weight = 1.0f, .position_ticks = 24000, .flags = NOH_TRACK_ADDITIVE });
    scene_pose(&g.s, LEAN, 24000, lean, floats);
    take_pose(&g);
    assert_true(pose_apart(g.pose, lean, JOINTS) < 2e-6); /* the bind pose and all of the difference from it */
    assert_true(floats_apart(g.floats, floats, FLOATS) < 1e-6);
}

/* Clones that write one bone tree overwrite each other unless each is drawn before the
 * next is updated. Here a clone is one memcpy and its pose lies where its owner says. */
static void clones_share_nothing_they_write(void **state)
{
    stage g;
    ALIGNED uint8_t clone_memory[8192];
    noh_controller *clone = (noh_controller *)(void *)clone_memory;
    noh_transform shared_tree[JOINTS], a[JOINTS], b[JOINTS], want_a[JOINTS], want_b[JOINTS];
    float floats[FLOATS];
    (void)state;
    stage_open(&g, 2, NOH_CONTROLLER_INERTIAL);
    start(&g, 0, track_of(WALK, 1.0f));
    step(&g, 5000);
    memcpy(clone, g.c, g.c->bytes);
    step(&g, 1000);
    noh_controller_step(clone, &g.s.set, 9000, NULL, NULL);
    scene_pose(&g.s, WALK, 6000, want_a, floats);
    scene_pose(&g.s, WALK, 14000, want_b, floats);
    /* the source: update all, then draw all, from one tree */
    noh_controller_pose(g.c, &g.s.set, &g.scratch, shared_tree, g.floats);
    noh_controller_pose(clone, &g.s.set, &g.scratch, shared_tree, g.floats);
    assert_true(pose_apart(shared_tree, want_a, JOINTS) > 0.1);
    noh_controller_pose(g.c, &g.s.set, &g.scratch, a, g.floats);
    noh_controller_pose(clone, &g.s.set, &g.scratch, b, g.floats);
    assert_true(pose_apart(a, want_a, JOINTS) < 1e-6 && pose_apart(b, want_b, JOINTS) < 1e-6);
}

/* Saved and restored by memcpy, an instance continues with the same bits, changes included. */
static void a_snapshot_continues_with_the_same_bits(void **state)
{
    stage g;
    static ALIGNED uint8_t saved[8192];
    noh_change_desc d = change_of(NOH_CHANGE_SPEED, 30000);
    noh_transform first[JOINTS];
    (void)state;
    stage_open(&g, 3, NOH_CONTROLLER_INERTIAL);
    start(&g, 0, track_of(WALK, 1.0f));
    start(&g, 1, track_of(RUN, 0.4f));
    d.speed = 5 * NOH_SPEED_ONE;
    change(&g, d);
    step(&g, 1234);
    memcpy(saved, g.c, g.c->bytes);
    for (int i = 0; i < 100; i++) step(&g, 801);
    take_pose(&g);
    memcpy(first, g.pose, sizeof first);
    memcpy(g.c, saved, g.c->bytes);
    for (int i = 0; i < 801; i++) step(&g, 100);
    take_pose(&g);
    assert_memory_equal(first, g.pose, sizeof first);
}

/* ---- transitions ---- */

static void offsets_decay_without_overshoot(void **state)
{
    (void)state;
    for (int v = 0; v < 40; v++) {
        float v0 = -(float)v * 0.5f, before = 1.0f;
        for (int i = 0; i <= 1000; i++) {
            float x = noh_inertia_decay(1.0f, v0, 0.3f * (float)i / 1000.0f, 0.3f);
            assert_true(x >= 0.0f && x <= before + 1e-6f); /* never grows, never overshoots */
            before = x;
        }
        /* it starts with its speed and ends without any */
        assert_true(fabsf((noh_inertia_decay(1.0f, v0, 1e-3f, 0.3f) - 1.0f) / 1e-3f - v0) <
                    0.8f + 0.03f * fabsf(v0) * fabsf(v0));
        assert_true(noh_inertia_decay(1.0f, v0, 0.299f, 0.3f) < 1e-4f);
    }
    assert_true(noh_inertia_decay(1.0f, 0.0f, 0.0f, 0.3f) == 1.0f);
    assert_true(noh_inertia_decay(1.0f, 0.0f, 0.3f, 0.3f) == 0.0f);
    assert_true(noh_inertia_decay(0.0f, 0.0f, 0.1f, 0.3f) == 0.0f);
    assert_true(noh_inertia_decay(NAN, 0.0f, 0.1f, 0.3f) == 0.0f);
}

/* The remaining offset of a transition at an earlier tick, computed now, is what it was then. */
static void inertia_some_ticks_ago(void **state)
{
    stage g;
    noh_transform then[JOINTS], now[JOINTS];
    float floats_then[FLOATS], floats_now[FLOATS];
    (void)state;
    stage_open(&g, 2, NOH_CONTROLLER_INERTIAL);
    start(&g, 0, track_of(WALK, 1.0f));
    step(&g, 20000);
    assert_int_equal(noh_controller_inertia_capture(g.c, &g.s.set, &g.scratch, NULL), NOH_OK);
    start(&g, 0, track_of(RUN, 1.0f));
    assert_int_equal(noh_controller_inertia_begin(g.c, &g.s.set, &g.scratch, 9600, NULL), NOH_OK);
    step(&g, 1000);
    memcpy(then, g.s.bind, sizeof then);
    memcpy(floats_then, g.s.defaults, sizeof floats_then);
    noh_controller_inertia_add(g.c, 0, then, floats_then);
    assert_true(pose_apart(then, g.s.bind, JOINTS) > 0.1);
    step(&g, 3000);
    memcpy(now, g.s.bind, sizeof now);
    memcpy(floats_now, g.s.defaults, sizeof floats_now);
    noh_controller_inertia_add(g.c, 3000, now, floats_now);
    assert_memory_equal(now, then, sizeof now);
    assert_memory_equal(floats_now, floats_then, sizeof floats_now);
}

static void an_inertial_transition_does_not_jump(void **state)
{
    stage g;
    noh_transform before[JOINTS], last[JOINTS], target[JOINTS];
    float floats[FLOATS];
    uint32_t samples;
    double largest = 0.0, jump;
    (void)state;
    stage_open(&g, 2, NOH_CONTROLLER_INERTIAL);
    start(&g, 0, track_of(WALK, 1.0f));
    step(&g, 20000);
    take_pose(&g);
    memcpy(before, g.pose, sizeof before);
    memcpy(floats, g.floats, sizeof floats);
    assert_int_equal(noh_controller_inertia_capture(g.c, &g.s.set, &g.scratch, NULL), NOH_OK);
    start(&g, 0, track_of(RUN, 1.0f));
    assert_int_equal(noh_controller_inertia_begin(g.c, &g.s.set, &g.scratch, 14400, NULL), NOH_OK);
    take_pose(&g);
    assert_true(pose_apart(g.pose, before, JOINTS) < 3e-6); /* no jump at the switch */
    assert_true(floats_apart(g.floats, floats, FLOATS) < 1e-6);
    memcpy(last, g.pose, sizeof last);
    for (int i = 0; i < 40; i++) {
        step(&g, 400);
        samples = g.s.samples;
        take_pose(&g);
        assert_int_equal(g.s.samples - samples, 1); /* the new clip alone is sampled */
        largest = fmax(largest, pose_apart(g.pose, last, JOINTS));
        memcpy(last, g.pose, sizeof last);
    }
    scene_pose(&g.s, RUN, 16000, target, floats);
    assert_memory_equal(&g.pose[3].translation, &target[3].translation, sizeof target[3].translation);
    assert_true(pose_apart(g.pose, target, JOINTS) < 1e-6); /* nothing is left */
    scene_pose(&g.s, RUN, 0, target, floats);
    jump = pose_apart(before, target, JOINTS);
    print_message("a cut would jump by %.3f; the largest step of 1/120 s was %.3f\n", jump, largest);
    assert_true(largest < 0.35 * jump);
}

static void a_transition_within_a_transition_does_not_jump(void **state)
{
    stage g;
    noh_transform before[JOINTS];
    noh_error error;
    (void)state;
    stage_open(&g, 2, NOH_CONTROLLER_INERTIAL);
    start(&g, 0, track_of(WALK, 1.0f));
    for (uint32_t i = 0; i < 10; i++) {
        step(&g, 2000);
        take_pose(&g);
        memcpy(before, g.pose, sizeof before);
        assert_int_equal(noh_controller_inertia_capture(g.c, &g.s.set, &g.scratch, NULL), NOH_OK);
        start(&g, 0, track_of(i % 3u, 1.0f));
        assert_int_equal(noh_controller_inertia_begin(g.c, &g.s.set, &g.scratch, 14400, NULL), NOH_OK);
        take_pose(&g);
        assert_true(pose_apart(g.pose, before, JOINTS) < 1e-5);
    }
    assert_int_equal(noh_controller_inertia_begin(g.c, &g.s.set, &g.scratch, 0, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, "duration_ticks", strlen("duration_ticks")), 0);
    stage_open(&g, 2, 0);
    assert_int_equal(noh_controller_inertia_capture(g.c, &g.s.set, &g.scratch, &error), NOH_ERR_ARG);
    stage_open(&g, 2, NOH_CONTROLLER_INERTIAL);
    assert_int_equal(noh_pose_scratch_init(g.scratch_memory, sizeof g.scratch_memory, &g.s.set, 0, &g.scratch, NULL),
                     NOH_OK);
    assert_int_equal(noh_controller_inertia_capture(g.c, &g.s.set, &g.scratch, &error), NOH_ERR_ARG);
}

/* ---- a callback that changes the controller ---- */

typedef struct handler {
    stage *g;
    int64_t fired_at, restarted_at;
} handler;

/* ---- blocks from outside ---- */

/* A controller with everything on: fades, a travel, a sync group, a transition. */
static void busy_open(stage *g)
{
    noh_change_desc d;
    stage_open(g, 4, NOH_CONTROLLER_INERTIAL);
    start_synced(g, 0, WALK, 1.0f);
    start_synced(g, 1, RUN, 0.5f);
    start(g, 2, (noh_track_desc){ .clip = JUMP, .group = NOH_GROUP_HIGH, .mask = 2 });
    start(g, 3, (noh_track_desc){ .clip = WAVE, .flags = NOH_TRACK_ADDITIVE, .weight = 0.3f });
    memset(&d, 0, sizeof d);
    d.kind = NOH_CHANGE_WEIGHT, d.track = 1, d.weight = 0.1f, d.duration_ticks = 9000, change(g, d);
    d.kind = NOH_CHANGE_POSITION, d.track = 3, d.position_ticks = 90000, change(g, d);
    d.kind = NOH_CHANGE_SPEED, d.track = 2, d.speed = 2 * NOH_SPEED_ONE, d.delay_ticks = 700, change(g, d);
    assert_int_equal(noh_controller_inertia_capture(g->c, &g->s.set, &g->scratch, NULL), NOH_OK);
    start(g, 3, (noh_track_desc){ .clip = LEAN, .flags = NOH_TRACK_ADDITIVE, .weight = 0.6f });
    assert_int_equal(noh_controller_inertia_begin(g->c, &g->s.set, &g->scratch, 4000, NULL), NOH_OK);
    step(g, 1234);
}

static void check_accepts_what_a_step_leaves(void **state)
{
    stage g;
    noh_error error;
    (void)state;
    busy_open(&g);
    for (int i = 0; i < 300; i++) {
        step(&g, (uint32_t)(i * i));
        assert_int_equal(noh_controller_check(g.c, g.c->bytes, &g.s.set, NULL), NOH_OK);
    }
    assert_int_equal(noh_controller_check(g.c, g.c->bytes - 1u, &g.s.set, &error), NOH_ERR_DATA);
    assert_int_equal(noh_controller_check(g.c, sizeof *g.c - 1u, &g.s.set, &error), NOH_ERR_DATA);
    assert_int_equal(noh_controller_check(g.memory + NOH_MEMORY_ALIGN / 2, g.c->bytes, &g.s.set, &error), NOH_ERR_ARG);
    assert_int_equal(noh_controller_check(NULL, 0, &g.s.set, &error), NOH_ERR_ARG);
    g.s.set.mask_count--;
    assert_int_equal(noh_controller_check(g.c, g.c->bytes, &g.s.set, &error), NOH_ERR_DATA);
    assert_int_equal(strncmp(error.what, "controller: made for another set", 32), 0);
}

/* Damage to the head, tracks or changes is refused, or does no harm. */
static void damaged_blocks_do_no_harm(void **state)
{
    static stage g, kept;
    noh_error error;
    uint32_t seed = 11, refused = 0, taken = 0, head_bytes;
    (void)state;
    test_skip_emulated("thousands of damaged blocks");
    busy_open(&g);
    kept = g;
    head_bytes = g.c->inertia_offset;
    for (int round = 0; round < 20000; round++) {
        memcpy(g.memory, kept.memory, sizeof g.memory);
        for (int k = 0; k < 1 + round % 3; k++) {
            uint32_t at;
            seed = seed * 1664525u + 1013904223u;
            at = (seed >> 8) % head_bytes;
            seed = seed * 1664525u + 1013904223u;
            g.memory[at] = (uint8_t)(round % 2 ? seed >> 24 : g.memory[at] ^ (1u << (seed >> 29)));
        }
        g.c->flags &= 1u; /* not as if called back */
        if (noh_controller_check(g.memory, sizeof g.memory, &g.s.set, NULL) != NOH_OK) {
            refused++;
            continue;
        }
        taken++;
        for (int k = 0; k < 3; k++) {
            step(&g, 700);
            take_pose(&g);
            (void)noh_controller_inertia_capture(g.c, &g.s.set, &g.scratch, NULL);
            if (noh_controller_check(g.memory, sizeof g.memory, &g.s.set, &error) != NOH_OK)
                fail_msg("round %d: %s (%u)", round, error.what, (unsigned)error.where);
        }
    }
    print_message("%u damaged blocks refused, %u played\n", refused, taken);
    assert_true(refused > 1000 && taken > 1000);
}

/* A seek that fires moves any distance in one tick; a transition after it still finds what was shown 10 ms before. */
static void a_pose_before_a_far_seek(void **state)
{
    stage g;
    (void)state;
    stage_open(&g, 1, NOH_CONTROLLER_INERTIAL);
    start(&g, 0, track_of(RUN, 1.0f));
    assert_int_equal(noh_controller_seek(g.c, &g.s.set, 0, (int64_t)1 << 43, NOH_SEEK_FIRE, NULL), NOH_OK);
    step(&g, 1);
    assert_int_equal(noh_controller_inertia_capture(g.c, &g.s.set, &g.scratch, NULL), NOH_OK);
    assert_int_equal(noh_controller_inertia_begin(g.c, &g.s.set, &g.scratch, 4000, NULL), NOH_OK);
    take_pose(&g);
}

static void restart_other(void *user, const noh_event *e)
{
    handler *h = user;
    if (e->track == 0) {
        noh_track_desc d = track_of(RUN, 1.0f);
        h->fired_at = e->clock;
        assert_int_equal(noh_controller_start(h->g->c, &h->g->s.set, 1, &d, NULL), NOH_OK);
    } else if (h->restarted_at == 0) {
        h->restarted_at = e->clock;
    }
}

static void a_callback_may_start_a_track_within_the_step(void **state)
{
    stage g;
    handler h = { NULL, 0, 0 };
    (void)state;
    stage_open(&g, 2, 0);
    h.g = &g;
    g.s.clips[WALK].event_count = 1;
    g.s.events[0].tick = 1000;
    g.s.clips[RUN].first_event = 1;
    g.s.clips[RUN].event_count = 1;
    g.s.events[1].tick = 300;
    start(&g, 0, track_of(WALK, 1.0f));
    assert_int_equal(noh_controller_step(g.c, &g.s.set, 5000, restart_other, &h), 2);
    assert_int_equal(h.fired_at, 1000);
    assert_int_equal(h.restarted_at, 1300);
    assert_int_equal(noh_controller_track(g.c, 1)->position, noh_position_of(4000));
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(set_fields_broken_in_turn),
        cmocka_unit_test(controller_desc_fields_broken_in_turn),
        cmocka_unit_test(memory_is_exact),
        cmocka_unit_test(scratch_memory_is_exact),
        cmocka_unit_test(state_is_small),
        cmocka_unit_test(track_desc_fields_broken_in_turn),
        cmocka_unit_test(setters_refuse_bad_values),
        cmocka_unit_test(time_functions_follow_their_loop_modes),
        cmocka_unit_test(time_does_not_drift),
        cmocka_unit_test(ended_tracks_are_known),
        cmocka_unit_test(change_fields_broken_in_turn),
        cmocka_unit_test(a_weight_follows_its_curve),
        cmocka_unit_test(a_speed_change_moves_by_the_integral),
        cmocka_unit_test(a_position_change_arrives_exactly),
        cmocka_unit_test(a_cross_fade_is_the_blend_of_both),
        cmocka_unit_test(tracks_keep_in_step_by_markers_and_by_phase),
        cmocka_unit_test(clips_with_other_markers_are_not_synced),
        cmocka_unit_test(one_track_shows_its_clip),
        cmocka_unit_test(priority_is_the_blend_group),
        cmocka_unit_test(a_masked_track_covers_by_its_mask),
        cmocka_unit_test(the_high_group_covers_what_nothing_lies_below),
        cmocka_unit_test(weights_below_one_cover_in_part),
        cmocka_unit_test(a_masked_track_alone_leaves_the_bind_pose),
        cmocka_unit_test(clips_of_joints_and_of_floats_do_not_mix),
        cmocka_unit_test(clips_of_joints_and_of_floats_do_not_mix_in_the_high_group),
        cmocka_unit_test(a_masked_track_leaves_others_their_joints),
        cmocka_unit_test(tracks_count_by_weight),
        cmocka_unit_test(lod_levels_leave_out_tracks_and_joints),
        cmocka_unit_test(additive_tracks_add_differences),
        cmocka_unit_test(an_additive_track_alone_lies_over_the_bind_pose),
        cmocka_unit_test(clones_share_nothing_they_write),
        cmocka_unit_test(a_snapshot_continues_with_the_same_bits),
        cmocka_unit_test(offsets_decay_without_overshoot),
        cmocka_unit_test(inertia_some_ticks_ago),
        cmocka_unit_test(an_inertial_transition_does_not_jump),
        cmocka_unit_test(a_transition_within_a_transition_does_not_jump),
        cmocka_unit_test(a_callback_may_start_a_track_within_the_step),
        cmocka_unit_test(check_accepts_what_a_step_leaves),
        cmocka_unit_test(damaged_blocks_do_no_harm),
        cmocka_unit_test(a_pose_before_a_far_seek),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
