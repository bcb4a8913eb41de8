/* Tests of runtime/core/base/{trig,quat}.c: the stated errors, measured against the C library in double. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>

#include "core/base/trig_internal.h"
#include "noh/low_core.h"

#define PI 3.14159265358979323846

/* An emulated processor looks at every seventh number. */
static int stride(void)
{
    return getenv("NOH_EMULATED") && !getenv("NOH_LONG") ? 7 : 1;
}

static double worse(double worst, double error)
{
    return fabs(error) > worst ? fabs(error) : worst;
}

static void sin_and_cos_are_close(void **state)
{
    double worst = 0.0, far = 0.0, turns = 0.0, small = 0.0;
    float s, c;
    const int every = stride();
    (void)state;
    for (int i = -2000000; i <= 2000000; i += every) {
        float x = (float)i * 1e-5f;
        noh_sin_cos(x, &s, &c);
        worst = worse(worse(worst, (double)s - sin((double)x)), (double)c - cos((double)x));
    }
    for (int i = -1000000; i <= 1000000; i += every) {
        float x = (float)i;
        noh_sin_cos(x, &s, &c);
        far = worse(worse(far, (double)s - sin((double)x)), (double)c - cos((double)x));
    }
    for (uint32_t i = 0; i < 4000000u; i += (uint32_t)every) {
        uint32_t turn = i * 1073u;
        noh_sin_cos_turn(turn, &s, &c);
        turns = worse(worse(turns, (double)s - sin((double)turn * PI / 2147483648.0)),
                      (double)c - cos((double)turn * PI / 2147483648.0));
        turn = i + 1u;
        noh_sin_cos_turn(turn, &s, &c);
        small = worse(small, (double)s / sin((double)turn * PI / 2147483648.0) - 1.0);
    }
    print_message("sin, cos %.3g, to 1e6 %.3g, turns %.3g, relative near zero %.3g\n", worst, far, turns, small);
    assert_true(worst <= 1.2e-7 && far <= 1.2e-7 && turns <= 1.2e-7 && small <= 3e-7);
    for (uint32_t q = 0; q < 4; q++) {
        static const float sines[] = { 0, 1, 0, -1 };
        noh_sin_cos_turn(q << 30, &s, &c);
        assert_true(s == sines[q] && c == sines[(q + 1u) % 4u]);
    }
    noh_sin_cos(NAN, &s, &c);
    assert_true(s == 0.0f && c == 1.0f);
    noh_sin_cos(1e30f, &s, &c);
    assert_true(s == 0.0f && c == 1.0f);
}

static void atan2_is_close(void **state)
{
    double worst = 0.0, relative = 0.0;
    const int every = stride();
    (void)state;
    for (int i = 0; i < 2000000; i += every) {
        double a = ((double)i / 1000000.0 - 1.0) * PI, r = pow(10.0, (double)(i % 13) - 6.0);
        float y = (float)(sin(a) * r), x = (float)(cos(a) * r);
        double error = (double)noh_atan2(y, x) - atan2((double)y, (double)x);
        worst = worse(worst, error);
        if (fabs(a) < 0.5 && y != 0.0f) relative = worse(relative, error / atan2((double)y, (double)x));
    }
    print_message("atan2 %.3g, relative %.3g\n", worst, relative);
    assert_true(worst <= 4e-7 && relative <= 3e-7);
    assert_true(noh_atan2(0.0f, 0.0f) == 0.0f);
}

static void log2_is_close(void **state)
{
    double worst = 0.0, near_one = 0.0;
    const int every = stride();
    (void)state;
    for (int i = 0; i < 4000000; i += every) {
        const float x = (float)exp2((double)i * 6e-5 - 120.0), y = 0.5f + (float)i * 2.5e-7f;
        const double exact = log2((double)x);
        worst = worse(worst, ((double)noh_log2(x) - exact) / fmax(1.0, fabs(exact)));
        near_one = worse(near_one, (double)noh_log2(y) - log2((double)y));
    }
    print_message("log2 %.3g, near one %.3g\n", worst, near_one);
    assert_true(worst <= 2e-7 && near_one <= 2e-7);
    for (int e = -149; e < 128; e++) assert_true(noh_log2((float)ldexp(1.0, e)) == (float)e);
    assert_true(noh_log2(0.0f) == -150.0f && noh_log2(-1.0f) == -150.0f && noh_log2(NAN) == -150.0f);
}

