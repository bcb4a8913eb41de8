/* make_corpus.c: the fuzzer's seeds, small packs of every shape, written to a folder. */
#include "support.h"

#include <stdio.h>
#include <stdlib.h>

static void write_pack(const char *folder, const char *name, const test_model_desc *desc)
{
    char path[4096];
    size_t count;
    uint8_t *bytes = test_pack(desc, &count);
    snprintf(path, sizeof path, "%s/%s.noh", folder, name);
    test_write_file(path, bytes, count);
    free(bytes);
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
