/* Tests of lod_pools.c: slots of several sizes, shared out by priority. */
#include "support/support.h"
#include "stage/character/lod_pools_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define INSTANCES 60u

static const uint32_t levels[3] = { 0, 1, 3 }, slots[3] = { 4, 16, 40 };
static const noh_lod_pools_desc three = { INSTANCES, 3, levels, slots, 0 };

static noh_lod_pools *pools_open(const noh_lod_pools_desc *desc)
{
    size_t bytes = noh_lod_pools_size(desc);
    noh_lod_pools *p;
    void *memory = test_aligned(NULL, bytes);
    assert_int_equal(noh_lod_pools_init(memory, bytes, desc, &p, NULL), NOH_OK);
    assert_ptr_equal(p, memory);
    return p;
}

static void ask(noh_lod_pools *p, uint32_t instance, uint32_t level, float priority)
{
    noh_lod_pools_ask_at(p, instance, level, priority, 0.0f, 0);
}

static void share(noh_lod_pools *p)
{
    noh_lod_pools_share_some(p, UINT32_MAX);
}

/* ---- descs, memory ---- */

static void bad(noh_lod_pools_desc d, const char *what)
{
    static uint8_t memory[4096] __attribute__((aligned(16)));
    noh_lod_pools *p = NULL;
    noh_error error;
    assert_int_equal(noh_lod_pools_size(&d), 0);
    assert_int_equal(noh_lod_pools_init(memory, sizeof memory, &d, &p, &error), NOH_ERR_ARG);
    assert_non_null(strstr(error.what, what));
    assert_null(p);
}

static void descs_are_checked(void **state)
{
    static const uint32_t falling[3] = { 1, 1, 2 }, high[3] = { 0, 1, 8 }, none[3] = { 30, 0, 30 };
    static const uint32_t many[3] = { 4, 16, 65517 };
    noh_lod_pools_desc d = three;
    (void)state;
    d = three, d.instance_count = 0, bad(d, "instance_count");
    d = three, d.instance_count = 65537, bad(d, "instance_count");
    d = three, d.pool_count = 0, bad(d, "pool_count");
    d = three, d.pool_count = 9, bad(d, "pool_count");
    d = three, d.levels = NULL, bad(d, "levels");
    d = three, d.levels = falling, bad(d, "levels");
    d = three, d.levels = high, bad(d, "levels");
    d = three, d.slot_counts = NULL, bad(d, "slot_counts");
    d = three, d.slot_counts = none, bad(d, "at least 1");
    d = three, d.slot_counts = many, bad(d, "NOH_LOD_POOL_SLOTS_MAX");
}

