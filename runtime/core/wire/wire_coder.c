/* wire_coder.c: adaptive symbols, coded by asymmetric numeral systems.
 *
 * A model moves all its ranges a share of the way to where only the last symbol would be likely, quickly at first and
 * then slowly.
 * source  Duda: Asymmetric numeral systems, 2013; Giesen: Interleaved entropy coders, 2014 */
#include "core/wire/wire_internal.h"

#include "core/base/compiler_internal.h"

#define SCALE (1u << NOH_WIRE_SCALE_BITS)
#define RATE_FIRST 4u
#define RATE_LAST 7u
#define COUNT_LAST 64u

void noh_wire_model_reset(noh_wire_model *models, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t s = 0; s < NOH_WIRE_SYMBOLS; s++) {
            models[i].start[s] = (uint16_t)(s * (SCALE / NOH_WIRE_SYMBOLS));
        }
        models[i].count = 0;
    }
}

/* Ranges keep 1 at least: where they go to they are 1 apart, and so is any mean of two such rows rounded down. */
static void adapt(noh_wire_model *m, uint32_t symbol)
{
    const uint32_t rate = RATE_FIRST + (m->count > 7u) + (m->count > 23u) + (m->count >= COUNT_LAST);
    m->count = (uint16_t)(m->count + (m->count < COUNT_LAST));
    for (uint32_t i = 0; i < NOH_WIRE_SYMBOLS; i++) {
        const int32_t to = (int32_t)(i <= symbol ? i : SCALE - NOH_WIRE_SYMBOLS + i), from = m->start[i];
        m->start[i] = (uint16_t)(from + ((to - from) >> rate));
    }
}

void noh_wire_coder_begin(noh_wire_coder *c, const uint8_t *bytes, uint32_t count, uint32_t items)
{
    c->bytes = bytes;
    c->end = count;
    c->at = 0;
    c->state = NOH_WIRE_LOW;
    c->items = items;
    c->bad = count < 4u;
    if (!c->bad) {
        c->state = (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
        c->at = 4;
        c->bad = c->state < NOH_WIRE_LOW;
    }
}

int noh_wire_coder_ended(const noh_wire_coder *c)
{
    return !c->bad && c->at == c->end && c->state == NOH_WIRE_LOW && !c->items;
}

static inline void renew(noh_wire_coder *c)
{
    if (c->state < NOH_WIRE_LOW) {
        if (c->at + 2u > c->end) {
            c->bad = 1;
            c->state |= NOH_WIRE_LOW;
            return;
        }
        c->state = c->state << 16 | (uint32_t)c->bytes[c->at] | (uint32_t)c->bytes[c->at + 1u] << 8;
        c->at += 2u;
    }
}

static uint32_t read_symbol(noh_wire_coder *c, const noh_wire_model *m)
{
    const uint32_t slot = c->state & (SCALE - 1u);
    uint32_t symbol = 0, next;
    for (uint32_t i = 1; i < NOH_WIRE_SYMBOLS; i++) symbol += m->start[i] <= slot;
    next = symbol + 1u < NOH_WIRE_SYMBOLS ? m->start[symbol + 1u] : SCALE;
    c->state = (next - m->start[symbol]) * (c->state >> NOH_WIRE_SCALE_BITS) + slot - m->start[symbol];
    renew(c);
    return symbol;
}

uint32_t noh_wire_symbol(noh_wire_coder *c, noh_wire_model *m, uint32_t symbol)
{
    if (!c->record) {
        symbol = read_symbol(c, m);
    } else {
        const uint32_t next = symbol + 1u < NOH_WIRE_SYMBOLS ? m->start[symbol + 1u] : SCALE;
        c->record(c->user, m->start[symbol], next - m->start[symbol]);
    }
    adapt(m, symbol);
    return symbol;
}

/* At most 15 bits: a symbol out of 2^bits, all as likely. */
static uint32_t few_bits(noh_wire_coder *c, uint32_t value, uint32_t bits)
{
    if (c->record) {
        c->record(c->user, value << (NOH_WIRE_SCALE_BITS - bits), 1u << (NOH_WIRE_SCALE_BITS - bits));
        return value;
    }
    {
        const uint32_t shift = NOH_WIRE_SCALE_BITS - bits, slot = c->state & (SCALE - 1u);
        value = slot >> shift;
        c->state = ((c->state >> NOH_WIRE_SCALE_BITS) << shift) + (slot & ((1u << shift) - 1u));
        renew(c);
    }
    return value;
}

uint32_t noh_wire_bits(noh_wire_coder *c, uint32_t value, uint32_t bits)
{
    uint32_t result = 0;
    for (uint32_t done = 0; done < bits;) {
        const uint32_t now = bits - done < 12u ? bits - done : 12u;
        result |= few_bits(c, value >> done & ((1u << now) - 1u), now) << done;
        done += now;
    }
    return result;
}

/* Zigzag: 0, -1, 1, -2 ... become 0, 1, 2, 3 ... Up to 7 a symbol each; then classes that double twice, with the rest
 * of their bits as they are; from 256 on the count of bits is a symbol of its own. */
static const uint8_t class_bits[16] = { 0, 0, 0, 0, 0, 0, 0, 0, 2, 2, 3, 3, 5, 6, 7, 0 };
static const uint8_t class_first[16] = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 24, 32, 64, 128, 0 };

static uint32_t class_of(uint32_t zigzag)
{
    uint32_t k = 0;
    if (zigzag < 8u) return zigzag;
    if (zigzag > 255u) return 15u;
    for (k = 8; k < 14u && zigzag >= class_first[k + 1u];) k++;
    return k;
}

static uint32_t large_value(noh_wire_coder *c, noh_wire_model *large, uint32_t zigzag)
{
    uint32_t bits = zigzag > 255u ? 31u - noh_leading_zeros(zigzag) : 8u, symbol;
    symbol = noh_wire_symbol(c, large, bits - 8u < 15u ? bits - 8u : 15u);
    if (symbol == 15u) return noh_wire_bits(c, zigzag, 32u);
    bits = symbol + 8u;
    return 1u << bits | noh_wire_bits(c, zigzag & ((1u << bits) - 1u), bits);
}

int32_t noh_wire_value(noh_wire_coder *c, noh_wire_model *model, noh_wire_model *large, int32_t value)
{
    uint32_t zigzag = (uint32_t)value << 1 ^ (value < 0 ? 0xffffffffu : 0u);
    const uint32_t k = noh_wire_symbol(c, model, class_of(zigzag));
    if (k == 15u) {
        zigzag = large_value(c, large, zigzag);
    } else {
        zigzag = class_first[k] + noh_wire_bits(c, zigzag - class_first[k], class_bits[k]);
    }
    return (int32_t)(zigzag >> 1 ^ (0u - (zigzag & 1u)));
}
