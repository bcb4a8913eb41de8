/* etc2_block.h: the block of ETC2 or EAC that is the nearest to 4 x 4 texels.
 *
 *   etc2_encode_rgb    colours: individual, differential, T, H and planar, whichever is off by the least; with an alpha
 *                      of one bit without individual, and where texels are transparent differential and T alone
 *   eac_encode         one channel, of 8 or 11 bits
 *
 * All sums are of integers: every machine makes the same bytes. Errors are squares of differences of bytes, summed over
 * texels and channels; of 11 bits likewise, in their steps.
 *
 * Texel x, y has the number 4 x + y, as in the blocks. The search starts with the mean colour of each half, chooses
 * table and selectors, sets the colour to the mean of what these leave, and again while that helps; then it moves each
 * channel of the best by a step. Stroem and Pettersson, "ETC2: Texture Compression using Invalid Combinations"
 * (Graphics Hardware 2007), has the modes; the bits are in OpenGL ES 3.0.6, appendix C.1. */
#ifndef NOH_CONVERT_TEXTURE_ETC2_BLOCK_H
#define NOH_CONVERT_TEXTURE_ETC2_BLOCK_H

#include <stdint.h>

typedef struct etc2_texels {
    int32_t rgb[16][3];
    int32_t counts[16]; /* 1, or 0: nobody sees this colour */
    int cut;            /* 1: a block of NOH_TEXTURE_ETC2_RGBA1 */
    uint32_t holes;     /* of such a block, bit i: texel i is transparent; its count is 0 */
    uint32_t bit_worth; /* error that a bit less is worth, when the block is sent; 0: the nearest block */
} etc2_texels;

/* The best so far: that with the least error and what its bits are worth. */
typedef struct etc2_best {
    uint64_t block;
    uint32_t error;
    uint32_t bits; /* that it takes when it is sent (wire_etc2.c), roughly */
} etc2_best;

/* The gain in error that a block must give for each additional bit. */
static inline int etc2_is_better(const etc2_texels *t, uint32_t error, uint32_t bits, const etc2_best *best)
{
    return (uint64_t)error + (uint64_t)t->bit_worth * bits <
           (uint64_t)best->error + (uint64_t)t->bit_worth * best->bits;
}

/* Bits of a difference: few where it is small. */
static inline uint32_t etc2_bits_of(int32_t difference)
{
    uint32_t n = (uint32_t)(difference < 0 ? -difference : difference), bits = 0;
    for (; n; n >>= 1) bits += 2;
    return bits;
}

/* Bits of a block's selectors: each that differs from its neighbours costs one more. */
uint32_t etc2_bits_of_selectors(uint64_t block);

static inline int32_t etc2_clamp(int32_t value, int32_t most)
{
    return value < 0 ? 0 : value > most ? most : value;
}

/* Modes of their own; each replaces *best where it is nearer. */
void etc2_try_halves(const etc2_texels *t, etc2_best *best);
void etc2_try_paints(const etc2_texels *t, etc2_best *best);
void etc2_try_planar(const etc2_texels *t, etc2_best *best);

/* Writes 8 bytes. */
/* beside: blocks to the left and above, or NULL: the same again takes next to no bits. */
void etc2_encode_rgb(const etc2_texels *t, const uint8_t *const beside[2], uint8_t block[8]);

/* values[16]: 0..255, with eleven 0..2047. beside, bit_worth: as above. Writes 8 bytes. */
void eac_encode(const int32_t values[16], int eleven, uint32_t bit_worth, const uint8_t *const beside[2],
                uint8_t block[8]);

#endif
