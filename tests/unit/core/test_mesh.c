/* Meshes read from a pack: how much compact attributes may lose, and what they must keep. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "noh/low_core.h"

#define SIDE 40u

static model *source;
static uint8_t *bytes;
static uint32_t *order; /* pack vertex -> source vertex */
static noh_pack pack;
static noh_mesh mesh;

static int set_up(void **state)
{
    const test_model_desc desc = { 1, SIDE, 3, TEST_TANGENTS | TEST_UVS | TEST_COLORS, 9 };
    test_random r = test_random_from(9);
    size_t count;
    (void)state;
    source = test_model(&desc);
    for (uint32_t v = 0; v < SIDE * SIDE; v++) { /* all directions, not only up */
        float *n = source->meshes[0].normal + 3 * v, *t = source->meshes[0].tangent + 4 * v;
        float z = test_random_float(&r, -1.0f, 1.0f), a = test_random_float(&r, -3.15f, 3.15f),
              ring = sqrtf(1.0f - z * z);
        n[0] = ring * cosf(a);
        n[1] = ring * sinf(a);
        n[2] = z;
        t[0] = -sinf(a);
        t[1] = cosf(a);
        t[2] = 0.0f;
        if (v < 6) { /* the axes: corners and folds of the octahedron */
            memset(n, 0, 12);
            n[v / 2] = v % 2 ? -1.0f : 1.0f;
        }
    }
    bytes = test_pack_of(source, &count, &order);
    pack = test_open(bytes, count);
    mesh = test_mesh(&pack, 0);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    model_free(source);
    free(bytes);
    free(order);
    return 0;
}

static noh_vertex decoded(uint32_t v)
{
    noh_vertex vertex;
    noh_mesh_vertex(&mesh, v, &vertex);
    return vertex;
}

static void every_vertex_is_there_once(void **state)
{
    uint8_t *seen = test_zeros(SIDE * SIDE);
    (void)state;
    assert_int_equal(mesh.header->vertex_count, SIDE * SIDE);
    for (uint32_t v = 0; v < SIDE * SIDE; v++) {
        assert_true(order[v] < SIDE * SIDE);
        assert_int_equal(seen[order[v]], 0);
        seen[order[v]] = 1;
    }
    free(seen);
}

static void positions_are_exact(void **state)
{
    (void)state;
    for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
        noh_vertex vertex = decoded(v);
        test_same_floats(vertex.position, source->meshes[0].position + 3 * order[v], 3, "position");
    }
}

static double angle(const float a[3], const float b[3])
{
    double cross[3], dot = 0.0, sine = 0.0;
    for (int i = 0; i < 3; i++) {
        cross[i] = (double)a[(i + 1) % 3] * (double)b[(i + 2) % 3] - (double)a[(i + 2) % 3] * (double)b[(i + 1) % 3];
        sine += cross[i] * cross[i];
        dot += (double)a[i] * (double)b[i];
    }
    return atan2(sqrt(sine), dot);
}

/* Half a step in x and y moves the unfolded point by at most |(hx, hy, hx + hy)|, and that
 * point is at least 1/sqrt(3) long. */
static double octahedral_bound(double half_x, double half_y)
{
    return sqrt(3.0) * sqrt(half_x * half_x + half_y * half_y + (half_x + half_y) * (half_x + half_y)) + 2e-7;
}

static int is_unit(const float v[3])
{
    double square = (double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] + (double)v[2] * (double)v[2];
    return fabs(sqrt(square) - 1.0) < 2e-7;
}

static void normals_stay_within_the_octahedral_bound(void **state)
{
    double bound = octahedral_bound(0.5 / 32767.0, 0.5 / 32767.0), worst = 0.0;
    (void)state;
    for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
        noh_vertex vertex = decoded(v);
        worst = fmax(worst, angle(vertex.normal, source->meshes[0].normal + 3 * order[v]));
        assert_true(is_unit(vertex.normal));
    }
    print_message("# worst %g, bound %g rad\n", worst, bound);
    assert_true(worst <= bound && worst > 0.1 * bound); /* a bound far above would test nothing */
}

static void tangents_stay_within_the_octahedral_bound(void **state)
{
    double bound = octahedral_bound(0.5 / 32767.0, 0.5 / 16383.0), worst = 0.0;
    (void)state;
    for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
        noh_vertex vertex = decoded(v);
        assert_true(is_unit(vertex.tangent));
        worst = fmax(worst, angle(vertex.tangent, source->meshes[0].tangent + 4 * order[v]));
    }
    print_message("# worst %g, bound %g rad\n", worst, bound);
    assert_true(worst <= bound && worst > 0.1 * bound);
}

static void handedness_is_kept(void **state)
{
    uint32_t left = 0;
    (void)state;
    for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
        noh_vertex vertex = decoded(v);
        assert_true(vertex.tangent[3] == source->meshes[0].tangent[4 * order[v] + 3]);
        left += vertex.tangent[3] < 0.0f;
    }
    assert_in_range(left, 1, mesh.header->vertex_count - 1); /* both hands were tried */
}

static void uvs_are_within_half_a_step_of_their_range(void **state)
{
    (void)state;
    for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
        noh_vertex vertex = decoded(v);
        for (uint32_t i = 0; i < 2; i++) {
            double expected = (double)source->meshes[0].uv[2 * order[v] + i];
            double step = (double)mesh.header->uv_scale[i] / 65535.0;
            assert_true(fabs((double)vertex.uv[i] - expected) <= 0.5 * step + 2e-7);
        }
    }
}

