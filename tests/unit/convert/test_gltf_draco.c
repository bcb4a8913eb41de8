/* Tests of tools/convert/gltf/gltf_draco.cpp: a compressed grid against the one that was encoded; broken data has a
 * message and no crash. Built without Draco, such files are refused by name. */
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model.h"

#define SIDE 4u
#define VERTICES (SIDE * SIDE)
#define INDICES ((SIDE - 1u) * (SIDE - 1u) * 6u)

/* 4 x 4 vertices at (x, y, x y / 4) with normals along z, uv in thirds and their number as a joint, by Draco 1.5.5's
 * sequential encoder: 14, 10 and 12 bits. */
/* clang-format off */
static const uint8_t compressed[355] = {
    68, 82, 65, 67, 79, 2, 2, 1, 0, 0, 0, 18, 16, 1, 0, 1, 4, 1, 5, 4, 1, 2, 5, 2, 6, 5, 2, 3, 6, 3, 7, 6, 4, 5, 8, 5,
    9, 8, 5, 6, 9, 6, 10, 9, 6, 7, 10, 7, 11, 10, 8, 9, 12, 9, 13, 12, 9, 10, 13, 10, 14, 13, 10, 11, 14, 11, 15, 14,
    1, 4, 0, 9, 3, 0, 0, 1, 9, 3, 0, 1, 3, 9, 2, 0, 2, 4, 2, 4, 0, 3, 2, 3, 2, 1, 0, 1, 1, 0, 15, 3, 1, 4, 47, 1, 60,
    3, 0, 32, 139, 80, 85, 1, 0, 0, 64, 85, 5, 0, 0, 0, 85, 21, 0, 0, 0, 4, 0, 85, 21, 0, 80, 85, 1, 0, 85, 69, 85, 5,
    0, 88, 21, 85, 21, 0, 80, 85, 4, 0, 85, 245, 255, 83, 85, 1, 0, 171, 74, 85, 5, 0, 168, 42, 85, 21, 0, 176, 170,
    4, 0, 85, 245, 255, 87, 85, 1, 0, 0, 80, 85, 5, 0, 0, 64, 85, 21, 0, 240, 255, 0, 0, 0, 0, 0, 255, 63, 0, 0, 0, 3,
    1, 0, 10, 3, 1, 60, 27, 1, 4, 3, 0, 159, 137, 0, 254, 3, 0, 0, 0, 255, 3, 0, 0, 255, 1, 0, 0, 0, 1, 1, 0, 13, 3,
    1, 4, 39, 1, 60, 3, 0, 32, 139, 168, 42, 0, 168, 42, 0, 168, 42, 0, 8, 128, 170, 170, 42, 0, 168, 42, 0, 168, 42,
    0, 8, 128, 170, 170, 42, 0, 168, 42, 0, 168, 42, 0, 8, 128, 170, 170, 42, 0, 168, 42, 0, 168, 42, 0, 0, 0, 0, 0,
    0, 255, 15, 0, 0, 0, 1, 1, 1, 1, 3, 1, 49, 3, 1, 15, 9, 64, 48, 8, 231, 177, 150, 1, 249, 128, 0, 0, 0, 0, 15, 0,
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 64, 64, 14, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 128, 63, 12,
};
/* clang-format on */

/* What is wrong with a file; zeros: nothing. */
typedef struct lie {
    size_t flipped, bytes; /* the index of a changed byte; the length of the file, 0: all of it */
    int vertices, normal_id, view, required;
} lie;

static const char *write_grid(const lie *l)
{
    static char json[4096];
    uint8_t data[sizeof compressed];
    const size_t bytes = l->bytes ? l->bytes : sizeof data;
    memcpy(data, compressed, sizeof data);
    if (l->flipped) data[l->flipped] ^= 0x55;
    (void)snprintf(
        json, sizeof json,
        "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_draco_mesh_compression\"],%s"
        "\"buffers\":[{\"uri\":\"grid.bin\",\"byteLength\":%zu}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu}],\"accessors\":["
        "{\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[3,3,3]},"
        "{\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\"},{\"componentType\":5126,\"count\":%d,\"type\":\"VEC2\"},"
        "{\"componentType\":5123,\"count\":%u,\"type\":\"SCALAR\"}],"
        "\"meshes\":[{\"name\":\"grid\",\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},"
        "\"indices\":3,\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":%d,"
        "\"attributes\":{\"POSITION\":0,\"NORMAL\":%d,\"TEXCOORD_0\":2}}}}]}],"
        "\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}],\"scene\":0}",
        l->required ? "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]," : "", bytes, bytes, l->vertices,
        l->vertices, l->vertices, INDICES, l->view, l->normal_id);
    test_write_file(test_path("grid.bin"), data, bytes);
    test_write_file(test_path("grid.gltf"), json, strlen(json));
    test_keep_glb_seed(json, data, bytes);
    return test_path("grid.gltf");
}

