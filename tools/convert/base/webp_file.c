#include "webp_file.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

/* The part of libwebp's interface that is used. */
typedef struct webp {
    int (*info)(const uint8_t *data, size_t bytes, int *width, int *height);
    uint8_t *(*decode)(const uint8_t *data, size_t bytes, uint8_t *out, size_t out_bytes, int stride);
} webp;

/* It stays open: the next texture needs it again. */
static int load(webp *w, model_error *error)
{
    void *library = dlopen("libwebp.so.7", RTLD_NOW | RTLD_LOCAL);
    if (!library) library = dlopen("libwebp.so.6", RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        return model_fail(error, "",
                          "WebP pictures need libwebp, which is not installed (Debian: apt install libwebp7)");
    }
    /* ISO C has no cast from an object's address to a function's: POSIX takes this one */
    *(void **)&w->info = dlsym(library, "WebPGetInfo");
    *(void **)&w->decode = dlsym(library, "WebPDecodeRGBAInto");
    if (!w->info || !w->decode) {
        return model_fail(error, "", "WebP pictures need libwebp 0.6 or newer: the installed one lacks functions");
    }
    return 0;
}

int webp_begins(const unsigned char *bytes, size_t count)
{
    return count > 16 && memcmp(bytes, "RIFF", 4) == 0 && memcmp(bytes + 8, "WEBPVP8", 7) == 0;
}

int webp_read(const unsigned char *bytes, size_t count, uint64_t pixels_max, uint32_t *width, uint32_t *height,
              unsigned char **rgba, model_error *error)
{
    webp w = { NULL, NULL };
    int columns = 0, rows = 0;
    unsigned char *out;
    size_t out_bytes;
    if (load(&w, error)) return 1;
    if (!w.info(bytes, count, &columns, &rows) || columns < 1 || rows < 1) {
        return model_fail(error, "", "the image data is damaged: save it again as PNG");
    }
    if ((uint64_t)columns * (uint64_t)rows > pixels_max) {
        return model_fail(error, "", "the image has %d x %d pixels; the limit is %llu", columns, rows,
                          (unsigned long long)pixels_max);
    }
    *width = (uint32_t)columns;
    *height = (uint32_t)rows;
    out_bytes = (size_t)columns * (size_t)rows * 4u;
    out = malloc(out_bytes);
    if (!out) return model_fail(error, "", "there is not enough memory for the image");
    if (!w.decode(bytes, count, out, out_bytes, columns * 4)) {
        free(out);
        return model_fail(error, "", "the image data is damaged: save it again as PNG");
    }
    *rgba = out;
    return 0;
}
