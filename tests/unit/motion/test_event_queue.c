/* Tests of event_queue.c. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <string.h>

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

#define CAPACITY 3u

typedef struct box {
    noh_event events[CAPACITY + 1u];
} box;

static noh_event event_of(int64_t tick)
{
    noh_event e;
    memset(&e, 0, sizeof e);
    e.clock = tick;
    return e;
}

static void push(noh_event_queue *q, int64_t tick)
{
    const noh_event e = event_of(tick);
    noh_event_queue_push(q, &e);
}

static void events_come_out_in_the_order_of_pushing(void **state)
{
    union {
        uint64_t align[2];
        box b;
    } memory __attribute__((aligned(16)));
    noh_event_queue q;
    (void)state;
    assert_int_equal(noh_event_queue_init(&memory, noh_event_queue_size(CAPACITY), CAPACITY, &q, NULL), NOH_OK);
    assert_true(q.count == 0 && q.lost == 0 && q.high_water == 0);
    push(&q, 5);
    push(&q, 2);
    assert_int_equal(q.count, 2);
    assert_true(q.events[0].clock == 5 && q.events[1].clock == 2);
}

/* An event without room is counted; the others, and the bytes past the memory, stay untouched. The counts of lost
 * events and of the most at once survive a clear: they say whether the queue was large enough. */
static void what_finds_no_room_is_counted(void **state)
{
    union {
        uint64_t align[2];
        box b;
    } memory __attribute__((aligned(16)));
    noh_event_queue q;
    noh_event behind;
    (void)state;
    memset(&memory, 0x5a, sizeof memory);
    behind = memory.b.events[CAPACITY];
    assert_int_equal(noh_event_queue_init(&memory, noh_event_queue_size(CAPACITY), CAPACITY, &q, NULL), NOH_OK);
    for (int64_t i = 0; i < 5; i++) push(&q, i);
    assert_true(q.count == CAPACITY && q.lost == 2 && q.high_water == CAPACITY);
    assert_true(q.events[CAPACITY - 1u].clock == 2);
    assert_memory_equal(&memory.b.events[CAPACITY], &behind, sizeof behind);
    noh_event_queue_clear(&q);
    assert_true(q.count == 0 && q.lost == 2 && q.high_water == CAPACITY);
    push(&q, 9);
    assert_true(q.count == 1 && q.high_water == CAPACITY && q.events[0].clock == 9);
}

static void impossible_queues_are_refused(void **state)
{
    union {
        uint64_t align[2];
        box b;
    } memory __attribute__((aligned(16)));
    noh_event_queue q;
    noh_error error;
    const size_t need = noh_event_queue_size(CAPACITY);
    (void)state;
    assert_int_equal(need, CAPACITY * sizeof(noh_event));
    assert_int_equal(noh_event_queue_size((1u << 24) + 1u), 0);
    assert_int_equal(noh_event_queue_init(&memory, sizeof memory, 0, &q, &error), NOH_ERR_ARG);
    assert_int_equal(noh_event_queue_init(NULL, need, CAPACITY, &q, &error), NOH_ERR_ARG);
    assert_int_equal(noh_event_queue_init((uint8_t *)&memory + 4, need, CAPACITY, &q, &error), NOH_ERR_ARG);
    assert_int_equal(noh_event_queue_init(&memory, need - 1u, CAPACITY, &q, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, need);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(events_come_out_in_the_order_of_pushing),
        cmocka_unit_test(what_finds_no_room_is_counted),
        cmocka_unit_test(impossible_queues_are_refused),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
