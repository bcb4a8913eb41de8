/* Pictures of each format: BMP and Photoshop's pixels, each cut is refused, and what is not read is named. */
#include "support/support.h"

#include <string.h>

#include "convert/base/image_file.h"

#define SHORT(n) (n) >> 8, (n)&255
#define LONG(n) 0, 0, SHORT(n)
#define BMP_SHORT(n) (n), 0
#define BMP_LONG(n) (n), 0, 0, 0

static int decode(const unsigned char *bytes, size_t count, image_file *image, model_error *error)
{
    unsigned char *exact = test_aligned(bytes, count);
    uint64_t pixels_left = 100;
    const int failed = image_decode(exact, count, &pixels_left, image, error);
    if (failed) assert_null(image->rgba);
    free(exact);
    return failed;
}

static void pixels_are(const unsigned char *bytes, size_t count, uint32_t channels, const unsigned char *rgba,
                       size_t rgba_bytes)
{
    image_file image;
    model_error error = { "", "" };
    if (decode(bytes, count, &image, &error)) fail_msg("refused: %s", error.what);
    assert_int_equal((size_t)image.width * image.height * 4, rgba_bytes);
    assert_int_equal(image.channels, channels);
    assert_memory_equal(image.rgba, rgba, rgba_bytes);
    free(image.rgba);
}

static uint32_t bits_of(const unsigned char *bytes, size_t count)
{
    image_file image;
    model_error error;
    assert_int_equal(decode(bytes, count, &image, &error), 0);
    free(image.rgba);
    return image.bits;
}

static void refused(const unsigned char *bytes, size_t count, const char *what)
{
    image_file image;
    model_error error = { "", "" };
    assert_int_equal(decode(bytes, count, &image, &error), 1);
    if (!strstr(error.what, what)) fail_msg("'%s', not '%s'", error.what, what);
}

/* From the mark on: each cut, and each change of a byte, which may make no sense but reads nothing outside. */
static void cuts_and_changes(const unsigned char *bytes, size_t count, size_t mark)
{
    image_file image;
    model_error error;
    for (size_t i = mark; i < count; i++) refused(bytes, i, "cut off");
    for (size_t i = 0; i < count; i++) {
        unsigned char *changed = test_aligned(bytes, count);
        for (unsigned value = 1; value < 256; value = value * 2 + 1) {
            changed[i] = (unsigned char)(bytes[i] ^ value);
            if (!decode(changed, count, &image, &error)) free(image.rgba);
        }
        free(changed);
    }
}

/* ---- BMP ---- */

#define BMP(width, height, bits, packing, begin)                                                              \
    'B', 'M', BMP_LONG(0), BMP_LONG(0), BMP_LONG(begin), BMP_LONG(40), BMP_LONG(width), height, BMP_SHORT(1), \
        BMP_SHORT(bits), BMP_LONG(packing), BMP_LONG(0), BMP_LONG(0), BMP_LONG(0), BMP_LONG(0), BMP_LONG(0)
#define DOWN(n) 256 - (n), 255, 255, 255
#define DOWN_MOST 0, 0, 0, 128

static void bmp_has_rows_and_palettes(void **state)
{
    static const unsigned char up[] = { BMP(1, BMP_LONG(2), 24, 0, 54), 3, 2, 1, 0, 6, 5, 4, 0 };
    static const unsigned char down[] = { BMP(1, DOWN(2), 24, 0, 54), 3, 2, 1, 0, 6, 5, 4, 0 };
    static const unsigned char palette[] = { BMP(2, BMP_LONG(1), 8, 0, 62), 3, 2, 1, 0, 6, 5, 4, 0, 1, 0, 0, 0 };
    static const unsigned char odd[] = { BMP(3, BMP_LONG(1), 4, 0, 62), 3, 2, 1, 0, 6, 5, 4, 0, 0x10, 0x1f, 0, 0 };
    unsigned char outside[sizeof palette];
    (void)state;
    pixels_are(odd, sizeof odd, 3, (const unsigned char[]){ 4, 5, 6, 255, 1, 2, 3, 255, 4, 5, 6, 255 }, 12);
    memcpy(outside, odd, sizeof odd);
    outside[63] = 0x21; /* the last pixel, in half a byte */
    refused(outside, sizeof outside, "colours that its palette lacks");
    pixels_are(up, sizeof up, 3, (const unsigned char[]){ 4, 5, 6, 255, 1, 2, 3, 255 }, 8);
    pixels_are(down, sizeof down, 3, (const unsigned char[]){ 1, 2, 3, 255, 4, 5, 6, 255 }, 8);
    pixels_are(palette, sizeof palette, 3, (const unsigned char[]){ 4, 5, 6, 255, 1, 2, 3, 255 }, 8);
    memcpy(outside, palette, sizeof palette);
    outside[63] = 2;
    refused(outside, sizeof outside, "colours that its palette lacks");
    cuts_and_changes(up, sizeof up, 55);
    cuts_and_changes(palette, sizeof palette, 62);
}

