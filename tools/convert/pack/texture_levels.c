#include "texture_levels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/texture/texture_blocks.h"
#include "convert/texture/texture_trim.h"

#define ONE (1u << 20) /* linear light, data, alpha 1, length of a normal */

/* A level before it is rounded to bytes. */
typedef struct image {
    uint32_t width, height;
    int32_t *texels; /* [height][width][4] */
} image;

/* ---- bytes and values ---- */

static void linear_light(int32_t of_byte[256])
{
    for (int i = 0; i < 256; i++) {
        const double s = i / 255.0, linear = s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4);
        of_byte[i] = (int32_t)floor(linear * ONE + 0.5);
    }
}

/* The byte whose light is the nearest. */
static uint8_t byte_of_light(const int32_t of_byte[256], int32_t light)
{
    int low = 0, high = 255;
    while (low < high) {
        const int middle = (low + high + 1) / 2;
        if (of_byte[middle] <= light) {
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    return (uint8_t)(low < 255 && of_byte[low + 1] - light <= light - of_byte[low] ? low + 1 : low);
}

static int32_t value_of_byte(uint8_t byte)
{
    return (int32_t)(((uint64_t)byte * ONE + 127) / 255);
}

static uint8_t byte_of_value(int32_t value)
{
    return (uint8_t)(((int64_t)value * 255 + ONE / 2) / ONE);
}

/* Bytes of a normal map have no value for 0; 128 stands for it. */
static int32_t component_of_byte(uint8_t byte)
{
    return ((int32_t)byte - 128) * (int32_t)ONE / 127;
}

static uint8_t byte_of_component(int32_t component)
{
    const int64_t scaled = (int64_t)component * 127 + (component < 0 ? -(int32_t)ONE / 2 : (int32_t)ONE / 2);
    const int64_t byte = scaled / (int64_t)ONE + 128;
    return (uint8_t)(byte < 0 ? 0 : byte > 255 ? 255 : byte);
}

static void make_unit(int32_t v[3])
{
    const double x = v[0], y = v[1], z = v[2], length = sqrt(x * x + y * y + z * z);
    if (length > 0.0) {
        for (int i = 0; i < 3; i++) v[i] = (int32_t)floor(v[i] / length * ONE + 0.5);
    } else {
        v[0] = v[1] = 0; /* opposite normals leave nothing: the surface's own */
        v[2] = ONE;
    }
}

static void open_texel(const uint8_t *bytes, model_texture_use use, const int32_t light[256], int32_t *texel)
{
    for (int c = 0; c < 3; c++) {
        texel[c] = use == MODEL_TEXTURE_COLOR    ? light[bytes[c]]
                   : use == MODEL_TEXTURE_NORMAL ? component_of_byte(bytes[c])
                                                 : value_of_byte(bytes[c]);
    }
    texel[3] = value_of_byte(bytes[3]);
}

static void close_texel(const int32_t *texel, model_texture_use use, const int32_t light[256], uint8_t *bytes)
{
    int32_t unit[3] = { texel[0], texel[1], texel[2] };
    if (use == MODEL_TEXTURE_NORMAL) make_unit(unit);
    for (int c = 0; c < 3; c++) {
        bytes[c] = use == MODEL_TEXTURE_COLOR    ? byte_of_light(light, texel[c])
                   : use == MODEL_TEXTURE_NORMAL ? byte_of_component(unit[c])
                                                 : byte_of_value(texel[c]);
    }
    bytes[3] = byte_of_value(texel[3]);
}

/* ---- halving ---- */

/* Texels of a side that one of the next level's covers, with weights that sum to the side's length. */
typedef struct cover {
    uint32_t first, count, weights[3];
} cover;

static cover cover_of(uint32_t from, uint32_t to, uint32_t i)
{
    const uint64_t begin = (uint64_t)i * from, end = begin + from;
    cover c = { (uint32_t)(begin / to), 0, { 0, 0, 0 } };
    for (uint64_t at = c.first; at * to < end; at++) {
        const uint64_t low = at * to < begin ? begin : at * to, high = (at + 1) * to > end ? end : (at + 1) * to;
        c.weights[c.count++] = (uint32_t)(high - low);
    }
    return c;
}

static int32_t mean(int64_t sum, int64_t weight)
{
    return (int32_t)((sum + (sum < 0 ? -weight / 2 : weight / 2)) / weight);
}

/* with_alpha: colours count as much as their alpha, unless all of them have none */
static void halve_texel(const image *from, const cover *x, const cover *y, int with_alpha, int32_t *out)
{
    int64_t plain[4] = { 0, 0, 0, 0 }, weighted[3] = { 0, 0, 0 }, weight = 0, alpha = 0;
    for (uint32_t j = 0; j < y->count; j++) {
        for (uint32_t i = 0; i < x->count; i++) {
            const int32_t *t = from->texels + ((size_t)(y->first + j) * from->width + x->first + i) * 4;
            const int64_t w = (int64_t)x->weights[i] * y->weights[j];
            for (int c = 0; c < 4; c++) plain[c] += w * t[c];
            for (int c = 0; c < 3; c++) weighted[c] += w * (t[3] / 256) * t[c];
            weight += w;
            alpha += w * (t[3] / 256);
        }
    }
    for (int c = 0; c < 3; c++) {
        out[c] = with_alpha && alpha > 0 ? mean(weighted[c], alpha) : mean(plain[c], weight);
    }
    out[3] = mean(plain[3], weight);
}

/* One of the texels that a texel of the next level covers: codes have no mean. */
static void pick_texel(const image *from, const cover *x, const cover *y, int32_t *out)
{
    const uint32_t column = x->first + x->count / 2u, row = y->first + y->count / 2u;
    memcpy(out, from->texels + ((size_t)row * from->width + column) * 4, 4 * sizeof *out);
}

static int halve(const model_texture *t, image *level)
{
    image next = { level->width > 1 ? level->width / 2 : 1, level->height > 1 ? level->height / 2 : 1, NULL };
    next.texels = malloc((size_t)next.width * next.height * 4 * sizeof *next.texels);
    if (!next.texels) return 1;
    for (uint32_t j = 0; j < next.height; j++) {
        const cover y = cover_of(level->height, next.height, j);
        for (uint32_t i = 0; i < next.width; i++) {
            const cover x = cover_of(level->width, next.width, i);
            int32_t *texel = next.texels + ((size_t)j * next.width + i) * 4;
            if (t->use == MODEL_TEXTURE_CODES) {
                pick_texel(level, &x, &y, texel);
            } else {
                halve_texel(level, &x, &y, t->with_alpha, texel);
            }
        }
    }
    free(level->texels);
    *level = next;
    return 0;
}

/* ---- cutoffs ---- */

static uint64_t covered(const uint8_t *bytes, uint64_t count, uint32_t cutoff)
{
    uint64_t stays = 0;
    for (uint64_t i = 0; i < count; i++) stays += bytes[i * 4 + 3] >= cutoff;
    return stays;
}

/* Scale alphas so that the share of texels which stay is the nearest to `share` of `whole`. */
static void keep_coverage(uint8_t *bytes, uint64_t count, uint32_t cutoff, uint64_t share, uint64_t whole)
{
    uint32_t best = cutoff;
    uint64_t best_off = UINT64_MAX;
    for (uint32_t at = 1; at < 256; at++) {
        const uint64_t a = covered(bytes, count, at) * whole, b = share * count, off = a > b ? a - b : b - a;
        const uint32_t from = at > cutoff ? at - cutoff : cutoff - at,
                       from_best = best > cutoff ? best - cutoff : cutoff - best;
        if (off < best_off || (off == best_off && from < from_best)) {
            best_off = off;
            best = at;
        }
    }
    for (uint64_t i = 0; i < count; i++) {
        const uint32_t scaled = (bytes[i * 4 + 3] * cutoff + best / 2) / best;
        bytes[i * 4 + 3] = (uint8_t)(scaled > 255 ? 255 : scaled);
    }
}

/* ---- all levels ---- */

static int open_image(const model_texture *from, const int32_t light[256], image *out)
{
    const size_t count = (size_t)from->width * from->height;
    out->width = from->width;
    out->height = from->height;
    out->texels = malloc(count * 4 * sizeof *out->texels);
    for (size_t i = 0; i < count && out->texels; i++) {
        open_texel(from->rgba + i * 4, from->use, light, out->texels + i * 4);
    }
    return !out->texels;
}

/* The cutoff as a byte; 0: nothing is cut. */
static uint32_t cutoff_of(const model_texture *t)
{
    const double cutoff = ceil((double)t->alpha_cutoff * 255.0);
    return t->use == MODEL_TEXTURE_COLOR && cutoff > 0.0 && cutoff < 256.0 ? (uint32_t)cutoff : 0;
}

static void close_image(const model_texture *t, const image *level, const int32_t light[256], uint8_t *bytes)
{
    const size_t count = (size_t)level->width * level->height;
    for (size_t i = 0; i < count; i++) close_texel(level->texels + i * 4, t->use, light, bytes + i * 4);
}

/* Mean squares of errors, of bytes: 38 and 40 dB. */
#define ERROR_GOOD 10.3f
#define ERROR_FINE 6.5f
#define SIDE_SMALL 64u
/* A block that takes thirty bits less when it is sent may lose 2.5 more in the mean square: much of what is at 50 dB,
 * little of what is at 40. */
#define BIT_WORTH 4u

static int keeps_alpha(const model_texture *t, const uint8_t *bytes, size_t count)
{
    if (t->use == MODEL_TEXTURE_NORMAL || t->alpha_unread) return 0;
    if (t->use == MODEL_TEXTURE_COLOR && !t->with_alpha && !t->alpha_is_data) return 0; /* glTF ignores such alphas */
    for (size_t i = 0; i < count; i++) {
        if (bytes[i * 4 + 3] != 255) return 1;
    }
    return 0;
}

/* Whether it is stored in ASTC. The runtime reads alphas that cut or blend for picking, and decodes ETC2 alone. */
static int is_astc(const model_texture *t)
{
    return t->blocks == MODEL_BLOCKS_ASTC && (!t->with_alpha || t->alpha_unread);
}

/* Larger blocks of normal maps show as facets in highlights, whatever their error is. */
static uint32_t astc_formats(const model_texture *t, uint32_t formats[4])
{
    uint32_t count = 0;
    for (uint32_t f = t->use == MODEL_TEXTURE_NORMAL ? NOH_TEXTURE_ASTC_6X6 : NOH_TEXTURE_ASTC_8X8;
         f >= NOH_TEXTURE_ASTC_4X4; f--) {
        formats[count++] = f;
    }
    return count;
}

/* The formats to try for a texture, the smallest first. Textures that are read texel by texel have none: blocks would
 * mix their colours. */
static uint32_t formats_of(const model_texture *t, const noh_texture_header *h, const texture_image *pixels,
                           uint32_t formats[4])
{
    if (!t->blocks || h->nearest || h->width < 4u || h->height < 4u) return 0;
    if (is_astc(t)) return astc_formats(t, formats);
    formats[0] = NOH_TEXTURE_ETC2_RGB;
    formats[1] = NOH_TEXTURE_EAC_RG;
    if (t->use == MODEL_TEXTURE_NORMAL) return 2;
    if (!pixels->keeps_alpha) return 1;
    formats[0] = formats[1] = NOH_TEXTURE_ETC2_RGBA;
    if (!t->cut_alone) return 1;
    formats[0] = NOH_TEXTURE_ETC2_RGBA1;
    return 2;
}

/* The first level, in the smallest format that is good enough: a normal map's colour blocks keep less than blocks
 * of two channels, one-bit alphas are good enough only with few values between, and small textures stay exact where
 * blocks lose too much. */
static int append_first(const model_texture *t, noh_texture_header *h, const texture_image *pixels, byte_buffer *out)
{
    const size_t at = out->count;
    uint32_t formats[4];
    const uint32_t count = formats_of(t, h, pixels, formats), first = is_astc(t) ? 1u : 0u;
    const int is_small = h->width <= SIDE_SMALL && h->height <= SIDE_SMALL;
    const float enough = t->use == MODEL_TEXTURE_NORMAL ? ERROR_FINE : ERROR_GOOD;
    for (uint32_t i = first; i < 2u * count;
         i += 1u + first) { /* where blocks that pack well lose too much, the nearest blocks */
        const float most = i / 2u + 1u < count ? enough : is_small ? ERROR_GOOD : 65025.0f;
        texture_image tried = *pixels;
        if (i & 1u) tried.bit_worth = 0;
        out->count = at;
        h->format = formats[i / 2u];
        if (texture_blocks_append(&tried, h->format, out)) return 1;
        h->error = texture_blocks_error(&tried, h->format, out->bytes + at);
        if (h->error < 0.0f) return 1;
        if (h->error <= (i & 1u || most < ERROR_GOOD ? most : ERROR_GOOD)) return 0;
    }
    out->count = at;
    h->format = NOH_TEXTURE_RGBA8;
    h->error = 0.0f;
    return buffer_append(out, pixels->rgba, (size_t)h->width * h->height * 4u), out->failed;
}

static int append_level(const model_texture *t, noh_texture_header *h, const image *level, const uint8_t *bytes,
                        byte_buffer *out)
{
    const int alpha = keeps_alpha(t, bytes, (size_t)level->width * level->height);
    const texture_image pixels = { bytes,     level->width, level->height, t->with_alpha,
                                   BIT_WORTH, cutoff_of(t), t->use,        alpha };
    if (!h->level_count) return append_first(t, h, &pixels, out);
    if (h->format) return texture_blocks_append(&pixels, h->format, out);
    return buffer_append(out, bytes, (size_t)level->width * level->height * 4u), out->failed;
}

static uint32_t size_max(const model_texture *t)
{
    return t->size_max && t->size_max < NOH_TEXTURE_SIZE_MAX ? t->size_max : NOH_TEXTURE_SIZE_MAX;
}

/* The first level: halved until it is small enough, without what is trimmed. `bytes` are the source's where it is not
 * halved. */
static int make_first(const model_texture *t, const int32_t light[256], image *level, noh_texture_header *h,
                      uint8_t *bytes)
{
    const int is_source = level->width <= size_max(t) && level->height <= size_max(t);
    uint32_t sides[2] = { t->width, t->height };
    while (level->width > size_max(t) || level->height > size_max(t)) {
        if (halve(t, level)) return 1;
    }
    h->trim = texture_trim_word(t);
    if (h->trim) {
        h->whole_width = (uint16_t)level->width;
        h->whole_height = (uint16_t)level->height;
        texture_trim_texels(t, level->texels, 4 * sizeof *level->texels, &level->width, &level->height);
    }
    if (is_source) {
        memcpy(bytes, t->rgba, (size_t)t->width * t->height * 4);
        if (h->trim) texture_trim_texels(t, bytes, 4, &sides[0], &sides[1]);
    } else {
        close_image(t, level, light, bytes);
    }
    h->width = level->width;
    h->height = level->height;
    h->level_count = 0;
    return 0;
}

int texture_levels_write(const model_texture *t, noh_texture_header *h, byte_buffer *out)
{
    int32_t light[256];
    image level;
    uint64_t share = 0, whole = 0;
    const uint32_t cutoff = cutoff_of(t);
    uint8_t *bytes = malloc((size_t)t->width * t->height * 4);
    int failed = open_image(t, (linear_light(light), light), &level) || !bytes;
    failed = failed || make_first(t, light, &level, h, bytes);
    for (int more = 1; !failed && more;) {
        const uint64_t count = (uint64_t)level.width * level.height;
        if (h->level_count) close_image(t, &level, light, bytes);
        if (!h->level_count) {
            share = covered(bytes, count, cutoff);
            whole = count;
        } else if (cutoff) {
            keep_coverage(bytes, count, cutoff, share, whole);
        }
        failed = append_level(t, h, &level, bytes, out);
        h->level_count++;
        more = !h->nearest && (level.width > 1 || level.height > 1);
        failed = failed || (more && halve(t, &level));
    }
    free(level.texels);
    free(bytes);
    return failed;
}
