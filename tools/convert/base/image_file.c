#include "image_file.h"

#include <stdlib.h>
#include <string.h>

#include <stb/stb_image.h>

#include "convert/base/bmp_file.h"
#include "convert/base/file_kind.h"
#include "convert/base/image_whole.h"
#include "convert/base/input_file.h"
#include "convert/base/psd_file.h"
#include "convert/base/tga_file.h"
#include "convert/base/webp_file.h"

/* stb_image's other decoders are kept from files of unknown origin. */
static int is_png_or_jpeg(const unsigned char *bytes, size_t count)
{
    static const unsigned char png[4] = { 0x89, 'P', 'N', 'G' }, jpeg[3] = { 0xff, 0xd8, 0xff };
    return count > 8 && (memcmp(bytes, png, 4) == 0 || memcmp(bytes, jpeg, 3) == 0);
}

static int fail_to_decode(model_error *error)
{
    return model_fail(error, "", "the image data is damaged, or of a kind that is not read (%s): save it again as PNG",
                      stbi_failure_reason());
}

static int check_size(const unsigned char *bytes, size_t count, uint64_t *pixels_left, model_error *error)
{
    int width = 0, height = 0, channels = 0;
    uint64_t pixels, rows;
    if (count > 0x7fffffffu) return model_fail(error, "", "the image has more than 2 GiB: save it smaller");
    if (!stbi_info_from_memory(bytes, (int)count, &width, &height, &channels)) return fail_to_decode(error);
    if (width < 1 || height == 0) return model_fail(error, "", "the image data is damaged: save it again as PNG");
    rows = height < 0 ? 0u - (uint64_t)(int64_t)height : (uint64_t)height; /* of a BMP with the top row first */
    pixels = (uint64_t)width * rows;
    if (pixels > IMAGE_PIXELS || pixels > *pixels_left) {
        return model_fail(error, "", "the image has %d x %llu pixels; the limit is %llu%s", width,
                          (unsigned long long)rows,
                          (unsigned long long)(pixels > IMAGE_PIXELS ? IMAGE_PIXELS : *pixels_left),
                          pixels > IMAGE_PIXELS ? "" : ", after those before it, for files of this size");
    }
    *pixels_left -= pixels;
    return 0;
}

static uint8_t *load_wide(const unsigned char *bytes, size_t count, int size[2], int *channels)
{
    uint16_t *wide = stbi_load_16_from_memory(bytes, (int)count, &size[0], &size[1], channels, 4);
    uint8_t *narrow = (uint8_t *)wide;
    const size_t values = wide ? (size_t)size[0] * (size_t)size[1] * 4u : 0;
    for (size_t i = 0; i < values; i++) narrow[i] = image_byte_of(wide[i]);
    return narrow;
}

/* Where the file does not say whether its pixels have alpha. */
static uint32_t channels_of(const image_file *image)
{
    const size_t pixels = (size_t)image->width * image->height;
    for (size_t i = 0; i < pixels; i++) {
        if (image->rgba[i * 4u + 3u] != 255) return 4;
    }
    return 3;
}

static int decode(const unsigned char *bytes, size_t count, image_file *image, model_error *error)
{
    int size[2] = { 0, 0 }, channels = 0;
    image->bits = stbi_is_16_bit_from_memory(bytes, (int)count) ? 16 : 8;
    image->rgba = image->bits == 16 ? load_wide(bytes, count, size, &channels)
                                    : stbi_load_from_memory(bytes, (int)count, &size[0], &size[1], &channels, 4);
    if (!image->rgba) return fail_to_decode(error);
    image->width = (uint32_t)size[0];
    image->height = (uint32_t)size[1];
    image->channels = (uint32_t)channels;
    return 0;
}

static int decode_without_end(const unsigned char *bytes, size_t count, image_file *image, model_error *error)
{
    unsigned char *whole = malloc(count + 2u);
    model_error reason = *error;
    int failed;
    if (!whole) return model_fail_memory(error);
    memcpy(whole, bytes, count);
    for (size_t i = 0; i < 2u; i++) whole[count + i] = (unsigned char)IMAGE_END[i];
    failed = decode(whole, count + 2u, image, &reason);
    free(whole);
    image->has_no_end = !failed;
    if (failed) *error = reason;
    return failed;
}

static int decode_png_or_jpeg(const unsigned char *bytes, size_t count, uint64_t *pixels_left, image_file *image,
                              model_error *error)
{
    int failed = check_size(bytes, count, pixels_left, error);
    if (!failed) failed = image_is_cut(bytes, count, error);
    if (failed == IMAGE_NO_END) return decode_without_end(bytes, count, image, error);
    return failed ? 1 : decode(bytes, count, image, error);
}

