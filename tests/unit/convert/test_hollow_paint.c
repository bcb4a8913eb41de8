/* Hollows of skin that no texture shades become dark, unless a target opens them. */
#include "convert/light/hollow_paint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "noh/format.h"
#include "support/support.h"

#define SIDE 25u /* vertices */
#define COUNT (SIDE * SIDE)
#define MIDDLE (COUNT / 2u)

/* A plate of 24 units in the plane z = 0, with a pit in the middle: 6 units wide, 18 deep. A target raises its
 * floor. */
static model *nostril_of(int opens)
{
    model *m = model_new();
    model_mesh *mesh = m->meshes = test_zeros(sizeof *m->meshes);
    model_error error;
    m->materials = test_zeros(sizeof *m->materials);
    m->materials[0] = model_material_default();
    m->materials[0].name = model_string("Face");
    m->materials[0].surface = NOH_SURFACE_SKIN;
    m->material_count = m->mesh_count = 1;
    mesh->name = model_string("head");
    mesh->vertex_count = COUNT;
    mesh->position = test_zeros(3u * COUNT * sizeof *mesh->position);
    mesh->indices = test_zeros(6u * COUNT * sizeof *mesh->indices);
    mesh->submeshes = test_zeros(sizeof *mesh->submeshes);
    mesh->submesh_count = 1;
    mesh->targets = test_zeros(sizeof *mesh->targets);
    mesh->target_count = opens ? 1 : 0;
    if (opens) {
        mesh->targets[0].name = model_string("open");
        mesh->targets[0].position = test_zeros(3u * COUNT * sizeof *mesh->position);
    }
    for (uint32_t v = 0; v < COUNT; v++) {
        const float x = (float)(v % SIDE) - 12.0f, y = (float)(v / SIDE) - 12.0f;
        const int deep = fmaxf(fabsf(x), fabsf(y)) < 3.5f;
        mesh->position[3u * v] = x;
        mesh->position[3u * v + 1u] = y;
        mesh->position[3u * v + 2u] = deep ? -18.0f : 0.0f;
        if (opens && deep) mesh->targets[0].position[3u * v + 2u] = 18.0f;
        if (v % SIDE + 1u == SIDE || v / SIDE + 1u == SIDE) continue;
        const uint32_t corners[6] = { v, v + 1u, v + SIDE, v + 1u, v + SIDE + 1u, v + SIDE };
        memcpy(mesh->indices + mesh->index_count, corners, sizeof corners);
        mesh->index_count += 6u;
    }
    mesh->submeshes[0].vertex_count = COUNT;
    mesh->submeshes[0].index_count = mesh->index_count;
    assert_int_equal(model_complete(m, &error), 0);
    return m;
}

static void nostrils_are_dark(void **state)
{
    model *m = nostril_of(0);
    (void)state;
    assert_int_equal(hollow_paint(m), 0);
    assert_non_null(m->meshes[0].color);
    assert_true(m->meshes[0].color[4u * MIDDLE] < 0.3f);
    assert_float_equal(m->meshes[0].color[4u * MIDDLE + 3u], 1.0f, 0.0f);
    assert_float_equal(m->meshes[0].color[4u * (5u * SIDE + 5u)], 1.0f, 0.0f); /* outside the pit */
    assert_int_equal(m->warning_count, 1);
    model_free(m);
}

/* Joint 0 moves the plate, and as much of the floor's weight as joint 1 does not have. */
static model *moved_nostril(float floor)
{
    model *m = nostril_of(0);
    model_mesh *mesh = &m->meshes[0];
    mesh->joints = test_zeros(MODEL_INFLUENCES_MAX * COUNT * sizeof *mesh->joints);
    mesh->joint_weights = test_zeros(MODEL_INFLUENCES_MAX * COUNT * sizeof *mesh->joint_weights);
    mesh->joint_limit = 2;
    for (uint32_t v = 0; v < COUNT; v++) {
        const size_t first = (size_t)v * MODEL_INFLUENCES_MAX;
        const float second = mesh->position[3u * v + 2u] < -1.0f ? floor : 0.0f;
        mesh->joint_weights[first] = fmaxf(second, 1.0f - second);
        mesh->joint_weights[first + 1u] = fminf(second, 1.0f - second);
        mesh->joints[first + (second < 0.5f)] = 1;
    }
    return m;
}

static void a_joint_keeps_nostrils_dark(void **state)
{
    (void)state;
    model *m = moved_nostril(0.0f);
    assert_int_equal(hollow_paint(m), 0);
    assert_non_null(m->meshes[0].color);
    assert_true(m->meshes[0].color[4u * MIDDLE] < 0.3f);
    assert_float_equal(m->meshes[0].color[4u * (5u * SIDE + 5u)], 1.0f, 0.0f);
    assert_int_equal(m->warning_count, 1);
    model_free(m);
}

static void what_joints_may_open_stays(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        model *m = moved_nostril(kind ? 1.0f : 0.3f);
        assert_int_equal(hollow_paint(m), 0);
        assert_null(m->meshes[0].color);
        assert_int_equal(m->warning_count, 0);
        model_free(m);
    }
}

static void what_a_target_opens_stays(void **state)
{
    model *m = nostril_of(1);
    (void)state;
    assert_int_equal(hollow_paint(m), 0);
    assert_true(!m->meshes[0].color || m->meshes[0].color[4u * MIDDLE] >= 1.0f);
    model_free(m);
}

static void other_surfaces_stay(void **state)
{
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        model *m = nostril_of(0);
        if (kind == 0) m->materials[0].surface = NOH_SURFACE_PLAIN;
        if (kind == 1) m->materials[0].surface_given = 1;
        if (kind == 2) m->materials[0].base_color_texture = 0;
        if (kind == 3) m->meshes[0].color = test_zeros(4u * COUNT * sizeof(float)); /* black: an artist's */
        assert_int_equal(hollow_paint(m), 0);
        assert_int_equal(m->warning_count, 0);
        assert_true(kind == 3 || !m->meshes[0].color);
        model_free(m);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nostrils_are_dark),          cmocka_unit_test(a_joint_keeps_nostrils_dark),
        cmocka_unit_test(what_joints_may_open_stays), cmocka_unit_test(what_a_target_opens_stays),
        cmocka_unit_test(other_surfaces_stay),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
