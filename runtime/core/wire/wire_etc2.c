/* wire_etc2.c: a unit of colours: mode, colours, tables, and for each texel the rank of its colour by lightness.
 *
 * Bits that a mode leaves free are those that the converter chooses; a unit with others is sent as it is. */
#include "core/wire/wire_blocks_internal.h"

#include <string.h>

#include "noh/format.h"
#include "noh/low_core.h"

/* How a unit is coded. Of modes with holes one texel or more may be transparent. */
enum {
    HOW_LEFT,
    HOW_ABOVE,
    HOW_NEAR,                 /* halves, the second coded as a difference from the first; + 1: one above the other */
    HOW_APART = HOW_NEAR + 2, /* halves of four bits each; likewise */
    HOW_T = HOW_APART + 2,
    HOW_H,
    HOW_PLANAR,
    HOW_HOLES, /* as HOW_NEAR */
    HOW_T_HOLES = HOW_HOLES + 2,
    HOW_RAW
};

#define NO_HOLE 4u

typedef struct colors {
    uint32_t how;
    int32_t color[3][3];   /* of halves the first and the second, less the first where it is near; of planar three */
    int32_t table[2];      /* of T and H the first is the distance */
    uint8_t selectors[16]; /* [4 y + x] */
} colors;

static int32_t bits_of(uint64_t block, uint32_t at, uint32_t count)
{
    return (int32_t)(block >> at & ((1u << count) - 1u));
}

static uint64_t block_at(const uint8_t *b)
{
    uint64_t block = 0;
    for (int i = 0; i < 8; i++) block = block << 8 | b[i];
    return block;
}

/* ---- fields and bits ---- */

/* Whether the five bits of a channel and the difference behind them lead out of 0..31. */
static int leads_out(uint64_t block, uint32_t at)
{
    const int32_t low = bits_of(block, at, 3), sum = bits_of(block, at + 3u, 5) + (low < 4 ? low : low - 8);
    return sum < 0 || sum > 31;
}

static uint32_t how_of(uint64_t block, int with_alpha)
{
    const uint32_t solid = (uint32_t)(block >> 33) & 1u, flip = (uint32_t)(block >> 32) & 1u;
    if (!with_alpha && !solid) return HOW_APART + flip;
    if (leads_out(block, 56)) return solid ? HOW_T : HOW_T_HOLES;
    if (leads_out(block, 48)) return solid ? HOW_H : HOW_RAW;
    if (leads_out(block, 40)) return solid ? HOW_PLANAR : HOW_RAW;
    return (solid ? HOW_NEAR : HOW_HOLES) + flip;
}

static int is_near(uint32_t how)
{
    return how == HOW_NEAR || how == HOW_NEAR + 1 || how == HOW_HOLES || how == HOW_HOLES + 1;
}

static int is_apart(uint32_t how)
{
    return how == HOW_APART || how == HOW_APART + 1;
}

static int has_holes(uint32_t how)
{
    return how >= HOW_HOLES && how <= HOW_T_HOLES;
}

/* Halves one above the other. */
static int is_flat(uint32_t how)
{
    return how == HOW_NEAR + 1 || how == HOW_APART + 1 || how == HOW_HOLES + 1;
}

static void parse_paints(uint64_t b, colors *c)
{
    const int is_h = c->how == HOW_H;
    c->color[0][0] = is_h ? bits_of(b, 59, 4) : bits_of(b, 59, 2) << 2 | bits_of(b, 56, 2);
    c->color[0][1] = is_h ? bits_of(b, 56, 3) << 1 | bits_of(b, 52, 1) : bits_of(b, 52, 4);
    c->color[0][2] = is_h ? bits_of(b, 51, 1) << 3 | bits_of(b, 47, 3) : bits_of(b, 48, 4);
    for (uint32_t i = 0; i < 3u; i++) c->color[1][i] = bits_of(b, (is_h ? 43u : 44u) - 4u * i, 4);
    c->table[0] = is_h ? bits_of(b, 34, 1) << 1 | bits_of(b, 32, 1) : bits_of(b, 34, 2) << 1 | bits_of(b, 32, 1);
}

