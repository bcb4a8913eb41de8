/* test_sources.c: several files in one pack: whose clips are taken, and why not. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "convert/clips/raw_set.h"
#include "convert/sources.h"
#include "support/clip_bank_fixture.h"

#define FRAMES 40u

static const joint_match_options by_name = { .names = NULL }, in_part = { .partial = 1 };

static source source_of(const char *path)
{
    const source_options options = { .unit_cm = 1.0 };
    source s;
    model_error error;
    if (source_read(path, &options, &s, &error)) {
        fail_msg("%s: %s", path, error.what);
    }
    return s;
}

/* Takes the model. */
static source source_of_model(model *m)
{
    source s;
    model_error error;
    memset(&s, 0, sizeof s);
    s.m = m;
    assert_int_equal(clips_from_model(m, NULL, &s.made, &error), 0);
    s.set_count = s.made->set_count;
    s.sets = test_zeros((s.set_count + 1u) * sizeof *s.sets);
    for (uint32_t i = 0; i < s.set_count; i++) {
        s.sets[i] = s.made->sets[i];
    }
    return s;
}

/* A message advises --partial where it helps. */
static void expect_refused_in_full(source *base, source *other, const char *what, int advises)
{
    model_error error = { "", "" };
    assert_int_equal(source_join(base, "base.glb", other, "other.bvh", &by_name, &error), 1);
    assert_int_equal(strstr(error.what, "--partial") != NULL, advises);
    if (!strstr(error.what, what)) {
        fail_msg("'%s' does not say '%s'", error.what, what);
    }
    source_free(base);
    source_free(other);
}

static void expect_refused(source *base, source *other, const char *what)
{
    expect_refused_in_full(base, other, what, 0);
}

static int has_warning(const model *m, const char *text)
{
    for (uint32_t i = 0; i < m->warning_count; i++) {
        if (strstr(m->warnings[i], text)) {
            return 1;
        }
    }
    return 0;
}

static void clips_of_one_skeleton_are_joined(void **state)
{
    source base = source_of(clip_bvh("walk", "abc", FRAMES)), other = source_of(clip_bvh("run", "abc", FRAMES + 3u));
    model_error error;
    (void)state;
    assert_int_equal(source_join(&base, "walk.bvh", &other, "run.bvh", &by_name, &error), 0);
    assert_int_equal(base.set_count, 1);
    assert_int_equal(base.sets[0]->clip_count, 2);
    assert_string_equal(base.sets[0]->clips[0].name, "walk");
    assert_string_equal(base.sets[0]->clips[1].name, "run");
    assert_int_equal(base.sets[0]->clips[1].frame_count, FRAMES + 3u);
    source_free(&other);
    source_free(&base);
}

static void a_name_that_is_taken_gets_that_of_the_file(void **state)
{
    source base = source_of(clip_bvh("walk", "abc", FRAMES)), other = source_of(clip_bvh("walk", "abc", FRAMES));
    model_error error;
    (void)state;
    assert_int_equal(source_join(&base, "walk.bvh", &other, "dir/slow.v2.bvh", &by_name, &error), 0);
    assert_string_equal(base.sets[0]->clips[1].name, "slow.v2/walk");
    source_free(&base);
    source_free(&other);
}

/* Files of one name: the second name is taken too. */
static void a_name_that_is_taken_twice_is_numbered(void **state)
{
    static const char *const expected[4] = { "walk", "other/walk", "other/walk_2", "other/walk_3" };
    source base = source_of(clip_bvh("walk", "abc", FRAMES));
    model_error error;
    (void)state;
    for (int i = 1; i < 4; i++) {
        source other = source_of(clip_bvh("walk", "abc", FRAMES));
        assert_int_equal(source_join(&base, "walk.bvh", &other, "other.bvh", &by_name, &error), 0);
        source_free(&other);
    }
    for (int i = 0; i < 4; i++) assert_string_equal(base.sets[0]->clips[i].name, expected[i]);
    assert_true(has_warning(base.m, "two clips are named 'other/walk': the second is clip 'other/walk_2'"));
    source_free(&base);
}

