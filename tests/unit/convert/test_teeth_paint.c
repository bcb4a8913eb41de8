/* Teeth of one colour get gums; what has them, or is no tooth, stays as it is. */
#include "convert/model/teeth_paint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "convert/model/surface_kind.h"
#include "noh/format.h"
#include "support/support.h"

#define COLUMNS 9u
#define ROWS 5u
#define STRIP (COLUMNS * ROWS)
#define HIGH 0.016f /* of each jaw, gum included */

/* Two strips on an arch of 60 mm, their edges apart by `gap`. The mouth's material is `color`. */
static model *mouth_of(const float color[3], float gap, float grey)
{
    model *m = model_new();
    model_mesh *mesh = m->meshes = test_zeros(sizeof *m->meshes);
    m->materials = test_zeros(sizeof *m->materials);
    m->materials[0] = model_material_default();
    m->materials[0].name = model_string("teeth");
    m->materials[0].surface = NOH_SURFACE_TEETH;
    for (int c = 0; c < 3; c++) m->materials[0].base_color[c] = color[c];
    m->material_count = m->mesh_count = 1;
    mesh->name = model_string("teeth");
    mesh->vertex_count = 2u * STRIP;
    mesh->position = test_zeros(3u * 2u * STRIP * sizeof *mesh->position);
    mesh->indices = test_zeros(12u * STRIP * sizeof *mesh->indices);
    mesh->submeshes = test_zeros(sizeof *mesh->submeshes);
    mesh->submesh_count = 1;
    for (uint32_t v = 0; v < 2u * STRIP; v++) {
        const uint32_t x = v % STRIP % COLUMNS, y = v % STRIP / COLUMNS, upper = v / STRIP;
        const float away = 0.5f * gap + HIGH * (float)y / (ROWS - 1u);
        mesh->position[3u * v] = -0.03f + 0.06f * (float)x / (COLUMNS - 1u);
        mesh->position[3u * v + 1u] = 1.5f + (upper ? away : -away);
        if (x + 1u == COLUMNS || y + 1u == ROWS) continue;
        const uint32_t corners[6] = { v, v + 1u, v + COLUMNS, v + 1u, v + COLUMNS + 1u, v + COLUMNS };
        memcpy(mesh->indices + mesh->index_count, corners, sizeof corners);
        mesh->index_count += 6u;
    }
    if (grey > 0.0f) {
        mesh->color = test_zeros(4u * 2u * STRIP * sizeof *mesh->color);
        for (uint32_t i = 0; i < 4u * 2u * STRIP; i++) mesh->color[i] = i % 4u == 3u ? 1.0f : grey;
    }
    mesh->submeshes[0].vertex_count = mesh->vertex_count;
    mesh->submeshes[0].index_count = mesh->index_count;
    return m;
}

/* Red over blue, of the row that lies this far from the edge. */
static float redness(const model *m, uint32_t upper, uint32_t row)
{
    const float *of = m->meshes[0].color + 4u * (upper * STRIP + row * COLUMNS + COLUMNS / 2u);
    return of[0] * m->materials[0].base_color[0] / (of[2] * m->materials[0].base_color[2]);
}

static void plain_teeth_get_gums(void **state)
{
    static const float greys[] = { 0.0f, 0.3f, 1.0f };
    static const float ivory[3] = { 0.76f, 0.72f, 0.60f };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(greys); i++) {
        model *m = mouth_of(ivory, 0.002f, greys[i]);
        assert_int_equal(teeth_paint(m), 0);
        assert_non_null(m->meshes[0].color);
        for (uint32_t upper = 0; upper < 2; upper++) {
            const float *edge = m->meshes[0].color + 4u * (upper * STRIP + COLUMNS / 2u);
            assert_true(redness(m, upper, 0) < 1.3f && redness(m, upper, ROWS - 1u) > 2.5f);
            for (uint32_t row = 1; row < ROWS; row++)
                assert_true(redness(m, upper, row) >= redness(m, upper, row - 1u));
            assert_true(edge[0] * ivory[0] > 0.5f && edge[0] * ivory[0] < 0.7f); /* neither grey nor white */
        }
        model_free(m);
    }
}

