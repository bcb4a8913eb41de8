/* etc2_halves.c: blocks of two halves, side by side or one above the other, each with a colour of its own. */
#include "etc2_block.h"

#include <limits.h>
#include <stdlib.h>

#define HALF 8

static const int32_t tables[8][2] = { { 2, 8 },   { 5, 17 },  { 9, 29 },   { 13, 42 },
                                      { 18, 60 }, { 24, 80 }, { 33, 106 }, { 47, 183 } };

/* Texels of a half. */
typedef struct half {
    int32_t rgb[HALF][3], counts[HALF], texels[HALF];
    int32_t sums[3], count;
    int with_holes;
    uint8_t hole[HALF];
} half;

/* A colour in 4 or 5 bits, a table, and what each texel takes from it: 0 and 1 are added, 2 and 3 subtracted. In a
 * block with holes 2 is a hole, and 0 adds nothing. */
typedef struct fit {
    int32_t color[3], table;
    uint8_t selectors[HALF];
    uint32_t error;
} fit;

static int32_t widened(int32_t color, int five)
{
    return five ? color << 3 | color >> 2 : color * 17;
}

static int32_t narrowed(int32_t sum, int32_t count, int five)
{
    const int32_t most = five ? 31 : 15;
    const int32_t value = etc2_clamp(sum, 255 * count);
    return (2 * value * most + 255 * count) / (2 * 255 * count);
}

static void take_half(const etc2_texels *t, int flip, int second, half *h)
{
    int n = 0;
    h->sums[0] = h->sums[1] = h->sums[2] = h->count = 0;
    h->with_holes = t->holes != 0;
    for (int i = 0; i < 16; i++) {
        if ((flip ? i % 4 / 2 : i / 8) != second) continue;
        h->texels[n] = i;
        h->counts[n] = t->counts[i];
        h->hole[n] = (uint8_t)(t->holes >> i & 1u);
        h->count += t->counts[i];
        for (int c = 0; c < 3; c++) {
            h->rgb[n][c] = t->rgb[i][c];
            h->sums[c] += t->counts[i] * t->rgb[i][c];
        }
        n++;
    }
}

static int32_t added_by(const half *h, int32_t table, int selector)
{
    const int32_t add = tables[table][selector & 1];
    if (h->with_holes && !(selector & 1)) return 0;
    return selector & 2 ? -add : add;
}

/* Choose the selectors of a colour and table. */
static void select_all(const half *h, int five, fit *f)
{
    int32_t paints[4][3];
    for (int s = 0; s < 4; s++) {
        const int32_t add = added_by(h, f->table, s);
        for (int c = 0; c < 3; c++) paints[s][c] = etc2_clamp(widened(f->color[c], five) + add, 255);
    }
    f->error = 0;
    for (int i = 0; i < HALF; i++) {
        uint32_t nearest = UINT_MAX;
        f->selectors[i] = 2;
        for (int s = 0; s < 4 && !h->hole[i]; s++) {
            if (h->with_holes && s == 2) continue;
            const int32_t r = h->rgb[i][0] - paints[s][0], g = h->rgb[i][1] - paints[s][1],
                          b = h->rgb[i][2] - paints[s][2];
            const uint32_t off = (uint32_t)(r * r + g * g + b * b);
            if (off < nearest) {
                nearest = off;
                f->selectors[i] = (uint8_t)s;
            }
        }
        f->error += h->counts[i] ? nearest : 0;
    }
}

/* The colour that fits the selectors the best, clamping left aside, within `low` to `high`. 1: it is another. */
static int refit(const half *h, int five, const int32_t low[3], const int32_t high[3], fit *f)
{
    int32_t added = 0;
    int moved = 0;
    for (int i = 0; i < HALF; i++) added += h->counts[i] * added_by(h, f->table, f->selectors[i]);
    for (int c = 0; c < 3 && h->count; c++) {
        int32_t color = narrowed(h->sums[c] - added, h->count, five);
        color = color < low[c] ? low[c] : color > high[c] ? high[c] : color;
        moved |= color != f->color[c];
        f->color[c] = color;
    }
    return moved;
}

/* Move each channel by a step while that helps. */
static void polish(const half *h, int five, const int32_t low[3], const int32_t high[3], fit *best)
{
    for (int i = 0; i < 6 && best->error; i++) {
        fit f = *best;
        f.color[i / 2] += i & 1 ? 1 : -1;
        if (f.color[i / 2] < low[i / 2] || f.color[i / 2] > high[i / 2]) continue;
        select_all(h, five, &f);
        if (f.error < best->error) *best = f;
    }
}

