/* Tests of scheduler.c: budgets are kept, and no instance waits for ever. */
#include "stage/character/scheduler_internal.h"
#include "noh/base.h"
#include "noh/low_core.h"
#include "support/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CROWD 400u
#define FRAME 800u

typedef struct crowd {
    noh_schedule s;
    void *memory;
    int64_t due[CROWD];
    uint32_t cost[CROWD];
    float visibility[CROWD];
    uint32_t last_served[CROWD];
} crowd;

static void crowd_open(crowd *c, uint32_t capacity)
{
    memset(c, 0, sizeof *c);
    c->memory = test_aligned(NULL, noh_schedule_size(capacity));
    assert_int_equal(noh_schedule_init(c->memory, noh_schedule_size(capacity), capacity, &c->s, NULL), NOH_OK);
}

static void memory_is_exact(void **state)
{
    uint8_t *memory = test_aligned(NULL, 16 * 7 + 64);
    noh_schedule s;
    noh_error error;
    uint32_t instance;
    (void)state;
    assert_int_equal(noh_schedule_size(0), 0);
    assert_int_equal(noh_schedule_size(NOH_SCHEDULE_MAX + 1u), 0);
    assert_int_equal(noh_schedule_size(7), 16 * 7);
    memset(memory, 0xa5, 16 * 7 + 64);
    memset(&s, 0x11, sizeof s);
    assert_int_equal(noh_schedule_init(memory, 16 * 7 - 1, 7, &s, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, 16 * 7);
    assert_int_equal(noh_schedule_init(memory + NOH_MEMORY_ALIGN / 2, 16 * 7, 7, &s, &error), NOH_ERR_ARG);
    assert_int_equal(noh_schedule_init(memory, 16 * 7, 0, &s, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, "capacity", strlen("capacity")), 0);
    assert_int_equal(s.capacity, 0x11111111);
    assert_int_equal(noh_schedule_init(memory, 16 * 7, 7, &s, &error), NOH_OK);
    noh_schedule_begin(&s, FRAME, 1000);
    for (uint32_t i = 0; i < 9; i++) noh_schedule_offer(&s, i, i, 1.0f, 1);
    assert_int_equal(s.offered, 7);
    assert_int_equal(s.lost, 2);
    assert_int_equal(s.late_ticks, 8); /* of the offers that were lost, too */
    while (noh_schedule_next(&s, &instance)) assert_true(instance < 7);
    assert_int_equal(s.served, 7);
    for (int i = 16 * 7; i < 16 * 7 + 64; i++) assert_int_equal(memory[i], 0xa5);
    free(memory);
}

typedef struct offer {
    uint64_t urgency;
    uint32_t instance;
} offer;

static int by_urgency(const void *a, const void *b)
{
    const offer *x = a, *y = b;
    if (x->urgency != y->urgency) return x->urgency > y->urgency ? -1 : 1;
    return x->instance < y->instance ? -1 : 1;
}

/* In the order that sorting gives, until the budget is spent. */
static void the_most_urgent_come_first(void **state)
{
    test_random r = test_random_from(31);
    uint32_t sorted = 0;
    crowd c;
    (void)state;
    crowd_open(&c, CROWD);
    for (int round = 0; round < 200; round++) {
        offer offers[CROWD];
        uint32_t instance, count = test_random_below(&r, CROWD), served = 0;
        uint64_t budget = test_random_below(&r, 3000), spent = 0;
        noh_schedule_begin(&c.s, FRAME, budget);
        for (uint32_t i = 0; i < count; i++) {
            uint32_t late = test_random_below(&r, 20), eighths = 8u + test_random_below(&r, 57);
            c.cost[i] = 1u + test_random_below(&r, 30);
            offers[i].instance = i;
            offers[i].urgency = (uint64_t)(late + FRAME + 1u) * eighths;
            noh_schedule_offer(&c.s, i, late, (float)eighths / 8.0f, c.cost[i]);
        }
        if (c.s.offered_cost > budget) { /* else all are served in the order of the offers */
            qsort(offers, count, sizeof *offers, by_urgency);
        }
        while (noh_schedule_next(&c.s, &instance)) {
            assert_int_equal(instance, offers[served].instance);
            assert_true(served == 0 || spent < budget);
            spent += c.cost[instance];
            served++;
        }
        assert_true(served == count || spent >= budget);
        assert_int_equal(c.s.spent, spent);
        assert_int_equal(c.s.served, served);
        sorted += c.s.offered_cost > budget;
    }
    assert_in_range(sorted, 20, 180); /* of 200 rounds: both kinds occur */
    free(c.memory);
}

static void odd_visibilities_are_clamped(void **state)
{
    crowd c;
    uint32_t instance;
    (void)state;
    crowd_open(&c, CROWD);
    noh_schedule_begin(&c.s, FRAME, 100);
    noh_schedule_offer(&c.s, 0, 0, NAN, 1);
    noh_schedule_offer(&c.s, 1, 0, -3.0f, 1);
    noh_schedule_offer(&c.s, 2, 0, INFINITY, 1);
    noh_schedule_offer(&c.s, 3, UINT32_MAX, 0.0f, 1);
    noh_schedule_offer(&c.s, 4, 0, NOH_VISIBILITY_MAX, 1);
    noh_schedule_offer(&c.s, 5, 0, 0.0f, 96); /* a little more than the budget for all of them */
    for (uint32_t i = 0; noh_schedule_next(&c.s, &instance); i++) {
        static const uint32_t order[] = { 3, 2, 4, 0, 1, 5 };
        assert_int_equal(instance, order[i]);
    }
    free(c.memory);
}

static void work_that_cannot_wait_is_charged_to_the_budget(void **state)
{
    crowd c;
    uint32_t instance, served = 0;
    (void)state;
    crowd_open(&c, CROWD);
    noh_schedule_begin(&c.s, FRAME, 100);
    noh_schedule_spend(&c.s, 60);
    for (uint32_t i = 0; i < 20; i++) noh_schedule_offer(&c.s, i, 0, 1.0f, 10);
    while (noh_schedule_next(&c.s, &instance)) served++;
    assert_int_equal(served, 4);
    noh_schedule_begin(&c.s, FRAME, 100);
    noh_schedule_spend(&c.s, 1000);
    noh_schedule_offer(&c.s, 0, 0, 1.0f, 10);
    noh_schedule_offer(&c.s, 1, 0, 1.0f, 10);
    assert_int_equal(noh_schedule_next(&c.s, &instance), 1); /* at least one is served */
    assert_int_equal(noh_schedule_next(&c.s, &instance), 0);
    noh_schedule_begin(&c.s, FRAME, 100);
    assert_int_equal(noh_schedule_next(&c.s, &instance), 0);
    free(c.memory);
}

/* One frame: instances that are due are offered; those that are served are due again after their period. */
static void run_frame(crowd *c, uint32_t count, uint32_t period, uint64_t budget, uint32_t frame)
{
    int64_t clock = (int64_t)frame * FRAME;
    uint32_t instance, largest = 0;
    noh_schedule_begin(&c->s, FRAME, budget);
    for (uint32_t i = 0; i < count; i++) {
        if (c->due[i] <= clock)
            noh_schedule_offer(&c->s, i, (uint32_t)(clock - c->due[i]), c->visibility[i], c->cost[i]);
    }
    while (noh_schedule_next(&c->s, &instance)) {
        c->due[instance] = clock + 1 + period;
        c->last_served[instance] = frame;
        largest = c->cost[instance] > largest ? c->cost[instance] : largest;
    }
    assert_true(c->s.spent < budget + (largest ? largest : 1u));
}

/* With visibilities and costs of every kind, fixed or changing from frame to frame, no instance waits longer than the
 * stated bound, and the lateness in the statistics is the worst one. */
static void no_instance_waits_longer_than_stated(void **state)
{
    test_random r = test_random_from(32);
    double closest = 0.0;
    (void)state;
    for (int round = 0; round < 60; round++) {
        uint32_t count = 2u + test_random_below(&r, CROWD - 2u), cost_max = 1u + test_random_below(&r, 50), longest = 0;
        uint64_t budget = 1u + test_random_below(&r, cost_max * 20u),
                 bound = noh_schedule_wait_max(count, budget, cost_max);
        uint32_t period = (uint32_t)round % 3u * 1600u;
        crowd c;
        crowd_open(&c, CROWD);
        for (uint32_t i = 0; i < count; i++) {
            c.cost[i] = round % 2 ? cost_max : 1u + test_random_below(&r, cost_max);
            c.visibility[i] = round % 4 < 2 ? (i % 10 ? NOH_VISIBILITY_MAX : 1.0f) : test_random_float(&r, 0.0f, 10.0f);
        }
        for (uint32_t frame = 1; frame < 4 * (uint32_t)bound && frame < 8000; frame++) {
            uint32_t worst = 0;
            for (uint32_t i = 0; i < count; i++) {
                int64_t late = (int64_t)frame * FRAME - c.due[i];
                worst = late > (int64_t)worst ? (uint32_t)late : worst;
                if (round % 5 == 4) c.visibility[i] = test_random_float(&r, 1.0f, 8.0f);
            }
            run_frame(&c, count, period, budget, frame);
            assert_int_equal(c.s.late_ticks, worst);
            longest = worst > longest ? worst : longest;
        }
        assert_true(longest <= bound * FRAME);
        assert_int_equal(c.s.late_high_water, longest);
        closest = fmax(closest, (double)longest / (double)(bound * FRAME));
        free(c.memory);
    }
    print_message("the longest wait was %.2f of the bound\n", closest);
    assert_true(closest > 0.1); /* the bound is not far too high */
}

/* With enough budget for the mean, lateness is at most the time that a burst takes to work off. */
static void the_most_visible_wait_least(void **state)
{
    crowd c;
    uint32_t worst[2] = { 0, 0 };
    (void)state;
    crowd_open(&c, CROWD);
    for (uint32_t i = 0; i < CROWD; i++) {
        c.cost[i] = 10;
        c.visibility[i] = i % 4 ? 1.0f : 8.0f;
    }
    for (uint32_t frame = 1; frame < 2000; frame++) {
        for (uint32_t i = 0; i < CROWD; i++) {
            uint32_t late = (int64_t)frame * FRAME > c.due[i] ? (uint32_t)((int64_t)frame * FRAME - c.due[i]) : 0;
            if (frame > 200 && late > worst[i % 4 == 0]) worst[i % 4 == 0] = late;
        }
        run_frame(&c, CROWD, 0, 10u * CROWD / 8u, frame); /* an eighth of the crowd in a frame */
    }
    print_message("worst lateness: %u ticks of the most visible quarter, %u of the others\n", worst[1], worst[0]);
    assert_true(4u * worst[1] < worst[0]);
    free(c.memory);
}

static void costs_add_up(void **state)
{
    noh_cost_weights w = { 100.0f, 2.5f, 1.25f, 3.0f };
    (void)state;
    assert_int_equal(noh_cost_ns(&w, 0, 0, 0), 100);
    assert_int_equal(noh_cost_ns(&w, 62, 1000, 2000), 100 + 155 + 1250 + 6000);
    assert_int_equal(noh_cost_ns(&w, 1, 0, 0), 103);
    memset(&w, 0, sizeof w);
    assert_int_equal(noh_cost_ns(&w, 5, 5, 5), 1);
    w.per_vertex = 1e6f;
    assert_int_equal(noh_cost_ns(&w, 0, 0, 1000000), UINT32_MAX);
    assert_int_equal(noh_schedule_wait_max(0, 10, 1), 16);
    assert_int_equal(noh_schedule_wait_max(101, 20, 2), 8 * (10 + 2));
    assert_int_equal(noh_schedule_wait_max(12, 9, 3),
                     8 * (4 + 2)); /* eleven others, three a frame: the last is served in the fourth */
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(memory_is_exact),
        cmocka_unit_test(the_most_urgent_come_first),
        cmocka_unit_test(odd_visibilities_are_clamped),
        cmocka_unit_test(work_that_cannot_wait_is_charged_to_the_budget),
        cmocka_unit_test(no_instance_waits_longer_than_stated),
        cmocka_unit_test(the_most_visible_wait_least),
        cmocka_unit_test(costs_add_up),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
