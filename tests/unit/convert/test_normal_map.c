/* test_normal_map.c: normal maps out of height maps and out of fine models, against normals in closed form. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/normal/normal_bake.h"
#include "convert/normal/normal_height.h"

#define TAU 6.283185307179586

static double degrees_between(const double a[3], const double b[3])
{
    const double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const double lengths = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) *
                           sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    return acos(fmin(dot / lengths, 1.0)) * 360.0 / TAU;
}

/* As noh_map_vector of the shaders reads it. */
static void vector_of(const uint8_t texel[4], double v[3])
{
    for (int c = 0; c < 3; c++) v[c] = (texel[c] - 128.0) / 127.0;
}

/* ---- heights ---- */

#define SIDE 128u
#define DEPTH 10.0

/* Waves that tile, of different lengths along the two axes: 0..1, and the rise to the right and upwards a texel. */
static double wave(double x, double y, double slope[2])
{
    const double a = TAU * 2.0 * x / SIDE, b = TAU * 3.0 * y / SIDE;
    slope[0] = 0.25 * TAU * 2.0 / SIDE * cos(a);
    slope[1] = 0.25 * TAU * 3.0 / SIDE * sin(b); /* rows go down */
    return 0.5 + 0.25 * sin(a) + 0.25 * cos(b);
}

static double worst_wave(const uint8_t *rgba, double depth, uint32_t margin)
{
    double worst = 0.0;
    for (uint32_t y = margin; y < SIDE - margin; y++) {
        for (uint32_t x = margin; x < SIDE - margin; x++) {
            double slope[2], got[3];
            (void)wave(x, y, slope);
            const double want[3] = { -depth * slope[0], -depth * slope[1], 1.0 };
            vector_of(rgba + 4u * (y * SIDE + x), got);
            worst = fmax(worst, degrees_between(want, got));
        }
    }
    return worst;
}

/* Both signs of depth, at the edges too where it tiles; green up, as the shader reads it: turned round it is 27 degrees
 * off. */
static void slopes_of_a_height_map(void **state)
{
    uint16_t *heights = test_zeros(SIDE * SIDE * sizeof *heights);
    uint8_t *up, *down, *edges;
    double slope[2];
    (void)state;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        heights[i] = (uint16_t)(65535.0 * wave(i % SIDE, (double)(i / SIDE), slope) + 0.5);
    }
    up = normal_map_of_height(heights, SIDE, SIDE, DEPTH, 1);
    down = normal_map_of_height(heights, SIDE, SIDE, -DEPTH, 1);
    edges = normal_map_of_height(heights, SIDE, SIDE, DEPTH, 0);
    printf("# waves: off by at most %.2f degrees\n", worst_wave(up, DEPTH, 0));
    assert_true(worst_wave(up, DEPTH, 0) < 0.7);
    assert_true(worst_wave(down, -DEPTH, 0) < 0.7);
    assert_true(worst_wave(edges, DEPTH, 1) < 0.7);
    assert_true(worst_wave(edges, DEPTH, 0) > 3.0); /* half the slope, where there is nothing beyond */
    assert_true(worst_wave(down, DEPTH, 0) > 10.0);
    free(up);
    free(down);
    free(edges);
    memset(heights, 0x55, SIDE * SIDE * sizeof *heights);
    up = normal_map_of_height(heights, SIDE, SIDE, DEPTH, 1);
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        assert_memory_equal(up + 4u * i, ((uint8_t[4]){ 128, 128, 255, 255 }), 4);
    free(up);
    free(heights);
}

/* ---- models ---- */

#define COARSE 5u
#define FINE 129u
#define MAP 96u

/* A bump over the square -1..1, and its normal. */
static double bump(double x, double y, double n[3])
{
    const double height = 0.05 * cos(2.0 * x) * cos(3.0 * y);
    n[0] = 0.05 * 2.0 * sin(2.0 * x) * cos(3.0 * y);
    n[1] = 0.05 * 3.0 * cos(2.0 * x) * sin(3.0 * y);
    n[2] = 1.0;
    return height;
}

/* A square: flat, or with the bump. turned: it looks down, as a back wall would. */
static model *square(uint32_t side, int bumpy, float z, int turned)
{
    const test_model_desc desc = { 1, side, 0, TEST_UVS | TEST_TANGENTS, 1 };
    model *m = test_model(&desc);
    model_mesh *mesh = &m->meshes[0];
    for (uint32_t v = 0; v < side * side; v++) {
        const double x = 2.0 * (v % side) / (side - 1.0) - 1.0, y = 2.0 * (double)(v / side) / (side - 1.0) - 1.0;
        double n[3] = { 0.0, 0.0, turned ? -1.0 : 1.0 };
        const double height = bumpy ? bump(x, y, n) : 0.0, length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        const float at[3] = { (float)x, (float)y, (float)height + z };
        memcpy(mesh->position + 3u * v, at, sizeof at);
        for (uint32_t k = 0; k < 3; k++) mesh->normal[3u * v + k] = (float)(n[k] / length);
    }
    return m;
}

