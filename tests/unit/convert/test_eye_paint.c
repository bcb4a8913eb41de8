/* Eyes of one colour get an iris, which is then found; other eyes stay, and lose the shadows that would
 * turn with them. Strips of lashes are hidden. */
#include "convert/model/eye_paint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/affine.h"
#include "convert/model/mesh_place.h"
#include "convert/model/model_build.h"
#include "convert/model/size_guess.h"
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
    mesh->normal = test_zeros(3u * vertices * sizeof *mesh->normal);
    mesh->uv = test_zeros(2u * vertices * sizeof *mesh->uv);
    mesh->indices = test_zeros((indices + 6u) * sizeof *mesh->indices); /* with room for two triangles */
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
    assert_int_equal(surface_shapes_find(m, 0, NULL, &error), 0);
    assert_true(m->materials[0].surface_values[2] > 0.0f && fabsf(m->materials[0].surface_values[3] - 0.42f) < 0.03f);
    model_free(m);
}

/* A mesh without texture coordinates gets them. */
static void eyes_without_coordinates_get_an_iris(void **state)
{
    model *m = eyes_of(0.062f);
    model_mesh *mesh = m->meshes;
    model_error error;
    (void)state;
    free(mesh->uv);
    mesh->uv = NULL;
    assert_int_equal(eye_paint(m), 0);
    assert_int_equal(m->texture_count, 1);
    assert_non_null(mesh->uv);
    for (uint32_t v = 0; v < 2u * BALL; v++) {
        const uint8_t green = green_at(m, mesh->uv[2u * v] * 0.999f, mesh->uv[2u * v + 1u] * 0.999f);
        assert_true(v % BALL / SIDES == 0 ? green < 40 : v % BALL / SIDES < 3 || green > 200);
    }
    assert_int_equal(surface_shapes_find(m, 0, NULL, &error), 0);
    assert_true(fabsf(m->materials[0].surface_values[3] - 0.42f) < 0.03f);
    model_free(m);
}

