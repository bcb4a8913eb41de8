#include "psd_file.h"

#include <stdlib.h>
#include <string.h>

#include "convert/base/image_file.h"

#define HEADER_BYTES 26u
#define RESOURCE_BYTES 12u  /* of the smallest resource */
#define VERSION_INFO 0x421u /* the resource that tells whether the flattened picture was stored */
#define MOST_PACKED 64u     /* bytes of each: two have up to 128 */

enum { GREY = 1, COLOURS = 3 };

typedef struct psd {
    const unsigned char *bytes, *lengths, *at; /* the lengths of packed rows; NULL: they are not packed */
    size_t count;
    uint32_t channels, width, height, sample; /* bytes of a number */
    int grey, on_white;                       /* colours are blended with white by their alpha */
} psd;

static uint32_t big(const unsigned char *b, size_t bytes)
{
    uint32_t value = 0;
    for (size_t i = 0; i < bytes; i++) value = value << 8 | b[i];
    return value;
}

int psd_begins(const unsigned char *bytes, size_t count)
{
    return count > HEADER_BYTES && memcmp(bytes, "8BPS", 4) == 0;
}

static int cut(const psd *p, model_error *error)
{
    return model_fail(
        error, "", "the Photoshop file of %zu bytes lacks pixels: it was cut off or is damaged; save or copy it again",
        p->count);
}

/* Behind a section that begins with its length; the end of the file if it is cut off. */
static size_t behind(const psd *p, size_t at)
{
    const size_t left = p->count - at;
    return left < 4u || big(p->bytes + at, 4) > left - 4u ? p->count : at + 4u + big(p->bytes + at, 4);
}

/* Programs write a white picture in place of the flattened one unless the author asks for it. */
static int lacks_flattened(const psd *p, size_t at, size_t end)
{
    while (end > at && end - at > RESOURCE_BYTES) {
        const size_t size_at = at + 7u + (p->bytes[at + 6] | 1u), data = size_at + 4u;
        if (data + 5u > end) return 0;
        if (big(p->bytes + at + 4, 2) == VERSION_INFO) return !p->bytes[data + 4u];
        const size_t size = big(p->bytes + size_at, 4);
        if (size > end - data) return 0;
        at = data + size + (size & 1u);
    }
    return 0;
}

static int check_kind(const psd *p, model_error *error)
{
    static const char *const modes[10] = {
        "in black and white", NULL,          "with a palette", NULL, "in CMYK", NULL, NULL,
        "of channels",        "of duotones", "in Lab"
    };
    const uint32_t bits = big(p->bytes + 22, 2), mode = big(p->bytes + 24, 2);
    if (big(p->bytes + 4, 2) != 1u) {
        return model_fail(error, "", "it is a large Photoshop file (PSB), which is not read: save it as PNG");
    }
    if (mode != GREY && mode != COLOURS) {
        return model_fail(error, "", "it is a Photoshop file %s, which is not read: save it as PNG",
                          mode < 10u && modes[mode] ? modes[mode] : "of an unknown mode");
    }
    if (bits != 8u && bits != 16u) {
        return model_fail(error, "", "it is a Photoshop file of %u bits a channel; 8 and 16 are read: save it as PNG",
                          (unsigned)bits);
    }
    return 0;
}

static int check_size(const psd *p, uint64_t pixels_max, model_error *error)
{
    const uint64_t pixels = (uint64_t)p->width * p->height;
    if (!pixels || p->channels < (p->grey ? 1u : 3u))
        return model_fail(error, "", "the image data is damaged: save it again as PNG");
    if (pixels > pixels_max) {
        return model_fail(error, "", "the image has %u x %u pixels; the limit is %llu", (unsigned)p->width,
                          (unsigned)p->height, (unsigned long long)pixels_max);
    }
    return pixels * p->channels * p->sample > (p->lengths ? MOST_PACKED : 1u) * (uint64_t)p->count ? cut(p, error) : 0;
}

/* Whether the first alpha is the transparency of all layers: their number is negative; a file of 16 bits, whose layers
 * are elsewhere, says so by an entry without data. */
static int has_transparency(const unsigned char *section, size_t count)
{
    return count > 10u &&
           (big(section + 4, 4) > 1u ? section[8] >= 128 : count > 20u && memcmp(section + 12, "8BIMMt", 6) == 0);
}

