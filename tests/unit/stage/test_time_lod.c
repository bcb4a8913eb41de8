/* Tests of time_lod.c, time_lod_measure.c: updates that are even, mixes that are smooth and right. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/clip_set_fixture.h"
#include "core/base/math_internal.h"
#include "support/raw_play.h"
#include "motion/anim/tracks_internal.h"
#include "stage/character/measure_internal.h"
#include "stage/character/time_lod_internal.h"
#include "noh/base.h"
#include "noh/low_stage.h"

/* ---- evenness ---- */

#define CROWD 1000u

typedef struct load {
    double mean, worst; /* of a frame */
    double per_second;
} load;

/* Updates per frame over ten seconds, without the first one. rates[CROWD]; frames of `ticks`, give or take `jitter`. */
static load run_crowd(const uint8_t *rates, uint32_t ticks, uint32_t jitter)
{
    static noh_time_lod crowd[CROWD];
    test_random r = test_random_from(21);
    load l = { 0.0, 0.0, 0.0 };
    uint32_t frames = 0;
    int64_t clock;
    for (uint32_t i = 0; i < CROWD; i++) noh_time_lod_init(&crowd[i], i);
    for (clock = 0; clock < 480000; clock += ticks - jitter + test_random_below(&r, 2u * jitter + 1u)) {
        uint32_t updates = 0;
        for (uint32_t i = 0; i < CROWD; i++) {
            noh_time_lod_frame(&crowd[i], clock, (noh_update_rate)rates[i]);
            if (noh_time_lod_due(&crowd[i]) != NOH_DUE_NOT) {
                noh_time_lod_update(&crowd[i]);
                updates++;
            }
        }
        if (clock >= 48000) {
            l.mean += updates;
            l.worst = fmax(l.worst, updates);
            frames++;
        }
    }
    l.per_second = l.mean * 48000.0 / (double)(clock - 48000);
    l.mean /= frames;
    return l;
}

static void updates_are_spread_evenly(void **state)
{
    static const uint32_t frame_ticks[] = { 400, 533, 800 }; /* 120, 90, 60 Hz */
    test_random r = test_random_from(22);
    uint8_t rates[CROWD];
    (void)state;
    for (int kind = 0; kind <= 5; kind++) {
        for (uint32_t i = 0; i < CROWD; i++) {
            float distance = 100.0f *
                             sqrtf(test_random_float(&r, 0.0f, 1.0f)); /* kind 4: scattered over a disc; 5: in rows */
            distance = kind == 5 ? 0.1f * (float)i : distance;
            rates[i] = (uint8_t)(kind <= 3          ? kind
                                 : distance < 15.0f ? 0
                                 : distance < 30.0f ? 1
                                 : distance < 60.0f ? 2
                                                    : 3);
        }
        for (uint32_t f = 0; f < 3; f++) {
            load l = run_crowd(rates, frame_ticks[f], 0);
            print_message("crowd %d, frames of %u ticks: %.1f updates, at worst %.3f of the mean\n", kind,
                          frame_ticks[f], l.mean, l.worst / l.mean);
            assert_true(l.worst <= 1.2 * l.mean);
        }
    }
}

/* Uneven frames cause no extra updates: exactly those whose tick falls into a frame are due. */
static void uneven_frames_lose_no_updates(void **state)
{
    uint8_t rates[CROWD];
    (void)state;
    memset(rates, NOH_UPDATE_RATE_15, sizeof rates);
    for (uint32_t jitter = 0; jitter <= 300; jitter += 100) {
        load l = run_crowd(rates, 800, jitter);
        assert_true(fabs(l.per_second - 15.0 * CROWD) < 0.01 * 15.0 * CROWD);
    }
}

/* ---- what is shown, on a line ---- */

/* One number instead of a pose: the same states and mixes as a character's. */
typedef struct line {
    noh_time_lod t;
    double value[2];
} line;

static double wave(double tick, double kind)
{
    return sin(tick / 7000.0 + kind) + 0.3 * sin(tick / 3100.0 + 2.0 * kind);
}
#define WAVE_SPEED (1.0 / 7000.0 + 0.3 / 3100.0)
#define WAVE_BEND (1.0 / (7000.0 * 7000.0) + 0.3 / (3100.0 * 3100.0))

static double shown(const line *l)
{
    double part = (double)noh_time_lod_fraction(&l->t);
    return l->value[l->t.to_pose ^ 1u] * (1.0 - part) + l->value[l->t.to_pose] * part;
}

static void update(line *l, double kind)
{
    noh_time_update u = noh_time_lod_update(&l->t);
    uint32_t other = u.pose ^ 1u;
    if (u.keep < 1.0f) l->value[other] = l->value[other] * (1.0 - (double)u.keep) + l->value[u.pose] * (double)u.keep;
    l->value[u.pose] = wave((double)u.pose_clock, kind);
}

