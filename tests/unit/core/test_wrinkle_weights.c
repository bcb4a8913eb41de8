/* test_wrinkle_weights.c: regions out of expressions, weights out of areas, normals with wrinkles; compared with
 * the sources' formulas. */
#include "support/support.h"

#include <math.h>
#include <string.h>

#include "core/mesh/mesh_internal.h"
#include "noh/format.h"
#include "noh/pack.h"

static void regions_come_from_expressions(void **state)
{
    (void)state;
    static const uint8_t matrix[3 * NOH_WRINKLE_FOLDS] = { 255, 51, 0, 0, 0, 0, 0, 0, 0, 0, 0, 255,
                                                           255, 0,  0, 0, 0, 0, 0, 0, 0, 0, 0, 102 };
    const noh_wrinkles wrinkles = { .target_count = 3, .matrix = matrix };
    float regions[NOH_WRINKLE_REGIONS];
    noh_wrinkles_weights(&wrinkles, (const float[3]){ 0.5f, 0.25f, 9.0f }, regions);
    assert_true(fabsf(regions[0] - 0.75f) < 1e-6f); /* both expressions */
    assert_true(fabsf(regions[1] - 0.1f) < 1e-6f);
    assert_true(fabsf(regions[11] - 0.6f) < 1e-6f);
    for (int r = 2; r < 11; ++r) assert_true(regions[r] == 0.0f);
    noh_wrinkles_weights(&wrinkles, (const float[3]){ 1.0f, 1.0f, 0.0f }, regions);
    assert_true(regions[0] == 1.0f); /* never above */
    noh_wrinkles_weights(&wrinkles, (const float[3]){ -1.0f, 0.5f, 0.0f }, regions);
    assert_true(fabsf(regions[0] - 0.5f) < 1e-6f); /* what is below 0 takes nothing away */
    for (uint32_t c = 0; c < 4; ++c) assert_true(regions[NOH_WRINKLE_FOLDS + c] == 0.0f); /* it has no colours */
}

/* A blush by the first target and half of it by the second, pallor by the third. Regions are blended one after the
 * other, so what covers whole hides what is below. */
static void colors_fade_in_with_targets(void **state)
{
    static const uint8_t matrix[3 * NOH_WRINKLE_FOLDS] = { 255 };
    static const uint8_t colors[7][4] = { { 204, 51, 51, 0 },
                                          { 0 },
                                          { 0 },
                                          { 153, 204, 255, 0 }, /* square roots */
                                          { 255, 0, 0, 0 },
                                          { 102, 0, 0, 0 },
                                          { 0, 0, 0, 255 } };
    const noh_wrinkles wrinkles = { .target_count = 3, .matrix = matrix, .colors = colors[0] };
    const float albedo[3] = { 0.5f, 0.4f, 0.3f };
    float regions[NOH_WRINKLE_REGIONS], rgb[3];
    (void)state;
    noh_wrinkles_weights(&wrinkles, (const float[3]){ 0.5f, 0.5f, 0.0f }, regions);
    assert_true(regions[0] == 0.5f);
    assert_true(fabsf(regions[NOH_WRINKLE_FOLDS] - 0.7f) < 1e-6f);
    for (uint32_t c = 1; c < 4; ++c) assert_true(regions[NOH_WRINKLE_FOLDS + c] == 0.0f);
    memcpy(rgb, albedo, sizeof rgb);
    noh_wrinkles_color(&wrinkles, (const uint8_t[4]){ 51, 255, 255, 255 }, regions, rgb);
    for (int i = 0; i < 3; ++i) { /* 0.7 of a fifth of the way to 0.64, 0.04, 0.04 */
        assert_true(fabsf(rgb[i] - (albedo[i] + 0.14f * ((i ? 0.04f : 0.64f) - albedo[i]))) < 1e-6f);
    }
    memcpy(rgb, albedo, sizeof rgb);
    noh_wrinkles_color(&wrinkles, (const uint8_t[4]){ 0, 255, 255, 255 }, regions, rgb);
    assert_memory_equal(rgb, albedo, sizeof rgb); /* where no region is, no bit changes */
    noh_wrinkles_weights(&wrinkles, (const float[3]){ 9.0f, 0.0f, 1.0f }, regions);
    assert_true(regions[NOH_WRINKLE_FOLDS] == 1.0f && regions[NOH_WRINKLE_FOLDS + 3] == 1.0f);
    noh_wrinkles_color(&wrinkles, (const uint8_t[4]){ 255, 0, 0, 255 }, regions, rgb);
    for (int i = 0; i < 3; ++i) assert_true(fabsf(rgb[i] - (const float[3]){ 0.36f, 0.64f, 1.0f }[i]) < 1e-6f);
}

static double area_of(double p[3][3])
{
    double n[3];
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        n[i] = (p[1][j] - p[0][j]) * (p[2][k] - p[0][k]) - (p[1][k] - p[0][k]) * (p[2][j] - p[0][j]);
    }
    return 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

