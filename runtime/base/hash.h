/* hash.h: names are found by FNV-1a, bytes are proven by CRC-32C. */
#ifndef NOH_BASE_HASH_H
#define NOH_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

/* FNV-1a, 32 bits, of a zero-terminated name. */
uint32_t noh_hash_name(const char *name);

/* CRC-32C (Castagnoli, reflected 0x82f63b78), continued from `crc`; start with 0. */
uint32_t noh_crc32c(uint32_t crc, const void *bytes, size_t count);

#endif
