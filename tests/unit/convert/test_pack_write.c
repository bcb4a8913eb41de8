/* The pack writer: the same bytes every time, names and pictures cut to what the format holds,
 * and what it cannot hold refused with the limit in the message. */
#include "support/support.h"

#include <stdio.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "convert/pack/triangle_order.h"
#include "support/pack_walk.h"

static model *whole(void)
{
    const test_model_desc desc = { 2, 4, 3, TEST_TANGENTS | TEST_UVS | TEST_COLORS | TEST_SCENE, 81 };
    return test_model(&desc);
}

static void the_same_model_gives_the_same_bytes(void **state)
{
    size_t counts[2];
    uint8_t *packs[2];
    (void)state;
    for (int i = 0; i < 2; i++) {
        model *m = whole();
        packs[i] = test_pack_of(m, &counts[i], NULL);
        model_free(m);
    }
    assert_int_equal(counts[0], counts[1]);
    assert_memory_equal(packs[0], packs[1], counts[0]);
    free(packs[0]);
    free(packs[1]);
}

/* ---- limits: a count at the limit passes, one more is refused and both are reported ---- */

static void expect_limit(model *m, uint32_t *count, uint32_t limit, const char *word)
{
    uint32_t before = *count;
    model_error error;
    char number[16];
    *count = limit;
    assert_int_equal(pack_check_model(m, &error), 0);
    *count = limit + 1;
    assert_int_equal(pack_check_model(m, &error), 1);
    snprintf(number, sizeof number, "%u", (unsigned)limit);
    if (!strstr(error.what, number) || !strstr(error.what, word)) {
        fail_msg("'%s' names neither %s nor %s", error.what, word, number);
    }
    *count = before;
}

static void limits_are_told(void **state)
{
    model *m = whole();
    (void)state;
    expect_limit(m, &m->meshes[1].vertex_count, NOH_VERTICES_MAX, "vertices");
    expect_limit(m, &m->meshes[0].index_count, NOH_INDICES_MAX, "indices");
    expect_limit(m, &m->meshes[0].submesh_count, NOH_SUBMESHES_MAX, "primitives");
    expect_limit(m, &m->meshes[1].target_count, NOH_TARGETS_MAX, "targets");
    expect_limit(m, &m->material_count, NOH_MATERIALS_MAX, "materials");
    expect_limit(m, &m->node_count, NOH_NODES_MAX, "nodes");
    model_free(m);
}

/* ---- names ---- */

static void long_names_are_cut_between_characters(void **state)
{
    model *m = whole();
    size_t count;
    uint8_t *bytes;
    noh_pack pack;
    noh_mesh mesh;
    const char *name;
    char *long_name = test_zeros(400);
    (void)state;
    for (size_t i = 0; i < 199; i++) {
        memcpy(long_name + 2 * i, "\xc3\xa9", 3); /* two bytes each: 255 falls into one */
    }
    free(m->meshes[0].targets[2].name);
    m->meshes[0].targets[2].name = long_name;
    bytes = test_pack_of(m, &count, NULL);
    pack = test_open(bytes, count);
    mesh = test_mesh(&pack, 0);
    name = noh_pack_string(&pack, mesh.targets[2].name);
    assert_int_equal(strlen(name), NOH_NAME_BYTES_MAX - 2);
    assert_memory_equal(name, long_name, NOH_NAME_BYTES_MAX - 2);
    assert_int_equal(noh_mesh_find_target(&mesh, name), 2);
    pack_walk(&pack, 1);
    free(bytes);
    model_free(m);
}

/* ---- textures ---- */

static void large_pictures_are_halved_until_they_fit(void **state)
{
    const test_model_desc desc = { 1, 3, 1, TEST_SCENE, 82 };
    model *m = test_model(&desc);
    size_t count;
    uint8_t *bytes;
    noh_pack pack;
    noh_texture texture;
    (void)state;
    free(m->textures[0].rgba);
    m->textures[0].width = 4 * NOH_TEXTURE_SIZE_MAX;
    m->textures[0].height = 8;
    m->textures[0].rgba = test_zeros(4u * m->textures[0].width * m->textures[0].height);
    memset(m->textures[0].rgba, 100, 4u * m->textures[0].width * m->textures[0].height);
    bytes = test_pack_of(m, &count, NULL);
    pack = test_open(bytes, count);
    assert_int_equal(noh_pack_texture_at(&pack, 0, &texture, NULL), NOH_OK);
    assert_int_equal(texture.header->width, NOH_TEXTURE_SIZE_MAX);
    assert_int_equal(texture.header->height, 2);
    for (uint32_t i = 0; i < 8u * NOH_TEXTURE_SIZE_MAX; i++) {
        assert_int_equal(texture.pixels[i], 100); /* the mean of equal pixels */
    }
    free(bytes);
    model_free(m);
}

static void wrap_modes_and_filters_are_kept(void **state)
{
    static const uint32_t gltf[] = { 10497, 33071, 33648, 0 },
                          packed[] = { NOH_WRAP_REPEAT, NOH_WRAP_CLAMP, NOH_WRAP_MIRROR, NOH_WRAP_REPEAT };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(gltf); i++) {
        const test_model_desc desc = { 1, 3, 1, TEST_SCENE, 83 };
        model *m = test_model(&desc);
        size_t count;
        uint8_t *bytes;
        noh_pack pack;
        noh_texture texture;
        m->textures[0].wrap_s = gltf[i];
        m->textures[0].wrap_t = gltf[(i + 1) % 4];
        m->textures[0].mag_filter = i % 2 ? 9728 : 9729;
        bytes = test_pack_of(m, &count, NULL);
        pack = test_open(bytes, count);
        assert_int_equal(noh_pack_texture_at(&pack, 0, &texture, NULL), NOH_OK);
        assert_int_equal(texture.header->wrap_s, packed[i]);
        assert_int_equal(texture.header->wrap_t, packed[(i + 1) % 4]);
        assert_int_equal(texture.header->nearest, i % 2);
        free(bytes);
        model_free(m);
    }
}

