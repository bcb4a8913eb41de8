/* webp_none.c: convert/base/webp_file.c finds libwebp at run time; a page has none. */
#include <string.h>

#include "convert/base/webp_file.h"

int webp_begins(const unsigned char *bytes, size_t count)
{
    return count > 16 && memcmp(bytes, "RIFF", 4) == 0 && memcmp(bytes + 8, "WEBPVP8", 7) == 0;
}

int webp_read(const unsigned char *bytes, size_t count, uint64_t pixels_max, uint32_t *width, uint32_t *height,
              unsigned char **rgba, model_error *error)
{
    (void)bytes;
    (void)count;
    (void)pixels_max;
    (void)width;
    (void)height;
    (void)rgba;
    return model_fail(error, "",
                      "it is a WebP picture, which a page does not convert: noh build does, or save it "
                      "as PNG or JPEG");
}
