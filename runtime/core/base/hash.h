/* hash.h: FNV-1a for finding names, and CRC-32C for detecting damaged bytes.
 *
 * Threads: no state; any thread. */
#ifndef NOH_BASE_HASH_H
#define NOH_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Hash a zero-terminated name (FNV-1a, 32 bits). Different names can have equal hashes, so searches compare the names
 * too.
 * source  Fowler, Noll, Vo: draft-eastlake-fnv */
uint32_t noh_hash_name(const char *name);

/* Compute the CRC-32C (Castagnoli, reflected 0x82f63b78) of bytes, continued from `crc`; start with 0. It detects every
 * single flipped bit and every error burst of up to 32 bits.
 * source  RFC 3720, appendix B.4 */
uint32_t noh_crc32c(uint32_t crc, const void *bytes, size_t count);

#ifdef __cplusplus
}
#endif

#endif