static void bmp_that_is_not_read_says_so(void **state)
{
    static const unsigned char packed[] = { BMP(1, BMP_LONG(1), 8, 1, 58), 0, 0, 0, 0, 1, 0, 0, 1 };
    static const unsigned char narrow[] = { BMP(0, DOWN_MOST, 8, 0, 54), 0, 0, 0, 0 };
    /* clang-format off */
    static const unsigned char first[] = {
        'B', 'M', BMP_LONG(0), BMP_LONG(0), BMP_LONG(38), BMP_LONG(12), BMP_SHORT(1), BMP_SHORT(4), BMP_SHORT(1),
        BMP_SHORT(4), 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 0x10, 0, 0, 0, 0x20, 0, 0, 0, 0x30, 0, 0, 0, 0x10, 0,
        0, 0, 0
    };
    /* clang-format on */
    (void)state;
    refused(narrow, sizeof narrow, "damaged"); /* in no time: it has no pixel in 2,147,483,648 rows */
    refused(first, sizeof first, "a BMP picture of OS/2 with a palette, which is not read: save it as PNG");
    refused(packed, sizeof packed, "a BMP picture with packed pixels, which is not read: save it as PNG");
}

/* ---- Photoshop ---- */

#define PSD(channels, height, width, bits, mode) \
    '8', 'B', 'P', 'S', SHORT(1), 0, 0, 0, 0, 0, 0, SHORT(channels), LONG(height), LONG(width), SHORT(bits), SHORT(mode)
#define NO_SECTIONS LONG(0), LONG(0), LONG(0)
#define LAYERS(number) LONG(0), LONG(0), LONG(8), LONG(2), number, 0, 0

static void psd_has_its_flattened_picture(void **state)
{
    static const unsigned char plain[] = { PSD(3, 2, 1, 8, 3), NO_SECTIONS, SHORT(0), 1, 4, 2, 5, 3, 6 };
    static const unsigned char packed[] = { PSD(3, 1, 3, 8, 3),
                                            NO_SECTIONS,
                                            SHORT(1),
                                            SHORT(2),
                                            SHORT(4),
                                            SHORT(4),
                                            0xfe,
                                            7,
                                            2,
                                            8,
                                            9,
                                            10,
                                            0x80,
                                            0xfe,
                                            6,
                                            0x80 };
    static const unsigned char wide[] = { PSD(1, 1, 2, 16, 1), NO_SECTIONS, SHORT(0), 0xff, 0xff, 0x7f, 0xff };
    (void)state;
    pixels_are(plain, sizeof plain, 3, (const unsigned char[]){ 1, 2, 3, 255, 4, 5, 6, 255 }, 8);
    pixels_are(packed, sizeof packed, 3, (const unsigned char[]){ 7, 8, 6, 255, 7, 9, 6, 255, 7, 10, 6, 255 }, 12);
    pixels_are(wide, sizeof wide, 1, (const unsigned char[]){ 255, 255, 255, 255, 127, 127, 127, 255 }, 8);
    assert_int_equal(bits_of(wide, sizeof wide), 16);
    assert_int_equal(bits_of(plain, sizeof plain), 8);
    cuts_and_changes(plain, sizeof plain, 27);
    cuts_and_changes(packed, sizeof packed, 27);
    cuts_and_changes(wide, sizeof wide, 27);
}

/* The transparency of layers: their colours are blended with white by it. A channel of alpha: they are not. */
static void psd_alpha_is_of_layers_or_a_channel(void **state)
{
    static const unsigned char channel[] = { PSD(4, 1, 1, 8, 3), NO_SECTIONS, SHORT(0), 240, 190, 140, 128 };
    static const unsigned char layers[] = { PSD(4, 1, 1, 8, 3), LAYERS(SHORT(0xffff)), SHORT(0), 227, 177, 127, 128 };
    static const unsigned char other[] = { PSD(4, 1, 1, 8, 3), LAYERS(SHORT(0xffff)), SHORT(0), 200, 100, 0, 128 };
    /* clang-format off */
    static const unsigned char wide[] = {
        PSD(4, 1, 1, 16, 3), LONG(0), LONG(0), LONG(20), LONG(0), LONG(0), '8', 'B', 'I', 'M', 'M', 't', '1', '6',
        LONG(0), SHORT(0), 227, 227, 177, 177, 127, 127, 128, 128
    };
    /* clang-format on */
    (void)state;
    pixels_are(wide, sizeof wide, 4, (const unsigned char[]){ 199, 100, 0, 128 }, 4);
    cuts_and_changes(wide, sizeof wide, 27);
    pixels_are(channel, sizeof channel, 4, (const unsigned char[]){ 240, 190, 140, 128 }, 4);
    pixels_are(layers, sizeof layers, 4, (const unsigned char[]){ 199, 100, 0, 128 }, 4);
    pixels_are(other, sizeof other, 4, (const unsigned char[]){ 200, 100, 0, 128 }, 4);
    cuts_and_changes(layers, sizeof layers, 27);
}

