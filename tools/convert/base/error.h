/* error.h: errors of inputs; allocations that may fail. */
#ifndef NOH_CONVERT_BASE_ERROR_H
#define NOH_CONVERT_BASE_ERROR_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The failure and its place (e.g. "accessor 7, element 12"; may be empty). */
typedef struct model_error {
    char what[256];
    char where[128];
} model_error;

/* Fill *error (printf form for `what`) unless it is NULL. Returns 1. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
int model_fail(model_error *error, const char *where, const char *format, ...);
int model_fail_memory(model_error *error); /* "out of memory" */

/* A zeroed array, or NULL: out of memory, or its size overflows. 0 elements get a block too. */
void *model_zeros(size_t count, size_t element_size);

/* A copy of a string, or of its first bytes; or NULL. */
char *model_string(const char *text);
char *model_string_of(const char *text, size_t bytes);

#ifdef __cplusplus
}
#endif
#endif
