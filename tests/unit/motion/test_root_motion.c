/* Tests of root_motion.c and of the controller's root motion. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>

#include "support/clip_set_fixture.h"
#include "core/base/trig_internal.h"
#include "motion/anim/root_motion_internal.h"
#include "motion/anim/tracks_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"

/* A walk of one clip whose root goes along a curve: `turn` per pass, `step` forward. */
typedef struct walk {
    noh_clip_set set;
    noh_clip_entry clip[2];
    noh_root_track roots[2];
    noh_transform bind;
    double turn, step, start_turn;
} walk;

static void walk_sample(void *user, uint32_t clip, uint32_t tick, uint32_t joints, noh_transform *pose, uint32_t floats,
                        float *values)
{
    walk *w = user;
    double s = (double)tick / (double)w->clip[clip].duration_ticks, heading = w->start_turn + w->turn * s;
    float yaw[3] = { 0.0f, (float)heading, 0.0f }, lean[3] = { 0.2f, 0.0f, 0.1f }, qy[4], ql[4];
    (void)floats, (void)values;
    for (uint32_t j = 0; j < joints; j++) pose[j] = w->bind;
    noh_quat_from_rotation(yaw, qy);
    noh_quat_from_rotation(lean, ql);
    noh_quat_mul(qy, ql, pose[0].rotation);
    pose[0].translation[0] = (float)(0.3 + w->step * s * sin(heading));
    pose[0].translation[1] = (float)(0.9 + 0.05 * sin(TWO_PI * s));
    pose[0].translation[2] = (float)(w->step * s * cos(heading));
}

static void walk_open(walk *w, double turn, double step, uint32_t duration, uint32_t axes)
{
    memset(w, 0, sizeof *w);
    w->turn = turn;
    w->step = step;
    w->start_turn = 0.4;
    w->bind.rotation[3] = 1.0f;
    w->bind.scale[0] = w->bind.scale[1] = w->bind.scale[2] = 1.0f;
    for (int m = 0; m < 2; m++) {
        w->clip[m].duration_ticks = duration * (uint32_t)(m + 1);
        w->clip[m].loop = NOH_LOOP_REPEAT;
    }
    w->set.clip_count = 2;
    w->set.joint_count = 1;
    w->set.clips = w->clip;
    w->set.bind_pose = &w->bind;
    w->set.sample = walk_sample;
    w->set.user = w;
    assert_int_equal(noh_clip_set_check(&w->set, NULL), NOH_OK);
    for (uint32_t m = 0; m < 2; m++)
        assert_int_equal(noh_root_track_measure(&w->set, m, axes, 1, &w->roots[m], NULL), NOH_OK);
    w->set.roots = w->roots;
}

static double root_apart(const noh_root_pose *a, const noh_root_pose *b)
{
    double worst = fabs((double)(int32_t)(a->turn - b->turn) * TWO_PI / 4294967296.0);
    for (int k = 0; k < 3; k++) worst = fmax(worst, fabs(a->translation[k] - b->translation[k]));
    return worst;
}

/* world * E * rest is the root as the clip has it. */
static void what_is_extracted_is_removed(void **state)
{
    double worst = 0.0;
    (void)state;
    for (uint32_t up = 0; up < 3; up++) {
        for (uint32_t axes = 0; axes < 16; axes++) {
            for (int i = 0; i < 200; i++) {
                noh_transform root, rest;
                noh_root_pose e;
                float v[3], q[4] = { 0, 0, 0, 1 }, moved[3];
                for (int k = 0; k < 3; k++) {
                    v[k] = (float)sin(i * 0.37 + k * 2.1);
                    root.translation[k] = (float)(3.0 * cos(i * 0.11 + k));
                    root.scale[k] = 1.0f;
                }
                noh_quat_from_rotation(v, root.rotation);
                rest = root;
                e = noh_root_extract(axes, up, &root);
                noh_root_remove(axes, up, 0, &rest);
                noh_sin_cos(0.5f * noh_radians_from_turn(e.turn), &q[up], &q[3]);
                noh_quat_mul(q, rest.rotation, rest.rotation);
                noh_quat_rotate(q, rest.translation, moved);
                for (int k = 0; k < 3; k++) {
                    rest.translation[k] = moved[k] + (float)e.translation[k];
                    if (!(axes >> k & 1u)) assert_true(e.translation[k] == 0.0);
                }
                if (!(axes & NOH_ROOT_HEADING)) assert_int_equal(e.turn, 0);
                worst = fmax(worst, pose_apart(&rest, &root, 1));
            }
        }
    }
    print_message("put together again: %.2g\n", worst);
    assert_true(worst < 3e-6);
}

