/* Tests of clip_set.c: a set with only the required fields; broken fields are in test_controller.c. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "noh/base.h"
#include "noh/clip.h"

static void rest(void *user, uint32_t clip, uint32_t clip_tick, uint32_t joint_count, noh_transform *pose,
                 uint32_t float_count, float *floats)
{
    (void)user, (void)clip, (void)clip_tick;
    memset(pose, 0, joint_count * sizeof *pose);
    memset(floats, 0, float_count * sizeof *floats);
}

/* No keys, no markers, no masks, no defaults: their arrays may be NULL. */
static void arrays_of_nothing_may_be_null(void **state)
{
    noh_clip_entry clips[2];
    noh_transform bind;
    noh_clip_set set;
    noh_error error = { NOH_OK, NULL, 0, 0 };
    (void)state;
    memset(clips, 0, sizeof clips);
    memset(&bind, 0, sizeof bind);
    memset(&set, 0, sizeof set);
    clips[0].loop = clips[1].loop = NOH_LOOP_ONCE;
    clips[1].name_hash = 7;
    set.clip_count = 2;
    set.joint_count = 1;
    set.clips = clips;
    set.bind_pose = &bind;
    set.sample = rest;
    assert_int_equal(noh_clip_set_check(&set, &error), NOH_OK);
    assert_int_equal(noh_clip_set_find(&set, 7), 1);
    assert_int_equal(noh_clip_set_find(&set, 8), NOH_NONE);
    clips[1].first_marker = 1;
    assert_int_equal(noh_clip_set_check(&set, &error), NOH_ERR_DATA);
    assert_int_equal(error.where, 1);
    assert_non_null(strstr(error.what, "markers of a clip lie outside"));
    clips[1].first_marker = 0, clips[1].event_count = 1;
    assert_int_equal(noh_clip_set_check(&set, &error), NOH_ERR_DATA);
    assert_non_null(strstr(error.what, "events of a clip lie outside"));
    clips[1].event_count = 0, set.marker_count = 1;
    assert_int_equal(noh_clip_set_check(&set, &error), NOH_ERR_ARG);
    assert_non_null(strstr(error.what, "markers"));
}

static void as_many_clips_as_the_limit_are_a_set(void **state)
{
    noh_clip_entry *clips = calloc(NOH_CLIPS_MAX + 1u, sizeof *clips);
    const noh_transform bind = { .scale = { 1.0f, 1.0f, 1.0f } };
    noh_clip_set set = { .clips = clips, .joint_count = 1, .bind_pose = &bind, .sample = rest };
    noh_error error = { NOH_OK, NULL, 0, 0 };
    (void)state;
    for (uint32_t i = 0; i <= NOH_CLIPS_MAX; i++) clips[i].loop = NOH_LOOP_ONCE;
    set.clip_count = NOH_CLIPS_MAX;
    assert_int_equal(noh_clip_set_check(&set, &error), NOH_OK);
    set.clip_count = NOH_CLIPS_MAX + 1u;
    assert_int_equal(noh_clip_set_check(&set, &error), NOH_ERR_ARG);
    assert_non_null(strstr(error.what, "clip_count"));
    set.clip_count = 0;
    assert_int_equal(noh_clip_set_check(&set, &error), NOH_ERR_ARG);
    free(clips);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(arrays_of_nothing_may_be_null),
    cmocka_unit_test(as_many_clips_as_the_limit_are_a_set),
};

int main(void)
{
    return cmocka_run_group_tests(tests, NULL, NULL);
}