/* Updated on time the error is the interpolation's, h^2 / 8 times the second derivative, and what is
 * shown at an update is true; rates change at random. */
static void updates_on_time_have_the_error_of_interpolation(void **state)
{
    test_random r = test_random_from(23);
    noh_update_rate rate = NOH_UPDATE_RATE_8;
    double worst[NOH_UPDATE_RATE_COUNT] = { 0.0 }, last = 0.0;
    int64_t clock = 12345;
    uint32_t period = 6000;
    line l = { .value = { 0.0, 0.0 } };
    (void)state;
    noh_time_lod_init(&l.t, 77);
    for (int frame = 0; frame < 200000; frame++) {
        int64_t ticks = 200 + test_random_below(&r, 1000);
        double now, error;
        clock += ticks;
        if (test_random_below(&r, 200) == 0) rate = (noh_update_rate)test_random_below(&r, NOH_UPDATE_RATE_COUNT);
        noh_time_lod_frame(&l.t, clock, rate);
        if (noh_time_lod_due(&l.t) != NOH_DUE_NOT) update(&l, 0.0);
        assert_int_equal(noh_time_lod_due(&l.t), NOH_DUE_NOT);
        now = shown(&l);
        error = fabs(now - wave((double)clock, 0.0));
        /* a mix at a finer rate may begin with the error of the coarser rate before it */
        period = noh_update_period((noh_update_rate)l.t.shown_rate) < period
                     ? period
                     : noh_update_period((noh_update_rate)l.t.shown_rate);
        assert_true(error <= WAVE_BEND * (double)period * (double)period / 8.0 + 1e-6);
        if (l.t.to_clock - l.t.from_clock == (int64_t)noh_update_period((noh_update_rate)l.t.shown_rate)) {
            worst[l.t.shown_rate] = fmax(worst[l.t.shown_rate], error);
            period = noh_update_period((noh_update_rate)l.t.shown_rate);
        }
        if (frame)
            assert_true(fabs(now - last) <= WAVE_SPEED * (double)ticks * 1.01 + WAVE_BEND * 6000.0 * 6000.0 / 4.0);
        last = now;
    }
    print_message("largest errors at full rate, 30, 15, 8 Hz: %g %g %g %g\n", worst[0], worst[1], worst[2], worst[3]);
    assert_true(worst[0] == 0.0 && worst[1] > 0.0 && worst[1] < worst[2] && worst[2] < worst[3]);
}

/* Frames between the last two steps of a game: what is shown has the error of interpolation between steps or, where
 * those are longer, updates; and no update poses what the controller has left behind. */
static void frames_between_steps_have_the_error_of_interpolation(void **state)
{
    test_random r = test_random_from(26);
    noh_update_rate rate = NOH_UPDATE_RATE_FULL;
    int64_t shown_clock = 5000, clock = 4800, span = 0;
    double worst[NOH_UPDATE_RATE_COUNT] = { 0.0 };
    line l = { .value = { 0.0, 0.0 } };
    (void)state;
    noh_time_lod_init(&l.t, 31);
    for (int frame = 0; frame < 200000; frame++) {
        const int64_t end = l.t.to_clock;
        double error;
        shown_clock += 200 + test_random_below(&r, 1000);
        while (clock < shown_clock) clock += 1600;
        if (test_random_below(&r, 200) == 0) rate = (noh_update_rate)test_random_below(&r, NOH_UPDATE_RATE_COUNT);
        l.t.behind_ticks = (uint32_t)(clock - shown_clock);
        noh_time_lod_frame(&l.t, clock, rate);
        if (noh_time_lod_due(&l.t) != NOH_DUE_NOT) {
            update(&l, 0.0);
            assert_true(l.t.to_clock >= clock);
            span = l.t.from_clock == end ? l.t.to_clock - end : 6000; /* else it begins with the error of a mix */
        }
        if (l.t.from_clock == l.t.to_clock && shown_clock < clock) continue; /* the first ones show the step itself */
        error = fabs(shown(&l) - wave((double)shown_clock, 0.0));
        if (error > WAVE_BEND * (double)span * (double)span / 8.0 + 1e-6)
            fail_msg("frame %d: off by %g in a span of %d", frame, error, (int)span);
        if (span < 6000 || l.t.shown_rate == NOH_UPDATE_RATE_8)
            worst[l.t.shown_rate] = fmax(worst[l.t.shown_rate], error);
        if (l.t.from_clock < shown_clock && shown_clock == l.t.to_clock) assert_true(error < 1e-6);
    }
    print_message("largest errors between steps at 30 Hz, at full rate, 30, 15, 8 Hz: %g %g %g %g\n", worst[0],
                  worst[1], worst[2], worst[3]);
    assert_true(worst[0] > 0.0 && worst[0] < worst[2] && worst[2] < worst[3]);
}

