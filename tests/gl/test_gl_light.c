/* test_gl_light.c: the lit renderer against closed forms: a furnace, a plane and a wall, the fitted integral of GGX,
 * the shadow of a square. */
#include "support/light_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/math_internal.h"
#include "gl/draw/gl_light_internal.h"

static void open_scene(scene *s, const noh_environment *environment, uint32_t shadow_px, const float values[4])
{
    const model_material material = scene_material(values);
    scene_open(s, &material, environment, shadow_px, NULL);
}

/* ---- even light ---- */

static void a_furnace_is_white_at_every_pixel(void **state)
{
    static const float materials[][4] = { { 1.0f, 1.0f, 0.0f, 0.04f },
                                          { 1.0f, 0.3f, 0.0f, 0.04f },
                                          { 1.0f, 0.6f, 0.0f, 0.0f },
                                          { 1.0f, 0.5f, 1.0f, 0.04f } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(materials); i++) {
        scene s;
        noh_light light;
        noh_lighting lighting;
        uint8_t *rgba;
        uint32_t covered = 0;
        open_scene(&s, noh_environment_at(0), 0, materials[i]);
        noh_light_from_environment(noh_environment_at(0), 6, &light);
        noh_lighting_make(&light, NULL, 1, &lighting);
        rgba = scene_draw(&s, SPHERE, scene_identity, &lighting);
        for (uint32_t p = 0; p < SIDE * SIDE; p++) {
            const double x = pixel_at(p % SIDE), y = pixel_at(p / SIDE);
            if (x * x + y * y > 0.96 * 0.96) continue;
            covered++;
            for (int c = 0; c < 3; c++) assert_true(rgba[4 * p + (uint32_t)c] >= encoded(0.99) - 0.5);
        }
        assert_true(covered > 2500);
        free(rgba);
        scene_close(&s);
    }
}

/* The integrals that noh_albedo_of is fitted to, by Hammersley points over half vectors. */
static void integrate(double roughness, double nv, double *all, double *edge)
{
    enum { POINTS = 4096 };
    const double a2 = pow(roughness, 4.0), sine = sqrt(1.0 - nv * nv);
    *all = *edge = 0.0;
    for (uint32_t i = 0; i < POINTS; i++) {
        uint32_t bits = 0;
        for (uint32_t k = 0; k < 12; k++) bits |= (i >> k & 1u) << (11u - k);
        const double u = (i + 0.5) / POINTS, azimuth = 2.0 * PI * bits / POINTS;
        const double nh = sqrt((1.0 - u) / (1.0 + (a2 - 1.0) * u));
        const double vh = fmax(sine * sqrt(1.0 - nh * nh) * cos(azimuth) + nv * nh, 1e-9), nl = 2.0 * vh * nh - nv;
        double v, weight, fresnel;
        if (nl <= 0.0) continue;
        v = 0.5 / (nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2));
        weight = v * nl * 4.0 * vh / nh / POINTS;
        fresnel = pow(1.0 - vh, 5.0);
        *all += weight;
        *edge += weight * fresnel;
    }
}

/* What black, and half-metal, spheres gloss with under even light: the fit against the integral, through the GPU. */
static void the_fitted_integral_is_near(void **state)
{
    static const float roughnesses[] = { 0.08f, 0.2f, 0.35f, 0.5f, 0.65f, 0.8f, 1.0f };
    double worst = 0.0;
    (void)state;
    for (size_t i = 0; i < 2 * TEST_COUNT(roughnesses); i++) {
        const int metal = i % 2;
        const float material[4] = { metal ? 0.5f : 0.0f, roughnesses[i / 2], metal ? 1.0f : 0.0f, 0.0f };
        scene s;
        noh_light light;
        noh_lighting lighting;
        uint8_t *rgba;
        open_scene(&s, noh_environment_at(0), 0, material);
        noh_light_from_environment(noh_environment_at(0), 6, &light);
        noh_lighting_make(&light, NULL, 1, &lighting);
        rgba = scene_draw(&s, SPHERE, scene_identity, &lighting);
        for (uint32_t x = SIDE / 2; x < SIDE * 97 / 100; x++) {
            const double at = pixel_at(x), nv = sqrt(1.0 - at * at);
            double all, edge, right, found;
            integrate((double)material[1], nv, &all, &edge);
            right = metal ? (0.5 * (all - edge) + edge) * (1.0 + 0.5 * (1.0 / all - 1.0)) : edge;
            found = decoded(rgba[4 * (SIDE / 2 * SIDE + x)]);
            worst = fmax(worst, fabs(found - right));
        }
        free(rgba);
        scene_close(&s);
    }
    print_message("the fit is off by %.4f at most\n", worst);
    assert_true(worst < 0.03);
}

