/* Eyes of one colour get an iris, which is then found; other eyes stay. Strips of lashes are hidden. */
#include "convert/model/eye_paint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "convert/model/surface_shape.h"
#include "noh/format.h"
#include "support/support.h"

#define RINGS 12u
#define SIDES 16u
#define BALL (RINGS * SIDES)
#define RADIUS 0.012f
#define PI 3.14159265358979

static model *model_of(const char *name, uint32_t surface, uint32_t vertices, uint32_t indices)
{
    model *m = model_new();
    model_mesh *mesh = m->meshes = test_zeros(sizeof *m->meshes);
    m->materials = test_zeros(sizeof *m->materials);
    m->materials[0] = model_material_default();
    m->materials[0].name = model_string(name);
    m->materials[0].surface = surface;
    m->material_count = m->mesh_count = 1;
    mesh->name = model_string(name);
    mesh->vertex_count = vertices;
    mesh->position = test_zeros(3u * vertices * sizeof *mesh->position);
    mesh->uv = test_zeros(2u * vertices * sizeof *mesh->uv);
    mesh->indices = test_zeros(indices * sizeof *mesh->indices);
    mesh->submeshes = test_zeros(sizeof *mesh->submeshes);
    mesh->submesh_count = 1;
    mesh->submeshes[0].vertex_count = vertices;
    return m;
}

/* Balls that look along +z: their first ring is at the front. apart: of the centres, 0: one ball */
static model *eyes_of(float apart)
{
    const uint32_t balls = apart > 0.0f ? 2u : 1u;
    model *m = model_of("Eyes", NOH_SURFACE_EYE, balls * BALL, balls * 6u * BALL);
    model_mesh *mesh = m->meshes;
    for (uint32_t v = 0; v < balls * BALL; v++) {
        const uint32_t ring = v % BALL / SIDES, side = v % SIDES, next = v - side + (side + 1u) % SIDES;
        const double down = PI * (ring + 0.1) / (RINGS - 0.8), about = 2.0 * PI * side / SIDES;
        const uint32_t corners[6] = { v, next, v + SIDES, next, next + SIDES, v + SIDES };
        mesh->position[3u * v] = RADIUS * (float)(sin(down) * cos(about)) + (v / BALL ? 0.5f : -0.5f) * apart;
        mesh->position[3u * v + 1u] = RADIUS * (float)(sin(down) * sin(about)) + 1.6f;
        mesh->position[3u * v + 2u] = RADIUS * (float)cos(down) + 0.1f;
        if (ring + 1u == RINGS) continue;
        memcpy(mesh->indices + mesh->index_count, corners, sizeof corners);
        mesh->index_count += 6u;
    }
    mesh->submeshes[0].index_count = mesh->index_count;
    return m;
}

static uint8_t green_at(const model *m, float u, float v)
{
    const model_texture *t = &m->textures[0];
    return t->rgba[4u * ((uint32_t)(v * (float)t->height) * t->width + (uint32_t)(u * (float)t->width)) + 1u];
}

static void blank_eyes_get_an_iris(void **state)
{
    model *m = eyes_of(0.062f);
    model_error error;
    (void)state;
    assert_int_equal(eye_paint(m), 0);
    assert_int_equal(m->texture_count, 1);
    assert_int_equal(m->warning_count, 1);
    assert_int_equal(m->materials[0].base_color_texture, 0);
    for (uint32_t v = 0; v < 2u * BALL; v++) {
        const float *uv = m->meshes[0].uv + 2u * v;
        const uint8_t green = green_at(m, uv[0] * 0.999f, uv[1] * 0.999f);
        const uint32_t ring = v % BALL / SIDES;
        assert_true(ring > 0 || green < 40);                                                            /* the pupil */
        assert_true(ring != 1 || green < 140);                                                          /* the iris */
        assert_true(ring < 3 || green > 200);                                                           /* the white */
        assert_true(ring == 0 || (uv[0] > 0.5f) == (v % SIDES < 4u || v % SIDES > 12u) || v % 4u == 0); /* x is right */
    }
    assert_int_equal(surface_shapes_find(m, NULL, &error), 0);
    assert_true(m->materials[0].surface_values[2] > 0.0f && fabsf(m->materials[0].surface_values[3] - 0.42f) < 0.03f);
    model_free(m);
}

