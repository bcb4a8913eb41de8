/* test_wrinkles.c: principal strains, generated creases, regions and their matrix. */
#include "support/support.h"
#include "support/wrinkle_sheet.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "convert/model/model_build.h"
#include "convert/wrinkle/wrinkle_creases.h"
#include "convert/wrinkle/wrinkle_folds.h"
#include "convert/wrinkle/wrinkle_make.h"
#include "convert/wrinkle/wrinkle_regions.h"
#include "file/png_file.h"
#include "noh/format.h"

#define PI 3.14159265358979323846

/* ---- strains ---- */

/* A triangle in a random plane, stretched by known amounts along known directions, then turned and shifted. */
static void strains_of_known_stretches(void **state)
{
    (void)state;
    test_random r = test_random_from(5);
    double worst = 0.0, worst_axis = 0.0;
    for (int round = 0; round < 20000; ++round) {
        double x[3], y[3], z[3], moved[3][3], rest[3][3], now[3][3], along = 0.0;
        const double most = (double)test_random_float(&r, 0.9f, 1.6f),
                     least = (double)test_random_float(&r, 0.2f, 0.85f);
        for (int i = 0; i < 3; ++i) {
            x[i] = (double)test_random_float(&r, -1, 1);
            y[i] = (double)test_random_float(&r, -1, 1);
        }
        vec_normalize(x);
        vec_reject(y, x);
        vec_normalize(y);
        vec_cross(x, y, z);
        memcpy(moved[0], z, sizeof z); /* anything orthonormal */
        memcpy(moved[1], x, sizeof x);
        for (int k = 0; k < 3; ++k) {
            const double a = (k == 1) + (double)test_random_float(&r, -0.2f, 0.2f);
            const double b = (k == 2) + (double)test_random_float(&r, -0.2f, 0.2f);
            for (int i = 0; i < 3; ++i) {
                rest[k][i] = a * x[i] + b * y[i];
                now[k][i] = most * a * moved[0][i] + least * b * moved[1][i] + 3.0;
            }
        }
        wrinkle_strain s;
        assert_int_equal(wrinkle_strain_of(rest, now, &s), 1);
        worst = fmax(worst, fmax(fabs(s.most - most), fabs(s.least - least)));
        along = fabs(vec_dot(s.axis, x));
        worst_axis = fmax(worst_axis, 1.0 - along);
    }
    print_message("principal stretches: off by at most %.2g, axis 1 - cosine %.2g\n", worst, worst_axis);
    assert_true(worst < 1e-9 && worst_axis < 1e-9);
    double flat[3][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 } };
    wrinkle_strain s;
    assert_int_equal(wrinkle_strain_of(flat, flat, &s), 0);
}

/* ---- a sheet ---- */

#define SIDE 33
#define VERTICES (SIDE * SIDE)
#define TRIANGLES ((SIDE - 1) * (SIDE - 1) * 2)

/* A square sheet, 1 by 1, that target 0 compresses along x in its left third, target 1 along y in its right third. */
typedef struct sheet {
    float position[VERTICES][3], normal[VERTICES][3], tangent[VERTICES][4], uv[VERTICES][2], deltas[2][VERTICES][3];
    uint32_t indices[3 * TRIANGLES];
    model_submesh sub;
    model_target targets[2];
    model_mesh mesh;
} sheet;

static float squeeze(float at, float first, float last, float least)
{
    const float inside = fminf(fmaxf(at, first), last);
    return -(inside - first) * (1.0f - least); /* what lies behind moves along: it keeps its shape */
}

static void sheet_make(sheet *s)
{
    memset(s, 0, sizeof *s);
    for (uint32_t v = 0; v < VERTICES; ++v) {
        const float x = (float)(v % SIDE) / (SIDE - 1), y = (float)(v / SIDE) / (SIDE - 1);
        s->position[v][0] = s->uv[v][0] = x;
        s->position[v][1] = 1.0f - y; /* v runs down */
        s->uv[v][1] = y;
        s->normal[v][2] = s->tangent[v][0] = s->tangent[v][3] = 1.0f;
        s->deltas[0][v][0] = squeeze(x, 0.0f, 0.34375f, 0.8f);
        s->deltas[1][v][1] = squeeze(1.0f - y, 0.25f, 0.75f, 0.7f) * fminf(fmaxf(x - 0.65f, 0.0f) * 16.0f, 1.0f);
    }
    for (uint32_t i = 0; i < TRIANGLES; ++i) {
        const uint32_t cell = i / 2, v = cell / (SIDE - 1) * SIDE + cell % (SIDE - 1);
        const uint32_t corners[2][3] = { { v, v + SIDE, v + 1 }, { v + 1, v + SIDE, v + SIDE + 1 } };
        memcpy(&s->indices[3 * i], corners[i % 2], sizeof corners[0]);
    }
    s->sub = (model_submesh){ .index_count = 3 * TRIANGLES, .vertex_count = VERTICES };
    s->targets[0].position = s->deltas[0][0];
    s->targets[1].position = s->deltas[1][0];
    s->mesh = (model_mesh){ .vertex_count = VERTICES,
                            .index_count = 3 * TRIANGLES,
                            .submesh_count = 1,
                            .target_count = 2,
                            .position = s->position[0],
                            .normal = s->normal[0],
                            .tangent = s->tangent[0],
                            .uv = s->uv[0],
                            .indices = s->indices,
                            .submeshes = &s->sub,
                            .targets = s->targets };
}

