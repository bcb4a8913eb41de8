/* Tests of lod.c: levels chosen by pixels, fades, targets left out. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/trig_internal.h"
#include "stage/character/lod_internal.h"
#include "noh/base.h"
#include "noh/low_stage.h"
#include "noh/noh.h"

#define LEVELS 4u
#define FRAME 800u

static const noh_lod_mesh meshes[LEVELS] = {
    { 10000, 20000, 4, 0.0f }, { 5000, 10000, 4, 0.001f }, { 2500, 5000, 2, 0.004f }, { 1000, 2000, 1, 0.011f }
};
static const noh_lod_joints joints[3] = { { 60, 0.0f }, { 31, 0.002f }, { 12, 0.02f } };
static const noh_lod_influences influences[3] = { { 4, 0.0f }, { 2, 0.0015f }, { 1, 0.008f } };
static const float rates[NOH_UPDATE_RATE_COUNT] = { 0.0f, 0.003f, 0.01f, 0.03f };
static const float shares[NOH_LOD_KIND_COUNT] = { 0.3f, 0.1f, 0.05f, 0.1f, 0.45f }; /* the documented default */

static noh_lod_table table_of(void)
{
    noh_lod_table t;
    memset(&t, 0, sizeof t);
    t.meshes = meshes;
    t.joints = joints;
    t.influences = influences;
    t.mesh_level_count = LEVELS;
    t.joint_level_count = t.influence_level_count = 3;
    t.clip_error_m = 0.0001f;
    return t;
}

static noh_lod_settings settings_of(float pixels)
{
    noh_lod_settings s;
    memset(&s, 0, sizeof s);
    s.pixels = pixels;
    return s;
}

/* ---- descs ---- */

static void bad_table(noh_lod_table t, noh_result result, const char *what)
{
    noh_error error;
    assert_int_equal(noh_lod_table_check(&t, &error), result);
    assert_int_equal(strncmp(error.what, what, strlen(what)), 0);
}

static void table_fields_broken_in_turn(void **state)
{
    noh_lod_table fine = table_of(), t;
    noh_lod_mesh m[LEVELS];
    noh_lod_joints j[3];
    noh_lod_influences i[3];
    (void)state;
    assert_int_equal(noh_lod_table_check(&fine, NULL), NOH_OK);
    t = fine, t.meshes = NULL, bad_table(t, NOH_ERR_ARG, "meshes");
    t = fine, t.mesh_level_count = NOH_LOD_LEVELS_MAX + 1u, bad_table(t, NOH_ERR_ARG, "meshes");
    t = fine, t.joints = NULL, bad_table(t, NOH_ERR_ARG, "joints");
    t = fine, t.influence_level_count = 99, bad_table(t, NOH_ERR_ARG, "influences");
    t = fine, t.clip_error_m = -1.0f, bad_table(t, NOH_ERR_DATA, "clip_error_m");
    memcpy(m, meshes, sizeof m);
    t = fine, t.meshes = m;
    m[2].error_m = 0.0005f, bad_table(t, NOH_ERR_DATA, "error of a mesh level");
    m[2].error_m = NAN, bad_table(t, NOH_ERR_DATA, "error of a mesh level");
    m[2].error_m = -1.0f, bad_table(t, NOH_ERR_DATA, "error of a mesh level");
    memcpy(j, joints, sizeof j);
    t = fine, t.joints = j;
    j[1].joint_count = 0, bad_table(t, NOH_ERR_DATA, "joint_count of a joint level");
    j[1].error_m = INFINITY, bad_table(t, NOH_ERR_DATA, "error of a joint level");
    memcpy(i, influences, sizeof i);
    t = fine, t.influences = i;
    i[2].influence_count = 0, bad_table(t, NOH_ERR_DATA, "influence_count of an influence level");
    i[0].error_m = -0.5f, bad_table(t, NOH_ERR_DATA, "error of an influence level");
}

