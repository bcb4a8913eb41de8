/* Tests of gl_draw.c and mesh.frag: how a material, a texture, colours and a mirrored world change a
 * pixel. */
#include "support/gl_fixture.h"

#include "support/lit_quad.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The middle row equals the closed form, within rounding. */
static void expect_lit(const lit_quad *q, const uint8_t *rgba)
{
    for (uint32_t x = 0; x < LIT_QUAD_SIDE; x++) {
        double right[3];
        lit_quad_pixel(q, x, NORMALS_BY_INVERSE_TRANSPOSE, 1, right);
        for (int i = 0; i < 3; i++) {
            assert_true(fabs((double)lit_quad_at(rgba, x)[i] - right[i]) < LIT_QUAD_CLOSE);
        }
    }
}

static void expect_color(const uint8_t *pixel, double r, double g, double b)
{
    assert_true(fabs((double)pixel[0] - r) < LIT_QUAD_CLOSE && fabs((double)pixel[1] - g) < LIT_QUAD_CLOSE &&
                fabs((double)pixel[2] - b) < LIT_QUAD_CLOSE);
}

static int draws_nothing(const uint8_t *rgba)
{
    for (uint32_t x = 0; x < LIT_QUAD_SIDE; x++) {
        if (!lit_quad_is_background(lit_quad_at(rgba, x))) return 0;
    }
    return 1;
}

static uint8_t *drawn(const lit_quad *q, int pass)
{
    uint8_t *rgba = lit_quad_draw(fixture_gpu(), q, pass);
    fixture_expect_no_errors();
    return rgba;
}

static void metal_and_roughness_are_each_its_own(void **state)
{
    static const float pairs[4][2] = { { 0.0f, 0.9f }, { 0.9f, 0.3f }, { 0.5f, 0.5f }, { 0.1f, 0.2f } };
    (void)state;
    for (int i = 0; i < 4; i++) {
        lit_quad q = lit_quad_of();
        uint8_t *rgba;
        q.metallic = pairs[i][0];
        q.roughness = pairs[i][1];
        rgba = drawn(&q, NOH_DRAW_OPAQUE);
        expect_lit(&q, rgba);
        free(rgba);
    }
}

static void what_is_unlit_is_its_color(void **state)
{
    lit_quad q = lit_quad_of();
    uint8_t *rgba;
    (void)state;
    q.unlit = 1;
    rgba = drawn(&q, NOH_DRAW_OPAQUE);
    for (uint32_t x = 0; x < LIT_QUAD_SIDE; x++) {
        expect_color(lit_quad_at(rgba, x), encoded(0.8), encoded(0.6), encoded(0.4));
    }
    free(rgba);
}

/* A cutoff counts only in materials that are masked. */
static void masked_materials_are_cut_off(void **state)
{
    (void)state;
    for (int masked = 0; masked < 2; masked++) {
        for (int below = 0; below < 2; below++) {
            lit_quad q = lit_quad_of();
            uint8_t *rgba;
            q.alpha = masked ? MODEL_ALPHA_MASK : MODEL_ALPHA_OPAQUE;
            q.base[3] = below ? 0.3f : 0.5f;
            q.cutoff = 0.4f;
            rgba = drawn(&q, NOH_DRAW_OPAQUE);
            assert_int_equal(draws_nothing(rgba), masked && below);
            free(rgba);
        }
    }
}

/* A quad seen from behind is drawn only if its material is double-sided, and is then lit with its normal reversed. */
static void two_sided_materials_are_seen_from_behind(void **state)
{
    (void)state;
    for (int both = 0; both < 2; both++) {
        lit_quad q = lit_quad_of();
        uint8_t *rgba;
        q.double_sided = both;
        q.world[0] = -q.world[0];
        q.world[10] = -q.world[10];
        rgba = drawn(&q, NOH_DRAW_OPAQUE);
        assert_int_equal(draws_nothing(rgba), !both);
        if (both) {
            expect_lit(&q, rgba);
        }
        free(rgba);
    }
}

