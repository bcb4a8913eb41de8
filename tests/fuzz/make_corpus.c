/* make_corpus.c: the fuzzer's seeds, small packs of every shape, written to a folder. */
#include "support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/convert.h"
#include "convert/model_build.h"
#include "motion_fixture.h"

static void write_pack(const char *folder, const char *name, const test_model_desc *desc)
{
    char path[4096];
    size_t count;
    uint8_t *bytes = test_pack(desc, &count);
    snprintf(path, sizeof path, "%s/%s.noh", folder, name);
    test_write_file(path, bytes, count);
    free(bytes);
}

/* A skeleton and a clip, out of a .bvh. */
static void write_motion(const char *folder)
{
    static const char bvh[] =
        "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
        "JOINT b\n{\nOFFSET 0 -9 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 -9 0\n}\n}\n}\nMOTION\n"
        "Frames: 4\nFrame Time: 0.05\n0 20 0 0 0 0 0 0 0\n1 20 0 5 0 0 10 0 0\n2 21 0 10 0 0 25 0 0\n3 20 0 5 0 0 10 3 0\n";
    const char *input = test_path("motion.bvh");
    char path[4096];
    convert_options options;
    convert_failure failure;
    byte_buffer out = { NULL, 0, 0, 0 };
    memset(&options, 0, sizeof options);
    test_write_file(input, bvh, sizeof bvh - 1);
    assert_int_equal(convert_files(&input, 1, &options, &out, &failure), 0);
    snprintf(path, sizeof path, "%s/motion.noh", folder);
    test_write_file(path, out.bytes, out.count);
    buffer_free(&out);
}

/* Weights, a joint, callback keys and sync markers. */
static void write_weights(const char *folder)
{
    model *m = motion_model(2);
    char path[4096];
    size_t count;
    uint8_t *bytes = test_pack_of(m, &count, NULL);
    snprintf(path, sizeof path, "%s/weights.noh", folder);
    test_write_file(path, bytes, count);
    free(bytes);
    model_free(m);
}

static const char *folder;

static void corpus(void **state)
{
    static const struct { const char *name; test_model_desc desc; } seeds[] = {
        { "bare", { 1, 2, 0, 0, 1 } },
        { "targets", { 1, 4, 3, 0, 2 } },
        { "attributes", { 1, 4, 2, TEST_TANGENTS | TEST_UVS | TEST_COLORS, 3 } },
        { "scene", { 1, 4, 3, TEST_TANGENTS | TEST_UVS | TEST_COLORS | TEST_SCENE, 4 } },
        { "scene_without_targets", { 1, 3, 0, TEST_SCENE, 5 } },
        { "two_meshes", { 2, 3, 2, TEST_SCENE, 6 } },
        { "many_targets", { 1, 5, 20, TEST_COLORS, 7 } }
    };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(seeds); i++) {
        write_pack(folder, seeds[i].name, &seeds[i].desc);
    }
    write_motion(folder);
    write_weights(folder);
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(corpus) };
    if (argument_count != 2) {
        fprintf(stderr, "usage: make_corpus FOLDER\n");
        return 2;
    }
    folder = arguments[1];
    return cmocka_run_group_tests(tests, NULL, NULL);
}