static void root_moves_compose_as_a_group(void **state)
{
    (void)state;
    for (uint32_t up = 0; up < 3; up++) {
        noh_root_pose a = { { 0.3, -1.0, 2.0 }, 0x13572468u, 0 }, b = { { -4.0, 0.5, 0.25 }, 0xc0ffee00u, 0 }, inverse,
                      x, y, none = { { 0, 0, 0 }, 0, 0 };
        inverse = noh_root_inverse(up, &a);
        x = noh_root_compose(up, &a, &inverse);
        assert_true(root_apart(&x, &none) < 1e-14);
        x = noh_root_compose(up, &a, &b);
        x = noh_root_compose(up, &inverse, &x);
        assert_true(root_apart(&x, &b) < 1e-14);
        x = none;
        for (int n = 0; n < 50; n++) {
            y = noh_root_power(up, &a, n);
            assert_true(root_apart(&x, &y) < 1e-12);
            y = noh_root_power(up, &a, -n);
            y = noh_root_compose(up, &x, &y);
            assert_true(root_apart(&y, &none) < 1e-12);
            x = noh_root_compose(up, &x, &a);
        }
    }
}

/* A million compositions, one after another. */
static void million_by_one(uint32_t turn, long double out[2])
{
    long double angle = (long double)(int32_t)turn * 6.283185307179586476925L / 4294967296.0L;
    long double c = cosl(angle), s = sinl(angle), hc = 1.0L, hs = 0.0L, t;
    out[0] = out[1] = 0.0L;
    for (uint32_t n = 0; n < 1000000u; n++) {
        out[0] += hc * 0.3L + hs * 1.3L; /* about y: x' = c x + s z */
        out[1] += -hs * 0.3L + hc * 1.3L;
        t = hc * c - hs * s;
        hs = hc * s + hs * c;
        hc = t;
    }
}

/* The same by squaring: twenty doublings. */
static noh_root_pose million_by_squaring(const noh_root_pose *a)
{
    noh_root_pose square = *a, out = { { 0, 0, 0 }, 0, 0 };
    for (uint32_t n = 1000000u; n; n >>= 1) {
        if (n & 1u) out = noh_root_compose(1, &out, &square);
        square = noh_root_compose(1, &square, &square);
    }
    return out;
}

/* A million passes in closed form, against both. */
static void a_million_loops_do_not_drift(void **state)
{
    static const uint32_t turns[] = { 0, 1, 5000, 0xffffff00u, 0x20000000u, 0x80000000u, 0x12345678u };
    (void)state;
    for (uint32_t i = 0; i < 7; i++) {
        noh_root_pose a = { { 0.3, 0.01, 1.3 }, 0, 0 }, p, squared;
        long double sum[2];
        double apart = 0.0, way;
        a.turn = turns[i];
        p = noh_root_power(1, &a, 1000000);
        squared = million_by_squaring(&a);
        way = sqrt(p.translation[0] * p.translation[0] + p.translation[2] * p.translation[2]);
        assert_int_equal(p.turn, (uint32_t)(turns[i] * 1000000ull));
        assert_true(root_apart(&p, &squared) < 1e-8 + 1e-13 * way);
        if (sizeof(long double) > sizeof(double)) { /* else the reference drifts */
            million_by_one(turns[i], sum);
            apart = fmax(fabs(p.translation[0] - (double)sum[0]), fabs(p.translation[2] - (double)sum[1]));
        }
        print_message("turn %08x: %.6g units from the start, %.2g off\n", turns[i], way, apart);
        assert_true(apart < 1e-8 + 1e-13 * way);
        assert_true(fabs(p.translation[1] - 1e4) < 1e-9);
    }
}

