#include "base/arena.h"

noh_arena noh_arena_over(void *memory, size_t bytes)
{
    noh_arena arena = { (uint8_t *)memory, memory ? bytes : 0, 0 };
    return arena;
}

noh_arena noh_arena_measure(void)
{
    noh_arena arena = { NULL, 0, 0 };
    return arena;
}

void *noh_arena_carve(noh_arena *arena, size_t bytes, size_t alignment)
{
    size_t start = (arena->used + alignment - 1) & ~(alignment - 1);
    if (start < arena->used || bytes > SIZE_MAX - start) {
        arena->used = SIZE_MAX;
        return NULL;
    }
    arena->used = start + bytes;
    if (!arena->base || arena->used > arena->bytes) {
        return NULL;
    }
    return arena->base + start;
}