static void the_first_difference_is_told(void **state)
{
    source base = source_of(clip_bvh("walk", "abcd", FRAMES)), other = source_of(clip_bvh("run", "abxd", FRAMES));
    (void)state;
    expect_refused_in_full(&base, &other, "its skeleton differs from base.glb: joint 2 is 'x' here and 'c' there", 1);
    base = source_of(clip_bvh("walk", "abcd", FRAMES));
    other = source_of(clip_bvh("run", "abc", FRAMES));
    expect_refused_in_full(&base, &other, "it has 3 joints here and 4 there", 1);
    base = source_of(clip_bvh("walk", "abcd", FRAMES));
    other = source_of(clip_bvh("run", "abcd", FRAMES));
    other.sets[0]->skeleton.joints[3].parent = 1;
    expect_refused(&base, &other, "the parent of joint 'd' is 'b' here and 'c' there");
}

static void translations_come_to_the_unit_of_the_base(void **state)
{
    source base = source_of(clip_bvh("walk", "abc", FRAMES)), other = source_of(clip_bvh("run", "abc", FRAMES));
    const float before = other.sets[0]->clips[0].translations[1];
    model_error error;
    (void)state;
    base.sets[0]->skeleton.unit_cm = 100.0;
    assert_int_equal(source_join(&base, "walk.bvh", &other, "run.bvh", &by_name, &error), 0);
    assert_true(before > 80.0f);
    assert_true(base.sets[0]->clips[1].translations[1] == (float)((double)before * 0.01));
    source_free(&base);
    source_free(&other);
}

static void weights_go_to_nodes_of_the_same_name(void **state)
{
    model *to = clip_model(4), *from = clip_model(4);
    source base, other;
    model_error error;
    (void)state;
    free(from->clips[1].name); /* "linear", "shake" and "cubic" */
    from->clips[1].name = model_string("shake");
    base = source_of_model(to);
    other = source_of_model(from);
    assert_int_equal(source_join(&base, "base.glb", &other, "other.glb", &by_name, &error), 0);
    assert_int_equal(base.sets[0]->clip_count, 6);
    assert_string_equal(base.sets[0]->clips[3].name, "other/linear");
    assert_string_equal(base.sets[0]->clips[4].name, "shake");
    assert_int_equal(base.sets[0]->clips[4].float_count, 1);
    assert_int_equal(base.sets[0]->clips[4].floats[0].node, 1);
    assert_int_equal(base.sets[0]->clips[3].event_count, 3); /* keys and markers too */
    assert_true(has_warning(base.m, "other.glb: only its clips were used"));
    source_free(&base);
    source_free(&other);
}

static void weights_of_unknown_nodes_are_left_out(void **state)
{
    source base = source_of_model(clip_model(4)), other = source_of_model(clip_model(5));
    model_error error;
    (void)state;
    assert_int_equal(source_join(&base, "base.glb", &other, "other.glb", &by_name, &error), 0);
    assert_int_equal(base.sets[0]->clip_count, 4); /* of "linear" only the joint's track is taken */
    assert_int_equal(base.sets[0]->clips[3].float_count, 0);
    assert_int_equal(base.sets[0]->clips[3].joint_count, 1);
    assert_true(has_warning(base.m, "clip 'step': base.glb has no node 'grid_0' with 5 targets"));
    source_free(&base);
    source_free(&other);
}

/* A face without an animation of its own. */
static void weights_come_to_a_model_without_clip(void **state)
{
    model *still = clip_model(4), *from = clip_model(4);
    source base, other;
    model_error error;
    (void)state;
    still->clip_count = 0; /* kept, not freed: given back below */
    base = source_of_model(still);
    assert_int_equal(base.set_count, 0);
    other = source_of_model(from);
    raw_clip_clear(&other.sets[0]->clips[0]); /* the one that moves a joint */
    memmove(other.sets[0]->clips, other.sets[0]->clips + 1, 2 * sizeof *other.sets[0]->clips);
    other.sets[0]->clip_count = 2;
    assert_int_equal(source_join(&base, "base.glb", &other, "other.glb", &by_name, &error), 0);
    assert_int_equal(base.set_count, 1);
    assert_int_equal(base.sets[0]->clip_count, 2);
    still->clip_count = 3;
    source_free(&base);
    source_free(&other);
}

static void what_adds_nothing_is_refused(void **state)
{
    const test_model_desc still = { 1, 4, 0, TEST_SCENE, 11 };
    source base = source_of(clip_bvh("walk", "abc", FRAMES)), other = source_of_model(test_model(&still));
    (void)state;
    expect_refused(&base, &other, "it has no clips to add to base.glb");
    base = source_of_model(test_model(&still));
    other = source_of(clip_bvh("walk", "abc", FRAMES));
    expect_refused(&base, &other, "it animates a skeleton, and base.glb has none");
}

