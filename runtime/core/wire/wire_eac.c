/* wire_eac.c: a unit of EAC: base, multiplier, table, and for each texel the rank of its step. */
#include "core/wire/wire_blocks_internal.h"

#include <string.h>

#include "noh/format.h"
#include "noh/low_core.h"

/* Steps in rising order, as their selectors are. */
static const uint8_t rising[8] = { 3, 2, 1, 0, 4, 5, 6, 7 };

typedef struct channel {
    int32_t base, times, table;
    uint8_t ranks[16];
} channel;

static void parse(const uint8_t *b, channel *c)
{
    uint64_t bits = 0;
    for (int i = 0; i < 8; i++) bits = bits << 8 | b[i];
    c->base = b[0];
    c->times = b[1] >> 4;
    c->table = b[1] & 15;
    for (uint32_t i = 0; i < 16u; i++) {
        const uint32_t selector = (uint32_t)(bits >> (45u - 3u * (i % 4u * 4u + i / 4u))) & 7u;
        c->ranks[i] = (uint8_t)(selector < 4u ? 3u - selector : selector);
    }
}

static void assemble(const channel *c, uint8_t *b)
{
    uint64_t bits = (uint64_t)c->base << 56 | (uint64_t)c->times << 52 | (uint64_t)c->table << 48;
    for (uint32_t i = 0; i < 16u; i++) bits |= (uint64_t)rising[c->ranks[i]] << (45u - 3u * (i % 4u * 4u + i / 4u));
    for (int i = 0; i < 8; i++) b[i] = (uint8_t)(bits >> (56 - 8 * i));
}

/* What the texels of each rank are. */
static void values_of(const channel *c, int eleven, int32_t values[8])
{
    channel all = *c;
    uint8_t block[8];
    uint16_t decoded[16];
    for (uint32_t i = 0; i < 16u; i++) all.ranks[i] = (uint8_t)(i % 8u);
    assemble(&all, block);
    noh_eac_decode(block, eleven, decoded);
    for (uint32_t i = 0; i < 8u; i++) values[i] = 4 * decoded[i]; /* a light is the sum of four */
}

static uint32_t zone_of(const int32_t values[8], int32_t light)
{
    return noh_wire_zone(values, 8, light) / 2u;
}

static void code_ranks(noh_wire_filter *f, noh_wire_unit *u, channel *c)
{
    int32_t values[8];
    values_of(c, u->format == NOH_TEXTURE_EAC_RG, values);
    for (uint32_t i = 0; i < 16u; i++) {
        const uint32_t x = i % 4u, y = i / 4u, beside = zone_of(values, noh_wire_light_beside(u, x, y));
        const uint32_t guess = zone_of(values, noh_wire_light(u->guess[i].c));
        noh_wire_model *m = &f->models[NOH_BLOCKS_EAC_SELECTOR + (c->times > 2 ? 64u : 0u) + 8u * beside + guess];
        c->ranks[i] = (uint8_t)(noh_wire_symbol(&f->coder, m, c->ranks[i]) & 7u);
        u->light[1u + y][1u + x] = values[c->ranks[i]];
    }
}

void noh_wire_code_channel(noh_wire_filter *f, noh_wire_unit *u)
{
    enum { LEFT, ABOVE, OWN };
    uint32_t how = OWN, spread;
    int32_t guess = 0, off;
    channel c;
    if (u->above && memcmp(u->above, u->now, 8) == 0) how = ABOVE;
    if (u->left && memcmp(u->left, u->now, 8) == 0) how = LEFT;
    how = noh_wire_symbol(&f->coder, &f->models[NOH_BLOCKS_EAC_HOW + u->equal], how);
    if (how != OWN) {
        const uint8_t *from = how == LEFT ? u->left : u->above;
        if (!noh_wire_writes(f) && from) memcpy(u->now, from, 8);
        return;
    }
    parse(u->now, &c);
    noh_wire_look_beside(u);
    spread = noh_wire_spread(u, 0xffffu);
    for (uint32_t i = 0; i < 16u; i++) guess += u->guess[i].c[0];
    guess /= u->format == NOH_TEXTURE_EAC_RG ? 16 * 8 : 16;
    c.times = (int32_t)noh_wire_symbol(&f->coder, &f->models[NOH_BLOCKS_EAC_TIMES + spread], (uint32_t)c.times);
    c.table = (int32_t)noh_wire_symbol(&f->coder, &f->models[NOH_BLOCKS_EAC_TABLE + (uint32_t)c.times],
                                       (uint32_t)c.table);
    off = noh_wire_residual(f, NOH_BLOCKS_EAC_BASE, (uint32_t)c.times, c.base - guess);
    c.base = off > 255 || off < -255 ? 0 : noh_wire_held(guess + off, 255);
    code_ranks(f, u, &c);
    if (!noh_wire_writes(f)) assemble(&c, u->now);
}
