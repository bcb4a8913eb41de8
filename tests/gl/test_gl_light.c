/* test_gl_light.c: the lit renderer against closed forms: a furnace, a plane and a wall, the fitted integral of GGX,
 * the shadow of a square. */
#include "support/gl_fixture.h"
#include "support/renderer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/math_internal.h"
#include "gpu/canvas.h"

#define SIDE 65u
#define PI 3.14159265358979323846

static double encoded(double linear)
{
    const double c = fmin(fmax(linear, 0.0), 1.0);
    return 255.0 * (c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1.0 / 2.4) - 0.055);
}

/* ---- a scene: a sphere of radius 1, a square of half a side 1 that faces +z ---- */

enum { SPHERE, SQUARE, MESHES };

typedef struct scene {
    gpu *g;
    uint8_t *bytes;
    noh_pack pack;
    noh_mesh meshes[MESHES];
    noh_gl_mesh drawn[MESHES];
    noh_gl_renderer renderer;
    noh_reflection reflection;
    noh_gl_light light;
    noh_gl_ledger ledger;
    canvas canvas;
} scene;

static void fill_sphere(model_mesh *m, uint32_t side)
{
    for (uint32_t v = 0; v < side * side; v++) {
        const double a = 2.0 * PI * (v % side) / (side - 1u), b = PI * (v / side) / (side - 1u) - PI / 2.0;
        const double at[3] = { cos(b) * sin(a), sin(b), cos(b) * cos(a) };
        for (int k = 0; k < 3; k++) m->position[3 * v + (uint32_t)k] = m->normal[3 * v + (uint32_t)k] = (float)at[k];
    }
}

static void fill_square(model_mesh *m, uint32_t side)
{
    for (uint32_t v = 0; v < side * side; v++) {
        const float at[3] = { 2.0f * (float)(v % side) / (float)(side - 1u) - 1.0f,
                              2.0f * (float)(v / side) / (float)(side - 1u) - 1.0f, 0.0f };
        const float normal[3] = { 0.0f, 0.0f, 1.0f };
        memcpy(m->position + 3 * v, at, sizeof at);
        memcpy(m->normal + 3 * v, normal, sizeof normal);
    }
}

static uint8_t *make_pack(float albedo, float roughness, float metallic, float f0, size_t *count)
{
    const test_model_desc desc = { MESHES, 65, 0, 0, 1 };
    model *m = test_model(&desc);
    model_material *material = m->materials = test_zeros(sizeof *m->materials);
    uint8_t *bytes;
    *material = model_material_default();
    m->material_count = 1;
    material->name = model_string("ball");
    for (int k = 0; k < 3; k++) {
        material->base_color[k] = albedo;
        material->f0[k] = f0;
    }
    material->roughness = roughness;
    material->metallic = metallic;
    material->double_sided = 1;
    fill_sphere(&m->meshes[SPHERE], 65);
    fill_square(&m->meshes[SQUARE], 71);
    for (int i = 0; i < MESHES; i++) m->meshes[i].submeshes[0].material = 0;
    bytes = test_pack_of(m, count, NULL);
    model_free(m);
    return bytes;
}

static void open_scene(scene *s, const noh_environment *environment, uint32_t shadow_px, const float material[4])
{
    static __attribute__((aligned(16))) uint32_t texels[2 * 6 * 32 * 32];
    static __attribute__((aligned(16))) uint8_t scratch[3 * 4 * 2 * 6 * 32 * 32];
    const noh_reflection_desc baked = { 32, noh_reflection_of_environment, environment };
    const noh_gl_light_desc desc = { &s->reflection, shadow_px };
    noh_gl_renderer_desc d;
    char log[1024] = "";
    size_t count;
    memset(s, 0, sizeof *s);
    memset(&d, 0, sizeof d);
    s->g = fixture_gpu();
    s->bytes = make_pack(material[0], material[1], material[2], material[3], &count);
    s->pack = test_open(s->bytes, count);
    for (uint32_t i = 0; i < MESHES; i++) {
        s->meshes[i] = test_mesh(&s->pack, i);
        assert_int_equal(noh_gl_mesh_create(&s->g->gl, &s->ledger, &s->meshes[i], &s->drawn[i], NULL), NOH_OK);
    }
    assert_int_equal(noh_reflection_init(texels, sizeof texels, scratch, sizeof scratch, &baked, &s->reflection, NULL),
                     NOH_OK);
    const noh_gl_device device = { &s->g->gl, NULL, &s->ledger, log, sizeof log };
    const uint64_t before = noh_gl_ledger_bytes(&s->ledger);
    assert_int_equal(noh_gl_light_create(&device, &desc, &s->light, NULL), NOH_OK);
    assert_int_equal(noh_gl_ledger_bytes(&s->ledger) - before, noh_gl_light_bytes(&desc));
    d.meshes = s->meshes;
    d.mesh_count = MESHES;
    d.lit = 1;
    d.passes = NOH_PASSES_ALL;
    if (renderer_create(&device, &d, &s->renderer, NULL)) fail_msg("%s", log);
    assert_int_equal(canvas_open(&s->canvas, s->g, SIDE, SIDE), 0);
}

