#include "texture_blocks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "etc2_block.h"
#include "texture_astc.h"
#include "noh/format.h"
#include "noh/low_core.h"

static const uint8_t *texel_at(const texture_image *level, uint32_t x, uint32_t y)
{
    x = x < level->width ? x : level->width - 1u;
    y = y < level->height ? y : level->height - 1u;
    return level->rgba + ((size_t)y * level->width + x) * 4u;
}

/* As the shader reads it, and unit. */
static void vector_of(const uint8_t *texel, double v[3])
{
    double length = 0.0;
    for (int c = 0; c < 3; c++) {
        v[c] = (texel[c] - 128.0) / 127.0;
        length += v[c] * v[c];
    }
    length = sqrt(length);
    for (int c = 0; c < 3; c++) v[c] = length > 1e-9 ? v[c] / length : c == 2;
}

void texture_unit_bytes(const uint8_t texel[4], uint8_t unit[4])
{
    double v[3];
    vector_of(texel, v);
    for (int c = 0; c < 3; c++) unit[c] = (uint8_t)floor(v[c] * 127.0 + 128.5);
    unit[3] = 255;
}

static int32_t eleven_bits(double component)
{
    const double value = floor((component * 127.0 + 128.0) / 255.0 * 2047.0 + 0.5);
    return value < 0.0 ? 0 : value > 2047.0 ? 2047 : (int32_t)value;
}

/* The second 8 bytes of the blocks beside. */
static void second_of(const uint8_t *const near[2], const uint8_t *second[2])
{
    for (int i = 0; i < 2; i++) second[i] = near[i] ? near[i] + 8 : NULL;
}

static void encode_pair(const texture_image *level, uint32_t x, uint32_t y, const uint8_t *const near[2],
                        uint8_t *block)
{
    const uint8_t *second[2];
    int32_t values[2][16];
    for (uint32_t i = 0; i < 16; i++) {
        double v[3];
        vector_of(texel_at(level, x + i / 4u, y + i % 4u), v);
        for (int c = 0; c < 2; c++) values[c][i] = eleven_bits(v[c]);
    }
    second_of(near, second);
    eac_encode(values[0], 1, level->bit_worth, near, block);
    eac_encode(values[1], 1, level->bit_worth, second, block + 8);
}

/* Whether a colour is seen. */
static int color_counts(const texture_image *level, uint32_t format, const uint8_t *texel)
{
    return format == NOH_TEXTURE_ETC2_RGBA1 ? texel[3] >= level->cutoff : !level->with_alpha || texel[3] != 0;
}

static void encode_color(const texture_image *level, uint32_t x, uint32_t y, uint32_t format,
                         const uint8_t *const near[2], uint8_t *block)
{
    const uint8_t *beside[2] = { near[0], near[1] };
    int32_t alphas[16];
    etc2_texels t;
    t.cut = format == NOH_TEXTURE_ETC2_RGBA1;
    t.holes = 0;
    t.bit_worth = level->bit_worth;
    for (uint32_t i = 0; i < 16; i++) {
        const uint8_t *texel = texel_at(level, x + i / 4u, y + i % 4u);
        for (int c = 0; c < 3; c++) t.rgb[i][c] = texel[c];
        alphas[i] = texel[3];
        t.counts[i] = color_counts(level, format, texel);
        t.holes |= t.cut && !t.counts[i] ? 1u << i : 0u;
    }
    if (format == NOH_TEXTURE_ETC2_RGBA) {
        eac_encode(alphas, 0, level->bit_worth, near, block);
        block += 8;
        second_of(near, beside);
    }
    etc2_encode_rgb(&t, beside, block);
}

/* Whether the block's texels equal the block to the left. */
static int is_repeated(const texture_image *level, uint32_t x, uint32_t y)
{
    if (!x || x + 4u > level->width) return 0;
    for (uint32_t j = y; j < y + 4u && j < level->height; j++) {
        const uint8_t *row = texel_at(level, x, j);
        if (memcmp(row, row - 16, 16) != 0) return 0;
    }
    return 1;
}

int texture_blocks_append(const texture_image *level, uint32_t format, byte_buffer *out)
{
    const size_t bytes = noh_texture_block_bytes(format);
    const size_t row = (level->width + 3u) / 4u * bytes;
    uint8_t block[16], above[16];
    if (format >= NOH_TEXTURE_ASTC_4X4) return texture_astc_encode(level, format, out);
    for (uint32_t y = 0; y < level->height; y += 4u) {
        for (uint32_t x = 0; x < level->width; x += 4u) {
            uint8_t left[16];
            const uint8_t *const near[2] = { x ? left : NULL, y ? above : NULL };
            if (x) memcpy(left, block, sizeof left);
            if (y && !out->failed) memcpy(above, out->bytes + out->count - row, bytes);
            if (is_repeated(level, x, y)) {
                /* the same again */
            } else if (format == NOH_TEXTURE_EAC_RG) {
                encode_pair(level, x, y, near, block);
            } else {
                encode_color(level, x, y, format, near, block);
            }
            buffer_append(out, block, bytes);
        }
    }
    return out->failed;
}