static void other_mouths_stay(void **state)
{
    static const float tongue[3] = { 0.45f, 0.09f, 0.09f }, ivory[3] = { 0.76f, 0.72f, 0.60f };
    float before[8u * STRIP];
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        model *m = mouth_of(kind == 0 ? tongue : ivory, kind == 1 ? -2.0f * HIGH : 0.002f, 0.9f); /* 1: one jaw */
        float *color = m->meshes[0].color;
        if (kind == 2) color[4u * STRIP - 2u] = 0.4f; /* gums of its own */
        if (kind == 3) m->materials[0].base_color_texture = 0;
        memcpy(before, color, sizeof before);
        assert_int_equal(teeth_paint(m), 0);
        assert_memory_equal(before, color, sizeof before);
        m->materials[0].base_color_texture = MODEL_NONE;
        model_free(m);
    }
}

/* Next to teeth of another material a pale gum becomes red; what is known as other, or has a colour, stays. */
static void pale_gums_become_red(void **state)
{
    static const float skin[3] = { 0.8f, 0.6f, 0.5f }, tongue[3] = { 0.8f, 0.4f, 0.4f };
    static const struct {
        const char *name;
        const float *color;
        int is_alone, is_given, has_picture, becomes_red;
        float grey; /* of a vertex colour; below 0: red */
    } cases[] = { { "M_GumsTongue", skin, 0, 0, 0, 1, 0 }, { "Mouth", skin, 0, 0, 0, 1, 0 },
                  { "Zunge", skin, 0, 0, 0, 1, 0.3f },     { "TeethAndGums", skin, 0, 0, 0, 0, 0 },
                  { "Mouth", skin, 1, 0, 0, 0, 0 },        { "Gums", skin, 0, 1, 0, 0, 0 },
                  { "Gums", skin, 0, 0, 1, 0, 0 },         { "Tongue", tongue, 0, 0, 0, 0, 0 },
                  { "Tongue", skin, 0, 0, 0, 0, -1.0f },   { "Mouth_Guard", skin, 0, 0, 0, 0, 0 },
                  { "shoe_tongue", skin, 0, 0, 0, 0, 0 } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        model *m = mouth_of(skin, 0.002f, fabsf(cases[i].grey));
        model_material *materials = test_zeros(2 * sizeof *materials), *gums = &materials[1];
        model_submesh *parts = test_zeros(2 * sizeof *parts);
        parts[0] = parts[1] = m->meshes[0].submeshes[0];
        parts[0].index_count = parts[1].first_index = parts[1].index_count /= 2u;
        parts[1].material = 1;
        free(m->meshes[0].submeshes);
        m->meshes[0].submeshes = parts;
        m->meshes[0].submesh_count = 2;
        if (cases[i].grey < 0.0f) m->meshes[0].color[8u * STRIP - 3u] = 0.4f; /* green, of the last vertex */
        materials[0] = m->materials[0];
        if (cases[i].is_alone) materials[0].surface = NOH_SURFACE_PLAIN;
        *gums = model_material_default();
        gums->name = model_string(cases[i].name);
        gums->surface = surface_kind_of_name(cases[i].name);
        assert_int_equal(gums->surface, NOH_SURFACE_TEETH);
        gums->surface_given = (uint8_t)cases[i].is_given;
        if (cases[i].has_picture) gums->base_color_texture = 0;
        memcpy(gums->base_color, cases[i].color, sizeof skin);
        free(m->materials);
        m->materials = materials;
        m->material_count = 2;
        assert_int_equal(teeth_paint(m), 0);
        assert_int_equal(m->warning_count, cases[i].becomes_red);
        assert_int_equal(gums->base_color[0] > 2.1f * gums->base_color[1], cases[i].becomes_red);
        gums->base_color_texture = MODEL_NONE;
        model_free(m);
    }
}

