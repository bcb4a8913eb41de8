/* Tests of sync.c: phases, leaders, and the speeds that keep a group in step. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "support/clip_set_fixture.h"
#include "motion/anim/sync_internal.h"
#include "motion/anim/time_internal.h"

#define GROUP 3u

/* The position of a tick and a part of it. */
static int64_t at(double ticks)
{
    return (int64_t)(ticks * 65536.0);
}

static noh_track synced(uint32_t clip, float weight, double tick)
{
    noh_track t;
    memset(&t, 0, sizeof t);
    t.clip = (uint16_t)clip;
    t.weight = weight;
    t.speed = NOH_SPEED_ONE;
    t.speed_now = NOH_SPEED_ONE;
    t.loop = NOH_LOOP_REPEAT;
    t.mode = NOH_TRACK_ON;
    t.sync_group = GROUP;
    t.position = t.root_position = at(tick);
    return t;
}

static void expect_phase(const scene *s, uint32_t clip, double tick, int64_t interval, double fraction)
{
    const noh_phase p = noh_sync_phase(&s->set, &s->clips[clip], at(tick));
    assert_int_equal(p.interval, interval);
    assert_true(fabs(p.fraction - fraction) < 1e-12);
}

/* Phase 0 is the smallest id, wherever it lies; the last interval goes over the seam; passes do not count. */
static void phases_are_counted_from_the_smallest_id(void **state)
{
    scene s;
    (void)state;
    scene_open(&s);
    expect_phase(&s, WALK, 1000, 0, 0.0); /* ids 0 at 1,000 and 1 at 25,000 of 48,000 */
    expect_phase(&s, WALK, 13000, 0, 0.5);
    expect_phase(&s, WALK, 25000, 1, 0.0);
    expect_phase(&s, WALK, 37000, 1, 0.5);
    expect_phase(&s, WALK, 0, 1, 23.0 / 24.0);
    expect_phase(&s, WALK, 13000 - 48000, 0, 0.5);
    expect_phase(&s, WALK, 37000 + 96000, 1, 0.5);
    expect_phase(&s, RUN, 18000, 0, 0.0); /* ids 1 at 2,000 and 0 at 18,000 of 30,000 */
    expect_phase(&s, RUN, 2000, 1, 0.0);
    expect_phase(&s, RUN, 10000, 1, 0.5);
    expect_phase(&s, RUN, 25000, 0, 0.5);
    expect_phase(&s, LEAN, 24000, 0, 0.25); /* no markers: one interval */
}

/* Of several markers with the smallest id, the first is where phase 0 lies. */
static void equal_ids_begin_with_the_first(void **state)
{
    scene s;
    (void)state;
    scene_open(&s);
    s.clips[WALK].marker_count = 4;
    for (uint32_t i = 0; i < 4; i++) {
        s.markers[i].id = i % 2u;
        s.markers[i].tick = 1000u + 12000u * i;
    }
    expect_phase(&s, WALK, 1000, 0, 0.0);
    expect_phase(&s, WALK, 25000, 2, 0.0);
}

/* A phase goes back to the position that it was taken from, to the 1/65,536 tick. */
static void positions_survive_the_round_trip(void **state)
{
    scene s;
    (void)state;
    scene_open(&s);
    for (uint32_t m = WALK; m <= RUN; m++) {
        const int64_t duration = noh_position_of(s.clips[m].duration_ticks);
        for (int64_t p = 0; p < duration; p += 1234577) {
            assert_int_equal(noh_sync_position(&s.set, &s.clips[m], noh_sync_phase(&s.set, &s.clips[m], p)), p);
        }
    }
}

static void clips_fit_by_the_cycle_of_their_ids(void **state)
{
    scene s;
    (void)state;
    scene_open(&s);
    assert_true(noh_sync_fits(&s.set, &s.clips[WALK], &s.clips[RUN])); /* 0 1 and 1 0 are one cycle */
    assert_false(noh_sync_fits(&s.set, &s.clips[WALK], &s.clips[LEAN]));
    assert_true(noh_sync_fits(&s.set, &s.clips[LEAN], &s.clips[WAVE]));
    s.markers[3].id = 7;
    assert_false(noh_sync_fits(&s.set, &s.clips[WALK], &s.clips[RUN]));
}

static void the_heaviest_leads_the_lowest_of_equals(void **state)
{
    scene s;
    noh_track t[4];
    (void)state;
    scene_open(&s);
    t[0] = synced(WALK, 0.5f, 0);
    t[1] = synced(RUN, 2.0f, 0);
    t[2] = synced(WALK, 2.0f, 0);
    t[3] = synced(RUN, 9.0f, 0);
    t[3].sync_group = GROUP + 1u;
    assert_int_equal(noh_sync_leader(t, 4, GROUP), 1);
    t[1].mode = NOH_TRACK_OFF;
    assert_int_equal(noh_sync_leader(t, 4, GROUP), 2);
    t[2].mode = NOH_TRACK_TIME_ONLY; /* its time still runs */
    assert_int_equal(noh_sync_leader(t, 4, GROUP), 2);
    assert_int_equal(noh_sync_leader(t, 4, GROUP + 2u), 4);
}

