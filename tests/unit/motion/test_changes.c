/* Tests of changes.c: the table of changes over time. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "support/clip_set_fixture.h"
#include "motion/anim/changes_internal.h"
#include "motion/anim/tracks_internal.h"
#include "noh/base.h"
#include "noh/clip.h"

#define ENTRIES 4u

typedef struct rig {
    scene s;
    noh_track tracks[2];
    float priority;
    noh_change table[ENTRIES];
    noh_change_target target;
} rig;

static void rig_open(rig *r)
{
    memset(r, 0, sizeof *r);
    scene_open(&r->s);
    for (int i = 0; i < 2; i++) {
        const noh_track_desc d = track_of(WALK, 1.0f);
        assert_int_equal(noh_track_start(&r->tracks[i], &r->s.set, &d, NULL), NOH_OK);
    }
    r->target.set = &r->s.set;
    r->target.tracks = r->tracks;
    r->target.priority_blend = &r->priority;
}

static noh_change_desc desc_of(noh_change_kind kind, uint32_t delay, uint32_t duration, float weight)
{
    noh_change_desc d;
    memset(&d, 0, sizeof d);
    d.kind = kind;
    d.delay_ticks = delay;
    d.duration_ticks = duration;
    d.weight = weight;
    return d;
}

static void add(rig *r, noh_change_desc d)
{
    assert_int_equal(noh_changes_add(r->table, ENTRIES, &r->target, 2, &d, NULL), NOH_OK);
}

static void run_to(rig *r, int64_t clock)
{
    while (r->target.clock < clock) {
        r->target.clock++;
        noh_changes_update(r->table, ENTRIES, &r->target);
    }
}

static void curves_at_known_places(void **state)
{
    (void)state;
    for (int curve = NOH_CURVE_LINEAR; curve <= NOH_CURVE_SMOOTHSTEP; curve++) {
        assert_true(noh_curve_at((noh_curve)curve, -1.0f) == 0.0f && noh_curve_at((noh_curve)curve, 0.5f) == 0.5f);
        assert_true(noh_curve_at((noh_curve)curve, 1.0f) == 1.0f && noh_curve_at((noh_curve)curve, 2.0f) == 1.0f);
    }
    assert_true(noh_curve_at(NOH_CURVE_LINEAR, 0.25f) == 0.25f &&
                noh_curve_at(NOH_CURVE_SMOOTHSTEP, 0.25f) == 0.15625f);
}

/* A change that begins takes over from one that runs: the older one may not end it later. */
static void a_change_takes_over_from_the_running_one(void **state)
{
    rig r;
    (void)state;
    rig_open(&r);
    add(&r, desc_of(NOH_CHANGE_WEIGHT, 0, 100, 3.0f));
    add(&r, desc_of(NOH_CHANGE_WEIGHT, 50, 20, 0.5f));
    run_to(&r, 50);
    assert_true(r.tracks[0].weight == 2.0f);
    run_to(&r, 60);
    assert_true(r.tracks[0].weight == 1.25f);
    run_to(&r, 200);
    assert_true(r.tracks[0].weight == 0.5f);
    assert_true(r.tracks[1].weight == 1.0f);
}

/* A change of a weight or speed concerns all members of a sync group, because it changes their mean speed, and no other
 * track. */
static void sync_groups_hear_of_changes(void **state)
{
    rig r;
    (void)state;
    rig_open(&r);
    add(&r, desc_of(NOH_CHANGE_WEIGHT, 0, 10, 0.0f));
    run_to(&r, 10);
    assert_int_equal(r.target.sync_touched, 0);
    r.tracks[0].sync_group = 1;
    add(&r, desc_of(NOH_CHANGE_PRIORITY, 0, 10, 1.0f));
    run_to(&r, 20);
    assert_true(r.target.sync_touched == 0 && r.priority == 1.0f);
    add(&r, desc_of(NOH_CHANGE_WEIGHT, 0, 10, 2.0f));
    run_to(&r, 30);
    assert_true(r.target.sync_touched != 0);
}

