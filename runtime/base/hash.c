#include "base/hash.h"

#include "base/assert.h"

uint32_t noh_hash_name(const char *name)
{
    uint32_t hash = 2166136261u;
    NOH_ASSERT(name);
    for (const unsigned char *c = (const unsigned char *)name; *c; c++) {
        hash = (hash ^ *c) * 16777619u;
    }
    return hash;
}

/* A CRC is the remainder of the message, as a polynomial over two elements, by a generator. Shifting the remainder right by
 * a bit (reflected order) and subtracting the generator where a one falls out divides by x once; four such steps depend
 * only on the four bits that fall out, so a table of 16 remainders does them at once. The compiler makes the table out of
 * the four steps themselves. */
#define R1(c) (((c) >> 1) ^ (((c) & 1u) ? 0x82f63b78u : 0u))
#define R4(c) R1(R1(R1(R1((uint32_t)(c)))))
#define ROW(n) R4(n)

/* 64 bytes: small enough for any cache, and there is nothing to make at start-up. */
static const uint32_t crc_nibble[16] = {
    ROW(0), ROW(1), ROW(2), ROW(3), ROW(4), ROW(5), ROW(6), ROW(7),
    ROW(8), ROW(9), ROW(10), ROW(11), ROW(12), ROW(13), ROW(14), ROW(15)
};

uint32_t noh_crc32c(uint32_t crc, const void *bytes, size_t count)
{
    const uint8_t *p = (const uint8_t *)bytes;
    NOH_ASSERT(bytes || !count);
    crc = ~crc;
    for (size_t i = 0; i < count; i++) {
        crc ^= p[i];
        crc = (crc >> 4) ^ crc_nibble[crc & 15u];
        crc = (crc >> 4) ^ crc_nibble[crc & 15u];
    }
    return ~crc;
}