static int read_header(psd *p, uint64_t pixels_max, model_error *error)
{
    const size_t resources = behind(p, HEADER_BYTES), layers = behind(p, resources), at = behind(p, layers);
    if (check_kind(p, error)) return 1;
    p->channels = big(p->bytes + 12, 2);
    p->height = big(p->bytes + 14, 4);
    p->width = big(p->bytes + 18, 4);
    p->sample = big(p->bytes + 22, 2) / 8u;
    p->grey = big(p->bytes + 24, 2) == GREY;
    if (p->count - at < 2u) return cut(p, error);
    if (lacks_flattened(p, resources + 4u, layers)) {
        return model_fail(
            error, "",
            "it is a Photoshop file without its flattened picture: save it with 'Maximize Compatibility', "
            "or as PNG");
    }
    if (big(p->bytes + at, 2) > 3u) return cut(p, error);
    if (big(p->bytes + at, 2) > 1u) {
        return model_fail(error, "", "it is a Photoshop file packed with ZIP, which is not read: save it as PNG");
    }
    p->on_white = has_transparency(p->bytes + layers, at - layers);
    p->at = p->bytes + at + 2u;
    if (big(p->bytes + at, 2) == 1u) {
        p->lengths = p->at;
        if ((uint64_t)p->channels * p->height * 2u > p->count - at - 2u) return cut(p, error);
        p->at += (size_t)p->channels * p->height * 2u;
    }
    return check_size(p, pixels_max, error);
}

/* Apple's PackBits. Returns 1 if the bytes do not make up a row. */
static int unpack(const unsigned char *from, size_t count, unsigned char *row, size_t row_bytes)
{
    const unsigned char *end = from + count;
    size_t at = 0;
    while (at < row_bytes && from < end) {
        const size_t code = *from++, run = code < 128u ? code + 1u : 257u - code;
        if (code == 128u) continue;
        if (run > row_bytes - at || (size_t)(end - from) < (code < 128u ? run : 1u)) return 1;
        if (code < 128u)
            memcpy(row + at, from, run);
        else
            memset(row + at, *from, run);
        from += code < 128u ? run : 1u;
        at += run;
    }
    return at < row_bytes;
}

static int next_row(psd *p, unsigned char *row)
{
    const size_t row_bytes = (size_t)p->width * p->sample;
    const size_t length = p->lengths ? big(p->lengths, 2) : row_bytes;
    if (length > p->count - (size_t)(p->at - p->bytes)) return 1;
    if (p->lengths && unpack(p->at, length, row, row_bytes)) return 1;
    if (!p->lengths) memcpy(row, p->at, length);
    if (p->lengths) p->lengths += 2;
    p->at += length;
    return 0;
}

static int read_channel(psd *p, unsigned char *row, unsigned char *rgba, size_t first, size_t last)
{
    for (uint32_t y = 0; y < p->height; y++) {
        if (next_row(p, row)) return 1;
        for (uint32_t x = 0; x < p->width; x++) {
            const unsigned char value = p->sample > 1u ? image_byte_of(big(row + x * 2u, 2)) : row[x];
            for (size_t c = first; c <= last; c++) rgba[((size_t)y * p->width + x) * 4u + c] = value;
        }
    }
    return 0;
}

/* Some programs do not blend: there some value is less than the white that would be in it. */
static int is_on_white(const unsigned char *rgba, size_t pixels)
{
    for (size_t i = 0; i < pixels * 4u; i++) {
        if (i % 4u != 3u && rgba[i] + rgba[i | 3u] < 254) return 0;
    }
    return 1;
}

static void take_from_white(unsigned char *rgba, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++) {
        unsigned char *texel = rgba + i * 4u;
        const int alpha = texel[3];
        for (size_t c = 0; alpha && c < 3u; c++) {
            const int value = 255 - ((255 - texel[c]) * 255 + alpha / 2) / alpha;
            texel[c] = (unsigned char)(value < 0 ? 0 : value);
        }
    }
}

/* row: one of the file's */
static int read_pixels(psd *p, unsigned char *row, unsigned char *rgba)
{
    const size_t pixels = (size_t)p->width * p->height;
    const uint32_t colours = p->grey ? 1u : 3u;
    memset(rgba, 255, pixels * 4u);
    for (uint32_t c = 0; c < colours; c++) {
        if (read_channel(p, row, rgba, c, p->grey ? 2u : c)) return 1;
    }
    if (p->channels == colours) return 0;
    if (read_channel(p, row, rgba, 3, 3)) return 1;
    if (p->on_white && is_on_white(rgba, pixels)) take_from_white(rgba, pixels);
    return 0;
}

int psd_read(const unsigned char *bytes, size_t count, uint64_t pixels_max, uint32_t *width, uint32_t *height,
             uint32_t *channels, unsigned char **rgba, model_error *error)
{
    psd p = { bytes, NULL, bytes, count, 0, 0, 0, 0, 0, 0 };
    size_t rgba_bytes;
    if (read_header(&p, pixels_max, error)) return 1;
    *width = p.width;
    *height = p.height;
    *channels = p.grey ? (p.channels > 1u ? 2u : 1u) : p.channels > 3u ? 4u : 3u;
    rgba_bytes = (size_t)p.width * p.height * 4u;
    *rgba = malloc(rgba_bytes + (size_t)p.width * p.sample);
    if (!*rgba) return model_fail(error, "", "there is not enough memory for the image");
    if (!read_pixels(&p, *rgba + rgba_bytes, *rgba)) return 0;
    free(*rgba);
    *rgba = NULL;
    return cut(&p, error);
}
