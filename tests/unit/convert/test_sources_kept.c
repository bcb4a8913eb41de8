/* What a pack keeps of its source model, vertex by vertex, where no other test would notice a loss: how far each target
 * moves, and the texture coordinates of a mesh that takes another as a target. */
#include "support/support.h"

#include "convert/model/model_build.h"
#include "convert/model/two_stream.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- how far a target moves ---- */

static double length(const float v[3])
{
    return sqrt((double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] + (double)v[2] * (double)v[2]);
}

/* A target's radius in the pack is at least the source's longest delta, and at most a millionth more. */
static void the_radius_of_a_target_is_its_longest_delta(void **state)
{
    const test_model_desc desc = { 2, 9, 7, TEST_TANGENTS, 61 };
    model *m = test_model(&desc);
    size_t count;
    uint8_t *bytes = test_pack_of(m, &count, NULL);
    const noh_pack pack = test_open(bytes, count);
    (void)state;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const noh_mesh mesh = test_mesh(&pack, i);
        for (uint32_t t = 0; t < m->meshes[i].target_count; t++) {
            const model_target *source = &m->meshes[i].targets[t];
            const uint32_t found = noh_mesh_find_target(&mesh, source->name);
            const double kept = (double)mesh.targets[found].radius;
            double longest = 0.0;
            for (uint32_t v = 0; v < m->meshes[i].vertex_count; v++)
                longest = fmax(longest, length(source->position + 3 * (size_t)v));
            assert_true(longest > 0.0);
            assert_true(kept >= longest && kept <= longest * (1.0 + 1e-6));
        }
    }
    free(bytes);
    model_free(m);
}

/* ---- two meshes joined ---- */

/* Two grids of one shape; the second is moved, and its texture coordinates run the other way. */
static model *two_grids(void)
{
    const test_model_desc desc = { 1, 8, 1, TEST_UVS | TEST_TANGENTS, 62 };
    const test_model_desc second = { 1, 8, 0, TEST_UVS | TEST_TANGENTS, 62 };
    model *m = test_model(&desc), *other = test_model(&second);
    model_mesh *meshes = realloc(m->meshes, 2 * sizeof *meshes);
    assert_non_null(meshes);
    m->meshes = meshes;
    meshes[1] = other->meshes[0];
    other->mesh_count = 0;
    model_free(other);
    m->mesh_count = 2;
    free(meshes[1].name);
    meshes[1].name = model_string("moved");
    for (uint32_t v = 0; v < meshes[1].vertex_count; v++) {
        meshes[1].position[3 * v + 2] += 0.25f + 0.01f * (float)v;
        meshes[1].uv[2 * v] = 1.0f - meshes[1].uv[2 * v];
        meshes[1].uv[2 * v + 1] = 0.5f;
    }
    return m;
}

static void a_joined_mesh_keeps_its_texture_coordinates(void **state)
{
    model *m = two_grids();
    const uint32_t vertices = m->meshes[0].vertex_count;
    float *uv = test_zeros(8u * (size_t)vertices);
    uint32_t *order = NULL;
    model_error error;
    size_t count;
    uint8_t *bytes;
    (void)state;
    memcpy(uv, m->meshes[0].uv, 8u * (size_t)vertices);
    assert_int_equal(two_stream_join(m, "grid_0=moved", &error), 0);
    assert_int_equal(m->mesh_count, 1);
    bytes = test_pack_of(m, &count, &order);
    const noh_pack pack = test_open(bytes, count);
    const noh_mesh mesh = test_mesh(&pack, 0);
    assert_true(noh_mesh_find_target(&mesh, "moved") < mesh.header->target_count);
    for (uint32_t v = 0; v < vertices; v++) {
        noh_vertex got;
        noh_mesh_vertex(&mesh, v, &got);
        for (uint32_t c = 0; c < 2; c++) assert_true(fabsf(got.uv[c] - uv[2 * order[v] + c]) < 2e-5f);
    }
    free(order);
    free(uv);
    free(bytes);
    model_free(m);
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_radius_of_a_target_is_its_longest_delta),
        cmocka_unit_test(a_joined_mesh_keeps_its_texture_coordinates),
    };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