/* Late updates, which hold the last pose, and random changes: what is shown takes at least half a period to radius the
 * new state, however far that is, moves as the true pose does when nothing changes, and returns to it. */
static void late_updates_and_changes_never_jump(void **state)
{
    test_random r = test_random_from(24);
    double kind = 0.0, last = 0.0;
    int64_t clock = 0, changed = 0;
    line l = { .value = { 0.0, 0.0 } };
    (void)state;
    noh_time_lod_init(&l.t, 5);
    noh_time_lod_frame(&l.t, 0, NOH_UPDATE_RATE_8);
    update(&l, kind);
    last = shown(&l);
    for (int frame = 1; frame < 100000; frame++) {
        int late = frame / 500 % 2; /* every second 500 frames are short of budget */
        clock += 800;
        if (test_random_below(&r, 300) == 0) {
            kind += 1.0;
            changed = clock;
            noh_time_lod_wake(&l.t);
        }
        noh_time_lod_frame(&l.t, clock, NOH_UPDATE_RATE_8);
        if (noh_time_lod_due(&l.t) != NOH_DUE_NOT && (!late || test_random_below(&r, 20) == 0)) update(&l, kind);
        assert_true(noh_time_lod_due(&l.t) == NOH_DUE_NOT || noh_time_lod_late(&l.t) <= clock);
        assert_true(fabs(shown(&l) - last) <= 2.6 * 800.0 / 3000.0 + 1e-6);
        assert_true(fabs(shown(&l) - last) <= WAVE_SPEED * 800.0 * 1.01 || late || frame % 500 < 20 ||
                    clock - changed <= 13000);
        last = shown(&l);
        if (!late && frame % 500 > 20 && clock - changed > 13000) {
            assert_true(fabs(last - wave((double)clock, kind)) <= WAVE_BEND * 6000.0 * 6000.0 / 8.0 + 1e-6);
        }
    }
}

static void unseen_for_long_is_posed_at_once(void **state)
{
    line l = { .value = { 0.0, 0.0 } };
    (void)state;
    noh_time_lod_init(&l.t, 9);
    noh_time_lod_frame(&l.t, 100, NOH_UPDATE_RATE_15);
    assert_int_equal(noh_time_lod_due(&l.t), NOH_DUE_AT_ONCE);
    assert_int_equal(noh_time_lod_late(&l.t), 0);
    update(&l, 0.0);
    assert_true(shown(&l) == wave(100.0, 0.0));
    noh_time_lod_frame(&l.t, 900, NOH_UPDATE_RATE_15);
    assert_int_equal(noh_time_lod_due(&l.t), NOH_DUE);
    update(&l, 0.0);
    noh_time_lod_frame(&l.t, 1000000, NOH_UPDATE_RATE_15);
    assert_int_equal(noh_time_lod_due(&l.t), NOH_DUE_AT_ONCE);
    update(&l, 0.0);
    assert_true(shown(&l) == wave(1000000.0, 0.0));
}

/* A finer rate does not wait for the end of the mix that is shown; a coarser one does. */
static void a_finer_rate_begins_at_once(void **state)
{
    line l = { .value = { 0.0, 0.0 } };
    double before;
    (void)state;
    noh_time_lod_init(&l.t, 4);
    noh_time_lod_frame(&l.t, 0, NOH_UPDATE_RATE_8);
    update(&l, 0.0);
    noh_time_lod_frame(&l.t, 800, NOH_UPDATE_RATE_8);
    update(&l, 0.0);
    assert_true(l.t.to_clock >= 2400);
    noh_time_lod_frame(&l.t, 1200, NOH_UPDATE_RATE_8);
    assert_int_equal(noh_time_lod_due(&l.t), NOH_DUE_NOT);
    noh_time_lod_frame(&l.t, 1600, NOH_UPDATE_RATE_30);
    assert_int_equal(noh_time_lod_due(&l.t), NOH_DUE);
    before = shown(&l);
    update(&l, 0.0);
    assert_true(fabs(shown(&l) - before) < 1e-6);
    assert_true(l.t.to_clock <= 1600 + 1600 && l.t.from_clock == 1600);
    noh_time_lod_frame(&l.t, 1700, NOH_UPDATE_RATE_15);
    assert_int_equal(noh_time_lod_due(&l.t), NOH_DUE_NOT);
    noh_time_lod_frame(&l.t, 1800, NOH_UPDATE_RATE_FULL);
    assert_int_equal(noh_time_lod_due(&l.t), NOH_DUE);
    update(&l, 0.0);
    assert_true(shown(&l) == wave(1800.0, 0.0));
}

