#include "etc2_block.h"

#include <limits.h>

#include "noh/format.h"
#include "noh/low_core.h"

/* Modes T and H are tried where the others are off by more than this in the mean of texels and channels: 41 dB. */
#define GOOD_ENOUGH (16u * 3u * 5u)

/* Sixteen selectors of 2, of no colour. */
#define ALL_HOLES 0xffff0000u

uint32_t etc2_bits_of_selectors(uint64_t block)
{
    uint32_t changes = 0;
    for (uint32_t i = 0; i < 16u; i++) {
        const uint32_t down = i % 4u < 3u ? i + 1u : i, right = i < 12u ? i + 4u : i;
        const uint32_t s = (uint32_t)(block >> i & 0x10001u);
        changes += s != (uint32_t)(block >> down & 0x10001u);
        changes += s != (uint32_t)(block >> right & 0x10001u);
    }
    return 4u + changes;
}

/* The error of a neighbouring block here; with other holes it cannot be used. */
static void try_beside(const etc2_texels *t, const uint8_t *beside, etc2_best *best)
{
    uint8_t texels[16][4];
    uint32_t error = 0;
    uint64_t block = 0;
    noh_etc2_decode(t->cut ? NOH_TEXTURE_ETC2_RGBA1 : NOH_TEXTURE_ETC2_RGB, beside, 1, texels[0]);
    for (int i = 0; i < 16; i++) {
        const uint8_t *texel = texels[i % 4 * 4 + i / 4];
        if ((texel[3] == 0) != (int)(t->holes >> i & 1u)) return;
        for (int c = 0; c < 3 && t->counts[i]; c++) {
            const int32_t off = texel[c] - t->rgb[i][c];
            error += (uint32_t)(off * off);
        }
    }
    if (!etc2_is_better(t, error, 1, best)) return;
    for (int i = 0; i < 8; i++) block = block << 8 | beside[i];
    best->block = block;
    best->error = error;
    best->bits = 1;
}

void etc2_encode_rgb(const etc2_texels *t, const uint8_t *const beside[2], uint8_t block[8])
{
    etc2_best best = { ALL_HOLES, UINT_MAX, 0 };
    if (t->holes == 0xffffu) best.error = 0;
    for (int i = 0; i < 2; i++) {
        if (beside[i]) try_beside(t, beside[i], &best);
    }
    if (!t->holes) etc2_try_planar(t, &best);
    etc2_try_halves(t, &best);
    if (best.error > GOOD_ENOUGH) etc2_try_paints(t, &best);
    for (int i = 0; i < 8; i++) block[i] = (uint8_t)(best.block >> (56 - 8 * i));
}
