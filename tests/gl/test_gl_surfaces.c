/* test_gl_surfaces.c: skin, eyes, teeth and toons against closed forms and our own integrals: scatter, through its
 * function and on a ball; a furnace; the lamp in an eye; the iris behind its cornea; highlights of hair; teeth behind
 * lips, and cheeks. */
#include "support/light_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/format.h"
#include "noh/light.h"
#include "noh/noh_gl.h"

/* ---- scatter ---- */

/* d'Eon and Luebke's profile of skin: variances in mm^2, weights by channel. */
static const double variances[6] = { 0.0064, 0.0484, 0.187, 0.567, 1.99, 7.41 };
static const double shares[6][3] = { { 0.233, 0.455, 0.649 }, { 0.100, 0.336, 0.344 }, { 0.118, 0.198, 0.0 },
                                     { 0.113, 0.007, 0.007 }, { 0.358, 0.004, 0.0 },   { 0.078, 0.0, 0.0 } };

/* What noh_scatter is fitted to: max(cos, 0) over a ring of that curvature, 1/mm, weighted by the profile. The steps
 * grow by the cube: the narrowest Gaussian is 0.08 mm wide. */
static void integrate(double nl, double curvature, double out[3])
{
    enum { STEPS = 3000 };
    const double angle = acos(nl);
    double sum[3] = { 0 }, all[3] = { 0 };
    for (int i = 0; i < STEPS; i++) {
        const double t = 2.0 * (i + 0.5) / STEPS - 1.0, x = PI * t * t * t;
        const double chord = 2.0 / curvature * sin(0.5 * x), light = fmax(cos(angle + x), 0.0), width = 3.0 * t * t;
        for (int g = 0; g < 6; g++) {
            const double at = width * exp(-chord * chord / (2.0 * variances[g])) / variances[g];
            for (int c = 0; c < 3; c++) {
                sum[c] += shares[g][c] * at * light;
                all[c] += shares[g][c] * at;
            }
        }
    }
    for (int c = 0; c < 3; c++) out[c] = sum[c] / all[c];
}

static model_material skin_of(const float values[4], float unit_mm)
{
    model_material m = scene_material(values);
    m.surface = NOH_SURFACE_SKIN;
    m.surface_values[0] = unit_mm;
    return m;
}

static void the_fit_of_scatter_is_near_its_integral(void **state)
{
    static const char own[] = "layout(location = 0) out vec4 o_color;\n"
                              "void main()\n"
                              "{\n"
                              "    vec2 at = gl_FragCoord.xy / 65.0;\n"
                              "    o_color = vec4(noh_encode(noh_scatter(vec3(2.0 * at.x - 1.0), at.y)), 1.0);\n"
                              "}\n";
    static const float values[4] = { 1.0f, 1.0f, 0.0f, 0.0f };
    const model_material skin = skin_of(values, 0.0f);
    double worst = 0.0;
    uint8_t *rgba;
    scene s;
    (void)state;
    scene_open(&s, &skin, NULL, 0, own);
    rgba = scene_draw(&s, SQUARE, scene_identity, NULL);
    for (uint32_t row = 0; row < SIDE; row += 4) {
        for (uint32_t x = 0; x < SIDE; x += 2) {
            double right[3];
            integrate(pixel_at(x), 0.5 - 0.5 * pixel_at(row), right);
            for (uint32_t c = 0; c < 3; c++) {
                worst = fmax(worst, fabs(decoded(rgba[4 * (row * SIDE + x) + c]) - right[c]));
            }
        }
    }
    print_message("the fit is off by %.4f at most\n", worst);
    assert_true(worst < 0.02);
    free(rgba);
    scene_close(&s);
}

/* Through curvature by derivatives: a ball of 5 mm, lit from the right, red beyond the edge of the light. */
static void a_ball_of_skin_scatters_as_its_curvature_says(void **state)
{
    static const float values[4] = { 1.0f, 1.0f, 0.0f, 0.0f }, right[3] = { 1.0f, 0.0f, 0.0f };
    const model_material skin = skin_of(values, 5.0f);
    noh_lighting lighting;
    double worst = 0.0, plain = 0.0;
    uint8_t *rgba;
    scene s;
    (void)state;
    scene_open(&s, &skin, &scene_black, 0, NULL);
    key_alone(right, &lighting);
    rgba = scene_draw(&s, SPHERE, scene_identity, &lighting);
    for (uint32_t x = SIDE / 6; x < SIDE - SIDE / 6; x++) {
        const uint8_t *pixel = rgba + 4 * ((size_t)(SIDE / 2) * SIDE + x);
        double should[3];
        integrate(pixel_at(x), 0.2, should);
        for (int c = 0; c < 3; c++) {
            worst = fmax(worst, fabs(decoded(pixel[c]) - 0.9 * should[c]));
            plain = fmax(plain, fabs(0.9 * fmax(pixel_at(x), 0.0) - 0.9 * should[c]));
        }
    }
    print_message("off by %.4f at most; without scatter by %.4f\n", worst, plain);
    assert_true(worst < 0.03 && plain > 2.0 * worst);
    free(rgba);
    scene_close(&s);
}

