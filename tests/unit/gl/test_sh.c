/* test_sh.c: spherical harmonics and environments against closed forms, in double precision.
 * cross: slow, integrals by brute force */
#include "support/support.h"

#include <math.h>
#include <string.h>

#include "gl/light/sh_internal.h"
#include "gl/light/light_internal.h"
#include "noh/base.h"
#include "noh/light.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"

#define PI 3.14159265358979323846

/* Directions with weights that integrate polynomials of degree 40 and more over the sphere: a grid of midpoints in the
 * azimuth, and in z a rule of Gauss and Legendre of 32 nodes, found by Newton's method. */
#define RINGS 32u
#define RING 64u

typedef struct grid {
    float direction[RINGS * RING][3];
    double weight[RINGS * RING];
} grid;

static void legendre(double x, double *value, double *slope)
{
    double before = 1.0, now = x;
    for (unsigned l = 1; l < RINGS; l++) {
        const double next = ((2.0 * l + 1.0) * x * now - l * before) / (l + 1.0);
        before = now;
        now = next;
    }
    *value = now;
    *slope = RINGS * (x * now - before) / (x * x - 1.0);
}

static const grid *make_grid(void)
{
    static grid g;
    for (unsigned r = 0; r < RINGS; r++) {
        double z = cos(PI * (r + 0.75) / (RINGS + 0.5)), value, slope;
        for (int i = 0; i < 50; i++) {
            legendre(z, &value, &slope);
            z -= value / slope;
        }
        legendre(z, &value, &slope);
        for (unsigned i = 0; i < RING; i++) {
            const double angle = 2.0 * PI * (i + 0.5) / RING, across = sqrt(1.0 - z * z);
            float *d = g.direction[r * RING + i];
            d[0] = (float)(across * cos(angle));
            d[1] = (float)(across * sin(angle));
            d[2] = (float)z;
            g.weight[r * RING + i] = 2.0 / ((1.0 - z * z) * slope * slope) * 2.0 * PI / RING;
        }
    }
    return &g;
}

static void random_direction(test_random *r, float d[3])
{
    double length;
    do {
        for (int i = 0; i < 3; i++) d[i] = test_random_float(r, -1.0f, 1.0f);
        length = sqrt((double)d[0] * d[0] + (double)d[1] * d[1] + (double)d[2] * d[2]);
    } while (length < 0.1 || length > 1.0);
    for (int i = 0; i < 3; i++) d[i] = (float)(d[i] / length);
}

/* ---- the basis ---- */

/* Bands 0 to 2 as they are printed everywhere, and band 3's two ends. */
static void the_basis_is_the_known_one(void **state)
{
    test_random r = test_random_from(1);
    (void)state;
    for (int i = 0; i < 1000; i++) {
        float d[3], basis[NOH_SH_COUNT_MAX];
        double x, y, z;
        random_direction(&r, d);
        x = d[0], y = d[1], z = d[2];
        noh_sh_basis(6, d, basis);
        {
            const double known[] = { 0.5 * sqrt(1.0 / PI),
                                     sqrt(3.0 / (4.0 * PI)) * y,
                                     sqrt(3.0 / (4.0 * PI)) * z,
                                     sqrt(3.0 / (4.0 * PI)) * x,
                                     0.5 * sqrt(15.0 / PI) * x * y,
                                     0.5 * sqrt(15.0 / PI) * y * z,
                                     0.25 * sqrt(5.0 / PI) * (3.0 * z * z - 1.0),
                                     0.5 * sqrt(15.0 / PI) * z * x,
                                     0.25 * sqrt(15.0 / PI) * (x * x - y * y),
                                     0.25 * sqrt(35.0 / (2.0 * PI)) * y * (3.0 * x * x - y * y) };
            for (size_t k = 0; k < TEST_COUNT(known); k++) assert_true(fabs(basis[k] - known[k]) < 1e-6);
            assert_true(fabs(basis[15] - 0.25 * sqrt(35.0 / (2.0 * PI)) * x * (x * x - 3.0 * y * y)) < 1e-6);
        }
    }
}