/* A mirrored node shows its front faces, and its normals still point outwards. */
static void mirrored_worlds_keep_their_front(void **state)
{
    lit_quad q = lit_quad_of();
    uint8_t *rgba;
    (void)state;
    q.world[5] = -q.world[5];
    rgba = drawn(&q, NOH_DRAW_OPAQUE);
    assert_false(draws_nothing(rgba));
    expect_lit(&q, rgba);
    free(rgba);
}

/* The material's own texture is sampled at the mesh's UVs, which the pack stores as fractions of their range. */
static void textures_are_looked_up_at_the_uvs(void **state)
{
    static const float uv[8] = { 0.2f, 0.5f, 0.9f, 0.5f, 0.2f, 0.5f, 0.9f, 0.5f };
    static const uint8_t picture[8] = { 200, 40, 10, 255, 20, 90, 240, 255 };
    lit_quad q = lit_quad_of();
    uint8_t *rgba;
    (void)state;
    q.unlit = 1;
    for (int i = 0; i < 3; i++) q.base[i] = 1.0f;
    q.uv = uv;
    q.picture = picture;
    rgba = drawn(&q, NOH_DRAW_OPAQUE);
    for (uint32_t x = 0; x < LIT_QUAD_SIDE; x++) { /* turned by half a turn and seen from behind: left stays left */
        const double u = 0.2 + 0.7 * ((double)x + 0.5) / (double)LIT_QUAD_SIDE;
        const uint8_t *texel = picture + (u < 0.5 ? 0 : 4);
        if (fabs(u - 0.5) > 0.02) {
            expect_color(lit_quad_at(rgba, x), texel[0], texel[1], texel[2]);
        }
    }
    free(rgba);
}

static void vertex_colors_multiply_the_base(void **state)
{
    lit_quad q = lit_quad_of();
    float color[16];
    uint8_t *rgba;
    (void)state;
    q.unlit = 1;
    q.color = color;
    for (int i = 0; i < 16; i++) {
        static const float one[4] = { 0.25f, 1.0f, 0.5f, 0.75f };
        color[i] = one[i % 4];
    }
    rgba = drawn(&q, NOH_DRAW_OPAQUE);
    expect_color(lit_quad_at(rgba, LIT_QUAD_SIDE / 2u), encoded(0.25 * 0.8), encoded(0.6), encoded(0.5 * 0.4));
    free(rgba);
    q.alpha = MODEL_ALPHA_MASK;
    for (int below = 0; below < 2; below++) { /* alpha too: 0.75 of 1 against the cutoff */
        q.cutoff = below ? 0.8f : 0.7f;
        rgba = drawn(&q, NOH_DRAW_OPAQUE);
        assert_int_equal(draws_nothing(rgba), below);
        free(rgba);
    }
}

/* Blended materials are drawn in the pass for them, over what is there. */
static void blended_materials_have_a_pass_of_their_own(void **state)
{
    static const double background[3] = { 0.075, 0.078, 0.085 };
    lit_quad q = lit_quad_of();
    uint8_t *rgba;
    (void)state;
    q.unlit = 1;
    q.alpha = MODEL_ALPHA_BLEND;
    q.base[3] = 0.25f;
    rgba = drawn(&q, NOH_DRAW_OPAQUE);
    assert_true(draws_nothing(rgba));
    free(rgba);
    rgba = drawn(&q, NOH_DRAW_BLENDED);
    expect_color(lit_quad_at(rgba, 5), encoded(0.25 * 0.8 + 0.75 * background[0]),
                 encoded(0.25 * 0.6 + 0.75 * background[1]), encoded(0.25 * 0.4 + 0.75 * background[2]));
    free(rgba);
    q.alpha = MODEL_ALPHA_OPAQUE;
    rgba = drawn(&q, NOH_DRAW_BLENDED);
    assert_true(draws_nothing(rgba));
    free(rgba);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(metal_and_roughness_are_each_its_own),
    cmocka_unit_test(what_is_unlit_is_its_color),
    cmocka_unit_test(masked_materials_are_cut_off),
    cmocka_unit_test(two_sided_materials_are_seen_from_behind),
    cmocka_unit_test(mirrored_worlds_keep_their_front),
    cmocka_unit_test(textures_are_looked_up_at_the_uvs),
    cmocka_unit_test(vertex_colors_multiply_the_base),
    cmocka_unit_test(blended_materials_have_a_pass_of_their_own),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