/* A half ball that is closed at its back by a fan is an eye, too. */
static void half_balls_get_an_iris(void **state)
{
    model *m = eyes_of(0.062f);
    (void)state;
    for (uint32_t v = 0; v < 2u * BALL; v++) {
        float *p = m->meshes[0].position + 3u * v;
        if (v % BALL / SIDES < 8u) continue;
        p[0] = v / BALL ? 0.031f : -0.031f;
        p[1] = 1.6f;
        p[2] = 0.1f;
    }
    assert_int_equal(eye_paint(m), 0);
    assert_int_equal(m->texture_count, 1);
    for (uint32_t v = 0; v < 2u * BALL; v++) {
        const float *uv = m->meshes[0].uv + 2u * v;
        if (v % BALL / SIDES == 0) assert_true(green_at(m, uv[0] * 0.999f, uv[1] * 0.999f) < 40);
    }
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

static void add_node(model *m, double x, int is_turned)
{
    static const double turned[12] = { 1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0 }; /* -90 degrees about x */
    model_node *nodes = test_zeros((m->node_count + 1u) * sizeof *nodes), *node = &nodes[m->node_count];
    if (m->node_count) memcpy(nodes, m->nodes, m->node_count * sizeof *nodes);
    free(m->nodes);
    m->nodes = nodes;
    m->node_count++;
    node->parent = node->skin = MODEL_NONE;
    node->world[0] = node->world[5] = node->world[10] = node->world[15] = 1.0;
    if (is_turned) memcpy(node->world, turned, sizeof turned);
    node->world[12] = x;
}

/* z is up in the mesh: a node turns it, 1: a joint, 2: which tilts the head by 17 degrees, too. */
static model *turned_eyes(int skinned)
{
    model *m = eyes_of(0.062f);
    model_mesh *mesh = m->meshes;
    for (float *p = mesh->position; p < mesh->position + 6u * BALL; p += 3) {
        const float y = p[1];
        p[1] = -p[2];
        p[2] = y;
    }
    add_node(m, 0.0, 1);
    if (skinned) {
        m->skins = test_zeros(sizeof *m->skins);
        m->skin_count = m->skins->joint_count = 1;
        m->skins->joints = test_zeros(sizeof *m->skins->joints);
        m->skins->inverse_bind = test_zeros(16 * sizeof(float));
        for (int i = 0; i < 16; i += 5) m->skins->inverse_bind[i] = 1.0f;
        mesh->joints = test_zeros(2u * BALL * MODEL_INFLUENCES_MAX * sizeof *mesh->joints);
        mesh->joint_weights = test_zeros(2u * BALL * MODEL_INFLUENCES_MAX * sizeof *mesh->joint_weights);
        add_node(m, 0.0, 0);
        for (int c = 0; skinned == 2 && c < 12; c += 4) {
            double *w = m->nodes[0].world + c, x = w[0];
            w[0] = 0.956 * x - 0.292 * w[1];
            w[1] = 0.292 * x + 0.956 * w[1];
        }
        m->nodes[1].skin = 0;
        m->nodes[0].mesh = MODEL_NONE;
        m->nodes[1].mesh = 0;
    }
    return m;
}

/* Where the joint puts a vertex. */
static void posed(const model *m, uint32_t vertex, double out[3])
{
    const float *p = m->meshes[0].position + 3u * vertex;
    const double at[3] = { (double)p[0], (double)p[1], (double)p[2] };
    double bind[16], both[16];
    affine_of_floats(m->skins->inverse_bind, bind);
    affine_multiply(m->nodes[0].world, bind, both);
    affine_point(both, at, out);
}

/* Skinned meshes have the axes of the world; nothing moves. A mesh that a node turns stays as it is. */
static void skinned_meshes_stand_upright(void **state)
{
    (void)state;
    for (int skinned = 0; skinned < 3; skinned++) {
        model *m = turned_eyes(skinned), *upright = turned_eyes(skinned);
        model_error error;
        assert_int_equal(meshes_upright(upright), 0);
        for (uint32_t v = 0; v < 2u * BALL; v++) {
            const float *was = m->meshes[0].position + 3u * v, *is = upright->meshes[0].position + 3u * v;
            double before[3], after[3];
            assert_true(is[0] == was[0]);
            assert_true(skinned ? is[1] == was[2] && is[2] == -was[1] : is[1] == was[1] && is[2] == was[2]);
            if (!skinned) continue;
            posed(m, v, before);
            posed(upright, v, after);
            for (int c = 0; c < 3; c++) assert_true(fabs(before[c] - after[c]) < 1e-9);
        }
        assert_int_equal(eye_paint(upright), 0);
        assert_int_equal(surface_shapes_find(upright, 0, NULL, &error), 0);
        const float *gaze = upright->materials[0].surface_values; /* the world's z */
        assert_true(skinned ? gaze[2] > 0.9f * RADIUS * 0.4f : gaze[1] < -0.9f * RADIUS * 0.4f);
        model_free(m);
        model_free(upright);
    }
}

/* After joints: the shader knows the world's stretch, not theirs. Files in centimetres have a joint of 0.01. */
static void joints_shrink_an_iris(void **state)
{
    (void)state;
    for (int skinned = 0; skinned < 2; skinned++) {
        double length[2];
        for (int is_shrunk = 0; is_shrunk < 2; is_shrunk++) {
            model *m = turned_eyes(skinned);
            const float *gaze = m->materials[0].surface_values;
            model_error error;
            for (int i = 0; i < 12; i++) m->nodes[0].world[i] *= is_shrunk ? 0.01 : 1.0;
            assert_int_equal(eye_paint(m), 0);
            assert_int_equal(surface_shapes_find(m, 0, NULL, &error), 0);
            length[is_shrunk] = fabs((double)gaze[1]);
            assert_true(length[is_shrunk] > 0.0);
            model_free(m);
        }
        assert_true(fabs(length[1] / length[0] - (skinned ? 0.01 : 1.0)) < 1e-5);
    }
}

/* The iris is where the world's +z is. */
static void turned_eyes_look_ahead(void **state)
{
    (void)state;
    for (int skinned = 0; skinned < 3; skinned++) {
        model *m = turned_eyes(skinned);
        const model_mesh *mesh = m->meshes;
        assert_int_equal(eye_paint(m), 0);
        assert_int_equal(m->texture_count, 1);
        for (uint32_t v = 0; v < 2u * BALL; v++) {
            const float *uv = mesh->uv + 2u * v;
            const uint8_t green = green_at(m, uv[0] * 0.999f, uv[1] * 0.999f);
            assert_true(v % BALL / SIDES == 0 ? green < 40 : v % BALL / SIDES < 3 || green > 200);
        }
        model_free(m);
    }
}

/* One ball that two nodes draw side by side is a pair; far apart, or when one is turned, it is none. */
static void nodes_pair_eyes(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        model *m = eyes_of(0.0f);
        add_node(m, kind == 1 ? -1.0 : -0.031, 0);
        add_node(m, 0.031, kind == 2);
        assert_int_equal(eye_paint(m), 0);
        assert_int_equal(m->texture_count, kind == 0);
        assert_int_equal(m->materials[0].base_color_texture, kind == 0 ? 0 : MODEL_NONE);
        model_free(m);
    }
}