static void bad_settings(noh_lod_settings s, const char *what)
{
    noh_error error;
    assert_int_equal(noh_lod_settings_check(&s, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, what, strlen(what)), 0);
}

static void settings_fields_broken_in_turn(void **state)
{
    noh_lod_settings fine = settings_of(0.0f), s;
    (void)state;
    assert_int_equal(noh_lod_settings_check(&fine, NULL), NOH_OK);
    s = fine, s.pixels = -1.0f, bad_settings(s, "pixels");
    s = fine, s.pixels = NAN, bad_settings(s, "pixels");
    s = fine, s.shares[1] = 1.5f, bad_settings(s, "shares");
    s = fine, s.shares[1] = s.shares[4] = 0.6f, bad_settings(s, "shares must sum to at most 1");
    s = fine, s.hysteresis = 1.0f, bad_settings(s, "hysteresis");
    s = fine, s.lead = 0.3f, bad_settings(s, "lead");
    s = fine, s.hysteresis = 0.5f, s.lead = 0.49f;
    assert_int_equal(noh_lod_settings_check(&s, NULL), NOH_OK);
}

/* ---- scale ---- */

/* 1080 lines over 90 degrees: at d metres the view is 2 d high. */
static void scale_is_that_of_the_perspective(void **state)
{
    (void)state;
    assert_true(fabs(noh_lod_scale(1.0f, NOH_PI / 2.0f, 1080) - 540.0) < 1e-3);
    assert_true(fabs(noh_lod_scale(10.0f, NOH_PI / 2.0f, 1080) - 54.0) < 1e-4);
    assert_true(fabs(noh_lod_scale(3.0f, 0.8f, 720) / (720.0 / (6.0 * tan(0.4))) - 1.0) < 1e-6);
    assert_true(noh_lod_scale(0.0f, 1.0f, 720) == noh_lod_scale(1e-4f, 1.0f, 720));
    assert_true(isfinite(noh_lod_scale(-5.0f, 1.0f, 720)));
    assert_true(isfinite(noh_lod_scale(NAN, 1.0f, 720)));
}

/* ---- choice ---- */

static float coarsest_shown_mesh(const noh_lod *d)
{
    return meshes[d->mesh > d->mesh_before ? d->mesh : d->mesh_before].error_m;
}

/* Each kind within its share; while a fade is on, the mesh may have outgrown it. */
static void expect_within_shares(const noh_lod *d, float scale, float pixels, int with_mesh)
{
    const float slack = 1.00001f;
    if (with_mesh) assert_true(coarsest_shown_mesh(d) * scale <= shares[NOH_LOD_MESH] * pixels * slack);
    assert_true(joints[d->joints].error_m * scale <= shares[NOH_LOD_JOINTS] * pixels * slack);
    assert_true(influences[d->influences].error_m * scale <= shares[NOH_LOD_INFLUENCES] * pixels * slack);
    if (d->update_rate)
        assert_true((rates[d->update_rate] + 0.0001f) * scale <= shares[NOH_LOD_UPDATES] * pixels * slack);
}

static void fresh_choice_is_monotone_and_within_the_quality_setting(void **state)
{
    noh_lod_table t = table_of();
    noh_lod_settings s = settings_of(1.0f);
    noh_lod last;
    (void)state;
    memset(&last, 0, sizeof last);
    for (float scale = 1e5f; scale > 0.5f; scale *= 0.99f) {
        noh_lod d;
        memset(&d, 0, sizeof d);
        noh_lod_choose(&d, &t, &s, scale, rates, 0);
        assert_true(d.mesh >= last.mesh && d.joints >= last.joints && d.influences >= last.influences &&
                    d.update_rate >= last.update_rate);
        assert_int_equal(d.mesh, d.mesh_before);
        assert_int_equal(d.fade_ticks, 0);
        expect_within_shares(&d, scale, 1.0f, 1);
        if (d.mesh) assert_true(noh_lod_error_pixels(&d) <= 1.0f);
        last = d;
    }
    assert_int_equal(last.mesh, LEVELS - 1u); /* far away all is coarse */
    assert_int_equal(last.joints, 2);
    assert_int_equal(last.influences, 2);
    assert_int_equal(last.update_rate, NOH_UPDATE_RATE_8);
    assert_int_equal(noh_lod_joint_count(&last, &t), 12);
    assert_int_equal(noh_lod_influence_count(&last, &t), 1);
}