/* ---- joints of other names, or only some ---- */

static void name_joint(source *s, uint32_t joint, const char *name)
{
    char **at = &s->sets[0]->skeleton.joints[joint].name;
    free(*at);
    *at = test_zeros(strlen(name) + 1);
    strcpy(*at, name);
}

static void joints_of_one_name_are_told(void **state)
{
    source same = source_of(clip_bvh("walk", "aba", FRAMES)), other = source_of(clip_bvh("walk", "abc", FRAMES));
    (void)state;
    assert_true(has_warning(same.m, "joint name 'a' is used more than once (1 joints repeat a name)"));
    assert_false(has_warning(other.m, "two joints"));
    source_free(&same);
    source_free(&other);
}

static void namespaces_are_no_part_of_a_name(void **state)
{
    source base = source_of(clip_bvh("walk", "abc", FRAMES)), other = source_of(clip_bvh("run", "abc", FRAMES)),
           same = source_of(clip_bvh("run", "abc", FRAMES));
    const raw_clip *clip;
    model_error error;
    (void)state;
    name_joint(&base, 0, "mixamorig:a");
    name_joint(&other, 0, "mixamorig7:a");
    name_joint(&other, 1, "mixamorig7:b");
    assert_int_equal(source_join(&base, "walk.bvh", &other, "run.bvh", &by_name, &error), 0);
    assert_true(has_warning(base.m, "run.bvh: 3 of its 3 joints were found by name"));
    clip = &base.sets[0]->clips[1];
    assert_memory_equal(clip->rotations, same.sets[0]->clips[0].rotations, FRAMES * 3u * 4u * sizeof(float));
    assert_memory_equal(clip->translations, same.sets[0]->clips[0].translations, FRAMES * 3u * 3u * sizeof(float));
    source_free(&base);
    source_free(&other);
    source_free(&same);
}

/* base's joints are of VRM, the other's of Mixamo. turn_degrees: of the other's first joint at rest, about x. */
static int join_by_meaning(double turn_degrees, model_error *error)
{
    static const char *const ours[] = { "hips", "spine", "leftUpperLeg" };
    static const char *const theirs[] = { "mixamorig:Hips", "mixamorig:Spine", "mixamorig:LeftUpLeg" };
    source base = source_of(clip_bvh("walk", "abc", FRAMES)), other = source_of(clip_bvh("run", "abc", FRAMES));
    const double half = 0.5 * turn_degrees * 3.14159265358979 / 180.0;
    float *rest = other.sets[0]->skeleton.joints[0].rotation;
    int failed;
    for (uint32_t j = 0; j < 3; j++) {
        name_joint(&base, j, ours[j]);
        name_joint(&other, j, theirs[j]);
    }
    rest[0] = (float)sin(half);
    rest[3] = (float)cos(half);
    failed = source_join(&base, "walk.bvh", &other, "run.bvh", &by_name, error);
    if (!failed) assert_int_equal(base.sets[0]->clip_count, 2);
    source_free(&base);
    source_free(&other);
    return failed;
}

static void bones_of_other_names_are_matched_where_they_rest_alike(void **state)
{
    model_error error = { "", "" };
    (void)state;
    if (join_by_meaning(0.0, &error)) fail_msg("%s", error.what);
    if (join_by_meaning(8.0, &error)) fail_msg("%s", error.what);
    assert_int_equal(join_by_meaning(15.0, &error), 1);
    assert_non_null(strstr(error.what, "joint 0 is 'mixamorig:Hips' here and 'hips' there"));
}

static const char *names_file(const char *text)
{
    const char *path = test_path("names.txt");
    test_write_file(path, text, strlen(text));
    return path;
}

static void names_are_read_from_a_file(void **state)
{
    source base = source_of(clip_bvh("walk", "abc", FRAMES)), other = source_of(clip_bvh("run", "xbz", FRAMES));
    const char *path = names_file("# theirs ours\nx a\n\n\"z\" c # the tip\nnever b\n");
    const joint_match_options options = { .names = path };
    model_error error = { "", "" };
    (void)state;
    if (source_join(&base, "walk.bvh", &other, "run.bvh", &options, &error)) fail_msg("%s", error.what);
    assert_int_equal(base.sets[0]->clip_count, 2);
    source_free(&base);
    source_free(&other);
}

