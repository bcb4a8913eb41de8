/* Distances to triangles, eight at once and by a tree, held to one at a time. */
#include "support/support.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "convert/lod/lod_internal.h"
#include "convert/lod/lod_tree.h"

#define TRIANGLES 203u /* not a multiple of LOD_LANES */
#define POINTS 400u
#define POSES 3u

typedef struct scene {
    float position[POSES][TRIANGLES * 3u][3];
    uint32_t indices[TRIANGLES * 3u];
    float points[POINTS][3];
} scene;

/* Small triangles in a cube; a few are lines or points. */
static void make_scene(scene *s)
{
    test_random r = test_random_from(7);
    for (uint32_t i = 0; i < TRIANGLES * 3u; i++) {
        s->indices[i] = i;
        for (uint32_t k = 0; k < 3u; k++) {
            const float *first = s->position[0][i / 3u * 3u];
            s->position[0][i][k] = i % 3u ? first[k] + test_random_float(&r, -0.1f, 0.1f)
                                          : test_random_float(&r, -1.0f, 1.0f);
            s->position[1][i][k] = s->position[0][i][k] + test_random_float(&r, -0.05f, 0.05f);
            s->position[2][i][k] = i / 3u % 50u ? 2.0f * s->position[0][i][k] : 0.25f;
        }
    }
    memcpy(s->position[0][1], s->position[0][0], sizeof s->position[0][0]); /* a line */
    for (uint32_t i = 0; i < POINTS; i++) {
        for (uint32_t k = 0; k < 3u; k++) s->points[i][k] = test_random_float(&r, -1.3f, 1.3f);
    }
    memcpy(s->points[0], s->position[0][4], sizeof s->points[0]); /* a corner */
}

static void triangle_at(const scene *s, uint32_t pose, uint32_t triangle, float *out)
{
    memcpy(out, s->position[pose][3u * triangle], 9u * sizeof *out);
}

static void eight_at_once_are_the_same_bits(void **state)
{
    (void)state;
    static scene s;
    make_scene(&s);
    for (uint32_t first = 0; first < TRIANGLES; first += LOD_LANES) {
        const uint32_t left = TRIANGLES - first, count = left < LOD_LANES ? left : LOD_LANES;
        float triangles[LOD_LANES * 9u];
        lod_block block;
        for (uint32_t k = 0; k < count; k++) triangle_at(&s, 0, first + k, triangles + 9u * k);
        lod_block_prepare(triangles, count, &block);
        for (uint32_t i = 0; i < POINTS; i++) {
            float squared[LOD_LANES];
            lod_block_distances(&block, s.points[i], squared);
            for (uint32_t k = 0; k < LOD_LANES; k++) {
                const float one = lod_distance_point(triangles + 9u * (k < count ? k : count - 1u), s.points[i]);
                assert_memory_equal(&one, &squared[k], sizeof one);
            }
        }
    }
}

static float nearest_of_all(const scene *s, uint32_t pose, const float *point)
{
    float best = FLT_MAX;
    for (uint32_t t = 0; t < TRIANGLES; t++) {
        float triangle[9], squared;
        triangle_at(s, pose, t, triangle);
        squared = lod_distance_point(triangle, point);
        best = squared < best ? squared : best;
    }
    return best;
}

static void the_tree_finds_the_nearest_in_each_pose(void **state)
{
    (void)state;
    static scene s;
    lod_tree tree = { 0 };
    make_scene(&s);
    assert_int_equal(lod_tree_make(s.indices, TRIANGLES, s.position[0][0], &tree), 0);
    for (uint32_t pose = 0; pose < POSES; pose++) {
        uint32_t nearest = 0;
        if (pose) lod_tree_pose(&tree, s.position[pose][0]);
        for (uint32_t i = 0; i < POINTS; i++) {
            const float squared = lod_tree_nearest(&tree, s.points[i], 0.0f, &nearest);
            const float found = lod_tree_distance(&tree, s.points[i], nearest);
            assert_float_equal(squared, nearest_of_all(&s, pose, s.points[i]), 0.0f);
            assert_float_equal(squared, found, 0.0f);
        }
    }
    lod_tree_free(&tree);
}

/* A search may end early only at a triangle that is near enough. */
static void near_enough_is_enough(void **state)
{
    (void)state;
    static scene s;
    lod_tree tree = { 0 };
    uint32_t early = 0;
    make_scene(&s);
    assert_int_equal(lod_tree_make(s.indices, TRIANGLES, s.position[0][0], &tree), 0);
    for (uint32_t i = 0; i < POINTS; i++) {
        const float enough = 0.09f, least = nearest_of_all(&s, 0, s.points[i]);
        uint32_t nearest = 0;
        const float squared = lod_tree_nearest(&tree, s.points[i], enough, &nearest);
        assert_float_equal(squared, lod_tree_distance(&tree, s.points[i], nearest), 0.0f);
        assert_true(squared == least || (squared > least && squared <= enough));
        early += squared > least;
    }
    assert_in_range(early, 1, POINTS - 1u);
    lod_tree_free(&tree);
}

/* Of a fan of slivers nearly each box about a quarter of a turn holds each point of that quarter: searches end early,
 * at a triangle whose distance is right. */
static void slivers_end_a_search(void **state)
{
    (void)state;
    enum { slivers = 4096, queries = 65536 };
    static float position[slivers + 2u][3];
    static uint32_t indices[slivers][3];
    lod_tree tree = { 0 };
    uint32_t nearest = 0;
    for (uint32_t i = 0; i <= slivers; i++) {
        const float angle = 6.2831853f * (float)i / (float)slivers;
        position[i + 1u][0] = cosf(angle);
        position[i + 1u][1] = sinf(angle);
        if (i < slivers) memcpy(indices[i], (const uint32_t[3]){ 0, i + 1u, i + 2u }, sizeof indices[i]);
    }
    assert_int_equal(lod_tree_make(indices[0], slivers, position[0], &tree), 0);
    for (uint32_t i = 0; i < queries; i++) {
        const float angle = 2.399963f * (float)i, point[3] = { 0.5f * cosf(angle), 0.5f * sinf(angle), 1e-3f };
        const float squared = lod_tree_nearest(&tree, point, 0.0f, &nearest);
        assert_float_equal(squared, lod_tree_distance(&tree, point, nearest), 0.0f);
        if (i == 0) assert_float_equal(squared, 1e-6f, 1e-9f);
    }
    assert_int_equal(tree.spare_leaves, 0);
    lod_tree_free(&tree);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(eight_at_once_are_the_same_bits),
    cmocka_unit_test(the_tree_finds_the_nearest_in_each_pose),
    cmocka_unit_test(near_enough_is_enough),
    cmocka_unit_test(slivers_end_a_search),
};

TEST_MAIN(tests, NULL, NULL)
