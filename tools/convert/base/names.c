#include "names.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/input_file.h"
#include "convert/base/names_table.h"
#include "convert/base/text_scan.h"
#include "life/reach/bone_names_internal.h"

#define KEY_BYTES NOH_NAME_BYTES_MAX
#define WORD_MAX 60 /* bytes of a word of the table */

/* side: 'l', 'r', 0: none, '*': of either, and `means` has a '*' for it */
typedef struct name_row {
    name_kind kind;
    int is_own;
    char side;
    char *means, *name; /* name: a key; of materials a word */
} name_row;

typedef struct name_rows {
    name_row *rows;
    uint32_t count;
} name_rows;

static __thread name_rows in_use;

/* ---- reading ---- */

static int add_row(name_rows *all, name_kind kind, int is_own, const char *means, const char *name)
{
    name_row *grown = realloc(all->rows, ((size_t)all->count + 1u) * sizeof *grown);
    char spelled[2 * KEY_BYTES], key[KEY_BYTES];
    const char *star = kind == NAME_MATERIAL ? NULL : strchr(name, '*');
    name_row *row;
    if (!grown) return 1;
    all->rows = grown;
    row = &grown[all->count];
    row->kind = kind;
    row->is_own = is_own;
    row->side = 0;
    if (kind != NAME_MATERIAL) {
        (void)snprintf(spelled, sizeof spelled, "%.*s%s%.60s", star ? (int)(star - name) : WORD_MAX, name,
                       star ? "_left_" : "", star ? star + 1 : "");
        row->side = noh_name_key(spelled, key);
        if (star) row->side = '*';
    }
    row->means = model_string(means);
    row->name = model_string(kind == NAME_MATERIAL ? name : key);
    all->count++;
    return !row->means || !row->name;
}

static int kind_named(text_word word, name_kind *kind)
{
    static const char *const kinds[] = { "target", "joint", "material", "strip" };
    for (int i = 0; i < 4; i++) {
        *kind = (name_kind)i;
        if (text_is(word, kinds[i])) return 1;
    }
    return 0;
}

static int read_line(text_scan *s, name_rows *all)
{
    text_word word;
    name_kind kind;
    char means[KEY_BYTES], name[KEY_BYTES], shown[TEXT_SHOWN];
    if (text_take_on_line(s, &word)) return 1;
    if (!word.size) return 0; /* a comment */
    if (!kind_named(word, &kind)) {
        return text_fail(s, word.line, "'%s' is none of target, joint, material and strip", text_show(word, shown));
    }
    means[0] = '\0';
    for (int n = 0;; n++) {
        if (text_take_on_line(s, &word)) return 1;
        if (!word.size) {
            return n > (kind == NAME_MATERIAL) ? 0 : text_fail(s, word.line, "a line is KIND WHAT NAME...");
        }
        if (word.size > WORD_MAX) {
            return text_fail(s, word.line, "'%s' is longer than %d bytes", text_show(word, shown), WORD_MAX);
        }
        (void)snprintf(name, sizeof name, "%.*s", (int)word.size, word.text);
        if (!n) memcpy(means, name, sizeof means);
        if (kind == NAME_MATERIAL && !n) continue;
        if (add_row(all, kind, !n, means, name)) return text_fail(s, word.line, "out of memory");
    }
}

static int read_text(name_rows *all, const char *text, size_t size, model_error *error)
{
    text_scan scan;
    int failed;
    text_start(&scan, text, size, error);
    do {
        failed = read_line(&scan, all);
    } while (!failed && text_next_line(&scan));
    return failed;
}

/* A line of the table from one of the library: KIND WHAT NAME..., where names of a side have a '*'. */
static int read_keys(name_rows *all, const char *start, const char *keys, int has_side, model_error *error)
{
    char line[256];
    size_t n = (size_t)snprintf(line, sizeof line, "%s", start);
    for (const char *c = keys; *c && n + 3u < sizeof line; c++) {
        if (has_side && (c == keys || c[-1] == ' ')) line[n++] = '*';
        line[n++] = *c;
    }
    return read_text(all, line, n, error);
}