/* Creases run along y where x is compressed, and the other way round: slopes are across them. */
static void creases_lie_across_the_compression(void **state)
{
    (void)state;
    static sheet s;
    wrinkle_field f;
    wrinkle_raster r;
    double sums[2][2] = { { 0 } };
    sheet_make(&s);
    assert_int_equal(wrinkle_field_make(&s.mesh, 0, &f), 0);
    assert_int_equal(wrinkle_raster_make(&f, 128, 128, &r), 0);
    assert_int_equal(r.covered, 128 * 128);
    assert_int_equal(r.overlapped, 0);
    uint8_t *map = wrinkle_creases_make(&f, &r, 0.08), *again = wrinkle_creases_make(&f, &r, 0.08);
    assert_non_null(map);
    assert_memory_equal(map, again, 4 * 128 * 128);
    for (int i = 0; i < 128 * 128; ++i) {
        const int x = i % 128, y = i / 128, right = x > 90 && y > 40 && y<88, left = x> 4 && x < 40;
        if (x > 48 && x < 76) assert_memory_equal(map + 4 * i, ((const uint8_t[4]){ 128, 128, 255, 255 }), 4);
        for (int c = 0; c < 2 && (left || right); ++c) sums[right][c] += pow((map[4 * i + c] - 128) / 127.0, 2);
    }
    print_message("slopes squared where x shrinks: %.1f along x, %.1f along y; where y does: %.1f and %.1f\n",
                  sums[0][0], sums[0][1], sums[1][0], sums[1][1]);
    assert_true(sums[0][0] > 100 * sums[0][1] && sums[0][0] > 100);
    assert_true(sums[1][1] > 100 * sums[1][0] && sums[1][1] > 50);
    free(map);
    free(again);
    wrinkle_raster_free(&r);
    wrinkle_field_free(&f);
}

static void regions_follow_targets(void **state)
{
    (void)state;
    static sheet s;
    wrinkle_field f;
    sheet_make(&s);
    assert_int_equal(wrinkle_field_make(&s.mesh, 0, &f), 0);
    region_weights *regions = wrinkle_regions_make(&f);
    assert_non_null(regions);
    wrinkle_raster raster;
    region_maps maps = { .width = 64, .height = 64 };
    assert_int_equal(wrinkle_raster_make(&f, 64, 64, &raster), 0);
    assert_int_equal(wrinkle_maps_make(&f, regions, &raster, maps.map), 0);
    wrinkle_raster_free(&raster);
    uint8_t *matrix = wrinkle_matrix_make(&f, &maps);
    for (uint32_t k = 0; k < REGION_MAP_COUNT; ++k) free(maps.map[k]);
    assert_non_null(matrix);
    for (uint32_t r = 0; r < REGION_COUNT; ++r) {
        float covered[3] = { 0 };
        for (uint32_t v = 0; v < VERTICES; ++v) {
            const float x = s.uv[v][0];
            covered[x < 0.4f ? 0 : x > 0.6f ? 2 : 1] += regions[v][r];
            assert_true(regions[v][r] >= 0.0f && regions[v][r] <= 1.0f);
        }
        assert_true(covered[1] == 0.0f);                       /* nothing is compressed there */
        assert_true(covered[0] == 0.0f || covered[2] == 0.0f); /* a region belongs to one target */
        if (covered[0] > 0.0f) assert_true(matrix[r] == 255 && matrix[REGION_COUNT + r] == 0);
        if (covered[2] > 0.0f) assert_true(matrix[REGION_COUNT + r] == 255 && matrix[r] == 0);
    }
    for (uint32_t v = 0; v < VERTICES; ++v) { /* inside both thirds some region is whole */
        float most = 0.0f;
        for (uint32_t r = 0; r < REGION_COUNT; ++r) most = fmaxf(most, regions[v][r]);
        if (s.uv[v][0] > 0.1f && s.uv[v][0] < 0.3f) assert_true(most == 1.0f);
    }
    free(matrix);
    free(regions);
    wrinkle_field_free(&f);
}