/* What is refused says more than stb_image does. */
static int decode_bmp(const unsigned char *bytes, size_t count, uint64_t *pixels_left, image_file *image,
                      model_error *error)
{
    return bmp_is_refused(bytes, count, error) || check_size(bytes, count, pixels_left, error) ||
           decode(bytes, count, image, error);
}

/* Formats that are read: a file of one that no reader takes was cut off. */
static int is_cut_picture(const file_kind *kind)
{
    static const char *const endings[] = { ".png", ".jpg", ".psd" };
    for (size_t i = 0; kind && i < sizeof endings / sizeof endings[0]; i++) {
        if (kind->ending && strcmp(kind->ending, endings[i]) == 0) return 1;
    }
    return 0;
}

static int decode_other(const unsigned char *bytes, size_t count, uint64_t *pixels_left, image_file *image,
                        model_error *error)
{
    const uint64_t most = *pixels_left < IMAGE_PIXELS ? *pixels_left : IMAGE_PIXELS;
    const file_kind *kind = file_kind_of_bytes(bytes, count);
    const int is_psd = psd_begins(bytes, count);
    int failed;
    image->bits = is_psd ? bytes[23] : 8;
    if (webp_begins(bytes, count)) {
        failed = webp_read(bytes, count, most, &image->width, &image->height, &image->rgba, error);
        image->channels = failed ? 0 : channels_of(image);
    } else if (is_psd || (!kind && tga_begins(bytes, count))) {
        failed = (is_psd ? psd_read : tga_read)(bytes, count, most, &image->width, &image->height, &image->channels,
                                                &image->rgba, error);
    } else if (is_cut_picture(kind)) {
        return model_fail(error, "", "it is %s of %zu bytes, which was cut off: save or copy it again", kind->what,
                          count);
    } else if (kind && !kind->ending) {
        return model_fail(error, "", "it is %s: %s", kind->what, kind->instead);
    } else {
        return model_fail(error, "", "it is %s, not a PNG, JPEG, WebP, TGA, BMP or Photoshop picture: save it as PNG",
                          kind    ? kind->what
                          : count ? "of an unknown kind"
                                  : "empty");
    }
    *pixels_left -= (uint64_t)image->width * image->height; /* of damaged pixels as well: they took time */
    return failed;
}

int image_decode(const unsigned char *bytes, size_t count, uint64_t *pixels_left, image_file *image, model_error *error)
{
    memset(image, 0, sizeof *image);
    return (is_png_or_jpeg(bytes, count) ? decode_png_or_jpeg
            : bmp_begins(bytes, count)   ? decode_bmp
                                         : decode_other)(bytes, count, pixels_left, image, error);
}

int image_read_next(const char *path, uint64_t *pixels_left, image_file *image, model_error *error)
{
    size_t count = 0;
    char *bytes = input_read(path, &count, error);
    int failed;
    memset(image, 0, sizeof *image);
    if (!bytes) return 1;
    *pixels_left += 64u * (uint64_t)count;
    failed = image_decode((const unsigned char *)bytes, count, pixels_left, image, error);
    free(bytes);
    return failed;
}

int image_read(const char *path, image_file *image, model_error *error)
{
    uint64_t pixels_left = IMAGE_PIXELS;
    if (image_read_next(path, &pixels_left, image, error)) return 1;
    if (!image->has_no_end) return 0;
    free(image->rgba);
    image->rgba = NULL;
    return 1;
}

static int decode_grey(const unsigned char *bytes, size_t count, uint32_t size[2], uint16_t **grey, model_error *error)
{
    int width = 0, height = 0, channels = 0;
    uint64_t pixels_left = IMAGE_PIXELS;
    if (check_size(bytes, count, &pixels_left, error) || image_is_cut(bytes, count, error)) return 1;
    *grey = stbi_load_16_from_memory(bytes, (int)count, &width, &height, &channels, 1);
    if (!*grey) return fail_to_decode(error);
    size[0] = (uint32_t)width;
    size[1] = (uint32_t)height;
    return 0;
}

int image_read_grey(const char *path, uint32_t *width, uint32_t *height, uint16_t **grey, model_error *error)
{
    size_t count = 0;
    char *bytes = input_read(path, &count, error);
    uint32_t size[2] = { 0, 0 };
    *grey = NULL;
    if (!bytes) return 1;
    const int failed = count > 8 && memcmp(bytes, "\x89PNG", 4) == 0
                           ? decode_grey((const unsigned char *)bytes, count, size, grey, error)
                           : model_fail(error, "", "it is not a PNG file");
    free(bytes);
    *width = size[0];
    *height = size[1];
    return failed;
}