/* Skin, whose reflectance is low, has shorter polynomials: x to the right is nv, y upwards the roughness. */
static void the_integral_of_skin_is_near(void **state)
{
    static const char own[] = "layout(location = 0) out vec4 o_color;\n"
                              "void main()\n"
                              "{\n"
                              "    vec2 at = gl_FragCoord.xy / 65.0;\n"
                              "    o_color = vec4(noh_encode(vec3(noh_albedo_of(at.y, at.x), 0.0)), 1.0);\n"
                              "}\n";
    static const float values[4] = { 1.0f, 1.0f, 0.0f, 0.0f }, front[3] = { 0.0f, 0.0f, 1.0f };
    model_material skin = scene_material(values);
    double worst[2] = { 0.0, 0.0 };
    noh_lighting lighting;
    uint8_t *rgba;
    scene s;
    (void)state;
    skin.surface = NOH_SURFACE_SKIN;
    scene_open(&s, &skin, &scene_black, 0, own);
    key_alone(front, &lighting);
    rgba = scene_draw(&s, SQUARE, scene_identity, &lighting);
    for (uint32_t row = 0; row < SIDE; row += 4) {
        for (uint32_t x = 1; x < SIDE; x += 4) {
            const double roughness = 0.5 - 0.5 * pixel_at(row), nv = 0.5 + 0.5 * pixel_at(x);
            const uint8_t *pixel = rgba + 4 * (row * SIDE + x);
            double right[2];
            if (roughness < 0.08) continue;
            integrate(roughness, nv, &right[0], &right[1]);
            for (int i = 0; i < 2; i++) worst[i] = fmax(worst[i], fabs(decoded(pixel[i]) - right[i]));
        }
    }
    print_message("skin's fit is off by %.4f and %.4f at most\n", worst[0], worst[1]);
    assert_true(worst[0] < 0.075 && worst[1] < 0.055);
    free(rgba);
    scene_close(&s);
}

/* ---- a plane and a wall ---- */

/* A hemisphere of light above: what faces up reflects all of it, a wall half, a ceiling none. */
static void a_plane_and_a_wall_are_the_analytic_ones(void **state)
{
    static const noh_environment half = { .name = "half",
                                          .lamp_count = 1,
                                          .lamps = { { { 0, 1, 0 }, 0, 0, { 1, 1, 1 } } } };
    static const float flat[4] = { 1.0f, 1.0f, 0.0f, 0.0f };
    scene s;
    noh_light light;
    noh_lighting lighting;
    (void)state;
    open_scene(&s, &scene_black, 0, flat);
    noh_light_from_environment(&half, 6, &light);
    for (int degrees = 0; degrees <= 180;
         degrees += 15) { /* of the light's turn: up, then towards the square's front */
        const float sn = (float)sin(degrees * PI / 180.0), cs = (float)cos(degrees * PI / 180.0);
        const float turn[9] = { 1, 0, 0, 0, cs, -sn, 0, sn, cs };
        const double right = encoded(0.5 * (1.0 + (double)sn));
        uint8_t *rgba;
        noh_lighting_make(&light, turn, 0, &lighting);
        rgba = scene_draw(&s, SQUARE, scene_identity, &lighting);
        for (uint32_t p = 0; p < SIDE * SIDE; p++) assert_true(fabs(rgba[4 * p] - right) <= 1.5);
        free(rgba);
    }
    scene_close(&s);
}

