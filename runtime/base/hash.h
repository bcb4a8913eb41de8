/* hash.h: names are found by FNV-1a, bytes are proven by CRC-32C.
 * Threads: no state; any thread. */
#ifndef NOH_BASE_HASH_H
#define NOH_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* FNV-1a, 32 bits, of a zero-terminated name. Names that are equal have equal hashes; those that are not, nearly never:
 * a search compares the names too.
 * source  Fowler, Noll, Vo: draft-eastlake-fnv */
uint32_t noh_hash_name(const char *name);

/* CRC-32C (Castagnoli, reflected 0x82f63b78) of bytes, continued from `crc`; start with 0. It finds every error of up
 * to 32 bits in a row, and every flipped bit. source  RFC 3720, appendix B.4 */
uint32_t noh_crc32c(uint32_t crc, const void *bytes, size_t count);

#ifdef __cplusplus
}
#endif

#endif