static void parse_planes(uint64_t b, colors *c)
{
    c->color[0][0] = bits_of(b, 57, 6);
    c->color[0][1] = bits_of(b, 56, 1) << 6 | bits_of(b, 49, 6);
    c->color[0][2] = bits_of(b, 48, 1) << 5 | bits_of(b, 43, 2) << 3 | bits_of(b, 39, 3);
    c->color[1][0] = bits_of(b, 34, 5) << 1 | bits_of(b, 32, 1);
    c->color[1][1] = bits_of(b, 25, 7);
    c->color[1][2] = bits_of(b, 19, 6);
    c->color[2][0] = bits_of(b, 13, 6);
    c->color[2][1] = bits_of(b, 6, 7);
    c->color[2][2] = bits_of(b, 0, 6);
}

static void parse(uint64_t b, int with_alpha, colors *c)
{
    memset(c, 0, sizeof *c);
    c->how = how_of(b, with_alpha);
    for (uint32_t i = 0; i < 16u; i++) {
        const uint32_t at = i % 4u * 4u + i / 4u;
        c->selectors[i] = (uint8_t)(b >> at & 1u) | (uint8_t)((b >> (at + 16u) & 1u) << 1);
    }
    if (c->how == HOW_PLANAR) {
        parse_planes(b, c);
    } else if (is_near(c->how) || is_apart(c->how)) {
        for (uint32_t i = 0; i < 3u; i++) {
            const uint32_t at = 56u - 8u * i;
            const int32_t low = bits_of(b, at, 3);
            c->color[0][i] = is_near(c->how) ? bits_of(b, at + 3u, 5) : bits_of(b, at + 4u, 4);
            c->color[1][i] = is_near(c->how) ? low < 4 ? low : low - 8 : bits_of(b, at, 4);
        }
        c->table[0] = bits_of(b, 37, 3);
        c->table[1] = bits_of(b, 34, 3);
    } else {
        parse_paints(b, c);
    }
}

/* The first of the free bits' values with which a channel leads out, or does not. */
static uint64_t filled(uint64_t block, uint32_t at, uint64_t mask, int out)
{
    uint64_t bits = 0;
    do {
        if (leads_out(block | bits << at, at) == out) return block | bits << at;
        bits = (bits - mask) & mask;
    } while (bits);
    return block;
}

static uint64_t filled_planar(uint64_t block)
{
    static const uint8_t at[6] = { 63, 55, 47, 46, 45, 42 };
    for (uint64_t i = 0; i < 64; i++) {
        uint64_t b = block;
        for (uint32_t k = 0; k < 6u; k++) b |= (i >> k & 1u) << at[k];
        if (!leads_out(b, 56) && !leads_out(b, 48) && leads_out(b, 40)) return b;
    }
    return block;
}

static uint64_t field(int32_t value, uint32_t shift, uint32_t count, uint32_t at)
{
    return (uint64_t)((uint32_t)value >> shift & ((1u << count) - 1u)) << at;
}

static uint64_t planes_of(const colors *c)
{
    const int32_t(*p)[3] = c->color;
    return filled_planar(field(p[0][0], 0, 6, 57) | field(p[0][1], 6, 1, 56) | field(p[0][1], 0, 6, 49) |
                         field(p[0][2], 5, 1, 48) | field(p[0][2], 3, 2, 43) | field(p[0][2], 0, 3, 39) |
                         field(p[1][0], 1, 5, 34) | (uint64_t)1 << 33 | field(p[1][0], 0, 1, 32) |
                         field(p[1][1], 0, 7, 25) | field(p[1][2], 0, 6, 19) | field(p[2][0], 0, 6, 13) |
                         field(p[2][1], 0, 7, 6) | field(p[2][2], 0, 6, 0));
}