/* What is mirrored is taken from what is matte, in two lobes as in one. */
static void white_skin_in_a_furnace_is_white(void **state)
{
    static const float values[][4] = { { 1.0f, 0.3f, 0.0f, 0.028f }, { 1.0f, 0.6f, 0.0f, 0.028f } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(values); i++) {
        const model_material skin = skin_of(values[i], 100.0f);
        noh_light light;
        noh_lighting lighting;
        uint8_t *rgba;
        scene s;
        scene_open(&s, &skin, noh_environment_at(0), 0, NULL);
        noh_light_from_environment(noh_environment_at(0), 6, &light);
        noh_lighting_make(&light, NULL, 1, &lighting);
        rgba = scene_draw(&s, SPHERE, scene_identity, &lighting);
        for (uint32_t p = 0; p < SIDE * SIDE; p++) {
            const double x = pixel_at(p % SIDE), y = pixel_at(p / SIDE);
            if (x * x + y * y > 0.9 * 0.9) continue;
            for (uint32_t c = 0; c < 3; c++) assert_true(rgba[4 * p + c] >= encoded(0.99) - 0.5);
        }
        free(rgba);
        scene_close(&s);
    }
}

/* The light that a lamp's lobes send out, over all directions, is no more than Fresnel's share of it: the eye goes
 * around a point that is lit straight on. */
static void two_lobes_send_out_no_more_than_comes(void **state)
{
    static const float values[4] = { 0.0f, 0.5f, 0.0f, 0.028f }, front[3] = { 0.0f, 0.0f, 1.0f };
    const model_material skin = skin_of(values, 1000.0f);
    double sum = 0.0;
    noh_lighting lighting;
    scene s;
    (void)state;
    scene_open(&s, &skin, &scene_black, 0, NULL);
    key_alone(front, &lighting);
    for (int c = 0; c < 3; c++) lighting.key[c] = 4.0f;
    lighting.key_gloss = 1.0f;
    for (int i = 0; i < 45; i++) {
        const double angle = (2.0 * i + 1.0) * PI / 180.0;
        uint8_t *rgba;
        s.eye[0] = (float)(1e6 * sin(angle));
        s.eye[2] = (float)(1e6 * cos(angle));
        rgba = scene_draw(&s, SQUARE, scene_identity, &lighting);
        sum += decoded(rgba[4 * (SIDE / 2 * SIDE + SIDE / 2)]) / 4.0 * 2.0 * sin(angle) * cos(angle) * PI / 90.0;
        free(rgba);
    }
    print_message("%.4f of the light glosses, 0.028 where all facets lie flat\n", sum);
    assert_true(sum > 0.7 * 0.028 && sum < 1.4 * 0.028);
    scene_close(&s);
}

/* ---- eyes ---- */

#define RIM_SPREAD 1.7 /* 1.46 to 1.52 by processor; 2.9 with edges that are not as wide as a pixel */

#define IRIS 0.45f /* sine, and on a ball of radius 1 also the radius */

static model_material eye_of(float red, float green, float blue)
{
    static const float values[4] = { 1.0f, 0.1f, 0.0f, 0.025f };
    model_material m = scene_material(values);
    m.base_color[0] = red;
    m.base_color[1] = green;
    m.base_color[2] = blue;
    m.surface = NOH_SURFACE_EYE;
    m.surface_values[2] = m.surface_values[3] = IRIS;
    return m;
}

/* The middle of what is brighter than half of white, in -1..1; 0: nothing is. */
static int bright_spot(const uint8_t *rgba, double out[2])
{
    uint32_t count = 0;
    out[0] = out[1] = 0.0;
    for (uint32_t p = 0; p < SIDE * SIDE; p++) {
        const double x = pixel_at(p % SIDE), y = pixel_at(p / SIDE);
        if (x * x + y * y > 0.8 || decoded(rgba[4 * p + 2]) < 0.5) continue;
        out[0] += x;
        out[1] -= y;
        count++;
    }
    for (int c = 0; c < 2 && count; c++) out[c] /= count;
    return count > 4;
}

/* A lamp shows where a sphere of the cornea's radius mirrors it, not where the ball would; the iris keeps its colour.
 */
static void an_eye_shows_the_lamp(void **state)
{
    static const float keys[][3] = { { -0.45f, 0.62f, 0.64f }, { 0.3f, 0.5f, 0.81f }, { 0.0f, 0.35f, 0.94f } };
    const model_material eye = eye_of(0.12f, 0.06f, 0.02f);
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(keys); i++) {
        const double up = (double)keys[i][1] - 0.35, half[3] = { (double)keys[i][0], up, (double)keys[i][2] + 1.0 };
        const double across = hypot(half[0], half[1]), ball = atan(across / half[2] * 1.3 * (double)IRIS);
        double spot[2];
        const uint8_t *iris;
        uint8_t *rgba;
        scene s;
        scene_open(&s, &eye, NULL, 0, NULL);
        memcpy(s.key, keys[i], sizeof s.key);
        rgba = scene_draw(&s, SPHERE, scene_identity, NULL);
        assert_true(bright_spot(rgba, spot));
        for (int c = 0; c < 2; c++) assert_true(fabs(spot[c] - sin(ball) * half[c] / across) < 0.05);
        iris = rgba + 4 * ((size_t)(SIDE / 2 + 6) * SIDE + SIDE / 2);
        assert_true(fabs(decoded(iris[0]) / decoded(iris[1]) - 2.0) < 0.3);
        assert_true(decoded(iris[0]) / decoded(iris[2]) > 3.5);
        free(rgba);
        scene_close(&s);
    }
}

