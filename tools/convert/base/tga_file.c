#include "tga_file.h"

#include <stdlib.h>
#include <string.h>

#define HEADER_BYTES 18u
#define MOST_PACKED 64u /* pixels for each byte: a packet of two bytes has up to 128 */

enum { KIND_COLORS = 2, KIND_GREY = 3, KIND_PACKED = 8 };

typedef struct tga {
    const unsigned char *at, *end;
    uint32_t width, height, pixel_bytes;
    int packed, has_alpha, from_top, from_right;
} tga;

static uint32_t short_at(const unsigned char *b)
{
    return (uint32_t)b[0] | (uint32_t)b[1] << 8;
}

int tga_begins(const unsigned char *bytes, size_t count)
{
    const unsigned kind = count > HEADER_BYTES ? bytes[2] & ~(unsigned)KIND_PACKED : 0;
    return kind >= 1u && kind <= 3u && bytes[1] <= 1 && short_at(bytes + 12) && short_at(bytes + 14) &&
           bytes[16] >= 8 && bytes[16] <= 32;
}

static int read_header(const unsigned char *bytes, size_t count, uint64_t pixels_max, tga *t, model_error *error)
{
    const unsigned kind = bytes[2] & ~(unsigned)KIND_PACKED;
    const unsigned bits = bytes[16];
    uint64_t pixels;
    t->width = short_at(bytes + 12);
    t->height = short_at(bytes + 14);
    pixels = (uint64_t)t->width * t->height;
    t->pixel_bytes = bits / 8u;
    t->packed = (bytes[2] & KIND_PACKED) != 0;
    t->has_alpha = bits == 32u && (bytes[17] & 15u) == 8u;
    t->from_top = (bytes[17] & 32u) != 0;
    t->from_right = (bytes[17] & 16u) != 0;
    if (bytes[1] || kind < KIND_COLORS) {
        return model_fail(error, "", "it is a TGA picture with a palette, which is not read: save it as PNG");
    }
    if (kind == KIND_GREY ? bits != 8u : bits != 24u && bits != 32u) {
        return model_fail(error, "", "it is a %sTGA picture of %u bits a pixel; %s read: save it as PNG",
                          kind == KIND_GREY ? "grey " : "", bits, kind == KIND_GREY ? "only 8 are" : "24 and 32 are");
    }
    if (pixels > pixels_max) {
        return model_fail(error, "", "the image has %u x %u pixels; the limit is %llu", (unsigned)t->width,
                          (unsigned)t->height, (unsigned long long)pixels_max);
    }
    if (count < HEADER_BYTES + (size_t)bytes[0] ||
        pixels > (uint64_t)(t->packed ? MOST_PACKED : 1u) * (count - HEADER_BYTES)) {
        return model_fail(error, "", "the image was cut off; save it again");
    }
    t->at = bytes + HEADER_BYTES + bytes[0];
    t->end = bytes + count;
    return 0;
}

/* The place of a pixel of the file. */
static unsigned char *place_of(const tga *t, unsigned char *rgba, size_t pixel)
{
    const size_t row = pixel / t->width, column = pixel % t->width;
    const size_t y = t->from_top ? row : t->height - 1u - row, x = t->from_right ? t->width - 1u - column : column;
    return rgba + (y * t->width + x) * 4u;
}

static void put(const tga *t, const unsigned char *from, unsigned char *to)
{
    to[0] = from[t->pixel_bytes > 1u ? 2 : 0];
    to[1] = from[t->pixel_bytes > 1u ? 1 : 0];
    to[2] = from[0];
    to[3] = t->has_alpha ? from[3] : 255;
}

static int read_pixels(tga *t, unsigned char *rgba)
{
    const size_t pixels = (size_t)t->width * t->height;
    for (size_t i = 0; i < pixels;) {
        size_t run = 1;
        int repeats = 0;
        if (t->packed) {
            if (t->at == t->end) return 1;
            repeats = *t->at >= 128;
            run = (size_t)(*t->at++ & 127) + 1u;
        }
        for (size_t k = 0; k < run && i < pixels; k++, i++) {
            if ((size_t)(t->end - t->at) < t->pixel_bytes) return 1;
            put(t, t->at, place_of(t, rgba, i));
            if (!repeats || k + 1u == run) t->at += t->pixel_bytes;
        }
    }
    return 0;
}

int tga_read(const unsigned char *bytes, size_t count, uint64_t pixels_max, uint32_t *width, uint32_t *height,
             uint32_t *channels, unsigned char **rgba, model_error *error)
{
    tga t = { bytes, bytes, 0, 0, 0, 0, 0, 0, 0 };
    if (read_header(bytes, count, pixels_max, &t, error)) return 1;
    *width = t.width;
    *height = t.height;
    *channels = t.has_alpha ? 4u : t.pixel_bytes > 1u ? 3u : 1u;
    *rgba = malloc((size_t)t.width * t.height * 4u);
    if (!*rgba) return model_fail(error, "", "there is not enough memory for the image");
    if (read_pixels(&t, *rgba)) {
        free(*rgba);
        *rgba = NULL;
        return model_fail(error, "", "the image was cut off; save it again");
    }
    return 0;
}