static void an_empty_table_gives_full_detail(void **state)
{
    noh_lod_table t;
    noh_lod_settings s = settings_of(1.0f);
    noh_lod d;
    (void)state;
    memset(&t, 0, sizeof t);
    memset(&d, 0, sizeof d);
    assert_int_equal(noh_lod_table_check(&t, NULL), NOH_OK);
    noh_lod_choose(&d, &t, &s, 0.0f, NULL, 0);
    assert_true(d.mesh == 0 && d.joints == 0 && d.influences == 0 && d.update_rate == NOH_UPDATE_RATE_FULL);
    assert_int_equal(noh_lod_joint_count(&d, &t), 0);
    assert_int_equal(noh_lod_influence_count(&d, &t), 0);
    assert_true(noh_lod_error_pixels(&d) == 0.0f);
}

/* A mesh level that stores fewer influences than the influence level allows. */
static void influences_are_those_that_the_mesh_has(void **state)
{
    noh_lod_table t = table_of();
    noh_lod d;
    (void)state;
    memset(&d, 0, sizeof d);
    assert_int_equal(noh_lod_influence_count(&d, &t), 4);
    d.mesh = 2;
    assert_int_equal(noh_lod_influence_count(&d, &t), 2);
    d.mesh = 0, d.influences = 1;
    assert_int_equal(noh_lod_influence_count(&d, &t), 2);
    t.influence_level_count = 0;
    assert_int_equal(noh_lod_influence_count(&d, &t), 4);
}

/* ---- no flicker ---- */

typedef struct changes {
    uint32_t mesh, joints, influences, update_rate;
} changes;

static void count_changes(changes *n, const noh_lod *before, const noh_lod *after)
{
    n->mesh += before->mesh != after->mesh;
    n->joints += before->joints != after->joints;
    n->influences += before->influences != after->influences;
    n->update_rate += before->update_rate != after->update_rate;
}

/* A distance that trembles by less than the hysteresis: after the first frames, each kind changes at most once. */
static void trembling_never_flickers(void **state)
{
    noh_lod_table t = table_of();
    noh_lod_settings s = settings_of(1.0f);
    test_random r = test_random_from(11);
    (void)state;
    for (int place = 0; place < 200; place++) {
        float middle = 3.0f * powf(1.04f, (float)place);
        changes n = { 0, 0, 0, 0 };
        noh_lod d;
        memset(&d, 0, sizeof d);
        noh_lod_choose(&d, &t, &s, middle, rates, 0);
        for (int64_t frame = 1; frame < 600; frame++) {
            noh_lod before = d;
            noh_lod_choose(&d, &t, &s, middle * test_random_float(&r, 0.93f, 1.07f), rates, frame * FRAME);
            count_changes(&n, &before, &d);
        }
        assert_true(n.mesh <= 1 && n.joints <= 1 && n.influences <= 1 && n.update_rate <= 1);
    }
}

/* What must never happen on a random walk: two mesh changes within one fade, a change back before the scale has moved
 * by the hysteresis, an error above the quality setting while the scale grows no faster than the lead allows. */