/* Clocks that jump between the ends of their range: nothing overflows, what is shown stays between two poses. */
static void clocks_at_the_ends(void **state)
{
    static const int64_t clocks[] = { 0,         INT64_MAX - 3000, INT64_MAX - 2200, INT64_MAX - 800,
                                      INT64_MAX, INT64_MAX,        INT64_MIN,        INT64_MIN + 800,
                                      -1,        INT64_MAX };
    (void)state;
    for (uint32_t instance = 0; instance < 50; instance++) {
        noh_time_lod t;
        noh_time_lod_init(&t, instance);
        for (uint32_t i = 0; i < sizeof clocks / sizeof *clocks; i++) {
            noh_time_lod_frame(&t, clocks[i], NOH_UPDATE_RATE_8);
            assert_true(noh_time_lod_late(&t) == 0 || clocks[i] > t.due_clock);
            if (noh_time_lod_due(&t) != NOH_DUE_NOT) {
                const noh_time_update u = noh_time_lod_update(&t);
                assert_true(u.pose_clock >= clocks[i] && u.keep >= 0.0f && u.keep <= 1.0f);
            }
            assert_true(noh_time_lod_fraction(&t) >= 0.0f && noh_time_lod_fraction(&t) <= 1.0f);
            noh_time_lod_wake(&t);
        }
    }
}

/* Ten frames a second at 30 and at 15 Hz: every frame is exact. */
static void frames_longer_than_a_period_are_exact(void **state)
{
    line l = { .value = { 0.0, 0.0 } };
    (void)state;
    noh_time_lod_init(&l.t, 3);
    for (int64_t clock = 0; clock < 480000; clock += 4800) {
        noh_time_lod_frame(&l.t, clock, clock % 9600 ? NOH_UPDATE_RATE_30 : NOH_UPDATE_RATE_15);
        assert_true(noh_time_lod_due(&l.t) != NOH_DUE_NOT);
        update(&l, 0.0);
        assert_true(shown(&l) == wave((double)clock, 0.0));
    }
}

/* ---- measuring ---- */

/* A joint that makes one full turn in its clip, with a vertex at its radius, and a float that is a parabola. */
typedef struct turning {
    noh_clip_set set;
    noh_clip_entry clip;
    noh_transform bind;
    noh_skeleton skeleton;
    uint16_t parent;
    float radius, scalar_radius;
    noh_time_probe probe;
} turning;

static void sample_turning(void *user, uint32_t clip, uint32_t tick, uint32_t joints, noh_transform *pose,
                           uint32_t floats, float *values)
{
    const turning *t = user;
    double part = (double)tick / (double)t->clip.duration_ticks;
    float v[3] = { 0.0f, 0.0f, (float)(TWO_PI * part) };
    (void)clip, (void)joints;
    pose[0] = t->bind;
    noh_quat_from_rotation(v, pose[0].rotation);
    if (floats) values[0] = (float)(part * part);
}

static void turning_open(turning *t)
{
    memset(t, 0, sizeof *t);
    t->bind.rotation[3] = t->bind.scale[0] = t->bind.scale[1] = t->bind.scale[2] = 1.0f;
    t->parent = NOH_JOINT_ROOT;
    t->skeleton.joint_count = 1;
    t->skeleton.parents = &t->parent;
    t->skeleton.bind_pose = &t->bind;
    t->clip.duration_ticks = 96000;
    t->clip.loop = NOH_LOOP_REPEAT;
    t->set.clip_count = t->set.joint_count = 1;
    t->set.clips = &t->clip;
    t->set.bind_pose = &t->bind;
    t->set.sample = sample_turning;
    t->set.user = t;
    t->radius = 0.5f;
    t->scalar_radius = 0.01f;
    t->probe.set = &t->set;
    t->probe.skeleton = &t->skeleton;
    t->probe.joint_radius_m = &t->radius;
}

