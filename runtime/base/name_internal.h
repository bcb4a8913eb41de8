/* name_internal.h: names compared where their hashes agree. Threads: no state; any thread. */
#ifndef NOH_BASE_NAME_INTERNAL_H
#define NOH_BASE_NAME_INTERNAL_H

static inline int noh_names_equal(const char *a, const char *b)
{
    while (*a && *a == *b) {
        a++;
        b++;
    }
    return *a == *b;
}

#endif