/* The same through a clip's positions, and from pass 0 and from pass a million alike. */
static void positions_are_the_same_in_every_pass(void **state)
{
    walk w;
    noh_root_pose near_by, far, after;
    int64_t million = 1000000LL * noh_position_of(48000);
    double worst = 0.0;
    (void)state;
    walk_open(&w, 0.7, 1.3, 48000, NOH_ROOT_GROUND);
    far = noh_root_between(&w.set, &w.roots[0], 0, NOH_LOOP_REPEAT, 0, million);
    near_by = noh_root_power(1, &w.roots[0].loop, 1000000);
    assert_true(root_apart(&far, &near_by) < 1e-9);
    for (int i = -10; i < 10; i++) {
        int64_t a = noh_position_of(7001 * i), b = noh_position_of(9013 * i + 500);
        near_by = noh_root_between(&w.set, &w.roots[0], 0, NOH_LOOP_REPEAT, a, b);
        after = noh_root_between(&w.set, &w.roots[0], 0, NOH_LOOP_REPEAT, a + million, b + million);
        worst = fmax(worst, root_apart(&near_by, &after));
        far = noh_root_between(&w.set, &w.roots[0], 0, NOH_LOOP_REPEAT, b, a);
        far = noh_root_compose(1, &near_by, &far);
        after = noh_root_inverse(1, &far);
        assert_true(root_apart(&far, &after) < 1e-12); /* there and back */
    }
    assert_true(worst == 0.0);
    far = noh_root_between(&w.set, &w.roots[0], 0, NOH_LOOP_PING_PONG, 0, noh_position_of(2 * 48000 * 1000LL));
    near_by = noh_root_power(1, &w.roots[0].loop, 0);
    assert_true(root_apart(&far, &near_by) < 1e-12); /* there and back again */
}

/* Steps of any size add up to the closed form: the sum does not drift either. */
static void steps_add_up(void **state)
{
    walk w;
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        noh_root_pose world = { { 0, 0, 0 }, 0, 0 }, want;
        int64_t at = 0, end = 100000LL * noh_position_of(48000);
        uint32_t seed = 5, steps = 0;
        walk_open(&w, kind == 0 ? 0.0 : kind == 1 ? 0.7 : -6.0, 1.3, 48000, NOH_ROOT_GROUND | NOH_ROOT_Y);
        while (at < end) {
            int64_t to;
            noh_root_pose move;
            seed = seed * 1664525u + 1013904223u;
            to = at + (int64_t)(seed >> 8) * 30000;
            to = to < end ? to : end;
            move = noh_root_between(&w.set, &w.roots[0], 0, NOH_LOOP_REPEAT, at, to);
            world = noh_root_compose(1, &world, &move);
            at = to;
            steps++;
        }
        want = noh_root_between(&w.set, &w.roots[0], 0, NOH_LOOP_REPEAT, 0, end);
        print_message("%u steps over 100000 passes: %.2g off, %.6g away\n", steps, root_apart(&world, &want),
                      fabs(want.translation[0]) + fabs(want.translation[2]));
        assert_int_equal(world.turn, want.turn);
        assert_true(root_apart(&world, &want) < 2e-8);
    }
}