/* A painted region's row of the matrix is what the targets do under its texels. */
static void a_painted_mask_gets_its_matrix(void **state)
{
    (void)state;
    static sheet s;
    static uint8_t codes[64 * 64 * 4];
    wrinkle_field f;
    region_maps maps = { .width = 64, .height = 64 };
    const region_mask mask = { 64, 64, codes };
    sheet_make(&s);
    for (int i = 0; i < 64 * 64; ++i) {
        codes[4 * i] = i % 64 < 16 ? 75 : i % 64 > 50 ? 165 : 0; /* region 0 left, region 1 right */
        codes[4 * i + 3] = 255;                                  /* region 11 everywhere */
    }
    assert_int_equal(wrinkle_field_make(&s.mesh, 0, &f), 0);
    assert_int_equal(region_maps_make(&mask, maps.map), 0);
    uint8_t *matrix = wrinkle_matrix_make(&f, &maps);
    assert_non_null(matrix);
    assert_int_equal(matrix[0], 255);
    assert_int_equal(matrix[REGION_COUNT], 0);
    assert_int_equal(matrix[1], 0);
    assert_int_equal(matrix[REGION_COUNT + 1], 255);
    assert_true(matrix[11] > 100 && matrix[REGION_COUNT + 11] > 100);
    assert_int_equal(matrix[5], 0); /* an empty region */
    free(matrix);
    for (uint32_t k = 0; k < REGION_MAP_COUNT; ++k) free(maps.map[k]);
    wrinkle_field_free(&f);
}

/* ---- targets that compress nothing ---- */

#define MASK_SIDE 64u

static char mask_path[64];

/* Region 0 left of 0.45, region 4 right of 0.55. */
static void write_mask(void)
{
    static uint8_t codes[MASK_SIDE * MASK_SIDE * 4];
    memset(codes, 0, sizeof codes);
    for (uint32_t i = 0; i < MASK_SIDE * MASK_SIDE; ++i) {
        const float u = ((float)(i % MASK_SIDE) + 0.5f) / MASK_SIDE;
        if (u < 0.45f) codes[4 * i] = 75;
        if (u > 0.55f) codes[4 * i + 1] = 165;
    }
    snprintf(mask_path, sizeof mask_path, "/tmp/noh_mask_%ld.png", (long)getpid());
    assert_int_equal(tool_write_png(mask_path, MASK_SIDE, MASK_SIDE, codes), 0);
}

static model *sheet_with_mask(const sheet_target *targets, uint32_t count, const recipe_text *recipe)
{
    model *m = wrinkle_sheet_make(targets, count);
    model_error error = { "", "" };
    wrinkle_settings settings = { .models = NOH_WRINKLE_BY_REGION, .recipe = recipe };
    write_mask();
    settings.mask = mask_path;
    if (wrinkles_make(m, &settings, &error)) print_message("%s\n", error.what);
    unlink(mask_path);
    return m;
}

static void squeeze_left(float at[3])
{
    if (at[0] < 0.0f) at[0] *= 0.5f;
}
static void grow(float at[3])
{
    if (at[0] > 0.0f) at[0] *= 1.37f;
}
static void slide(float at[3])
{
    at[0] += 0.3f, at[1] += 0.1f, at[2] += 0.2f;
}
static void turn(float at[3])
{
    const float x = at[0], y = at[1];
    at[0] = 0.8f * x - 0.6f * y + 1000.0f; /* far away coordinates are rounded to more */
    at[1] = 0.6f * x + 0.8f * y - 300.0f;
}
static void widen(float at[3]) /* the sheet is torn along x = 0, where its triangles shear */
{
    if (at[0] > 0.0f) at[1] *= 1.37f;
}
static void stay(float at[3])
{
    (void)at;
}
static void shrink_slightly(float at[3])
{
    if (at[0] > 0.0f) at[0] *= 0.999f;
}

static unsigned tie(const model *m, uint32_t target, uint32_t region)
{
    return m->meshes[0].wrinkles[target * REGION_COUNT + region];
}

/* What moves a region alike, turns it, lets it grow, leaves it, or compresses it by less than shows, is not tied to it,
 * and an expression that does so beside one that compresses it neither. */
static void targets_that_compress_nothing_are_tied_to_no_region(void **state)
{
    (void)state;
    const sheet_target targets[] = { { "squeeze", squeeze_left },  { "grow", grow }, { "widen", widen },
                                     { "slide", slide },           { "turn", turn }, { "stay", stay },
                                     { "slight", shrink_slightly } };
    const uint32_t count = sizeof targets / sizeof targets[0];
    model *m = sheet_with_mask(targets, count, NULL);
    assert_non_null(m->meshes[0].wrinkles);
    for (uint32_t t = 0; t < count; ++t) {
        for (uint32_t r = 0; r < REGION_COUNT; ++r) assert_int_equal(tie(m, t, r), t == 0 && r == 0 ? 255 : 0);
    }
    assert_int_equal(m->warning_count, 1);
    assert_non_null(strstr(m->warnings[0], "in region 4 of the mask"));
    model_free(m);
}