static void random_walks_keep_all_bounds(void **state)
{
    noh_lod_table t = table_of();
    noh_lod_settings s = settings_of(1.0f);
    test_random r = test_random_from(12);
    uint32_t total = 0, returns = 0;
    (void)state;
    for (int walk = 0; walk < 60; walk++) {
        float scale = powf(10.0f, test_random_float(&r, 0.0f, 4.0f)), speed = 0.0f, changed_at = 0.0f;
        const float step = powf(1.0f / 0.85f, 1.0f / 17.0f) -
                           1.0f; /* less than the lead in the 15 frames of a fade, and one */
        int64_t last_change = -1000000;
        uint8_t came_from = LEVELS;
        noh_lod d;
        memset(&d, 0, sizeof d);
        for (int64_t frame = 0; frame < 4000; frame++) {
            noh_lod before = d;
            noh_lod_choose(&d, &t, &s, scale, rates, frame * FRAME);
            expect_within_shares(&d, scale, 1.0f, 1);
            if (frame && d.mesh != before.mesh) {
                assert_true(frame * FRAME - last_change >= 12000);
                if (d.mesh == came_from)
                    assert_true(fmaxf(scale / changed_at, changed_at / scale) > 1.2f); /* 0.85 over 0.7 */
                returns += d.mesh == came_from;
                came_from = before.mesh;
                last_change = frame * FRAME;
                changed_at = scale;
                total++;
            }
            speed += test_random_float(&r, -0.3f, 0.3f) * step;
            speed = fmaxf(-step, fminf(step, speed));
            scale *= 1.0f + speed;
            scale = fmaxf(1.0f, fminf(2e4f, scale));
        }
    }
    print_message("60 walks of 4000 frames: %u changes of the mesh level, %u of them back\n", total, returns);
    assert_true(total > 60 && returns > 10);
}

/* Zooming out and in again, slowly: each level once each way. */
static void slow_zoom_passes_each_level_once(void **state)
{
    noh_lod_table t = table_of();
    noh_lod_settings s = settings_of(1.0f);
    changes n = { 0, 0, 0, 0 };
    noh_lod d;
    (void)state;
    memset(&d, 0, sizeof d);
    noh_lod_choose(&d, &t, &s, 1e4f, rates, 0);
    for (int frame = 1; frame <= 1200; frame++) {
        noh_lod before = d;
        float part = (float)(frame <= 600 ? frame : 1200 - frame) / 600.0f;
        noh_lod_choose(&d, &t, &s, 1e4f * powf(1e-4f, part), rates, (int64_t)frame * FRAME);
        assert_true(frame <= 600 ? d.mesh >= before.mesh : d.mesh <= before.mesh || frame < 620);
        count_changes(&n, &before, &d);
    }
    assert_int_equal(n.mesh, 6);
    assert_int_equal(n.joints, 4);
    assert_int_equal(n.influences, 4);
    assert_int_equal(n.update_rate, 6);
}

/* ---- limits ---- */

/* A level without memory is wanted but not taken; once the limit allows it, it fades in. */
static void a_limit_holds_finer_levels_back(void **state)
{
    noh_lod_table t = table_of();
    noh_lod_settings s = settings_of(1.0f);
    noh_lod d;
    int64_t clock = 0;
    (void)state;
    memset(&d, 0, sizeof d);
    noh_lod_choose(&d, &t, &s, 0.5f, rates, clock);
    assert_int_equal(d.mesh, LEVELS - 1u);
    noh_lod_set_limit(&d, LEVELS - 2u);
    for (int frame = 0; frame < 60; frame++) {
        noh_lod_choose(&d, &t, &s, 1e5f, rates, clock += FRAME);
        assert_true(d.mesh >= LEVELS - 2u && d.mesh_before >= LEVELS - 2u);
    }
    assert_int_equal(d.mesh, LEVELS - 2u);
    assert_int_equal(d.mesh_wanted, 0);
    assert_int_equal(noh_lod_finest(&d), 0);
    assert_true(d.error_m >= t.meshes[LEVELS - 2u].error_m); /* and error_m is the coarser level's */
    noh_lod_set_limit(&d, 0);
    noh_lod_choose(&d, &t, &s, 1e5f, rates, clock += FRAME);
    assert_int_equal(d.mesh, 0);
    assert_int_equal(d.mesh_before, LEVELS - 2u);
    assert_true(d.fade_ticks > 0);
}