static void refuse_names(const char *text, const char *what)
{
    source base = source_of(clip_bvh("walk", "abc", FRAMES)), other = source_of(clip_bvh("run", "xbz", FRAMES));
    const joint_match_options options = { .names = names_file(text) };
    model_error error = { "", "" };
    assert_int_equal(source_join(&base, "walk.bvh", &other, "run.bvh", &options, &error), 1);
    if (!strstr(error.what, what)) fail_msg("'%s' does not say '%s'", error.what, what);
    source_free(&base);
    source_free(&other);
}

static void a_bad_file_of_names_is_refused_by_line(void **state)
{
    (void)state;
    refuse_names("x a\nz nobody\n", "the pack has no joint 'nobody'");
    refuse_names("x a\nz\n", "a line needs two names");
    refuse_names("x a\n", "its skeleton differs from walk.bvh");
}

/* Where a joint of a clip is in object space, below another joint. */
static void place_below(const raw_set *set, const raw_clip *clip, uint32_t frame, uint32_t joint, double out[12])
{
    double poses[12 * 8];
    raw_pose_object(&set->skeleton, clip, frame, poses);
    memcpy(out, poses + 12u * joint, 12 * sizeof *out);
}

static void expect_same_place(const raw_set *a, uint32_t a_clip, uint32_t a_joint, const raw_set *b, uint32_t b_joint)
{
    for (uint32_t f = 0; f < FRAMES; f++) {
        double x[12], y[12];
        place_below(a, &a->clips[a_clip], f, a_joint, x);
        place_below(b, &b->clips[0], f, b_joint, y);
        for (int i = 0; i < 12; i++) assert_true(fabs(x[i] - y[i]) < 1e-4);
    }
}

/* A joint that only the file has, between two others: the one below it stays where it was. */
static void a_joint_in_between_is_folded_into_the_next(void **state)
{
    source base = source_of(clip_bvh("walk", "ac", FRAMES)), other = source_of(clip_bvh("run", "abc", FRAMES)),
           same = source_of(clip_bvh("run", "abc", FRAMES));
    model_error error;
    (void)state;
    assert_int_equal(source_join(&base, "walk.bvh", &other, "run.bvh", &in_part, &error), 0);
    assert_true(has_warning(base.m, "these were left out: 'b'"));
    expect_same_place(base.sets[0], 1, 0, same.sets[0], 0);
    expect_same_place(base.sets[0], 1, 1, same.sets[0], 2);
    source_free(&base);
    source_free(&other);
    source_free(&same);
}

/* A joint that only the pack has keeps the bind pose, and what hangs from it is where the file has it. */
static void a_joint_that_the_file_lacks_keeps_the_bind_pose(void **state)
{
    source base = source_of(clip_bvh("walk", "abc", FRAMES)), other = source_of(clip_bvh("run", "ac", FRAMES)),
           same = source_of(clip_bvh("run", "ac", FRAMES)), again = source_of(clip_bvh("few", "ab", FRAMES)),
           more = source_of(clip_bvh("walk", "abc", FRAMES));
    model_error error;
    (void)state;
    assert_int_equal(source_join(&base, "walk.bvh", &other, "run.bvh", &in_part, &error), 0);
    assert_true(has_warning(base.m, "2 of its 2 joints were found by name; these keep the bind pose: 'b'"));
    for (uint32_t f = 0; f < FRAMES; f++) {
        assert_memory_equal(base.sets[0]->clips[1].rotations + (f * 3u + 1u) * 4u,
                            base.sets[0]->skeleton.joints[1].rotation, 4u * sizeof(float));
    }
    expect_same_place(base.sets[0], 1, 2, same.sets[0], 1);
    source_free(&base);
    source_free(&other);
    source_free(&same);
    expect_refused_in_full(&more, &again, "--partial uses the joints that both have", 1);
}

static void strangers_are_refused_in_part_too(void **state)
{
    source base = source_of(clip_bvh("walk", "abcde", FRAMES)), other = source_of(clip_bvh("run", "axyzw", FRAMES));
    model_error error;
    (void)state;
    assert_int_equal(source_join(&base, "walk.bvh", &other, "run.bvh", &in_part, &error), 1);
    source_free(&base);
    source_free(&other);
}