static void other_eyes_stay(void **state)
{
    (void)state;
    for (int kind = 0; kind < 6; kind++) {
        model *m = eyes_of(kind == 0 ? 0.0f : 0.062f); /* one ball is no pair */
        model_material *eye = m->materials;
        if (kind == 1) eye->base_color[1] = eye->base_color[2] = 0.1f;
        if (kind == 2) eye->emissive[0] = 1.0f;
        if (kind == 3) eye->alpha = MODEL_ALPHA_BLEND;
        if (kind == 4) eye->surface = NOH_SURFACE_PLAIN;
        if (kind == 5) {
            m->meshes[0].color = test_zeros(8u * BALL * sizeof(float)); /* black */
        }
        assert_int_equal(eye_paint(m), 0);
        assert_int_equal(m->texture_count + m->warning_count, 0);
        assert_int_equal(eye->base_color_texture, MODEL_NONE);
        model_free(m);
    }
}

/* What is grey around eyes that were painted becomes skin, unless its name says another thing, or it has a colour. */
static void grey_faces_become_skin(void **state)
{
    static const struct {
        const char *name;
        float red;
        int has_texture, is_skin;
    } cases[] = { { "M_Face", 0.6f, 0, 1 },       { "M_BackHead", 0.6f, 0, 1 }, { "Kopf", 0.8f, 0, 1 },
                  { "M_Shirt", 0.6f, 0, 0 },      { "M_Face", 0.9f, 0, 0 },     { "M_Face", 0.6f, 1, 0 },
                  { "Headband hair", 0.6f, 0, 0 } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        model *m = eyes_of(0.062f);
        model_material *materials = test_zeros(2 * sizeof *materials), *face = &materials[1];
        materials[0] = m->materials[0];
        *face = model_material_default();
        face->name = model_string(cases[i].name);
        face->metallic = 0.0f;
        face->base_color[0] = face->base_color[1] = face->base_color[2] = cases[i].red == 0.8f ? 0.8f : 0.6f;
        face->base_color[0] = cases[i].red;
        free(m->materials);
        m->materials = materials;
        m->material_count = 2;
        if (cases[i].has_texture) {
            m->textures = test_zeros(sizeof *m->textures);
            m->texture_count = 1;
        }
        assert_int_equal(eye_paint(m), 0);
        assert_int_equal(face->surface, cases[i].is_skin ? NOH_SURFACE_SKIN : NOH_SURFACE_PLAIN);
        assert_int_equal(face->base_color[0] > 1.3f * face->base_color[1], cases[i].red == 0.9f || cases[i].is_skin);
        assert_int_equal(m->warning_count, 1 + cases[i].is_skin);
        model_free(m);
    }
}

/* A strip of 32 triangles is hidden; as 32 lashes it stays. */
static void slabs_of_lashes_are_hidden(void **state)
{
    (void)state;
    for (uint32_t apart = 0; apart < 2; apart++) {
        model *m = model_of("Std_Eyelash", NOH_SURFACE_PLAIN, 96, 96);
        for (uint32_t i = 0; i < 96; i++) m->meshes[0].indices[i] = apart ? i : i / 3u + i % 3u;
        m->meshes[0].submeshes[0].vertex_count = apart ? 96 : 34;
        m->meshes[0].submeshes[0].index_count = m->meshes[0].index_count = 96;
        assert_int_equal(lash_strips_hide(m), 0);
        assert_int_equal(m->materials[0].alpha, apart ? MODEL_ALPHA_OPAQUE : MODEL_ALPHA_BLEND);
        assert_true(m->materials[0].base_color[3] == (apart ? 1.0f : 0.0f));
        model_free(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blank_eyes_get_an_iris),
        cmocka_unit_test(other_eyes_stay),
        cmocka_unit_test(grey_faces_become_skin),
        cmocka_unit_test(slabs_of_lashes_are_hidden),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
