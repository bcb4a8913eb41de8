#include "etc2_block.h"

#include <limits.h>

/* Modes T and H are tried where the others are off by more than this in the mean of texels and channels: 41 dB. */
#define GOOD_ENOUGH (16u * 3u * 5u)

/* Sixteen selectors of 2, of no colour. */
#define ALL_HOLES 0xffff0000u

void etc2_encode_rgb(const etc2_texels *t, uint8_t block[8])
{
    etc2_best best = { ALL_HOLES, UINT_MAX };
    if (t->holes == 0xffffu) best.error = 0;
    if (!t->holes) etc2_try_planar(t, &best);
    etc2_try_halves(t, &best);
    if (best.error > GOOD_ENOUGH) etc2_try_paints(t, &best);
    for (int i = 0; i < 8; i++) block[i] = (uint8_t)(best.block >> (56 - 8 * i));
}