/* A disc of another material before each pupil; kind 4: inside the ball, which covers it; 5: in its hole. */
static void eyes_with_an_iris_stay(void **state)
{
    (void)state;
    for (int kind = 0; kind < 6; kind++) {
        model *m = eyes_of(0.062f);
        model_mesh *mesh = m->meshes;
        model_material *materials = test_zeros(2 * sizeof *materials);
        model_submesh *parts = test_zeros(2 * sizeof *parts);
        float *position = test_zeros(3u * (2u * BALL + 6u) * sizeof *position);
        materials[0] = m->materials[0];
        materials[1] = model_material_default();
        materials[1].name = model_string("Iris");
        materials[1].surface = kind == 1 ? NOH_SURFACE_PLAIN : NOH_SURFACE_EYE;
        materials[1].alpha = kind == 2 ? MODEL_ALPHA_BLEND : MODEL_ALPHA_OPAQUE;
        parts[0] = mesh->submeshes[0];
        parts[1] = (model_submesh){ .first_index = mesh->index_count, .index_count = 6, .material = 1 };
        memcpy(position, mesh->position, 6u * BALL * sizeof *position);
        for (uint32_t v = 0; kind == 5 && v < 2u * BALL; v++) {
            position[3u * v + 2u] = fminf(position[3u * v + 2u], 0.1f + 0.9f * RADIUS);
        }
        for (uint32_t i = 0; i < 6; i++) {
            float *p = position + 6u * BALL + 3u * i;
            mesh->indices[mesh->index_count++] = 2u * BALL + i;
            p[0] = i < 3 ? -0.031f : 0.031f;
            p[1] = 1.6f;
            p[2] = 0.1f + (kind == 3 ? 1.5f : kind >= 4 ? 0.85f : 1.1f) * RADIUS;
        }
        free(mesh->position);
        free(mesh->uv);
        free(mesh->submeshes);
        free(m->materials);
        mesh->position = position;
        mesh->uv = test_zeros(2u * (2u * BALL + 6u) * sizeof *mesh->uv);
        mesh->vertex_count += 6u;
        mesh->submeshes = parts;
        m->materials = materials;
        mesh->submesh_count = m->material_count = 2;
        assert_int_equal(eye_paint(m), 0);
        assert_int_equal(m->texture_count, kind != 0 && kind != 5);
        model_free(m);
    }
}

/* A mesh of three vertices of one grey, and the second material. */
static void add_part(model *m, float grey)
{
    model_mesh *meshes = test_zeros(2 * sizeof *meshes), *mesh = &meshes[1];
    meshes[0] = m->meshes[0];
    free(m->meshes);
    m->meshes = meshes;
    m->mesh_count = 2;
    mesh->name = model_string("face");
    mesh->vertex_count = 3;
    mesh->position = test_zeros(9 * sizeof *mesh->position);
    mesh->normal = test_zeros(9 * sizeof *mesh->normal);
    mesh->color = test_zeros(12 * sizeof *mesh->color);
    for (int i = 0; i < 12; i++) mesh->color[i] = i % 3 ? 1.0f : grey;
    mesh->submeshes = test_zeros(sizeof *mesh->submeshes);
    mesh->submesh_count = 1;
    mesh->submeshes->material = 1;
    mesh->submeshes->index_count = mesh->index_count = 3;
    mesh->indices = test_zeros(3 * sizeof *mesh->indices);
    for (uint32_t i = 0; i < 3; i++) mesh->indices[i] = i;
}

/* What is grey around eyes that were painted becomes skin, unless its name says another thing, it has a colour, or its
 * surface is given. */
