/* What is between lips is lit by its own targets: teeth that open with the mouth are dark while it is shut, and teeth of
 * a mesh that has no such targets never are. */
#include "convert/model/mouth_shape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "noh/format.h"
#include "support/support.h"

#define COLUMNS 13u
#define ROWS 4u
#define PATCH (COLUMNS * ROWS)
#define HALF 0.03f /* of the mouth's width */
#define OPEN 0.02f /* of a jaw */

enum { SKIN, TEETH, MATERIALS };
enum { FACE, UPPER, LOWER, MESHES };

static void add_mesh(model_mesh *mesh, const char *name, uint32_t vertices, uint32_t material)
{
    mesh->name = model_string(name);
    mesh->vertex_count = vertices;
    mesh->position = test_zeros(3u * vertices * sizeof *mesh->position);
    mesh->indices = test_zeros(6u * vertices * sizeof *mesh->indices);
    mesh->submeshes = test_zeros(sizeof *mesh->submeshes);
    mesh->submesh_count = 1;
    mesh->submeshes[0].material = material;
    mesh->submeshes[0].vertex_count = vertices;
}

/* A patch of rows above or below y, in front of z. */
static void add_patch(model_mesh *mesh, uint32_t first, float y, int up, float half, float z)
{
    for (uint32_t v = first; v < first + PATCH; v++) {
        const uint32_t x = (v - first) % COLUMNS, row = (v - first) / COLUMNS;
        const uint32_t corners[6] = { v, v + 1u, v + COLUMNS, v + 1u, v + COLUMNS + 1u, v + COLUMNS };
        mesh->position[3u * v] = half * (2.0f * (float)x / (COLUMNS - 1u) - 1.0f);
        mesh->position[3u * v + 1u] = y + (up ? 0.005f : -0.005f) * (float)row;
        mesh->position[3u * v + 2u] = z - 0.01f * (float)(x % 2u);
        if (x + 1u == COLUMNS || row + 1u == ROWS) continue;
        memcpy(mesh->indices + mesh->index_count, corners, sizeof corners);
        mesh->index_count += 6u;
    }
    mesh->submeshes[0].index_count = mesh->index_count;
}

/* A target that moves the vertices from `first` on down, in the middle the most. */
static void add_target(model_mesh *mesh, const char *name, uint32_t first)
{
    model_target *t = mesh->targets = test_zeros(sizeof *t);
    mesh->target_count = 1;
    t->name = model_string(name);
    t->position = test_zeros(3u * mesh->vertex_count * sizeof *t->position);
    for (uint32_t v = first; v < mesh->vertex_count; v++) {
        const float aside = mesh->position[3u * v] / HALF;
        t->position[3u * v + 1u] = -OPEN * (1.0f - aside * aside);
    }
}

/* A face whose lips touch and that jawOpen parts, and teeth of two meshes, which have targets of these names; NULL:
 * none. */
static model *face_of(const char *upper, const char *lower)
{
    static const char *const names[MESHES] = { "face", "teeth.upper", "teeth.lower" };
    const char *const targets[MESHES] = { "jawOpen", upper, lower };
    model *m = model_new();
    m->meshes = test_zeros(MESHES * sizeof *m->meshes);
    m->mesh_count = MESHES;
    m->materials = test_zeros(MATERIALS * sizeof *m->materials);
    m->material_count = MATERIALS;
    for (uint32_t i = 0; i < MATERIALS; i++) {
        m->materials[i] = model_material_default();
        m->materials[i].name = model_string(i == SKIN ? "skin" : "teeth");
        m->materials[i].surface = i == SKIN ? NOH_SURFACE_SKIN : NOH_SURFACE_TEETH;
    }
    for (uint32_t i = 0; i < MESHES; i++) {
        model_mesh *mesh = &m->meshes[i];
        add_mesh(mesh, names[i], i == FACE ? 2u * PATCH : PATCH, i == FACE ? SKIN : TEETH);
        add_patch(mesh, 0, 0.0f, i != LOWER, i == FACE ? HALF : 0.7f * HALF, i == FACE ? 0.1f : 0.08f);
        if (i == FACE) add_patch(mesh, PATCH, 0.0f, 0, HALF, 0.1f);
        if (targets[i]) add_target(mesh, targets[i], i == FACE ? PATCH : 0);
    }
    return m;
}

static float gap_of(const model *m, uint32_t mesh)
{
    return m->materials[m->meshes[mesh].submeshes[0].material].surface_more[3];
}

static void teeth_without_targets_stay_light(void **state)
{
    static const struct {
        const char *upper, *lower;
        int shuts[MESHES];
    } cases[] = {
        { "jawOpen", "jawOpen", { 1, 1, 1 } },
        { NULL, "jawOpen", { 1, 0, 1 } },
        { "teethOpen", "jawOpen", { 1, 0, 1 } },
        { NULL, NULL, { 1, 0, 0 } },
    };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        model *m = face_of(cases[i].upper, cases[i].lower);
        const int apart = cases[i].shuts[UPPER] != cases[i].shuts[LOWER];
        assert_int_equal(mouth_shape_find(m), 0);
        assert_true(m->meshes[FACE].targets[0].lips > 0.2f); /* lips were found */
        for (uint32_t mesh = 0; mesh < MESHES; mesh++) {
            const float right = cases[i].shuts[mesh] ? 0.012f : 0.24f;
            if (fabsf(gap_of(m, mesh) - right) > 1e-6f)
                fail_msg("%s of case %zu: %g, not %g", m->meshes[mesh].name, i, (double)gap_of(m, mesh), (double)right);
        }
        assert_int_equal(m->material_count, MATERIALS + (uint32_t)apart); /* a copy where one is needed */
        for (uint32_t k = TEETH; k < m->material_count; k++) {
            assert_string_equal(m->materials[k].name, "teeth");
            assert_true(m->materials[k].surface_values[2] > 0.0f && m->materials[k].surface_more[0] == 1.0f);
        }
        model_free(m);
    }
}

/* A vertex of another part lies in the teeth's range, as in joined meshes. */
static void others_in_range_are_no_teeth(void **state)
{
    model *m = face_of(NULL, NULL), *joined = face_of(NULL, NULL);
    model_mesh *mesh = &joined->meshes[UPPER];
    float *position = test_zeros(3u * (mesh->vertex_count + 1u) * sizeof *position);
    (void)state;
    memcpy(position, mesh->position, 3u * mesh->vertex_count * sizeof *position);
    position[3u * mesh->vertex_count + 2u] = -3.0f;
    free(mesh->position);
    mesh->position = position;
    mesh->submeshes[0].vertex_count = ++mesh->vertex_count;
    assert_int_equal(mouth_shape_find(m) + mouth_shape_find(joined), 0);
    assert_memory_equal(m->materials[TEETH].surface_values, joined->materials[TEETH].surface_values,
                        sizeof m->materials[TEETH].surface_values);
    model_free(m);
    model_free(joined);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(teeth_without_targets_stay_light),
                                        cmocka_unit_test(others_in_range_are_no_teeth) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