/* Floats summed frame by frame drift; moves composed as the library does it stay on the clip's path. */
static void sums_of_moves_do_not_drift(void **state)
{
    walk w;
    noh_root_pose want, composed = { { 0.0, 0.0, 0.0 }, 0, 0 };
    float x = 0.0f, z = 0.0f, heading = 0.0f;
    int64_t position = 0;
    (void)state;
    walk_open(&w, 0.7, 1.3, 48000, NOH_ROOT_GROUND);
    for (uint32_t i = 0; i < 60u * 20000u; i++) {
        noh_root_pose move = noh_root_between(&w.set, &w.roots[0], 0, NOH_LOOP_REPEAT, position,
                                              position + noh_position_of(800));
        float s, c;
        noh_sin_cos(heading, &s, &c);
        x += c * (float)move.translation[0] + s * (float)move.translation[2];
        z += -s * (float)move.translation[0] + c * (float)move.translation[2];
        heading += noh_radians_from_turn(move.turn);
        composed = noh_root_compose(1, &composed, &move);
        position += noh_position_of(800);
    }
    want = noh_root_between(&w.set, &w.roots[0], 0, NOH_LOOP_REPEAT, 0, position);
    print_message("20000 passes: %.3g off in floats, %.3g composed\n",
                  fabs((double)x - want.translation[0]) + fabs((double)z - want.translation[2]),
                  root_apart(&composed, &want));
    assert_int_equal(composed.turn, want.turn);
    assert_true(root_apart(&composed, &want) < 1e-6);
    assert_true(fabs((double)x - want.translation[0]) + fabs((double)z - want.translation[2]) > 1e-3);
}

static void measuring_names_the_bad_argument(void **state)
{
    walk w;
    noh_root_track t;
    noh_error error;
    (void)state;
    walk_open(&w, 0.7, 1.3, 48000, 0);
    assert_int_equal(noh_root_track_measure(&w.set, 2, 0, 1, &t, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, "clip", strlen("clip")), 0);
    assert_int_equal(noh_root_track_measure(&w.set, 0, 16, 1, &t, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, "axes", strlen("axes")), 0);
    assert_int_equal(noh_root_track_measure(&w.set, 0, 1, 3, &t, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, "up", strlen("up")), 0);
}

/* ---- the controller ---- */

typedef struct stage {
    walk w;
    ALIGNED uint8_t memory[4096];
    noh_controller *c;
} stage;

static void stage_controller(stage *g)
{
    noh_controller_desc d;
    memset(&d, 0, sizeof d);
    d.set = &g->w.set;
    assert_int_equal(noh_controller_init(g->memory, sizeof g->memory, &d, &g->c, NULL), NOH_OK);
}

static void stage_open(stage *g, uint32_t axes)
{
    walk_open(&g->w, 0.5, 1.2, 24000, axes);
    stage_controller(g);
}

static void start(stage *g, uint32_t track, noh_track_desc d)
{
    assert_int_equal(noh_controller_start(g->c, &g->w.set, track, &d, NULL), NOH_OK);
}

static void one_track_moves_as_its_clip(void **state)
{
    stage g;
    noh_root_pose world = { { 0, 0, 0 }, 0, 0 }, want;
    (void)state;
    stage_open(&g, NOH_ROOT_GROUND);
    start(&g, 0, track_of(0, 0.3f));
    for (int i = 0; i < 5000; i++) {
        noh_root_pose move;
        noh_controller_step(g.c, &g.w.set, 800u + (uint32_t)i % 7u * 9000u, NULL, NULL); /* up to several passes */
        move = noh_controller_root_motion(g.c, &g.w.set);
        world = noh_root_compose(1, &world, &move);
    }
    want = noh_root_between(&g.w.set, &g.w.roots[0], 0, NOH_LOOP_REPEAT, 0, noh_controller_track(g.c, 0)->position);
    assert_true(root_apart(&world, &want) < 1e-6);
}

/* A track without weight plays on, but what it walked meanwhile is not made up for when it has weight again. */
static void what_was_walked_without_weight_is_gone(void **state)
{
    stage g;
    noh_root_pose move, want;
    int64_t from;
    (void)state;
    stage_open(&g, NOH_ROOT_GROUND);
    start(&g, 0, track_of(0, 0.3f));
    assert_int_equal(noh_controller_set_weight(g.c, 0, 0.0f), NOH_OK);
    for (int i = 0; i < 10; i++) {
        noh_controller_step(g.c, &g.w.set, 800, NULL, NULL);
        move = noh_controller_root_motion(g.c, &g.w.set);
        assert_true(move.translation[0] == 0.0 && move.translation[2] == 0.0 && move.turn == 0u);
    }
    assert_int_equal(noh_controller_set_weight(g.c, 0, 0.3f), NOH_OK);
    from = noh_controller_track(g.c, 0)->position;
    noh_controller_step(g.c, &g.w.set, 800, NULL, NULL);
    move = noh_controller_root_motion(g.c, &g.w.set);
    want = noh_root_between(&g.w.set, &g.w.roots[0], 0, NOH_LOOP_REPEAT, from, noh_controller_track(g.c, 0)->position);
    assert_true(root_apart(&move, &want) < 1e-9);
}