/* A limit that is set while a finer level is shown: a fade to the nearest level allowed, and on to a coarser one when
 * that is enough. */
static void a_limit_fades_out_finer_levels(void **state)
{
    noh_lod_table t = table_of();
    noh_lod_settings s = settings_of(1.0f);
    noh_lod d;
    (void)state;
    memset(&d, 0, sizeof d);
    noh_lod_choose(&d, &t, &s, 1e5f, rates, 0);
    assert_int_equal(d.mesh, 0);
    noh_lod_set_limit(&d, 1);
    noh_lod_choose(&d, &t, &s, 1e5f, rates, FRAME);
    assert_int_equal(d.mesh, 1);
    assert_true(d.fade_ticks > 0);
    noh_lod_set_limit(&d, 200); /* past the last: the coarsest */
    noh_lod_choose(&d, &t, &s, 1e5f, rates, FRAME + 12000);
    assert_int_equal(d.mesh, LEVELS - 1u);
    noh_lod_cut(&d);
    noh_lod_choose(&d, &t, &s, 1e5f, rates, FRAME + 12000);
    assert_int_equal(d.mesh, 0);
}

/* Clocks at the ends of their range: nothing overflows, and a fade ends. */
static void clocks_at_the_ends(void **state)
{
    static const int64_t clocks[] = { INT64_MIN, INT64_MIN + 5, -1, 0, INT64_MAX - 5, INT64_MAX };
    noh_lod_table t = table_of();
    noh_lod_settings s = settings_of(1.0f);
    (void)state;
    for (uint32_t i = 0; i < sizeof clocks / sizeof *clocks; i++) {
        for (uint32_t k = i; k < sizeof clocks / sizeof *clocks; k++) {
            noh_lod d;
            float fade;
            memset(&d, 0, sizeof d);
            noh_lod_choose(&d, &t, &s, 1e5f, rates, clocks[i]);
            noh_lod_choose(&d, &t, &s, 0.5f, rates, clocks[i]);
            fade = noh_lod_fade(&d, clocks[k]);
            assert_true(k == i ? fade == 0.0f : k > 1 && i < 2 ? fade == 1.0f : fade >= 0.0f && fade <= 1.0f);
            noh_lod_choose(&d, &t, &s, 0.5f, rates, clocks[k]);
            assert_int_equal(d.mesh, LEVELS - 1u);
        }
    }
}

/* ---- fades ---- */

static void fades_are_smooth_and_one_at_a_time(void **state)
{
    noh_lod_table t = table_of();
    noh_lod_settings s = settings_of(1.0f);
    noh_lod d;
    float last = 0.0f;
    (void)state;
    memset(&d, 0, sizeof d);
    s.fade_ticks = 24000;
    noh_lod_choose(&d, &t, &s, 1e4f, rates, 0);
    assert_true(noh_lod_fade(&d, 0) == 1.0f);
    noh_lod_choose(&d, &t, &s, 15.0f, rates, 1000);
    assert_int_equal(d.mesh, 3);
    assert_int_equal(d.mesh_before, 0);
    for (int64_t tick = 1000; tick < 25000; tick += 400) {
        float fade = noh_lod_fade(&d, tick);
        noh_lod_choose(&d, &t, &s, tick % 800 ? 1e4f : 5.0f, rates, tick); /* whatever the camera does */
        assert_true(d.mesh == 3 && d.mesh_before == 0);
        assert_true(fade >= last && fade - last <= 1.5f * 400.0f / 24000.0f + 1e-6f);
        last = fade;
    }
    assert_true(last < 1.0f);
    assert_true(noh_lod_fade(&d, 25000) == 1.0f);
    noh_lod_choose(&d, &t, &s, 1e4f, rates, 25000); /* all the way back, at once */
    assert_true(d.mesh == 0 && d.mesh_before == 3);
    noh_lod_cut(&d);
    assert_true(noh_lod_fade(&d, 25001) == 1.0f);
    noh_lod_choose(&d, &t, &s, 15.0f, rates, 25001);
    assert_true(d.mesh == 3 && d.mesh_before == 3 && noh_lod_fade(&d, 25001) == 1.0f);
}

