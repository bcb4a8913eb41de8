/* Places written as text (tools/noh/crowd/place_file.h): each line arrives in its field, mistakes are named with their
 * line, and a text that is cut or spoiled anywhere is read or refused; and agents who live there use slots one at a
 * time, with the same bits each time. */
#include "crowd/place_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "crowd/place_life.h"
#include "support/support.h"

static const char town[] = "# a town\n"
                           "area 10 8 -10 -8\n"
                           "agents 0.3 0.5 1.5\n"
                           "wall -3 -2 3 -2 0.4\n"
                           "post 8 3 0.6   # round\n"
                           "step -9 -7 -6 -5 0.3\n"
                           "spawn -9 -7 9 7\n"
                           "goal -7 0 2\n"
                           "goal 7 0\n"
                           "need rest 0.05\r\n"
                           "need fun 0.1\n"
                           "object bench rest 0.5 30\n"
                           "slot -2 -3 180 15 sit\n"
                           "slot 0 -3 90\n"
                           "object \"the drum\" fun 0.5 20\n"
                           "slot 8 5 -90 2.5 dance bow 1.5 - 0.25\n";

static place_file *read_text(const char *text)
{
    place_file *p = NULL;
    model_error error;
    uint32_t line;
    if (place_parse(text, strlen(text), &p, &line, &error)) fail_msg("line %u: %s", line, error.what);
    return p;
}

static void each_line_arrives_in_its_field(void **state)
{
    place_file *p = read_text(town);
    (void)state;
    assert_true(p->area.low[0] == -10.0f && p->area.high[1] == 8.0f);
    assert_true(p->radius == 0.3f && p->speed[0] == 0.5f && p->speed[1] == 1.5f);
    assert_int_equal(p->obstacle_count, 2);
    assert_true(p->obstacles[0].radius == 0.2f && p->obstacles[0].to[0] == 3.0f);
    assert_true(p->obstacles[1].radius == 0.6f && p->obstacles[1].to[1] == 3.0f);
    assert_int_equal(p->step_count, 1);
    assert_true(p->steps[0].height == 0.3f);
    assert_int_equal(p->goal_count, 2);
    assert_true(p->goals[0].radius == 2.0f && p->goals[1].radius == 1.0f);
    assert_int_equal(p->smart.need_count, 2);
    assert_int_equal(p->smart.object_count, 2);
    assert_int_equal(p->smart.slot_count, 3);
    assert_int_equal(p->objects[1].need, 1);
    assert_int_equal(p->objects[1].first_slot, 2);
    assert_int_equal(p->objects[1].going_ticks, 960000);
    assert_int_equal(p->slots[0].use_ticks, 720000);
    assert_string_equal(p->clips[p->slots[2].use_clip - 1u], "dance");
    assert_int_equal(p->slots[1].use_clip, 0);
    assert_string_equal(p->clips[p->slots[2].enter_clip - 1u], "bow");
    assert_int_equal(p->slots[2].enter_ticks, 72000);
    assert_int_equal(p->slots[2].leave_clip, 0);
    assert_int_equal(p->slots[2].leave_ticks, 12000);
    assert_true(p->slots[1].face[0] > 0.999f && p->slots[2].face[0] < -0.999f);
    place_free(p);
}