static void grey_faces_become_skin(void **state)
{
    static const struct {
        const char *name;
        float red;
        int has_texture, is_skin, is_given, has_colors;
    } cases[] = { { "M_Face", 0.6f, 0, 0, 1, 0 },       { "M_Face", 0.6f, 0, 0, 0, 1 },
                  { "M_Face", 0.6f, 0, 1, 0, 2 },       { "M_Face", 0.6f, 0, 1, 0, 0 },
                  { "M_BackHead", 0.6f, 0, 1, 0, 0 },   { "Kopf", 0.8f, 0, 1, 0, 0 },
                  { "M_Shirt", 0.6f, 0, 0, 0, 0 },      { "M_Face", 0.9f, 0, 0, 0, 0 },
                  { "Wolf3D_Skin", 0.6f, 0, 1, 0, 0 }, /* skin by its name, without its picture */
                  { "Zombie_Skin", 0.6f, 0, 0, 0, 0 },  { "Snake_Skin", 0.6f, 0, 0, 0, 0 },
                  { "Std_Skin_Arm", 0.6f, 0, 1, 0, 0 }, { "M_Face", 0.6f, 1, 0, 0, 0 },
                  { "Headband hair", 0.6f, 0, 0, 0, 0 } };
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
        if (strstr(cases[i].name, "Skin")) face->surface = NOH_SURFACE_SKIN;
        free(m->materials);
        m->materials = materials;
        m->material_count = 2;
        face->surface_given = (uint8_t)cases[i].is_given;
        if (cases[i].has_colors) add_part(m, cases[i].has_colors == 1 ? 0.5f : 1.0f);
        if (cases[i].has_texture) {
            m->textures = test_zeros(sizeof *m->textures);
            m->texture_count = 1;
        }
        assert_int_equal(eye_paint(m), 0);
        const int stays = !cases[i].is_skin && !strstr(cases[i].name, "Skin");
        assert_int_equal(face->surface, stays ? NOH_SURFACE_PLAIN : NOH_SURFACE_SKIN);
        assert_int_equal(face->base_color[0] > 1.3f * face->base_color[1], cases[i].red == 0.9f || cases[i].is_skin);
        assert_int_equal(m->warning_count, 1 + cases[i].is_skin);
        model_free(m);
    }
}

/* A face in one colour of people becomes skin, too, and keeps it; one in another colour stays. */
static void faces_of_flesh_become_skin(void **state)
{
    static const float colors[][3] = {
        { 0.8f, 0.6f, 0.5f }, { 0.15f, 0.07f, 0.04f }, { 0.8f, 0.4f, 0.05f }, { 0.3f, 0.6f, 0.4f }, { 0.9f, 0.6f, 0.6f }
    };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(colors); i++) {
        model *m = eyes_of(0.062f);
        model_material *materials = test_zeros(2 * sizeof *materials), *face = &materials[1];
        materials[0] = m->materials[0];
        *face = model_material_default();
        face->name = model_string("M_Face");
        face->metallic = 0.0f;
        memcpy(face->base_color, colors[i], sizeof colors[i]);
        free(m->materials);
        m->materials = materials;
        m->material_count = 2;
        assert_int_equal(eye_paint(m), 0);
        assert_int_equal(face->surface, i < 2 ? NOH_SURFACE_SKIN : NOH_SURFACE_PLAIN);
        assert_memory_equal(face->base_color, colors[i], sizeof colors[i]);
        model_free(m);
    }
}

/* The distance of eyes that two nodes put side by side counts, not their mesh's: the unit of a figure of 1.7 m fits. */
static void eyes_of_nodes_are_apart(void **state)
{
    model *m = eyes_of(0.0f);
    model_material *materials = test_zeros(2 * sizeof *materials);
    (void)state;
    materials[0] = m->materials[0];
    materials[1] = model_material_default();
    materials[1].name = model_string("body");
    free(m->materials);
    m->materials = materials;
    m->material_count = 2;
    add_part(m, 1.0f);
    m->meshes[1].position[1] = 1.7f;
    add_node(m, -0.031, 0);
    add_node(m, 0.031, 0);
    assert_int_equal(size_guess(m, NULL), 0);
    assert_int_equal(m->warning_count, 0);
    m->nodes[1].world[12] = 3.1; /* as far apart as a figure of centimetres has them */
    m->nodes[0].world[12] = -3.1;
    m->meshes[1].position[1] = 170.0f;
    assert_int_equal(size_guess(m, NULL), 0);
    assert_int_equal(m->warning_count, 1);
    model_free(m);
}