/* Texture coordinates that run along y and against x, the second half of the square mirrored in them. */
static void coordinates(model_mesh *mesh, uint32_t side)
{
    for (uint32_t v = 0; v < side * side; v++) {
        const float *p = mesh->position + 3u * v;
        const float tangent[4] = { 0.0f, 1.0f, 0.0f, -1.0f };
        mesh->uv[2u * v] = 0.5f + 0.5f * p[1];
        mesh->uv[2u * v + 1u] = 0.5f + 0.5f * p[0];
        memcpy(mesh->tangent + 4u * v, tangent, sizeof tangent);
    }
}

static normal_map baked(const model *coarse, const model *fine, double reach)
{
    const normal_bake_settings settings = { MAP, reach, NULL };
    normal_map map;
    model_error error;
    if (normal_map_bake(coarse, fine, &settings, &map, &error)) fail_msg("%s", error.what);
    assert_int_equal(map.covered, MAP * MAP);
    return map;
}

/* The largest angle between what the map says, in the frame, and the fine surface's own normal there. */
static double worst_bump(const normal_map *map)
{
    double worst = 0.0;
    for (uint32_t i = 0; i < MAP * MAP; i++) {
        const double y = 2.0 * (i % MAP + 0.5) / MAP - 1.0, x = 2.0 * (i / MAP + 0.5) / MAP - 1.0;
        double v[3], want[3];
        (void)bump(x, y, want);
        vector_of(map->rgba + 4u * i, v);
        /* tangent +y; bitangent cross(n, t) * -1 = +x */
        const double got[3] = { v[1], v[0], v[2] };
        worst = fmax(worst, degrees_between(want, got));
    }
    return worst;
}

static void a_fine_surface_is_seen_in_the_coarse_ones_frame(void **state)
{
    model *coarse = square(COARSE, 0, 0.0f, 0), *fine = square(FINE, 1, 0.0f, 0);
    normal_map map;
    (void)state;
    coordinates(&coarse->meshes[0], COARSE);
    map = baked(coarse, fine, 0.1);
    printf("# a bump: off by at most %.2f degrees, leaning %.2f in the mean\n", worst_bump(&map), map.lean);
    assert_int_equal(map.missed, 0);
    assert_true(worst_bump(&map) < 0.7);
    assert_true(map.lean > 3.0 && map.lean < 12.0);
    free(map.rgba);
    map = baked(coarse, fine, 0.02); /* the bump is farther off than that where it is high */
    assert_in_range(map.missed, MAP * MAP / 4u, MAP * MAP * 3u / 4u);
    free(map.rgba);
    model_free(coarse);
    model_free(fine);
}

/* A wall that faces away is nearer, and does not count; without a fine surface the map is flat. */
static void what_faces_away_does_not_count(void **state)
{
    model *coarse = square(COARSE, 0, 0.0f, 0), *fine = square(FINE, 0, 0.08f, 0);
    model *wall = square(FINE, 0, -0.01f, 1);
    normal_map map;
    (void)state;
    coordinates(&coarse->meshes[0], COARSE);
    map = baked(coarse, wall, 0.1);
    assert_int_equal(map.missed, MAP * MAP);
    for (uint32_t i = 0; i < MAP * MAP; i++)
        assert_memory_equal(map.rgba + 4u * i, ((uint8_t[4]){ 128, 128, 255, 255 }), 4);
    free(map.rgba);
    map = baked(coarse, fine, 0.1);
    assert_int_equal(map.missed, 0);
    free(map.rgba);
    map = baked(coarse, fine, 0.05);
    assert_int_equal(map.missed, MAP * MAP);
    free(map.rgba);
    model_free(wall);
    model_free(coarse);
    model_free(fine);
}

static void what_cannot_be_baked_says_why(void **state)
{
    const normal_bake_settings all = { MAP, 0.0, NULL }, named = { MAP, 0.0, "no such material" };
    const test_model_desc bare = { 1, COARSE, 0, 0, 1 };
    model *coarse = test_model(&bare), *fine = square(FINE, 1, 0.0f, 0);
    normal_map map;
    model_error error;
    (void)state;
    assert_int_equal(normal_map_bake(coarse, fine, &all, &map, &error), 1);
    assert_non_null(strstr(error.what, "texture coordinates"));
    assert_null(map.rgba);
    assert_int_equal(normal_map_bake(fine, coarse, &named, &map, &error), 1);
    assert_non_null(strstr(error.what, "no triangle of that material"));
    model_free(coarse);
    model_free(fine);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(slopes_of_a_height_map),
    cmocka_unit_test(a_fine_surface_is_seen_in_the_coarse_ones_frame),
    cmocka_unit_test(what_faces_away_does_not_count),
    cmocka_unit_test(what_cannot_be_baked_says_why),
};

TEST_MAIN(tests, NULL, NULL)
