/* Tests of dual_quaternion.c: matrices split into a rotation, a translation and a stretch. Meshes
 * skinned by them are in test_skin. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "deform/skin/skin_internal.h"
#include "noh/deform.h"
#include "noh/low_core.h"

/* The matrix of a split transform: rows of 3 x 4. */
static void matrix_of(const float q[4], const float scale[3], const float t[3], float m[12])
{
    for (int c = 0; c < 3; c++) {
        float axis[3] = { 0.0f, 0.0f, 0.0f }, turned[3];
        axis[c] = scale[c];
        noh_quat_rotate(q, axis, turned);
        for (int r = 0; r < 3; r++) m[4 * r + c] = turned[r];
    }
    for (int r = 0; r < 3; r++) m[4 * r + 3] = t[r];
}

/* R H x + t: where a vertex is moved to. */
static void move(const noh_dual_quaternion *d, const float p[3], float out[3])
{
    const float *q = d->real, *e = d->dual, *h = d->stretch;
    float stretched[3];
    for (int r = 0; r < 3; r++) stretched[r] = h[3 * r] * p[0] + h[3 * r + 1] * p[1] + h[3 * r + 2] * p[2];
    noh_quat_rotate(q, stretched, out);
    for (int i = 0; i < 3; i++) { /* 2 dual * conjugate(real) */
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] += 2.0f * (q[3] * e[i] - e[3] * q[i] + q[j] * e[k] - q[k] * e[j]);
    }
}

static void expect_same(const float m[12], double within)
{
    static const float points[4][3] = {
        { 0.0f, 0.0f, 0.0f }, { 1.0f, 0.2f, -0.4f }, { -0.3f, 1.0f, 0.5f }, { 0.1f, -0.6f, 1.0f }
    };
    noh_dual_quaternion d;
    float length = 0.0f, across = 0.0f;
    noh_dual_quaternion_from_matrix(m, &d);
    for (int i = 0; i < 4; i++) {
        length += d.real[i] * d.real[i];
        across += d.real[i] * d.dual[i];
    }
    assert_true(fabsf(length - 1.0f) < 1e-5f && fabsf(across) < 1e-5f); /* a rigid motion */
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < r; c++) assert_true(fabsf(d.stretch[3 * r + c] - d.stretch[3 * c + r]) < 1e-4f);
    }
    for (int k = 0; k < 4; k++) {
        float got[3];
        move(&d, points[k], got);
        for (int r = 0; r < 3; r++) {
            const float want = m[4 * r] * points[k][0] + m[4 * r + 1] * points[k][1] + m[4 * r + 2] * points[k][2] +
                               m[4 * r + 3];
            assert_true(fabs((double)(got[r] - want)) < within);
        }
    }
}

static const float axes[6][3] = { { 1, 0, 0 },       { 0, 1, 0 },        { 0, 0, 1 },
                                  { 0.6f, 0.8f, 0 }, { 0, -0.6f, 0.8f }, { 0.48f, -0.6f, 0.64f } };
static const float offset[3] = { 0.7f, -1.3f, 0.4f }, ones[3] = { 1.0f, 1.0f, 1.0f };

/* At half a turn the quaternion's w is 0: dividing by w would leave no direction. */
static void rotations_by_any_angle(void **state)
{
    (void)state;
    for (int a = 0; a < 6; a++) {
        for (int degrees = -360; degrees <= 360; degrees += 15) {
            const float half = (float)degrees * 0.00872664626f, s = sinf(half);
            const float q[4] = { axes[a][0] * s, axes[a][1] * s, axes[a][2] * s, cosf(half) };
            float m[12];
            matrix_of(q, ones, offset, m);
            expect_same(m, 2e-5);
        }
    }
}

/* Exact half turns; a rounded angle never gives one. */
static void exact_half_turns(void **state)
{
    (void)state;
    for (int a = 0; a < 3; a++) {
        float m[12] = { -1, 0, 0, 0.5f, 0, -1, 0, 0.25f, 0, 0, -1, 0.125f };
        noh_dual_quaternion d;
        m[5 * a] = 1.0f;
        expect_same(m, 1e-6);
        noh_dual_quaternion_from_matrix(m, &d);
        assert_true(fabsf(fabsf(d.real[a]) - 1.0f) < 1e-6f && fabsf(d.real[3]) < 1e-6f);
    }
}

/* Axes stretched by as much as 1 to 1,000, and shear, go into the stretch. */
static void stretches_are_kept(void **state)
{
    static const float scales[4][3] = {
        { 2.0f, 0.5f, 1.0f }, { 1000.0f, 1.0f, 1.0f }, { 0.001f, 1.0f, 0.1f }, { 3.0f, 3.0f, 3.0f }
    };
    (void)state;
    for (int k = 0; k < 4; k++) {
        const float q[4] = { 0.1f, 0.7f, -0.1f, 0.7f };
        float unit[4], m[12];
        memcpy(unit, q, sizeof unit);
        noh_quat_normalize(unit);
        matrix_of(unit, scales[k], offset, m);
        expect_same(m, 1e-4 * (double)(scales[k][0] > 1.0f ? scales[k][0] : 1.0f));
    }
    {
        const float sheared[12] = { 1.0f, 0.6f, 0.0f, 1.0f, 0.0f, 1.0f, -0.3f, 2.0f, 0.0f, 0.0f, 1.0f, 3.0f };
        expect_same(sheared, 1e-5);
    }
}

/* A mirror is no rotation: the stretch takes the sign. */
static void mirrors_go_into_the_stretch(void **state)
{
    (void)state;
    for (int a = 0; a < 6; a++) {
        float q[4] = { 0.1f, 0.7f, -0.1f, 0.7f }, scale[3] = { 1.0f, 2.0f, 0.5f }, m[12];
        if (a < 3) {
            q[0] = q[1] = q[2] = q[3] = 0.5f; /* the axes change places */
        }
        scale[a % 3] = -scale[a % 3];
        noh_quat_normalize(q);
        matrix_of(q, scale, offset, m);
        expect_same(m, 2e-5);
    }
}

/* A joint that is scaled to nothing, or to a plane, has no rotation; its numbers are still finite and its translation
 * is kept. */
static void joints_of_no_volume_stay_finite(void **state)
{
    static const float flat[12] = { 1, 0, 0, 4, 0, 1, 0, 5, 0, 0, 0, 6 },
                       nothing[12] = { 0, 0, 0, 4, 0, 0, 0, 5, 0, 0, 0, 6 };
    (void)state;
    expect_same(flat, 1e-5);
    expect_same(nothing, 1e-5);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rotations_by_any_angle),
        cmocka_unit_test(exact_half_turns),
        cmocka_unit_test(stretches_are_kept),
        cmocka_unit_test(mirrors_go_into_the_stretch),
        cmocka_unit_test(joints_of_no_volume_stay_finite),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
