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

/* Whether a name has a word of small letters, in any case and over separators: 'upper_arm.L' has "upperarm" and "arm",
 * 'handbag' has not "hand". Words end at separators, digits and capitals; a side, a plural's s, and words such as
 * upper, hind and bone may be joined to a word (name.c). */
int noh_name_has(const char *name, const char *word);

#endif
