#include "motion/clip/clip_coefs_internal.h"
#include "core/base/compiler_internal.h"
#include "noh/low_motion.h"

/* Most coefficients of a track are 0, 1 or -1, and the larger ones are at low frequencies; the neighbours just above in
 * frequency predict the magnitude well. So the three components of one frequency are one symbol, from a table selected
 * by their neighbours, and where neighbours are large the low bits are stored outside the symbol (Rice coding with an
 * adaptive parameter); clip_coefs_internal.h has the rules. Any bits decode: quotients, shifts and escapes are limited
 * to a width at which nothing overflows. */

#define LOW_BITS_READY 44u /* after a refill, a symbol of 9 bits and before 3 signs */
#define MAGNITUDE_MASK ((1u << NOH_CLIP_MAGNITUDE_BITS) - 1u)

/* Statistics of the three frequencies above the current one: per component the sum of their magnitudes, the two
 * nearest, and the number of separate low bits. */
typedef struct history {
    uint32_t sum[3], near[3], middle[3], shift[3];
} history;

static inline void history_push(history *h, uint32_t c, uint32_t magnitude)
{
    h->sum[c] = magnitude + h->near[c] + h->middle[c];
    h->shift[c] = noh_clip_shift(h->sum[c]);
    h->middle[c] = h->near[c];
    h->near[c] = magnitude;
}

static inline int32_t with_sign(uint32_t magnitude, uint32_t negative)
{
    return ((int32_t)magnitude ^ -(int32_t)negative) + (int32_t)negative;
}

/* An Exp-Golomb number of order 0: n zeros, a one, n bits. A prefix longer than any encoder writes is cut off. */
static uint32_t read_escape(noh_bits *b)
{
    uint32_t zeros;
    noh_bits_refill(b);
    zeros = b->word ? noh_trailing_zeros(b->word) : NOH_CLIP_MAGNITUDE_BITS;
    if (zeros > NOH_CLIP_MAGNITUDE_BITS) {
        zeros = NOH_CLIP_MAGNITUDE_BITS;
    }
    (void)noh_bits_take(b, zeros + 1u);
    return ((1u << zeros) | noh_bits_take(b, zeros)) - 1u;
}

static inline uint32_t with_escape(noh_bits *b, uint32_t quotient)
{
    return quotient == NOH_CLIP_QUOTIENT_MAX ? quotient + read_escape(b) : quotient;
}

static inline uint32_t read_low(noh_bits *b, uint32_t quotient, uint32_t shift)
{
    return ((quotient << shift) | noh_bits_take(b, shift)) & MAGNITUDE_MASK;
}

/* The table of a triple, by which of its components are busy: those with a sum of NOH_CLIP_BUSY or more, which is where
 * the shift is not 0. */
static inline const uint16_t *table_of(const history *h)
{
    return noh_clip_triple_table[(uint32_t)(h->shift[0] != 0u) | (uint32_t)(h->shift[1] != 0u) << 1 |
                                 (uint32_t)(h->shift[2] != 0u) << 2];
}

/* Rare cases use a copy of the reader, so that the reader itself can stay in registers. */
static inline void read_triple(noh_bits *b, const uint16_t *table, history *h, int32_t out[4])
{
    const uint32_t wide = h->shift[0] + h->shift[1] + h->shift[2] > LOW_BITS_READY;
    uint32_t symbol, signs, q0, q1, q2, m0, m1, m2, some0, some1, some2;
    noh_bits_refill(b);
    symbol = noh_clip_symbol(b, table, NOH_CLIP_TRIPLE_BITS);
    q0 = symbol & 3u;
    q1 = symbol >> 2 & 3u;
    q2 = symbol >> 4;
    if ((symbol & (symbol >> 1) & 0x15u) != 0u) { /* a pair of ones is a quotient of 3 */
        noh_bits copy = *b;
        q0 = with_escape(&copy, q0);
        q1 = with_escape(&copy, q1);
        q2 = with_escape(&copy, q2);
        *b = copy;
        noh_bits_refill(b);
    }
    m0 = read_low(b, q0, h->shift[0]);
    if (wide) {
        noh_bits_refill(b);
    }
    m1 = read_low(b, q1, h->shift[1]);
    if (wide) {
        noh_bits_refill(b);
    }
    m2 = read_low(b, q2, h->shift[2]);
    if (wide) {
        noh_bits_refill(b);
    }
    history_push(h, 0, m0);
    history_push(h, 1, m1);
    history_push(h, 2, m2);
    some0 = m0 != 0u;
    some1 = m1 != 0u;
    some2 = m2 != 0u;
    signs = noh_bits_take(b, some0 + some1 + some2);
    out[0] = with_sign(m0, signs & some0);
    out[1] = with_sign(m1, signs >> some0 & some1);
    out[2] = with_sign(m2, signs >> (some0 + some1) & some2);
}

/* Frequency 0: the bit length as a symbol, the bits below the highest, the sign. */
static void read_mean(noh_bits *b, uint32_t last, const history *h, int32_t out[4])
{
    for (uint32_t c = 0; c < 3u; c++) {
        uint32_t category, magnitude = 0, negative = 0;
        noh_bits_refill(b);
        category = noh_clip_symbol(b, noh_clip_dc_table[noh_clip_dc_context(h->sum[c], last)], NOH_CLIP_DC_BITS);
        if (category) {
            magnitude = 1u << (category - 1u) | noh_bits_take(b, category - 1u);
            negative = noh_bits_take(b, 1u);
        }
        out[c] = with_sign(magnitude, negative);
    }
}

uint32_t noh_clip_read_coefs(noh_bits *bits, uint32_t first, uint32_t count, uint32_t context, int32_t out[][4])
{
    noh_bits b = *bits; /* a copy that `out` cannot alias */
    history h = { { 0 }, { 0 }, { 0 }, { 0 } };
    const uint32_t means = first == 0u;
    uint32_t last;
    noh_bits_refill(&b);
    last = noh_clip_symbol(&b, noh_clip_last_table[context], NOH_CLIP_LAST_BITS);
    if (last > count) {
        last = count;
    }
    if (last > 0u) {
        const uint16_t *table = noh_clip_triple_table[NOH_CLIP_TRIPLE_FIRST];
        if (context == NOH_CLIP_LAST_LOW && last == count) {
            for (uint32_t c = 0; c < 3u; c++) {
                history_push(&h, c, NOH_CLIP_LOW_NEIGHBOUR);
            }
            table = table_of(&h);
        }
        for (uint32_t k = last; k > means; k--) {
            read_triple(&b, table, &h, out[k - 1u]);
            table = table_of(&h);
        }
        if (means) {
            read_mean(&b, last, &h, out[0]);
        }
    }
    *bits = b;
    return last;
}
