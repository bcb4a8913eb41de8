#include "image_file.h"

#include <stdlib.h>
#include <string.h>

#include <stb/stb_image.h>

#include "convert/base/image_whole.h"
#include "convert/base/input_file.h"
#include "convert/base/tga_file.h"

/* stb_image's other decoders are kept from files of unknown origin. */
static int is_png_or_jpeg(const char *bytes, size_t count)
{
    static const unsigned char png[4] = { 0x89, 'P', 'N', 'G' }, jpeg[3] = { 0xff, 0xd8, 0xff };
    return count > 8 && (memcmp(bytes, png, 4) == 0 || memcmp(bytes, jpeg, 3) == 0);
}

static int check_size(const unsigned char *bytes, size_t count, uint64_t *pixels_left, model_error *error)
{
    int width = 0, height = 0, channels = 0;
    uint64_t pixels;
    if (count > 0x7fffffffu || !stbi_info_from_memory(bytes, (int)count, &width, &height, &channels) || width < 1 ||
        height < 1) {
        return model_fail(error, "", "the image data is damaged");
    }
    pixels = (uint64_t)width * (uint64_t)height;
    *pixels_left += 64u * (uint64_t)count;
    if (pixels > IMAGE_PIXELS || pixels > *pixels_left) {
        return model_fail(error, "", "the image has %d x %d pixels; the limit is %llu%s", width, height,
                          (unsigned long long)(pixels > IMAGE_PIXELS ? IMAGE_PIXELS : *pixels_left),
                          pixels > IMAGE_PIXELS ? "" : ", after those before it, for files of this size");
    }
    *pixels_left -= pixels;
    return 0;
}

static int decode(const unsigned char *bytes, size_t count, image_file *image, model_error *error)
{
    int width = 0, height = 0, channels = 0;
    image->bits = stbi_is_16_bit_from_memory(bytes, (int)count) ? 16 : 8;
    image->rgba = stbi_load_from_memory(bytes, (int)count, &width, &height, &channels, 4);
    if (!image->rgba) {
        return model_fail(error, "", "the image data is damaged, or there is not enough memory");
    }
    image->width = (uint32_t)width;
    image->height = (uint32_t)height;
    image->channels = (uint32_t)channels;
    return 0;
}

static int append_end(char **bytes, size_t *count, image_file *image, model_error *error)
{
    char *grown = realloc(*bytes, *count + 2u);
    if (!grown) return model_fail_memory(error);
    for (size_t i = 0; i < 2u; i++) grown[*count + i] = IMAGE_END[i];
    *bytes = grown;
    *count += 2u;
    image->has_no_end = 1;
    return 0;
}

static int decode_png_or_jpeg(char **bytes, size_t *count, uint64_t *pixels_left, image_file *image, model_error *error)
{
    int failed = check_size((const unsigned char *)*bytes, *count, pixels_left, error);
    if (!failed) failed = image_is_cut((const unsigned char *)*bytes, *count, error);
    if (failed == IMAGE_NO_END) failed = append_end(bytes, count, image, error);
    return failed ? failed : decode((const unsigned char *)*bytes, *count, image, error);
}

static int decode_tga(const char *bytes, size_t count, uint64_t *pixels_left, image_file *image, model_error *error)
{
    const uint64_t left = *pixels_left + 64u * (uint64_t)count;
    if (tga_read((const unsigned char *)bytes, count, left < IMAGE_PIXELS ? left : IMAGE_PIXELS, &image->width,
                 &image->height, &image->channels, &image->rgba, error)) {
        return 1;
    }
    image->bits = 8;
    *pixels_left = left - (uint64_t)image->width * image->height;
    return 0;
}

int image_read_next(const char *path, uint64_t *pixels_left, image_file *image, model_error *error)
{
    size_t count = 0;
    char *bytes = input_read(path, &count, error);
    int failed;
    memset(image, 0, sizeof *image);
    if (!bytes) {
        return 1;
    }
    if (is_png_or_jpeg(bytes, count))
        failed = decode_png_or_jpeg(&bytes, &count, pixels_left, image, error);
    else if (tga_begins((const unsigned char *)bytes, count))
        failed = decode_tga(bytes, count, pixels_left, image, error);
    else
        failed = model_fail(error, "", "it is neither PNG, JPEG nor TGA");
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
    if (!*grey) return model_fail(error, "", "the image data is damaged, or there is not enough memory");
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
