/* test_events_read.c: callback keys from text files.
 * cross: slow, thousands of damaged files */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/clips/events_read.h"
#include "convert/model/model_build.h"
#include "convert/clips/raw_set.h"

static const char *save(const char *text)
{
    const char *path = test_path("events.txt");
    test_write_file(path, text, strlen(text));
    return path;
}

static event_list *load(const char *text)
{
    event_list *list = NULL;
    model_error error = { "", "" };
    if (events_read(save(text), &list, &error)) fail_msg("refused: %s (%s)", error.what, error.where);
    return list;
}

static void refused(const char *text, const char *what, const char *where)
{
    event_list *list = (event_list *)1;
    model_error error = { "", "" };
    assert_int_equal(events_read(save(text), &list, &error), 1);
    assert_null(list);
    if (!strstr(error.what, what) || strcmp(error.where, where) != 0)
        fail_msg("expected '%s' at '%s', got '%s' at '%s'", what, where, error.what, error.where);
}

static uint64_t payload_of(const event_list *list, uint32_t i)
{
    uint64_t bits = 0;
    for (int k = 7; k >= 0; --k) bits = bits << 8 | list->entries[i].event.payload[k];
    return bits;
}

static void all_forms(void **state)
{
    (void)state;
    event_list *list = load(
        "# steps of the walk\n\nwalk 0.5 step_left\r\n  walk\t1.0 step_right 7 min=0.25 # the heavy one\n"
        "\"a long walk\" 0 \"bell rings\" 0xDEADbeef\nrun 2 x min=1 -3\nrun 2 y 0xffffffffffffffff\nrun 2 z 1.5\nrun "
        "2.5e-1 w 18446744073709551615\n"
        "run 0 x#1 #comment to the end");
    assert_int_equal(list->count, 8);
    assert_string_equal(list->entries[0].clip, "walk");
    assert_string_equal(list->entries[0].event.name, "step_left");
    assert_true(list->entries[0].event.time_s == 0.5 && list->entries[0].event.weight_min == 0.0f);
    assert_int_equal(list->entries[0].line, 3);
    assert_int_equal(payload_of(list, 0), 0);
    assert_int_equal(payload_of(list, 1), 7);
    assert_true(list->entries[1].event.weight_min == 0.25f);
    assert_string_equal(list->entries[2].clip, "a long walk");
    assert_string_equal(list->entries[2].event.name, "bell rings");
    assert_true(payload_of(list, 2) == UINT64_C(0xdeadbeef));
    assert_true(payload_of(list, 3) == (uint64_t)-3 && list->entries[3].event.weight_min == 1.0f);
    assert_true(payload_of(list, 4) == UINT64_MAX && payload_of(list, 6) == UINT64_MAX);
    double real;
    uint64_t bits = payload_of(list, 5);
    memcpy(&real, &bits, sizeof real);
    assert_true(real == 1.5);
    assert_true(list->entries[6].event.time_s == 0.25);
    assert_string_equal(list->entries[7].event.name, "x#1");
    events_free(list);
    list = load("");
    assert_int_equal(list->count, 0);
    events_free(list);
}

static void markers_are_told_from_keys(void **state)
{
    (void)state;
    event_list *list = load("walk 0.5 left marker # a foot\nmarker 0.5 marker\nwalk 1 \"marker\" 3\n");
    assert_int_equal(list->count, 3);
    assert_int_equal(list->entries[0].event.is_marker, 1);
    assert_string_equal(list->entries[0].event.name, "left");
    assert_int_equal(list->entries[1].event.is_marker, 0); /* a clip and a key may be called so */
    assert_string_equal(list->entries[1].event.name, "marker");
    assert_int_equal(list->entries[2].event.is_marker, 0);
    events_free(list);
}

static void bad_lines_are_refused(void **state)
{
    (void)state;
    refused("walk 1 left marker 7\n", "'7' follows marker", "line 1");
    refused("walk 1 left marker min=1\n", "follows marker", "line 1");
    refused("walk 1 left marker marker\n", "follows marker", "line 1");
    refused("walk 1 left 7 marker\n", "'marker' must be", "line 1");
    refused("walk\n", "the time is missing", "line 1");
    refused("# c\nwalk 1 # x\n", "the name is missing", "line 2");
    refused("walk x step\n", "'x' is not a number", "line 1");
    refused("walk nan step\n", "not finite", "line 1");
    refused("walk -1 step\n", "negative", "line 1");
    refused("walk 1 step 1 2\n", "'2' must be", "line 1");
    refused("walk 1 step min=1 min=2\n", "must be a payload", "line 1");
    refused("walk 1 step min=-1\n", "min must be 0 or more", "line 1");
    refused("walk 1 step min=\n", "must be a payload", "line 1");
    refused("walk 1 step 0x\n", "must be a payload", "line 1");
    refused("walk 1 step 0x11112222333344445\n", "must be a payload", "line 1");
    refused("walk 1 step 18446744073709551616\n\n", "must be a payload", "line 1");
    refused("walk 1 step -9223372036854775809.x\n", "must be a payload", "line 1");
    refused("\n\n\"walk 1 step\n", "quote is not closed", "line 3");
    refused("\"\" 1 step\n", "name is empty", "line 1");
}

