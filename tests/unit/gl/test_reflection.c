/* test_reflection.c: windows and key lights as spherical harmonics, and the prefiltered cube, against brute force in
 * double precision.
 * cross: slow, integrals by brute force */
#include "support/support.h"

#include <math.h>
#include <string.h>

#include "gl/light/light_internal.h"
#include "noh/base.h"
#include "noh/light.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"

#define PI 3.14159265358979323846
#define SIDE_MAX 128u

static __attribute__((aligned(16))) float texels[SIDE_MAX * SIDE_MAX * 6 * 2], scratch[SIDE_MAX * SIDE_MAX * 6 * 4];

static noh_reflection make(uint32_t side, noh_radiance radiance, const void *user)
{
    const noh_reflection_desc desc = { side, radiance, user };
    noh_reflection r;
    noh_error error;
    assert_true(noh_reflection_size(side) <= sizeof texels && noh_reflection_scratch_size(side) <= sizeof scratch);
    assert_int_equal(noh_reflection_init(texels, noh_reflection_size(side), scratch, noh_reflection_scratch_size(side),
                                         &desc, &r, &error),
                     NOH_OK);
    return r;
}

/* ---- spherical harmonics ---- */

/* The sum over a fine grid on the sphere is off by its steps at the window's edges. */
static void windows_have_their_integral(void **state)
{
    (void)state;
    test_skip_emulated("integrals by brute force");
    for (uint32_t e = 0; e < NOH_ENVIRONMENT_COUNT; e++) {
        const noh_environment *environment = noh_environment_at(e);
        double sums[NOH_SH_COUNT_MAX] = { 0.0 };
        const int rings = 600, ring = 1200;
        noh_light light;
        if (!environment->window_count) continue;
        noh_light_from_environment(environment, 6, &light);
        for (int i = 0; i < rings * ring; i++) {
            const double z = 2.0 * (i / ring + 0.5) / rings - 1.0, a = 2.0 * PI * (i % ring + 0.5) / ring;
            const double across = sqrt(1.0 - z * z);
            const float d[3] = { (float)(across * cos(a)), (float)(across * sin(a)), (float)z };
            float rgb[3], basis[NOH_SH_COUNT_MAX];
            noh_environment_radiance(environment, d, rgb);
            noh_sh_basis(6, d, basis);
            for (int k = 0; k < 36; k++) sums[k] += 4.0 * PI / (rings * ring) * (double)rgb[1] * (double)basis[k];
        }
        for (int k = 0; k < 36; k++) assert_true(fabs(sums[k] - (double)light.coefs[k][1]) < 2e-2);
    }
}

/* The solid angle of a rectangle has a closed form: 4 atan(a b / sqrt(1 + a^2 + b^2)). */
static void a_windows_solid_angle_is_the_known_one(void **state)
{
    static const float halves[][2] = { { 0.1f, 0.1f }, { 0.42f, 0.55f }, { 0.69f, 0.69f }, { 0.05f, 0.6f } };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(halves); i++) {
        for (uint32_t panes = 1; panes <= 4; panes++) {
            noh_environment one = { .name = "one", .window_count = 1 };
            const double a = halves[i][0], b = halves[i][1];
            noh_light light;
            one.windows[0] = (noh_window){ { 0.0f, 0.6f, 0.8f }, { 0, 0 }, { panes, 5 - panes }, 0.0f, { 1, 1, 1 } };
            memcpy(one.windows[0].half, halves[i], sizeof halves[i]);
            noh_light_from_environment(&one, 6, &light);
            assert_true(fabs((double)light.coefs[0][0] / sqrt(1.0 / (4.0 * PI)) -
                             4.0 * atan(a * b / sqrt(1.0 + a * a + b * b))) < 1e-5);
        }
    }
}

/* A distant lamp is found again, exactly; under an even light there is none; key and rest are the light. */
static void a_key_light_is_taken_out(void **state)
{
    const float to[3] = { 0.36f, 0.48f, -0.8f };
    noh_light light, rest;
    float basis[NOH_SH_COUNT_MAX], direction[3], rgb[3];
    (void)state;
    memset(&light, 0, sizeof light);
    light.order = 6;
    noh_sh_basis(6, to, basis);
    for (int i = 0; i < 36; i++) {
        for (int c = 0; c < 3; c++) light.coefs[i][c] = (float)(c + 1) * basis[i] * (float)PI;
    }
    light.coefs[0][1] += 1.0f;
    noh_light_key(&light, direction, rgb, &rest);
    for (int k = 0; k < 3; k++) {
        assert_true(fabsf(direction[k] - to[k]) < 1e-5f);
        assert_true(fabsf(rgb[k] - (float)(k + 1)) < 1e-5f);
        for (int i = 1; i < 36; i++) assert_true(fabsf(rest.coefs[i][k]) < 1e-5f);
    }
    assert_true(fabsf(rest.coefs[0][1] - 1.0f) < 1e-5f && fabsf(rest.coefs[0][0]) < 1e-5f);
    noh_light_from_environment(noh_environment_at(0), 6, &light);
    noh_light_key(&light, direction, rgb, &rest);
    assert_true(rgb[0] == 0.0f && rgb[1] == 0.0f && rgb[2] == 0.0f);
    assert_memory_equal(&rest, &light, sizeof rest);
}