static void the_size_is_exact(void **state)
{
    const size_t bytes = noh_lod_pools_size(&three);
    uint8_t *memory = test_aligned(NULL, bytes + 64u);
    noh_lod_pools *p = NULL;
    noh_error error;
    (void)state;
    memset(memory, 0xa5, bytes + 64u);
    assert_int_equal(noh_lod_pools_init(memory, bytes - 1u, &three, &p, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, bytes);
    assert_int_equal(noh_lod_pools_init(memory + 1, bytes, &three, &p, &error), NOH_ERR_ARG);
    assert_null(p);
    for (size_t i = 0; i < bytes + 64u; i++) assert_int_equal(memory[i], 0xa5);
    assert_int_equal(noh_lod_pools_init(memory, bytes, &three, &p, NULL), NOH_OK);
    for (uint32_t frame = 0; frame < 5; frame++) {
        noh_lod_pools_begin(p);
        for (uint32_t i = 0; i < INSTANCES; i++) ask(p, i, (i + frame) % 4u, (float)i);
        share(p);
    }
    for (size_t i = bytes; i < bytes + 64u; i++) assert_int_equal(memory[i], 0xa5);
    free(memory);
}

/* ---- sharing ---- */

typedef struct wish {
    int asks;
    uint32_t level;
    float priority;
} wish;

static void ask_all(noh_lod_pools *p, const wish *wishes)
{
    noh_lod_pools_begin(p);
    for (uint32_t i = 0; i < INSTANCES; i++) {
        if (wishes[i].asks) ask(p, i, wishes[i].level, wishes[i].priority);
    }
    share(p);
}

/* No slot twice, none past its pool's end, none finer than its pool, and the counts are right. */
static void expect_sound(const noh_lod_pools *p, const wish *wishes)
{
    const noh_lod_pools_stats *stats = noh_lod_pools_stats_of(p);
    uint32_t asked = 0, coarser = 0, used[3] = { 0, 0, 0 };
    uint8_t taken[3][INSTANCES];
    memset(taken, 0, sizeof taken);
    for (uint32_t i = 0; i < INSTANCES; i++) {
        noh_lod_slot s;
        if (!wishes[i].asks) continue;
        s = noh_lod_pools_slot(p, i);
        assert_true(s.pool < 3 && s.slot < slots[s.pool] && !taken[s.pool][s.slot]);
        assert_int_equal(s.level, wishes[i].level > levels[s.pool] ? wishes[i].level : levels[s.pool]);
        taken[s.pool][s.slot] = 1;
        used[s.pool]++;
        asked++;
        coarser += s.level > wishes[i].level;
    }
    assert_int_equal(stats->asked, asked);
    assert_int_equal(stats->coarser, coarser);
    assert_memory_equal(stats->used, used, sizeof used);
}

/* Where an instance is given a coarser level than it asked for, all slots that would do went to instances of at least
 * its priority. */
static void expect_fair(const noh_lod_pools *p, const wish *wishes)
{
    for (uint32_t i = 0; i < INSTANCES; i++) {
        noh_lod_slot own;
        if (!wishes[i].asks) continue;
        own = noh_lod_pools_slot(p, i);
        for (uint32_t k = 0; k < INSTANCES && own.level > wishes[i].level; k++) {
            noh_lod_slot other;
            if (!wishes[k].asks) continue;
            other = noh_lod_pools_slot(p, k);
            if (levels[other.pool] <= wishes[i].level) assert_true(wishes[k].priority * 1.2501f >= wishes[i].priority);
        }
        if (own.level > wishes[i].level) {
            for (uint32_t q = 0; q < 3; q++) {
                assert_true(levels[q] > wishes[i].level || noh_lod_pools_stats_of(p)->used[q] == slots[q]);
            }
        }
    }
}

static void all_get_a_slot_by_priority(void **state)
{
    test_random r = test_random_from(71);
    noh_lod_pools *p = pools_open(&three);
    uint32_t with = 0, without = 0;
    wish wishes[INSTANCES];
    (void)state;
    for (int round = 0; round < 2000; round++) {
        const uint32_t finest = test_random_below(&r, 4), rush = test_random_below(&r, 4);
        for (uint32_t i = 0; i < INSTANCES; i++) {
            if (round % 3 && test_random_below(&r, 8)) continue; /* most requests stay the same */
            wishes[i].asks = test_random_below(&r, 4) != 0;
            wishes[i].level = rush ? finest + test_random_below(&r, 8u - finest) : finest;
            wishes[i].priority = test_random_float(&r, 0.0f, 100.0f);
        }
        ask_all(p, wishes);
        expect_sound(p, wishes);
        expect_fair(p, wishes);
        *(noh_lod_pools_stats_of(p)->coarser ? &with : &without) += 1u;
    }
    assert_true(with > 200 && without > 200);
    free(p);
}

static void an_instance_that_keeps_its_pool_keeps_its_slot(void **state)
{
    noh_lod_pools *p = pools_open(&three);
    noh_lod_slot before[INSTANCES];
    wish wishes[INSTANCES];
    (void)state;
    for (uint32_t i = 0; i < INSTANCES; i++) {
        const wish w = { 1, i < 4 ? 0u : i < 20 ? 1u : 3u, 100.0f - (float)i };
        wishes[i] = w;
    }
    ask_all(p, wishes);
    assert_int_equal(noh_lod_pools_stats_of(p)->moved, INSTANCES);
    assert_int_equal(noh_lod_pools_stats_of(p)->coarser, 0);
    for (uint32_t i = 0; i < INSTANCES; i++) before[i] = noh_lod_pools_slot(p, i);
    wishes[2].asks = 0;
    ask_all(p, wishes);
    wishes[2].asks = 1;
    ask_all(p, wishes);
    assert_int_equal(noh_lod_pools_stats_of(p)->moved, 1);
    for (uint32_t i = 0; i < INSTANCES; i++) {
        const noh_lod_slot now = noh_lod_pools_slot(p, i);
        assert_true(now.pool == before[i].pool && now.slot == before[i].slot);
    }
    wishes[7].level = 3; /* the last of the far ones moves to a slot that is finer than it needs */
    ask_all(p, wishes);
    assert_int_equal(noh_lod_pools_stats_of(p)->moved, 2);
    assert_int_equal(noh_lod_pools_slot(p, 7).pool, 2);
    assert_int_equal(noh_lod_pools_slot(p, INSTANCES - 1u).pool, 1);
    assert_int_equal(noh_lod_pools_slot(p, INSTANCES - 1u).level, 3);
    free(p);
}

/* Five nearly equal instances, four slots: each keeps its slot until another's priority is a quarter higher. */
static void equals_do_not_take_turns(void **state)
{
    noh_lod_pools *p = pools_open(&three);
    wish wishes[INSTANCES];
    (void)state;
    memset(wishes, 0, sizeof wishes);
    for (uint32_t i = 0; i < 5; i++) {
        const wish w = { 1, 0, 10.0f - 0.1f * (float)i };
        wishes[i] = w;
    }
    ask_all(p, wishes);
    assert_int_equal(noh_lod_pools_slot(p, 4).level, 1);
    for (uint32_t frame = 0; frame < 20; frame++) {
        for (uint32_t i = 0; i < 5; i++) wishes[i].priority = 10.0f + 0.5f * (float)((i + frame) % 5u);
        ask_all(p, wishes);
        assert_int_equal(noh_lod_pools_stats_of(p)->moved, 0);
        assert_int_equal(noh_lod_pools_stats_of(p)->coarser, 1);
    }
    wishes[4].priority = 16.0f;
    ask_all(p, wishes);
    assert_int_equal(noh_lod_pools_slot(p, 4).level, 0);
    assert_int_equal(noh_lod_pools_stats_of(p)->moved, 2);
    assert_int_equal(noh_lod_pools_stats_of(p)->coarser_high_water, 1);
    memset(wishes, 0, sizeof wishes); /* no request: the high-water marks stay */
    ask_all(p, wishes);
    assert_int_equal(noh_lod_pools_stats_of(p)->coarser, 0);
    assert_int_equal(noh_lod_pools_stats_of(p)->coarser_high_water, 1);
    assert_int_equal(noh_lod_pools_stats_of(p)->used_high_water[0], 4);
    free(p);
}

static void odd_priorities_come_last(void **state)
{
    static const float odd[5] = { NAN, -1.0f, 0.0f, INFINITY, 1.0f };
    noh_lod_pools *p = pools_open(&three);
    wish wishes[INSTANCES];
    (void)state;
    memset(wishes, 0, sizeof wishes);
    for (uint32_t i = 0; i < 5; i++) {
        const wish w = { 1, 0, odd[i] };
        wishes[i] = w;
    }
    ask_all(p, wishes);
    for (uint32_t i = 0; i < 5; i++)
        assert_int_equal(noh_lod_pools_slot(p, i).level, i == 2 ? 1u : 0u); /* the last of three equal ones */
    assert_int_equal(noh_lod_pools_stats_of(p)->used_high_water[0], 4);
    free(p);
}

/* Where there is no memory for the full level at all. */
static void pools_may_begin_with_a_coarser_level(void **state)
{
    static const uint32_t coarse[2] = { 2, 3 }, counts[2] = { 1, 1 };
    const noh_lod_pools_desc d = { 2, 2, coarse, counts, 0 };
    noh_lod_pools *p = pools_open(&d);
    (void)state;
    noh_lod_pools_begin(p);
    ask(p, 0, 0, 1.0f);
    ask(p, 1, 1, 2.0f);
    share(p);
    assert_int_equal(noh_lod_pools_slot(p, 1).level, 2);
    assert_int_equal(noh_lod_pools_slot(p, 0).level, 3);
    assert_int_equal(noh_lod_pools_stats_of(p)->coarser, 2);
    free(p);
}

/* Of equal priorities the nearer one comes first, and holding a slot counts nothing for one that asks afresh. */
static void the_nearer_of_equals_comes_first(void **state)
{
    static const uint32_t two[2] = { 0, 1 }, counts[2] = { 1, 8 };
    const noh_lod_pools_desc d = { 6, 2, two, counts, 0 };
    noh_lod_pools *p = pools_open(&d);
    (void)state;
    for (uint32_t nearest = 0; nearest < 6; nearest++) {
        noh_lod_pools_begin(p);
        for (uint32_t i = 0; i < 6; i++) {
            const float distance = i == nearest ? 3.0f : 3.1f + (float)((i * 5u + nearest) % 6u);
            noh_lod_pools_ask_at(p, i, 0, 7.0f, distance, 1);
        }
        share(p);
        for (uint32_t i = 0; i < 6; i++) assert_int_equal(noh_lod_pools_slot(p, i).level == 0, i == nearest);
    }
    for (int afresh = 0; afresh < 2; afresh++) { /* instance 5 holds the slot, 2 is a tenth nearer */
        noh_lod_pools_begin(p);
        noh_lod_pools_ask_at(p, 5, 0, 10.0f, 10.0f, afresh);
        noh_lod_pools_ask_at(p, 2, 0, 11.0f, 9.0f, afresh);
        share(p);
        assert_int_equal(noh_lod_pools_slot(p, 2).level, afresh ? 0 : 1);
    }
    noh_lod_pools_begin(p);
    noh_lod_pools_ask_at(p, 4, 0, 10.0f, NAN, 1); /* no distance: as if it were at the eye */
    share(p);
    assert_int_equal(noh_lod_pools_slot(p, 4).level, 0);
    free(p);
}

/* Six slots; eight actors ask and seven are shown: the first six have one, the seventh rests, the last is left out.
 */
static void who_finds_no_slot_rests_and_who_is_too_many_is_left_out(void **state)
{
    static const uint32_t few[2] = { 2, 4 };
    const noh_lod_pools_desc d = { 8, 2, levels, few, 7 };
    noh_lod_pools *p = pools_open(&d);
    (void)state;
    for (uint32_t round = 0; round < 3; round++) {
        noh_lod_pools_begin(p);
        for (uint32_t i = 0; i < 8; i++) ask(p, i, 1, 100.0f - (float)((i + round) % 8u) * 10.0f);
        share(p);
        for (uint32_t rank = 0; rank < 8; rank++) {
            const uint32_t i = (rank + 8u - round) % 8u;
            const noh_lod_slot s = noh_lod_pools_slot(p, i);
            assert_int_equal(s.pool == NOH_NONE, rank >= 6);
            assert_int_equal(s.left_out, rank == 7);
            assert_int_equal(s.level, 1);
        }
        assert_int_equal(noh_lod_pools_stats_of(p)->resting, 1);
        assert_int_equal(noh_lod_pools_stats_of(p)->left_out, 1);
        assert_int_equal(noh_lod_pools_stats_of(p)->used[0], 2);
        assert_int_equal(noh_lod_pools_stats_of(p)->used[1], 4);
    }
    free(p);
}

/* As expect_sound, for pools in which some wait. */
static void expect_bounded(const noh_lod_pools *p, const wish *wishes, uint32_t moves)
{
    const noh_lod_pools_stats *stats = noh_lod_pools_stats_of(p);
    uint32_t resting = 0, used[3] = { 0, 0, 0 };
    uint8_t taken[3][INSTANCES];
    memset(taken, 0, sizeof taken);
    for (uint32_t i = 0; i < INSTANCES; i++) {
        noh_lod_slot s;
        if (!wishes[i].asks) continue;
        s = noh_lod_pools_slot(p, i);
        resting += s.pool == NOH_NONE;
        if (s.pool == NOH_NONE) continue;
        assert_true(s.pool < 3 && s.slot < slots[s.pool] && !taken[s.pool][s.slot]);
        assert_int_equal(s.level, wishes[i].level > levels[s.pool] ? wishes[i].level : levels[s.pool]);
        taken[s.pool][s.slot] = 1;
        used[s.pool]++;
    }
    assert_true(stats->moved <= moves && resting <= stats->waiting && resting == stats->resting);
    assert_memory_equal(stats->used, used, sizeof used);
}

static void ask_some(noh_lod_pools *p, const wish *wishes, uint32_t moves)
{
    noh_lod_pools_begin(p);
    for (uint32_t i = 0; i < INSTANCES; i++) {
        if (wishes[i].asks) ask(p, i, wishes[i].level, wishes[i].priority);
    }
    noh_lod_pools_share_some(p, moves);
}

/* However the wishes leap, few slots change hands in a frame; once they stay, all settle within as many frames as that
 * takes, and stand as without a bound: fair, and none waits. An actor that holds a slot keeps one meanwhile. */
static void few_slots_change_hands_in_a_frame(void **state)
{
    test_random r = test_random_from(72);
    noh_lod_pools *p = pools_open(&three);
    wish wishes[INSTANCES];
    uint32_t waited = 0, exchanged = 0;
    (void)state;
    for (int round = 0; round < 400; round++) {
        const uint32_t full = round % 3 == 0; /* all ask, so that no slot is free: two have to exchange theirs */
        const uint32_t moves = test_random_below(&r, 7), bound = moves < 2 ? 2 : moves, rush = test_random_below(&r, 3);
        for (uint32_t i = 0; i < INSTANCES; i++) {
            wishes[i].asks = full || test_random_below(&r, 8) != 0;
            wishes[i].level = rush ? test_random_below(&r, 4) : 0;
            wishes[i].priority = test_random_float(&r, 0.0f, 100.0f);
        }
        for (uint32_t frame = 0; frame <= INSTANCES; frame++) {
            uint8_t held[INSTANCES];
            uint32_t holders = 0;
            for (uint32_t i = 0; i < INSTANCES; i++) {
                held[i] = frame && wishes[i].asks && noh_lod_pools_slot(p, i).pool != NOH_NONE;
                holders += held[i];
            }
            ask_some(p, wishes, moves);
            expect_bounded(p, wishes, bound);
            for (uint32_t i = 0; i < INSTANCES; i++) {
                if (held[i]) assert_int_not_equal(noh_lod_pools_slot(p, i).pool, NOH_NONE);
            }
            waited += noh_lod_pools_stats_of(p)->waiting;
            exchanged += holders == INSTANCES && noh_lod_pools_stats_of(p)->moved > 0;
        }
        assert_int_equal(noh_lod_pools_stats_of(p)->waiting, 0);
        assert_int_equal(noh_lod_pools_stats_of(p)->moved, 0);
        expect_sound(p, wishes);
        expect_fair(p, wishes);
    }
    assert_true(waited > 1000 && exchanged > 100);
    free(p);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(descs_are_checked),
    cmocka_unit_test(the_size_is_exact),
    cmocka_unit_test(all_get_a_slot_by_priority),
    cmocka_unit_test(an_instance_that_keeps_its_pool_keeps_its_slot),
    cmocka_unit_test(equals_do_not_take_turns),
    cmocka_unit_test(odd_priorities_come_last),
    cmocka_unit_test(pools_may_begin_with_a_coarser_level),
    cmocka_unit_test(who_finds_no_slot_rests_and_who_is_too_many_is_left_out),
    cmocka_unit_test(the_nearer_of_equals_comes_first),
    cmocka_unit_test(few_slots_change_hands_in_a_frame),
};

TEST_MAIN(tests, NULL, NULL)
