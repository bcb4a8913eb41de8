/* The plain C that replaces builtins gives their bits; interpolated quaternions are unit. */
#include "support/support.h"

#include <math.h>
#include <string.h>

#include "core/base/compiler_internal.h"
#include "core/base/math_internal.h"
#include "noh/low_core.h"

static float from_bits(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint32_t to_bits(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static void compare_root(uint32_t bits)
{
    const uint32_t got = to_bits(noh_sqrt_plain(from_bits(bits))), expected = to_bits(noh_sqrt(from_bits(bits)));
    const int both_nan = (got & 0x7fffffffu) > 0x7f800000u && (expected & 0x7fffffffu) > 0x7f800000u;
    if (got != expected && !both_nan) {
        fail_msg("root of %08x: %08x, not %08x", (unsigned)bits, (unsigned)got, (unsigned)expected);
    }
}

/* All signs and exponents with mantissas spread over their range, and those next to powers of two. */
static void plain_square_roots_equal_those_of_the_processor(void **state)
{
    uint64_t compared = 0;
    (void)state;
    for (uint64_t bits = 0; bits < 0x100000000u; bits += 1021) {
        compare_root((uint32_t)bits);
        compared++;
    }
    for (uint32_t top = 0; top < 512u; top++) {
        for (uint32_t low = 0; low < 64u; low++) {
            compare_root(top << 23 | low);
            compare_root(top << 23 | (0x7fffffu - low));
            compared += 2;
        }
    }
    print_message("# %lu roots\n", (unsigned long)compared);
}

/* Squares of floats of 12 bits are exact, and so are their roots. */
static void roots_of_squares_are_exact(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 4096u; i++) {
        const float root = (float)i;
        assert_int_equal(to_bits(noh_sqrt_plain(root * root)), to_bits(root));
        assert_int_equal(to_bits(noh_sqrt(root * root)), to_bits(root));
    }
    assert_int_equal(to_bits(noh_sqrt_plain(-0.0f)), 0x80000000u);
    assert_int_equal(to_bits(noh_sqrt_plain(from_bits(0x7f800000u))), 0x7f800000u);
    assert_true(noh_sqrt_plain(-1.0f) != noh_sqrt_plain(-1.0f));
}

static void plain_counts_of_zeros_equal_those_of_the_processor(void **state)
{
    test_random r = test_random_from(5);
    (void)state;
    for (uint32_t i = 0; i < 64u; i++) {
        for (uint32_t round = 0; round < 100u; round++) {
            const uint64_t word = (((uint64_t)test_random_u32(&r) << 32 | test_random_u32(&r)) | 1u) << i;
            assert_int_equal(noh_trailing_zeros_plain(word), i);
            assert_int_equal(noh_trailing_zeros(word), i);
            if (i < 32u) {
                const uint32_t low = (test_random_u32(&r) | 0x80000000u) >> i;
                assert_int_equal(noh_leading_zeros_plain(low), i);
                assert_int_equal(noh_leading_zeros(low), i);
            }
        }
    }
}

/* Halfway between rotations that are far apart a plain mixture has 0.7 of the length or less: skinned by it a limb
 * shrinks. The result is also between the two: at equal angles from both at t = 1/2. */
static void nlerp_is_unit(void **state)
{
    test_random r = test_random_from(9);
    float shortest = 1.0f;
    (void)state;
    for (int round = 0; round < 20000; round++) {
        float a[4], b[4], mixed[4], out[4], sign;
        const float t = round % 2 ? 0.5f : test_random_float(&r, 0.0f, 1.0f);
        for (int i = 0; i < 4; i++) {
            a[i] = test_random_float(&r, -1.0f, 1.0f);
            b[i] = test_random_float(&r, -1.0f, 1.0f);
        }
        noh_quat_normalize(a);
        noh_quat_normalize(b);
        noh_quat_nlerp(a, b, t, out);
        sign = noh_quat_dot(a, b) < 0.0f ? -1.0f : 1.0f;
        for (int i = 0; i < 4; i++) {
            mixed[i] = a[i] * (1.0f - t) + sign * b[i] * t;
        }
        shortest = noh_quat_dot(mixed, mixed) < shortest ? noh_quat_dot(mixed, mixed) : shortest;
        assert_true(fabsf(noh_quat_dot(out, out) - 1.0f) < 1e-6f);
        if (t == 0.5f) {
            assert_true(fabsf(noh_quat_dot(out, a) - sign * noh_quat_dot(out, b)) < 1e-6f);
        }
    }
    assert_true(shortest < 0.51f); /* else every mixture was about unit anyway */
}

/* The source's example: an axis of (0.2, 0.6, -0.3) and an angle of 0.342. Its text writes w first, its code's numbers
 * lie in memory as x, y, z, w: by the text's order the rotation is another one. */
static void w_is_last(void **state)
{
    const double length = sqrt(0.2 * 0.2 + 0.6 * 0.6 + 0.3 * 0.3), angle = 0.342;
    const double axis[3] = { 0.2 / length, 0.6 / length, -0.3 / length };
    const float v[3] = { 1.0f, -2.0f, 0.5f };
    float turn[3], q[4], ours[3], theirs[3], off = 0.0f;
    double along = 0.0, cross[3];
    (void)state;
    for (int i = 0; i < 3; i++) {
        turn[i] = (float)(axis[i] * angle);
        along += axis[i] * (double)v[i];
        cross[i] = axis[(i + 1) % 3] * (double)v[(i + 2) % 3] - axis[(i + 2) % 3] * (double)v[(i + 1) % 3];
    }
    noh_quat_from_rotation(turn, q);
    assert_true(fabs((double)q[3] - cos(0.171)) < 1e-6);
    const float text[4] = { q[3], q[0], q[1], q[2] };
    noh_quat_rotate(q, v, ours);
    noh_quat_rotate(text, v, theirs);
    for (int i = 0; i < 3; i++) {
        const double right = cos(angle) * (double)v[i] + sin(angle) * cross[i] +
                             (1.0 - cos(angle)) * along * axis[i]; /* Rodrigues */
        assert_true(fabs((double)ours[i] - right) < 1e-5);
        off = fmaxf(off, fabsf(theirs[i] - (float)right));
    }
    assert_true(off > 1.0f);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(plain_square_roots_equal_those_of_the_processor),
    cmocka_unit_test(roots_of_squares_are_exact),
    cmocka_unit_test(plain_counts_of_zeros_equal_those_of_the_processor),
    cmocka_unit_test(nlerp_is_unit),
    cmocka_unit_test(w_is_last),
};

TEST_MAIN(tests, NULL, NULL)
