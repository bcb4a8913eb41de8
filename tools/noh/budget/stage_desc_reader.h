/* stage_desc_reader.h: what reads a stage from a text line by line (stage_desc_file.c), and its keys
 * (stage_desc_keys.c). */
#ifndef NOH_NOH_BUDGET_STAGE_DESC_READER_H
#define NOH_NOH_BUDGET_STAGE_DESC_READER_H

#include <stddef.h>

#include "cli/message.h"
#include "stage_desc_file.h"

#define WORDS_MAX 64u
#define DESC_KEYS_MAX 64u

/* KEY=VALUE has a value; in a word with quotes, only an equals sign outside them counts. */
typedef struct word {
    char *text, *value; /* value NULL: none */
} word;

typedef struct reader {
    stage_desc_file *file;
    const char *path;
    char *at; /* the next line; NULL past the last */
    uint32_t line;
    word words[WORDS_MAX];
    uint32_t word_count;
    noh_kind_desc *kind; /* NULL before the first */
    uint32_t kind_line;
    uint32_t given[DESC_KEYS_MAX]; /* the line of each key of this section, by its row; 0: not yet */
} reader;

/* "; did you mean 'bytes_max'?", or nothing. */
typedef struct hint {
    char text[96];
} hint;

MESSAGE_FORMAT(3, 4) int desc_fail_at(const reader *r, uint32_t line, const char *format, ...);
int desc_out_of_memory(const char *path);
hint desc_hint(const char *name, const char *const *candidates, size_t count);

/* A path of the text: relative to its folder. NULL when out of memory. */
char *desc_path(const char *text, const char *path);

/* A pack by its path; each file is opened once. */
int desc_pack(const reader *r, const char *text, const noh_pack **out);

/* Another text; reader_of: whose peer it is. */
int desc_read_file(const char *path, stage_desc_file *reader_of, stage_desc_file **out);

/* A line of a key and its value. */
int desc_read_key(reader *r);

/* What follows a key: one word; words; a word, then words and NAME=VALUE, each name once. */
typedef enum desc_words { DESC_ONE_WORD, DESC_WORDS, DESC_OPTIONS } desc_words;

int desc_check_words(const reader *r, const char *key, desc_words takes);

/* A whole number within bounds; the place of a text in a list. */
int desc_number(const reader *r, const char *key, const char *text, uint64_t least, uint64_t most, uint64_t *out);
int desc_one_of(const reader *r, const char *key, const char *text, const char *const *names, uint32_t count,
                uint32_t *out);

/* Values of several words (stage_desc_words.c). */
int desc_add_layer(reader *r);
int desc_add_texture_set(reader *r);
int desc_add_modifier(reader *r);
int desc_make_map(reader *r); /* for a kind whose last line is read */
int desc_set_face(reader *r);
int desc_set_light(reader *r);
int desc_set_nodes(reader *r);

#endif
