/* LOD levels drawn: each level looks like a mesh of its triangles alone; levels fade pixel by pixel, alone and in
 * crowds; meshes without the finer levels; the colours that tell levels apart. */
#include "support/tube_fixture.h"
#include "support/level_fixture.h"
#include "support/skin_asset.h"
#include "support/renderer.h"
#include "gl/draw/gl_draw_internal.h"
#include "stage/character/lod_pack_internal.h"
#include "stage/character/lod_internal.h"
#include "gl/draw/gl_renderer_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SIDE 192u
#define LEVELS 3u

/* ---- a tube with levels and without ---- */

static uint8_t *tube_bytes;
static noh_pack tube_pack;
static fixture_levels levels;
static tube with, without;

static void close_both(void)
{
    if (tube_bytes) {
        tube_close(&with);
        tube_close(&without);
        fixture_levels_close(&levels);
        free(tube_bytes);
        tube_bytes = NULL;
    }
}

/* Open one side, with at most `palette` joints per palette, 0: all. Kept for the tests that follow; skips without a
 * context. */
static void open_split(uint32_t palette)
{
    static uint32_t opened;
    const skin_cylinder c = { 24, 33, 9, 4, 3, 1, 2.0f, 0.35f };
    model *m;
    skin_options options;
    size_t count;
    noh_mesh mesh;
    fixture_gpu();
    if (tube_bytes && opened == palette) {
        return;
    }
    close_both();
    opened = palette;
    m = skin_cylinder_model(&c);
    memset(&options, 0, sizeof options);
    options.palette = palette;
    tube_bytes = skin_pack_of(m, &options, 1.0f, &count, NULL);
    tube_pack = test_open(tube_bytes, count);
    model_free(m);
    fixture_levels_open(&levels, &tube_pack, LEVELS, 0.12f);
    mesh = test_mesh(&levels.pack, 0);
    assert_true(mesh.header[1].index_count < mesh.header[0].index_count &&
                mesh.header[2].index_count < mesh.header[1].index_count);
    tube_open(&with, &mesh, NOH_PALETTE_TEXTURE);
    mesh = test_mesh(&tube_pack, 0);
    tube_open(&without, &mesh, NOH_PALETTE_TEXTURE);
}

static void open_both(void)
{
    open_split(0);
}

static int tear_down(void **state)
{
    close_both();
    return fixture_tear_down(state);
}

/* ---- pictures ---- */

static noh_gl_renderer_desc renderer_desc(const noh_mesh *meshes, uint32_t count)
{
    noh_gl_renderer_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.meshes = meshes;
    desc.mesh_count = count;
    desc.palettes = NOH_PALETTE_TEXTURE;
    desc.crowds = desc.fewer_influences = desc.fades = 1;
    return desc;
}

/* One side's copies, drawn once for each `lod` (NULL: without one), into one frame. */
static uint8_t *picture(const tube *s, const noh_gl_mesh *gl, draw_kind kind, const noh_gl_lod *lods, uint32_t count,
                        noh_debug_view view)
{
    const noh_gl_api *api = &fixture_gpu()->gl;
    noh_gl_renderer_desc desc = renderer_desc(&s->mesh, 1);
    noh_gl_renderer renderer;
    char log[4096];
    uint8_t *rgba;
    fixture_frame f;
    fixture_frame_open(&f, SIDE);
    desc.view = view;
    assert_int_equal(renderer_create(&(noh_gl_device){ api, NULL, &f.ledger, log, sizeof log }, &desc, &renderer, NULL),
                     NOH_OK);
    noh_gl_draw_begin(&renderer, &tube_camera);
    for (uint32_t i = 0; i < (lods ? count : 1u); i++) {
        tube_draw(&renderer, s, gl, kind, lods ? &lods[i] : NULL, NOH_DRAW_OPAQUE);
    }
    noh_gl_draw_end(&renderer);
    rgba = fixture_frame_read(&f);
    noh_gl_renderer_delete(&renderer);
    fixture_frame_close(&f);
    fixture_expect_no_errors();
    return rgba;
}

static uint8_t *picture_of_level(draw_kind kind, uint32_t level)
{
    const noh_gl_lod drawn = { level, 0.0f, 1.0f };
    return picture(&with, &with.gl, kind, &drawn, 1, NOH_VIEW_LIT);
}

static int covered(const uint8_t *rgba, uint32_t pixel)
{
    return rgba[4u * pixel + 3u] != 0;
}

