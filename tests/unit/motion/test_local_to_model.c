/* Tests of local_to_model.c: matrices whose bits do not depend on the processor. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "noh/low_motion.h"
#include "support/support.h"

/* Lane by lane the product of the plain loop, to the bit: zeros of both signs, denormals, infinities and NaNs included;
 * in place too. */
static void products_have_the_bits_of_the_plain_loop(void **state)
{
    static const float special[] = { 0.0f, -0.0f, 1e-40f, -1e-40f, 3e38f, -3e38f, INFINITY, 1.0f };
    test_random r = test_random_from(77);
    (void)state;
    for (int round = 0; round < 4000; round++) {
        float a[12], b[12], want[12], got[12];
        for (int i = 0; i < 12; i++) {
            a[i] = round % 3 ? test_random_float(&r, -2.0f, 2.0f) : special[test_random_below(&r, 8)];
            b[i] = round % 5 ? test_random_float(&r, -2.0f, 2.0f) : special[test_random_below(&r, 8)];
        }
        for (int i = 0; i < 12; i++) {
            const float *row = a + i / 4 * 4;
            want[i] = row[0] * b[i % 4] + row[1] * b[4 + i % 4] + row[2] * b[8 + i % 4];
            if (i % 4 == 3) want[i] += row[3];
        }
        noh_matrix_multiply(a, b, got);
        for (int i = 0; i < 12; i++) assert_true(isnan(want[i]) ? isnan(got[i]) : memcmp(&want[i], &got[i], 4) == 0);
        memcpy(got, b, sizeof got);
        noh_matrix_multiply(a, got, got);
        for (int i = 0; i < 12; i++) assert_true(isnan(want[i]) ? isnan(got[i]) : memcmp(&want[i], &got[i], 4) == 0);
        noh_matrix_multiply(a, b, a);
        for (int i = 0; i < 12; i++) assert_true(isnan(want[i]) ? isnan(a[i]) : memcmp(&want[i], &a[i], 4) == 0);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(products_have_the_bits_of_the_plain_loop),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