static void the_scene_is_kept(void **state)
{
    model *m = whole();
    size_t count;
    uint8_t *bytes = test_pack_of(m, &count, NULL);
    noh_pack pack = test_open(bytes, count);
    (void)state;
    assert_int_equal(pack.node_count, m->node_count);
    for (uint32_t i = 0; i < m->node_count; i++) {
        assert_string_equal(noh_pack_string(&pack, pack.nodes[i].name), m->nodes[i].name);
        assert_int_equal(pack.nodes[i].parent, m->nodes[i].parent);
        assert_int_equal(pack.nodes[i].mesh, m->nodes[i].mesh);
        assert_true(pack.nodes[i].world[0] == (float)m->nodes[i].world[0]);
    }
    assert_true(pack.node_weights[pack.nodes[1].first_weight] == 0.5f);
    assert_int_equal(pack.nodes[2].first_weight, NOH_NONE);
    assert_int_equal(pack.materials[0].base_color_texture, 0);
    assert_int_equal(pack.materials[1].base_color_texture, NOH_NONE);
    assert_int_equal(pack.materials[1].flags, NOH_MATERIAL_BLEND);
    assert_string_equal(noh_pack_string(&pack, pack.materials[1].name), "glass");
    assert_int_equal(test_mesh(&pack, 1).submeshes[1].material, 1);
    free(bytes);
    model_free(m);
}

/* A target's largest displacement, which culling and LOD levels trust, is the largest of the model's deltas. */
static void targets_say_how_far_they_move(void **state)
{
    model *m = whole();
    size_t count;
    uint8_t *bytes = test_pack_of(m, &count, NULL);
    noh_pack pack = test_open(bytes, count);
    (void)state;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const noh_mesh mesh = test_mesh(&pack, i);
        for (uint32_t t = 0; t < m->meshes[i].target_count; t++) {
            double farthest = 0.0;
            for (size_t v = 0; v < m->meshes[i].vertex_count; v++) {
                const float *d = m->meshes[i].targets[t].position + 3 * v;
                farthest = fmax(farthest, sqrt((double)d[0] * (double)d[0] + (double)d[1] * (double)d[1] +
                                               (double)d[2] * (double)d[2]));
            }
            assert_true(farthest > 0.0);
            assert_true((double)mesh.targets[t].radius >= farthest &&
                        (double)mesh.targets[t].radius <= farthest * 1.000001);
        }
    }
    free(bytes);
    model_free(m);
}

/* Deltas that halves cannot add up have no bound, which is a number all the same. */
static void models_of_any_size_open(void **state)
{
    static const float sizes[] = { 1e-30f, 1e-4f, 1.0f, 1e5f, 1e6f, 1e11f };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(sizes); i++) {
        const test_model_desc desc = { .targets = 2, .flags = TEST_TANGENTS | TEST_UVS };
        model *m = test_model(&desc);
        model_mesh *mesh = m->meshes;
        uint8_t *bytes;
        size_t count;
        noh_pack pack;
        for (size_t k = 0; k < 3u * (size_t)mesh->vertex_count; k++) {
            mesh->position[k] *= sizes[i];
            for (uint32_t t = 0; t < mesh->target_count; t++) mesh->targets[t].position[k] *= sizes[i];
        }
        bytes = test_pack_of(m, &count, NULL);
        pack = test_open(bytes, count);
        assert_true((test_mesh(&pack, 0).header->f16_position_bound >= NOH_NUMBER_MAX) == (sizes[i] > 1e5f));
        free(bytes);
        model_free(m);
    }
}

/* Sorting takes the square of the triangles that meet in a vertex: thousands stay as they are. */
static void large_fans_are_not_sorted(void **state)
{
    enum { TRIANGLES = 5000 };
    static float positions[TRIANGLES + 1][3];
    static uint32_t indices[2][3 * TRIANGLES];
    (void)state;
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        const float angle = 6.2831853f * (float)i / (float)TRIANGLES;
        const uint32_t at = i * 7u % TRIANGLES, of[3] = { at, (at + 1u) % TRIANGLES, TRIANGLES };
        positions[i][0] = cosf(angle), positions[i][1] = sinf(angle);
        for (int n = 0; n < 2; n++) memcpy(&indices[n][3 * i], of, sizeof of);
    }
    assert_int_equal(triangle_order(indices[0], 3 * TRIANGLES, positions[0], TRIANGLES + 1), 0);
    assert_memory_equal(indices[0], indices[1], sizeof indices[0]);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(models_of_any_size_open),
    cmocka_unit_test(the_same_model_gives_the_same_bytes),
    cmocka_unit_test(limits_are_told),
    cmocka_unit_test(long_names_are_cut_between_characters),
    cmocka_unit_test(large_pictures_are_halved_until_they_fit),
    cmocka_unit_test(wrap_modes_and_filters_are_kept),
    cmocka_unit_test(the_scene_is_kept),
    cmocka_unit_test(targets_say_how_far_they_move),
    cmocka_unit_test(large_fans_are_not_sorted),
};

TEST_MAIN(tests, NULL, NULL)
