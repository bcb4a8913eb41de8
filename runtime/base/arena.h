/* arena.h: carving one block that the caller gave.
 *
 * An arena with base NULL only measures: the same code that carves also says
 * how many bytes it will need, so a size can never disagree with its use. */
#ifndef NOH_BASE_ARENA_H
#define NOH_BASE_ARENA_H

#include <stddef.h>
#include <stdint.h>

typedef struct noh_arena {
    uint8_t *base;
    size_t bytes; /* of the block */
    size_t used;  /* carved so far; may pass `bytes`, carving then gives NULL */
} noh_arena;

/* An arena over memory[bytes]; memory must be 16-byte aligned. */
noh_arena noh_arena_over(void *memory, size_t bytes);

/* An arena that only measures. */
noh_arena noh_arena_measure(void);

/* Carve bytes at the alignment (a power of two, at most 16). NULL when the
 * block is exhausted or the arena measures. */
void *noh_arena_carve(noh_arena *arena, size_t bytes, size_t alignment);

#endif