/* ---- targets ---- */

#define TARGETS 290u

static int by_value(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

/* The sum that the greedy choice skips, found by sorting. */
static double greedy_sum(const float *weights, const float *radius, double room)
{
    float costs[TARGETS];
    double sum = 0.0;
    for (uint32_t i = 0; i < TARGETS; i++) costs[i] = fabsf(weights[i] * radius[i]);
    qsort(costs, TARGETS, sizeof *costs, by_value);
    for (uint32_t i = 0; i < TARGETS && sum + (double)costs[i] <= room; i++) sum += (double)costs[i];
    return sum;
}

static void a_fixed_level_does_not_influence_later_choices(void **state)
{
    const noh_lod_table t = table_of();
    const noh_lod_settings s = settings_of(1.0f);
    noh_lod d, fresh;
    (void)state;
    for (uint32_t level = 0; level < LEVELS + 2u; level++) {
        memset(&d, 0xa5, sizeof d);
        noh_lod_set_mesh(&d, &t, level, 7.0f);
        assert_true(noh_lod_fade(&d, 123) == 1.0f);
        assert_int_equal(d.mesh, level < LEVELS ? level : LEVELS - 1u);
        assert_true(d.error_m == meshes[d.mesh].error_m && noh_lod_error_pixels(&d) == 7.0f * d.error_m);
        memset(&fresh, 0, sizeof fresh);
        noh_lod_choose(&d, &t, &s, 40.0f, rates, 500); /* where hysteresis would keep a coarser level */
        noh_lod_choose(&fresh, &t, &s, 40.0f, rates, 500);
        assert_memory_equal(&d, &fresh, sizeof d);
    }
}

/* Against the depth of every corner in double precision. */
static void skipped_targets_are_the_smallest_and_bounded(void **state)
{
    noh_lod_settings s = settings_of(0.0f);
    test_random r = test_random_from(13);
    float weights[TARGETS], radius[TARGETS], kept[TARGETS];
    (void)state;
    for (int round = 0; round < 300; round++) {
        float smallest_kept = INFINITY, largest_skipped = 0.0f;
        uint32_t left = 0, told;
        double room, sum = 0.0;
        noh_lod d;
        memset(&d, 0, sizeof d);
        d.pixels_per_metre = powf(10.0f, test_random_float(&r, -1.0f, 5.0f));
        room = (double)shares[NOH_LOD_TARGETS] / (double)d.pixels_per_metre;
        test_random_weights(&r, weights, TARGETS);
        for (uint32_t i = 0; i < TARGETS; i++)
            radius[i] = round % 3 ? test_random_float(&r, 0.0f, 0.03f) : 0.004f * (float)(1u + i % 2u);
        told = noh_lod_targets(&d, &s, weights, radius, TARGETS, kept);
        for (uint32_t i = 0; i < TARGETS; i++) {
            float cost = fabsf(weights[i] * radius[i]);
            if (kept[i] == 0.0f) {
                sum += (double)cost;
                largest_skipped = fmaxf(largest_skipped, cost);
            } else {
                assert_true(kept[i] == weights[i]);
                smallest_kept = fminf(smallest_kept, cost);
                left++;
            }
        }
        assert_int_equal(told, left);
        assert_true(sum <= room && fabs(sum - (double)d.skipped_m) <= 1e-6 * sum);
        assert_true(largest_skipped <= smallest_kept);
        assert_true(fabs(sum - greedy_sum(weights, radius, room)) <= 1e-6 * sum + 1e-12);
        assert_true(noh_lod_error_pixels(&d) <= shares[NOH_LOD_TARGETS] * 1.00001f);
    }
}

/* Half of a fade's ticks is half of the pixels; it begins and ends without a jump of speed. */
static void fades_follow_the_smoothstep(void **state)
{
    const noh_lod_table t = table_of();
    const noh_lod_settings s = settings_of(1.0f);
    noh_lod d;
    (void)state;
    memset(&d, 0, sizeof d);
    d.fade_start = 1000;
    d.fade_ticks = 4000;
    assert_true(noh_lod_fade(&d, 900) == 0.0f && noh_lod_fade(&d, 1000) == 0.0f && noh_lod_fade(&d, 2000) == 0.15625f);
    assert_true(noh_lod_fade(&d, 3000) == 0.5f && noh_lod_fade(&d, 4000) == 0.84375f && noh_lod_fade(&d, 5000) == 1.0f);
    memset(&d, 0, sizeof d);
    noh_lod_choose(&d, &t, &s, 15.0f, rates, 0);
    noh_lod_choose(&d, &t, &s, 1e5f, rates, 100);
    assert_int_equal(d.fade_ticks, 12000); /* the default: a quarter of a second */
}

/* The error in pixels is the sum over all kinds, with the targets left out; during a fade the coarser level counts,
 * whether it is the new one or the old one. */
static void errors_of_all_kinds_add_up(void **state)
{
    const float weights[2] = { 0.5f, 1.0f }, radius[2] = { 0.002f, 1.0f };
    noh_lod_table t = table_of();
    noh_lod_settings s = settings_of(1.0f);
    float kept[2];
    noh_lod d;
    (void)state;
    memset(&d, 0, sizeof d);
    s.fade_ticks = 24000;
    noh_lod_choose(&d, &t, &s, 15.0f, rates, 0);
    assert_int_equal(d.mesh, 3);
    assert_int_equal(noh_lod_targets(&d, &s, weights, radius, 2, kept), 1);
    assert_true(d.skipped_m == 0.001f);
    assert_true(fabsf(d.error_m - (meshes[3].error_m + joints[d.joints].error_m + influences[d.influences].error_m +
                                   rates[d.update_rate] + t.clip_error_m)) < 1e-7f);
    assert_true(noh_lod_error_pixels(&d) == (d.error_m + d.skipped_m) * 15.0f);
    noh_lod_choose(&d, &t, &s, 1e5f, rates, 100); /* suddenly near: level 3 is still drawn while it fades */
    assert_true(d.mesh == 0 && d.mesh_before == 3);
    assert_true(fabsf(d.error_m - (meshes[3].error_m + t.clip_error_m)) < 1e-7f);
    noh_lod_choose(&d, &t, &s, 1e5f, rates, 30000);
    assert_true(fabsf(d.error_m - t.clip_error_m) < 1e-7f);
}

/* A lower update rate never counts as better, whatever was measured: where 15 Hz happened to measure better than 30 Hz,
 * it is not kept when 30 Hz is too coarse. */
static void a_coarser_update_rate_is_never_better(void **state)
{
    static const float odd[NOH_UPDATE_RATE_COUNT] = { 0.0f, 0.02f, 0.005f, 0.03f };
    noh_lod_table t = table_of();
    noh_lod_settings s = settings_of(1.0f);
    noh_lod d;
    (void)state;
    memset(&d, 0, sizeof d);
    noh_lod_choose(&d, &t, &s, 1.0f, odd, 0);
    assert_int_equal(d.update_rate, 3);
    noh_lod_choose(&d, &t, &s, 31.5f, odd, 800); /* allows 0.0143 m of error in time */
    assert_int_equal(d.update_rate, 0);
}

static void equal_targets_are_left_out_by_index(void **state)
{
    const float weights[5] = { 0.5f, -0.5f, 0.5f, 0.0f, 0.5f }, radius[5] = { 0.01f, 0.01f, 0.01f, 0.01f, 0.01f };
    noh_lod_settings s = settings_of(1.0f);
    float kept[5];
    noh_lod d;
    (void)state;
    memset(&d, 0, sizeof d);
    d.pixels_per_metre = 0.1f / 0.0125f; /* room for two of 5 mm */
    assert_int_equal(noh_lod_targets(&d, &s, weights, radius, 5, kept), 2);
    assert_true(kept[0] == 0.0f && kept[1] == 0.0f && kept[2] == 0.5f && kept[4] == 0.5f);
    assert_true(fabsf(d.skipped_m - 0.01f) < 1e-8f);
}

/* Where a smaller target no longer fits, no larger one is left out in its place, whatever their order. */
static void a_larger_target_is_never_left_out_first(void **state)
{
    const float weights[4] = { 0.6f, 0.5f, 0.5f, 0.5f }, radius[4] = { 0.01f, 0.01f, 0.01f, 0.01f };
    noh_lod_settings s = settings_of(1.0f);
    float kept[4];
    noh_lod d;
    (void)state;
    memset(&d, 0, sizeof d);
    d.pixels_per_metre = 0.1f / 0.0115f;
    assert_int_equal(noh_lod_targets(&d, &s, weights, radius, 4, kept), 2);
    assert_true(kept[0] == 0.6f && kept[1] == 0.0f && kept[2] == 0.0f && kept[3] == 0.5f);
}

static void odd_weights_are_kept(void **state)
{
    float weights[4] = { NAN, INFINITY, 1.0f, -INFINITY };
    const float radius[4] = { 0.01f, 0.01f, 0.01f, 0.0f }; /* the last: infinity times 0 */
    noh_lod_settings s = settings_of(1.0f);
    noh_lod d;
    (void)state;
    memset(&d, 0, sizeof d);
    d.pixels_per_metre = 1e-6f;
    assert_int_equal(noh_lod_targets(&d, &s, weights, radius, 4, weights), 3);
    assert_true(weights[2] == 0.0f && isnan(weights[0]));
    assert_int_equal(noh_lod_targets(&d, &s, weights, radius, 0, weights), 0);
    assert_true(d.skipped_m == 0.0f);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_fields_broken_in_turn),
        cmocka_unit_test(settings_fields_broken_in_turn),
        cmocka_unit_test(scale_is_that_of_the_perspective),
        cmocka_unit_test(fresh_choice_is_monotone_and_within_the_quality_setting),
        cmocka_unit_test(an_empty_table_gives_full_detail),
        cmocka_unit_test(influences_are_those_that_the_mesh_has),
        cmocka_unit_test(trembling_never_flickers),
        cmocka_unit_test(random_walks_keep_all_bounds),
        cmocka_unit_test(slow_zoom_passes_each_level_once),
        cmocka_unit_test(a_limit_holds_finer_levels_back),
        cmocka_unit_test(a_limit_fades_out_finer_levels),
        cmocka_unit_test(clocks_at_the_ends),
        cmocka_unit_test(fades_are_smooth_and_one_at_a_time),
        cmocka_unit_test(a_fixed_level_does_not_influence_later_choices),
        cmocka_unit_test(skipped_targets_are_the_smallest_and_bounded),
        cmocka_unit_test(fades_follow_the_smoothstep),
        cmocka_unit_test(errors_of_all_kinds_add_up),
        cmocka_unit_test(a_coarser_update_rate_is_never_better),
        cmocka_unit_test(equal_targets_are_left_out_by_index),
        cmocka_unit_test(a_larger_target_is_never_left_out_first),
        cmocka_unit_test(odd_weights_are_kept),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
