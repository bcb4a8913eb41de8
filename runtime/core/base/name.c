#include "core/base/name_internal.h"

#include <stddef.h>

static int is_capital(char c)
{
    return c >= 'A' && c <= 'Z';
}

/* In small letters; 0: not a letter. */
static char letter_of(char c)
{
    return is_capital(c) ? (char)(c + 32) : c >= 'a' && c <= 'z' ? c : '\0';
}

/* Whether a word ends before this character of a name, and another begins: L|Hand, upper|Arm, arm|01. */
static int is_edge(const char *name, size_t at)
{
    if (!at || !letter_of(name[at - 1u]) || !letter_of(name[at])) return 1;
    return is_capital(name[at]) &&
           (!is_capital(name[at - 1u]) || (letter_of(name[at + 1u]) && !is_capital(name[at + 1u])));
}

/* Behind the word, if it stands here, whatever separates its letters; 0: it does not. */
static size_t end_of(const char *name, size_t at, const char *word)
{
    for (; name[at]; at++) {
        const char letter = letter_of(name[at]);
        if (!letter) continue;
        if (letter != *word) return 0;
        if (!*++word) return at + 1u;
    }
    return 0;
}

/* Words that names join to others: leftarm, hindleg, headbone. */
static const char *const joined[] = { "left", "right", "upper", "lower", "front", "fore",
                                      "hind", "back",  "rear",  "bone",  "joint" };
#define JOINED (sizeof joined / sizeof joined[0])

static int begins_at(const char *name, size_t at)
{
    const char side = at ? letter_of(name[at - 1u]) : '\0';
    if (is_edge(name, at) || ((side == 'l' || side == 'r') && is_edge(name, at - 1u))) return 1;
    for (size_t i = 0; i < JOINED; i++) {
        for (size_t length = 4; length < 6 && length <= at; length++) {
            if (end_of(name, at - length, joined[i]) == at) return 1;
        }
    }
    return 0;
}

static int ends_at(const char *name, size_t at)
{
    const char last = letter_of(name[at]);
    if (is_edge(name, at) || ((last == 'l' || last == 'r' || last == 's') && is_edge(name, at + 1u))) return 1;
    for (size_t i = 0; i < JOINED; i++) {
        if (end_of(name, at, joined[i])) return 1;
    }
    return 0;
}

int noh_name_has(const char *name, const char *word)
{
    for (size_t at = 0; name[at]; at++) {
        const size_t end = letter_of(name[at]) == *word && begins_at(name, at) ? end_of(name, at, word) : 0;
        if (end && ends_at(name, end)) return 1;
    }
    return 0;
}