/* The library's names of bones come first. */
static int read_bones(name_rows *all, model_error *error)
{
    int failed = read_keys(all, "strip ", noh_bone_strips, 0, error);
    for (uint32_t i = 0; !failed && i < NOH_BONE_NAMES; i++) {
        const noh_bone_name *bone = &noh_bone_names[i];
        char start[64];
        (void)snprintf(start, sizeof start, "joint %s ", bone->vrm);
        failed = read_keys(all, start, bone->keys, bone->vrm[0] == '*', error);
    }
    return failed;
}

int names_use(const char *path, model_error *error)
{
    size_t size;
    char *text = path ? input_read_text(path, &size, error) : NULL;
    int failed = path && !text;
    names_free();
    if (text) failed = read_text(&in_use, text, size, error);
    free(text);
    failed = failed || read_bones(&in_use, error);
    for (uint32_t i = 0; !failed && names_table[i]; i++) {
        failed = read_text(&in_use, names_table[i], strlen(names_table[i]), error);
    }
    return failed;
}

void names_free(void)
{
    for (uint32_t i = 0; i < in_use.count; i++) {
        free(in_use.rows[i].means);
        free(in_use.rows[i].name);
    }
    free(in_use.rows);
    memset(&in_use, 0, sizeof in_use);
}

static const name_rows *rows_in_use(void)
{
    model_error error;
    if (!in_use.count) (void)names_use(NULL, &error);
    return &in_use;
}

/* ---- finding ---- */

static const name_row *find_key(const name_rows *all, name_kind kind, const char *key, char side)
{
    for (uint32_t i = 0; i < all->count; i++) {
        const name_row *row = &all->rows[i];
        const int fits = row->side == side || (row->side == '*' && side);
        if (row->kind == kind && fits && strcmp(row->name, key) == 0) return row;
    }
    return NULL;
}

/* Cut one of the table's beginnings or endings off. 0: there is none, or nothing else is left. */
static int strip(const name_rows *all, char *key)
{
    for (uint32_t i = 0; i < all->count; i++) {
        const name_row *row = &all->rows[i];
        if (row->kind == NAME_STRIP && noh_name_cut(key, row->name, strlen(row->name))) return 1;
    }
    return 0;
}

int names_find(name_kind kind, const char *name, char means[NOH_NAME_BYTES_MAX], int *is_own)
{
    const name_rows *all = rows_in_use();
    char key[KEY_BYTES];
    const char side = noh_name_key(name, key), *star;
    const name_row *row = find_key(all, kind, key, side);
    int stripped = 0;
    while (!row && strip(all, key)) {
        row = find_key(all, kind, key, side);
        stripped = 1;
    }
    if (!row) return 0;
    star = strchr(row->means, '*');
    (void)snprintf(means, NOH_NAME_BYTES_MAX, "%.*s%s%.60s", star ? (int)(star - row->means) : WORD_MAX, row->means,
                   !star               ? ""
                   : star > row->means ? (side == 'l' ? "Left" : "Right")
                   : side == 'l'       ? "left"
                                       : "right",
                   star ? star + 1 : "");
    if (is_own) *is_own = row->is_own && !stripped;
    return 1;
}

int names_has_word(const char *material, const char *word, size_t length)
{
    const name_rows *all = rows_in_use();
    for (uint32_t i = 0; i < all->count; i++) {
        const name_row *row = &all->rows[i];
        if (row->kind == NAME_MATERIAL && strcmp(row->means, material) == 0 && strlen(row->name) == length &&
            memcmp(row->name, word, length) == 0)
            return 1;
    }
    return 0;
}

int names_has_part(const char *material, const char *name)
{
    const name_rows *all = rows_in_use();
    for (uint32_t i = 0; i < all->count; i++) {
        const name_row *row = &all->rows[i];
        if (row->kind == NAME_MATERIAL && row->name[0] == '*' && strcmp(row->means, material) == 0 &&
            strstr(name, row->name + 1))
            return 1;
    }
    return 0;
}