static void seeks_do_not_move_play_does(void **state)
{
    stage g;
    noh_root_pose move, none = { { 0, 0, 0 }, 0, 0 };
    (void)state;
    stage_open(&g, NOH_ROOT_GROUND);
    start(&g, 0, track_of(0, 1.0f));
    noh_controller_seek(g.c, &g.w.set, 0, 20000, NOH_SEEK_SKIP, NULL);
    move = noh_controller_root_motion(g.c, &g.w.set);
    assert_true(root_apart(&move, &none) == 0.0);
    noh_controller_seek(g.c, &g.w.set, 0, 5000, NOH_SEEK_FIRE, NULL);
    noh_controller_step(g.c, &g.w.set, 1, NULL, NULL);
    move = noh_controller_root_motion(g.c, &g.w.set);
    assert_true(root_apart(&move, &none) == 0.0);
    noh_controller_step(g.c, &g.w.set, 100, NULL, NULL);
    move = noh_controller_root_motion(g.c, &g.w.set);
    assert_true(root_apart(&move, &none) > 1e-3);
    g.w.set.roots = NULL;
    noh_controller_step(g.c, &g.w.set, 100, NULL, NULL);
    move = noh_controller_root_motion(g.c, &g.w.set);
    assert_true(root_apart(&move, &none) == 0.0);
}

static void moves_are_blended_by_weight_and_group(void **state)
{
    stage g;
    noh_root_pose a, b, got, want;
    (void)state;
    stage_open(&g, NOH_ROOT_GROUND);
    a = noh_root_between(&g.w.set, &g.w.roots[0], 0, NOH_LOOP_REPEAT, 0, noh_position_of(3000));
    b = noh_root_between(&g.w.set, &g.w.roots[1], 1, NOH_LOOP_REPEAT, 0, noh_position_of(3000));
    for (int k = 0; k < 3; k++) want.translation[k] = 0.75 * a.translation[k] + 0.25 * b.translation[k];
    want.turn = (uint32_t)(int32_t)(0.75 * (double)(int32_t)a.turn + 0.25 * (double)(int32_t)b.turn);
    for (int high = 0; high < 2; high++) {
        noh_track_desc d = track_of(1, high ? 7.0f : 0.2f);
        d.group = high ? NOH_GROUP_HIGH : NOH_GROUP_LOW;
        start(&g, 0, track_of(0, 0.6f));
        start(&g, 1, d);
        noh_controller_set_priority_blend(g.c, 0.25f);
        noh_controller_step(g.c, &g.w.set, 3000, NULL, NULL);
        got = noh_controller_root_motion(g.c, &g.w.set);
        assert_true(root_apart(&got, &want) < 1e-7);
    }
    noh_controller_set_mode(g.c, 0, NOH_TRACK_OFF);
    noh_controller_step(g.c, &g.w.set, 3000, NULL, NULL);
    got = noh_controller_root_motion(g.c, &g.w.set);
    want = noh_root_between(&g.w.set, &g.w.roots[1], 1, NOH_LOOP_REPEAT, noh_position_of(3000), noh_position_of(6000));
    assert_true(root_apart(&got, &want) < 1e-12);
}

/* A clip of floats only, or one whose mask leaves the root out, takes no part: the walk goes as far as it does alone.
 */
