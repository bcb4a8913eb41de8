/* etc2_paints.c: modes T and H, four colours for the whole block out of two and a distance: in T the first alone and
 * the second with one on each side of it, in H a pair about each. */
#include "etc2_block.h"

#include <limits.h>
#include <string.h>

static const int32_t distances[8] = { 3, 6, 11, 16, 23, 32, 41, 64 };

typedef struct fit {
    int32_t colors[2][3]; /* 0..15 */
    int32_t distance;
    uint8_t selectors[16];
    uint32_t error;
} fit;

/* The amount that a paint adds, and the colour it is added to. */
static int32_t shift_of(int is_h, int paint, int32_t distance, int *color)
{
    static const int8_t t_signs[4] = { 0, 1, 0, -1 };
    *color = is_h ? paint / 2 : paint > 0;
    if (is_h) return paint & 1 ? -distance : distance;
    return t_signs[paint] * distance;
}

static void select_all(const etc2_texels *t, int is_h, fit *f)
{
    int32_t paints[4][3];
    for (int p = 0; p < 4; p++) {
        int color;
        const int32_t shift = shift_of(is_h, p, distances[f->distance], &color);
        for (int c = 0; c < 3; c++) paints[p][c] = etc2_clamp(f->colors[color][c] * 17 + shift, 255);
    }
    f->error = 0;
    for (int i = 0; i < 16; i++) {
        uint32_t nearest = UINT_MAX;
        f->selectors[i] = 2;
        for (int p = 0; p < 4 && !(t->holes >> i & 1u); p++) {
            if (t->holes && p == 2) continue;
            const int32_t r = t->rgb[i][0] - paints[p][0], g = t->rgb[i][1] - paints[p][1],
                          b = t->rgb[i][2] - paints[p][2];
            const uint32_t off = (uint32_t)(r * r + g * g + b * b);
            if (off < nearest) {
                nearest = off;
                f->selectors[i] = (uint8_t)p;
            }
        }
        f->error += t->counts[i] ? nearest : 0;
    }
}

/* The two colours that fit the selectors the best, clamping left aside. 1: they are others. */
static int refit(const etc2_texels *t, int is_h, fit *f)
{
    int32_t sums[2][3] = { { 0, 0, 0 }, { 0, 0, 0 } }, counts[2] = { 0, 0 };
    int moved = 0;
    for (int i = 0; i < 16; i++) {
        int k;
        const int32_t shift = shift_of(is_h, f->selectors[i], distances[f->distance], &k);
        for (int c = 0; c < 3; c++) sums[k][c] += t->counts[i] * (t->rgb[i][c] - shift);
        counts[k] += t->counts[i];
    }
    for (int k = 0; k < 2; k++) {
        for (int c = 0; c < 3 && counts[k]; c++) {
            const int32_t value = etc2_clamp(sums[k][c], 255 * counts[k]);
            const int32_t color = (2 * value * 15 + 255 * counts[k]) / (2 * 255 * counts[k]);
            moved |= color != f->colors[k][c];
            f->colors[k][c] = color;
        }
    }
    return moved;
}

