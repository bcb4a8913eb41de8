/* test_quat.c: the converter's angles and quaternions against libm. */
#include "support/support.h"

#include <math.h>
#include <string.h>

#include "convert/base/angle.h"
#include "convert/base/quat.h"

#define PI 3.14159265358979323846

static double worst;

static void see(double got, double expected)
{
    worst = fmax(worst, fabs(got - expected));
}

static void angles(void **state)
{
    (void)state;
    worst = 0.0;
    for (int i = 0; i <= 100000; ++i) {
        const double part = (double)i / 100000.0, degrees = part * 720.0 - 360.0;
        double s, c;
        angle_sin_cos_degrees(degrees, &s, &c);
        see(s, sin(degrees * PI / 180.0));
        see(c, cos(degrees * PI / 180.0));
        see(s * s + c * c, 1.0);
    }
    print_message("sine and cosine of degrees: %.2g\n", worst);
    assert_true(worst < 2e-15); /* most of it libm's: its argument is rounded to radians */
    worst = 0.0;
    for (int i = 0; i <= 100000; ++i) {
        const double part = (double)i / 100000.0;
        see(angle_sine(part * PI / 2.0), sin(part * PI / 2.0));
        see(angle_arc_tangent(part), atan(part));
    }
    print_message("sine of radians, arc tangent: %.2g\n", worst);
    assert_true(worst < 4e-16);
}

static void quarters_are_exact(void **state)
{
    (void)state;
    static const double sines[4] = { 0, 1, 0, -1 };
    for (int i = -20; i <= 20; ++i) {
        double s, c;
        angle_sin_cos_degrees(90.0 * i, &s, &c);
        assert_true(s == sines[i & 3] && c == sines[(i + 1) & 3]);
    }
    double s, c, t, d;
    angle_sin_cos_degrees(1e300, &s, &c);
    angle_sin_cos_degrees(fmod(1e300, 360.0), &t, &d);
    assert_true(s == t && c == d);
}

static void random_unit(test_random *r, double *q)
{
    do {
        for (int i = 0; i < 4; ++i) q[i] = (double)test_random_float(r, -1.0f, 1.0f);
    } while (!quat_normalize(q));
}

/* Two rotations `angle` apart. */
static void pair(test_random *r, double angle, double *a, double *b)
{
    double axis[4];
    random_unit(r, a);
    axis[3] = 0.0;
    do
        for (int i = 0; i < 3; ++i) axis[i] = (double)test_random_float(r, -1.0f, 1.0f);
    while (!quat_normalize(axis));
    const double turn[4] = { axis[0] * sin(angle / 2), axis[1] * sin(angle / 2), axis[2] * sin(angle / 2),
                             cos(angle / 2) };
    quat_multiply(a, turn, b);
}

static void slerp_of_every_angle(void **state)
{
    (void)state;
    static const double sizes[] = { 0.0,    1e-12, 1e-9, 1.9e-7, 2.1e-7, 1e-6, 1.9e-5,
                                    2.1e-5, 1e-3,  0.1,  1.0,    2.0,    3.0,  3.1415 };
    test_random r = test_random_from(1);
    double worst_angle = 0.0, worst_place = 0.0;
    for (int i = 0; i < 20000; ++i) {
        const double angle = sizes[(size_t)i % TEST_COUNT(sizes)], t = (double)test_random_float(&r, 0.0f, 1.0f);
        double a[4], b[4], middle[4];
        pair(&r, angle, a, b);
        if (i & 1)
            for (int k = 0; k < 4; ++k) b[k] = -b[k];
        quat_slerp(a, b, t, middle);
        worst_angle = fmax(worst_angle, fabs(quat_angle(a, b) - angle));
        worst_place = fmax(worst_place, fabs(quat_angle(a, middle) - angle * t));
        worst_place = fmax(worst_place, fabs(quat_angle(middle, b) - angle * (1.0 - t)));
        assert_true(fabs(quat_dot(middle, middle) - 1.0) < 1e-15);
    }
    print_message("angles %.2g, places on the arc %.2g radians\n", worst_angle, worst_place);
    assert_true(worst_angle < 2e-15 && worst_place < 4e-15);
}

static void nothing_has_no_direction(void **state)
{
    (void)state;
    double none[4] = { 0, 0, 1e-7, 0 }, endless[4] = { 0, 0, 0, INFINITY }, unknown[4] = { 0, (double)NAN, 0, 1 };
    assert_false(quat_normalize(none));
    assert_true(none[2] == 1e-7);
    assert_false(quat_normalize(endless));
    assert_false(quat_normalize(unknown));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(angles),
    cmocka_unit_test(quarters_are_exact),
    cmocka_unit_test(slerp_of_every_angle),
    cmocka_unit_test(nothing_has_no_direction),
};

TEST_MAIN(tests, NULL, NULL)