static uint64_t paints_of(const colors *c)
{
    const int32_t *a = c->color[0], *b = c->color[1];
    uint64_t block = (uint64_t)(c->how != HOW_T_HOLES) << 33;
    if (c->how == HOW_H) {
        block |= field(a[0], 0, 4, 59) | field(a[1], 1, 3, 56) | field(a[1], 0, 1, 52) | field(a[2], 3, 1, 51) |
                 field(a[2], 0, 3, 47) | field(b[0], 0, 4, 43) | field(b[1], 0, 4, 39) | field(b[2], 0, 4, 35) |
                 field(c->table[0], 1, 1, 34) | field(c->table[0], 0, 1, 32);
        return filled(filled(block, 56, 0x80, 0), 48, 0xe4, 1);
    }
    block |= field(a[0], 2, 2, 59) | field(a[0], 0, 2, 56) | field(a[1], 0, 4, 52) | field(a[2], 0, 4, 48) |
             field(b[0], 0, 4, 44) | field(b[1], 0, 4, 40) | field(b[2], 0, 4, 36) | field(c->table[0], 1, 2, 34) |
             field(c->table[0], 0, 1, 32);
    return filled(block, 56, 0xe4, 1);
}

static uint64_t halves_of(const colors *c)
{
    uint64_t block = field(c->table[0], 0, 3, 37) | field(c->table[1], 0, 3, 34) | (uint64_t)is_flat(c->how) << 32 |
                     (uint64_t)(c->how == HOW_NEAR || c->how == HOW_NEAR + 1) << 33;
    for (uint32_t i = 0; i < 3u; i++) {
        const uint32_t at = 56u - 8u * i;
        block |= is_apart(c->how) ? field(c->color[0][i], 0, 4, at + 4u) | field(c->color[1][i], 0, 4, at)
                                  : field(c->color[0][i], 0, 5, at + 3u) | field(c->color[1][i], 0, 3, at);
    }
    return block;
}

static uint64_t assemble(const colors *c)
{
    uint64_t block;
    if (c->how == HOW_PLANAR) return planes_of(c);
    block = is_near(c->how) || is_apart(c->how) ? halves_of(c) : paints_of(c);
    for (uint32_t i = 0; i < 16u; i++) {
        const uint32_t at = i % 4u * 4u + i / 4u;
        block |= (uint64_t)(c->selectors[i] & 1u) << at | (uint64_t)(c->selectors[i] >> 1) << (at + 16u);
    }
    return block;
}

static void put_block(uint64_t block, uint8_t *b)
{
    for (int i = 0; i < 8; i++) b[i] = (uint8_t)(block >> (56 - 8 * i));
}

/* ---- colours ---- */

/* Texels of a half, as bits. */
static uint32_t half_of(uint32_t how, uint32_t second)
{
    if (is_flat(how)) return second ? 0xff00u : 0x00ffu;
    return second ? 0xccccu : 0x3333u;
}

/* The mean of the guess, in steps of 255 / most. */
static void mean_of(const noh_wire_unit *u, uint32_t texels, int32_t most, int32_t mean[3])
{
    int32_t sums[3] = { 0, 0, 0 }, count = 0;
    int any = 0;
    for (uint32_t i = 0; i < 16u; i++) any |= u->guess[i].share && texels >> i & 1u;
    for (uint32_t i = 0; i < 16u; i++) {
        const int32_t weight = texels >> i & 1u ? any ? u->guess[i].share : 1 : 0;
        for (uint32_t c = 0; c < 3u; c++) sums[c] += weight * u->guess[i].c[c];
        count += weight;
    }
    for (uint32_t c = 0; c < 3u; c++) mean[c] = (2 * sums[c] * most + 255 * count) / (2 * 255 * count);
}

static uint32_t class_of(int32_t residual)
{
    const uint32_t magnitude = noh_wire_magnitude(residual);
    return magnitude < 7u ? magnitude : 7u;
}

