/* identity_words.c: names of targets as words: noseWidthIncr, nose-width-incr and nose_width.incr are equal. */
#include "life/face/identity_internal.h"

static int is_upper(char c)
{
    return c >= 'A' && c <= 'Z';
}

static int is_letter(char c)
{
    return is_upper(c) || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || (unsigned char)c >= 128u;
}

static char lower(char c)
{
    return is_upper(c) ? (char)(c + ('a' - 'A')) : c;
}

/* Get the next word and move *name behind it; returns its length, 0 at the end. */
static uint32_t next_word(const char **name, const char **word)
{
    const char *p = *name;
    while (*p && !is_letter(*p)) p++;
    *word = p;
    while (*p && is_letter(*p) && (p == *word || !is_upper(*p) || is_upper(p[-1]))) p++;
    *name = p;
    return (uint32_t)(p - *word);
}

static int same_word(const char *a, uint32_t a_length, const char *b, uint32_t b_length)
{
    int same = a_length == b_length;
    for (uint32_t i = 0; same && i < a_length; i++) same = lower(a[i]) == lower(b[i]);
    return same;
}

int noh_identity_one_word_apart(const char *a, const char *b)
{
    uint32_t differ = 0;
    for (;;) {
        const char *word_a, *word_b;
        const uint32_t length_a = next_word(&a, &word_a), length_b = next_word(&b, &word_b);
        if (!length_a || !length_b) {
            return length_a == length_b && differ == 1u;
        }
        differ += !same_word(word_a, length_a, word_b, length_b);
    }
}

int noh_identity_name_leads(const char *name)
{
    static const struct {
        const char *text;
        uint32_t length;
    } words[] = { { "age", 3 },    { "old", 3 },  { "young", 5 },  { "fat", 3 },  { "weight", 6 },   { "muscle", 6 },
                  { "gender", 6 }, { "male", 4 }, { "female", 6 }, { "thin", 4 }, { "masculine", 9 } };
    const char *word;
    uint32_t length;
    while ((length = next_word(&name, &word)) != 0) {
        for (uint32_t i = 0; i < sizeof words / sizeof words[0]; i++) {
            if (same_word(word, length, words[i].text, words[i].length)) return 1;
        }
    }
    return 0;
}