static void eyes_teeth_and_toons_have_none(void **state)
{
    static const uint32_t surfaces[] = { NOH_SURFACE_PLAIN, NOH_SURFACE_SKIN, NOH_SURFACE_EYE, NOH_SURFACE_TEETH,
                                         NOH_SURFACE_TOON };
    const sheet_target squeezed = { "squeeze", squeeze_left };
    const wrinkle_settings settings = { .automatic = 1, .size = 64 };
    (void)state;
    for (uint32_t i = 0; i < sizeof surfaces / sizeof surfaces[0]; ++i) {
        model *m = wrinkle_sheet_make(&squeezed, 1);
        model_error error = { "", "" };
        m->materials[0].surface = surfaces[i];
        assert_int_equal(wrinkles_make(m, &settings, &error), i > 1);
        assert_int_equal(m->meshes[0].wrinkles != NULL, i < 2);
        if (i > 1) assert_non_null(strstr(error.what, "no eye, teeth or toon"));
        model_free(m);
    }
}

/* ---- edges of textures ---- */

/* A vertex at u = 1 reads the right edge of a mask and not the left one, in whichever tile the coordinates are; a part
 * across several tiles goes on repeating, and so does one whose textures say otherwise. */
static void masks_end_at_their_edges(void **state)
{
    (void)state;
    static const struct {
        float u, v;
        uint32_t base_wrap, wrap_s, wrap_t;
        float first_u, first_v;
    } cases[] = { { 0.0f, 0.0f, 10497, 33071, 33071, 0.0f, 0.0f },
                  { 3.0f, -2.0f, 10497, 33071, 33071, 0.0f, 0.0f },
                  { 0.5f, 0.0f, 10497, 10497, 33071, 0.5f, 0.0f },
                  { 1.0f, 0.0f, 33648, 10497, 33071, 1.0f, 0.0f },
                  { 1e-5f, -1e-5f, 10497, 33071, 33071, 1e-5f, 0.0f } };
    const sheet_target targets[] = { { "squeeze", squeeze_left } };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        model *m = wrinkle_sheet_make(targets, 1);
        model_error error = { "", "" };
        const wrinkle_settings settings = { .models = NOH_WRINKLE_BY_REGION, .automatic = 1 };
        m->textures[0].wrap_s = m->textures[0].wrap_t = cases[i].base_wrap;
        for (uint32_t v = 0; v < WRINKLE_SHEET_VERTICES; ++v) {
            m->meshes[0].uv[2 * v] += cases[i].u;
            m->meshes[0].uv[2 * v + 1] += cases[i].v;
        }
        assert_int_equal(wrinkles_make(m, &settings, &error), 0);
        assert_true(m->meshes[0].uv[0] == cases[i].first_u && m->meshes[0].uv[1] == cases[i].first_v);
        for (uint32_t k = 0; k < 4; ++k) {
            const model_material *skin = &m->materials[0];
            const model_texture *t = &m->textures[k < 3 ? skin->more_textures[k] : skin->wrinkle_texture];
            assert_int_equal(t->wrap_s, cases[i].wrap_s);
            assert_int_equal(t->wrap_t, cases[i].wrap_t);
        }
        for (uint32_t v = 0; v < 2 * WRINKLE_SHEET_VERTICES && cases[i].wrap_s == 33071; ++v) {
            assert_true(m->meshes[0].uv[v] >= 0.0f && m->meshes[0].uv[v] <= 1.0f);
        }
        model_free(m);
    }
}

/* ---- an artist's table ---- */

static recipe_text *recipe_of(const char *text)
{
    recipe_text *recipe = recipe_new();
    model_error error = { "", "" };
    uint32_t line = 0;
    assert_int_equal(recipe_add_text(recipe, text, strlen(text), &line, &error), 0);
    return recipe;
}

