#include "clip/clip_coefs_internal.h"

/* Most coefficients of a track are 0, 1 or -1, and the larger ones are at low frequencies; the neighbours just above in
 * frequency predict well how large one is. So the three components of one frequency are one symbol, from a table that
 * their neighbours choose, and where neighbours are large the low bits are kept out of the symbol (Rice coding with an
 * adaptive parameter); clip_coefs_internal.h has the rules. Any bits decode: quotients, shifts and escapes are cut to a
 * width at which nothing overflows. */

#define MAGNITUDE_MASK ((1u << NOH_CLIP_MAGNITUDE_BITS) - 1u)

/* Magnitudes of one component at the three frequencies above the one being read. */
typedef struct history {
    uint32_t near, middle, far;
} history;

static inline uint32_t history_sum(const history *h)
{
    return h->near + h->middle + h->far;
}

static inline void history_push(history *h, uint32_t magnitude)
{
    h->far = h->middle;
    h->middle = h->near;
    h->near = magnitude;
}

static inline int32_t with_sign(uint32_t magnitude, uint32_t negative)
{
    return ((int32_t)magnitude ^ -(int32_t)negative) + (int32_t)negative;
}

/* An Exp-Golomb number of order 0: n zeros, a one, n bits. A prefix longer than any encoder writes is cut. */
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

/* The low bits and the sign of a magnitude; `quotient` is what is above the low bits. */
static inline int32_t read_rest(noh_bits *b, uint32_t quotient, uint32_t shift, history *h)
{
    uint32_t magnitude = ((quotient << shift) | noh_bits_take(b, shift)) & MAGNITUDE_MASK;
    const uint32_t some = magnitude != 0u;
    const uint32_t negative = noh_bits_take(b, some);
    history_push(h, magnitude);
    return with_sign(magnitude, negative);
}

/* The slow way: long shifts or escapes, with refills between. */
static void read_long(noh_bits *b, uint32_t symbol, const uint32_t shifts[3], history h[3], int32_t out[4])
{
    for (uint32_t c = 0; c < 3u; c++) {
        uint32_t quotient = (symbol >> (2u * c)) & 3u;
        if (quotient == NOH_CLIP_QUOTIENT_MAX) {
            quotient += read_escape(b);
        }
        noh_bits_refill(b);
        out[c] = read_rest(b, quotient, shifts[c], &h[c]);
    }
}

static inline uint32_t busy_of(const history h[3])
{
    return (uint32_t)(history_sum(&h[0]) >= NOH_CLIP_BUSY) | (uint32_t)(history_sum(&h[1]) >= NOH_CLIP_BUSY) << 1 |
           (uint32_t)(history_sum(&h[2]) >= NOH_CLIP_BUSY) << 2;
}

static inline void read_triple(noh_bits *b, const uint16_t *table, history h[3], int32_t out[4])
{
    const uint32_t s0 = noh_clip_shift(history_sum(&h[0])), s1 = noh_clip_shift(history_sum(&h[1])),
                   s2 = noh_clip_shift(history_sum(&h[2]));
    uint32_t symbol;
    noh_bits_refill(b);
    symbol = noh_clip_symbol(b, table, NOH_CLIP_TRIPLE_BITS);
    /* 47 bits are left for three low parts and three signs; a pair of ones is a quotient of 3 */
    if (((symbol & (symbol >> 1) & 0x15u) != 0u) | (s0 + s1 + s2 > 40u)) {
        const uint32_t shifts[3] = { s0, s1, s2 };
        read_long(b, symbol, shifts, h, out);
        return;
    }
    out[0] = read_rest(b, symbol & 3u, s0, &h[0]);
    out[1] = read_rest(b, (symbol >> 2) & 3u, s1, &h[1]);
    out[2] = read_rest(b, symbol >> 4, s2, &h[2]);
}

/* Frequency 0: the bit length as a symbol, the bits below the highest, the sign. */
static void read_mean(noh_bits *b, uint32_t last, const history h[3], int32_t out[4])
{
    for (uint32_t c = 0; c < 3u; c++) {
        uint32_t category, magnitude = 0, negative = 0;
        noh_bits_refill(b);
        category = noh_clip_symbol(b, noh_clip_dc_table[noh_clip_dc_context(history_sum(&h[c]), last)],
                                   NOH_CLIP_DC_BITS);
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
    history h[3] = { { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 } };
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
            h[0].near = h[1].near = h[2].near = NOH_CLIP_LOW_NEIGHBOUR;
            table = noh_clip_triple_table[busy_of(h)];
        }
        for (uint32_t k = last; k > means; k--) {
            read_triple(&b, table, h, out[k - 1u]);
            table = noh_clip_triple_table[busy_of(h)];
        }
        if (means) {
            read_mean(&b, last, h, out[0]);
        }
    }
    *bits = b;
    return last;
}