/* rgb is kept as a square root in 8 bits: fine in the dark, where eyes are. */
static void colors_are_within_half_a_step_of_their_root(void **state)
{
    (void)state;
    for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
        noh_vertex vertex = decoded(v);
        const float *expected = source->meshes[0].color + 4 * order[v];
        for (uint32_t i = 0; i < 3; i++) {
            assert_true(fabs(sqrt((double)vertex.color[i]) - sqrt((double)expected[i])) <= 0.5 / 255.0 + 1e-6);
        }
        assert_true(fabs((double)vertex.color[3] - (double)expected[3]) <= 0.5 / 255.0 + 1e-6);
    }
}

static void a_mesh_without_attributes_has_defaults(void **state)
{
    const test_model_desc desc = { 1, 4, 1, 0, 2 };
    size_t count;
    uint8_t *plain = test_pack(&desc, &count);
    noh_pack p = test_open(plain, count);
    noh_mesh m = test_mesh(&p, 0);
    noh_vertex vertex;
    (void)state;
    assert_int_equal(noh_mesh_tangent_offset(&m), -1);
    assert_int_equal(noh_mesh_uv_offset(&m), -1);
    assert_int_equal(noh_mesh_color_offset(&m), -1);
    noh_mesh_vertex(&m, 0, &vertex);
    for (int i = 0; i < 4; i++) {
        assert_true(vertex.tangent[i] == 0.0f && vertex.color[i] == 1.0f);
    }
    assert_true(vertex.uv[0] == 0.0f && vertex.uv[1] == 0.0f);
    free(plain);
}

/* Each combination of attributes lies where the offsets say: decoded values agree with the
 * values of the mesh that has them all. */
static void every_combination_of_attributes_decodes(void **state)
{
    (void)state;
    for (uint32_t flags = 0; flags < 8; flags++) {
        test_model_desc desc = { 1, 6, 1, flags, 4 };
        model *m = test_model(&desc);
        size_t count;
        uint32_t *map;
        uint8_t *packed = test_pack_of(m, &count, &map);
        noh_pack p = test_open(packed, count);
        noh_mesh got = test_mesh(&p, 0);
        for (uint32_t v = 0; v < 36; v++) {
            noh_vertex vertex;
            noh_mesh_vertex(&got, v, &vertex);
            assert_true(angle(vertex.normal, m->meshes[0].normal + 3 * map[v]) < 1e-4);
            assert_true(!m->meshes[0].tangent || angle(vertex.tangent, m->meshes[0].tangent + 4 * map[v]) < 2e-4);
            assert_true(!m->meshes[0].uv || fabsf(vertex.uv[1] - m->meshes[0].uv[2 * map[v] + 1]) < 1e-4f);
            assert_true(!m->meshes[0].color || fabsf(vertex.color[3] - m->meshes[0].color[4 * map[v] + 3]) < 3e-3f);
        }
        free(packed);
        free(map);
        model_free(m);
    }
}

/* Triangles may be reordered and rotated, but their set must be the same. */
static void triangles_are_those_of_the_source(void **state)
{
    uint64_t got = 0, expected = 0;
    (void)state;
    assert_int_equal(mesh.header->index_count, source->meshes[0].index_count);
    for (uint32_t i = 0; i < mesh.header->index_count; i += 3) {
        uint64_t a = 1, b = 1;
        for (uint32_t k = 0; k < 3; k++) {
            a *= 2654435761u + order[noh_mesh_index(&mesh, i + k)];
            b *= 2654435761u + source->meshes[0].indices[i + k];
        }
        got += a * a;
        expected += b * b;
    }
    assert_true(got == expected);
}

static void large_meshes_have_wide_indices(void **state)
{
    const test_model_desc desc = { 1, 257, 1, 0, 3 }; /* 66049 vertices */
    size_t count;
    uint8_t *large = test_pack(&desc, &count);
    noh_pack p = test_open(large, count);
    noh_mesh m = test_mesh(&p, 0);
    uint32_t highest = 0;
    (void)state;
    assert_int_equal(m.header->index_bytes, 4);
    for (uint32_t i = 0; i < m.header->index_count; i++) {
        highest = noh_mesh_index(&m, i) > highest ? noh_mesh_index(&m, i) : highest;
    }
    assert_int_equal(highest, 66048);
    assert_int_equal(mesh.header->index_bytes, 2);
    free(large);
}

static void targets_are_found_by_name(void **state)
{
    (void)state;
    assert_int_equal(noh_mesh_find_target(&mesh, "smile"), 0);
    assert_int_equal(noh_mesh_find_target(&mesh, "blink"), 1);
    assert_int_equal(noh_mesh_find_target(&mesh, "target_2"), 2);
    assert_int_equal(noh_mesh_find_target(&mesh, "simle"), NOH_NONE);
    assert_int_equal(noh_mesh_find_target(&mesh, ""), NOH_NONE);
    assert_int_equal(noh_mesh_find_target(&mesh, "smil"), NOH_NONE);
}

static void default_weights_are_kept(void **state)
{
    (void)state;
    test_same_floats(mesh.weights, source->meshes[0].weights, 3, "default weight");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_vertex_is_there_once),
    cmocka_unit_test(positions_are_exact),
    cmocka_unit_test(normals_stay_within_the_octahedral_bound),
    cmocka_unit_test(tangents_stay_within_the_octahedral_bound),
    cmocka_unit_test(handedness_is_kept),
    cmocka_unit_test(uvs_are_within_half_a_step_of_their_range),
    cmocka_unit_test(colors_are_within_half_a_step_of_their_root),
    cmocka_unit_test(a_mesh_without_attributes_has_defaults),
    cmocka_unit_test(every_combination_of_attributes_decodes),
    cmocka_unit_test(triangles_are_those_of_the_source),
    cmocka_unit_test(large_meshes_have_wide_indices),
    cmocka_unit_test(targets_are_found_by_name),
    cmocka_unit_test(default_weights_are_kept),
};

TEST_MAIN(tests, set_up, tear_down)
