/* weights_text.h: weights of targets as text, to copy, paste and keep as presets:
 *
 *   [grin]
 *   smile = 0.8
 *   cheekPuff = 0.2
 *
 * Pasted text may come from other programs: "--weight smile=0.8 --weight cheekPuff=0.2", "smile: 0.8, cheekPuff: 0.2"
 * and JSON's {"smile": 0.8, "cheekPuff": 0.2} are read, too. # begins a comment. */
#ifndef NOH_NOH_FILE_WEIGHTS_TEXT_H
#define NOH_NOH_FILE_WEIGHTS_TEXT_H

#include <stddef.h>

#include "noh/base.h"

typedef enum weights_kind {
    WEIGHTS_END,
    WEIGHTS_VALUE,
    WEIGHTS_PRESET, /* a name in brackets */
    WEIGHTS_BAD     /* neither: `name` has what stands there */
} weights_kind;

typedef struct weights_item {
    char name[NOH_NAME_BYTES_MAX];
    double value;  /* finite */
    unsigned line; /* from 1 */
} weights_item;

typedef struct weights_reader {
    const char *at; /* zero-terminated */
    unsigned line;  /* 0 at first */
} weights_reader;

/* The next item of a text. */
weights_kind weights_next(weights_reader *reader, weights_item *item);

/* A line "name = value\n" with the shortest digits that give the same float. Returns its length without the zero; if it
 * does not fit, nothing is written and the length is 0. */
size_t weights_line(char *text, size_t bytes, const char *name, float value);

#endif