static int32_t distance2(const int32_t a[3], const int32_t b[3])
{
    const int32_t x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

/* The texel that is the farthest from a colour. */
static const int32_t *farthest(const etc2_texels *t, const int32_t from[3])
{
    int best = 0;
    int32_t most = -1;
    for (int i = 0; i < 16; i++) {
        const int32_t d = t->counts[i] ? distance2(t->rgb[i], from) : -1;
        if (d > most) {
            most = d;
            best = i;
        }
    }
    return t->rgb[best];
}

/* Two clusters, by k-means from texels that lie far from each other. */
static void two_means(const etc2_texels *t, int32_t means[2][3])
{
    const int32_t *one = farthest(t, farthest(t, t->rgb[0])), *two = farthest(t, one);
    memcpy(means[0], one, sizeof means[0]);
    memcpy(means[1], two, sizeof means[1]);
    for (int round = 0; round < 4; round++) {
        int32_t sums[2][3] = { { 0, 0, 0 }, { 0, 0, 0 } }, counts[2] = { 0, 0 };
        for (int i = 0; i < 16; i++) {
            const int k = distance2(t->rgb[i], means[1]) < distance2(t->rgb[i], means[0]);
            for (int c = 0; c < 3; c++) sums[k][c] += t->counts[i] * t->rgb[i][c];
            counts[k] += t->counts[i];
        }
        for (int k = 0; k < 2; k++) {
            for (int c = 0; c < 3 && counts[k]; c++) means[k][c] = (2 * sums[k][c] + counts[k]) / (2 * counts[k]);
        }
    }
}

/* swapped: the second mean is the first colour */
static void fit_mode(const etc2_texels *t, int is_h, int swapped, const int32_t means[2][3], fit *best)
{
    best->error = UINT_MAX;
    for (int32_t distance = 0; distance < 8 && best->error; distance++) {
        fit f;
        f.distance = distance;
        for (int k = 0; k < 2; k++) {
            for (int c = 0; c < 3; c++) f.colors[k][c] = (means[k ^ swapped][c] * 15 + 127) / 255;
        }
        for (int round = 0; round < 3; round++) {
            select_all(t, is_h, &f);
            if (f.error < best->error) *best = f;
            if (!refit(t, is_h, &f)) break;
        }
    }
    for (int i = 0; i < 12 && best->error; i++) {
        fit f = *best;
        f.colors[i / 6][i / 2 % 3] += i & 1 ? 1 : -1;
        if (f.colors[i / 6][i / 2 % 3] < 0 || f.colors[i / 6][i / 2 % 3] > 15) continue;
        select_all(t, is_h, &f);
        if (f.error < best->error) *best = f;
    }
}

static uint64_t selectors_of(const fit *f)
{
    uint64_t block = 0;
    for (int i = 0; i < 16; i++) {
        block |= (uint64_t)(f->selectors[i] & 1u) << i | (uint64_t)(f->selectors[i] >> 1) << (i + 16);
    }
    return block;
}

/* A channel of five bits and a difference of three, with the bits of `mask` free: they are set so that the sum of the
 * two is outside 0..31, or inside. */
static uint64_t fill(uint64_t block, int at, uint64_t mask, int outside)
{
    uint64_t bits = 0;
    do {
        const uint64_t byte = (block >> at & 255u) | bits;
        const int first = (int)(byte >> 3), difference = (int)(byte & 7u) < 4 ? (int)(byte & 7u) : (int)(byte & 7u) - 8;
        const int sum = first + difference;
        if ((sum < 0 || sum > 31) == outside) return block | bits << at;
        bits = (bits - mask) & mask; /* the next subset of the mask */
    } while (bits);
    return block;
}

static uint64_t t_block(const fit *f, int with_holes)
{
    const int32_t *a = f->colors[0], *b = f->colors[1];
    const uint64_t block = (uint64_t)(a[0] >> 2) << 59 | (uint64_t)(a[0] & 3) << 56 | (uint64_t)a[1] << 52 |
                           (uint64_t)a[2] << 48 | (uint64_t)b[0] << 44 | (uint64_t)b[1] << 40 | (uint64_t)b[2] << 36 |
                           (uint64_t)(f->distance >> 1) << 34 | (uint64_t)!with_holes << 33 |
                           (uint64_t)(f->distance & 1) << 32 | selectors_of(f);
    return fill(block, 56, 0xe4, 1);
}

/* The lowest bit of the distance is which of the two colours is the larger: they change places where it is wrong. */
static void order_colors(fit *f)
{
    const int32_t a = f->colors[0][0] << 8 | f->colors[0][1] << 4 | f->colors[0][2];
    const int32_t b = f->colors[1][0] << 8 | f->colors[1][1] << 4 | f->colors[1][2];
    int32_t first[3];
    if ((a >= b) == (f->distance & 1)) return;
    memcpy(first, f->colors[0], sizeof first);
    memcpy(f->colors[0], f->colors[1], sizeof first);
    memcpy(f->colors[1], first, sizeof first);
    for (int i = 0; i < 16; i++) f->selectors[i] ^= 2u;
}

static uint64_t h_block(const fit *f)
{
    const int32_t *a = f->colors[0], *b = f->colors[1];
    const uint64_t block = (uint64_t)a[0] << 59 | (uint64_t)(a[1] >> 1) << 56 | (uint64_t)(a[1] & 1) << 52 |
                           (uint64_t)(a[2] >> 3) << 51 | (uint64_t)(a[2] & 7) << 47 | (uint64_t)b[0] << 43 |
                           (uint64_t)b[1] << 39 | (uint64_t)b[2] << 35 | (uint64_t)(f->distance >> 2) << 34 |
                           (uint64_t)1 << 33 | (uint64_t)(f->distance >> 1 & 1) << 32 | selectors_of(f);
    return fill(fill(block, 56, 0x80, 0), 48, 0xe4, 1);
}

void etc2_try_paints(const etc2_texels *t, etc2_best *best)
{
    int32_t means[2][3];
    fit f;
    two_means(t, means);
    for (int mode = 0; mode < 3 && best->error; mode++) {
        const int is_h = mode == 2;
        if (is_h && t->holes) break; /* its colours could not change places */
        fit_mode(t, is_h, mode == 1, (const int32_t(*)[3])means, &f);
        if (is_h) order_colors(&f);
        if (is_h && f.colors[0][0] == f.colors[1][0] && f.colors[0][1] == f.colors[1][1] &&
            f.colors[0][2] == f.colors[1][2] && !(f.distance & 1)) {
            continue; /* of equal colours the distance is odd */
        }
        const uint64_t block = is_h ? h_block(&f) : t_block(&f, t->holes != 0);
        const uint32_t bits = 24u + etc2_bits_of_selectors(block);
        if (etc2_is_better(t, f.error, bits, best)) {
            best->error = f.error;
            best->bits = bits;
            best->block = block;
        }
    }
}
