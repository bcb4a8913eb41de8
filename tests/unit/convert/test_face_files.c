/* test_face_files.c: one face as a folder of .obj files, and as a .glb file with dense, sparse and shared accessors,
 * becomes one pack. The demo mask with a few of its targets; with NOH_LONG set it and hero/head.glb with all. */
#include "support/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "convert/convert.h"
#include "support/face_files.h"

#define FORMS 4

static byte_buffer convert(const char *path, const char *targets)
{
    const char *inputs[] = { path };
    convert_options o = { 0 };
    convert_failure failure = { 0 };
    byte_buffer out = { NULL, 0, 0, 0 };
    o.source.targets = targets;
    o.clip.clip.error_cm = 0.01;
    o.clip.clip.shell_cm = 3.0;
    o.clip.clip.effort = 1;
    o.source.skin.influences = 4;
    o.source.skin.palette = NOH_PALETTE_JOINTS_MAX;
    o.blocks = MODEL_BLOCKS_ETC2;
    if (convert_files(inputs, 1, &o, &out, &failure)) {
        fail_msg("%s: %s (%s)", failure.file, failure.error.what, failure.error.where);
    }
    return out;
}

static void count_pack(const byte_buffer *pack, uint32_t *vertices, uint64_t *pairs)
{
    noh_pack opened = test_open(pack->bytes, pack->count);
    const noh_mesh mesh = test_mesh(&opened, 0);
    *vertices = mesh.header->vertex_count;
    *pairs = 0;
    for (uint32_t t = 0; t < mesh.header->target_count; t++) *pairs += mesh.targets[t].pair_count;
}

static void compare(const byte_buffer packs[FORMS])
{
    static const char *const names[FORMS] = { "the folder of .obj files", "dense accessors", "sparse accessors",
                                              "shared accessors" };
    uint32_t vertices[FORMS];
    uint64_t pairs[FORMS];
    for (int i = 0; i < FORMS; i++) {
        uint8_t *aligned = test_aligned(packs[i].bytes, packs[i].count);
        const byte_buffer pack = { aligned, packs[i].count, 0, 0 };
        count_pack(&pack, &vertices[i], &pairs[i]);
        print_message("%s: %u vertices, %llu pairs, %zu bytes\n", names[i], vertices[i], (unsigned long long)pairs[i],
                      packs[i].count);
        free(aligned);
    }
    for (int i = 1; i < FORMS; i++) {
        size_t at = 0;
        assert_int_equal(vertices[i], vertices[0]);
        assert_true(pairs[i] == pairs[0]);
        assert_int_equal(packs[i].count, packs[0].count);
        while (at < packs[0].count && packs[i].bytes[at] == packs[0].bytes[at]) at++;
        if (at < packs[0].count) fail_msg("byte %zu of %s differs from %s", at, names[i], names[0]);
    }
}

static void one_pack(const char *path, uint32_t target_max, int with_normals)
{
    byte_buffer packs[FORMS];
    model_error error;
    model *m = NULL;
    face_files *f;
    char folder[4096], obj[4128];
    assert_int_equal(model_read_gltf(path, &m, &error), 0);
    f = face_files_new(m, target_max, with_normals);
    model_free(m);
    (void)snprintf(folder, sizeof folder, "%s", test_path("face"));
    assert_int_equal(mkdir(folder, 0700), 0);
    (void)snprintf(obj, sizeof obj, "%s/face.obj", folder);
    face_files_obj(f, folder);
    packs[0] = convert(obj, folder);
    face_files_obj_remove(f, folder);
    for (int i = 1; i < FORMS; i++) {
        char glb[4096];
        (void)snprintf(glb, sizeof glb, "%s", test_path("face.glb"));
        face_files_glb(f, (face_form)(i - 1), glb);
        packs[i] = convert(glb, NULL);
    }
    face_files_free(f);
    compare(packs);
    for (int i = 0; i < FORMS; i++) buffer_free(&packs[i]);
}

static const char *mask_path(void)
{
    static char path[4096];
    const char *build = getenv("NOH_BUILD");
    (void)snprintf(path, sizeof path, "%s/mask.glb", build ? build : "build");
    return path;
}

static void the_mask_is_one_pack(void **state)
{
    (void)state;
    one_pack(mask_path(), getenv("NOH_LONG") ? 1000u : 2u, 1);
    if (getenv("NOH_LONG")) one_pack(mask_path(), 1000u, 0);
}

/* Its normals are computed from each form. */
static void a_head_is_one_pack(void **state)
{
    (void)state;
    const char *path = test_asset("hero/head.glb");
    one_pack(path, getenv("NOH_LONG") ? 1000u : 2u, 0);
    if (getenv("NOH_LONG")) one_pack(path, 1000u, 1);
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_mask_is_one_pack),
        cmocka_unit_test(a_head_is_one_pack),
    };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
