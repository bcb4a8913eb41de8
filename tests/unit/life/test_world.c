/* Tests of world.c: a height field against double, rays against fine steps. */
#include "noh/base.h"
#include "noh/body.h"

#include <math.h>

#include "support/support.h"

#define SIDE 33u

static uint16_t heights[SIDE * SIDE];
static uint32_t seed = 1;

static double random_unit(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (double)(seed >> 8) / 16777216.0;
}

static noh_field hills(void)
{
    const noh_field f = { heights, SIDE, SIDE, { -8.0f, -1.0f, -8.0f }, 0.5f, 1.0f / 10000.0f };
    for (uint32_t i = 0; i < SIDE * SIDE; i++) heights[i] = (uint16_t)(random_unit() * 20000.0);
    return f;
}

/* Bilinear, in double. */
static double height_at(const noh_field *f, double x, double z)
{
    const double u = (x - (double)f->origin[0]) / (double)f->spacing,
                 v = (z - (double)f->origin[2]) / (double)f->spacing;
    const uint32_t c = (uint32_t)fmin(floor(u), SIDE - 2.0), r = (uint32_t)fmin(floor(v), SIDE - 2.0);
    const uint16_t *h = f->heights + r * SIDE + c;
    const double a = u - c, b = v - r;
    return (double)f->origin[1] +
           (double)f->scale * ((h[0] * (1 - a) + h[1] * a) * (1 - b) + (h[SIDE] * (1 - a) + h[SIDE + 1] * a) * b);
}

static void heights_and_normals(void **state)
{
    const noh_field f = hills();
    (void)state;
    for (int i = 0; i < 20000; i++) {
        const double x = -7.9 + random_unit() * 15.8, z = -7.9 + random_unit() * 15.8, e = 1e-4;
        float height, n[3];
        assert_true(noh_field_height(&f, (float)x, (float)z, &height, n));
        assert_true(fabs((double)height - height_at(&f, (double)(float)x, (double)(float)z)) < 2e-5);
        const double dx = (height_at(&f, x + e, z) - height_at(&f, x - e, z)) / (2 * e);
        const double dz = (height_at(&f, x, z + e) - height_at(&f, x, z - e)) / (2 * e);
        const double u = fmod((x + 8.0) / 0.5, 1.0), v = fmod((z + 8.0) / 0.5, 1.0);
        if (fmin(fmin(u, 1 - u), fmin(v, 1 - v)) < 1e-3) continue; /* the slope changes at the edges of cells */
        assert_true(fabs(-(double)n[0] / (double)n[1] - dx) < 1e-3 && fabs(-(double)n[2] / (double)n[1] - dz) < 1e-3);
        assert_true(fabs((double)(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) - 1.0) < 1e-5);
    }
}

static void there_is_nothing_outside(void **state)
{
    const noh_field f = hills();
    float height = 5.0f;
    (void)state;
    assert_false(noh_field_height(&f, -8.01f, 0.0f, &height, NULL));
    assert_false(noh_field_height(&f, 0.0f, 8.01f, &height, NULL));
    assert_false(noh_field_height(&f, NAN, 0.0f, &height, NULL));
    assert_true(height == 5.0f);
    assert_true(noh_field_height(&f, 8.0f, 8.0f, &height, NULL));
    assert_true(fabs((double)height - height_at(&f, 8.0, 8.0)) < 1e-5);
}

static void bad_worlds_are_refused(void **state)
{
    const noh_plane skewed = { { 0.0f, 2.0f, 0.0f }, 0.0f }, floor_plane = { { 0.0f, 1.0f, 0.0f }, 0.0f };
    const noh_capsule inverted = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 1.0f, 0.0f }, -1.0f };
    const noh_obb unturned = { { 0.0f, 0.0f, 0.0f }, { 1.0f, 1.0f, 1.0f }, { 0.0f, 0.0f, 0.0f, 0.0f } };
    const noh_field flat = { heights, 1, SIDE, { 0.0f, 0.0f, 0.0f }, 1.0f, 1.0f };
    noh_world w = { .planes = &floor_plane, .plane_count = 1, .friction = 0.6f };
    (void)state;
    assert_int_equal(noh_world_check(&w, NULL), NOH_OK);
    w.planes = &skewed;
    assert_int_equal(noh_world_check(&w, NULL), NOH_ERR_ARG);
    w = (noh_world){ .capsules = &inverted, .capsule_count = 1 };
    assert_int_equal(noh_world_check(&w, NULL), NOH_ERR_ARG);
    w = (noh_world){ .boxes = &unturned, .box_count = 1 };
    assert_int_equal(noh_world_check(&w, NULL), NOH_ERR_ARG);
    w = (noh_world){ .field = &flat };
    assert_int_equal(noh_world_check(&w, NULL), NOH_ERR_ARG);
    w = (noh_world){ .friction = NAN };
    assert_int_equal(noh_world_check(&w, NULL), NOH_ERR_ARG);
    w = (noh_world){ .plane_count = NOH_OBSTACLES_MAX + 1u };
    assert_int_equal(noh_world_check(&w, NULL), NOH_ERR_LIMIT);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(heights_and_normals),
    cmocka_unit_test(there_is_nothing_outside),
    cmocka_unit_test(bad_worlds_are_refused),
};

TEST_MAIN(tests, NULL, NULL)
