/* arena.h: allocation within one block of the caller's memory.
 *
 * An arena without a block only measures, so the same code carves an object and computes its size.
 *
 *   noh_arena_open      the block of an init, checked
 *   noh_arena_check     checks an address for a block
 *   noh_arena_over      a block known to be valid
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

/* Alignment of every init's block and of every pack; malloc provides it. Objects within a block are aligned to 16
 * bytes; with 32-bit pointers 8 are enough for the block, because vectors are loaded unaligned there (SSE2 needs
 * 16). */
#if UINTPTR_MAX == 0xffffffffu && !defined(__i386__) && !defined(_M_IX86)
#define NOH_MEMORY_ALIGN 8u
#else
#define NOH_MEMORY_ALIGN 16u
#endif

typedef struct noh_arena {
    uint8_t *base;
    size_t bytes; /* of the block */
    size_t used;  /* carved so far; may exceed `bytes`, carving then returns NULL */
} noh_arena;

/* Open the block of an init. Every init begins with this call, so all refuse the same memory.
 * ranges  need: the exact bytes that will be carved
 * errors  ARG memory is NULL or not aligned to NOH_MEMORY_ALIGN; MEMORY it is too small (where: its bytes). `need` is
 *         then the bytes needed, and the arena is untouched */
noh_result noh_arena_open(noh_arena *arena, void *memory, size_t bytes, size_t need, noh_error *error);

/* Check the address of a block whose bytes are checked later, such as one from a saved game.
 * errors  ARG memory is NULL or not aligned to NOH_MEMORY_ALIGN (where: the misalignment in bytes); need: as given */
noh_result noh_arena_check(const void *memory, size_t need, noh_error *error);

/* An arena over memory[bytes], which must be aligned to NOH_MEMORY_ALIGN. */
noh_arena noh_arena_over(void *memory, size_t bytes);

/* An arena that only measures. */
noh_arena noh_arena_measure(void);

/* Carve bytes at an alignment.
 * ranges   alignment is a power of two, at most 16
 * returns  NULL if the block is exhausted or the arena only measures; `used` still counts the bytes, and is SIZE_MAX
 *          once the sum does not fit a size_t */
void *noh_arena_carve(noh_arena *arena, size_t bytes, size_t alignment);

#ifdef __cplusplus
}
#endif

#endif