static uint32_t covered_pixels(const uint8_t *rgba)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        count += (uint32_t)covered(rgba, i);
    }
    return count;
}

static void same_picture(uint8_t *got, uint8_t *expected)
{
    assert_true(covered_pixels(expected) > SIDE * SIDE / 20u);
    assert_memory_equal(got, expected, SIDE * SIDE * 4u);
    free(got);
    free(expected);
}

/* ---- a level is a mesh of its triangles ---- */

/* The mesh without levels, of one level's triangles alone, drawn. */
static uint8_t *picture_without(draw_kind kind, uint32_t level)
{
    const noh_mesh of = noh_mesh_at_lod(&with.mesh, level);
    noh_mesh_header header = *without.mesh.header;
    noh_mesh cut = without.mesh;
    noh_gl_ledger ledger;
    noh_gl_mesh gl;
    uint8_t *rgba;
    uint32_t *indices = test_zeros(4u * (size_t)of.header->index_count);
    for (uint32_t i = 0; i < of.header->index_count; i++) {
        indices[i] = levels.orders[0][noh_mesh_index(&of, i)];
    }
    memset(&ledger, 0, sizeof ledger);
    header.index_bytes = 4;
    header.index_count = of.header->index_count;
    cut.header = &header;
    cut.indices = indices;
    cut.submeshes = of.submeshes;
    assert_int_equal(noh_gl_mesh_create(&fixture_gpu()->gl, &ledger, &cut, &gl, NULL), NOH_OK);
    rgba = picture(&without, &gl, kind, NULL, 0, NOH_VIEW_LIT);
    noh_gl_mesh_delete(&fixture_gpu()->gl, &ledger, &gl);
    free(indices);
    return rgba;
}

static void expect_triangles(void)
{
    for (uint32_t level = 0; level < LEVELS; level++) {
        for (int kind = RIGID; kind <= CROWD; kind++) {
            same_picture(picture_of_level((draw_kind)kind, level), picture_without((draw_kind)kind, level));
        }
    }
}

static void a_level_draws_its_triangles(void **state)
{
    (void)state;
    open_both();
    expect_triangles();
}

static void so_where_joints_do_not_fit_a_palette(void **state)
{
    (void)state;
    open_split(6);
    assert_true(with.mesh.header->palette_count > 1);
    expect_triangles();
}

static void levels_differ(void **state)
{
    uint8_t *fine, *coarse;
    (void)state;
    open_both();
    fine = picture_of_level(SKINNED, 0);
    coarse = picture_of_level(SKINNED, 1);
    assert_memory_not_equal(fine, coarse, SIDE * SIDE * 4u);
    free(fine);
    free(coarse);
}

static void no_lod_is_the_finest(void **state)
{
    (void)state;
    open_both();
    same_picture(picture(&with, &with.gl, SKINNED, NULL, 0, NOH_VIEW_LIT), picture_of_level(SKINNED, 0));
    same_picture(picture(&with, &with.gl, CROWD, NULL, 0, NOH_VIEW_LIT), picture_of_level(CROWD, 0));
    same_picture(picture_of_level(SKINNED, 1000),
                 picture_of_level(SKINNED, LEVELS - 1u)); /* beyond the last level: the coarsest */
}