static void what_moves_no_joints_does_not_hold_the_root(void **state)
{
    static const uint8_t no_joints[1] = { 0 };
    (void)state;
    for (int group = NOH_GROUP_LOW; group <= NOH_GROUP_HIGH; group++) {
        for (uint32_t mask = 0; mask < 2; mask++) {
            stage g;
            noh_track_desc face = track_of(1, 2.0f), bow = track_of(0, 1.0f);
            noh_root_pose alone, got;
            stage_open(&g, NOH_ROOT_GROUND);
            g.w.set.mask_count = 1;
            g.w.set.masks = no_joints;
            stage_controller(&g);
            g.w.clip[1].flags = mask ? 0 : NOH_CLIP_FLOATS_ONLY;
            face.mask = mask;
            face.group = (noh_track_group)group;
            start(&g, 0, track_of(0, 1.0f));
            start(&g, 1, face);
            noh_controller_step(g.c, &g.w.set, 3000, NULL, NULL);
            got = noh_controller_root_motion(g.c, &g.w.set);
            alone = noh_root_between(&g.w.set, &g.w.roots[0], 0, NOH_LOOP_REPEAT, 0, noh_position_of(3000));
            assert_true(fabs(alone.translation[2]) > 0.05);
            assert_true(root_apart(&got, &alone) < 1e-12);
            bow.group = NOH_GROUP_HIGH; /* nor does it dilute another high track */
            bow.position_ticks = 6000;
            start(&g, 2, bow);
            noh_controller_step(g.c, &g.w.set, 3000, NULL, NULL);
            got = noh_controller_root_motion(g.c, &g.w.set);
            alone = noh_root_between(&g.w.set, &g.w.roots[0], 0, NOH_LOOP_REPEAT, noh_position_of(6000),
                                     noh_position_of(9000));
            assert_true(root_apart(&got, &alone) < 1e-12);
        }
    }
}

/* The mask's value for joint 0 weighs the track, within its group and when the high group covers the low one. */
static void masks_weigh_root_motion(void **state)
{
    static const uint8_t half = 128;
    const double part = 128.0 / 255.0;
    (void)state;
    for (int high = 0; high < 2; high++) {
        stage g;
        noh_root_pose a, b, got, want;
        noh_track_desc d = track_of(1, 1.0f);
        double w;
        stage_open(&g, NOH_ROOT_GROUND);
        g.w.set.masks = &half;
        g.w.set.mask_count = 1;
        stage_controller(&g);
        d.mask = 1;
        d.group = high ? NOH_GROUP_HIGH : NOH_GROUP_LOW;
        start(&g, 0, track_of(0, 1.0f));
        start(&g, 1, d);
        noh_controller_set_priority_blend(g.c, 0.6f);
        noh_controller_step(g.c, &g.w.set, 3000, NULL, NULL);
        a = noh_root_between(&g.w.set, &g.w.roots[0], 0, NOH_LOOP_REPEAT, 0, noh_position_of(3000));
        b = noh_root_between(&g.w.set, &g.w.roots[1], 1, NOH_LOOP_REPEAT, 0, noh_position_of(3000));
        w = high ? (double)0.6f * part : part / (1.0 + part);
        for (int k = 0; k < 3; k++) want.translation[k] = (1.0 - w) * a.translation[k] + w * b.translation[k];
        want.turn = (uint32_t)(int32_t)llround((1.0 - w) * (double)(int32_t)a.turn + w * (double)(int32_t)b.turn);
        got = noh_controller_root_motion(g.c, &g.w.set);
        assert_true(root_apart(&got, &want) < 1e-7);
    }
}

/* One clip turns left while another, played backwards, turns right: turns are signed angles, their mean rounded to the
 * nearest on both sides of zero. */
static void opposite_turns_are_averaged_as_angles(void **state)
{
    (void)state;
    for (int backward = 0; backward < 2; backward++) { /* the mean is right of zero, then left of it */
        stage g;
        noh_root_pose a, b, got;
        double mean;
        noh_track_desc d = track_of(0, backward ? 3.0f : 1.0f);
        stage_open(&g, NOH_ROOT_GROUND);
        d.speed = -NOH_SPEED_ONE;
        start(&g, 0, track_of(0, backward ? 1.0f : 2.0f));
        start(&g, 1, d);
        noh_controller_step(g.c, &g.w.set, 3000, NULL, NULL);
        a = noh_root_between(&g.w.set, &g.w.roots[0], 0, NOH_LOOP_REPEAT, 0, noh_position_of(3000));
        b = noh_root_between(&g.w.set, &g.w.roots[0], 0, NOH_LOOP_REPEAT, 0, noh_position_of(-3000));
        assert_true((int32_t)a.turn > 0 && (int32_t)b.turn < 0);
        mean = backward ? 0.25 * (double)(int32_t)a.turn + 0.75 * (double)(int32_t)b.turn
                        : (2.0 * (double)(int32_t)a.turn + (double)(int32_t)b.turn) / 3.0;
        got = noh_controller_root_motion(g.c, &g.w.set);
        assert_true(backward ? mean < 0.0 : mean > 0.0);
        assert_true(fabs((double)(int32_t)got.turn - mean) <= 0.5001);
    }
}