static void exp2_is_close(void **state)
{
    double worst = 0.0;
    const int every = stride();
    (void)state;
    for (int i = -1259999; i <= 1279989; i += every) {
        float x = (float)i * 1e-4f;
        worst = worse(worst, (double)noh_exp2(x) / exp2((double)x) - 1.0);
    }
    print_message("exp2 relative %.3g\n", worst);
    assert_true(worst <= 2e-7);
    assert_true(noh_exp2(0.0f) == 1.0f && noh_exp2(10.0f) == 1024.0f && noh_exp2(-200.0f) == 0.0f);
    assert_true(noh_exp2(NAN) == 0.0f && noh_exp2(1e30f) > 3.39e38f && noh_exp2(1e30f) < INFINITY);
}

static void turns_are_reduced(void **state)
{
    (void)state;
    assert_int_equal(noh_turn_from_radians(0.0f), 0);
    assert_true(fabs((double)noh_turn_from_radians((float)(PI / 2.0)) - 1073741824.0) < 200.0);
    assert_true(fabsf(noh_radians_from_turn(0xc0000000u) + (float)(PI / 2.0)) < 1e-6f);
    for (int i = -300; i < 300; i++) {
        float x = (float)i * 0.0104f;
        assert_true(fabsf(noh_radians_from_turn(noh_turn_from_radians(x)) - x) < 4e-7f);
    }
}

static void quaternions_rotate_as_defined(void **state)
{
    (void)state;
    for (int i = 1; i < 5000; i++) {
        float v[3] = { (float)sin(i * 1.7), (float)sin(i * 2.3 + 1.0), (float)cos(i * 0.9) }, q[4], p[4], back[3],
              turned[3];
        float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]), scale = (float)(i % 314) * 0.01f / length;
        double angle = (double)scale * (double)length, axis[3], dot = 0.0;
        for (int k = 0; k < 3; k++) {
            v[k] *= scale;
            axis[k] = angle > 0.0 ? (double)v[k] / angle : 0.0;
        }
        noh_quat_from_rotation(v, q);
        assert_true(fabsf(noh_quat_dot(q, q) - 1.0f) < 1e-6f);
        noh_quat_to_rotation(q, back);
        for (int k = 0; k < 3; k++) assert_true(fabsf(back[k] - v[k]) < 4e-6f);
        /* Rodrigues' formula in double */
        {
            double x[3] = { 0.3, -1.1, 0.7 };
            float xf[3] = { 0.3f, -1.1f, 0.7f };
            for (int k = 0; k < 3; k++) dot += axis[k] * x[k];
            noh_quat_rotate(q, xf, turned);
            for (int k = 0; k < 3; k++) {
                int a = (k + 1) % 3, b = (k + 2) % 3;
                double cross = axis[a] * x[b] - axis[b] * x[a];
                double want = x[k] * cos(angle) + cross * sin(angle) + axis[k] * dot * (1.0 - cos(angle));
                assert_true(fabs((double)turned[k] - want) < 2e-6);
            }
        }
        noh_quat_conjugate(q, p);
        noh_quat_mul(q, p, p);
        assert_true(fabsf(p[3] - 1.0f) < 1e-6f && fabsf(p[0]) + fabsf(p[1]) + fabsf(p[2]) < 1e-6f);
    }
}

/* Without the hemisphere fix, halfway between q and -q's neighbour lies nowhere near either. */
static void nlerp_takes_the_shorter_way(void **state)
{
    float a[4] = { 0, 0, 0, 1 }, b[4] = { 0, 0, -0.1f, -0.99498744f }, naive[4], out[4];
    (void)state;
    for (int i = 0; i < 4; i++) naive[i] = 0.5f * a[i] + 0.5f * b[i];
    noh_quat_normalize(naive);
    noh_quat_nlerp(a, b, 0.5f, out);
    assert_true(fabsf(noh_quat_dot(naive, a)) < 0.1f);
    assert_true(noh_quat_dot(out, a) > 0.99f);
}

static void degenerate_quaternions_become_unit(void **state)
{
    float zero[4] = { 0, 0, 0, 0 }, half[4] = { 1, 0, 0, 0 }, twist[4];
    (void)state;
    noh_quat_normalize(zero);
    assert_true(zero[3] == 1.0f);
    noh_quat_twist(half, 1, twist); /* half a turn about x has no twist about y */
    assert_true(twist[3] == 1.0f && twist[1] == 0.0f);
    noh_quat_twist(half, 0, twist);
    assert_true(twist[0] == 1.0f);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sin_and_cos_are_close),
        cmocka_unit_test(atan2_is_close),
        cmocka_unit_test(exp2_is_close),
        cmocka_unit_test(log2_is_close),
        cmocka_unit_test(turns_are_reduced),
        cmocka_unit_test(quaternions_rotate_as_defined),
        cmocka_unit_test(nlerp_takes_the_shorter_way),
        cmocka_unit_test(degenerate_quaternions_become_unit),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