static void mistakes_are_named_with_their_line(void **state)
{
    static const struct {
        const char *text, *says;
        uint32_t line;
    } bad[] = {
        { "goal 0 0\nspawn 0 0 1 1\n", "add a line `area", 0 },
        { "area 0 0 1 1\ngoal 0 0\n", "nowhere to enter", 0 },
        { "area 0 0 1 1\nspawn 0 0 1 1\n", "agents have no destination", 0 },
        { "area 0 0 1 1\narea 0 0 1 1\n", "given twice", 2 },
        { "area 0 0 0 1\n", "no extent", 1 },
        { "area 0 0 1\n", "Z is missing", 1 },
        { "area 0 0 1 x\n", "not a number", 1 },
        { "area 0 0 1 1e9\n", "it must be", 1 },
        { "area 0 0 1 1 1\n", "one word too many", 1 },
        { "# ...\n\nwal 0 0 1 1\n", "did you mean 'wall'?", 3 },
        { "need rest 0.1\nobject bench rst 1 10\n", "did you mean 'rest'?", 2 },
        { "need rest 0.1\nneed rest 0.2\n", "given twice", 2 },
        { "slot 0 0 0\n", "must follow the line of its object", 1 },
        { "need rest 0.1\nobject bench rest 1 10\nslot 0 0 0 1 sit bow\n", "ENTER_S is missing", 3 },
        { "need rest 0.1\nobject bench rest 1 10\nslot 0 0 0 1 sit bow 1\n", "CLIP is missing", 3 },
        { "area 0 0 9 9\nspawn 0 0 1 1\nneed rest 0.1\nobject bench rest 1 10\n", "no slot", 4 },
        { "area 0 0 9 9\nspawn 0 0 10 1\ngoal 1 1\n", "spawn 1 is not within", 0 },
        { "area 0 0 9 9\nspawn 0 0 1 1\ngoal 1 1\ngoal 1 10\n", "goal 2 is not within", 0 },
        { "agents 0.25 1 0.5\n", "FASTEST is 0.5", 1 },
        { "agents 0.25 1 nan\n", "not finite", 1 },
        { "object \"bench\n", "quote", 1 },
    };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(bad); i++) {
        place_file *p = NULL;
        model_error error;
        uint32_t line = 99;
        assert_int_equal(place_parse(bad[i].text, strlen(bad[i].text), &p, &line, &error), 1);
        if (!strstr(error.what, bad[i].says)) fail_msg("%s: %s", bad[i].text, error.what);
        if (line != bad[i].line) fail_msg("%s: line %u", bad[i].text, line);
        assert_null(p);
    }
}

/* Cut after each byte, and with bytes and lines changed at random. */
static void a_spoiled_text_is_read_or_refused(void **state)
{
    static const char signs[] = "0123456789.-+eE \n\t#\"areaslotobjectgoalneedx\0\377";
    const size_t size = sizeof town - 1u;
    uint32_t seed = 5, read = 0;
    (void)state;
    for (uint32_t turn = 0; turn < 6000u; turn++) {
        const size_t bytes = turn < size ? turn : size;
        char *text = malloc(bytes + 1u);
        place_file *p = NULL;
        model_error error;
        uint32_t line;
        memcpy(text, town, bytes);
        for (uint32_t k = 0; k < turn % 7u && turn >= size; k++) {
            seed = seed * 1664525u + 1013904223u;
            text[(seed >> 8) % bytes] = signs[(seed >> 3) % (sizeof signs - 1u)];
        }
        if (place_parse(text, bytes, &p, &line, &error) == 0) {
            read++;
            place_free(p);
        } else {
            assert_null(p);
            assert_true(error.what[0] && line <= 20u);
        }
        free(text);
    }
    printf("  %u of 6000 were read\n", read);
    assert_true(read > 100u && read < 5900u);
}

/* They use what they need, at most one at a slot, near it and facing nowhere else; twice the same. */
static void who_lives_there_uses_what_it_needs(void **state)
{
    uint32_t hash[2], used = 0;
    (void)state;
    for (int again = 0; again < 2; again++) {
        place_file *p = read_text(town);
        place_life *l = NULL;
        assert_int_equal(place_life_open(p, 40, 3, &l), 0);
        for (uint32_t step = 0; step < 1800u; step++) {
            uint32_t at_slot[3] = { 0, 0, 0 };
            place_life_step(l);
            for (uint32_t i = 0; i < 40u; i++) {
                const noh_smart_use use = place_life_use(l, i);
                if (use.phase < NOH_SMART_ENTERING) continue;
                const noh_crowd_agent *a = place_life_agent(l, i);
                const noh_smart_slot *slot = place_life_slot(l, use.slot);
                const float x = a->position[0] - slot->at[0], z = a->position[1] - slot->at[1];
                at_slot[use.slot]++;
                used++;
                assert_true(x * x + z * z < 0.5f * 0.5f);
            }
            assert_true(at_slot[0] <= 1u && at_slot[1] <= 1u && at_slot[2] <= 1u);
        }
        hash[again] = place_life_hash(l);
        assert_true(place_life_measures(l)->overlap_max < 0.08);
        place_life_close(l);
        place_free(p);
    }
    printf("  %u agent-steps at slots\n", used);
    assert_true(used > 200u);
    assert_int_equal(hash[0], hash[1]);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_line_arrives_in_its_field),
        cmocka_unit_test(mistakes_are_named_with_their_line),
        cmocka_unit_test(a_spoiled_text_is_read_or_refused),
        cmocka_unit_test(who_lives_there_uses_what_it_needs),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
