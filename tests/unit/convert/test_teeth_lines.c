/* Bands of teeth get lines between them; what is divided, or may have a look of its own, stays. */
#include "convert/model/teeth_lines.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "convert/model/teeth_paint.h"
#include "noh/format.h"
#include "support/support.h"

#define COLUMNS_MAX 33u
#define ROWS 4u
#define HIGH 0.012f

typedef enum { BANDS, BACKWARDS, ASIDE, DIVIDED, PLAIN_SKIN, GIVEN, SHARED, TARGETS, ISLANDS, MAPPED, KINDS } kind;

static void add_column(model_mesh *mesh, uint32_t first, uint32_t columns, uint32_t x, int is_apart)
{
    for (uint32_t y = 0; y + 1u < ROWS && x + 1u < columns; y++) {
        const uint32_t v = first + y * columns + x;
        const uint32_t corners[6] = { v, v + 1u, v + columns, v + 1u, v + columns + 1u, v + columns };
        if (is_apart && x == columns / 2u) continue;
        memcpy(mesh->indices + mesh->index_count, corners, sizeof corners);
        mesh->index_count += 6u;
    }
}

/* Two strips on an arch of 60 mm. */
static model_mesh *add_jaws(model *m, kind of)
{
    const uint32_t columns = of == DIVIDED ? COLUMNS_MAX : 9u, strip = columns * ROWS;
    model_mesh *mesh = m->meshes = test_zeros(sizeof *m->meshes);
    m->mesh_count = 1;
    mesh->name = model_string("head");
    mesh->vertex_count = 2u * strip;
    mesh->position = test_zeros(6u * strip * sizeof *mesh->position);
    mesh->indices = test_zeros(12u * strip * sizeof *mesh->indices);
    for (uint32_t v = 0; v < 2u * strip; v++) {
        const float turn = 3.14159265f * (float)(v % columns) / (float)(columns - 1u);
        const float away = 0.001f + HIGH * (float)(v % strip / columns) / (ROWS - 1u);
        mesh->position[3u * v] = (of == ASIDE ? 0.5f : 0.0f) - 0.03f * cosf(turn);
        mesh->position[3u * v + 1u] = 1.5f + (v / strip ? away : -away);
        mesh->position[3u * v + 2u] = (of == BACKWARDS ? -0.045f : 0.045f) * sinf(turn);
    }
    for (uint32_t upper = 0; upper < 2; upper++) {
        for (uint32_t x = 0; x < columns; x++) add_column(mesh, upper * strip, columns, x, of == ISLANDS && upper);
    }
    mesh->submeshes = test_zeros(2 * sizeof *mesh->submeshes);
    mesh->submesh_count = of == SHARED ? 2 : 1;
    mesh->submeshes[0].index_count = mesh->index_count;
    mesh->submeshes[0].vertex_count = mesh->submeshes[1].vertex_count = mesh->vertex_count;
    return mesh;
}

static model *head_of(kind of)
{
    model *m = model_new();
    model_mesh *mesh = add_jaws(m, of);
    m->textures = test_zeros(sizeof *m->textures);
    m->textures[0].name = model_string("skin_normal");
    m->texture_count = 1;
    m->materials = test_zeros(2 * sizeof *m->materials);
    m->materials[0] = m->materials[1] = model_material_default();
    m->materials[0].name = model_string("teeth");
    m->materials[0].surface = NOH_SURFACE_TEETH;
    m->materials[0].surface_given = of == GIVEN;
    m->materials[1].name = model_string("skin");
    m->materials[1].surface = NOH_SURFACE_SKIN;
    m->materials[1].normal_texture = of == PLAIN_SKIN ? MODEL_NONE : 0;
    m->material_count = 2;
    if (of == MAPPED) m->materials[0].normal_texture = 0;
    if (of == TARGETS) {
        mesh->targets = test_zeros(sizeof *mesh->targets);
        mesh->targets[0].uv = test_zeros(2u * mesh->vertex_count * sizeof(float));
        mesh->target_count = 1;
    }
    return m;
}

/* Of a texel of a row of the texture. */
static uint8_t red_at(const model *m, uint32_t column, uint32_t row)
{
    const model_texture *t = &m->textures[m->materials[0].base_color_texture];
    return t->rgba[4u * (row * t->width + column)];
}

static void bands_get_lines(void **state)
{
    (void)state;
    for (kind of = BANDS; of <= ASIDE; of++) {
        model *m = head_of(of);
        assert_int_equal(teeth_paint(m), 0);
        assert_int_equal(m->materials[0].base_color_texture, 1);
        assert_int_equal(m->texture_count, 2);
        assert_int_equal(m->warning_count, 1);
        const float *uv = m->meshes[0].uv;
        assert_non_null(uv);
        for (uint32_t x = 0; x < 9u;
             x++) { /* along the arch, and the same on both jaws, which have rows of their own */
            const float *upper = uv + 2u * (9u * ROWS + x);
            assert_true(uv[2u * x] >= 0.0f && uv[2u * x] <= 1.0f && (!x || uv[2u * x] > uv[2u * x - 2u] + 0.05f));
            assert_float_equal(uv[2u * x] + uv[2u * (8u - x)], 1.0f, 1e-4f);
            assert_float_equal(upper[0], uv[2u * x], 1e-6f);
            assert_true(uv[2u * x + 1u] > 0.5f && upper[1] < 0.5f);
        }
        const uint32_t width = m->textures[1].width;
        assert_true(red_at(m, width / 2u, 48) + 40 < red_at(m, width / 2u + 12u, 48)); /* between the incisors */
        assert_true(red_at(m, width / 2u + 12u, 48) > 230);
        model_free(m);
    }
}

static void other_teeth_stay(void **state)
{
    (void)state;
    for (kind of = DIVIDED; of < KINDS; of++) {
        model *m = head_of(of);
        assert_int_equal(teeth_paint(m), 0);
        if (m->materials[0].base_color_texture != MODEL_NONE) fail_msg("kind %d got lines", (int)of);
        assert_int_equal(m->texture_count, 1);
        assert_null(m->meshes[0].uv);
        assert_int_equal(m->warning_count, 0);
        model_free(m);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(bands_get_lines), cmocka_unit_test(other_teeth_stay) };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
