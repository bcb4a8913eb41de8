/* pack_walk.h: what the pack tests and the fuzzer share. Needs only libnoh.
 *
 *   pack_repair   make all checksums right again, so that the checks behind them are tested
 *   pack_find     the first chunk of a type
 *   pack_walk     use everything that an opened pack offers, as a game would */
#ifndef NOH_TESTS_SUPPORT_PACK_WALK_H
#define NOH_TESTS_SUPPORT_PACK_WALK_H

#include "noh/pack.h"

/* Recompute the checksum of every chunk that lies inside the bytes, then the table's checksum.
 * Does nothing where the table itself does not lie inside. */
void pack_repair(uint8_t *bytes, size_t count);

/* The first chunk with a tag (noh_chunk_tag) of a whole pack; NULL: there is none. */
noh_pack_chunk *pack_find(uint8_t *bytes, uint32_t tag);

/* Decode every vertex, index, rectangle, string, pixel and key; accumulate random weights in
 * every way; plan every GPU path. All work memory has the exact size that the library asks
 * for, so that AddressSanitizer sees one byte too much.
 * returns a hash of what was read; the same bytes and seed give the same hash */
uint32_t pack_walk(const noh_pack *pack, uint32_t seed);

#endif
