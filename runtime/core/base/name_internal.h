/* name_internal.h: names compared where their hashes agree, and words in names of joints. Threads: no state; any
 * thread. */
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

static inline int noh_name_begins(const char *name, const char *start)
{
    while (*start && *name == *start) {
        name++;
        start++;
    }
    return !*start;
}

/* Does a name, as letters alone in any case, have a word of lower case? 'upper_arm.L' has "upperarm". */
static inline int noh_name_has(const char *name, const char *word)
{
    for (; *name; name++) {
        const char *at = name, *rest = word;
        for (; *at && *rest; at++) {
            const char c = *at >= 'A' && *at <= 'Z' ? (char)(*at + 32) : *at;
            if (c < 'a' || c > 'z') continue;
            if (c != *rest) break;
            rest++;
        }
        if (!*rest) return 1;
    }
    return 0;
}

#endif
