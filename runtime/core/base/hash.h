/* hash.h: FNV-1a, by which names are found, and CRC-32C, which tells damaged bytes.
 *
 * Threads: no state; any thread. */
#ifndef NOH_BASE_HASH_H
#define NOH_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* FNV-1a, 32 bits, of a zero-terminated name. Equal names have equal hashes; different names nearly always have
 * different ones, but not always: a search compares the names too.
 * source  Fowler, Noll, Vo: draft-eastlake-fnv */
uint32_t noh_hash_name(const char *name);

/* CRC-32C (Castagnoli, reflected 0x82f63b78) of bytes, continued from `crc`; start with 0. It detects every single
 * flipped bit and every burst of errors of up to 32 bits.
 * source  RFC 3720, appendix B.4 */
uint32_t noh_crc32c(uint32_t crc, const void *bytes, size_t count);

#ifdef __cplusplus
}
#endif

#endif