static void a_turn_has_the_error_of_its_sagitta(void **state)
{
    ALIGNED uint8_t memory[1024];
    float errors[NOH_UPDATE_RATE_COUNT];
    turning t;
    (void)state;
    turning_open(&t);
    assert_int_equal(noh_time_lod_measure(memory, sizeof memory, &t.probe, 0, errors, NULL), NOH_OK);
    assert_true(errors[0] == 0.0f);
    for (int r = 1; r < NOH_UPDATE_RATE_COUNT; r++) {
        double angle = TWO_PI * noh_update_period((noh_update_rate)r) / 96000.0, arrow = 0.5 * (1.0 - cos(angle / 2.0));
        assert_true(errors[r] >= arrow * 0.999 && errors[r] <= arrow * 1.15);
    }
    t.radius = -1.0f; /* it moves no vertex */
    assert_int_equal(noh_time_lod_measure(memory, sizeof memory, &t.probe, 0, errors, NULL), NOH_OK);
    for (int r = 0; r < NOH_UPDATE_RATE_COUNT; r++) assert_true(errors[r] == 0.0f);
    t.set.float_count = 1;
    t.clip.loop = NOH_LOOP_ONCE;
    t.probe.float_radius_m = &t.scalar_radius;
    assert_int_equal(noh_time_lod_measure(memory, sizeof memory, &t.probe, 0, errors, NULL), NOH_OK);
    for (int r = 1; r < NOH_UPDATE_RATE_COUNT; r++) {
        double h = noh_update_period((noh_update_rate)r) / 96000.0, inside = 0.01 * h * h / 4.0,
               at_the_end = 0.01 * 2.0 * h;
        assert_true(errors[r] >= inside * 0.999 &&
                    errors[r] <= at_the_end); /* its motion has a corner where it stops */
    }
}

/* A mix cuts a point's arc short by its sagitta: points on the axis have no error, and the error of a point with two
 * joints lies between its errors with each alone. */
static void points_have_the_errors_of_their_own_sagittas(void **state)
{
    ALIGNED uint8_t memory[1024];
    const noh_time_hold out = { 0, 1.0f, { 0.3f, 0.4f, 7.0f } }, none = { 5, 0.0f, { 0.0f, 0.0f, 0.0f } },
                        axis = { 0, 1.0f, { 0.0f, 0.0f, 7.0f } };
    const noh_time_hold wrong = { 5, 1.0f, { 0.0f, 0.0f, 0.0f } }, half = { 0, 0.5f, { 0.3f, 0.4f, 7.0f } },
                        other_half = { 0, 0.5f, { 0.0f, 0.0f, 7.0f } };
    const noh_time_hold holds[6] = { axis, none, out, none, half, other_half };
    noh_time_lod_points points = { holds + 2, 1, 2 };
    float errors[NOH_UPDATE_RATE_COUNT], halves[NOH_UPDATE_RATE_COUNT];
    noh_error error;
    turning t;
    (void)state;
    turning_open(&t);
    t.probe.joint_radius_m = NULL;
    assert_int_equal(noh_time_lod_points_measure(memory, sizeof memory, &t.probe, &points, 0, errors, NULL), NOH_OK);
    points.holds = holds + 4;
    assert_int_equal(noh_time_lod_points_measure(memory, sizeof memory, &t.probe, &points, 0, halves, NULL), NOH_OK);
    for (int r = 1; r < NOH_UPDATE_RATE_COUNT; r++) {
        double angle = TWO_PI * noh_update_period((noh_update_rate)r) / 96000.0, arrow = 0.5 * (1.0 - cos(angle / 2.0));
        assert_true(fabs((double)errors[r] - arrow) <= 0.001 * arrow + 1e-6);
        assert_true(fabs((double)halves[r] - 0.5 * arrow) <= 0.001 * arrow + 1e-6);
    }
    points.holds = holds;
    assert_int_equal(noh_time_lod_points_measure(memory, sizeof memory, &t.probe, &points, 0, halves, NULL), NOH_OK);
    for (int r = 0; r < NOH_UPDATE_RATE_COUNT; r++) assert_true(halves[r] < 1e-5f);
    points.point_count = 3; /* the worst counts */
    assert_int_equal(noh_time_lod_points_measure(memory, sizeof memory, &t.probe, &points, 0, halves, NULL), NOH_OK);
    assert_memory_equal(halves, errors, sizeof errors);
    points.point_count = 0;
    assert_int_equal(noh_time_lod_points_measure(memory, sizeof memory, &t.probe, &points, 0, errors, &error),
                     NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, "points", strlen("points")), 0);
    points.point_count = 1;
    points.holds = &wrong;
    points.holds_per_point = 1;
    assert_int_equal(noh_time_lod_points_measure(memory, sizeof memory, &t.probe, &points, 0, errors, &error),
                     NOH_ERR_ARG);
    assert_int_equal(
        strncmp(error.what, "points: a joint is not in the skeleton", strlen("points: a joint is not in the skeleton")),
        0);
}

static void sample_walk(void *user, uint32_t clip, uint32_t tick, uint32_t joints, noh_transform *pose, uint32_t floats,
                        float *values)
{
    const turning *t = user;
    sample_turning(user, clip, tick, joints, pose, floats, values);
    pose[0].translation[0] = 3.0f * (float)tick / (float)t->clip.duration_ticks;
}

/* A loop that walks as it turns has the errors of one that turns on the spot when the probe travels; else the error of
 * its jump back. */
