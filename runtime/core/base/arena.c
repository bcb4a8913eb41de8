/* arena.c: one block cut into pieces. Each object of the library is laid out by one function over an arena, which runs
 * twice: over an arena without memory it adds up the bytes, over the real block it hands out the pieces. So a size and
 * the layout that it is the size of cannot disagree. A sum that would overflow stays at SIZE_MAX, which no block has.
 */
#include "core/base/arena_internal.h"
#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/low_core.h"

static uintptr_t misalignment(const void *memory)
{
    return (uintptr_t)memory & (NOH_MEMORY_ALIGN - 1u);
}

noh_result noh_arena_check(const void *memory, size_t need, noh_error *error)
{
    if (!memory) {
        return noh_fail(error, NOH_ERR_ARG, "memory is NULL", 0, need);
    }
    if (misalignment(memory)) {
        return noh_fail(error, NOH_ERR_ARG, "memory is not aligned to NOH_MEMORY_ALIGN bytes", misalignment(memory),
                        need);
    }
    return NOH_OK;
}

noh_result noh_arena_open(noh_arena *arena, void *memory, size_t bytes, size_t need, noh_error *error)
{
    const noh_result result = noh_arena_check(memory, need, error);
    NOH_ASSERT(arena);
    if (result) {
        return result;
    }
    if (bytes < need) {
        return noh_fail(error, NOH_ERR_MEMORY, "memory is too small", bytes, need);
    }
    *arena = noh_arena_over(memory, bytes);
    return NOH_OK;
}

noh_arena noh_arena_over(void *memory, size_t bytes)
{
    NOH_ASSERT(!misalignment(memory));
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
    const size_t start = (arena->used + alignment - 1) & ~(alignment - 1);
    NOH_ASSERT(alignment && alignment <= 16u && (alignment & (alignment - 1u)) == 0);
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