/* Straight before the pupil, the line of sight is bent by Snell's law, and meets the iris off-centre. */
static void the_iris_lies_behind_the_cornea(void **state)
{
    static const char own[] = "in vec3 v_world;\nin vec3 v_normal;\nin vec2 v_uv;\n"
                              "layout(location = 0) out vec4 o_color;\n"
                              "void main()\n"
                              "{\n"
                              "    vec2 shift = noh_eye_uv(v_world, v_normal, v_uv) - v_uv;\n"
                              "    o_color = vec4(noh_encode(vec3(0.5 + 4.0 * shift, 0.0)), 1.0);\n"
                              "}\n";
    static const int degrees[] = { 0, 15, -30, 45, 60 };
    const model_material eye = eye_of(1.0f, 1.0f, 1.0f);
    scene s;
    (void)state;
    scene_open(&s, &eye, NULL, 0, own);
    for (size_t i = 0; i < TEST_COUNT(degrees); i++) {
        const double angle = degrees[i] * PI / 180.0, deep = 0.45 * (double)IRIS;
        const double right = -0.5 * deep * tan(asin(sin(angle) / 1.336)); /* the texture is as wide as the ball */
        const uint8_t *pixel;
        uint8_t *rgba;
        s.eye[0] = (float)(1e6 * sin(angle));
        s.eye[2] = (float)(1e6 * cos(angle));
        rgba = scene_draw(&s, SPHERE, scene_identity, NULL);
        pixel = rgba + 4 * ((size_t)(SIDE / 2) * SIDE + SIDE / 2);
        assert_true(fabs((decoded(pixel[0]) - 0.5) / 4.0 - right) < 0.004);
        assert_true(fabs(decoded(pixel[1]) - 0.5) / 4.0 < 0.004);
        free(rgba);
    }
    scene_close(&s);
}

/* Lids darken the ball towards their edges, and only where they are known; so, too, in a mesh that has z up. */
static void lids_darken_the_ball(void **state)
{
    static const float z_up[12] = { 1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0 };
    model_material eye = eye_of(0.5f, 0.5f, 0.5f);
    uint8_t *rgba[3];
    (void)state;
    for (int i = 0; i < 3; i++) {
        scene s;
        eye.surface_values[1] = i == 2 ? -IRIS : 0.0f;
        eye.surface_values[2] = i == 2 ? 0.0f : IRIS;
        eye.surface_more[0] = i ? 0.5f : 0.0f;
        eye.surface_more[3] = i ? -0.4f : 0.0f;
        scene_open(&s, &eye, NULL, 0, NULL);
        s.key[1] = 0.6f;
        s.key[2] = -0.8f; /* from behind: no lamp in the eye */
        rgba[i] = scene_draw(&s, SPHERE, i == 2 ? z_up : scene_identity, NULL);
        scene_close(&s);
    }
    for (int i = 0; i < 2; i++) {
        const double y = i ? -0.02 : 0.46; /* in the middle of the eye, and close to the upper lid */
        const size_t p = 4 * ((size_t)((0.5 - 0.5 * y) * SIDE) * SIDE + SIDE / 2);
        const double share = decoded(rgba[1][p]) / decoded(rgba[0][p]);
        print_message("# %s: %.3f of the light\n", i ? "in the middle of the eye" : "close to the upper lid", share);
        assert_true(i ? share > 0.88 : share < 0.85);
        assert_true(fabs(decoded(rgba[2][p]) / decoded(rgba[1][p]) - 1.0) < 0.02);
    }
    for (int i = 0; i < 3; i++) free(rgba[i]);
}

/* The dark rim of an iris takes as much light, wherever it lies between the pixels: its edges are a pixel wide at least,
 * and what is wider is paler. The iris has a radius of a pixel and a half, its rim is 0.4 pixels wide. */
static void the_rim_of_an_iris_is_a_pixel_wide(void **state)
{
    double low = 1e9, high = 0.0;
    (void)state;
    for (int i = 0; i < 16; i++) {
        const float shift[2] = { 0.25f * (float)(i % 4) / (0.5f * (float)SIDE),
                                 0.25f * (float)(i / 4) / (0.5f * (float)SIDE) };
        const float small[12] = { 0.1f, 0, 0, shift[0], 0, 0.1f, 0, shift[1], 0, 0, 0.1f, 0 };
        double sums[2] = { 0.0, 0.0 };
        for (int has_iris = 0; has_iris < 2; has_iris++) {
            model_material eye = eye_of(0.5f, 0.5f, 0.5f);
            scene s;
            eye.f90_loss = 1.0f;
            memset(eye.f0, 0, sizeof eye.f0);
            if (!has_iris) eye.surface_values[2] = eye.surface_values[3] = 0.0f;
            scene_open(&s, &eye, NULL, 0, NULL);
            uint8_t *rgba = scene_draw(&s, SPHERE, small, NULL);
            for (uint32_t p = 0; p < SIDE * SIDE; p++) sums[has_iris] += decoded(rgba[4 * p + 1]);
            free(rgba);
            scene_close(&s);
        }
        low = fmin(low, sums[0] - sums[1]);
        high = fmax(high, sums[0] - sums[1]);
    }
    print_message("# the rim takes %.3f to %.3f\n", low, high);
    assert_true(low > 0.0 && high < RIM_SPREAD * low);
}