static void points_follow_a_loop_that_travels(void **state)
{
    ALIGNED uint8_t memory[1024];
    const noh_time_hold out = { 0, 1.0f, { 0.3f, 0.4f, 7.0f } };
    const noh_time_lod_points points = { &out, 1, 1 };
    float still[NOH_UPDATE_RATE_COUNT], walked[NOH_UPDATE_RATE_COUNT], leapt[NOH_UPDATE_RATE_COUNT];
    turning t;
    (void)state;
    turning_open(&t);
    assert_int_equal(noh_time_lod_points_measure(memory, sizeof memory, &t.probe, &points, 0, still, NULL), NOH_OK);
    t.set.sample = sample_walk;
    assert_int_equal(noh_time_lod_points_measure(memory, sizeof memory, &t.probe, &points, 0, leapt, NULL), NOH_OK);
    t.probe.travels = 1;
    assert_int_equal(noh_time_lod_points_measure(memory, sizeof memory, &t.probe, &points, 0, walked, NULL), NOH_OK);
    assert_true(walked[0] == 0.0f);
    for (int r = 1; r < NOH_UPDATE_RATE_COUNT; r++) {
        assert_true(fabsf(walked[r] - still[r]) <= 0.001f * still[r] + 2e-6f);
        assert_true(leapt[r] > 1.4f); /* about half of three metres */
    }
}