static void fit_half(const half *h, int five, const int32_t low[3], const int32_t high[3], fit *best)
{
    best->error = UINT_MAX;
    for (int32_t table = 0; table < 8 && best->error; table++) {
        fit f = { { 0, 0, 0 }, table, { 0 }, 0 };
        for (int c = 0; c < 3; c++) {
            const int32_t color = h->count ? narrowed(h->sums[c], h->count, five) : 0;
            f.color[c] = color < low[c] ? low[c] : color > high[c] ? high[c] : color;
        }
        for (int round = 0; round < 4; round++) {
            select_all(h, five, &f);
            if (f.error < best->error) *best = f;
            if (!refit(h, five, low, high, &f)) break;
        }
    }
    polish(h, five, low, high, best);
}

static uint64_t block_of(const half halves[2], const fit fits[2], int five, int flip)
{
    uint64_t block = (uint64_t)fits[0].table << 37 | (uint64_t)fits[1].table << 34 | (uint64_t)flip << 32;
    block |= (uint64_t)(five && !halves[0].with_holes) << 33;
    for (int c = 0; c < 3; c++) {
        const int at = 56 - 8 * c;
        const int32_t difference = fits[1].color[c] - fits[0].color[c];
        block |= five ? (uint64_t)fits[0].color[c] << (at + 3) | (uint64_t)(difference & 7) << at
                      : (uint64_t)fits[0].color[c] << (at + 4) | (uint64_t)fits[1].color[c] << at;
    }
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < HALF; i++) {
            const uint64_t s = fits[k].selectors[i];
            block |= (s & 1u) << halves[k].texels[i] | (s >> 1) << (halves[k].texels[i] + 16);
        }
    }
    return block;
}

/* Whether the second colour is within what three bits of difference reach. */
static int is_near(const fit fits[2])
{
    int near = 1;
    for (int c = 0; c < 3; c++) {
        const int32_t d = fits[1].color[c] - fits[0].color[c];
        near = near && d >= -4 && d <= 3;
    }
    return near;
}

/* Fit the half `moved` within reach of the other's colour. */
static void bring_near(const half halves[2], const fit from[2], int moved, fit fits[2])
{
    int32_t low[3], high[3];
    fits[0] = from[0];
    fits[1] = from[1];
    for (int c = 0; c < 3; c++) {
        const int32_t other = from[!moved].color[c];
        low[c] = moved ? other - 4 : other - 3;
        high[c] = moved ? other + 3 : other + 4;
        low[c] = low[c] < 0 ? 0 : low[c];
        high[c] = high[c] > 31 ? 31 : high[c];
    }
    fit_half(&halves[moved], 1, low, high, &fits[moved]);
}

static void keep(const etc2_texels *t, const half halves[2], const fit fits[2], int five, int flip, etc2_best *best)
{
    const uint32_t error = fits[0].error + fits[1].error;
    const uint64_t block = block_of(halves, fits, five, flip);
    uint32_t bits = 10u + etc2_bits_of_selectors(block);
    for (int c = 0; c < 3; c++) bits += etc2_bits_of(fits[1].color[c] - fits[0].color[c]);
    if (!etc2_is_better(t, error, bits, best)) return;
    best->error = error;
    best->bits = bits;
    best->block = block;
}

void etc2_try_halves(const etc2_texels *t, etc2_best *best)
{
    static const int32_t low[3] = { 0, 0, 0 }, high4[3] = { 15, 15, 15 }, high5[3] = { 31, 31, 31 };
    for (int flip = 0; flip < 2 && best->error; flip++) {
        half halves[2];
        fit fits[2], near[2];
        for (int k = 0; k < 2; k++) {
            take_half(t, flip, k, &halves[k]);
            fit_half(&halves[k], 1, low, high5, &fits[k]);
        }
        if (is_near(fits)) {
            keep(t, halves, fits, 1, flip, best);
            continue; /* four bits are no better */
        }
        for (int moved = 0; moved < 2; moved++) {
            bring_near(halves, fits, moved, near);
            keep(t, halves, near, 1, flip, best);
        }
        if (t->cut) continue; /* has no such mode */
        for (int k = 0; k < 2; k++) fit_half(&halves[k], 0, low, high4, &fits[k]);
        keep(t, halves, fits, 0, flip, best);
    }
}