static const lie nothing = { 0, 0, VERTICES, 1, 0, 1 };
static model_error said;

/* Then files are refused, whether they say that they need the extension or not. */
static int is_without_draco(void)
{
    lie optional = nothing;
    model *m = NULL;
    optional.required = 0;
    if (!model_read_gltf(write_grid(&nothing), &m, &said)) {
        model_free(m);
        return 0;
    }
    if (!strstr(said.what, "libdraco-dev")) fail_msg("%s (%s)", said.what, said.where);
    assert_int_equal(model_read_gltf(write_grid(&optional), &m, &said), 1);
    assert_non_null(strstr(said.what, "libdraco-dev"));
    return 1;
}

static void a_grid_is_the_one_that_was_encoded(void **state)
{
    model *m = NULL;
    (void)state;
    if (is_without_draco()) skip();
    assert_int_equal(model_read_gltf(write_grid(&nothing), &m, &said), 0);
    assert_int_equal(m->mesh_count, 1);
    const model_mesh *mesh = &m->meshes[0];
    assert_int_equal(mesh->vertex_count, VERTICES);
    assert_int_equal(mesh->index_count, INDICES);
    for (uint32_t i = 0; i < VERTICES; i++) {
        const float x = (float)(i % SIDE), y = (float)(i / SIDE), want[3] = { x, y, 0.25f * x * y };
        for (int c = 0; c < 3; c++) {
            assert_true(fabsf(mesh->position[3 * i + (uint32_t)c] - want[c]) < 3e-4f);
            assert_true(fabsf(mesh->normal[3 * i + (uint32_t)c] - (c == 2 ? 1.0f : 0.0f)) < 5e-3f);
        }
        assert_true(fabsf(mesh->uv[2 * i] - x / 3.0f) < 5e-4f);
        assert_true(fabsf(mesh->uv[2 * i + 1] - y / 3.0f) < 5e-4f);
    }
    for (uint32_t t = 0; t < INDICES; t += 3) {
        const uint32_t quad = t / 6u, corner = quad / (SIDE - 1u) * SIDE + quad % (SIDE - 1u);
        const uint32_t want[2][3] = { { corner, corner + 1u, corner + SIDE },
                                      { corner + 1u, corner + SIDE + 1u, corner + SIDE } };
        assert_memory_equal(mesh->indices + t, want[t / 3u % 2u], sizeof want[0]);
    }
    model_free(m);
}

static void refused(lie l, const char *words)
{
    model *m = NULL;
    if (!model_read_gltf(write_grid(&l), &m, &said)) fail_msg("it is read; wanted: %s", words);
    if (!strstr(said.what, words)) fail_msg("'%s' (%s) does not say '%s'", said.what, said.where, words);
    assert_non_null(strstr(said.where, "mesh 'grid' primitive 0"));
}

static void what_does_not_fit_is_named(void **state)
{
    lie l = nothing;
    (void)state;
    if (is_without_draco()) skip();
    l.vertices = VERTICES + 1;
    refused(l, "has 17 elements, but Draco decodes to 16");
    l = nothing;
    l.normal_id = 9;
    refused(l, "no such attribute");
    l.normal_id = 2;
    refused(l, "another number of components");
    l = nothing;
    l.view = 7;
    refused(l, "buffer view 7 does not exist");
    l = nothing;
    l.bytes = 100;
    refused(l, "damaged");
    l = nothing;
    l.flipped = 2;
    refused(l, "Draco data");
}

/* Every truncation is refused, and no byte that is another does harm. */
static void broken_data_does_no_harm(void **state)
{
    (void)state;
    if (is_without_draco()) skip();
    for (size_t i = 1; i < sizeof compressed; i++) {
        lie cut = nothing, other = nothing;
        model *m = NULL;
        cut.bytes = i;
        other.flipped = i;
        if (!model_read_gltf(write_grid(&cut), &m, &said)) fail_msg("%zu of %zu bytes are read", i, sizeof compressed);
        if (model_read_gltf(write_grid(&other), &m, &said)) {
            assert_true(said.what[0]);
        } else {
            model_free(m);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(a_grid_is_the_one_that_was_encoded),
                                        cmocka_unit_test(what_does_not_fit_is_named),
                                        cmocka_unit_test(broken_data_does_no_harm) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