static void close_scene(scene *s)
{
    canvas_close(&s->canvas);
    noh_gl_renderer_delete(&s->renderer);
    noh_gl_light_delete(&s->light);
    for (int i = 0; i < MESHES; i++) noh_gl_mesh_delete(&s->g->gl, &s->ledger, &s->drawn[i]);
    assert_int_equal(noh_gl_ledger_bytes(&s->ledger), 0);
    free(s->bytes);
    fixture_expect_no_errors();
}

/* Parallel, along -z, of -1..1 in x and y. */
static noh_gl_camera front(void)
{
    noh_gl_camera c;
    memset(&c, 0, sizeof c);
    c.view_projection[0] = c.view_projection[5] = c.view_projection[15] = 1.0f;
    c.view_projection[10] = -0.1f;
    c.eye[2] = 1000.0f;
    return c;
}

static void draw_mesh(scene *s, int mesh, const float world[12], int pass)
{
    noh_gl_texture none[1];
    memset(none, 0, sizeof none);
    noh_gl_draw_mesh(&s->renderer, &s->drawn[mesh], world, NULL, NULL, NULL, none, pass);
}

/* rgba[SIDE][SIDE][4], to be freed. */
static uint8_t *draw(scene *s, int mesh, const float world[12], const noh_lighting *lighting)
{
    const noh_gl_camera camera = front();
    uint8_t *rgba = test_zeros(SIDE * SIDE * 4);
    canvas_begin(&s->canvas);
    noh_gl_renderer_light(&s->renderer, &s->light, lighting);
    noh_gl_draw_begin(&s->renderer, &camera);
    draw_mesh(s, mesh, world, NOH_DRAW_OPAQUE);
    noh_gl_draw_end(&s->renderer);
    assert_int_equal(canvas_read(&s->canvas, rgba), 0);
    return rgba;
}

static const float identity[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
static const noh_environment black = { .name = "black" };

static double pixel_at(uint32_t i)
{
    return (2.0 * i + 1.0) / SIDE - 1.0;
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
        rgba = draw(&s, SPHERE, identity, &lighting);
        for (uint32_t p = 0; p < SIDE * SIDE; p++) {
            const double x = pixel_at(p % SIDE), y = pixel_at(p / SIDE);
            if (x * x + y * y > 0.96 * 0.96) continue;
            covered++;
            for (int c = 0; c < 3; c++) assert_true(rgba[4 * p + (uint32_t)c] >= encoded(0.99) - 0.5);
        }
        assert_true(covered > 2500);
        free(rgba);
        close_scene(&s);
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
        rgba = draw(&s, SPHERE, identity, &lighting);
        for (uint32_t x = SIDE / 2; x < SIDE * 97 / 100; x++) {
            const double at = pixel_at(x), nv = sqrt(1.0 - at * at);
            double all, edge, right, found;
            integrate((double)material[1], nv, &all, &edge);
            right = metal ? (0.5 * (all - edge) + edge) * (1.0 + 0.5 * (1.0 / all - 1.0)) : edge;
            found = rgba[4 * (SIDE / 2 * SIDE + x)] / 255.0;
            found = found <= 0.04045 ? found / 12.92 : pow((found + 0.055) / 1.055, 2.4);
            worst = fmax(worst, fabs(found - right));
        }
        free(rgba);
        close_scene(&s);
    }
    print_message("the fit is off by %.4f at most\n", worst);
    assert_true(worst < 0.03);
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
    open_scene(&s, &black, 0, flat);
    noh_light_from_environment(&half, 6, &light);
    for (int degrees = 0; degrees <= 180;
         degrees += 15) { /* of the light's turn: up, then towards the square's front */
        const float sn = (float)sin(degrees * PI / 180.0), cs = (float)cos(degrees * PI / 180.0);
        const float turn[9] = { 1, 0, 0, 0, cs, -sn, 0, sn, cs };
        const double right = encoded(0.5 * (1.0 + (double)sn));
        uint8_t *rgba;
        noh_lighting_make(&light, turn, 0, &lighting);
        rgba = draw(&s, SQUARE, identity, &lighting);
        for (uint32_t p = 0; p < SIDE * SIDE; p++) assert_true(fabs(rgba[4 * p] - right) <= 1.5);
        free(rgba);
    }
    close_scene(&s);
}

/* The cosine law, and the sum of key and rest. */
static void a_key_light_falls_by_the_cosine(void **state)
{
    static const float flat[4] = { 1.0f, 1.0f, 0.0f, 0.0f };
    scene s;
    (void)state;
    open_scene(&s, &black, 0, flat);
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
        rgba = draw(&s, SQUARE, identity, &lighting);
        for (uint32_t p = 0; p < SIDE * SIDE; p++) {
            if (fabs(rgba[4 * p] - encoded(0.9 * cos(a))) > 1.5)
                fail_msg("%d degrees: %u, not %.1f", degrees, rgba[4 * p], encoded(0.9 * cos(a)));
            assert_true(fabs(rgba[4 * p + 1] - encoded(0.5 * cos(a))) <= 1.5);
            assert_true(rgba[4 * p + 2] <= 1);
        }
        free(rgba);
    }
    close_scene(&s);
}

