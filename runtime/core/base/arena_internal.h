/* arena_internal.h: the private part of low_core.h. */
#ifndef NOH_BASE_ARENA_INTERNAL_H
#define NOH_BASE_ARENA_INTERNAL_H

#include <stddef.h>
#include <stdint.h>

#include "noh/base.h"
#include "noh/low_core.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Check the address of a block whose bytes are checked later, such as one from a saved game.
 * errors  ARG memory is NULL or not aligned to NOH_MEMORY_ALIGN (where: the misalignment in bytes); need: as given */
noh_result noh_arena_check(const void *memory, size_t need, noh_error *error);

/* Up to where the next object of a block begins. */
static inline size_t noh_aligned(size_t bytes)
{
    return (bytes + 15u) & ~(size_t)15u;
}

#ifdef __cplusplus
}
#endif

#endif