/* Uploaded from level 1 on: finer levels take no memory, and a draw of one draws level 1. */
static void finer_levels_can_stay_away(void **state)
{
    const noh_gl_lod lods[LEVELS] = { { 0, 0.0f, 1.0f }, { 1, 0.0f, 1.0f }, { 2, 0.0f, 1.0f } };
    noh_mesh view;
    noh_lod_mesh table_levels[NOH_LOD_LEVELS_MAX];
    noh_lod_table table;
    noh_lod chosen;
    noh_gl_ledger ledger;
    noh_gl_mesh gl;
    size_t first;
    (void)state;
    open_both();
    memset(&table, 0, sizeof table);
    view = noh_mesh_at_lod(&with.mesh, 1);
    memset(&ledger, 0, sizeof ledger);
    assert_int_equal(noh_gl_mesh_create(&fixture_gpu()->gl, &ledger, &view, &gl, NULL), NOH_OK);
    assert_true(noh_gl_ledger_bytes(&ledger) == noh_gl_mesh_bytes(&view));
    assert_int_equal(noh_gl_mesh_bytes(&with.mesh) - noh_gl_mesh_bytes(&view),
                     (with.mesh.header->vertex_count - view.header->vertex_count) *
                             (12u + with.mesh.header->attribute_stride + 12u) +
                         with.mesh.header->index_count * with.mesh.header->index_bytes);
    assert_int_equal(noh_gl_mesh_lod(&gl, 0, &first).header->level, 1);
    assert_int_equal(first, 0);
    assert_int_equal(noh_gl_mesh_lod(&gl, 9, &first).header->level, 2);
    assert_int_equal(first, view.header->index_count * view.header->index_bytes);
    noh_lod_mesh_levels(&view, table_levels, &table); /* LOD chooses by what is drawn */
    for (uint32_t k = table.mesh_level_first; k < table.mesh_level_count; k++) {
        const noh_mesh_header *drawn;
        noh_lod_set_mesh(&chosen, &table, k, 1.0f);
        drawn = noh_gl_mesh_lod(&gl, chosen.mesh, &first).header;
        assert_int_equal(drawn->level, k);
        assert_int_equal(drawn->vertex_count, table.meshes[chosen.mesh].vertex_count);
    }
    assert_int_equal(table.mesh_level_count, LEVELS);
    for (uint32_t k = 0; k < LEVELS; k++) {
        same_picture(picture(&with, &gl, CROWD, &lods[k], 1, NOH_VIEW_LIT), picture_of_level(CROWD, k ? k : 1u));
    }
    noh_gl_mesh_delete(&fixture_gpu()->gl, &ledger, &gl);
}

/* ---- fades ---- */

/* noh_fade_noise of common_fade.glsl, of the n-th pixel of a frame. */
static float noise(uint32_t x, uint32_t y)
{
    return (float)((x * 0xc13fa9a9u + y * 0x91e10da6u) >> 8) / 16777216.0f;
}

/* Each pixel comes from the level that the pattern selects, or from the background: never of both levels, never of
 * none. */
static void check_fade(draw_kind kind, float f)
{
    const noh_gl_lod lods[2] = { { 1, 0.0f, f }, { 0, f, 1.0f } };
    uint8_t *got = picture(&with, &with.gl, kind, lods, 2, NOH_VIEW_LIT);
    uint8_t *in = picture_of_level(kind, 1), *out = picture_of_level(kind, 0);
    uint32_t from_in = 0, from_out = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const int is_in = noise(i % SIDE, i / SIDE) < f;
        const uint8_t *expected = is_in ? in : out;
        if (memcmp(got + 4u * i, expected + 4u * i, 4) != 0) {
            fail_msg("fade %g: pixel %u, %u does not show the level that %s", (double)f, i % SIDE, i / SIDE,
                     is_in ? "comes" : "goes");
        }
        from_in += is_in && covered(in, i);
        from_out += !is_in && covered(out, i);
    }
    assert_int_equal(covered_pixels(got), from_in + from_out);
    assert_true(fabs((double)from_in / covered_pixels(in) - (double)f) < 0.01);
    free(got);
    free(in);
    free(out);
}

static void a_fade_draws_each_pixel_once(void **state)
{
    static const float steps[] = { 0.0f, 0.1f, 0.5f, 0.77f, 1.0f };
    (void)state;
    open_both();
    for (size_t i = 0; i < TEST_COUNT(steps); i++) {
        check_fade(SKINNED, steps[i]);
        check_fade(CROWD, steps[i]);
    }
    check_fade(RIGID, 0.3f);
    check_fade(FEWER, 0.3f);
}

static void a_level_fades_into_itself(void **state)
{
    const noh_gl_lod parts[3] = { { 0, 0.0f, 0.3f }, { 0, 0.3f, 0.31f }, { 0, 0.31f, 1.0f } };
    (void)state;
    open_both();
    same_picture(picture(&with, &with.gl, SKINNED, parts, 3, NOH_VIEW_LIT), picture_of_level(SKINNED, 0));
}

static void a_draw_of_no_pixels_draws_none(void **state)
{
    const noh_gl_lod none[3] = { { 0, 0.0f, 0.0f }, { 1, 1.0f, 1.0f }, { 1, 0.7f, 0.2f } };
    uint8_t *got;
    (void)state;
    open_both();
    got = picture(&with, &with.gl, CROWD, none, 3, NOH_VIEW_LIT);
    assert_int_equal(covered_pixels(got), 0);
    free(got);
}

