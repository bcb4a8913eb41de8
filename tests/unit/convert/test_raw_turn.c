/* Tests of tools/convert/clips/raw_turn.c: rest poses out of frames, and recordings turned to face +z. */
#include "convert/clips/raw_turn.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/clips/raw_set.h"
#include "convert/model/model_build.h"
#include "support/support.h"

#define JOINTS 5u
#define FRAMES 4u

/* A pelvis with two thighs, left and right, and two arms, whose left is at +x: it faces +z. */
static raw_set *figure(const char *const names[JOINTS])
{
    static const float offsets[JOINTS][3] = { { 0.0f, 90.0f, 0.0f },
                                              { 10.0f, -5.0f, 0.0f },
                                              { -10.0f, -5.0f, 0.0f },
                                              { 18.0f, 45.0f, 2.0f },
                                              { -18.0f, 45.0f, 2.0f } };
    raw_set *set = raw_set_new(JOINTS, 1);
    assert_non_null(set);
    assert_int_equal(raw_clip_alloc(&set->clips[0], FRAMES, JOINTS), 0);
    for (uint32_t j = 0; j < JOINTS; j++) {
        raw_joint *joint = &set->skeleton.joints[j];
        free(joint->name);
        joint->name = model_string(names[j]);
        joint->parent = j ? 0 : MODEL_NONE;
        memcpy(joint->translation, offsets[j], sizeof joint->translation);
        for (uint32_t f = 0; f < FRAMES; f++) {
            const size_t at = (size_t)f * JOINTS + j;
            const float angle = 0.2f * (float)(f + 1) * (float)(j + 1);
            const float q[4] = { sinf(0.5f * angle), 0.0f, 0.0f, cosf(0.5f * angle) };
            memcpy(set->clips[0].rotations + 4 * at, q, sizeof q);
            memcpy(set->clips[0].translations + 3 * at, offsets[j], sizeof offsets[j]);
            set->clips[0].translations[3 * at + 2] += j ? 0.0f : 3.0f * (float)f;
            for (size_t i = 0; i < 3; i++) set->clips[0].scales[3 * at + i] = 1.0f;
        }
    }
    return set;
}

static const char *const spelled[][JOINTS] = {
    { "Hips", "LeftUpLeg", "RightUpLeg", "LeftArm", "RightArm" },
    { "pelvis", "thigh_l", "thigh_r", "upperarm_l", "upperarm_r" },
    { "hip", "lThigh", "rThigh", "lShldr", "rShldr" },
    { "Bip01", "Bip01 L Thigh", "Bip01 R Thigh", "Bip01 L UpperArm", "Bip01 R UpperArm" },
    { "root", "thigh.L", "thigh.R", "arm.L", "arm.R" },
    { "ROOT", "LEFT_LEG", "RIGHT_LEG", "LEFT_ARM", "RIGHT_ARM" },
};

static void facing_is_found_by_any_spelling(void **state)
{
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(spelled); i++) {
        for (int turned = -170; turned <= 180; turned += 25) {
            raw_set *set = figure(spelled[i]);
            double degrees = 1000.0;
            raw_turn(set, turned);
            assert_int_equal(raw_facing(&set->skeleton, &degrees), 0);
            assert_true(fabs(degrees - turned) < 1e-4);
            raw_turn(set, -degrees);
            assert_int_equal(raw_facing(&set->skeleton, &degrees), 0);
            assert_true(fabs(degrees) < 1e-4);
            raw_set_free(set);
        }
    }
}

static void who_has_no_sides_faces_nowhere(void **state)
{
    static const char *const none[][JOINTS] = { { "hips", "tail1", "tail2", "pole", "reel" },
                                                { "hips", "Left", "other", "tall", "tarr" },
                                                { "hips", "LeftUpLeg", "leg", "hal", "rolled" } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(none); i++) {
        raw_set *set = figure(none[i]);
        double degrees = 5.0;
        assert_int_equal(raw_facing(&set->skeleton, &degrees), 1);
        assert_true(degrees == 5.0);
        raw_set_free(set);
    }
}