/* Where few samples of a pixel lie in a triangle, the pixel's middle lies outside of it. Colours there are not carried on
 * beyond the colours of the triangle's corners: a rim one triangle wide would be dashed. */
static void colours_stay_between_those_of_the_corners(void **state)
{
    static const float values[4] = { 1.0f, 1.0f, 0.0f, 0.0f };
    const test_model_desc desc = { MESHES, 65, 0, TEST_UVS | TEST_COLORS, 1 };
    model *m = test_model(&desc);
    double least = 1.0, most = 0.0;
    size_t count;
    scene s;
    (void)state;
    m->materials = test_zeros(sizeof *m->materials);
    m->materials[0] = scene_material(values);
    m->materials[0].name = model_string("ball");
    m->materials[0].unlit = 1;
    m->material_count = 1;
    for (int i = 0; i < MESHES; i++) m->meshes[i].submeshes[0].material = 0;
    for (uint32_t v = 0; v < 65u * 65u; v++) {
        const uint32_t column = v % 65u;
        const float x = (float)(column / 2u) / 16.0f - 1.0f + (column % 2u ? 0.004f : 0.0f);
        const float at[3] = { x + 0.1f * (float)(v / 65u) / 64.0f, (float)(v / 65u) / 32.0f - 1.0f, 0.0f };
        memcpy(m->meshes[SQUARE].position + 3u * v, at, sizeof at);
        for (int c = 0; c < 4; c++) {
            m->meshes[SQUARE].color[4u * v + (uint32_t)c] = c == 3 ? 1.0f : (column + 1u) / 2u % 2u ? 0.25f : 0.0625f;
        }
    }
    uint8_t *bytes = test_pack_of(m, &count, NULL);
    model_free(m);
    scene_open_pack(&s, bytes, count, NULL, 0, NULL);
    uint8_t *rgba = scene_draw(&s, SQUARE, scene_identity, NULL);
    for (uint32_t p = 0; p < SIDE * SIDE; p++) {
        const uint32_t x = p % SIDE, y = p / SIDE;
        if (x < 8 || x > SIDE - 8 || y < 4 || y > SIDE - 4) continue;
        least = fmin(least, decoded(rgba[4 * p]));
        most = fmax(most, decoded(rgba[4 * p]));
    }
    print_message("# colours of 0.0625 and 0.25: %.4f to %.4f\n", least, most);
    assert_true(least > 0.058 && most < 0.26);
    free(rgba);
    scene_close(&s);
}

/* ---- hair ---- */

static model_material hair_of(float albedo)
{
    const float values[4] = { albedo, 0.5f, 0.0f, 0.04f };
    model_material m = scene_material(values);
    m.surface = NOH_SURFACE_HAIR;
    m.surface_values[1] = 1.0f; /* strands run up the ball */
    return m;
}

static double strand_lobe(const double t[3], const double n[3], double shift, const double h[3], double sharpness)
{
    double moved[3], c = 0.0, length = 0.0, rise;
    for (int k = 0; k < 3; k++) {
        moved[k] = t[k] + shift * n[k];
        length += moved[k] * moved[k];
    }
    for (int k = 0; k < 3; k++) c += moved[k] / sqrt(length) * h[k];
    rise = fmin(fmax(c + 1.0, 0.0), 1.0);
    return rise * rise * (3.0 - 2.0 * rise) * pow(fmax(1.0 - c * c, 0.0), 0.5 * sharpness);
}