/* Warnings of a file of clips are kept together with the model's, nor is a unit that is not the model's. */
static void warnings_of_joined_files_are_kept(void **state)
{
    static const double units[] = { 1.0, 0.6, 1.9, 0.01, 100.0 };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(units); i++) {
        source base = source_of(clip_bvh("walk", "abc", FRAMES)), other = source_of(clip_bvh("run", "abc", FRAMES));
        model_error error;
        char advice[64];
        other.sets[0]->skeleton.unit_cm = units[i];
        free(other.sets[0]->warning); /* of its size */
        other.sets[0]->warning = model_string("the skeleton is odd");
        assert_int_equal(model_warn(other.m, "a sentence"), 0);
        assert_int_equal(source_join(&base, "walk.bvh", &other, "run.bvh", &by_name, &error), 0);
        assert_true(has_warning(base.m, "run.bvh: the skeleton is odd"));
        assert_true(has_warning(base.m, "run.bvh: a sentence"));
        snprintf(advice, sizeof advice, "its bones are %.3g times as long as in walk.bvh", units[i]);
        assert_int_equal(has_warning(base.m, "its bones"), units[i] < 0.5 || units[i] > 2.0);
        assert_int_equal(has_warning(base.m, advice), units[i] < 0.5 || units[i] > 2.0);
        assert_int_equal(has_warning(base.m, "--unit-cm 1 "), units[i] < 0.5 || units[i] > 2.0);
        source_free(&base);
        source_free(&other);
    }
}

/* The clips of all, the same bytes in whatever order. */
static void the_pack_of_several_files(void **state)
{
    const char *inputs[2], *swapped[2];
    size_t counts[2];
    uint8_t *made[2];
    noh_pack packs[2];
    (void)state;
    inputs[0] = swapped[1] = clip_bvh("walk", "abc", FRAMES);
    inputs[1] = swapped[0] = clip_bvh("run", "abc", 2u * FRAMES);
    made[0] = clip_pack(inputs, 2, NULL, &counts[0]);
    made[1] = clip_pack(swapped, 2, NULL, &counts[1]);
    for (int i = 0; i < 2; i++) {
        packs[i] = test_open(made[i], counts[i]);
        assert_int_equal(packs[i].runs[NOH_CHUNK_SKELETON].count, 1);
        assert_int_equal(packs[i].runs[NOH_CHUNK_CLIP].count, 2);
    }
    for (uint32_t i = 0; i < 2; i++) {
        noh_pack_clip a, b;
        noh_pack_clip_at(&packs[0], i, &a, NULL);
        noh_pack_clip_at(&packs[1], 1 - i, &b, NULL);
        assert_string_equal(a.name, b.name);
        assert_int_equal(a.header->clip_bytes, b.header->clip_bytes);
        assert_memory_equal(a.bytes, b.bytes, a.header->clip_bytes);
    }
    free(made[0]);
    free(made[1]);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(clips_of_one_skeleton_are_joined),
    cmocka_unit_test(warnings_of_joined_files_are_kept),
    cmocka_unit_test(a_name_that_is_taken_gets_that_of_the_file),
    cmocka_unit_test(a_name_that_is_taken_twice_is_numbered),
    cmocka_unit_test(the_first_difference_is_told),
    cmocka_unit_test(translations_come_to_the_unit_of_the_base),
    cmocka_unit_test(weights_go_to_nodes_of_the_same_name),
    cmocka_unit_test(weights_of_unknown_nodes_are_left_out),
    cmocka_unit_test(weights_come_to_a_model_without_clip),
    cmocka_unit_test(what_adds_nothing_is_refused),
    cmocka_unit_test(joints_of_one_name_are_told),
    cmocka_unit_test(namespaces_are_no_part_of_a_name),
    cmocka_unit_test(bones_of_other_names_are_matched_where_they_rest_alike),
    cmocka_unit_test(names_are_read_from_a_file),
    cmocka_unit_test(a_bad_file_of_names_is_refused_by_line),
    cmocka_unit_test(a_joint_in_between_is_folded_into_the_next),
    cmocka_unit_test(a_joint_that_the_file_lacks_keeps_the_bind_pose),
    cmocka_unit_test(strangers_are_refused_in_part_too),
    cmocka_unit_test(the_pack_of_several_files),
};

TEST_MAIN(tests, NULL, NULL)