/* What is left of a built-in environment lights no matte surface by less than nothing, or by little. */
static void what_is_left_is_light(void **state)
{
    (void)state;
    for (uint32_t e = 1; e < NOH_ENVIRONMENT_COUNT; e++) {
        noh_light light, rest;
        float direction[3], key[3], least = 1.0f;
        noh_light_from_environment(noh_environment_at(e), 6, &light);
        noh_light_key(&light, direction, key, &rest);
        assert_true(key[0] > 0.1f && key[1] > 0.1f && key[2] > 0.1f && direction[1] > 0.0f);
        for (uint32_t i = 0; i < 6 * 64; i++) {
            float n[3], rgb[3];
            noh_reflection_direction(8, i / 64, i % 8, i / 8 % 8, n);
            noh_light_irradiance(&rest, n, rgb);
            for (int c = 0; c < 3; c++) least = rgb[c] < least ? rgb[c] : least;
        }
        print_message("%s: key %.2f %.2f %.2f, the rest reflects at least %.3f\n", noh_environment_at(e)->name,
                      (double)key[0], (double)key[1], (double)key[2], (double)least);
        assert_true(least > -0.02f);
    }
}

/* ---- texels ---- */

static void constant(const void *user, const float direction[3], float rgb[3])
{
    (void)direction;
    memcpy(rgb, user, 3 * sizeof *rgb);
}

/* Shared exponents are within half a step of 1/256 to 1/512 of the largest part, from the smallest to the largest. */
static void texels_are_near(void **state)
{
    test_random random = test_random_from(3);
    (void)state;
    test_skip_emulated("integrals by brute force");
    for (int i = 0; i < 60; i++) {
        const float size = ldexpf(1.0f, i % 30 - 14);
        float rgb[3], found[3];
        noh_reflection r;
        for (int c = 0; c < 3; c++) rgb[c] = size * test_random_float(&random, 0.0f, 1.0f);
        r = make(16, constant, rgb);
        noh_reflection_texel(&r, 0, 3, 5, 6, found);
        for (int c = 0; c < 3; c++) {
            const float most = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
            assert_true(fabsf(found[c] - rgb[c]) <= most / 511.0f + ldexpf(1.0f, -25));
        }
    }
}

static void impossible_radiance(const void *user, const float direction[3], float rgb[3])
{
    (void)user;
    rgb[0] = direction[0] > 0.0f ? INFINITY : NAN;
    rgb[1] = -1.0f;
    rgb[2] = 1e30f;
}

static void no_radiance_breaks_a_texel(void **state)
{
    const noh_reflection r = make(16, impossible_radiance, NULL);
    (void)state;
    for (uint32_t i = 0; i < noh_reflection_size(16) / 4; i++) assert_true(r.texels[i] >> 27 <= 31u);
}

static void every_level_of_an_even_light_is_even(void **state)
{
    static const float white[3] = { 1.0f, 1.0f, 1.0f };
    const noh_reflection r = make(32, constant, white);
    (void)state;
    for (uint32_t i = 1; i < noh_reflection_size(32) / 4; i++) assert_int_equal(r.texels[i], r.texels[0]);
}

/* Each level against the same integral over 128^2 texels of each face, in double precision. */
static void brute_force(const noh_environment *environment, uint32_t level, const float about[3], double rgb[3])
{
    enum { FINE = 128 };
    const double roughness = level / 4.0, a2 = pow(roughness, 4.0);
    double weight = 0.0;
    for (int c = 0; c < 3; c++) rgb[c] = 0.0;
    for (uint32_t i = 0; i < 6 * FINE * FINE; i++) {
        float d[3], light[3];
        double s, t, l2, cosine, half, w;
        noh_reflection_direction(FINE, i / (FINE * FINE), i % FINE, i / FINE % FINE, d);
        s = (2.0 * (i % FINE) + 1.0) / FINE - 1.0;
        t = (2.0 * (i / FINE % FINE) + 1.0) / FINE - 1.0;
        l2 = 1.0 + s * s + t * t;
        cosine = (double)d[0] * (double)about[0] + (double)d[1] * (double)about[1] + (double)d[2] * (double)about[2];
        if (cosine <= 0.0) continue;
        half = sqrt((1.0 + cosine) / 2.0); /* of the angle */
        w = a2 / (PI * pow(half * half * (a2 - 1.0) + 1.0, 2.0)) * cosine / (l2 * sqrt(l2));
        noh_environment_radiance(environment, d, light);
        for (int c = 0; c < 3; c++) rgb[c] += w * (double)light[c];
        weight += w;
    }
    for (int c = 0; c < 3; c++) rgb[c] /= weight;
}