/* Strips of 32 triangles are hidden; 32 lashes stay, 20 of 32 triangles each, and what has a given surface. Vertices of
 * others, as joined meshes have, are no lashes. */
static void slabs_of_lashes_are_hidden(void **state)
{
    static const struct {
        uint32_t pieces, triangles, others;
        int is_given, is_hidden;
    } cases[] = { { 1, 32, 0, 0, 1 },  { 16, 32, 0, 0, 1 }, { 32, 1, 0, 0, 0 },
                  { 20, 32, 0, 0, 0 }, { 1, 32, 0, 1, 0 },  { 1, 32, 40, 0, 1 } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        const uint32_t of_piece = cases[i].triangles + 2u, vertices = cases[i].pieces * of_piece;
        const uint32_t triangles = cases[i].pieces * cases[i].triangles;
        model *m = model_of("Std_Eyelash", NOH_SURFACE_PLAIN, vertices + cases[i].others, 3u * triangles);
        for (uint32_t t = 0; t < 3u * triangles; t++) {
            const uint32_t triangle = t / 3u;
            m->meshes[0].indices[t] = triangle / cases[i].triangles * of_piece + triangle % cases[i].triangles + t % 3u;
        }
        m->meshes[0].submeshes[0].index_count = m->meshes[0].index_count = 3u * triangles;
        m->materials[0].surface_given = (uint8_t)cases[i].is_given;
        assert_int_equal(lash_strips_hide(m), 0);
        assert_int_equal(m->materials[0].alpha, cases[i].is_hidden ? MODEL_ALPHA_BLEND : MODEL_ALPHA_OPAQUE);
        assert_true(m->materials[0].base_color[3] == (cases[i].is_hidden ? 0.0f : 1.0f));
        model_free(m);
    }
}

/* Greys with shadows among them become white; colours, one grey, eyes without a texture, and what is given stay. */
static void shadows_on_eyes_are_left_out(void **state)
{
    static const struct {
        float front, back[3];
        int has_picture, is_given, is_cleared;
    } cases[] = { { 1.0f, { 0.25f, 0.25f, 0.25f }, 1, 0, 1 },
                  { 1.0f, { 0.25f, 0.25f, 0.5f }, 1, 0, 0 },
                  { 0.5f, { 0.5f, 0.5f, 0.5f }, 1, 0, 0 },
                  { 1.0f, { 0.25f, 0.25f, 0.25f }, 0, 0, 0 },
                  { 1.0f, { 0.25f, 0.25f, 0.25f }, 1, 1, 0 } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        model *m = eyes_of(0.06f);
        float *color = m->meshes[0].color = test_zeros(4u * 2u * BALL * sizeof *color);
        for (uint32_t v = 0; v < 2u * BALL; v++) {
            const int is_back = v % BALL / SIDES > RINGS / 2u;
            for (uint32_t c = 0; c < 3; c++) color[4u * v + c] = is_back ? cases[i].back[c] : cases[i].front;
            color[4u * v + 3u] = 0.5f;
        }
        m->materials[0].base_color_texture = cases[i].has_picture ? 0 : MODEL_NONE;
        m->materials[0].surface_given = (uint8_t)cases[i].is_given;
        assert_int_equal(eye_shade_clear(m), 0);
        assert_int_equal(m->warning_count, cases[i].is_cleared);
        for (uint32_t c = 0; c < 3; c++) {
            const float *last = color + 4u * (2u * BALL - 1u);
            assert_true(last[c] == (cases[i].is_cleared ? 1.0f : cases[i].back[c]));
            assert_true(color[c] == cases[i].front && last[3] == 0.5f);
        }
        m->materials[0].base_color_texture = MODEL_NONE;
        model_free(m);
    }
}