/* A gum and teeth of one jaw, as islands of their own, are not two jaws: of other heights, or one inside the other. */
static void one_jaw_stays(void **state)
{
    static const float ivory[3] = { 0.76f, 0.72f, 0.60f };
    static const float rows[3][4] = { { 0.0f, 0.010f, 0.005f, 0.023f }, /* teeth; gum: from, to */
                                      { 0.0f, 0.010f, 0.008f, 0.020f },
                                      { 0.0f, 0.010f, 0.010f, 0.030f } }; /* they only touch */
    (void)state;
    for (uint32_t kind = 0; kind < 8; kind++) {
        model *m = mouth_of(ivory, 0.002f, 0.9f);
        model_mesh *mesh = &m->meshes[0];
        float before[8u * STRIP];
        for (uint32_t v = 0; v < 2u * STRIP; v++) {
            const float share = (float)(v % STRIP / COLUMNS) / (ROWS - 1u),
                        *way = rows[kind % 4u % 3u] + 2u * (v / STRIP);
            if (kind % 4u == 3u) {
                mesh->position[3u * v] *= v / STRIP ? 1.0f : 0.5f; /* a few teeth */
            } else {
                mesh->position[3u * v + 1u] = way[0] + share * (way[1] - way[0]);
            }
            if (kind >= 4u) mesh->position[3u * v + 1u] *= -1.0f; /* the lower jaw */
        }
        memcpy(before, mesh->color, sizeof before);
        assert_int_equal(teeth_paint(m), 0);
        assert_memory_equal(before, mesh->color, sizeof before);
        model_free(m);
    }
}

/* Two jaws of a joined mesh whose range has vertices of a gum: no triangle of the teeth uses them. */
static void parts_of_joined_meshes_stay(void **state)
{
    static const float ivory[3] = { 0.76f, 0.72f, 0.60f };
    model *m = mouth_of(ivory, 0.002f, 0.9f);
    model_mesh *mesh = &m->meshes[0];
    float *position = test_zeros(3u * (2u * STRIP + 1u) * sizeof *position);
    float *color = test_zeros(4u * (2u * STRIP + 1u) * sizeof *color), *last = color + 8u * STRIP;
    (void)state;
    memcpy(position, mesh->position, 6u * STRIP * sizeof *position);
    memcpy(color, mesh->color, 8u * STRIP * sizeof *color);
    last[0] = 1.0f;
    free(mesh->position);
    free(mesh->color);
    mesh->position = position;
    mesh->color = color;
    mesh->submeshes[0].vertex_count = ++mesh->vertex_count;
    assert_int_equal(teeth_paint(m), 0);
    assert_true(redness(m, 0, ROWS - 1u) > 2.5f && redness(m, 1, ROWS - 1u) > 2.5f);
    assert_true(last[0] == 1.0f && last[1] == 0.0f && last[2] == 0.0f);
    model_free(m);
}

/* Jaws that overlap by a third of their height are two where a target opens them, which leaves a gum at its teeth. */
static void a_deep_bite_is_painted(void **state)
{
    static const float ivory[3] = { 0.76f, 0.72f, 0.60f };
    (void)state;
    for (int opens = 0; opens < 2; opens++) {
        model *m = mouth_of(ivory, -0.33f * HIGH, 0.9f);
        model_mesh *mesh = &m->meshes[0];
        float before[8u * STRIP];
        mesh->targets = test_zeros(sizeof *mesh->targets);
        mesh->target_count = 1;
        mesh->targets->name = model_string("jawOpen");
        mesh->targets->position = test_zeros(6u * STRIP * sizeof(float));
        for (uint32_t v = 0; v < 2u * STRIP; v++) {
            mesh->targets->position[3u * v + 1u] = opens && v / STRIP ? 0.0f : -0.02f;
        }
        memcpy(before, mesh->color, sizeof before);
        assert_int_equal(teeth_paint(m), 0);
        assert_int_equal(memcmp(before, mesh->color, sizeof before) != 0, opens);
        if (opens) assert_true(redness(m, 0, ROWS - 1u) > 2.5f && redness(m, 1, ROWS - 1u) > 2.5f);
        model_free(m);
    }
}

/* An overbite stays a pair of jaws. */
static void an_overbite_is_painted(void **state)
{
    static const float ivory[3] = { 0.76f, 0.72f, 0.60f };
    model *m = mouth_of(ivory, -0.002f, 0.9f);
    (void)state;
    assert_int_equal(teeth_paint(m), 0);
    assert_true(redness(m, 0, ROWS - 1u) > 2.5f && redness(m, 1, ROWS - 1u) > 2.5f);
    model_free(m);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plain_teeth_get_gums),        cmocka_unit_test(other_mouths_stay),
        cmocka_unit_test(parts_of_joined_meshes_stay), cmocka_unit_test(one_jaw_stays),
        cmocka_unit_test(an_overbite_is_painted),      cmocka_unit_test(a_deep_bite_is_painted),
        cmocka_unit_test(pale_gums_become_red),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