static raw_set *set_with_clips(void)
{
    raw_set *set = raw_set_new(1, 2);
    assert_non_null(set);
    for (uint32_t i = 0; i < 2; ++i) {
        assert_int_equal(raw_clip_alloc(&set->clips[i], 31, 1), 0);
        set->clips[i].sample_rate_hz = 30.0;
        set->clips[i].name = model_string(i ? "run" : "walk");
    }
    return set;
}

static void keys_go_to_their_clips_in_order(void **state)
{
    (void)state;
    model_error error = { "", "" };
    event_list *list = load("walk 0.9 c\nwalk 0.1 a\nrun 1.00005 end 5\nwalk 0.1 b\nwalk 0 first\n");
    raw_set *sets[2] = { set_with_clips(), set_with_clips() };
    assert_int_equal(events_apply(list, sets, 2, &error), 0);
    static const char *const order[4] = { "first", "a", "b", "c" };
    assert_int_equal(sets[0]->clips[0].event_count, 4);
    for (int i = 0; i < 4; ++i) assert_string_equal(sets[0]->clips[0].events[i].name, order[i]);
    assert_true(sets[0]->clips[1].events[0].time_s == 1.0); /* rounded past the end: moved to it */
    assert_int_equal(sets[0]->clips[1].events[0].payload[0], 5);
    assert_int_equal(sets[1]->clips[0].event_count, 0); /* once, though two sets have the clip */
    raw_set_free(sets[0]);
    raw_set_free(sets[1]);
    events_free(list);
}

static void apply_refused(const char *text, const char *what, const char *where)
{
    model_error error = { "", "" };
    event_list *list = load(text);
    raw_set *set = set_with_clips();
    assert_int_equal(events_apply(list, &set, 1, &error), 1);
    if (!strstr(error.what, what) || strcmp(error.where, where) != 0)
        fail_msg("expected '%s' at '%s', got '%s' at '%s'", what, where, error.what, error.where);
    raw_set_free(set);
    events_free(list);
}

static void keys_without_a_place_are_refused(void **state)
{
    (void)state;
    apply_refused("walk 0 a\n\nhop 0 a\n", "there is no clip 'hop'", "line 3");
    apply_refused("walk 1.01 a\n", "past the end of clip 'walk' at 1 s", "line 1");
}

static void mutations_never_crash(void **state)
{
    (void)state;
    const char *text = "walk 0.5 step_left 0x12 min=0.25 # c\n\"a b\" 1 c -3\n";
    const char bytes[] = " \n\"#0123456789-+.eEx=\t\0\xff";
    const char *given = getenv("NOH_FUZZ_ROUNDS");
    const uint32_t rounds = given ? (uint32_t)strtoul(given, NULL, 10) : 20000;
    test_random r = test_random_from(5);
    uint32_t accepted = 0;
    for (uint32_t i = 0; i < rounds; ++i) {
        char changed[128];
        size_t length = strlen(text);
        memcpy(changed, text, length);
        for (uint32_t n = 1 + test_random_below(&r, 4); n > 0; --n)
            changed[test_random_below(&r, (uint32_t)length)] = bytes[test_random_below(&r, sizeof bytes - 1)];
        event_list *list = NULL;
        model_error error = { "", "" };
        test_write_file(test_path("mutated.txt"), changed, length);
        accepted += !events_read(test_path("mutated.txt"), &list, &error);
        events_free(list);
    }
    assert_true(accepted > 0 && accepted < rounds);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(all_forms),
    cmocka_unit_test(markers_are_told_from_keys),
    cmocka_unit_test(bad_lines_are_refused),
    cmocka_unit_test(keys_go_to_their_clips_in_order),
    cmocka_unit_test(keys_without_a_place_are_refused),
    cmocka_unit_test(mutations_never_crash),
};

TEST_MAIN(tests, NULL, NULL)
