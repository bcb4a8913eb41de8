/* test_retarget_set.c: recordings of several rigs on others: slide, penetration, reach and bends; bones by a file; and
 * what is refused. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/names.h"
#include "convert/clips/raw_set.h"
#include "convert/clips/rcl.h"
#include "convert/retarget/bones.h"
#include "convert/retarget/retarget_set.h"
#include "convert/sources.h"

static raw_set *recording(const char *name)
{
    char path[64];
    raw_set *set;
    model_error error;
    (void)snprintf(path, sizeof path, "clips/%s.rcl", name);
    if (rcl_read(test_asset(path), &set, &error)) fail_msg("%s: %s", name, error.what);
    return set;
}

static source figure(const char *path)
{
    const source_options options = { .unit_cm = 0.0 };
    source s;
    model_error error;
    if (source_read(test_asset(path), &options, &s, &error)) fail_msg("%s: %s", path, error.what);
    return s;
}

/* The figures of the line about a clip: slide, penetration, the source's own, reach, bends. */
static void read_figures(FILE *report, double out[5])
{
    char line[512] = "";
    const char *at;
    rewind(report);
    assert_non_null(fgets(line, sizeof line, report));
    at = strstr(line, "feet slide");
    assert_non_null(at);
    assert_int_equal(
        sscanf(at,
               "feet slide %lf %% of a stride, penetrate %lf cm in 95 %% of frames (source: %lf), hands off "
               "by %lf cm, %lf %%",
               &out[0], &out[1], &out[2], &out[3], &out[4]),
        5);
}

static void retarget(const char *name, const char *whose, const raw_skeleton *to)
{
    raw_set *set = recording(name);
    FILE *report = tmpfile();
    model_error error;
    double f[5];
    assert_non_null(report);
    if (retarget_set(set, to, NULL, report, &error)) fail_msg("%s on %s: %s", name, whose, error.what);
    read_figures(report, f);
    print_message("%s on %s: slide %.2f %%, penetration %.1f cm, reach %.1f cm, bends %.1f %%\n", name, whose, f[0],
                  f[1], f[3], f[4]);
    if (f[0] > 1.0 || f[1] > 3.0 || f[3] > 6.0 || f[4] > 0.0) fail_msg("%s on %s", name, whose);
    assert_int_equal(raw_skeleton_hash(&set->skeleton), raw_skeleton_hash(to));
    assert_int_equal(set->clips[0].joint_count, to->joint_count);
    (void)fclose(report);
    raw_set_free(set);
}

static const char *const recordings[] = { "cmu_salsa_01", "cmu_martial_03", "cmu_01_01", "Knight__Walking_A",
                                          "RobotExpressive__Walking" };

static void on_figure(const char *path, const char *prefix, int vrm_names)
{
    source s = figure(path);
    raw_skeleton *to = &s.sets[0]->skeleton;
    char whose[64];
    for (uint32_t j = 0; j < to->joint_count; j++) {
        char name[NOH_NAME_BYTES_MAX + 16u], means[NOH_NAME_BYTES_MAX];
        uint16_t bones[NOH_BONES];
        uint32_t b = 0;
        bones_find(to, bones);
        while (b < NOH_BONES && bones[b] != j) b++;
        if (b == NOH_BONES) continue; /* others keep their names: as bones of hair and clothes do */
        if (!names_find(NAME_JOINT, to->joints[j].name, means, NULL)) continue;
        (void)snprintf(name, sizeof name, "%s%s", prefix, vrm_names ? means : to->joints[j].name);
        free(to->joints[j].name);
        to->joints[j].name = strcpy(test_zeros(strlen(name) + 1u), name);
    }
    (void)snprintf(whose, sizeof whose, "%s%s%s", path, *prefix ? " as " : "",
                   *prefix     ? prefix
                   : vrm_names ? " of VRM"
                               : "");
    for (uint32_t i = 0; i < TEST_COUNT(recordings); i++) retarget(recordings[i], whose, to);
    source_free(&s);
}

static void recordings_move_a_person(void **state)
{
    (void)state;
    on_figure("hero/body.glb", "", 0);
}

static void recordings_move_rigs_of_other_names(void **state)
{
    (void)state;
    on_figure("hero/body.glb", "mixamorig:", 0);
    on_figure("hero/body.glb", "", 1);
}

/* Its feet hang from the root, and its legs from a joint that is not named hips. */
static void recordings_move_a_robot(void **state)
{
    (void)state;
    on_figure("khronos/RobotExpressive.glb", "", 0);
}

static void recordings_move_rigs_of_recordings(void **state)
{
    static const char *const rigs[] = { "Knight__Idle", "cmu_salsa_01", "cmu_01_03" };
    (void)state;
    for (uint32_t r = 0; r < TEST_COUNT(rigs); r++) {
        raw_set *to = recording(rigs[r]);
        for (uint32_t i = 0; i < TEST_COUNT(recordings); i++) {
            if (strncmp(recordings[i], rigs[r], 7) != 0) retarget(recordings[i], rigs[r], &to->skeleton);
        }
        raw_set_free(to);
    }
}

/* ---- a file of bones ---- */