/* Green, then red and blue, which mostly are off by as much. */
static void code_color(noh_wire_filter *f, uint32_t models, uint32_t first, const int32_t guess[3], int32_t low,
                       int32_t high, int32_t color[3])
{
    static const uint8_t order[3] = { 1, 0, 2 };
    int32_t off = 0;
    for (uint32_t k = 0; k < 3u; k++) {
        const uint32_t c = order[k];
        int32_t by = guess[c] + off;
        by = by < low ? low : by > high ? high : by;
        const int32_t residual = noh_wire_value(&f->coder, &f->models[models + 8u * k + first],
                                                &f->models[NOH_WIRE_MODELS - 1u], color[c] - by);
        color[c] = residual > high - by ? high : residual < low - by ? low : by + residual;
        if (!k) off = residual > 64 ? 64 : residual < -64 ? -64 : residual;
        first = class_of(residual);
    }
}

static int32_t table_of(const uint8_t *b, int with_alpha)
{
    if (!b) return 3;
    const uint64_t block = block_at(b);
    const uint32_t how = how_of(block, with_alpha);
    return is_near(how) || is_apart(how) ? bits_of(block, 37, 3) : 3;
}

static void code_halves(noh_wire_filter *f, const noh_wire_unit *u, colors *c)
{
    const int with_alpha = u->format == NOH_TEXTURE_ETC2_RGBA1;
    const uint32_t beside = (uint32_t)(table_of(u->left, with_alpha) + table_of(u->above, with_alpha)) / 2u;
    int32_t most = is_near(c->how) ? 31 : 15, means[2][3];
    uint32_t spreads[2];
    for (uint32_t k = 0; k < 2u; k++) {
        mean_of(u, half_of(c->how, k), most, means[k]);
        spreads[k] = noh_wire_spread(u, half_of(c->how, k));
    }
    c->table[0] = (int32_t)(noh_wire_symbol(&f->coder, &f->models[NOH_BLOCKS_TABLE + 8u * spreads[0] + beside],
                                            (uint32_t)c->table[0]) &
                            7u);
    c->table[1] = (int32_t)(noh_wire_symbol(&f->coder,
                                            &f->models[NOH_BLOCKS_TABLE2 + 8u * spreads[1] + (uint32_t)c->table[0]],
                                            (uint32_t)c->table[1]) &
                            7u);
    if (most == 15) {
        code_color(f, NOH_BLOCKS_SMALL, (uint32_t)c->table[0], means[0], 0, 15, c->color[0]);
        code_color(f, NOH_BLOCKS_SMALL, (uint32_t)c->table[1], means[1], 0, 15, c->color[1]);
        return;
    }
    code_color(f, NOH_BLOCKS_BASE, (uint32_t)c->table[0], means[0], 0, 31, c->color[0]);
    for (uint32_t i = 0; i < 3u; i++) means[1][i] -= means[0][i];
    code_color(f, NOH_BLOCKS_SECOND, (uint32_t)c->table[1], means[1], -4, 3, c->color[1]);
}

static void code_paints(noh_wire_filter *f, const noh_wire_unit *u, colors *c)
{
    const uint32_t spread = noh_wire_spread(u, 0xffffu), most = c->how == HOW_H ? 3u : 7u;
    int32_t mean[3];
    mean_of(u, 0xffffu, 15, mean);
    c->table[0] =
        (int32_t)(noh_wire_symbol(&f->coder, &f->models[NOH_BLOCKS_DISTANCE + spread], (uint32_t)c->table[0]) & most);
    code_color(f, NOH_BLOCKS_SMALL, 7, mean, 0, 15, c->color[0]);
    code_color(f, NOH_BLOCKS_SMALL, 7, mean, 0, 15, c->color[1]);
}