static void the_basis_is_orthonormal(void **state)
{
    static double sums[NOH_SH_COUNT_MAX][NOH_SH_COUNT_MAX];
    const grid *g = make_grid();
    (void)state;
    memset(sums, 0, sizeof sums);
    for (unsigned s = 0; s < RINGS * RING; s++) {
        float basis[NOH_SH_COUNT_MAX];
        noh_sh_basis(6, g->direction[s], basis);
        for (unsigned i = 0; i < NOH_SH_COUNT_MAX; i++) {
            for (unsigned j = 0; j < NOH_SH_COUNT_MAX; j++) sums[i][j] += g->weight[s] * basis[i] * basis[j];
        }
    }
    for (unsigned i = 0; i < NOH_SH_COUNT_MAX; i++) {
        for (unsigned j = 0; j < NOH_SH_COUNT_MAX; j++) assert_true(fabs(sums[i][j] - (i == j)) < 3e-6);
    }
}

/* Sum over m of Y_lm(a) Y_lm(b) is (2 l + 1) / (4 pi) P_l(a . b), and a lower order is a prefix of a higher one. */
static void bands_add_up_to_legendre(void **state)
{
    test_random r = test_random_from(2);
    (void)state;
    for (int i = 0; i < 1000; i++) {
        float a[3], b[3], of_a[NOH_SH_COUNT_MAX], of_b[NOH_SH_COUNT_MAX], low[NOH_SH_COUNT_MAX];
        double t, before = 0.0, now = 1.0;
        random_direction(&r, a);
        random_direction(&r, b);
        t = (double)a[0] * b[0] + (double)a[1] * b[1] + (double)a[2] * b[2];
        noh_sh_basis(6, a, of_a);
        noh_sh_basis(6, b, of_b);
        noh_sh_basis(3, a, low);
        assert_memory_equal(low, of_a, 9 * sizeof *low);
        for (unsigned l = 0; l < 6; l++) {
            const double next = ((2.0 * l + 1.0) * t * now - l * before) / (l + 1.0);
            double sum = 0.0;
            for (unsigned k = l * l; k < (l + 1) * (l + 1); k++) sum += (double)of_a[k] * of_b[k];
            assert_true(fabs(sum - (2.0 * l + 1.0) / (4.0 * PI) * now) < 1e-5);
            before = now;
            now = next;
        }
    }
}

/* ---- projection, convolution ---- */

/* The clamped cosine about an axis: projected, from its zonal coefficients, and as irradiance of a sharp light. */
static void the_cosine_lobe_is_the_known_one(void **state)
{
    static const double known[] = { 1.0, 2.0 / 3.0, 0.25, 0.0, -1.0 / 24.0, 0.0 }; /* over pi */
    (void)state;
    for (unsigned l = 0; l < 6; l++) {
        double sum = 0.0; /* 2 pi times the integral of t P_l(t) over 0..1, over pi */
        for (int i = 0; i < 200000; i++) {
            const double t = (i + 0.5) / 200000.0;
            double before = 0.0, now = 1.0;
            for (unsigned k = 0; k < l; k++) {
                const double next = ((2.0 * k + 1.0) * t * now - k * before) / (k + 1.0);
                before = now;
                now = next;
            }
            sum += 2.0 * t * now / 200000.0;
        }
        assert_true(fabs(sum - known[l]) < 1e-5);
        assert_true(fabs(noh_sh_cosine_lobe[l] - known[l]) < 1e-7);
    }
}

/* A polynomial of degree 5 is projected and comes back. */
static void what_fits_the_order_comes_back(void **state)
{
    const grid *g = make_grid();
    test_random r = test_random_from(3);
    float coefs[NOH_SH_COUNT_MAX];
    (void)state;
    memset(coefs, 0, sizeof coefs);
    for (unsigned s = 0; s < RINGS * RING; s++) {
        const float *d = g->direction[s];
        const float value = 1.0f + d[0] * d[1] * d[2] * d[2] - 2.0f * d[1] * d[1] * d[1] * d[1] * d[0] + d[2];
        noh_sh_add_sample(6, d, value, (float)g->weight[s], coefs);
    }
    for (int i = 0; i < 1000; i++) {
        float d[3];
        random_direction(&r, d);
        assert_true(fabsf(noh_sh_evaluate(6, coefs, d) -
                          (1.0f + d[0] * d[1] * d[2] * d[2] - 2.0f * d[1] * d[1] * d[1] * d[1] * d[0] + d[2])) < 1e-5f);
    }
}

