/* clip_bits_internal.h (private to clip/ and the encoder): reading bits, lowest first.
 *
 * Past the end a reader returns zeros and keeps counting, so that it never reads outside its bytes and noh_bits_overrun
 * can report it afterwards. */
#ifndef NOH_CLIP_CLIP_BITS_INTERNAL_H
#define NOH_CLIP_CLIP_BITS_INTERNAL_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

typedef struct noh_bits {
    uint64_t word; /* the next bits, lowest first; above `count` the stream's own, or zeros */
    uint32_t count;
    size_t at, end; /* next byte to load, and the end of the bytes */
    const uint8_t *bytes;
} noh_bits;

#define NOH_BITS_READY 56u /* bits that a refill guarantees */

static inline noh_bits noh_bits_over(const uint8_t *bytes, size_t begin, size_t end)
{
    noh_bits b;
    b.word = 0;
    b.count = 0;
    b.at = begin;
    b.end = end;
    b.bytes = bytes;
    return b;
}

static inline uint64_t noh_bits_load8(const uint8_t *p)
{
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    uint64_t v;
    memcpy(&v, p, sizeof v);
    return v;
#else
    uint64_t v = 0;
    for (uint32_t i = 0; i < 8u; i++) {
        v |= (uint64_t)p[i] << (8u * i);
    }
    return v;
#endif
}

/* Make at least NOH_BITS_READY bits ready. With 8 bytes left this is one load: the word is filled to 56 bits or more by
 * whole bytes, and the loaded bits above `count` are the stream's next bits, which the next load repeats. */
static inline void noh_bits_refill(noh_bits *b)
{
    if (b->end - b->at >= 8u && b->at <= b->end) {
        const uint32_t bytes = (63u - b->count) >> 3;
        b->word |= noh_bits_load8(b->bytes + b->at) << b->count;
        b->at += bytes;
        b->count += bytes * 8u;
    } else {
        while (b->count <= NOH_BITS_READY - 1u) {
            if (b->at < b->end) {
                b->word |= (uint64_t)b->bytes[b->at] << b->count;
            }
            b->at++;
            b->count += 8u;
        }
    }
}

/* Take the next `width` bits, 0..32, after a refill. */
static inline uint32_t noh_bits_take(noh_bits *b, uint32_t width)
{
    const uint32_t v = (uint32_t)(b->word & (((uint64_t)1 << width) - 1u));
    b->word >>= width;
    b->count -= width;
    return v;
}

/* Refill and take, 0..32 bits. */
static inline uint32_t noh_bits_get(noh_bits *b, uint32_t width)
{
    noh_bits_refill(b);
    return noh_bits_take(b, width);
}

/* Read a varint (low_motion.h). */
static inline uint32_t noh_bits_varint(noh_bits *b)
{
    uint32_t v = 0;
    for (uint32_t shift = 0; shift < 32u; shift += 4u) {
        v |= noh_bits_get(b, 4u) << shift;
        if (noh_bits_get(b, 1u) == 0u) {
            break;
        }
    }
    return v;
}

/* Get the number of bits read, from the block's first byte. */
static inline size_t noh_bits_position(const noh_bits *b)
{
    return b->at * 8u - b->count;
}

static inline int noh_bits_overrun(const noh_bits *b)
{
    return noh_bits_position(b) > b->end * 8u;
}

/* Go back to a position from noh_bits_position. */
static inline void noh_bits_seek(noh_bits *b, size_t position)
{
    b->word = 0;
    b->count = 0;
    b->at = position / 8u;
    noh_bits_refill(b);
    (void)noh_bits_take(b, (uint32_t)(position % 8u));
}

#endif
