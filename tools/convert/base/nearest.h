/* nearest.h: suggests a name for a misspelt one. */
#ifndef NOH_CONVERT_BASE_NEAREST_H
#define NOH_CONVERT_BASE_NEAREST_H

#include <stddef.h>

/* The candidate nearest to `name` by edit distance, or NULL when none is near. */
const char *nearest_name(const char *name, const char *const *candidates, size_t count);

#endif