/* A zonal function turned about an axis is the projection of the same function of the angle to that axis. */
static void zonal_functions_turn_by_scaling(void **state)
{
    static const float zonal[6] = { 0.9f, -0.4f, 0.7f, 0.3f, -0.8f, 0.5f };
    test_random r = test_random_from(4);
    (void)state;
    for (int i = 0; i < 300; i++) {
        float axis[3], d[3], coefs[NOH_SH_COUNT_MAX];
        double t, before = 0.0, now = 1.0, sum = 0.0;
        random_direction(&r, axis);
        random_direction(&r, d);
        noh_sh_from_zonal(6, zonal, axis, coefs);
        t = (double)axis[0] * d[0] + (double)axis[1] * d[1] + (double)axis[2] * d[2];
        for (unsigned l = 0; l < 6; l++) {
            const double next = ((2.0 * l + 1.0) * t * now - l * before) / (l + 1.0);
            sum += zonal[l] * sqrt((2.0 * l + 1.0) / (4.0 * PI)) * now;
            before = now;
            now = next;
        }
        assert_true(fabs(noh_sh_evaluate(6, coefs, d) - sum) < 1e-5);
    }
}

/* ---- rotation ---- */

static void matrix_of(const float q[4], double m[9])
{
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const double rows[9] = { 1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
                             2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                             2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y) };
    memcpy(m, rows, sizeof rows);
}

/* The function that was f(d) is f(inverse d): values agree in every direction, for every order and any rotation. */
static void turned_functions_are_the_same_elsewhere(void **state)
{
    test_random r = test_random_from(5);
    double worst = 0.0;
    (void)state;
    for (int i = 0; i < 2000; i++) {
        float q[4], d[3], was[3], rotation[9], from[NOH_SH_COUNT_MAX], to[NOH_SH_COUNT_MAX];
        double m[9], length = 0.0;
        const uint32_t order = 1u + (uint32_t)i % 6u;
        for (int k = 0; k < 4; k++) q[k] = test_random_float(&r, -1.0f, 1.0f);
        for (int k = 0; k < 4; k++) length += (double)q[k] * q[k];
        for (int k = 0; k < 4; k++) q[k] = (float)(q[k] / sqrt(length));
        matrix_of(q, m);
        for (int k = 0; k < 9; k++) rotation[k] = (float)m[k];
        for (uint32_t k = 0; k < NOH_SH_COUNT(order); k++) from[k] = test_random_float(&r, -1.0f, 1.0f);
        noh_sh_rotate(order, rotation, from, to);
        random_direction(&r, d);
        for (int k = 0; k < 3; k++) was[k] = (float)(m[k] * d[0] + m[3 + k] * d[1] + m[6 + k] * d[2]);
        length = fabs((double)noh_sh_evaluate(order, to, d) - noh_sh_evaluate(order, from, was));
        worst = length > worst ? length : worst;
    }
    print_message("rotation: %.2g\n", worst);
    assert_true(worst < 1e-5);
}

/* About z, coefficients of m and -m turn into each other by the angle m a. */
static void about_z_rotation_has_its_closed_form(void **state)
{
    const double a = 0.7;
    const float rotation[9] = { (float)cos(a), (float)-sin(a), 0, (float)sin(a), (float)cos(a), 0, 0, 0, 1 };
    test_random r = test_random_from(6);
    float from[NOH_SH_COUNT_MAX], to[NOH_SH_COUNT_MAX];
    (void)state;
    for (unsigned k = 0; k < NOH_SH_COUNT_MAX; k++) from[k] = test_random_float(&r, -1.0f, 1.0f);
    noh_sh_rotate(6, rotation, from, to);
    for (int l = 0; l < 6; l++) {
        for (int m = 0; m <= l; m++) {
            const double c = from[l * (l + 1) + m], s = m ? from[l * (l + 1) - m] : 0.0;
            assert_true(fabs(to[l * (l + 1) + m] - (cos(m * a) * c - sin(m * a) * s)) < 1e-5);
            if (m) assert_true(fabs(to[l * (l + 1) - m] - (sin(m * a) * c + cos(m * a) * s)) < 1e-5);
        }
    }
}

/* ---- environments ---- */