/* The source takes areas of clip-space positions, without the division by w and then as they are: they follow the
 * camera. In bind space they do not know it. */
static void areas_do_not_follow_the_camera(void **state)
{
    (void)state;
    double rest[3][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } },
           now[3][3] = { { 0, 0, 0 }, { 0.5, 0, 0 }, { 0, 1, 1 } };
    double seen[2][2];
    const float ours = noh_wrinkles_area((float)area_of(rest), (float)area_of(now));
    for (int camera = 0; camera < 2; ++camera) {
        double *const poses[2] = { rest[0], now[0] };
        for (int pose = 0; pose < 2; ++pose) {
            double clip[3][3];
            for (int k = 0; k < 3; ++k) { /* turned about y, in a tall window, z as clip space has it */
                const double *p = poses[pose] + 3 * k, c = cos(1.4 * camera), s = sin(1.4 * camera);
                clip[k][0] = 4.0 * (c * p[0] + s * p[2]);
                clip[k][1] = 2.1 * p[1];
                clip[k][2] = 1.02 * (c * p[2] - s * p[0]) + 3.0;
            }
            seen[camera][pose] = area_of(clip);
        }
    }
    const double literal0 = (seen[0][0] - seen[0][1]) / seen[0][0], literal1 = (seen[1][0] - seen[1][1]) / seen[1][0];
    assert_true(fabs(literal0 - literal1) > 0.05);
    assert_true(fabs((double)ours - (0.3 + 1.0 - area_of(now) / area_of(rest))) < 1e-6);
    assert_true(noh_wrinkles_area(1.0f, 1.0f) == 0.3f);
    assert_true(noh_wrinkles_area(1.0f, 0.0f) == 1.0f);
    assert_true(fabsf(noh_wrinkles_area(1.0f, 3.0f) - 0.29f) < 1e-6f);
    assert_true(noh_wrinkles_area(1.0f, 1e9f) == 0.0f);
}

/* (A0 - A) / A0 of a triangle without area at rest is no number, and so is the normal that is mixed by it. */
static void no_area_at_rest_wrinkles_nothing(void **state)
{
    const volatile float none = 0.0f; /* so that the division is not done by the compiler */
    const float literal = (none - none) / none;
    (void)state;
    assert_true(literal != literal);
    assert_true(noh_wrinkles_area(0.0f, 0.0f) == 0.3f);
    assert_true(noh_wrinkles_area(0.0f, 2.0f) == 0.3f);
}

static float length_of(const float v[3])
{
    return sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* N = lerp(N_geo, N_bump, wrinkle) is not made unit again: with the weight that a triangle has at rest, and with the
 * weight of one that lost a third. */
static void normals_of_areas_are_unit(void **state)
{
    const float geometric[3] = { 0.0f, 0.0f, 1.0f }, bump[3] = { 0.8f, 0.0f, 0.6f };
    (void)state;
    for (int third = 0; third < 2; ++third) {
        const float weight = noh_wrinkles_area(3.0f, third ? 2.0f : 3.0f);
        float literal[3], out[3];
        for (int i = 0; i < 3; ++i) literal[i] = geometric[i] + weight * (bump[i] - geometric[i]);
        noh_wrinkles_normal(geometric, bump, weight, out);
        assert_true(length_of(literal) < 0.96f);
        assert_true(fabsf(length_of(out) - 1.0f) < 1e-6f);
    }
}

/* N = lerp(base, wrinkle, weight) is shorter than one, and at weight 1 has lost all of the base's detail. */
static void wrinkled_normals_are_unit(void **state)
{
    (void)state;
    const float base[3] = { 0.6f, 0.0f, 0.8f }, wrinkle[3] = { 0.0f, 0.6f, 0.8f }, flat[3] = { 0.0f, 0.0f, 1.0f };
    float out[3], literal[3];
    for (int i = 0; i < 3; ++i) literal[i] = 0.5f * (base[i] + wrinkle[i]);
    assert_true(length_of(literal) < 0.95f);
    for (int step = 0; step <= 4; ++step) {
        noh_wrinkles_normal(base, wrinkle, (float)step / 4.0f, out);
        assert_true(fabsf(length_of(out) - 1.0f) < 1e-6f);
        assert_true(out[0] > 0.3f); /* the base's slope stays */
    }
    assert_true(out[1] > 0.3f);
    noh_wrinkles_normal(base, wrinkle, 0.0f, out);
    for (int i = 0; i < 3; ++i) assert_true(fabsf(out[i] - base[i]) < 1e-6f);
    noh_wrinkles_normal(flat, wrinkle, 1.0f, out);
    for (int i = 0; i < 3; ++i) assert_true(fabsf(out[i] - wrinkle[i]) < 1e-6f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(regions_come_from_expressions), cmocka_unit_test(areas_do_not_follow_the_camera),
        cmocka_unit_test(colors_fade_in_with_targets),   cmocka_unit_test(no_area_at_rest_wrinkles_nothing),
        cmocka_unit_test(normals_of_areas_are_unit),     cmocka_unit_test(wrinkled_normals_are_unit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