/* The cosine law, and the sum of key and rest. */
static void a_key_light_falls_by_the_cosine(void **state)
{
    static const float flat[4] = { 1.0f, 1.0f, 0.0f, 0.0f };
    scene s;
    (void)state;
    open_scene(&s, &scene_black, 0, flat);
    for (int degrees = -100; degrees <= 100; degrees += 10) {
        const double a = degrees * PI / 180.0;
        noh_light none;
        noh_lighting lighting;
        uint8_t *rgba;
        memset(&none, 0, sizeof none);
        none.order = 3;
        noh_lighting_make(&none, NULL, 1, &lighting);
        lighting.key_direction[0] = (float)sin(a);
        lighting.key_direction[1] = 0.0f;
        lighting.key_direction[2] = (float)cos(a);
        lighting.key[0] = 0.9f;
        lighting.key[1] = 0.5f;
        rgba = scene_draw(&s, SQUARE, scene_identity, &lighting);
        for (uint32_t p = 0; p < SIDE * SIDE; p++) {
            if (fabs(rgba[4 * p] - encoded(0.9 * cos(a))) > 1.5)
                fail_msg("%d degrees: %u, not %.1f", degrees, rgba[4 * p], encoded(0.9 * cos(a)));
            assert_true(fabs(rgba[4 * p + 1] - encoded(0.5 * cos(a))) <= 1.5);
            assert_true(rgba[4 * p + 2] <= 1);
        }
        free(rgba);
    }
    scene_close(&s);
}

/* ---- the shadow map ---- */

#define SHADOW_PX 256u

/* Draw the shadow map of a mesh, and of the square at `above`, if any, in light from a direction, within a sphere. */
static void cast_shadow(scene *s, int mesh, const float above[12], const float sphere[4], const float to_light[3],
                        noh_lighting *lighting)
{
    noh_stage_view view;
    noh_gl_camera from_light = scene_front();
    noh_view_shadow(&view, sphere, to_light);
    noh_lighting_shadow(lighting, view.view_projection, sphere[3], SHADOW_PX);
    memcpy(from_light.view_projection, view.view_projection, sizeof view.view_projection);
    noh_gl_light_begin_shadow(&s->light);
    noh_gl_draw_begin(&s->renderer, &from_light);
    scene_draw_mesh(s, mesh, scene_identity, NOH_DRAW_DEPTH);
    if (above) scene_draw_mesh(s, SQUARE, above, NOH_DRAW_DEPTH);
    noh_gl_draw_end(&s->renderer);
    noh_gl_light_end_shadow(&s->light, view.view_projection, lighting);
}

/* A square of half a side 0.3 floats 0.8 above one that fills the picture; the light comes aslant. */
static void a_square_casts_its_shadow(void **state)
{
    static const float flat[4] = { 1.0f, 1.0f, 0.0f, 0.0f }, sphere[4] = { 0.0f, 0.0f, 0.0f, 1.6f };
    const float above[12] = { 0.3f, 0, 0, 0, 0, 0.3f, 0, 0, 0, 0, 1, 0.8f };
    const float to_light[3] = { 0.48f, 0.36f, 0.8f };
    const double shift[2] = { -0.8 * 0.48 / 0.8, -0.8 * 0.36 / 0.8 }, texel = 2.0 * 1.6 / SHADOW_PX;
    noh_lighting lighting;
    uint32_t dark = 0, lit = 0;
    uint8_t *rgba;
    scene s;
    (void)state;
    open_scene(&s, &scene_black, SHADOW_PX, flat);
    key_alone(to_light, &lighting);
    cast_shadow(&s, SQUARE, above, sphere, to_light, &lighting);
    rgba = scene_draw(&s, SQUARE, scene_identity, &lighting);
    for (uint32_t p = 0; p < SIDE * SIDE; p++) {
        const double x = pixel_at(p % SIDE) - shift[0], y = -pixel_at(p / SIDE) - shift[1];
        const double out = fmax(fabs(x), fabs(y)) - 0.3; /* of the shadow, as far as its edge */
        if (fabs(out) < 4.0 * texel + 1.0 / SIDE) continue;
        if (out < 0.0) {
            assert_true(rgba[4 * p] <= 1);
            dark++;
        } else {
            assert_true(fabs(rgba[4 * p] - encoded(0.9 * 0.8)) <= 1.5);
            lit++;
        }
    }
    assert_true(dark > 150 && lit > 2500);
    free(rgba);
    scene_close(&s);
}

/* How many pixels of the lit square are between dark and lit where the square above, this high, casts its shadow; with
 * those as dark as light that does not reach them, and those in full light. */