/* The follower is placed on the leader's phase in the pass in which it is, or the neighbour where that is nearer. */
static void joining_goes_the_shorter_way(void **state)
{
    scene s;
    noh_track leader, follower;
    (void)state;
    scene_open(&s);
    leader = synced(WALK, 1.0f, 13000); /* interval 0, half: 25,000 of the run */
    follower = synced(RUN, 1.0f, 5 * 30000 + 23000);
    noh_sync_join(&s.set, &follower, &leader);
    assert_int_equal(follower.position, at(5 * 30000 + 25000));
    follower.position = at(5 * 30000 + 1000);
    noh_sync_join(&s.set, &follower, &leader);
    assert_int_equal(follower.position, at(4 * 30000 + 25000));
    follower.position = at(-29000);
    noh_sync_join(&s.set, &follower, &leader);
    assert_int_equal(follower.position, at(-30000 - 5000));
}

/* Without markers an interval is a clip: the group's speed is the mean of 1 / duration, by weight. */
static void a_group_moves_at_its_weighted_mean(void **state)
{
    scene s;
    noh_track t[3];
    double mean;
    (void)state;
    scene_open(&s);
    s.clips[WALK].marker_count = s.clips[RUN].marker_count = 0;
    t[0] = synced(WALK, 3.0f, 0);
    t[1] = synced(RUN, 1.0f, 0);
    t[2] = synced(RUN, 2.0f, 0);
    t[2].mode = NOH_TRACK_OFF;
    t[2].speed_now = 77;
    noh_sync_speeds(&s.set, t, 3, 480);
    mean = (3.0 / 48000.0 + 1.0 / 30000.0) / 4.0;
    assert_true(fabs((double)t[0].speed_now - mean * 48000.0 * 65536.0) <= 0.5);
    assert_true(fabs((double)t[1].speed_now - mean * 30000.0 * 65536.0) <= 1.5);
    assert_int_equal(t[2].speed_now, 77); /* a track that is off neither weighs nor moves */
    t[0].weight = t[1].weight = 0.0f;     /* no weights: the leader's own speed */
    noh_sync_speeds(&s.set, t, 3, 480);
    assert_int_equal(t[0].speed_now, NOH_SPEED_ONE);
}

/* After the ticks for which its present speed was set, a follower is on the leader's phase within half a unit a tick,
 * wherever both began. */
static void followers_arrive_on_the_phase(void **state)
{
    scene s;
    (void)state;
    scene_open(&s);
    for (int k = 0; k < 400; k++) {
        noh_track t[2] = { synced(WALK, 2.0f, 117.25 * k), synced(RUN, 1.0f, 0) };
        noh_phase goal;
        int64_t off;
        noh_sync_join(&s.set, &t[1], &t[0]);
        t[1].position += k % 7; /* a little off */
        noh_sync_speeds(&s.set, t, 2, 480);
        goal = noh_sync_phase(&s.set, &s.clips[WALK], t[0].position + 480 * t[0].speed_now);
        off = t[1].position + 480 * t[1].speed_now - noh_sync_position(&s.set, &s.clips[RUN], goal);
        off -= noh_floor_div(off + at(15000), at(30000)) * at(30000);
        assert_true(off >= -241 && off <= 241);
    }
}

/* A phase comes once in every pass. At high speeds a leader covers whole passes in one stretch, and its follower takes
 * the position of as many: not the nearest to where it is. */
static void followers_cover_as_many_passes_as_their_leader(void **state)
{
    scene s;
    (void)state;
    scene_open(&s);
    s.clips[WALK].marker_count = s.clips[RUN].marker_count = 0;
    for (int eighths = -40; eighths <= 40; eighths++) {
        noh_track t[2] = { synced(WALK, 1.0f, 0), synced(RUN, 0.0f, 0) };
        t[0].speed = eighths * NOH_SPEED_ONE; /* an eighth of a pass in 6,000 ticks */
        noh_sync_speeds(&s.set, t, 2, 6000);
        assert_int_equal(t[0].speed_now, t[0].speed);
        assert_int_equal(t[1].speed_now, t[0].speed / 8 * 5); /* 30,000 for 48,000 */
    }
}

/* A follower that is ahead waits; it never moves backwards, and it stops where the leader stops. */
static void followers_never_turn_round(void **state)
{
    scene s;
    noh_track t[2];
    (void)state;
    scene_open(&s);
    s.clips[WALK].marker_count = s.clips[RUN].marker_count = 0;
    for (int sign = -1; sign <= 1; sign += 2) {
        t[0] = synced(WALK, 2.0f, 0);
        t[1] = synced(RUN, 1.0f, sign * 6000); /* a fifth of a pass ahead */
        t[0].speed = t[1].speed = sign * NOH_SPEED_ONE;
        noh_sync_speeds(&s.set, t, 2, 480);
        assert_true(sign * t[0].speed_now > 0);
        assert_int_equal(t[1].speed_now, 0);
        t[1].position = at(-sign * 600); /* behind: it hurries, forwards */
        noh_sync_speeds(&s.set, t, 2, 480);
        assert_true(sign * t[1].speed_now > NOH_SPEED_ONE);
        t[0].speed = t[1].speed = 0;
        noh_sync_speeds(&s.set, t, 2, 480);
        assert_true(t[0].speed_now == 0 && t[1].speed_now == 0);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(phases_are_counted_from_the_smallest_id),
        cmocka_unit_test(equal_ids_begin_with_the_first),
        cmocka_unit_test(positions_survive_the_round_trip),
        cmocka_unit_test(clips_fit_by_the_cycle_of_their_ids),
        cmocka_unit_test(the_heaviest_leads_the_lowest_of_equals),
        cmocka_unit_test(joining_goes_the_shorter_way),
        cmocka_unit_test(a_group_moves_at_its_weighted_mean),
        cmocka_unit_test(followers_arrive_on_the_phase),
        cmocka_unit_test(followers_cover_as_many_passes_as_their_leader),
        cmocka_unit_test(followers_never_turn_round),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