static void rows_of_a_recipe_tie_expressions_to_regions(void **state)
{
    (void)state;
    const sheet_target targets[] = { { "squeeze", squeeze_left }, { "slide", slide } };
    recipe_text *recipe = recipe_of("wrinkle slide 4 0.6 # painted on the right\nwrinkle slide 11\n");
    model *m = sheet_with_mask(targets, 2, recipe);
    assert_int_equal(tie(m, 0, 0), 255); /* without rows: as measured */
    assert_int_equal(tie(m, 1, 0), 0);
    assert_int_equal(tie(m, 1, 4), 153);
    assert_int_equal(tie(m, 1, 11), 255);
    assert_int_equal(m->warning_count, 0);
    model_free(m);
    recipe_free(recipe);
    recipe = recipe_of("wrinkle squeeze 4 1\nwrinkle squeeze 0 0\n"); /* in place of what is measured */
    m = sheet_with_mask(targets, 2, recipe);
    assert_int_equal(tie(m, 0, 0), 0);
    assert_int_equal(tie(m, 0, 4), 255);
    assert_non_null(strstr(m->warnings[0], "in region 0 of the mask"));
    model_free(m);
    m = sheet_with_mask(targets + 1, 1, NULL); /* nothing is compressed, and nobody says more */
    assert_null(m->meshes[0].wrinkles);
    model_free(m);
    recipe_free(recipe);
    recipe = recipe_of("wrinkle slide 0\n");
    m = sheet_with_mask(targets + 1, 1, recipe);
    assert_int_equal(tie(m, 0, 0), 255);
    model_free(m);
    recipe_free(recipe);
}

/* ---- masks that pixels read ---- */

static uint32_t add_map(model *m)
{
    model_texture *grown = realloc(m->textures, (m->texture_count + 1u) * sizeof *grown);
    assert_non_null(grown);
    m->textures = grown;
    grown[m->texture_count] = (model_texture){ .name = model_string("map"),
                                               .width = 1,
                                               .height = 1,
                                               .rgba = model_zeros(1, 4),
                                               .wrap_s = 10497,
                                               .wrap_t = 10497 };
    return m->texture_count++;
}

/* A mask of codes in place of three maps, as it was painted; where a pixel has no fetch left for it, vertices read it. */
static void masks_are_kept_for_pixels(void **state)
{
    (void)state;
    const sheet_target targets[] = { { "squeeze", squeeze_left } };
    for (int full = 0; full < 2; ++full) {
        model *m = wrinkle_sheet_make(targets, 1);
        model_error error = { "", "" };
        const wrinkle_settings settings = { .models = NOH_WRINKLE_BY_REGION, .mask = mask_path, .by_pixel = 1 };
        model_material *skin = m->materials;
        skin->normal_texture = add_map(m);
        skin->surface_texture = add_map(m);
        skin->emissive[1] = 0.5f;
        if (full) skin->specular_texture = add_map(m);
        write_mask();
        assert_int_equal(wrinkles_make(m, &settings, &error), 0);
        unlink(mask_path);
        skin = m->materials;
        assert_int_equal(skin->wrinkle_codes, !full);
        assert_int_equal(skin->more_textures[1] == MODEL_NONE, !full);
        assert_int_equal(m->warning_count, full ? 2 : 1); /* region 4 is idle, too */
        const model_texture *t = &m->textures[skin->more_textures[0]];
        assert_int_equal(t->use, full ? MODEL_TEXTURE_DATA : MODEL_TEXTURE_CODES);
        assert_int_equal(t->mag_filter, full ? 0 : 9728);
        assert_int_equal(t->rgba[0], full ? 255 : 75);
        model_free(m);
    }
}

/* Halves that share their texels: a mask finds what targets do on both; generated maps cannot tell them apart. */
static void mirrored_coordinates_take_painted_files(void **state)
{
    (void)state;
    const sheet_target targets[] = { { "squeeze", squeeze_left } };
    char map_path[80];
    static const uint8_t normal[4 * 4 * 4] = { 128, 128, 255, 255 };
    write_mask();
    snprintf(map_path, sizeof map_path, "%s.map.png", mask_path);
    assert_int_equal(tool_write_png(map_path, 4, 4, normal), 0);
    for (int painted = 0; painted < 2; ++painted) {
        model *m = wrinkle_sheet_make(targets, 1);
        model_error error = { "", "" };
        const wrinkle_settings settings = { .models = NOH_WRINKLE_BY_REGION,
                                            .automatic = 1,
                                            .map = painted ? map_path : NULL,
                                            .mask = painted ? mask_path : NULL };
        for (uint32_t v = 0; v < WRINKLE_SHEET_VERTICES; ++v) {
            float *u = &m->meshes[0].uv[2 * v];
            *u = fabsf(2.0f * *u - 1.0f); /* from the middle outwards, on both sides */
        }
        assert_int_equal(wrinkles_make(m, &settings, &error), !painted);
        if (painted)
            assert_true(tie(m, 0, 0) == 255 && tie(m, 0, 4) == 255); /* both regions lie on the left half, too */
        model_free(m);
    }
    unlink(map_path);
    unlink(mask_path);
}