static void psd_that_is_not_read_says_so(void **state)
{
    static const unsigned char cmyk[] = { PSD(4, 1, 1, 8, 4), NO_SECTIONS, SHORT(0), 1, 2, 3, 4 };
    static const unsigned char deep[] = { PSD(3, 1, 1, 32, 3), NO_SECTIONS, SHORT(0), 1, 2, 3, 4 };
    static const unsigned char white[] = {
        PSD(3, 1, 1, 8, 3), LONG(0), LONG(17), '8', 'B', 'I', 'M', 4, 0x21, 0, 0, LONG(5), LONG(1),
        0 /* no */,         LONG(0), SHORT(0), 255, 255, 255
    };
    static const unsigned char zip[] = { PSD(3, 1, 1, 8, 3), NO_SECTIONS, SHORT(2), 1, 2, 3, 4 };
    unsigned char large[sizeof cmyk];
    (void)state;
    refused(zip, sizeof zip, "a Photoshop file packed with ZIP, which is not read: save it as PNG");
    memcpy(large, cmyk, sizeof cmyk);
    large[5] = 2;
    refused(cmyk, sizeof cmyk, "a Photoshop file in CMYK, which is not read: save it as PNG");
    refused(deep, sizeof deep, "of 32 bits a channel; 8 and 16 are read");
    refused(large, sizeof large, "a large Photoshop file (PSB)");
    refused(white, sizeof white, "without its flattened picture: save it with 'Maximize Compatibility'");
}

/* ---- others ---- */

/* A picture that many textures name must not take its time for each of them. */
static void damaged_pixels_are_counted(void **state)
{
    static const unsigned char psd[] = { PSD(3, 1, 3, 8, 3), NO_SECTIONS, SHORT(1), SHORT(1), SHORT(1),
                                         SHORT(1),           9,           9,        9 };
    static const unsigned char tga[] = { 0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 1, 0, 24, 0, 0x80, 1, 2 };
    static const struct {
        const unsigned char *bytes;
        size_t count;
    } pictures[] = { { psd, sizeof psd }, { tga, sizeof tga } };
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        image_file image;
        model_error error;
        uint64_t pixels_left = 5;
        assert_int_equal(image_decode(pictures[i].bytes, pictures[i].count, &pixels_left, &image, &error), 1);
        assert_int_equal(pixels_left, 2);
        assert_int_equal(image_decode(pictures[i].bytes, pictures[i].count, &pixels_left, &image, &error), 1);
        assert_non_null(strstr(error.what, "the limit is 2"));
        assert_int_equal(pixels_left, 2);
    }
}

static void other_formats_are_named(void **state)
{
    static const struct {
        const char *begins, *what;
    } kinds[] = {
        { "GIF89a..........................", "it is a GIF picture, not a PNG" },
        { "DDS |...........................", "it is a DDS picture, not a PNG" },
        { "\xabKTX 20\xbb..................", "it is a KTX2 picture, not a PNG" },
        { "#?RADIANCE......................", "it is an HDR panorama, not a PNG" },
        { "II*.............................", "it is a TIFF picture, not a PNG" },
        { "a text.........................", "it is of an unknown kind, not a PNG, JPEG, WebP, TGA, BMP or Photoshop" },
        { "\xff\xd8\xff\xc9\0\x0b\x08\0\1\0\1\1\1\x11\0\xff\xd9", "or of a kind that is not read" },
    };
    (void)state;
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        refused((const unsigned char *)kinds[i].begins, 17, kinds[i].what);
    }
    refused((const unsigned char *)"", 0, "it is empty");
    refused((const unsigned char *)"\x89PNG\r\n", 6, "it is a PNG picture of 6 bytes, which was cut off");
    refused((const unsigned char *)"\xff\xd8\xff", 3, "it is a JPEG picture of 3 bytes, which was cut off");
    refused((const unsigned char *)"8BPS\0\1", 6, "it is a Photoshop file of 6 bytes, which was cut off");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bmp_has_rows_and_palettes),     cmocka_unit_test(bmp_that_is_not_read_says_so),
        cmocka_unit_test(psd_has_its_flattened_picture), cmocka_unit_test(psd_alpha_is_of_layers_or_a_channel),
        cmocka_unit_test(psd_that_is_not_read_says_so),  cmocka_unit_test(other_formats_are_named),
        cmocka_unit_test(damaged_pixels_are_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