/* A triangle of another material joins the eyes' mesh, and is in the range of their vertices. */
static void join_body(model *m)
{
    model_mesh *mesh = m->meshes;
    const uint32_t first = mesh->vertex_count, index = mesh->index_count;
    model_material *materials = test_zeros(2 * sizeof *materials);
    model_submesh *parts = test_zeros(2 * sizeof *parts);
    float *position = test_zeros(3u * (first + 3u) * sizeof *position);
    memcpy(position, mesh->position, 3u * first * sizeof *position);
    for (uint32_t i = 0; i < 3; i++) {
        position[3u * (first + i) + 1u] = 0.1f * (float)i;
        position[3u * (first + i)] = i == 1 ? 0.3f : 0.2f;
        mesh->indices[mesh->index_count++] = first + i;
    }
    materials[0] = m->materials[0];
    materials[1] = model_material_default();
    materials[1].name = model_string("Body");
    parts[0] = mesh->submeshes[0];
    parts[1] = (model_submesh){ .first_index = index, .index_count = 3, .material = 1 };
    mesh->vertex_count += 3u;
    parts[0].vertex_count = parts[1].vertex_count = mesh->vertex_count;
    free(mesh->position);
    free(mesh->uv);
    free(mesh->submeshes);
    free(m->materials);
    mesh->position = position;
    mesh->uv = test_zeros(2u * mesh->vertex_count * sizeof *mesh->uv);
    mesh->color = test_zeros(4u * mesh->vertex_count * sizeof *mesh->color);
    for (uint32_t i = 0; i < 4u * mesh->vertex_count; i++) mesh->color[i] = 1.0f;
    mesh->submeshes = parts;
    m->materials = materials;
    mesh->submesh_count = m->material_count = 2;
}

/* Joined meshes: a body's colours neither shade eyes, nor hide their shade, nor are cleared; its texture coordinates stay;
 * what is coloured does not keep eyes blank. */
static void bodies_of_joined_meshes_stay(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) { /* a grey body; a blue one, shaded eyes; blank eyes */
        model *m = eyes_of(0.062f);
        float *color, *uv;
        join_body(m);
        color = m->meshes[0].color;
        uv = m->meshes[0].uv + 4u * BALL;
        for (uint32_t i = 0; i < 6; i++) uv[i] = 0.25f;
        for (uint32_t i = 0; i < 3; i++) {
            float *of = color + 4u * (2u * BALL + i);
            of[0] = of[1] = 0.25f * (float)(i + 1u);
            if (kind == 0) of[2] = of[0];
        }
        if (kind == 1) color[0] = color[1] = color[2] = 0.25f;
        m->materials[0].base_color_texture = kind == 2 ? MODEL_NONE : 0;
        assert_int_equal(kind == 2 ? eye_paint(m) : eye_shade_clear(m), 0);
        assert_int_equal(m->warning_count, kind > 0);
        assert_int_equal(m->materials[0].base_color_texture, 0);
        assert_true(color[0] == 1.0f && color[4u * 2u * BALL] == 0.25f && color[4u * 2u * BALL + 4u] == 0.5f);
        for (uint32_t i = 0; i < 6; i++) assert_true(uv[i] == 0.25f);
        m->materials[0].base_color_texture = MODEL_NONE;
        model_free(m);
    }
}

/* Eyes of a joined figure in centimetres are as far apart as without the body, which is far to one side. */
static void bodies_do_not_part_eyes(void **state)
{
    model *m = eyes_of(0.062f);
    (void)state;
    join_body(m);
    for (uint32_t i = 0; i < 3u * m->meshes[0].vertex_count; i++) m->meshes[0].position[i] *= 100.0f;
    for (uint32_t i = 0; i < 3; i++) m->meshes[0].position[3u * (2u * BALL + i)] += 20000.0f;
    assert_int_equal(size_guess(m, NULL), 0);
    assert_int_equal(m->warning_count, 1);
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blank_eyes_get_an_iris),       cmocka_unit_test(other_eyes_stay),
        cmocka_unit_test(turned_eyes_look_ahead),       cmocka_unit_test(nodes_pair_eyes),
        cmocka_unit_test(eyes_with_an_iris_stay),       cmocka_unit_test(grey_faces_become_skin),
        cmocka_unit_test(faces_of_flesh_become_skin),   cmocka_unit_test(slabs_of_lashes_are_hidden),
        cmocka_unit_test(half_balls_get_an_iris),       cmocka_unit_test(skinned_meshes_stand_upright),
        cmocka_unit_test(eyes_of_nodes_are_apart),      cmocka_unit_test(shadows_on_eyes_are_left_out),
        cmocka_unit_test(bodies_of_joined_meshes_stay), cmocka_unit_test(bodies_do_not_part_eyes),
        cmocka_unit_test(joints_shrink_an_iris),        cmocka_unit_test(eyes_without_coordinates_get_an_iris),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
