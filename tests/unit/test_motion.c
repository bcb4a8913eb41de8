/* test_motion.c: checking a set that has only what it must have; broken fields are in test_controller.c. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "anim/controller_pose.h"

static void rest(void *user, uint32_t motion, uint32_t clip_tick, uint32_t joint_count, noh_transform *pose, uint32_t float_count, float *floats)
{
    (void)user, (void)motion, (void)clip_tick;
    memset(pose, 0, joint_count * sizeof *pose);
    memset(floats, 0, float_count * sizeof *floats);
}

/* No keys, no markers, no masks, no defaults: their arrays may be NULL. */
static void arrays_of_nothing_may_be_null(void **state)
{
    noh_motion motions[2];
    noh_transform bind;
    noh_anim_set set;
    noh_error error = { NOH_OK, NULL, 0, 0 };
    (void)state;
    memset(motions, 0, sizeof motions);
    memset(&bind, 0, sizeof bind);
    memset(&set, 0, sizeof set);
    motions[0].loop = motions[1].loop = NOH_LOOP_ONCE;
    motions[1].name_hash = 7;
    set.motion_count = 2;
    set.joint_count = 1;
    set.motions = motions;
    set.bind_pose = &bind;
    set.sample = rest;
    assert_int_equal(noh_anim_set_check(&set, &error), NOH_OK);
    assert_int_equal(noh_anim_set_find(&set, 7), 1);
    assert_int_equal(noh_anim_set_find(&set, 8), NOH_NONE);
    motions[1].first_marker = 1;
    assert_int_equal(noh_anim_set_check(&set, &error), NOH_ERR_DATA);
    assert_int_equal(error.where, 1);
    assert_non_null(strstr(error.what, "marker range"));
    motions[1].first_marker = 0, motions[1].event_count = 1;
    assert_int_equal(noh_anim_set_check(&set, &error), NOH_ERR_DATA);
    assert_non_null(strstr(error.what, "event range"));
    motions[1].event_count = 0, set.marker_count = 1;
    assert_int_equal(noh_anim_set_check(&set, &error), NOH_ERR_ARG);
    assert_non_null(strstr(error.what, "markers"));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(arrays_of_nothing_may_be_null),
};

int main(void)
{
    return cmocka_run_group_tests(tests, NULL, NULL);
}