static void names_are_found(void **state)
{
    static const char *const names[] = { "white", "studio", "room", "sky" };
    (void)state;
    for (uint32_t i = 0; i < NOH_ENVIRONMENT_COUNT; i++) {
        const noh_environment *e = noh_environment_at(i);
        assert_string_equal(e->name, names[i]);
        assert_int_equal(noh_environment_find(names[i]), i);
        assert_true(e->lamp_count <= NOH_LAMPS_MAX);
        for (uint32_t k = 0; k < e->lamp_count; k++) {
            const float *d = e->lamps[k].direction;
            assert_true(fabs((double)d[0] * d[0] + (double)d[1] * d[1] + (double)d[2] * d[2] - 1.0) < 1e-6);
            assert_true(e->lamps[k].power <= 2 && e->lamps[k].edge >= -1.0f && e->lamps[k].edge < 1.0f);
        }
    }
    assert_int_equal(noh_environment_find("whit"), NOH_NONE);
    assert_int_equal(noh_environment_find(""), NOH_NONE);
}

/* No direction is darker than black, and the mean of none is far from the others'. */
static void built_in_radiance_is_sensible(void **state)
{
    const grid *g = make_grid();
    (void)state;
    for (uint32_t i = 0; i < NOH_ENVIRONMENT_COUNT; i++) {
        double mean[3] = { 0.0, 0.0, 0.0 };
        for (unsigned s = 0; s < RINGS * RING; s++) {
            float rgb[3];
            noh_environment_radiance(noh_environment_at(i), g->direction[s], rgb);
            for (int c = 0; c < 3; c++) {
                assert_true(rgb[c] >= 0.0f);
                mean[c] += rgb[c] * g->weight[s] / (4.0 * PI);
            }
        }
        print_message("%s: mean radiance %.3f %.3f %.3f\n", noh_environment_at(i)->name, mean[0], mean[1], mean[2]);
        for (int c = 0; c < 3; c++) assert_true(mean[c] > 0.3 && mean[c] < 1.1);
    }
}

/* Each lamp's coefficients against an integral over its angle with 200,000 steps in double precision. */
static void lamps_have_their_closed_form(void **state)
{
    static const float edges[] = { 0.9962f, 0.93f, 0.5f, 0.0f, -0.3f, -1.0f };
    (void)state;
    for (size_t e = 0; e < TEST_COUNT(edges); e++) {
        for (uint32_t power = 0; power < 3; power++) {
            noh_environment one = { .name = "one", .lamp_count = 1, .lamps = { { { 0, 0, 1 }, 0, 0, { 1, 1, 1 } } } };
            noh_light light;
            one.lamps[0].edge = edges[e];
            one.lamps[0].power = power;
            noh_light_from_environment(&one, 6, &light);
            for (unsigned l = 0; l < 6; l++) {
                const double width = 1.0 - (double)edges[e];
                double sum = 0.0;
                for (int i = 0; i < 200000; i++) {
                    const double s = (i + 0.5) / 200000.0, t = edges[e] + width * s;
                    double before = 0.0, now = 1.0;
                    for (unsigned k = 0; k < l; k++) {
                        const double next = ((2.0 * k + 1.0) * t * now - k * before) / (k + 1.0);
                        before = now;
                        now = next;
                    }
                    sum += pow(s, power) * now * width / 200000.0;
                }
                assert_true(fabs(light.coefs[l * (l + 1)][1] - 2.0 * PI * sqrt((2 * l + 1) / (4 * PI)) * sum) < 1e-5);
            }
            assert_true(light.coefs[5][0] == 0.0f || fabsf(light.coefs[5][0]) < 1e-6f); /* round about z */
        }
    }
}

/* Under white light a matte surface is white, whichever way it faces and however the light is turned; and a hemisphere
 * of radiance 1 lights a surface by the sine law (1 + cos a) / 2. */
static void a_furnace_is_white(void **state)
{
    const noh_environment half = { .name = "half", .lamp_count = 1, .lamps = { { { 0, 1, 0 }, 0, 0, { 1, 1, 1 } } } };
    static const float about_x[9] = { 1, 0, 0, 0, 0.6f, -0.8f, 0, 0.8f, 0.6f };
    test_random r = test_random_from(7);
    noh_light white, turned, up;
    (void)state;
    noh_light_from_environment(noh_environment_at(0), 6, &white);
    noh_light_rotate(&white, about_x, &turned);
    noh_light_from_environment(&half, 6, &up);
    for (int i = 0; i < 500; i++) {
        float n[3], rgb[3];
        random_direction(&r, n);
        noh_light_irradiance(&turned, n, rgb);
        for (int c = 0; c < 3; c++) assert_true(fabsf(rgb[c] - 1.0f) < 1e-5f);
        noh_light_irradiance(&up, n, rgb);
        assert_true(fabs(rgb[0] - (1.0 + n[1]) / 2.0) < 1e-5); /* odd bands above 1 of the cosine are 0: exact */
    }
}

