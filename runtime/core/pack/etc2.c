/* etc2.c: decoding ETC2 and EAC. A block is read as two words, the most significant byte first; texel x, y of it has
 * the number 4 x + y. */
#include "core/base/half_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"

#include <string.h>


/* The words of a block of colours. */
typedef struct words {
    uint32_t high, low;
} words;

typedef struct rgb {
    int32_t c[3];
} rgb;

static uint32_t word_at(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* `count` bits from bit `at` up. */
static int32_t bits(uint32_t word, uint32_t at, uint32_t count)
{
    return (int32_t)(word >> at & ((1u << count) - 1u));
}

static int32_t clamp(int32_t value, int32_t most)
{
    return value < 0 ? 0 : value > most ? most : value;
}

static int32_t widen4(int32_t v)
{
    return v * 17;
}

static int32_t widen5(int32_t v)
{
    return v << 3 | v >> 2;
}

static int32_t widen6(int32_t v)
{
    return v << 2 | v >> 4;
}

static int32_t widen7(int32_t v)
{
    return v << 1 | v >> 6;
}

/* The two bits of a texel. */
static uint32_t selector(words w, uint32_t texel)
{
    return (w.low >> (texel + 16u) & 1u) << 1 | (w.low >> texel & 1u);
}

static void put(rgb from, int32_t add, uint8_t *to)
{
    for (int c = 0; c < 3; c++) to[c] = (uint8_t)clamp(from.c[c] + add, 255);
}

/* Two halves, each with a colour and a table of what is added to it; holes: the smaller of the two is 0. */
static void decode_halves(words w, const rgb base[2], int holes, uint8_t *to, size_t stride)
{
    static const uint8_t tables[8][2] = { { 2, 8 },   { 5, 17 },  { 9, 29 },   { 13, 42 },
                                          { 18, 60 }, { 24, 80 }, { 33, 106 }, { 47, 183 } };
    for (uint32_t x = 0; x < 4; x++) {
        for (uint32_t y = 0; y < 4; y++) {
            const uint32_t half = (w.high & 1u ? y : x) / 2u, which = selector(w, 4u * x + y);
            const int32_t add = holes && !(which & 1u) ? 0 : tables[bits(w.high, half ? 2u : 5u, 3)][which & 1u];
            put(base[half], which & 2u ? -add : add, to + y * stride + x * 4u);
        }
    }
}

static void decode_paints(words w, const rgb paints[4], uint8_t *to, size_t stride)
{
    for (uint32_t x = 0; x < 4; x++) {
        for (uint32_t y = 0; y < 4; y++) put(paints[selector(w, 4u * x + y)], 0, to + y * stride + x * 4u);
    }
}

static rgb shifted(rgb from, int32_t add)
{
    for (int c = 0; c < 3; c++) from.c[c] = clamp(from.c[c] + add, 255);
    return from;
}

static int32_t distance_at(uint32_t index)
{
    static const uint8_t distances[8] = { 3, 6, 11, 16, 23, 32, 41, 64 };
    return distances[index & 7u];
}

/* Mode T: one colour alone, and another with two variants. */
static void decode_t(words w, uint8_t *to, size_t stride)
{
    const uint32_t h = w.high;
    const rgb one = { { widen4(bits(h, 27, 2) << 2 | bits(h, 24, 2)), widen4(bits(h, 20, 4)),
                        widen4(bits(h, 16, 4)) } };
    const rgb two = { { widen4(bits(h, 12, 4)), widen4(bits(h, 8, 4)), widen4(bits(h, 4, 4)) } };
    const int32_t d = distance_at((h >> 1 & 6u) | (h & 1u));
    const rgb paints[4] = { one, shifted(two, d), two, shifted(two, -d) };
    decode_paints(w, paints, to, stride);
}

/* Mode H: two colours, each as a pair. The order of the two is a bit of the distance. */
static void decode_h(words w, uint8_t *to, size_t stride)
{
    const uint32_t h = w.high;
    const int32_t a[3] = { bits(h, 27, 4), bits(h, 24, 3) << 1 | bits(h, 20, 1), bits(h, 19, 1) << 3 | bits(h, 15, 3) };
    const int32_t b[3] = { bits(h, 11, 4), bits(h, 7, 4), bits(h, 3, 4) };
    const int order = (a[0] << 8 | a[1] << 4 | a[2]) >= (b[0] << 8 | b[1] << 4 | b[2]);
    const int32_t d = distance_at((h & 4u) | (h & 1u) << 1 | (uint32_t)order);
    const rgb one = { { widen4(a[0]), widen4(a[1]), widen4(a[2]) } };
    const rgb two = { { widen4(b[0]), widen4(b[1]), widen4(b[2]) } };
    const rgb paints[4] = { shifted(one, d), shifted(one, -d), shifted(two, d), shifted(two, -d) };
    decode_paints(w, paints, to, stride);
}

/* Mode planar: colours at the corner, four texels to the right and four down. */
static void decode_planar(words w, uint8_t *to, size_t stride)
{
    const uint32_t h = w.high, l = w.low;
    const int32_t o[3] = { widen6(bits(h, 25, 6)), widen7(bits(h, 24, 1) << 6 | bits(h, 17, 6)),
                           widen6(bits(h, 16, 1) << 5 | bits(h, 11, 2) << 3 | bits(h, 7, 3)) };
    const int32_t right[3] = { widen6(bits(h, 2, 5) << 1 | bits(h, 0, 1)), widen7(bits(l, 25, 7)),
                               widen6(bits(l, 19, 6)) };
    const int32_t down[3] = { widen6(bits(l, 13, 6)), widen7(bits(l, 6, 7)), widen6(bits(l, 0, 6)) };
    for (int32_t y = 0; y < 4; y++) {
        for (int32_t x = 0; x < 4; x++) {
            uint8_t *texel = to + (size_t)y * stride + (size_t)x * 4u;
            for (int c = 0; c < 3; c++) {
                const int32_t sum = x * (right[c] - o[c]) + y * (down[c] - o[c]) + 4 * o[c] + 2;
                texel[c] = (uint8_t)clamp(sum < 0 ? 0 : sum / 4, 255);
            }
        }
    }
}

/* Two colours of five bits, the second given by its difference; where a channel of it is out of range, the block is of
 * another mode. Bit 1 of the first word says that it is so; else the two have four bits each. With holes it says so
 * whatever the bit is. */
static void decode_color(words w, int holes, uint8_t *to, size_t stride)
{
    const int differs = holes || w.high & 2u;
    rgb base[2];
    int wide[3];
    for (uint32_t c = 0; c < 3; c++) {
        const int32_t first = bits(w.high, 27u - 8u * c, 5), difference = bits(w.high, 24u - 8u * c, 3);
        const int32_t second = first + (difference < 4 ? difference : difference - 8);
        wide[c] = second < 0 || second > 31;
        base[0].c[c] = differs ? widen5(first) : widen4(bits(w.high, 28u - 8u * c, 4));
        base[1].c[c] = differs ? widen5(second & 31) : widen4(bits(w.high, 24u - 8u * c, 4));
    }
    if (differs && wide[0]) {
        decode_t(w, to, stride);
    } else if (differs && wide[1]) {
        decode_h(w, to, stride);
    } else if (differs && wide[2]) {
        decode_planar(w, to, stride);
    } else {
        decode_halves(w, base, holes, to, stride);
    }
}

static int is_planar(words w)
{
    int wide[3];
    for (uint32_t c = 0; c < 3; c++) {
        const int32_t first = bits(w.high, 27u - 8u * c, 5), difference = bits(w.high, 24u - 8u * c, 3);
        const int32_t second = first + (difference < 4 ? difference : difference - 8);
        wide[c] = second < 0 || second > 31;
    }
    return !wide[0] && !wide[1] && wide[2];
}

void noh_eac_decode(const uint8_t block[8], int eleven, uint16_t values[16])
{
    static const int8_t tables[16][8] = { { -3, -6, -9, -15, 2, 5, 8, 14 }, { -3, -7, -10, -13, 2, 6, 9, 12 },
                                          { -2, -5, -8, -13, 1, 4, 7, 12 }, { -2, -4, -6, -13, 1, 3, 5, 12 },
                                          { -3, -6, -8, -12, 2, 5, 7, 11 }, { -3, -7, -9, -11, 2, 6, 8, 10 },
                                          { -4, -7, -8, -11, 3, 6, 7, 10 }, { -3, -5, -8, -11, 2, 4, 7, 10 },
                                          { -2, -6, -8, -10, 1, 5, 7, 9 },  { -2, -5, -8, -10, 1, 4, 7, 9 },
                                          { -2, -4, -8, -10, 1, 3, 7, 9 },  { -2, -5, -7, -10, 1, 4, 6, 9 },
                                          { -3, -4, -7, -10, 2, 3, 6, 9 },  { -1, -2, -3, -10, 0, 1, 2, 9 },
                                          { -4, -6, -8, -9, 3, 5, 7, 8 },   { -3, -5, -7, -9, 2, 4, 6, 8 } };
    const int8_t *table = tables[block[1] & 15u];
    const int32_t base = eleven ? block[0] * 8 + 4 : block[0], times = block[1] >> 4;
    const int32_t step = eleven ? (times ? times * 8 : 1) : times;
    const uint64_t indices = (uint64_t)(block[2] << 8 | block[3]) << 32 | word_at(block + 4);
    for (uint32_t texel = 0; texel < 16; texel++) {
        const int32_t value = base + table[indices >> (45u - 3u * texel) & 7u] * step;
        values[texel % 4u * 4u + texel / 4u] = (uint16_t)clamp(value, eleven ? 2047 : 255);
    }
}

static void decode_pair(const uint8_t *block, uint8_t *to, size_t stride)
{
    uint16_t values[2][16];
    noh_eac_decode(block, 1, values[0]);
    noh_eac_decode(block + 8, 1, values[1]);
    for (uint32_t i = 0; i < 16; i++) {
        uint16_t halves[2];
        for (int c = 0; c < 2; c++) {
            halves[c] = noh_half_from_float((float)values[c][i] / 2047.0f, NOH_HALF_RNE);
        }
        memcpy(to + i / 4u * stride + i % 4u * 4u, halves, sizeof halves);
    }
}

static void decode_opaque(const uint8_t *block, uint8_t *to, size_t stride)
{
    const words w = { word_at(block), word_at(block + 4) };
    decode_color(w, 0, to, stride);
    for (uint32_t i = 0; i < 16; i++) to[i / 4u * stride + i % 4u * 4u + 3u] = 255;
}

/* Bit 1 of the first word: no texel is transparent. Else those are whose selector is 2, but in mode planar. */
static void decode_cut(const uint8_t *block, uint8_t *to, size_t stride)
{
    const words w = { word_at(block), word_at(block + 4) };
    const int holes = !(w.high & 2u);
    decode_color(w, holes, to, stride);
    for (uint32_t x = 0; x < 4; x++) {
        for (uint32_t y = 0; y < 4; y++) {
            uint8_t *texel = to + y * stride + x * 4u;
            texel[3] = 255;
            if (holes && selector(w, 4u * x + y) == 2u && !is_planar(w)) memset(texel, 0, 4);
        }
    }
}

static void decode_alpha(const uint8_t *block, uint8_t *to, size_t stride)
{
    const words w = { word_at(block + 8), word_at(block + 12) };
    uint16_t values[16];
    noh_eac_decode(block, 0, values);
    decode_color(w, 0, to, stride);
    for (uint32_t i = 0; i < 16; i++) to[i / 4u * stride + i % 4u * 4u + 3u] = (uint8_t)values[i];
}

void noh_etc2_decode(uint32_t format, const uint8_t *blocks, uint32_t count, uint8_t *texels)
{
    const size_t stride = (size_t)count * 16u;
    for (uint32_t i = 0; i < count; i++) {
        uint8_t *to = texels + (size_t)i * 16u;
        if (format == NOH_TEXTURE_ETC2_RGB) {
            decode_opaque(blocks + (size_t)i * 8u, to, stride);
        } else if (format == NOH_TEXTURE_ETC2_RGBA) {
            decode_alpha(blocks + (size_t)i * 16u, to, stride);
        } else if (format == NOH_TEXTURE_ETC2_RGBA1) {
            decode_cut(blocks + (size_t)i * 8u, to, stride);
        } else {
            decode_pair(blocks + (size_t)i * 16u, to, stride);
        }
    }
}