static void blurred_levels_are_near_brute_force(void **state)
{
    (void)state;
    test_skip_emulated("integrals by brute force");
    for (uint32_t e = 0; e < NOH_ENVIRONMENT_COUNT; e++) {
        const noh_environment *environment = noh_environment_at(e);
        const noh_reflection r = make(64, noh_reflection_of_environment, environment);
        for (uint32_t level = 1; level < NOH_REFLECTION_LEVELS; level++) {
            const uint32_t n = 64u >> level, step = n * n > 64u ? n * n / 64u + 1u : 1u;
            double worst = 0.0, sum = 0.0, most = 1.0;
            uint32_t count = 0;
            for (uint32_t i = 0; i < 6 * n * n; i += 9 * step) {
                float d[3], found[3];
                double right[3];
                noh_reflection_direction(n, i / (n * n), i % n, i / n % n, d);
                noh_reflection_texel(&r, level, i / (n * n), i % n, i / n % n, found);
                brute_force(environment, level, d, right);
                most = fmax(most, right[1]);
                worst = fmax(worst, fabs((double)found[1] - right[1]));
                sum += fabs((double)found[1] - right[1]);
                count++;
            }
            print_message("%s, level %u: off by %.4f of %.2f at most, %.4f on average\n", environment->name, level,
                          worst, most, sum / count);
            assert_true(worst < 0.02 * most + 0.005 && sum / count < 0.005 * most);
        }
    }
}

/* The middle of a mirror's texels is what comes from there, away from edges of lamps. */
static void a_mirror_is_sharp(void **state)
{
    const noh_environment *room = noh_environment_at(2);
    const noh_reflection r = make(64, noh_reflection_of_environment, room);
    uint32_t near = 0, bright = 0;
    (void)state;
    for (uint32_t i = 0; i < 6 * 64 * 64; i++) {
        float d[3], right[3], found[3];
        noh_reflection_direction(64, i / 4096, i % 64, i / 64 % 64, d);
        noh_reflection_texel(&r, 0, i / 4096, i % 64, i / 64 % 64, found);
        noh_environment_radiance(room, d, right);
        near += fabsf(found[0] - right[0]) < 0.02f * right[0] + 0.01f;
        bright += right[0] > 8.0f;
    }
    assert_true(near > 6 * 4096 * 95 / 100);
    assert_true(bright > 500); /* there is a window to be seen */
}

static void wrong_asks_are_refused(void **state)
{
    static const uint32_t sides[] = { 8, 15, 17, 48, 256, UINT32_MAX };
    const noh_reflection_desc nothing = { 16, NULL, NULL };
    noh_reflection r;
    noh_error error;
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(sides); i++) {
        const noh_reflection_desc desc = { sides[i], constant, NULL };
        assert_int_equal(noh_reflection_size(sides[i]), 0);
        assert_int_equal(noh_reflection_init(texels, sizeof texels, scratch, sizeof scratch, &desc, &r, &error),
                         NOH_ERR_ARG);
    }
    assert_int_equal(noh_reflection_init(texels, sizeof texels, scratch, sizeof scratch, &nothing, &r, &error),
                     NOH_ERR_ARG);
    assert_int_equal(noh_reflection_size(0), 130944);
}

/* CRC-32C of all texels: the same on every processor. */
static void bits_are_the_same_everywhere(void **state)
{
    uint32_t crc = 0;
    (void)state;
    for (uint32_t i = 0; i < NOH_ENVIRONMENT_COUNT; i++) {
        const noh_reflection r = make(32, noh_reflection_of_environment, noh_environment_at(i));
        crc = noh_crc32c(crc, r.texels, noh_reflection_size(32));
    }
    assert_int_equal(crc, 0xf1e98b52u);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(windows_have_their_integral),
        cmocka_unit_test(a_windows_solid_angle_is_the_known_one),
        cmocka_unit_test(a_key_light_is_taken_out),
        cmocka_unit_test(what_is_left_is_light),
        cmocka_unit_test(texels_are_near),
        cmocka_unit_test(no_radiance_breaks_a_texel),
        cmocka_unit_test(every_level_of_an_even_light_is_even),
        cmocka_unit_test(blurred_levels_are_near_brute_force),
        cmocka_unit_test(a_mirror_is_sharp),
        cmocka_unit_test(wrong_asks_are_refused),
        cmocka_unit_test(bits_are_the_same_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