static double dot_of(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void make_unit(double v[3])
{
    const double length = sqrt(dot_of(v, v));
    for (int k = 0; k < 3; k++) v[k] /= length;
}

/* What hair of this albedo sends to the eye from a point of the ball, of a key light of 0.9 alone. */
static double hair_at(double x, double y, const float key[3], double albedo)
{
    const double z = sqrt(1.0 - x * x - y * y), l[3] = { (double)key[0], (double)key[1], (double)key[2] };
    double n[3] = { x, y, z + 1.5 - z }, t[3] = { 0.0, 1.0, -y / z }, h[3] = { l[0], l[1], l[2] + 1.0 };
    make_unit(n);
    make_unit(h);
    const double lean = dot_of(n, t);
    for (int k = 0; k < 3; k++) t[k] -= lean * n[k];
    make_unit(t);
    const double tl = dot_of(t, l), nl = dot_of(n, l), gloss = fmin(fmax((nl + 0.2) / 0.6, 0.0), 1.0);
    const double first = strand_lobe(t, n, -0.08, h, 88.0), second = strand_lobe(t, n, 0.12, h, 22.0);
    const double matte = albedo * fmin(fmax(0.25 + 0.75 * nl, 0.0), 1.0) * sqrt(1.0 - tl * tl);
    return 0.9 * (matte + gloss * gloss * (3.0 - 2.0 * gloss) * (0.06 * first + (2.5 * albedo + 0.02) * second));
}

/* A ball of hair that runs from pole to pole has two highlights across the strands, by the formula. */
static void hair_has_two_highlights(void **state)
{
    static const float keys[][3] = { { 0.0f, 0.0f, 1.0f }, { 0.48f, 0.6f, 0.64f }, { -0.6f, 0.0f, 0.8f } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(keys); i++) {
        const model_material hair = hair_of(0.08f);
        noh_lighting lighting;
        double worst = 0.0, most = 0.0;
        scene s;
        scene_open(&s, &hair, &scene_black, 0, NULL);
        key_alone(keys[i], &lighting);
        uint8_t *rgba = scene_draw(&s, SPHERE, scene_identity, &lighting);
        for (uint32_t p = 0; p < SIDE * SIDE; p++) {
            const double x = pixel_at(p % SIDE), y = -pixel_at(p / SIDE);
            if (x * x + y * y > 0.6) continue;
            const double should = hair_at(x, y, keys[i], 0.08);
            worst = fmax(worst, fabs(decoded(rgba[4 * p]) - should));
            most = fmax(most, should);
        }
        print_message("# off by %.4f at most, of %.3f\n", worst, most);
        assert_true(worst < 0.012 && most > 0.25);
        free(rgba);
        scene_close(&s);
    }
}

/* A dark card of hair in white light is dark, also at a grazing angle, where a plain one is a mirror. */
static void hair_is_not_silver(void **state)
{
    const float c = (float)cos(82.0 * PI / 180.0), d = (float)sin(82.0 * PI / 180.0);
    const float turned[12] = { c, 0, d, 0, 0, 1, 0, 0, -d, 0, c, 0 };
    double shown[2];
    (void)state;
    for (int is_hair = 0; is_hair < 2; is_hair++) {
        model_material card = hair_of(0.03f);
        noh_light light;
        noh_lighting lighting;
        scene s;
        if (!is_hair) {
            card.surface = NOH_SURFACE_PLAIN;
            card.surface_values[1] = 0.0f;
        }
        scene_open(&s, &card, noh_environment_at(0), 0, NULL);
        noh_light_from_environment(noh_environment_at(0), 6, &light);
        noh_lighting_make(&light, NULL, 1, &lighting);
        uint8_t *rgba = scene_draw(&s, SQUARE, turned, &lighting);
        shown[is_hair] = decoded(rgba[4 * (SIDE / 2 * SIDE + SIDE / 2)]);
        free(rgba);
        scene_close(&s);
    }
    print_message("# plain %.3f, hair %.3f of white\n", shown[0], shown[1]);
    assert_true(shown[1] > 0.03 && shown[1] < 0.1);
    assert_true(shown[0] > 2.5 * shown[1]);
}

/* ---- teeth ---- */

/* gap: half of the lips', in depths of the mouth; 0: not given, 0.24 */
static void check_teeth(float gap)
{
    static const float values[4] = { 0.8f, 0.9f, 0.0f, 0.04f };
    static const double flesh[3] = { 0.6, 0.15, 0.1 }, deepest[3] = { 0.24, 0.08, 0.07 };
    model_material teeth = scene_material(values);
    uint8_t *rgba[2];
    teeth.surface = NOH_SURFACE_TEETH;
    for (int i = 0; i < 2; i++) {
        scene s;
        teeth.surface_values[2] = i ? 1.25f : 0.0f; /* from z = 0.2, where no light comes, to 1 */
        teeth.surface_values[3] = i ? -0.25f : 0.0f;
        teeth.surface_more[0] = i ? 1.0f : 0.0f;
        teeth.surface_more[3] = gap;
        scene_open(&s, &teeth, NULL, 0, NULL);
        rgba[i] = scene_draw(&s, SPHERE, scene_identity, NULL);
        scene_close(&s);
    }
    for (uint32_t x = SIDE / 2; x < SIDE * 9 / 10; x++) {
        const size_t p = 4 * ((size_t)(SIDE / 2) * SIDE + x);
        const double z = sqrt(1.0 - pixel_at(x) * pixel_at(x)), open = fmin(fmax(1.25 * z - 0.25, 0.0), 1.0);
        const double depth = fmax(1.2 - open, 0.2) / (gap > 0.0f ? fmax((double)gap, 1.0 / 256.0) : 0.24);
        const double through = 1.0 / sqrt(1.0 + depth * depth);
        for (size_t c = 0; c < 3; c++) { /* of walls of flesh: what is deeper is redder */
            const double a = 2.0404 * flesh[c] - 0.3324, b = 0.6417 - 4.7951 * flesh[c], d = 2.7552 * flesh[c] + 0.6903;
            const double right = fmax(fmax(((a * through + b) * through + d) * through, through), deepest[c]);
            assert_true(fabs(decoded(rgba[1][p + c]) / decoded(rgba[0][p + c]) - right) < 0.03);
        }
    }
    free(rgba[0]);
    free(rgba[1]);
}

static void (*set_vectors)(int, int, const float *);
static float least_gap;

static void note_gap(int at, int count, const float *v)
{
    if (count == 2 && v[3] < least_gap) least_gap = v[3];
    set_vectors(at, count, v);
}

/* A GPU that flushes denormal numbers divides by 0 where a gap is one. */
static void teeth_are_dark_behind_the_lips(void **state)
{
    static const float gaps[] = { 0.0f, 0.05f, 0.9f, 1e-40f };
    gpu *g = fixture_gpu();
    (void)state;
    set_vectors = g->gl.Uniform3fv;
    g->gl.Uniform3fv = note_gap;
    for (size_t i = 0; i < TEST_COUNT(gaps); i++) {
        least_gap = 9.0f;
        check_teeth(gaps[i]);
        assert_true(least_gap >= 1.0f / 256.0f && least_gap < 1.0f);
    }
    g->gl.Uniform3fv = set_vectors;
}

/* The back of a mouth is dark; cheeks, which bend back at its corners and so lie behind the foremost teeth, and a chin a
 * little behind these are not. */
static void cheeks_are_not_inside_the_mouth(void **state)
{
    static const float values[4] = { 0.8f, 0.9f, 0.0f, 0.04f };
    static const char *const parts[3] = { "cheeks", "back of the mouth", "a chin" };
    (void)state;
    for (int part = 0; part < 3; part++) {
        const int is_back = part == 1;
        uint8_t *rgba[2];
        double least = 1.0;
        for (int i = 0; i < 2; i++) {
            model_material skin = skin_of(values, 1000.0f);
            scene s;
            skin.surface_values[3] = is_back ? 0.5f : part ? 0.05f : 0.98f; /* the foremost teeth */
            skin.surface_more[0] = 0.8f;
            skin.surface_more[1] = 0.4f;
            skin.surface_more[2] = i ? 2.0f : 0.0f; /* 0: there is no mouth */
            scene_open(&s, &skin, NULL, 0, NULL);
            rgba[i] = scene_draw(&s, part ? SQUARE : SPHERE, scene_identity, NULL);
            scene_close(&s);
        }
        for (size_t p = 0; p < 4 * (size_t)SIDE * SIDE; p += 4) {
            if (rgba[0][p] > 64) least = fmin(least, decoded(rgba[1][p]) / decoded(rgba[0][p]));
        }
        print_message("# %s: %.3f of the light\n", parts[part], least);
        assert_true(is_back ? least < 0.4 : least > 0.95);
        free(rgba[0]);
        free(rgba[1]);
    }
}

/* ---- a highlight ---- */

/* The cosine between a normal along z and the half vector of light along z, seen from x, 0, 1.5. */
static double half_cosine(double x)
{
    const double length = hypot(x, 1.5), half[2] = { x / length, 1.5 / length + 1.0 };
    return half[1] / hypot(half[0], half[1]);
}

/* A15: the literal half vector takes the eye's place for its direction, as if every point lay at the origin, so that a
 * flat square glosses alike at each. The eye is close to it: the highlight lies where eye, point and light say. */
static void a_highlight_is_seen_from_its_point(void **state)
{
    static const float values[4] = { 0.0f, 0.4f, 0.0f, 0.04f };
    const model_material gloss = scene_material(values);
    double brightest = 0.0, at = -1.0;
    uint8_t *rgba;
    scene s;
    (void)state;
    scene_open(&s, &gloss, NULL, 0, NULL);
    s.eye[0] = 0.6f;
    s.eye[2] = 1.5f;
    rgba = scene_draw(&s, SQUARE, scene_identity, NULL);
    for (uint32_t x = 0; x < SIDE; x++) {
        const double shown = decoded(rgba[4 * ((size_t)(SIDE / 2) * SIDE + x)]);
        if (shown > brightest) {
            brightest = shown;
            at = pixel_at(x);
        }
    }
    assert_true(fabs(at - 0.6) < 0.05);
    assert_true(brightest > 3.0 * decoded(rgba[4 * (size_t)(SIDE / 2) * SIDE]));
    assert_true(half_cosine(0.0) - half_cosine(0.6) > 0.015); /* the literal one, at every point, is that much lower */
    free(rgba);
    scene_close(&s);
}

/* A ball lit from the right, and from above: in shade it has one tone, in light another, and the edge between them is
 * as hard and as far as the material says. The lamp is lower than the key, and nearer to the viewer. */
static void a_toon_has_two_tones(void **state)
{
    static const float values[4] = { 1.0f, 1.0f, 0.0f, 0.0f },
                       keys[2][3] = { { 1.0f, 0.0f, 0.0f }, { 0.0f, 1.0f, 0.0f } };
    model_material toon = scene_material(values);
    double worst = 0.0;
    scene s;
    (void)state;
    toon.surface = NOH_SURFACE_TOON;
    toon.surface_values[0] = 0.5f;
    toon.surface_values[1] = 0.25f;
    toon.surface_values[2] = 0.75f;
    toon.surface_values[3] = 0.2f;
    toon.surface_more[0] = 0.6f;
    scene_open(&s, &toon, &scene_black, 0, NULL);
    for (int k = 0; k < 2; k++) {
        const double size = k ? hypot(0.4, 0.3) : hypot(1.0, 0.3);
        noh_lighting lighting;
        key_alone(keys[k], &lighting);
        uint8_t *rgba = scene_draw(&s, SPHERE, scene_identity, &lighting);
        for (uint32_t x = SIDE / 10; x < SIDE - SIDE / 10; x++) {
            const double at = pixel_at(x), reach = ((k ? 0.0 : at) + 0.3 * sqrt(1.0 - at * at)) / size;
            const double lit = fmin(fmax((reach + 0.2 + 0.4) / 0.8, 0.0), 1.0);
            for (int c = 0; c < 3; c++) {
                const double dark = (double)toon.surface_values[c], should = 0.9 * (dark + (1.0 - dark) * lit);
                worst = fmax(worst, fabs(decoded(rgba[4 * ((size_t)(SIDE / 2) * SIDE + x) + (size_t)c]) - should));
            }
        }
        free(rgba);
    }
    print_message("off by %.4f at most\n", worst);
    assert_true(worst < 0.02);
    scene_close(&s);
}

/* Its edge and its brightness are the same whether or not a key was split off the light for a shadow. */
static void a_toon_needs_no_key(void **state)
{
    static const float values[4] = { 0.9f, 1.0f, 0.0f, 0.0f };
    const model_material plain = scene_material(values);
    (void)state;
    for (uint32_t e = 0; e < 3u; e++) {
        model_material toon = plain;
        uint8_t *rgba[2];
        noh_light light;
        scene s;
        toon.surface = NOH_SURFACE_TOON;
        toon.surface_values[0] = toon.surface_values[1] = toon.surface_values[2] = 0.3f;
        toon.surface_more[0] = 0.6f;
        noh_light_from_environment(noh_environment_at(e), 6, &light);
        scene_open(&s, &toon, noh_environment_at(e), 0, NULL);
        for (int key = 0; key < 2; key++) {
            noh_lighting lighting;
            noh_lighting_make(&light, NULL, key, &lighting);
            rgba[key] = scene_draw(&s, SPHERE, scene_identity, &lighting);
        }
        assert_true(rgba[0][4 * (SIDE / 2 * SIDE + SIDE / 2)] > 20);
        for (uint32_t i = 0; i < 4 * SIDE * SIDE; i++) assert_in_range(rgba[0][i] - rgba[1][i] + 1, 0, 2);
        free(rgba[0]);
        free(rgba[1]);
        scene_close(&s);
    }
}

/* ---- MToon ---- */

#define CAP 64u

/* r and g: where it was read. */
static model_texture cap_picture(uint8_t rgba[CAP * CAP * 4])
{
    const model_texture cap = { .rgba = rgba, .width = CAP, .height = CAP, .wrap_s = 33071, .wrap_t = 33071 };
    for (uint32_t i = 0; i < CAP * CAP; i++) {
        rgba[4 * i] = (uint8_t)(4 * (i % CAP));
        rgba[4 * i + 1] = (uint8_t)(4 * (i / CAP));
        rgba[4 * i + 2] = 0;
        rgba[4 * i + 3] = 255;
    }
    return cap;
}

/* Draw a ball of a toon with one picture in light from the eye. Returns the largest difference of a linear channel from
 * `should`, of the normal. */
static double toon_error(const model_material *toon, const model_texture *picture,
                         double (*should)(const double normal[3], int channel))
{
    static const float front[3] = { 0.0f, 0.0f, 1.0f };
    noh_lighting lighting;
    double worst = 0.0;
    size_t count;
    scene s;
    uint8_t *pack = scene_pack(toon, picture, &count);
    scene_open_pack(&s, pack, count, &scene_black, 0, NULL);
    key_alone(front, &lighting);
    uint8_t *drawn = scene_draw(&s, SPHERE, scene_identity, &lighting);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const double x = pixel_at(i % SIDE), y = -pixel_at(i / SIDE), r2 = x * x + y * y;
        if (r2 > 0.8) continue;
        const double normal[3] = { x, y, sqrt(1.0 - r2) };
        for (int c = 0; c < 3; c++) worst = fmax(worst, fabs(decoded(drawn[4 * i + (uint32_t)c]) - should(normal, c)));
    }
    print_message("off by %.4f at most\n", worst);
    free(drawn);
    scene_close(&s);
    return worst;
}

