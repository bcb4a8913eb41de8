/* webp_browser.c: WebP pictures in a page. A browser decodes pictures only asynchronously, so worker.js decodes the
 * pictures of all files first, and writes them to files named by length and FNV-1a hash: width, height,
 * [height][width][4]. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/webp_file.h"

int webp_begins(const unsigned char *bytes, size_t count)
{
    return count > 16 && memcmp(bytes, "RIFF", 4) == 0 && memcmp(bytes + 8, "WEBPVP8", 7) == 0;
}

static FILE *decoded(const unsigned char *bytes, size_t count)
{
    const size_t told = 8u +
                        ((size_t)bytes[4] | (size_t)bytes[5] << 8 | (size_t)bytes[6] << 16 | (size_t)bytes[7] << 24);
    const size_t length = told < count ? told : count;
    uint32_t hash = 2166136261u;
    char name[64];
    for (size_t i = 0; i < length; i++) hash = (hash ^ bytes[i]) * 16777619u;
    (void)snprintf(name, sizeof name, "/webp/%zu-%08lx", length, (unsigned long)hash);
    return fopen(name, "rb");
}

static int read_pixels(FILE *f, uint64_t pixels_max, uint32_t size[2], unsigned char **rgba, model_error *error)
{
    size_t bytes;
    if (fread(size, sizeof *size, 2, f) != 2)
        return model_fail(error, "", "the image data is damaged: save it again as PNG");
    if ((uint64_t)size[0] * size[1] > pixels_max) {
        return model_fail(error, "", "the image has %lu x %lu pixels; the limit is %llu", (unsigned long)size[0],
                          (unsigned long)size[1], (unsigned long long)pixels_max);
    }
    bytes = (size_t)size[0] * size[1] * 4u;
    *rgba = malloc(bytes);
    if (!*rgba) return model_fail(error, "", "there is not enough memory for the image");
    if (fread(*rgba, 1, bytes, f) == bytes) return 0;
    free(*rgba);
    *rgba = NULL;
    return model_fail(error, "", "the image data is damaged: save it again as PNG");
}

int webp_read(const unsigned char *bytes, size_t count, uint64_t pixels_max, uint32_t *width, uint32_t *height,
              unsigned char **rgba, model_error *error)
{
    FILE *f = decoded(bytes, count);
    uint32_t size[2];
    int failed;
    if (!f) return model_fail(error, "", "the browser cannot decode this WebP picture: save it as PNG or JPEG");
    failed = read_pixels(f, pixels_max, size, rgba, error);
    (void)fclose(f);
    if (failed) return 1;
    *width = size[0];
    *height = size[1];
    return 0;
}