static double square(double v)
{
    return v * v;
}

/* x and y of a decoded texel, 0 to 255. */
static double vector_error(const uint8_t *texel, double x, double y)
{
    double v[3], got[3] = { (x - 128.0) / 127.0, (y - 128.0) / 127.0, 0.0 };
    vector_of(texel, v);
    const double left = 1.0 - got[0] * got[0] - got[1] * got[1];
    got[2] = left > 0.0 ? sqrt(left) : 0.0;
    return (square(v[0] - got[0]) + square(v[1] - got[1]) + square(v[2] - got[2])) * 127.0 * 127.0;
}

typedef struct error_sum {
    double squares;
    uint64_t count;
} error_sum;

static void add_pair(const texture_image *level, uint32_t x, uint32_t y, const uint8_t *block, error_sum *sum)
{
    uint16_t values[2][16];
    noh_eac_decode(block, 1, values[0]);
    noh_eac_decode(block + 8, 1, values[1]);
    for (uint32_t i = 0; i < 16; i++) {
        const uint32_t at_x = x + i % 4u, at_y = y + i / 4u;
        const double scale = 255.0 / 2047.0;
        if (at_x >= level->width || at_y >= level->height) continue;
        sum->squares += vector_error(texel_at(level, at_x, at_y), values[0][i] * scale, values[1][i] * scale);
        sum->count += 3;
    }
}

/* counts: of its colour */
static void add_texel(const uint8_t *texel, const uint8_t *got, int counts, int with_alpha, error_sum *sum)
{
    for (int c = 0; c < 3 && counts; c++) sum->squares += square((double)got[c] - texel[c]);
    sum->count += counts ? 3u : 0u;
    if (!with_alpha) return;
    sum->squares += square((double)got[3] - texel[3]);
    sum->count++;
}

static void add_color(const texture_image *level, uint32_t x, uint32_t y, uint32_t format, const uint8_t *block,
                      error_sum *sum)
{
    uint8_t texels[16][4];
    noh_etc2_decode(format, block, 1, texels[0]);
    for (uint32_t i = 0; i < 16; i++) {
        const uint32_t at_x = x + i % 4u, at_y = y + i / 4u;
        if (at_x >= level->width || at_y >= level->height) continue;
        const uint8_t *texel = texel_at(level, at_x, at_y);
        add_texel(texel, texels[i], color_counts(level, format, texel), format != NOH_TEXTURE_ETC2_RGB, sum);
    }
}

static float astc_error(const texture_image *level, uint32_t format, const uint8_t *blocks)
{
    const size_t count = (size_t)level->width * level->height;
    error_sum sum = { 0.0, 0 };
    uint8_t *rgba = malloc(4u * count);
    const int failed = !rgba || texture_astc_decode(level, format, blocks, rgba);
    for (size_t i = 0; i < count && !failed; i++) {
        const uint8_t *texel = level->rgba + 4u * i, *got = rgba + 4u * i;
        if (level->use == MODEL_TEXTURE_NORMAL) {
            sum.squares += vector_error(texel, got[0], got[1]);
            sum.count += 3;
        } else {
            add_texel(texel, got, 1, level->keeps_alpha, &sum);
        }
    }
    free(rgba);
    return failed ? -1.0f : (float)(sum.squares / (double)sum.count);
}

float texture_blocks_error(const texture_image *level, uint32_t format, const uint8_t *blocks)
{
    const size_t bytes = noh_texture_block_bytes(format);
    error_sum sum = { 0.0, 0 };
    if (format >= NOH_TEXTURE_ASTC_4X4) return astc_error(level, format, blocks);
    for (uint32_t y = 0; y < level->height; y += 4u) {
        for (uint32_t x = 0; x < level->width; x += 4u, blocks += bytes) {
            if (format == NOH_TEXTURE_EAC_RG) {
                add_pair(level, x, y, blocks, &sum);
            } else {
                add_color(level, x, y, format, blocks, &sum);
            }
        }
    }
    return sum.count ? (float)(sum.squares / (double)sum.count) : 0.0f;
}

double texture_quality_db(const noh_texture_header *header)
{
    const double db = header->error > 0.0f ? 10.0 * log10(255.0 * 255.0 / (double)header->error) : 99.0;
    return db < 99.0 ? db : 99.0;
}

const char *texture_format_name(uint32_t format)
{
    static const char *const names[] = { "RGBA8",    "ETC2 RGB", "ETC2 RGBA", "EAC RG",  "ETC2 RGBA1",
                                         "ASTC 4x4", "ASTC 5x5", "ASTC 6x6",  "ASTC 8x8" };
    return names[format];
}
