#include "text_scan.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void text_start(text_scan *s, const char *text, size_t size, model_error *error)
{
    s->at = text;
    s->end = text + size;
    s->line = 1;
    s->error = error;
    if (size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) s->at += 3; /* a byte order mark */
}

static int is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

static void skip_blanks(text_scan *s)
{
    while (s->at < s->end && is_blank(*s->at)) ++s->at;
}

text_word text_next_on_line(text_scan *s)
{
    skip_blanks(s);
    text_word word = { s->at, 0, s->line };
    while (s->at < s->end && *s->at != '\n' && !is_blank(*s->at)) ++s->at;
    word.size = (size_t)(s->at - word.text);
    return word;
}

int text_next_line(text_scan *s)
{
    skip_blanks(s);
    while (s->at < s->end && *s->at == '\n') {
        ++s->at;
        ++s->line;
        skip_blanks(s);
    }
    return s->at < s->end;
}

text_word text_next(text_scan *s)
{
    (void)text_next_line(s);
    return text_next_on_line(s);
}

text_word text_rest_of_line(text_scan *s)
{
    skip_blanks(s);
    text_word word = { s->at, 0, s->line };
    while (s->at < s->end && *s->at != '\n') ++s->at;
    word.size = (size_t)(s->at - word.text);
    while (word.size > 0 && is_blank(word.text[word.size - 1])) --word.size;
    return word;
}

int text_is(text_word word, const char *keyword)
{
    if (word.size != strlen(keyword)) return 0;
    for (size_t i = 0; i < word.size; ++i)
        if (tolower((unsigned char)word.text[i]) != tolower((unsigned char)keyword[i])) return 0;
    return 1;
}

static void clean(char *text)
{
    for (; *text; ++text)
        if ((unsigned char)*text < 0x20 || *text == 0x7f) *text = '_';
}

const char *text_show(text_word word, char out[TEXT_SHOWN])
{
    size_t size = word.size < TEXT_SHOWN ? word.size : TEXT_SHOWN - 1;
    for (size_t i = 0; i < size; ++i) out[i] = word.text[i] ? word.text[i] : '_';
    out[size] = '\0';
    clean(out);
    return out;
}

char *text_copy(text_word word)
{
    char *copy = malloc(word.size + 1);
    if (!copy) return NULL;
    for (size_t i = 0; i < word.size; ++i) copy[i] = word.text[i] ? word.text[i] : '_';
    copy[word.size] = '\0';
    clean(copy);
    return copy;
}

int text_fail(text_scan *s, uint32_t line, const char *format, ...)
{
    char where[32], what[256];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    (void)snprintf(where, sizeof where, "line %u", line);
    return model_fail(s->error, where, "%s", what);
}

/* also nan, inf and their longer spellings */
static int is_not_finite(text_word word)
{
    size_t sign = word.size > 0 && (word.text[0] == '-' || word.text[0] == '+');
    text_word rest = { word.text + sign, word.size - sign < 3 ? word.size - sign : 3, word.line };
    return text_is(rest, "nan") || text_is(rest, "inf") || text_is(rest, "1.#");
}

int text_number(text_scan *s, text_word word, double *out)
{
    char digits[64], shown[TEXT_SHOWN], *end = digits;
    if (is_not_finite(word)) return text_fail(s, word.line, "the number '%s' is not finite", text_show(word, shown));
    if (word.size > 0 && word.size < sizeof digits) {
        memcpy(digits, word.text, word.size);
        digits[word.size] = '\0';
        if (strspn(digits, "+-.0123456789eE") == word.size) /* no hexadecimal, no local decimal comma */
            *out = strtod(digits, &end);
    }
    if (end == digits || *end != '\0') return text_fail(s, word.line, "'%s' is not a number", text_show(word, shown));
    return isfinite(*out) ? 0 : text_fail(s, word.line, "the number '%s' is too large", text_show(word, shown));
}

int text_count(text_scan *s, text_word word, uint32_t limit, uint32_t *out)
{
    char shown[TEXT_SHOWN];
    uint64_t value = 0;
    for (size_t i = 0; i < word.size; ++i) {
        if (word.text[i] < '0' || word.text[i] > '9')
            return text_fail(s, word.line, "'%s' is not a whole number", text_show(word, shown));
        value = value * 10 + (uint64_t)(word.text[i] - '0');
        if (value > limit) return text_fail(s, word.line, "%s is above the limit of %u", text_show(word, shown), limit);
    }
    *out = (uint32_t)value;
    return word.size > 0 ? 0 : text_fail(s, word.line, "a number is missing");
}

int text_take_on_line(text_scan *s, text_word *out)
{
    const char *close;
    *out = text_next_on_line(s);
    if (out->size > 0 && out->text[0] == '#') {
        s->at = out->text;
        (void)text_rest_of_line(s);
        out->size = 0;
    }
    if (out->size == 0 || out->text[0] != '"') return 0;
    close = out->text + 1;
    while (close < s->end && *close != '"' && *close != '\n') ++close;
    if (close == s->end || *close != '"') return text_fail(s, out->line, "a quote is not closed");
    out->text++;
    out->size = (size_t)(close - out->text);
    s->at = close + 1;
    return out->size > 0 ? 0 : text_fail(s, out->line, "a name is empty");
}

int text_field(text_scan *s, char separator, const char *blanks, text_word *out)
{
    if (s->at == s->end || *s->at == '\n') return 0;
    if (*s->at == separator && out->text) s->at++;
    out->text = s->at;
    out->line = s->line;
    while (s->at < s->end && *s->at != '\n' && *s->at != separator) s->at++;
    out->size = (size_t)(s->at - out->text);
    while (out->size && strchr(blanks, out->text[out->size - 1])) out->size--;
    while (out->size && strchr(blanks, *out->text)) out->text++, out->size--;
    return 1;
}

int text_to_number(text_word word, double *out)
{
    model_error unused;
    text_scan scan;
    text_start(&scan, word.text, word.size, &unused);
    return text_number(&scan, word, out);
}