/* The plane of least squares through the guess: at the corner, four texels to the right, four down. */
static void guess_planes(const noh_wire_unit *u, int32_t guess[3][3])
{
    for (uint32_t c = 0; c < 3u; c++) {
        const int32_t most = c == 1u ? 127 : 63;
        int32_t sum = 0, x = 0, y = 0, at[3];
        for (int32_t i = 0; i < 16; i++) {
            sum += u->guess[i].c[c];
            x += (2 * (i % 4) - 3) * u->guess[i].c[c];
            y += (2 * (i / 4) - 3) * u->guess[i].c[c];
        }
        if (!u->finer) { /* pairs of texels have one value: their slope is a fourth less than it should be */
            x += x / 4;
            y += y / 4;
        }
        at[0] = 5 * sum - 3 * x - 3 * y;
        at[1] = 5 * sum + 5 * x - 3 * y;
        at[2] = 5 * sum - 3 * x + 5 * y;
        for (uint32_t k = 0; k < 3u; k++) {
            const int32_t held = noh_wire_held(at[k], 255 * 80);
            guess[k][c] = (2 * held * most + 255 * 80) / (2 * 255 * 80);
        }
    }
}

static void code_planes(noh_wire_filter *f, const noh_wire_unit *u, colors *c)
{
    static const uint8_t order[3] = { 1, 0, 2 };
    const uint32_t spread = noh_wire_spread(u, 0xffffu);
    int32_t guess[3][3], off[3] = { 0, 0, 0 };
    guess_planes(u, guess);
    for (uint32_t k = 0; k < 3u; k++) {
        uint32_t class = spread;
        int32_t shared = 0;
        for (uint32_t n = 0; n < 3u; n++) {
            const uint32_t i = order[n];
            const int32_t most = i == 1u ? 127 : 63;
            const int32_t by = noh_wire_held(guess[k][i] + (k ? off[i] : shared), most);
            const int32_t residual = noh_wire_value(&f->coder, &f->models[NOH_BLOCKS_PLANE + 24u * k + 8u * n + class],
                                                    &f->models[NOH_WIRE_MODELS - 1u], c->color[k][i] - by);
            c->color[k][i] = residual > most || residual < -most ? 0 : noh_wire_held(by + residual, most);
            class = class_of(residual);
            if (!k) off[i] = c->color[k][i] - guess[k][i];
            if (!n) shared = off[1] / 2;
        }
    }
}

/* ---- selectors ---- */

/* What a texel is with each selector: lights in rising order, and whose they are. */
typedef struct paints {
    int32_t lights[4];
    uint8_t selectors[4];
    uint32_t count;
} paints;

/* Of every texel, by decoding the block with each selector in all of them. */
static void list_paints(const noh_wire_unit *u, const colors *c, paints of[16])
{
    memset(of, 0, 16u * sizeof *of);
    for (uint32_t s = 0; s < 4u; s++) {
        colors all = *c;
        uint8_t block[8], texels[16][4];
        if (has_holes(c->how) && s == 2u) continue;
        memset(all.selectors, (int)s, sizeof all.selectors);
        put_block(assemble(&all), block);
        noh_etc2_decode(u->format, block, 1, texels[0]);
        for (uint32_t i = 0; i < 16u; i++) {
            const int32_t rgb[3] = { texels[i][0], texels[i][1], texels[i][2] }, light = noh_wire_light(rgb);
            paints *p = &of[i];
            uint32_t k = p->count++;
            for (; k && p->lights[k - 1u] > light; k--) {
                p->lights[k] = p->lights[k - 1u];
                p->selectors[k] = p->selectors[k - 1u];
            }
            p->lights[k] = light;
            p->selectors[k] = (uint8_t)s;
        }
    }
}

static int code_hole(noh_wire_filter *f, const noh_wire_unit *u, uint32_t x, uint32_t y, int hole)
{
    const uint32_t beside = (uint32_t)(u->light[1u + y][x] < 0) + (uint32_t)(u->light[y][1u + x] < 0);
    const uint32_t share = (uint32_t)u->guess[4u * y + x].share;
    return noh_wire_symbol(&f->coder, &f->models[NOH_BLOCKS_HOLE + 5u * beside + share], hole != 0) == 1u;
}