static void rows_of_wrinkles_that_are_wrong_are_refused(void **state)
{
    (void)state;
    static const char *const lines[] = { "wrinkle a",        "wrinkle a 12",
                                         "wrinkle a -1",     "wrinkle a 1.5",
                                         "wrinkle a 1 1.01", "wrinkle a 1 -0.1",
                                         "wrinkle a 1 1 1",  "wrinkle a 1\nwrinkle a 1 0.5",
                                         "wrinkle a b" };
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; ++i) {
        recipe_text *recipe = recipe_new();
        model_error error = { "", "" };
        uint32_t line = 0;
        assert_int_equal(recipe_add_text(recipe, lines[i], strlen(lines[i]), &line, &error), 1);
        assert_true(error.what[0] != '\0');
        recipe_free(recipe);
    }
}

/* ---- real faces ---- */

static void slope_at(const wrinkle_field *f, const wrinkle_raster *r, const uint8_t *map, size_t at, double slope[3])
{
    double normal[3] = { 0 }, tangent[3] = { 0 }, bitangent[3], sign = 1;
    for (uint32_t k = 0; k < 3; ++k) {
        const size_t v = wrinkle_corner(f, r->triangle[at], k);
        for (size_t i = 0; i < 3; ++i) {
            normal[i] += (double)(r->share[at][k] * f->mesh->normal[3 * v + i]);
            tangent[i] += (double)(r->share[at][k] * f->mesh->tangent[4 * v + i]);
        }
        sign = (double)f->mesh->tangent[4 * v + 3];
    }
    vec_normalize(normal);
    vec_reject(tangent, normal);
    vec_normalize(tangent);
    vec_cross(normal, tangent, bitangent);
    for (int i = 0; i < 3; ++i) {
        slope[i] = (map[4 * at] - 128) * tangent[i] + sign * (map[4 * at + 1] - 128) * bitangent[i];
    }
}

/* The larger principal axis of a tensor, by the power method. */
static void principal(const double t[6], double axis[3])
{
    double a[3] = { 1.0, 0.61, 0.37 };
    for (int round = 0; round < 200; ++round) {
        const double b[3] = { t[0] * a[0] + t[3] * a[1] + t[4] * a[2], t[3] * a[0] + t[1] * a[1] + t[5] * a[2],
                              t[4] * a[0] + t[5] * a[1] + t[2] * a[2] };
        memcpy(a, b, sizeof a);
        if (!vec_normalize(a)) break;
    }
    memcpy(axis, a, sizeof a);
}

/* The axis of a texel: of the strain of the surface about the corners of its triangle (the mean of the triangles around
 * each), or of its triangle alone. */
static void axis_at(const wrinkle_field *f, const wrinkle_raster *r, size_t at, int of_triangle, double axis[3])
{
    double t[6] = { 0 };
    for (uint32_t k = 0; k < 3; ++k) {
        const double *corner = f->tensor[wrinkle_corner(f, r->triangle[at], k)];
        for (int i = 0; i < 6; ++i) t[i] += (double)r->share[at][k] * corner[i];
    }
    principal(of_triangle ? f->demand[r->triangle[at]] : t, axis);
}

/* Shares of the texels that shrink by 3 % or more and whose mean slope is at right angles to the principal axis, to 15
 * degrees. surface: the slope within two texels against the mean strain about the triangle; triangle: of the texels
 * in the same triangle, against its exact strain; turned: the first axis a quarter turn away, which creases must not
 * follow. */
typedef struct agreement {
    size_t count, surface, triangle, turned;
} agreement;

/* The direction of the slopes within two texels, up to its sign. */
static void slope_near(const wrinkle_field *f, const wrinkle_raster *r, const uint8_t *map, size_t at, int of_triangle,
                       double across[3])
{
    double sums[6] = { 0 };
    for (int i = 0; i < 25; ++i) {
        const size_t near = at + (size_t)(i % 5) - 2 + ((size_t)(i / 5) - 2) * r->width;
        double s[3];
        if (near >= (size_t)r->width * r->height || r->triangle[near] == MODEL_NONE) continue;
        if (of_triangle && r->triangle[near] != r->triangle[at]) continue;
        slope_at(f, r, map, near, s);
        const double products[6] = { s[0] * s[0], s[1] * s[1], s[2] * s[2], s[0] * s[1], s[0] * s[2], s[1] * s[2] };
        for (int k = 0; k < 6; ++k) sums[k] += products[k];
    }
    principal(sums, across);
}

static void compare_texel(const wrinkle_field *f, const wrinkle_raster *r, const uint8_t *map, size_t at, agreement *a)
{
    double across[3], axis[3];
    ++a->count;
    slope_near(f, r, map, at, 0, across);
    axis_at(f, r, at, 0, axis);
    a->surface += vec_dot(across, across) > 0.5 && fabs(vec_dot(across, axis)) <= sin(15 * PI / 180);
    a->turned += fabs(vec_dot(across, axis)) >= cos(15 * PI / 180);
    slope_near(f, r, map, at, 1, across);
    axis_at(f, r, at, 1, axis);
    a->triangle += vec_dot(across, across) > 0.5 && fabs(vec_dot(across, axis)) <= sin(15 * PI / 180);
}