/* A toon with a hard edge and a blue rim of 0.64. */
static model_material toon_material(void)
{
    static const float values[4] = { 0.3f, 1.0f, 0.0f, 0.0f };
    model_material toon = scene_material(values);
    toon.surface = NOH_SURFACE_TOON;
    toon.surface_more[0] = 0.9f;
    toon.surface_more[1] = 65536.0f * 204.0f;
    toon.surface_more[2] = 3.0f;
    return toon;
}

static double with_matcap(const double normal[3], int c)
{
    const double lit = fmin(fmax((normal[2] - 0.6 + 0.1) / 0.2, 0.0), 1.0);
    const double read = c < 2 ? decoded((uint8_t)(127.5 + (c ? -127.5 : 127.5) * normal[c])) : 0.0;
    const double rim = c == 2 ? 0.64 * pow(fmin(1.1 - normal[2], 1.0), 3.0) : 0.0;
    return fmin(0.9 * (0.1 * c + (0.3 - 0.1 * c) * lit + rim + read), 1.0);
}

/* Against VRMC_materials_mtoon 1.0: a shade of its own, a rim, and a matcap that is read at the normal, downwards. */
static void a_toon_has_a_rim_and_a_matcap(void **state)
{
    static uint8_t rgba[CAP * CAP * 4];
    const model_texture cap = cap_picture(rgba);
    model_material toon = toon_material();
    (void)state;
    toon.toon_shade = 1;
    for (int c = 0; c < 3; c++) toon.surface_values[c] = 0.1f * (float)c;
    toon.surface_values[3] = -0.6f;
    toon.surface_more[3] = 0.1f;
    toon.more_textures[NOH_TOON_MATCAP] = 0;
    assert_true(toon_error(&toon, &cap, with_matcap) < 0.03);
}