static void measuring_checks_its_fields_and_its_memory(void **state)
{
    ALIGNED uint8_t memory[4096];
    float errors[NOH_UPDATE_RATE_COUNT];
    noh_error error;
    turning t;
    size_t size;
    (void)state;
    turning_open(&t);
    size = noh_time_lod_measure_size(&t.probe);
    memset(memory, 0xa5, sizeof memory);
    assert_int_equal(noh_time_lod_measure(memory, size - 1, &t.probe, 0, errors, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, size);
    assert_int_equal(noh_time_lod_measure(memory + 4, size, &t.probe, 0, errors, &error), NOH_ERR_ARG);
    assert_int_equal(noh_time_lod_measure(memory, size, &t.probe, 1, errors, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, "clip", strlen("clip")), 0);
    t.probe.joint_radius_m = NULL;
    assert_int_equal(noh_time_lod_measure(memory, size, &t.probe, 0, errors, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, "probe", strlen("probe")), 0);
    assert_int_equal(memory[0], 0xa5);
    t.probe.joint_radius_m = &t.radius;
    assert_int_equal(noh_time_lod_measure(memory, size, &t.probe, 0, errors, &error), NOH_OK);
    for (size_t i = size; i < sizeof memory; i++) assert_int_equal(memory[i], 0xa5);
}

static void errors_of_what_plays(void **state)
{
    ALIGNED uint8_t memory[8192];
    float errors[CLIPS][NOH_UPDATE_RATE_COUNT], out[NOH_UPDATE_RATE_COUNT];
    noh_controller_desc d;
    noh_controller *c;
    noh_track_desc track;
    scene s;
    (void)state;
    scene_open(&s);
    memset(&d, 0, sizeof d);
    d.set = &s.set;
    assert_int_equal(noh_controller_init(memory, sizeof memory, &d, &c, NULL), NOH_OK);
    for (uint32_t m = 0; m < CLIPS; m++) {
        for (uint32_t r = 0; r < NOH_UPDATE_RATE_COUNT; r++) errors[m][r] = (float)((m + 1u) * r);
    }
    noh_time_lod_error(c, errors[0], out);
    assert_true(out[3] == 0.0f);
    track = track_of(WALK, 1.0f);
    assert_int_equal(noh_controller_start(c, &s.set, 0, &track, NULL), NOH_OK);
    track = track_of(WAVE, 0.25f);
    assert_int_equal(noh_controller_start(c, &s.set, 1, &track, NULL), NOH_OK);
    noh_time_lod_error(c, errors[0], out);
    assert_true(out[0] == 0.0f && out[1] == 3.0f && out[3] == 9.0f); /* the wave's, however small its weight */
    assert_int_equal(noh_controller_set_speed(c, 0, -2 * NOH_SPEED_ONE), NOH_OK);
    noh_time_lod_error(c, errors[0], out);
    assert_true(out[2] == 8.0f); /* the walk's, four times */
    track = track_of(LEAN, 0.5f);
    track.flags = NOH_TRACK_ADDITIVE;
    assert_int_equal(noh_controller_start(c, &s.set, 2, &track, NULL), NOH_OK);
    noh_time_lod_error(c, errors[0], out);
    assert_true(out[2] == 8.0f + 0.5f * 8.0f);
    assert_int_equal(noh_controller_set_mode(c, 0, NOH_TRACK_TIME_ONLY), NOH_OK);
    noh_time_lod_error(c, errors[0], out);
    assert_true(out[2] == 6.0f + 4.0f);
    noh_controller_tracks(c)[1].speed_now = 3 * NOH_SPEED_ONE; /* its sync group drives it faster than its own speed */
    noh_time_lod_error(c, errors[0], out);
    assert_true(out[2] == 9.0f * 6.0f + 4.0f);
    assert_int_not_equal(s.set.clips[WALK].loop, NOH_LOOP_PING_PONG);
    track = track_of(WALK, 1.0f);
    track.loop = NOH_LOOP_PING_PONG; /* it was measured otherwise, and turns */
    assert_int_equal(noh_controller_start(c, &s.set, 1, &track, NULL), NOH_OK);
    noh_time_lod_error(c, errors[0], out);
    assert_true(out[2] == 2.0f * 2.0f + 4.0f);
}

/* Waking makes an update due now; one that is late already stays as late as it was. */
static void waking_does_not_forgive_lateness(void **state)
{
    noh_time_lod t;
    (void)state;
    noh_time_lod_init(&t, 3);
    noh_time_lod_frame(&t, 0, NOH_UPDATE_RATE_30);
    (void)noh_time_lod_update(&t);
    noh_time_lod_frame(&t, 800, NOH_UPDATE_RATE_30);
    (void)noh_time_lod_update(&t);
    noh_time_lod_wake(&t);
    assert_int_equal(noh_time_lod_due(&t), NOH_DUE);
    assert_int_equal(noh_time_lod_late(&t), 0);
    noh_time_lod_frame(&t, 2400, NOH_UPDATE_RATE_30);
    assert_int_equal(noh_time_lod_late(&t), 1600);
    noh_time_lod_wake(&t);
    assert_int_equal(noh_time_lod_late(&t), 1600);
}

/* A difference whose linear part has known singular values, between two rotations: what is measured is never less than
 * the largest of them says, and more by a factor of 3^(1/8) at most. */
static void a_difference_is_measured_by_its_largest_singular_value(void **state)
{
    test_random r = test_random_from(27);
    (void)state;
    for (uint32_t round = 0; round < 2000; round++) {
        const float radius = test_random_float(&r, 0.0f, 2.0f);
        float difference[12], left[12], right[12], values[3], largest = 0.0f;
        noh_transform turn = { .scale = { 1.0f, 1.0f, 1.0f } };
        for (int side = 0; side < 2; side++) {
            for (int i = 0; i < 4; i++) turn.rotation[i] = test_random_float(&r, -1.0f, 1.0f);
            noh_quat_normalize(turn.rotation);
            noh_transform_matrix(&turn, side ? right : left);
        }
        for (uint32_t i = 0; i < 3; i++) {
            values[i] = i && round % 3u == 0 ? 0.0f : test_random_float(&r, 0.0f, 1.0f);
            largest = fmaxf(largest, values[i]);
            difference[4 * i + 3] = test_random_float(&r, -1.0f, 1.0f);
        }
        for (uint32_t i = 0; i < 9; i++) {
            const uint32_t row = 4u * (i / 3u), column = i % 3u;
            difference[row + column] = 0.0f;
            for (uint32_t k = 0; k < 3; k++) {
                difference[row + column] += left[row + k] * values[k] * right[4u * column + k];
            }
        }
        const float shift = sqrtf(difference[3] * difference[3] + difference[7] * difference[7] +
                                  difference[11] * difference[11]);
        const float off = noh_probe_off(difference, radius, 0.0f);
        assert_true(off >= shift + 0.9999f * radius * largest && off <= shift + 1.1473f * radius * largest + 1e-5f);
        assert_true(noh_probe_off(difference, radius, 10.0f) == 10.0f);
    }
}

/* A real clip and its measured errors. */
typedef struct played {
    raw_play p;
    float *radius, *from, *to, *right;
    noh_transform *pose;
    float errors[NOH_UPDATE_RATE_COUNT];
} played;

#define SHELL_CM 10.0f

static void played_open(played *x, const char *path)
{
    noh_time_probe probe = { NULL, NULL, NULL, NULL, 0 };
    uint32_t joints;
    void *memory;
    size_t size;
    assert_int_equal(raw_play_open(&x->p, path, NOH_LOOP_ONCE), 0);
    joints = x->p.set.joint_count;
    x->radius = test_zeros(joints * sizeof *x->radius);
    x->pose = test_zeros(joints * sizeof *x->pose);
    x->from = test_zeros(joints * 48u), x->to = test_zeros(joints * 48u), x->right = test_zeros(joints * 48u);
    for (uint32_t j = 0; j < joints; j++) x->radius[j] = SHELL_CM;
    probe.set = &x->p.set, probe.skeleton = &x->p.skeleton, probe.joint_radius_m = x->radius;
    size = noh_time_lod_measure_size(&probe);
    memory = test_zeros(size);
    assert_int_equal(noh_time_lod_measure(memory, size, &probe, 0, x->errors, NULL), NOH_OK);
    free(memory);
}

static void played_close(played *x)
{
    free(x->radius), free(x->pose), free(x->from), free(x->to), free(x->right);
    raw_play_close(&x->p);
}

static void matrices_at(played *x, uint32_t tick, float *out)
{
    raw_play_sample(&x->p, 0, tick, x->p.set.joint_count, x->pose, 0, NULL);
    noh_local_to_model(&x->p.skeleton, x->pose, x->p.set.joint_count, out);
}

/* The largest error of a point of any joint's shell when matrices are mixed. */
static float farthest_off(const played *x, const float *direction, float part)
{
    float farthest = 0.0f;
    for (uint32_t j = 0; j < x->p.set.joint_count; j++) {
        float off[3];
        for (uint32_t i = 0; i < 3; i++) {
            uint32_t row = 12 * j + 4 * i;
            off[i] = 0.0f;
            for (uint32_t k = 0; k < 4; k++) {
                float mixed = x->from[row + k] + (x->to[row + k] - x->from[row + k]) * part;
                off[i] += (mixed - x->right[row + k]) * (k < 3 ? direction[k] * SHELL_CM : 1.0f);
            }
        }
        farthest = fmaxf(farthest, sqrtf(off[0] * off[0] + off[1] * off[1] + off[2] * off[2]));
    }
    return farthest;
}

/* At random periods and ticks, the shell of every joint stays within the measured error. */
static void real_clips_stay_within_what_was_measured(void **state)
{
    static const char *const names[] = { "clips/Knight__Walking_A.rcl", "clips/Knight__Idle.rcl", "clips/Fox__Walk.rcl",
                                         "clips/RobotExpressive__Dance.rcl" };
    test_random r = test_random_from(25);
    (void)state;
    for (size_t n = 0; n < TEST_COUNT(names); n++) {
        float worst[NOH_UPDATE_RATE_COUNT] = { 0.0f };
        played x;
        played_open(&x, test_asset(names[n]));
        for (uint32_t round = 0; round < 3000; round++) {
            uint32_t rate = 1u + round % 3u, period = noh_update_period((noh_update_rate)rate),
                     at = test_random_below(&r, period + 1u);
            uint32_t start = test_random_below(&r, x.p.clip.duration_ticks - period);
            float direction[3] = { test_random_float(&r, -1, 1), test_random_float(&r, -1, 1),
                                   test_random_float(&r, -1, 1) };
            noh_normalize3(direction, (const float[3]){ 1.0f, 0.0f, 0.0f });
            matrices_at(&x, start, x.from);
            matrices_at(&x, start + period, x.to);
            matrices_at(&x, start + at, x.right);
            worst[rate] = fmaxf(worst[rate], farthest_off(&x, direction, (float)at / (float)period));
        }
        print_message("%s: 30, 15, 8 Hz: measured %.3f %.3f %.3f cm, found at random %.3f %.3f %.3f\n", names[n],
                      (double)x.errors[1], (double)x.errors[2], (double)x.errors[3], (double)worst[1], (double)worst[2],
                      (double)worst[3]);
        for (int i = 1; i < NOH_UPDATE_RATE_COUNT; i++)
            assert_true(worst[i] <= x.errors[i] && worst[i] > 0.2f * x.errors[i]);
        assert_true(x.errors[1] < x.errors[2] && x.errors[2] < x.errors[3]);
        played_close(&x);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(updates_are_spread_evenly),
        cmocka_unit_test(uneven_frames_lose_no_updates),
        cmocka_unit_test(updates_on_time_have_the_error_of_interpolation),
        cmocka_unit_test(frames_between_steps_have_the_error_of_interpolation),
        cmocka_unit_test(late_updates_and_changes_never_jump),
        cmocka_unit_test(unseen_for_long_is_posed_at_once),
        cmocka_unit_test(a_finer_rate_begins_at_once),
        cmocka_unit_test(frames_longer_than_a_period_are_exact),
        cmocka_unit_test(clocks_at_the_ends),
        cmocka_unit_test(a_turn_has_the_error_of_its_sagitta),
        cmocka_unit_test(points_have_the_errors_of_their_own_sagittas),
        cmocka_unit_test(points_follow_a_loop_that_travels),
        cmocka_unit_test(measuring_checks_its_fields_and_its_memory),
        cmocka_unit_test(errors_of_what_plays),
        cmocka_unit_test(waking_does_not_forgive_lateness),
        cmocka_unit_test(a_difference_is_measured_by_its_largest_singular_value),
        cmocka_unit_test(real_clips_stay_within_what_was_measured),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