static void check_face(const char *path, uint32_t size)
{
    model *m;
    model_error error;
    wrinkle_field f;
    wrinkle_raster r;
    agreement a = { 0, 0, 0, 0 };
    assert_int_equal(model_read_gltf(path, &m, &error), 0);
    assert_int_equal(wrinkle_field_make(&m->meshes[0], 0, &f), 0);
    assert_int_equal(wrinkle_raster_make(&f, size, size, &r), 0);
    uint8_t *map = wrinkle_creases_make(&f, &r, wrinkle_spacing(&f));
    assert_non_null(map);
    for (size_t at = 0; at < (size_t)size * size; ++at) {
        const uint32_t triangle = r.triangle[at];
        if (triangle != MODEL_NONE && f.largest[triangle] >= 0.03f) compare_texel(&f, &r, map, at, &a);
    }
    print_message(
        "%s: of %zu texels that shrink by 3 %%, %.4f have creases within 15 degrees of the surface's axis, %.4f "
        "of their triangle's alone, %.4f across it\n",
        path, a.count, (double)a.surface / (double)a.count, (double)a.triangle / (double)a.count,
        (double)a.turned / (double)a.count);
    assert_true(a.count > 10000 && a.surface * 10 >= a.count * 9 && a.triangle * 10 >= a.count * 9 &&
                a.turned * 50 <= a.count);
    free(map);
    wrinkle_raster_free(&r);
    wrinkle_field_free(&f);
    model_free(m);
}

static void creases_follow_the_principal_axis(void **state)
{
    (void)state;
    char path[1024];
    snprintf(path, sizeof path, "%s/mask.glb", getenv("NOH_BUILD") ? getenv("NOH_BUILD") : "build");
    check_face(path, 256);
}

static void creases_of_a_human_head(void **state)
{
    (void)state;
    check_face(test_asset("hero/head.glb"), 512);
}

/* ---- folds of faces ---- */

static uint32_t target_of(const model_mesh *mesh, const char *name)
{
    for (uint32_t t = 0; t < mesh->target_count; ++t) {
        if (strcmp(mesh->targets[t].name, name) == 0) return t;
    }
    fail_msg("no target %s", name);
    return 0;
}

static void find_face(const char *path, model **m, wrinkle_field *f, wrinkle_folds *folds)
{
    model_error error;
    assert_int_equal(model_read_gltf(path, m, &error), 0);
    assert_int_equal(wrinkle_field_make(&(*m)->meshes[0], 0, f), 0);
    assert_int_equal(wrinkle_folds_find(f, NULL, folds), 1);
    print_message("%s: eyes %.1f mm apart, brows at %.3f, mouth at %.3f, %.3f\n", path, 1e3 * folds->face.unit,
                  folds->face.brow, folds->face.mouth[0], folds->face.mouth[1]);
}

/* Landmarks by channels, for targets named after ARKit and after action units. */
static void faces_are_found_by_what_their_channels_move(void **state)
{
    (void)state;
    char path[1024];
    snprintf(path, sizeof path, "%s/mask.glb", getenv("NOH_BUILD") ? getenv("NOH_BUILD") : "build");
    const char *const paths[] = { path, test_asset("hero/head.glb") };
    for (int i = 0; i < 2; ++i) {
        model *m;
        wrinkle_field f;
        wrinkle_folds folds;
        find_face(paths[i], &m, &f, &folds);
        const wrinkle_face *face = &folds.face;
        assert_true(face->unit > 0.055 && face->unit < 0.068);
        assert_true(face->axis[0][0] > 0.99 && face->axis[1][1] > 0.95 && face->axis[2][2] > 0.95);
        assert_true(face->brow > 0.2 && face->brow < 0.7);
        assert_true(face->mouth[0] > 0.3 && face->mouth[0] < 0.6 && face->mouth[1] > -1.2 && face->mouth[1] < -0.9);
        wrinkle_field_free(&f);
        model_free(m);
    }
    static sheet s;
    wrinkle_field f;
    wrinkle_folds folds;
    sheet_make(&s);
    s.targets[0].name = (char *)"left", s.targets[1].name = (char *)"right";
    assert_int_equal(wrinkle_field_make(&s.mesh, 0, &f), 0);
    assert_int_equal(wrinkle_folds_find(&f, NULL, &folds), 0); /* nothing blinks */
    wrinkle_field_free(&f);
}