/* A white face that looks ahead gets 1.1 under a uniform light, however bright, and less where the key is behind it. */
static void exposure_is_for_faces(void **state)
{
    static const float about[9] = { -1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, -1.0f };
    const noh_environment even = { .name = "even", .ambient = { 4.0f, 4.0f, 4.0f } };
    const noh_environment lamp = { .name = "lamp",
                                   .ambient = { 0.1f, 0.1f, 0.1f },
                                   .lamp_count = 1,
                                   .lamps = { { { 0.0f, 0.6f, 0.8f }, 0.5f, 1, { 9.0f, 9.0f, 9.0f } } } };
    noh_light light, turned;
    (void)state;
    noh_light_from_environment(&even, 3, &light);
    assert_float_equal(noh_light_exposure(&light, NULL), 1.1f / 4.0f, 1e-5f);
    memset(light.coefs, 0, sizeof light.coefs);
    assert_float_equal(noh_light_exposure(&light, NULL), 1.0f, 0.0f);
    noh_light_from_environment(&lamp, 3, &light);
    assert_true(noh_light_exposure(&light, about) > 1.3f * noh_light_exposure(&light, NULL));
    assert_true(noh_light_exposure(&light, about) < 2.0f * noh_light_exposure(&light, NULL)); /* its rim counts */
    noh_light_rotate(&light, about, &turned);
    assert_float_equal(noh_light_exposure(&light, about), noh_light_exposure(&turned, NULL), 1e-5f);
}

/* CRC-32C of lights and of what is made of them: the same on every processor. */
static void bits_are_the_same_everywhere(void **state)
{
    static const float turn[9] = { 0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0.0f, 0.48f, 0.64f, 0.6f };
    uint32_t crc = 0;
    (void)state;
    for (uint32_t i = 0; i < NOH_ENVIRONMENT_COUNT; i++) {
        noh_lobe lobe = { 0.7f, { 0.6f, 0.0f, -0.8f }, { 1.0f, 0.7f, 0.3f, 0.05f, -0.04f, 0.02f } };
        noh_light light, turned;
        float rgb[3], shaded[3], exposure;
        noh_light_from_environment(noh_environment_at(i), 6, &light);
        noh_light_rotate(&light, turn, &turned);
        noh_light_irradiance(&turned, turn, rgb);
        exposure = noh_light_exposure(&light, turn);
        crc = noh_crc32c(crc, &exposure, sizeof exposure);
        noh_lobe_turn(&lobe, turn, turn + 3);
        noh_lobe_shade(&lobe, 6, &turned, shaded);
        crc = noh_crc32c(crc, shaded, sizeof shaded);
        crc = noh_crc32c(crc, light.coefs, sizeof light.coefs);
        crc = noh_crc32c(crc, turned.coefs, sizeof turned.coefs);
        crc = noh_crc32c(crc, rgb, sizeof rgb);
    }
    assert_int_equal(crc, 0x579c39c2u);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_basis_is_the_known_one),
        cmocka_unit_test(the_basis_is_orthonormal),
        cmocka_unit_test(bands_add_up_to_legendre),
        cmocka_unit_test(the_cosine_lobe_is_the_known_one),
        cmocka_unit_test(what_fits_the_order_comes_back),
        cmocka_unit_test(zonal_functions_turn_by_scaling),
        cmocka_unit_test(turned_functions_are_the_same_elsewhere),
        cmocka_unit_test(about_z_rotation_has_its_closed_form),
        cmocka_unit_test(names_are_found),
        cmocka_unit_test(built_in_radiance_is_sensible),
        cmocka_unit_test(lamps_have_their_closed_form),
        cmocka_unit_test(a_furnace_is_white),
        cmocka_unit_test(exposure_is_for_faces),
        cmocka_unit_test(bits_are_the_same_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