static double with_masks(const double normal[3], int c)
{
    const double lit = fmin(fmax((normal[2] - 64.0 / 127.0 + 0.1) / 0.2, 0.0), 1.0);
    const double shade = c < 2 ? 0.15 : 0.0, rim = c == 2 ? 0.64 * pow(1.0 - normal[2], 3.0) * 128.0 / 255.0 : 0.0;
    return 0.9 * (shade + (0.3 - shade) * lit + rim);
}

/* Its third texture moves the edge towards the light, and takes half of the rim away. */
static void a_toon_has_masks(void **state)
{
    static uint8_t rgba[16 * 16 * 4];
    const model_texture mask = {
        .rgba = rgba, .width = 16, .height = 16, .wrap_s = 10497, .wrap_t = 10497, .use = MODEL_TEXTURE_DATA
    };
    model_material toon = toon_material();
    (void)state;
    for (uint32_t i = 0; i < 16 * 16; i++) memcpy(rgba + 4 * i, (uint8_t[4]){ 64, 255, 128, 255 }, 4);
    toon.toon_masks = 1;
    toon.surface_values[0] = toon.surface_values[1] = 0.5f;
    toon.more_textures[NOH_TOON_WIDTH] = 0;
    assert_true(toon_error(&toon, &mask, with_masks) < 0.03);
}