static const char *bones_file(const char *text)
{
    const char *path = test_path("bones.txt");
    test_write_file(path, text, strlen(text));
    return path;
}

static void hide_names(raw_set *set)
{
    for (uint32_t j = 0; j < set->skeleton.joint_count; j++) {
        (void)snprintf(set->skeleton.joints[j].name, 3, "%02u", j % 100u);
    }
}

static void expect_refused(raw_set *set, const raw_skeleton *to, const char *map, const char *what)
{
    model_error error = { "", "" };
    assert_int_equal(retarget_set(set, to, map, NULL, &error), 1);
    if (!strstr(error.what, what)) fail_msg("'%s' does not say '%s'", error.what, what);
}

static void bones_are_given_by_a_file(void **state)
{
    raw_set *to = recording("Knight__Idle"), *named = recording("cmu_salsa_01"), *hidden = recording("cmu_salsa_01");
    uint16_t ours[NOH_BONES], theirs[NOH_BONES];
    char text[8192] = "# bone theirs ours\n";
    model_error error;
    (void)state;
    bones_find(&named->skeleton, theirs);
    bones_find(&to->skeleton, ours);
    hide_names(hidden);
    expect_refused(hidden, &to->skeleton, NULL, "the bones of this file's skeleton are not known");
    for (uint32_t j = 0; j < named->skeleton.joint_count; j++) {
        char means[NOH_NAME_BYTES_MAX];
        const uint32_t b = names_find(NAME_JOINT, named->skeleton.joints[j].name, means, NULL) ? bone_named(means)
                                                                                               : NOH_BONES;
        if (b == NOH_BONES || theirs[b] != j || ours[b] == NOH_JOINT_ROOT) continue;
        (void)snprintf(text + strlen(text), sizeof text - strlen(text), "%s %02u %s\n", means, j % 100u,
                       to->skeleton.joints[ours[b]].name);
    }
    if (retarget_set(named, &to->skeleton, NULL, NULL, &error)) fail_msg("%s", error.what);
    if (retarget_set(hidden, &to->skeleton, bones_file(text), NULL, &error)) fail_msg("%s", error.what);
    assert_memory_equal(named->clips[0].rotations, hidden->clips[0].rotations,
                        4u * sizeof(float) * named->clips[0].frame_count * to->skeleton.joint_count);
    raw_set_free(to);
    raw_set_free(named);
    raw_set_free(hidden);
}

static void a_bad_file_of_bones_is_refused_by_line(void **state)
{
    raw_set *to = recording("Knight__Idle"), *set = recording("cmu_salsa_01");
    (void)state;
    expect_refused(set, &to->skeleton, bones_file("hips hip hips\nleftArm a b\n"), "'leftArm' is no bone");
    expect_refused(set, &to->skeleton, bones_file("hips hip\n"), "a line needs a bone and two joints");
    expect_refused(set, &to->skeleton, bones_file("reference\n"), "'reference' needs a frame");
    expect_refused(set, &to->skeleton, bones_file("reference two\n"), "'reference' needs a frame");
    expect_refused(set, &to->skeleton, bones_file("reference 100000\n"), "no clip has the reference frame 100000");
    raw_set_free(to);
    raw_set_free(set);
}

/* A bind pose that lies, in a clip whose first frame stands. */
static void a_frame_stands_in_for_a_bind_pose(void **state)
{
    raw_set *to = recording("Knight__Idle"), *set = recording("cmu_salsa_01");
    static const float lies[4] = { 0.70710678f, 0.0f, 0.0f, 0.70710678f };
    model_error error;
    (void)state;
    memcpy(set->skeleton.joints[0].rotation, lies, sizeof lies);
    expect_refused(set, &to->skeleton, NULL, "the bind pose of this file's skeleton does not stand upright");
    if (retarget_set(set, &to->skeleton, bones_file("reference 0\n"), NULL, &error)) fail_msg("%s", error.what);
    raw_set_free(to);
    raw_set_free(set);
}

static void clips_of_the_same_figure_keep_their_bits(void **state)
{
    raw_set *a = recording("Knight__Idle"), *b = recording("Knight__Idle");
    (void)state;
    assert_true(retarget_same(&a->skeleton, &b->skeleton));
    b->skeleton.joints[5].translation[1] *= 1.05f;
    assert_false(retarget_same(&a->skeleton, &b->skeleton));
    raw_set_free(b);
    b = recording("cmu_salsa_01");
    assert_false(retarget_same(&a->skeleton, &b->skeleton));
    raw_set_free(a);
    raw_set_free(b);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(recordings_move_a_person),          cmocka_unit_test(recordings_move_rigs_of_other_names),
    cmocka_unit_test(recordings_move_a_robot),           cmocka_unit_test(recordings_move_rigs_of_recordings),
    cmocka_unit_test(bones_are_given_by_a_file),         cmocka_unit_test(a_bad_file_of_bones_is_refused_by_line),
    cmocka_unit_test(a_frame_stands_in_for_a_bind_pose), cmocka_unit_test(clips_of_the_same_figure_keep_their_bits)
};

TEST_MAIN(tests, NULL, NULL)
