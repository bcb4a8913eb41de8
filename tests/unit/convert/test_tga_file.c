/* TGA pictures: rows and columns in each order, alpha, runs; each cut is refused, and no change of bytes reads outside. */
#include "support/support.h"

#include <string.h>

#include "convert/base/tga_file.h"

/* Two rows of three pixels: blue, green and red bytes. */
#define ROW_A 1, 2, 3, 4, 5, 6, 7, 8, 9
#define ROW_B 11, 12, 13, 14, 15, 16, 17, 18, 19
#define HEAD(kind, bits, flags) 0, 0, kind, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 2, 0, bits, flags

static unsigned char *read_whole(const unsigned char *bytes, size_t count, uint32_t channels)
{
    unsigned char *exact = test_aligned(bytes, count), *rgba = NULL;
    model_error error = { "", "" };
    uint32_t size[3] = { 0, 0, 0 };
    assert_true(tga_begins(exact, count));
    if (tga_read(exact, count, 6, &size[0], &size[1], &size[2], &rgba, &error)) fail_msg("refused: %s", error.what);
    assert_true(size[0] == 3 && size[1] == 2 && size[2] == channels);
    free(exact);
    return rgba;
}

static void pixels_are(const unsigned char *bytes, size_t count, uint32_t channels, const unsigned char *reds,
                       int alpha)
{
    unsigned char *rgba = read_whole(bytes, count, channels);
    for (int i = 0; i < 6; i++) {
        assert_int_equal(rgba[4 * i], reds[i]);
        assert_int_equal(rgba[4 * i + 3], alpha);
    }
    free(rgba);
}

static void rows_and_columns(void **state)
{
    static const unsigned char up[] = { HEAD(2, 24, 0), ROW_A, ROW_B };
    static const unsigned char down[] = { HEAD(2, 24, 32), ROW_A, ROW_B };
    static const unsigned char left[] = { HEAD(2, 24, 48), ROW_A, ROW_B };
    static const unsigned char grey[] = { HEAD(3, 8, 32), 3, 6, 9, 13, 16, 19 };
    (void)state;
    pixels_are(up, sizeof up, 3, (const unsigned char[]){ 13, 16, 19, 3, 6, 9 }, 255);
    pixels_are(down, sizeof down, 3, (const unsigned char[]){ 3, 6, 9, 13, 16, 19 }, 255);
    pixels_are(left, sizeof left, 3, (const unsigned char[]){ 9, 6, 3, 19, 16, 13 }, 255);
    pixels_are(grey, sizeof grey, 1, (const unsigned char[]){ 3, 6, 9, 13, 16, 19 }, 255);
}

/* A run over the end of a row, then pixels that differ; a name comes before them. */
static const unsigned char runs[] = { 2,  0,   10,  0,    0, 0, 0, 0,  0, 0, 0, 0, 3,  0, 2, 0, 32,
                                      40, 'h', 'i', 0x83, 1, 2, 7, 77, 1, 1, 2, 8, 77, 1, 2, 9, 77 };

static void runs_and_alpha(void **state)
{
    unsigned char bytes[sizeof runs];
    (void)state;
    pixels_are(runs, sizeof runs, 4, (const unsigned char[]){ 7, 7, 7, 7, 8, 9 }, 77);
    memcpy(bytes, runs, sizeof runs);
    bytes[17] = 32; /* the fourth byte is not said to be alpha */
    pixels_are(bytes, sizeof bytes, 3, (const unsigned char[]){ 7, 7, 7, 7, 8, 9 }, 255);
}

static void refused(const unsigned char *bytes, size_t count, uint64_t most, const char *what)
{
    unsigned char *exact = test_aligned(bytes, count), *rgba = NULL;
    model_error error = { "", "" };
    uint32_t size[3];
    assert_int_equal(tga_read(exact, count, most, &size[0], &size[1], &size[2], &rgba, &error), 1);
    if (rgba || !strstr(error.what, what)) fail_msg("'%s', not '%s'", error.what, what);
    free(exact);
}

static void what_is_not_read_is_told(void **state)
{
    static const unsigned char palette[] = { 0, 1, 1, 0, 0, 1, 0, 24, 0, 0, 0, 0, 3, 0, 2, 0, 8, 0, 0 };
    static const unsigned char few[] = { HEAD(2, 16, 0), 0 }, grey[] = { HEAD(3, 16, 0), 0 };
    static const unsigned char png[20] = { 0x89, 'P', 'N', 'G' };
    (void)state;
    refused(palette, sizeof palette, 6, "with a palette, which is not read: save it as PNG");
    refused(few, sizeof few, 6, "it is a TGA picture of 16 bits a pixel; 24 and 32 are read");
    refused(grey, sizeof grey, 6, "it is a grey TGA picture of 16 bits a pixel; only 8 are read");
    refused(runs, sizeof runs, 5, "3 x 2 pixels; the limit is 5");
    for (size_t i = 19; i < sizeof runs; i++) refused(runs, i, 6, "was cut off");
    assert_false(tga_begins(runs, 18));
    assert_false(tga_begins(png, sizeof png));
}

static void changed_bytes_read_nothing_outside(void **state)
{
    test_random r = test_random_from(5);
    (void)state;
    for (int round = 0; round < 20000; round++) {
        unsigned char *exact = test_aligned(runs, sizeof runs), *rgba = NULL;
        model_error error = { "", "" };
        uint32_t size[3];
        for (int k = 0; k < 3; k++)
            exact[test_random_below(&r, sizeof runs)] = (unsigned char)test_random_below(&r, 256);
        if (tga_begins(exact, sizeof runs) &&
            tga_read(exact, sizeof runs, 1u << 20, &size[0], &size[1], &size[2], &rgba, &error) == 0) {
            assert_non_null(rgba);
        }
        free(rgba);
        free(exact);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_and_columns),
        cmocka_unit_test(runs_and_alpha),
        cmocka_unit_test(what_is_not_read_is_told),
        cmocka_unit_test(changed_bytes_read_nothing_outside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