/* A ball of radius 0.5 under an outline of 0.1 in the world, or a twentieth of the picture's height, also in a mirror:
 * the hull's front is open. */
static void a_toon_has_an_outline(void **state)
{
    static const float values[4] = { 0.8f, 1.0f, 0.0f, 0.0f }, front[3] = { 0.0f, 0.0f, 1.0f };
    static const float widths[] = { 0.2f, -0.05f }; /* the world's scale is a half */
    (void)state;
    for (int i = 0; i < 4; i++) {
        const float mirror = i & 1 ? -0.5f : 0.5f;
        const float half[12] = { mirror, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 0.5f, 0 };
        model_material toon = scene_material(values);
        noh_lighting lighting;
        double outer = 0.0, inner = 2.0;
        scene s;
        toon.surface = NOH_SURFACE_TOON;
        toon.surface_more[0] = 0.9f;
        toon.surface_more[4] = widths[i >> 1];
        toon.surface_more[5] = 255.0f; /* red */
        scene_open(&s, &toon, &scene_black, 0, NULL);
        key_alone(front, &lighting);
        uint8_t *drawn = scene_draw(&s, SPHERE, half, &lighting);
        for (uint32_t k = 0; k < SIDE; k++) {
            const uint8_t *pixel = drawn + 4 * ((size_t)(SIDE / 2) * SIDE + k);
            if (pixel[0] < 200 || pixel[1] > 60) continue; /* neither grey nor what is behind */
            outer = fmax(outer, fabs(pixel_at(k)));
            inner = fmin(inner, fabs(pixel_at(k)));
        }
        print_message("from %.3f to %.3f\n", inner, outer);
        assert_true(fabs(inner - 0.5) < 0.04 && fabs(outer - 0.6) < 0.04);
        free(drawn);
        scene_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_fit_of_scatter_is_near_its_integral),
        cmocka_unit_test(a_ball_of_skin_scatters_as_its_curvature_says),
        cmocka_unit_test(white_skin_in_a_furnace_is_white),
        cmocka_unit_test(two_lobes_send_out_no_more_than_comes),
        cmocka_unit_test(an_eye_shows_the_lamp),
        cmocka_unit_test(the_iris_lies_behind_the_cornea),
        cmocka_unit_test(lids_darken_the_ball),
        cmocka_unit_test(the_rim_of_an_iris_is_a_pixel_wide),
        cmocka_unit_test(colours_stay_between_those_of_the_corners),
        cmocka_unit_test(hair_has_two_highlights),
        cmocka_unit_test(hair_is_not_silver),
        cmocka_unit_test(teeth_are_dark_behind_the_lips),
        cmocka_unit_test(cheeks_are_not_inside_the_mouth),
        cmocka_unit_test(a_toon_has_two_tones),
        cmocka_unit_test(a_toon_needs_no_key),
        cmocka_unit_test(a_toon_has_a_rim_and_a_matcap),
        cmocka_unit_test(a_toon_has_masks),
        cmocka_unit_test(a_toon_has_an_outline),
        cmocka_unit_test(a_highlight_is_seen_from_its_point),
    };
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
