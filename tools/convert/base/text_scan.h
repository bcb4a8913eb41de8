/* text_scan.h: reads a text in memory word by word and line by line, and knows line numbers for messages. Lines end
 * with LF or CRLF; blanks and tabs separate words. */
#ifndef NOH_CONVERT_BASE_TEXT_SCAN_H
#define NOH_CONVERT_BASE_TEXT_SCAN_H

#include <stdint.h>

#include "convert/base/error.h"

typedef struct text_scan {
    const char *at, *end;
    uint32_t line; /* of `at`, from 1 */
    model_error *error;
} text_scan;

typedef struct text_word {
    const char *text; /* not terminated */
    size_t size;      /* 0: there was none */
    uint32_t line;
} text_word;

void text_start(text_scan *s, const char *text, size_t size, model_error *error);

/* The next word, on this line or a later one; of size 0 at the end of the text. */
text_word text_next(text_scan *s);

/* The next word of this line; of size 0 at its end, where the scan stays. */
text_word text_next_on_line(text_scan *s);

/* The next word of this line, or the text between quotes; of size 0 at the line's end and at a comment, which it skips.
 * 0, or 1 and an error. */
int text_take_on_line(text_scan *s, text_word *out);

/* The rest of this line, without blanks around it. The scan stays at the line's end. */
text_word text_rest_of_line(text_scan *s);

/* Go from the end of this line to the first word of a later one. 0 at the end of the text. */
int text_next_line(text_scan *s);

/* The next field of this line, up to a separator, without the characters of `blanks` around it. `out` is the field
 * before; its text is NULL for the first of a line. 0 at the end of the line. */
int text_field(text_scan *s, char separator, const char *blanks, text_word *out);

/* Compare without regard to case. */
int text_is(text_word word, const char *keyword);

/* A copy for messages: short, without control characters. Returns `out`. */
#define TEXT_SHOWN 48
const char *text_show(text_word word, char out[TEXT_SHOWN]);

/* A name on the heap, control characters replaced. NULL when out of memory. */
char *text_copy(text_word word);

/* Fill the error with a line number (printf form) and return 1. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
int text_fail(text_scan *s, uint32_t line, const char *format, ...);

/* A finite decimal number, or 1 and an error. */
int text_number(text_scan *s, text_word word, double *out);

/* The same without an error: 0, or 1. */
int text_to_number(text_word word, double *out);

/* A whole number without sign, up to limit, or 1 and an error. */
int text_count(text_scan *s, text_word word, uint32_t limit, uint32_t *out);

#endif