/* ---- the shadow map ---- */

#define SHADOW_PX 256u

/* Light from nowhere but the key. */
static void key_alone(const float to_light[3], noh_lighting *lighting)
{
    noh_light none;
    memset(&none, 0, sizeof none);
    none.order = 3;
    noh_lighting_make(&none, NULL, 1, lighting);
    memcpy(lighting->key_direction, to_light, sizeof lighting->key_direction);
    for (int c = 0; c < 3; c++) lighting->key[c] = 0.9f;
}

/* A square of half a side 0.3 floats 0.8 above one that fills the picture; the light comes aslant. */
static void a_square_casts_its_shadow(void **state)
{
    static const float flat[4] = { 1.0f, 1.0f, 0.0f, 0.0f }, sphere[4] = { 0.0f, 0.0f, 0.0f, 1.6f };
    const float above[12] = { 0.3f, 0, 0, 0, 0, 0.3f, 0, 0, 0, 0, 1, 0.8f };
    const float to_light[3] = { 0.48f, 0.36f, 0.8f };
    const double shift[2] = { -0.8 * 0.48 / 0.8, -0.8 * 0.36 / 0.8 }, texel = 2.0 * 1.6 / SHADOW_PX;
    noh_stage_view view;
    noh_gl_camera from_light = front();
    noh_lighting lighting;
    uint32_t dark = 0, lit = 0;
    uint8_t *rgba;
    scene s;
    (void)state;
    open_scene(&s, &black, SHADOW_PX, flat);
    key_alone(to_light, &lighting);
    noh_view_shadow(&view, sphere, to_light);
    noh_lighting_shadow(&lighting, view.view_projection, sphere[3], SHADOW_PX);
    memcpy(from_light.view_projection, view.view_projection, sizeof view.view_projection);
    noh_gl_light_begin_shadow(&s.light);
    noh_gl_draw_begin(&s.renderer, &from_light);
    draw_mesh(&s, SQUARE, identity, NOH_DRAW_DEPTH);
    draw_mesh(&s, SQUARE, above, NOH_DRAW_DEPTH);
    noh_gl_draw_end(&s.renderer);
    noh_gl_light_end_shadow(&s.light);
    rgba = draw(&s, SQUARE, identity, &lighting);
    for (uint32_t p = 0; p < SIDE * SIDE; p++) {
        const double x = pixel_at(p % SIDE) - shift[0], y = -pixel_at(p / SIDE) - shift[1];
        const double out = fmax(fabs(x), fabs(y)) - 0.3; /* of the shadow, as far as its edge */
        if (fabs(out) < 3.0 * texel + 1.0 / SIDE) continue;
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
    close_scene(&s);
}

/* A sphere shadows its own far side and nothing of its near one. */
static void no_surface_shadows_itself(void **state)
{
    static const float flat[4] = { 1.0f, 1.0f, 0.0f, 0.0f }, all[4] = { 0.0f, 0.0f, 0.0f, 1.1f };
    const float to_light[3] = { 0.6f, 0.0f, 0.8f };
    noh_stage_view view;
    noh_gl_camera from_light = front();
    noh_lighting lighting;
    scene s;
    uint8_t *with, *without;
    (void)state;
    open_scene(&s, &black, SHADOW_PX, flat);
    key_alone(to_light, &lighting);
    without = draw(&s, SPHERE, identity, &lighting);
    noh_view_shadow(&view, all, to_light);
    noh_lighting_shadow(&lighting, view.view_projection, all[3], SHADOW_PX);
    memcpy(from_light.view_projection, view.view_projection, sizeof view.view_projection);
    noh_gl_light_begin_shadow(&s.light);
    noh_gl_draw_begin(&s.renderer, &from_light);
    draw_mesh(&s, SPHERE, identity, NOH_DRAW_DEPTH);
    noh_gl_draw_end(&s.renderer);
    noh_gl_light_end_shadow(&s.light);
    with = draw(&s, SPHERE, identity, &lighting);
    for (uint32_t p = 0; p < SIDE * SIDE; p++) {
        const double x = pixel_at(p % SIDE), y = pixel_at(p / SIDE), z2 = 1.0 - x * x - y * y;
        if (z2 < 0.05 || 0.6 * x + 0.8 * sqrt(z2) < 0.25) continue; /* off, or where light grazes */
        assert_true(abs(with[4 * p] - without[4 * p]) <= 2);
    }
    free(with);
    free(without);
    close_scene(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_furnace_is_white_at_every_pixel),
        cmocka_unit_test(the_fitted_integral_is_near),
        cmocka_unit_test(a_plane_and_a_wall_are_the_analytic_ones),
        cmocka_unit_test(a_key_light_falls_by_the_cosine),
        cmocka_unit_test(a_square_casts_its_shadow),
        cmocka_unit_test(no_surface_shadows_itself),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