/* A face turned upside down and away, scaled, has the same folds: its coordinates are its own. */
static void folds_follow_the_face(void **state)
{
    (void)state;
    model *m;
    wrinkle_field f;
    wrinkle_folds folds, turned;
    find_face(test_asset("hero/head.glb"), &m, &f, &folds);
    model_mesh *mesh = &m->meshes[0];
    for (uint32_t t = 0; t <= mesh->target_count; ++t) {
        float *p = t ? mesh->targets[t - 1].position : mesh->position;
        for (size_t v = 0; v < mesh->vertex_count; ++v) {
            p[3 * v] *= 100.0f, p[3 * v + 1] *= -100.0f, p[3 * v + 2] *= -100.0f;
        }
    }
    for (size_t v = 0; v < mesh->vertex_count; ++v) mesh->normal[3 * v + 1] *= -1.0f, mesh->normal[3 * v + 2] *= -1.0f;
    wrinkle_field_free(&f);
    assert_int_equal(wrinkle_field_make(mesh, 0, &f), 0);
    assert_int_equal(wrinkle_folds_find(&f, NULL, &turned), 1);
    assert_true(fabs(turned.face.unit - 100.0 * folds.face.unit) < 0.01 && turned.face.axis[1][1] < -0.95);
    assert_true(fabs(turned.face.brow - folds.face.brow) < 1e-4);
    assert_true(fabs(turned.face.mouth[1] - folds.face.mouth[1]) < 1e-4);
    wrinkle_field_free(&f);
    model_free(m);
}

/* The zones of a region: the matrix of the mask. */
static void expressions_fold_their_own_zones(void **state)
{
    (void)state;
    enum { FOREHEAD = 2, FROWN = 5, SMILE_LEFT = 6 };
    static const struct {
        const char *target;
        uint32_t region;
        uint8_t least, most;
    } cases[] = { { "anger", FROWN, 200, 255 },
                  { "browDownLeft", FROWN, 100, 255 },
                  { "surprise", FROWN, 0, 0 },
                  { "browInnerUp", FROWN, 0, 0 },
                  { "surprise", FOREHEAD, 200, 255 },
                  { "anger", FOREHEAD, 0, 0 },
                  { "mouthSmileLeft", SMILE_LEFT, 200, 255 },
                  { "mouthSmileRight", SMILE_LEFT, 0, 0 } };
    char path[1024];
    model *m;
    model_error error = { "", "" };
    const wrinkle_settings settings = { .automatic = 1 };
    snprintf(path, sizeof path, "%s/mask.glb", getenv("NOH_BUILD") ? getenv("NOH_BUILD") : "build");
    assert_int_equal(model_read_gltf(path, &m, &error), 0);
    assert_int_equal(wrinkles_make(m, &settings, &error), 0);
    const model_material *skin = &m->materials[0];
    const model_texture *map = &m->textures[skin->wrinkle_texture];
    size_t folded = 0;
    for (size_t i = 0; i < (size_t)map->width * map->height; ++i) {
        folded += abs(map->rgba[4 * i] - 128) > 4 || abs(map->rgba[4 * i + 1] - 128) > 4;
    }
    print_message("folds on %.1f %% of the texels\n", 100.0 * (double)folded / (map->width * map->height));
    assert_true(folded * 100 > map->width * map->height && folded * 10 < map->width * map->height); /* not a net */
    assert_int_equal(skin->wrinkle_models, NOH_WRINKLE_BY_REGION);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const unsigned tied = tie(m, target_of(&m->meshes[0], cases[i].target), cases[i].region);
        print_message("%s: %u of region %u\n", cases[i].target, tied, cases[i].region);
        assert_in_range(tied, cases[i].least, cases[i].most);
    }
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strains_of_known_stretches),
        cmocka_unit_test(creases_lie_across_the_compression),
        cmocka_unit_test(regions_follow_targets),
        cmocka_unit_test(a_painted_mask_gets_its_matrix),
        cmocka_unit_test(targets_that_compress_nothing_are_tied_to_no_region),
        cmocka_unit_test(eyes_teeth_and_toons_have_none),
        cmocka_unit_test(masks_end_at_their_edges),
        cmocka_unit_test(masks_are_kept_for_pixels),
        cmocka_unit_test(mirrored_coordinates_take_painted_files),
        cmocka_unit_test(rows_of_a_recipe_tie_expressions_to_regions),
        cmocka_unit_test(rows_of_wrinkles_that_are_wrong_are_refused),
        cmocka_unit_test(creases_follow_the_principal_axis),
        cmocka_unit_test(creases_of_a_human_head),
        cmocka_unit_test(faces_are_found_by_what_their_channels_move),
        cmocka_unit_test(folds_follow_the_face),
        cmocka_unit_test(expressions_fold_their_own_zones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