static uint32_t edge_pixels(float height, uint32_t *dark, uint32_t *lit)
{
    static const float flat[4] = { 1.0f, 1.0f, 0.0f, 0.0f }, sphere[4] = { 0.0f, 0.0f, 0.0f, 1.6f };
    const float above[12] = { 0.3f, 0, 0, 0, 0, 0.3f, 0, 0, 0, 0, 1, height }, to_light[3] = { 0.0f, 0.0f, 1.0f };
    noh_lighting lighting;
    uint32_t between = 0;
    scene s;
    open_scene(&s, &scene_black, SHADOW_PX | SCENE_SOFT, flat);
    key_alone(to_light, &lighting);
    cast_shadow(&s, SQUARE, above, sphere, to_light, &lighting);
    uint8_t *rgba = scene_draw(&s, SQUARE, scene_identity, &lighting);
    *dark = *lit = 0;
    for (uint32_t p = 0; p < SIDE * SIDE; p++) {
        const double x = pixel_at(p % SIDE), y = pixel_at(p / SIDE), out = fmax(fabs(x), fabs(y)) - 0.3;
        const int is_dark = rgba[4 * p] <= 1, is_lit = fabs(rgba[4 * p] - encoded(0.9)) <= 2.0;
        if (out < -0.16) assert_true(is_dark);
        if (out > 0.16) assert_true(is_lit);
        *dark += (uint32_t)is_dark;
        *lit += (uint32_t)is_lit;
        between += !is_dark && !is_lit;
    }
    free(rgba);
    scene_close(&s);
    return between;
}

/* A penumbra grows with the distance of what casts it. */
static void a_soft_shadow_is_harder_where_things_touch(void **state)
{
    uint32_t dark[2], lit[2];
    (void)state;
    if (!fixture_gpu()->caps.render_f16) test_skip("no half floats can be drawn to");
    const uint32_t near_by = edge_pixels(0.05f, &dark[0], &lit[0]), far = edge_pixels(0.8f, &dark[1], &lit[1]);
    print_message("pixels of a penumbra: near %u, far %u; dark %u and %u, lit %u and %u\n", near_by, far, dark[0],
                  dark[1], lit[0], lit[1]);
    assert_true(near_by > 0 && 3 * near_by < 2 * far);
    assert_true(dark[1] > 60 && dark[0] > dark[1] && lit[0] > lit[1]);
}

/* A sphere shadows its own far side and never its near side. */
static void check_itself(uint32_t shadow_px)
{
    static const float flat[4] = { 1.0f, 1.0f, 0.0f, 0.0f }, all[4] = { 0.0f, 0.0f, 0.0f, 1.1f };
    const float to_light[3] = { 0.6f, 0.0f, 0.8f };
    noh_lighting lighting;
    scene s;
    uint8_t *with, *without;
    open_scene(&s, &scene_black, shadow_px, flat);
    key_alone(to_light, &lighting);
    without = scene_draw(&s, SPHERE, scene_identity, &lighting);
    cast_shadow(&s, SPHERE, NULL, all, to_light, &lighting);
    with = scene_draw(&s, SPHERE, scene_identity, &lighting);
    for (uint32_t p = 0; p < SIDE * SIDE; p++) {
        const double x = pixel_at(p % SIDE), y = pixel_at(p / SIDE), z2 = 1.0 - x * x - y * y;
        if (z2 < 0.05 || 0.6 * x + 0.8 * sqrt(z2) < 0.25) continue; /* off, or where light grazes */
        assert_true(abs(with[4 * p] - without[4 * p]) <= 2);
    }
    free(with);
    free(without);
    scene_close(&s);
}

static void no_surface_shadows_itself(void **state)
{
    (void)state;
    check_itself(SHADOW_PX);
    check_itself(SHADOW_PX | SCENE_SOFT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_furnace_is_white_at_every_pixel),
        cmocka_unit_test(the_fitted_integral_is_near),
        cmocka_unit_test(the_integral_of_skin_is_near),
        cmocka_unit_test(a_plane_and_a_wall_are_the_analytic_ones),
        cmocka_unit_test(a_key_light_falls_by_the_cosine),
        cmocka_unit_test(a_square_casts_its_shadow),
        cmocka_unit_test(a_soft_shadow_is_harder_where_things_touch),
        cmocka_unit_test(no_surface_shadows_itself),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
