/* test_colors.c: colours by target: rows of recipes, maps, materials, chunks, and chunks that lie. */
#include "support/support.h"
#include "support/wrinkle_sheet.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "convert/model/model_build.h"
#include "convert/wrinkle/color_make.h"
#include "platform.h"
#include "file/png_file.h"
#include "noh/format.h"
#include "noh/pack.h"
#include "support/pack_walk.h"

/* ---- rows ---- */

static void rows_that_are_wrong_are_refused(void **state)
{
    static const char *const lines[] = { "color a",
                                         "color a x",
                                         "color a r 1.5",
                                         "color a r 1 1",
                                         "color a rg",
                                         "color a r\ncolor a r 0.5",
                                         "tint",
                                         "tint r",
                                         "tint x ff0000",
                                         "tint r ff000",
                                         "tint r ff00000",
                                         "tint r gg0000",
                                         "tint r 0xff00",
                                         "tint r ff0000 more",
                                         "tint r ff0000\ntint r 00ff00" };
    (void)state;
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; ++i) {
        recipe_text *recipe = recipe_new();
        model_error error = { "", "" };
        uint32_t line = 0;
        if (!recipe_add_text(recipe, lines[i], strlen(lines[i]), &line, &error)) fail_msg("'%s' is taken", lines[i]);
        assert_true(error.what[0] != '\0');
        recipe_free(recipe);
    }
}

/* ---- models ---- */

static void stay(float at[3])
{
    (void)at;
}

static void lift(float at[3])
{
    at[2] += 0.1f;
}

static const sheet_target targets[] = { { "lift", lift }, { "blush", stay } };
static const char rows[] =
    "tint r 804020\ntint g FFFFFF\ncolor blush r 0.5\ncolor blush g\ncolor lift r 0.2\ncolor other b 0\n"
    "tint b 000000\n";
static char map_path[64];

static int make(model *m, const char *text, const char *material, model_error *error)
{
    static uint8_t rgba[8 * 8 * 4];
    recipe_text *recipe = recipe_new();
    uint32_t line = 0;
    memset(rgba, 200, sizeof rgba);
    for (uint32_t i = 0; i < sizeof rgba; i += 4) rgba[i + 3] = 255;
    snprintf(map_path, sizeof map_path, "/tmp/noh_colors_%ld.png", (long)getpid());
    assert_int_equal(tool_write_png(map_path, 8, 8, rgba), 0);
    assert_int_equal(recipe_add_text(recipe, text, strlen(text), &line, error), 0);
    const color_settings settings = { .map = map_path, .material = material, .recipe = recipe };
    const int failed = colors_make(m, &settings, error);
    recipe_free(recipe);
    unlink(map_path);
    return failed;
}

/* sRGB 80, 40, 20 is 0.216, 0.0513, 0.0144 of light. */
static void recipes_colour_targets(void **state)
{
    static const uint8_t expected[6][4] = { { 118, 58, 31, 0 }, { 255, 255, 255, 0 }, { 0 }, { 0 },
                                            { 51, 0, 0, 0 },    { 128, 255, 0, 0 } };
    model *m = wrinkle_sheet_make(targets, 2);
    model_error error = { "", "" };
    (void)state;
    if (make(m, rows, NULL, &error)) fail_msg("%s", error.what);
    const model_mesh *mesh = &m->meshes[0];
    assert_memory_equal(mesh->colors, expected, sizeof expected);
    assert_int_equal(mesh->color_material, 0);
    const model_texture *t = &m->textures[m->materials[0].color_texture];
    assert_string_equal(t->name, "sheet colours");
    assert_int_equal(t->use, MODEL_TEXTURE_DATA);
    assert_true(t->width == 8 && t->height == 8 && t->rgba[0] == 200 && t->wrap_s == 10497);
    model_free(m);
}

static void what_cannot_be_coloured_is_said(void **state)
{
    static const struct {
        const char *rows, *material, *says;
        int maps;
    } cases[] = { { "color blush r\n", NULL, "channel r of the colour map has no colour", 0 },
                  { "tint r ff0000\ntint a ff0000\ncolor blush a\n", NULL, NULL, 0 },
                  { "wrinkle blush 3\n", NULL, "no target shows its colours", 0 },
                  { "tint r ff0000\ncolor nobody r\n", NULL, "no mesh has the targets", 0 },
                  { "tint r ff0000\ncolor blush r\n", "cloth", "it has no such material", 0 },
                  { "tint r ff0000\ncolor blush r\n", NULL, "as many maps as a pixel reads", 1 },
                  { "tint r ff0000\ncolor blush r\n", "skin", NULL, 0 } };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        model *m = wrinkle_sheet_make(targets, 2);
        model_error error = { "", "" };
        if (cases[i].maps) {
            m->materials[0].normal_texture = m->materials[0].surface_texture = m->materials[0].specular_texture = 0;
            m->materials[0].wrinkle_texture = 0;
            m->materials[0].emissive[1] = 1.0f;
        }
        assert_int_equal(make(m, cases[i].rows, cases[i].material, &error), cases[i].says != NULL);
        if (cases[i].says && !strstr(error.what, cases[i].says)) fail_msg("case %u: %s", (unsigned)i, error.what);
        assert_true((m->meshes[0].colors != NULL) == !cases[i].says);
        model_free(m);
    }
}

/* ---- packs ---- */

static noh_wrinkles_header *header_in(const noh_pack *pack, uint8_t *bytes)
{
    const uint8_t *at = noh_pack_chunk_at(pack, NOH_CHUNK_WRINKLES, 0);
    return (noh_wrinkles_header *)(void *)(bytes + (at - pack->bytes));
}

static void lie(noh_wrinkles_header *h, uint32_t which)
{
    if (which == 0) h->color_material = 5;
    if (which == 1) h->color_texture = 99;
    if (which == 2) h->colors_offset += 16;
    if (which == 3) h->colors_offset = 0;
    if (which == 4) h->colors_offset = h->color_material = h->color_texture = 0;
    if (which == 5) h->reserved[1] = 1;
}

static void chunks_that_lie_are_refused(void **state)
{
    static const char *const words[] = { "a missing material",  "have no map", "does not begin at the end",
                                         "without colours has", "longer than", "reserved" };
    char path[1024];
    noh_file file;
    noh_error error = { NOH_OK, "", 0, 0 };
    (void)state;
    snprintf(path, sizeof path, "%s/demo/flush.noh", getenv("NOH_BUILD") ? getenv("NOH_BUILD") : "build");
    assert_int_equal(noh_file_map(path, &file, &error), NOH_OK);
    for (uint32_t i = 0; i < 6; ++i) {
        noh_pack pack;
        uint8_t *bytes = test_aligned(file.data, file.bytes);
        assert_int_equal(noh_pack_open(bytes, file.bytes, &pack, &error), NOH_OK);
        assert_int_equal(pack.material_count, 5);
        lie(header_in(&pack, bytes), i);
        pack_repair(bytes, file.bytes);
        assert_int_equal(noh_pack_open(bytes, file.bytes, &pack, &error), NOH_ERR_DATA);
        if (!strstr(error.what, words[i])) fail_msg("lie %u: %s", i, error.what);
        free(bytes);
    }
    noh_file_unmap(&file);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(rows_that_are_wrong_are_refused),
    cmocka_unit_test(recipes_colour_targets),
    cmocka_unit_test(what_cannot_be_coloured_is_said),
    cmocka_unit_test(chunks_that_lie_are_refused),
};

TEST_MAIN(tests, NULL, NULL)
