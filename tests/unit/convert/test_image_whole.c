/* Pictures that were cut off: at each byte of a PNG and a JPEG the message says what is missing and where; whole ones
 * pass. */
#include "support/support.h"

#include <string.h>

#include "convert/base/image_whole.h"

static const unsigned char png[] = { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0, 0, 0, 2, 'I',
                                     'H',  'D', 'R', 1,   2,    9,    9,    9,    9, 0, 0, 0, 3,
                                     'I',  'D', 'A', 'T', 7,    7,    7,    9,    9, 9, 9, 0, 0,
                                     0,    0,   'I', 'E', 'N',  'D',  9,    9,    9, 9 };
/* With a fill byte, a comment, two scans, a stuffed byte and a restart. */
static const unsigned char jpeg[] = { 0xff, 0xd8, 0xff, 0xff, 0xfe, 0, 4,    'h',  'i', 0xff, 0xda, 0, 3,    1,   5,
                                      0xff, 0,    6,    0xff, 0xd3, 7, 0xff, 0xda, 0,   2,    8,    8, 0xff, 0xd9 };

static void expect_result(const unsigned char *bytes, size_t count, int result, const char *what)
{
    model_error error = { "", "" };
    assert_int_equal(image_is_cut(bytes, count, &error), result);
    assert_non_null(strstr(error.what, what));
}

static void expect_cut(const unsigned char *bytes, size_t count, const char *what)
{
    expect_result(bytes, count, 1, what);
}

static void each_cut_is_told(void **state)
{
    model_error error = { "", "" };
    (void)state;
    for (size_t i = 9; i < sizeof png; i++) {
        unsigned char *cut = test_aligned(png, i);
        expect_cut(cut, i, i > 34 && i < 37 ? "in the pixels at byte 22" : "was cut off");
        free(cut);
    }
    for (size_t i = 9; i < sizeof jpeg; i++) {
        const int in_pixels = (i > 14 && i < 23) || i > 25;
        unsigned char *cut = test_aligned(jpeg, i);
        expect_result(cut, i, in_pixels ? IMAGE_NO_END : 1, in_pixels ? "has no end marker" : "it was cut off; save");
        free(cut);
    }
    assert_int_equal(image_is_cut(png, sizeof png, &error), 0);
    assert_int_equal(image_is_cut(jpeg, sizeof jpeg, &error), 0);
}

static void a_header_alone_is_told(void **state)
{
    unsigned char bytes[sizeof png];
    (void)state;
    memcpy(bytes, png, 22);
    memcpy(bytes + 22, png + sizeof png - 12, 12);
    expect_cut(bytes, 34, "no pixels");
    memcpy(bytes, jpeg, 9);
    memcpy(bytes + 9, "\xff\xd9", 2);
    expect_cut(bytes, 11, "no pixels");
}

/* Decoders skip what stands between segments, until a frame begins. */
static void padding_is_skipped(void **state)
{
    static const unsigned char padded[] = { 0xff, 0xd8, 0xff, 0xe0, 0, 2, 0,    7,    0xff, 0xc0, 0,   2,
                                            0xff, 0xda, 0,    2,    8, 8, 0xff, 0xd9, 0,    0,    0xff };
    unsigned char moved[sizeof padded];
    model_error error = { "", "" };
    (void)state;
    assert_int_equal(image_is_cut(padded, sizeof padded, &error), 0);
    memcpy(moved, padded, sizeof padded);
    memcpy(moved + 6, padded + 8, 4);
    memset(moved + 10, 0, 2);
    expect_cut(moved, sizeof moved, "damaged at byte 10, where no segment begins: save it again");
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(each_cut_is_told), cmocka_unit_test(a_header_alone_is_told),
                                        cmocka_unit_test(padding_is_skipped) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