/* Every joint goes with the root: in object space all places are turned, in the bind pose and in each frame. */
static void all_of_it_is_turned(void **state)
{
    raw_set *set = figure(spelled[0]), *was = figure(spelled[0]);
    double before[JOINTS * 12], after[JOINTS * 12];
    (void)state;
    raw_turn(set, 90.0);
    for (uint32_t f = 0; f <= FRAMES; f++) {
        raw_pose_object(&was->skeleton, f < FRAMES ? &was->clips[0] : NULL, f, before);
        raw_pose_object(&set->skeleton, f < FRAMES ? &set->clips[0] : NULL, f, after);
        for (uint32_t j = 0; j < JOINTS; j++) { /* +z goes to +x, +x to -z */
            for (uint32_t c = 0; c < 4; c++) {
                const double *b = before + 12 * j + 3 * c, *a = after + 12 * j + 3 * c;
                assert_true(fabs(a[0] - b[2]) < 1e-4 && fabs(a[1] - b[1]) < 1e-4 && fabs(a[2] + b[0]) < 1e-4);
            }
        }
    }
    raw_set_free(set);
    raw_set_free(was);
}

/* A head over two feet, along z in the bind pose and in frames: only then z is up. */
static void who_stands_along_z_is_stood_up(void **state)
{
    static const char *const names[JOINTS] = { "Hips", "LeftFoot", "RightFoot", "Head", "Tail" };
    static const float places[JOINTS][3] = {
        { 0, 0, 90 }, { 10, 0, -80 }, { -10, 0, -80 }, { 0, -5, 60 }, { 0, 9, 0 }
    };
    (void)state;
    for (int lies = 0; lies < 2; lies++) {
        raw_set *set = figure(names);
        const raw_joint *head = &set->skeleton.joints[3], *hips = &set->skeleton.joints[0];
        double pose[JOINTS * 12];
        for (uint32_t j = 0; j < JOINTS; j++) memcpy(set->skeleton.joints[j].translation, places[j], sizeof places[j]);
        if (!lies) {
            for (size_t i = 0; i < (size_t)FRAMES * JOINTS; i++) {
                memcpy(set->clips[0].rotations + 4 * i, (const float[4]){ 0, 0, 0, 1 }, 4 * sizeof(float));
                memcpy(set->clips[0].translations + 3 * i, places[i % JOINTS], sizeof places[0]);
            }
            set->clips[0].translations[3 * 3 + 1] = -100.0f; /* it bends forward at first */
        }
        assert_int_equal(raw_stand_up(set), !lies);
        assert_true(fabsf(hips->translation[lies ? 2 : 1] - 90.0f) < 1e-4f && head->translation[2] == 60.0f);
        raw_pose_object(&set->skeleton, lies ? NULL : &set->clips[0], 1, pose);
        assert_true(fabs(pose[12 * 3 + 9 + (lies ? 2 : 1)] - 150.0) < 1e-3);
        assert_int_equal(raw_stand_up(set), 0);
        raw_set_free(set);
    }
}

static void the_rest_is_the_first_frame(void **state)
{
    raw_set *set = figure(spelled[0]);
    double rest[JOINTS * 12], first[JOINTS * 12];
    (void)state;
    assert_int_equal(raw_rest_from_frame(set, 0), 0);
    raw_pose_object(&set->skeleton, NULL, 0, rest);
    raw_pose_object(&set->skeleton, &set->clips[0], 0, first);
    assert_memory_equal(rest, first, sizeof rest);
    set->clips[0].joint_count = 0; /* scalars alone */
    assert_int_equal(raw_rest_from_frame(set, 0), 1);
    set->clips[0].joint_count = JOINTS;
    raw_set_free(set);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(facing_is_found_by_any_spelling),
        cmocka_unit_test(who_has_no_sides_faces_nowhere),
        cmocka_unit_test(all_of_it_is_turned),
        cmocka_unit_test(who_stands_along_z_is_stood_up),
        cmocka_unit_test(the_rest_is_the_first_frame),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
