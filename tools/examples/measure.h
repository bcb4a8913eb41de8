/* measure.h: the time, and the number of allocations by the program and the libraries linked into it (noh, not the
 * driver). Link with -Wl,--wrap=malloc,--wrap=calloc,--wrap=realloc. */
#ifndef NOH_EXAMPLES_MEASURE_H
#define NOH_EXAMPLES_MEASURE_H

#include <stddef.h>
#include <time.h>

static unsigned measure_allocations;

void *__real_malloc(size_t bytes);
void *__real_calloc(size_t count, size_t bytes);
void *__real_realloc(void *memory, size_t bytes);
void *__wrap_malloc(size_t bytes);
void *__wrap_calloc(size_t count, size_t bytes);
void *__wrap_realloc(void *memory, size_t bytes);

void *__wrap_malloc(size_t bytes)
{
    measure_allocations++;
    return __real_malloc(bytes);
}

void *__wrap_calloc(size_t count, size_t bytes)
{
    measure_allocations++;
    return __real_calloc(count, bytes);
}

void *__wrap_realloc(void *memory, size_t bytes)
{
    measure_allocations++;
    return __real_realloc(memory, bytes);
}

static double measure_ns(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

#endif
