/* arena.h: carving one block of memory that the caller brought.
 *
 * An arena without a block only measures: the code that carves an object also says how many bytes it needs, so the two
 * cannot disagree.
 *
 *   noh_arena_open      the block that an init was given, checked
 *   noh_arena_check     whether any block can lie there
 *   noh_arena_over      a block that is known to be good
 *   noh_arena_measure   no block: count only
 *   noh_arena_carve     the next bytes
 *
 * Threads: an arena is for one thread at a time. */
#ifndef NOH_BASE_ARENA_H
#define NOH_BASE_ARENA_H

#include <stddef.h>
#include <stdint.h>

#include "core/base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Of every block that an init takes, and of every pack: what malloc gives. Within a block all is placed to 16 bytes; 8
 * do for a block where pointers have 32 bits, since vectors are loaded unaligned there (SSE2 asks for 16). */
#if UINTPTR_MAX == 0xffffffffu && !defined(__i386__) && !defined(_M_IX86)
#define NOH_MEMORY_ALIGN 8u
#else
#define NOH_MEMORY_ALIGN 16u
#endif

typedef struct noh_arena {
    uint8_t *base;
    size_t bytes; /* of the block */
    size_t used;  /* carved so far; may pass `bytes`, carving then gives NULL */
} noh_arena;

/* Open the block that an init was given. Every init begins with this call, so all of them refuse the same memory.
 * ranges  need: the exact bytes that will be carved
 * errors  ARG memory is NULL or not aligned to NOH_MEMORY_ALIGN; MEMORY it is too small (where: its bytes). `need` is
 *         always the bytes needed, and the arena is left untouched */
noh_result noh_arena_open(noh_arena *arena, void *memory, size_t bytes, size_t need, noh_error *error);

/* Check an address for a block whose bytes are looked at afterwards, such as one from a saved game.
 * errors  ARG memory is NULL or not aligned to NOH_MEMORY_ALIGN (where: by how many bytes); need: as given */
noh_result noh_arena_check(const void *memory, size_t need, noh_error *error);

/* An arena over memory[bytes], which must be aligned to NOH_MEMORY_ALIGN. */
noh_arena noh_arena_over(void *memory, size_t bytes);

/* An arena that only measures. */
noh_arena noh_arena_measure(void);

/* Carve bytes at an alignment.
 * ranges   alignment is a power of two, at most 16
 * returns  NULL when the block is exhausted or the arena only measures; `used` counts the bytes all the same, and is
 *          SIZE_MAX once the sum no longer fits a size_t */
void *noh_arena_carve(noh_arena *arena, size_t bytes, size_t alignment);

#ifdef __cplusplus
}
#endif

#endif