/* In every block of 8 x 8 pixels, the share that is drawn is nearly the fade's, and rises with it. */
static void the_pattern_is_even(void **state)
{
    (void)state;
    for (uint32_t corner = 0; corner < 4096; corner++) {
        const uint32_t x = corner % 64u * 31u, y = corner / 64u * 29u;
        for (uint32_t step = 1; step < 16; step++) {
            const float f = (float)step / 16.0f;
            uint32_t drawn = 0;
            for (uint32_t i = 0; i < 64; i++) {
                drawn += noise(x + i % 8u, y + i / 8u) < f;
            }
            assert_true(fabsf((float)drawn - 64.0f * f) <= 5.0f);
        }
    }
}

static void only_renderers_that_fade_pay_for_it(void **state)
{
    noh_gl_renderer_desc desc;
    noh_gl_variant_key key;
    noh_gl_renderer fading, plain;
    noh_gl_ledger ledger;
    char log[4096];
    const noh_gl_api *gl;
    (void)state;
    open_both();
    gl = &fixture_gpu()->gl;
    desc = renderer_desc(&with.mesh, 1);
    key = noh_gl_variant_key_of(&with.mesh, NULL, 0, 0, NOH_VIEW_LIT);
    memset(&ledger, 0, sizeof ledger);
    assert_int_equal(renderer_create(&(noh_gl_device){ gl, NULL, &ledger, log, sizeof log }, &desc, &fading, NULL),
                     NOH_OK);
    desc.fades = 0;
    assert_int_equal(renderer_create(&(noh_gl_device){ gl, NULL, &ledger, log, sizeof log }, &desc, &plain, NULL),
                     NOH_OK);
    assert_int_equal(fading.variant_count, 2u * plain.variant_count);
    assert_non_null(noh_gl_renderer_variant(&plain, key));
    key.fade = 1;
    assert_null(noh_gl_renderer_variant(&plain, key));
    assert_non_null(noh_gl_renderer_variant(&fading, key));
    noh_gl_renderer_delete(&fading);
    noh_gl_renderer_delete(&plain);
    assert_int_equal(ledger.programs, 0);
}

/* ---- the debug view ---- */

static void mean_color(const uint8_t *rgba, double mean[3])
{
    double sum = 0.0;
    memset(mean, 0, 3 * sizeof *mean);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        for (uint32_t c = 0; covered(rgba, i) && c < 3; c++) {
            mean[c] += rgba[4u * i + c];
        }
    }
    for (int c = 0; c < 3; c++) {
        sum += mean[c];
    }
    assert_true(sum > 0.0);
    for (int c = 0; c < 3; c++) {
        mean[c] /= sum;
    }
}

/* The colours of all eight possible levels differ in hue, whatever the light. */
static void each_level_has_a_color(void **state)
{
    fixture_levels eight;
    noh_mesh mesh;
    double colors[NOH_LOD_LEVELS_MAX][3];
    tube s;
    (void)state;
    open_both();
    fixture_levels_open(&eight, &tube_pack, NOH_LOD_LEVELS_MAX, 0.005f);
    mesh = test_mesh(&eight.pack, 0);
    tube_open(&s, &mesh, NOH_PALETTE_TEXTURE);
    for (uint32_t k = 0; k < NOH_LOD_LEVELS_MAX; k++) {
        const noh_gl_lod drawn = { k, 0.0f, 1.0f };
        uint8_t *rgba = picture(&s, &s.gl, SKINNED, &drawn, 1, NOH_VIEW_LOD);
        mean_color(rgba, colors[k]);
        free(rgba);
        for (uint32_t other = 0; other < k; other++) {
            double square = 0.0;
            for (int c = 0; c < 3; c++) {
                square += (colors[k][c] - colors[other][c]) * (colors[k][c] - colors[other][c]);
            }
            assert_true(sqrt(square) > 0.1);
        }
    }
    assert_true(fabs(colors[0][0] - colors[0][2]) < 0.01); /* the full mesh is white */
    tube_close(&s);
    fixture_levels_close(&eight);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_level_draws_its_triangles),
    cmocka_unit_test(so_where_joints_do_not_fit_a_palette),
    cmocka_unit_test(levels_differ),
    cmocka_unit_test(no_lod_is_the_finest),
    cmocka_unit_test(finer_levels_can_stay_away),
    cmocka_unit_test(a_fade_draws_each_pixel_once),
    cmocka_unit_test(a_level_fades_into_itself),
    cmocka_unit_test(a_draw_of_no_pixels_draws_none),
    cmocka_unit_test(the_pattern_is_even),
    cmocka_unit_test(only_renderers_that_fade_pay_for_it),
    cmocka_unit_test(each_level_has_a_color),
};

TEST_MAIN(tests, NULL, tear_down)
