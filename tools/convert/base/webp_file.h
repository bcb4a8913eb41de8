/* webp_file.h: WebP pictures. libwebp reads them; it is loaded for the first picture, so that other files do not
 * need it. */
#ifndef NOH_CONVERT_BASE_WEBP_FILE_H
#define NOH_CONVERT_BASE_WEBP_FILE_H

#include <stddef.h>
#include <stdint.h>

#include "convert/base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Whether a file that begins with these bytes is a WebP picture. */
int webp_begins(const unsigned char *bytes, size_t count);

/* Returns 0, the size and [height][width][4], to be freed with free(); or 1 and *error: the data is damaged, there are
 * more than pixels_max pixels, or libwebp is not installed. Where pixels are damaged, the size is set as well. */
int webp_read(const unsigned char *bytes, size_t count, uint64_t pixels_max, uint32_t *width, uint32_t *height,
              unsigned char **rgba, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
