/* image_file.h: pictures as their bytes say, without any management of colours: PNG, JPEG, WebP, TGA, BMP and
 * Photoshop's, flattened. */
#ifndef NOH_CONVERT_BASE_IMAGE_FILE_H
#define NOH_CONVERT_BASE_IMAGE_FILE_H

#include <stdint.h>

#include "convert/base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct image_file {
    uint32_t width, height;
    uint32_t channels; /* in the file, 1 to 4: grey, grey and alpha, colour, colour and alpha */
    uint32_t bits;     /* of a channel in the file: 8 or 16 */
    int has_no_end;    /* 1: of a JPEG that ends in pixels; some may be missing, and *error says so */
    uint8_t *rgba;     /* [height][width][4], the top row first; to be freed. Alpha is 255 where the file has none */
} image_file;

/* Of 16 bits, the nearest of 8. */
static inline uint8_t image_byte_of(uint32_t wide)
{
    return (uint8_t)((wide * 255u + 32767u) / 65535u);
}

/* Read a file of at most 64 Mi pixels that has its end. Returns 0, or 1 and *error; then image->rgba is NULL. */
int image_read(const char *path, image_file *image, model_error *error);

/* The same of bytes in memory, also those without an end. *pixels_left shrinks by the pixels before they are
 * decoded. */
int image_decode(const unsigned char *bytes, size_t count, uint64_t *pixels_left, image_file *image,
                 model_error *error);

/* The same for the files of one model, also those without an end, so that a few small ones do not take any memory and
 * time. *pixels_left, at first IMAGE_PIXELS, also grows by 64 for each byte of a file. */
#define IMAGE_PIXELS ((uint64_t)64u << 20)
int image_read_next(const char *path, uint64_t *pixels_left, image_file *image, model_error *error);

/* The brightness of each pixel of a .png file, 0 to 65535 (of 8 bits: 257 times the byte). 0: *grey [height][width],
 * the top row first, to be freed; or 1 and *error, and *grey is NULL. */
int image_read_grey(const char *path, uint32_t *width, uint32_t *height, uint16_t **grey, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