/* An additive track changes the pose, not the root motion. */
static void additive_tracks_do_not_travel(void **state)
{
    stage g;
    noh_root_pose got, want;
    noh_track_desc d = track_of(1, 1.0f);
    (void)state;
    stage_open(&g, NOH_ROOT_GROUND);
    d.flags = NOH_TRACK_ADDITIVE;
    start(&g, 0, track_of(0, 1.0f));
    start(&g, 1, d);
    noh_controller_step(g.c, &g.w.set, 3000, NULL, NULL);
    got = noh_controller_root_motion(g.c, &g.w.set);
    want = noh_root_between(&g.w.set, &g.w.roots[0], 0, NOH_LOOP_REPEAT, 0, noh_position_of(3000));
    assert_true(root_apart(&got, &want) < 1e-12);
}

/* World * pose is the path of the clip without any extraction, over the seams. */
static void pose_and_clip_make_the_whole(void **state)
{
    stage g;
    noh_pose_scratch scratch;
    static ALIGNED uint8_t memory[1024];
    noh_root_pose world;
    noh_transform pose, whole;
    (void)state;
    stage_open(&g, NOH_ROOT_GROUND);
    assert_int_equal(noh_pose_scratch_init(memory, sizeof memory, &g.w.set, 0, &scratch, NULL), NOH_OK);
    start(&g, 0, track_of(0, 1.0f));
    world = g.w.roots[0].start;
    for (int i = 0; i < 29; i++) {
        noh_root_pose move;
        float q[4] = { 0, 0, 0, 1 };
        noh_controller_step(g.c, &g.w.set, 800, NULL, NULL);
        move = noh_controller_root_motion(g.c, &g.w.set);
        world = noh_root_compose(1, &world, &move);
        noh_controller_pose(g.c, &g.w.set, &scratch, &pose, NULL);
        noh_sin_cos(0.5f * noh_radians_from_turn(world.turn), &q[1], &q[3]);
        noh_quat_mul(q, pose.rotation, pose.rotation);
        noh_quat_rotate(q, pose.translation, pose.translation);
        for (int k = 0; k < 3; k++) pose.translation[k] += (float)world.translation[k];
        walk_sample(&g.w, 0, 800u * (uint32_t)(i + 1), 1, &whole, 0, NULL);
        assert_true(pose_apart(&pose, &whole, 1) < 3e-6);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_extracted_is_removed),
        cmocka_unit_test(root_moves_compose_as_a_group),
        cmocka_unit_test(a_million_loops_do_not_drift),
        cmocka_unit_test(positions_are_the_same_in_every_pass),
        cmocka_unit_test(steps_add_up),
        cmocka_unit_test(sums_of_moves_do_not_drift),
        cmocka_unit_test(measuring_names_the_bad_argument),
        cmocka_unit_test(one_track_moves_as_its_clip),
        cmocka_unit_test(what_was_walked_without_weight_is_gone),
        cmocka_unit_test(seeks_do_not_move_play_does),
        cmocka_unit_test(moves_are_blended_by_weight_and_group),
        cmocka_unit_test(what_moves_no_joints_does_not_hold_the_root),
        cmocka_unit_test(masks_weigh_root_motion),
        cmocka_unit_test(opposite_turns_are_averaged_as_angles),
        cmocka_unit_test(additive_tracks_do_not_travel),
        cmocka_unit_test(pose_and_clip_make_the_whole),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