static void code_selectors(noh_wire_filter *f, noh_wire_unit *u, colors *c)
{
    paints of[16];
    list_paints(u, c, of);
    for (uint32_t i = 0; i < 16u; i++) {
        const uint32_t x = i % 4u, y = i / 4u;
        const paints *p = &of[i];
        uint32_t rank = 0, kind = 2;
        if (has_holes(c->how) && code_hole(f, u, x, y, c->selectors[i] == 2u)) {
            c->selectors[i] = 2;
            u->light[1u + y][1u + x] = NOH_WIRE_UNKNOWN;
            continue;
        }
        while (rank + 1u < p->count && p->selectors[rank] != c->selectors[i]) rank++;
        if (is_near(c->how) || is_apart(c->how)) kind = c->table[is_flat(c->how) ? y / 2u : x / 2u] > 2;
        const uint32_t beside = noh_wire_zone(p->lights, p->count, noh_wire_light_beside(u, x, y));
        const uint32_t guess = noh_wire_zone(p->lights, p->count, noh_wire_light(u->guess[i].c));
        rank = noh_wire_symbol(&f->coder, &f->models[NOH_BLOCKS_SELECTOR + 64u * kind + 8u * beside + guess], rank);
        rank = rank < p->count ? rank : 0;
        c->selectors[i] = p->selectors[rank];
        u->light[1u + y][1u + x] = p->lights[rank];
    }
}

/* ---- units ---- */

static uint32_t kind_of(const uint8_t *b, int with_alpha)
{
    const uint32_t how = b ? how_of(block_at(b), with_alpha) : HOW_RAW;
    return is_near(how) ? has_holes(how) ? 3u : 0u : how == HOW_PLANAR ? 2u : how == HOW_RAW ? 3u : 1u;
}

static void code_raw(noh_wire_filter *f, uint8_t *b)
{
    for (uint32_t i = 0; i < 8u; i++) {
        const uint32_t byte = noh_wire_bits(&f->coder, b[i], 8u);
        if (!noh_wire_writes(f)) b[i] = (uint8_t)byte;
    }
}

static void code_own(noh_wire_filter *f, noh_wire_unit *u, colors *c)
{
    noh_wire_look_beside(u);
    if (c->how == HOW_PLANAR) {
        code_planes(f, u, c);
    } else if (is_near(c->how) || is_apart(c->how)) {
        code_halves(f, u, c);
        code_selectors(f, u, c);
    } else {
        code_paints(f, u, c);
        code_selectors(f, u, c);
    }
    if (!noh_wire_writes(f)) put_block(assemble(c), u->now);
}

void noh_wire_code_colors(noh_wire_filter *f, noh_wire_unit *u)
{
    const int with_alpha = u->format == NOH_TEXTURE_ETC2_RGBA1;
    const uint32_t model = NOH_BLOCKS_HOW + 16u * u->equal + 4u * kind_of(u->left, with_alpha) +
                           kind_of(u->above, with_alpha);
    uint32_t how = 0;
    colors c;
    if (noh_wire_writes(f)) {
        parse(block_at(u->now), with_alpha, &c);
        how = c.how != HOW_RAW && assemble(&c) == block_at(u->now) ? c.how : HOW_RAW;
        if (u->above && memcmp(u->above, u->now, 8) == 0) how = HOW_ABOVE;
        if (u->left && memcmp(u->left, u->now, 8) == 0) how = HOW_LEFT;
    } else {
        memset(&c, 0, sizeof c);
    }
    how = noh_wire_symbol(&f->coder, &f->models[model], how);
    c.how = how;
    if (how <= HOW_ABOVE) {
        const uint8_t *from = how == HOW_LEFT ? u->left : u->above;
        if (!noh_wire_writes(f) && from) memcpy(u->now, from, 8);
    } else if (how >= HOW_RAW) {
        code_raw(f, u->now);
    } else {
        code_own(f, u, &c);
    }
}