/* A track that is started again loses its own changes, waiting ones too; the priority blend belongs to no track. */
static void dropping_a_track_leaves_the_others(void **state)
{
    rig r;
    noh_change_desc other = desc_of(NOH_CHANGE_WEIGHT, 0, 10, 2.0f);
    (void)state;
    rig_open(&r);
    add(&r, desc_of(NOH_CHANGE_PRIORITY, 0, 10, 0.75f));
    add(&r, desc_of(NOH_CHANGE_WEIGHT, 0, 10, 2.0f));
    add(&r, desc_of(NOH_CHANGE_SPEED, 5, 10, 0.0f));
    other.track = 1;
    add(&r, other);
    noh_changes_drop(r.table, ENTRIES, 0);
    run_to(&r, 20);
    assert_true(r.priority == 0.75f && r.tracks[1].weight == 2.0f);
    assert_true(r.tracks[0].weight == 1.0f && r.tracks[0].speed == NOH_SPEED_ONE);
}

/* A second change of the same kind, track and tick replaces the waiting one; when the table is full, it is refused. */
static void a_full_table_refuses_and_replaces(void **state)
{
    rig r;
    noh_change_desc d;
    noh_error error;
    (void)state;
    rig_open(&r);
    for (uint32_t i = 0; i < ENTRIES; i++) add(&r, desc_of(NOH_CHANGE_WEIGHT, 10u + i, 1, 5.0f));
    d = desc_of(NOH_CHANGE_WEIGHT, 30, 1, 6.0f);
    assert_int_equal(noh_changes_add(r.table, ENTRIES, &r.target, 2, &d, &error), NOH_ERR_LIMIT);
    assert_int_equal(error.need, ENTRIES + 1u);
    add(&r, desc_of(NOH_CHANGE_WEIGHT, 13, 1, 7.0f));
    run_to(&r, 40);
    assert_true(r.tracks[0].weight == 7.0f);
}

/* Present speeds hold until the next change is due. */
static void rates_hold_until_something_is_due(void **state)
{
    rig r;
    (void)state;
    rig_open(&r);
    assert_int_equal(noh_changes_speeds(r.table, ENTRIES, &r.target, 2, 1000), 1000);
    assert_int_equal(r.tracks[0].speed_now, NOH_SPEED_ONE);
    add(&r, desc_of(NOH_CHANGE_WEIGHT, 40, 100, 2.0f));
    assert_int_equal(noh_changes_speeds(r.table, ENTRIES, &r.target, 2, 1000), 40);
    run_to(&r, 40);
    assert_int_equal(noh_changes_speeds(r.table, ENTRIES, &r.target, 2, 1000), 140);
}

/* A speed that changes within fewer ticks than the curve has slices takes, in each tick, the curve's value at the
 * middle of that tick; where ticks are no whole number of slices, within a slice. */
static void short_changes_take_the_middle_of_each_tick(void **state)
{
    (void)state;
    for (int curve = NOH_CURVE_LINEAR; curve <= NOH_CURVE_SMOOTHSTEP; curve++) {
        for (uint32_t ticks = 1; ticks <= NOH_CHANGE_SLICES; ticks++) {
            const double slack = NOH_CHANGE_SLICES % ticks ? 1.5 / NOH_CHANGE_SLICES : 1e-6;
            rig r;
            noh_change_desc d = desc_of(NOH_CHANGE_SPEED, 0, ticks, 0.0f);
            rig_open(&r);
            d.speed = -100 * NOH_SPEED_ONE;
            d.curve = (noh_curve)curve;
            add(&r, d);
            for (uint32_t i = 0; i < ticks; i++) {
                const double part = (double)noh_curve_at((noh_curve)curve, ((float)i + 0.5f) / (float)ticks);
                assert_int_equal(noh_changes_speeds(r.table, ENTRIES, &r.target, 2, 1000), i + 1u);
                assert_true(fabs((double)r.tracks[0].speed_now / NOH_SPEED_ONE - (1.0 - 101.0 * part)) <=
                            101.0 * slack);
                run_to(&r, i + 1);
            }
            assert_int_equal(r.tracks[0].speed, d.speed);
        }
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(curves_at_known_places),
        cmocka_unit_test(a_change_takes_over_from_the_running_one),
        cmocka_unit_test(sync_groups_hear_of_changes),
        cmocka_unit_test(dropping_a_track_leaves_the_others),
        cmocka_unit_test(a_full_table_refuses_and_replaces),
        cmocka_unit_test(rates_hold_until_something_is_due),
        cmocka_unit_test(short_changes_take_the_middle_of_each_tick),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
