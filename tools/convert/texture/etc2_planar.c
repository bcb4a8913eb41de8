/* etc2_planar.c: mode planar, three colours that span a plane: at the corner, four texels to the right, four down. */
#include "etc2_block.h"

#include <limits.h>

/* One channel: the three values, of 6 bits, green's of 7. */
typedef struct plane {
    int32_t o, right, down;
    uint32_t error, bits;
} plane;

static int32_t widened(int32_t v, int seven)
{
    return seven ? v << 1 | v >> 6 : v << 2 | v >> 4;
}

static int32_t narrowed(int32_t sum, int32_t count, int seven)
{
    const int32_t most = seven ? 127 : 63;
    return (2 * etc2_clamp(sum, 255 * count) * most + 255 * count) / (2 * 255 * count);
}

static uint32_t error_of(const etc2_texels *t, int c, plane *p)
{
    const int32_t o = widened(p->o, c == 1), right = widened(p->right, c == 1), down = widened(p->down, c == 1);
    uint32_t error = 0;
    for (int x = 0; x < 4; x++) {
        for (int y = 0; y < 4; y++) {
            const int32_t sum = x * (right - o) + y * (down - o) + 4 * o + 2;
            const int32_t off = etc2_clamp(sum < 0 ? 0 : sum / 4, 255) - t->rgb[4 * x + y][c];
            error += (uint32_t)(off * off * t->counts[4 * x + y]);
        }
    }
    p->bits = 2u + etc2_bits_of(p->right - p->o) + etc2_bits_of(p->down - p->o);
    return error;
}

static int is_better(const etc2_texels *t, const plane *p, const plane *than)
{
    return p->error + t->bit_worth * p->bits < than->error + t->bit_worth * than->bits;
}

/* The plane of least squares, clamping and counts left aside: its slopes are the values' products with x - 3/2 and
 * y - 3/2, over 20 a texel; in eightieths. */
static plane fit_plane(const etc2_texels *t, int c)
{
    const int32_t most = c == 1 ? 127 : 63;
    int32_t sum = 0, along_x = 0, along_y = 0;
    plane best = { 0, 0, 0, 0, 0 }, p = best;
    for (int i = 0; i < 16; i++) {
        sum += t->rgb[i][c];
        along_x += (2 * (i / 4) - 3) * t->rgb[i][c];
        along_y += (2 * (i % 4) - 3) * t->rgb[i][c];
    }
    /* mean = sum / 16, slope in x = along_x / 40; at the corner: mean - 3/2 of both slopes */
    best.o = narrowed(5 * sum - 3 * along_x - 3 * along_y, 80, c == 1);
    best.right = narrowed(5 * sum + 5 * along_x - 3 * along_y, 80, c == 1);
    best.down = narrowed(5 * sum - 3 * along_x + 5 * along_y, 80, c == 1);
    best.error = error_of(t, c, &best);
    const plane middle = best;
    for (int i = 0; i < 27 && best.error; i++) {
        p = middle;
        p.o += i % 3 - 1;
        p.right += i / 3 % 3 - 1;
        p.down += i / 9 - 1;
        if (p.o < 0 || p.right < 0 || p.down < 0 || p.o > most || p.right > most || p.down > most) continue;
        p.error = error_of(t, c, &p);
        if (is_better(t, &p, &best)) best = p;
    }
    for (int32_t i = -1; i < 2; i++) { /* the same all over */
        p.o = p.right = p.down = etc2_clamp(narrowed(sum, 16, c == 1) + i, most);
        p.error = error_of(t, c, &p);
        if (is_better(t, &p, &best)) best = p;
    }
    return best;
}

/* Whether a byte's difference of three bits leads out of its five. */
static int leads_out(uint64_t block, int at)
{
    const int first = (int)(block >> (at + 3) & 31u), low = (int)(block >> at & 7u);
    const int sum = first + (low < 4 ? low : low - 8);
    return sum < 0 || sum > 31;
}

/* Six bits are free, and say that the block is of this mode: red and green stay in range, blue leads out of it. */
static uint64_t fill(uint64_t block)
{
    static const int at[6] = { 63, 55, 47, 46, 45, 42 };
    for (uint64_t i = 0; i < 64; i++) {
        uint64_t tried = block;
        for (int b = 0; b < 6; b++) tried |= (i >> b & 1u) << at[b];
        if (!leads_out(tried, 56) && !leads_out(tried, 48) && leads_out(tried, 40)) return tried;
    }
    return block;
}

void etc2_try_planar(const etc2_texels *t, etc2_best *best)
{
    plane p[3];
    uint32_t error = 0, bits = 0;
    for (int c = 0; c < 3; c++) {
        p[c] = fit_plane(t, c);
        error += p[c].error;
        bits += p[c].bits;
    }
    if (!etc2_is_better(t, error, bits, best)) return;
    best->error = error;
    best->bits = bits;
    best->block = fill((uint64_t)p[0].o << 57 | (uint64_t)(p[1].o >> 6) << 56 | (uint64_t)(p[1].o & 63) << 49 |
                       (uint64_t)(p[2].o >> 5) << 48 | (uint64_t)(p[2].o >> 3 & 3) << 43 |
                       (uint64_t)(p[2].o & 7) << 39 | (uint64_t)(p[0].right >> 1) << 34 | (uint64_t)1 << 33 |
                       (uint64_t)(p[0].right & 1) << 32 | (uint64_t)p[1].right << 25 | (uint64_t)p[2].right << 19 |
                       (uint64_t)p[0].down << 13 | (uint64_t)p[1].down << 6 | (uint64_t)p[2].down);
}
