#include "springs_read.h"

#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "convert/base/input_file.h"
#include "convert/base/text_scan.h"

#define WORDS \
    "a chain is `chain JOINT [to JOINT] [stiffness N] [drag N] [gravity N] [radius N] [end X Y Z] [hits JOINT ...]`"

/* ---- words ---- */

static int name_copy(text_scan *s, text_word word, char **out)
{
    if (word.size >= NOH_NAME_BYTES_MAX) {
        return text_fail(s, word.line, "the joint's name is longer than %u bytes", NOH_NAME_BYTES_MAX - 1u);
    }
    free(*out);
    *out = text_copy(word);
    return *out ? 0 : text_fail(s, word.line, "out of memory");
}

/* A number within a range; it has to be there. */
static int take_number(text_scan *s, const char *what, double least, double most, float *out)
{
    text_word word;
    double value;
    if (text_take_on_line(s, &word)) return 1;
    if (!word.size) return text_fail(s, word.line, "the number of %s is missing", what);
    if (text_number(s, word, &value)) return 1;
    if (!(value >= least && value <= most)) {
        return text_fail(s, word.line, "%s is %g: it must be %g to %g", what, value, least, most);
    }
    *out = (float)value;
    return 0;
}

static int take_place(text_scan *s, const char *what, float out[3])
{
    for (int i = 0; i < 3; i++) {
        if (take_number(s, what, -1e6, 1e6, &out[i])) return 1;
    }
    return 0;
}

/* ---- a chain ---- */

/* The rest of the line: names. */
static int take_hits(text_scan *s, springs_chain *c)
{
    size_t used = 0;
    text_word word;
    do {
        char *grown;
        if (text_take_on_line(s, &word)) return 1;
        grown = realloc(c->hits, used + word.size + 2u);
        if (!grown) return text_fail(s, word.line, "out of memory");
        c->hits = grown;
        memcpy(grown + used, word.text, word.size);
        grown[used + word.size] = grown[used + word.size + 1u] = '\0';
        used += word.size + 1u;
    } while (word.size);
    return used > 1u
               ? 0
               : text_fail(s, c->line,
                           "`hits` needs the name of a joint with a collider; without `hits`, all colliders count");
}

static int take_option(text_scan *s, text_word word, springs_chain *c)
{
    char shown[TEXT_SHOWN];
    text_word name;
    if (text_is(word, "stiffness")) return take_number(s, "stiffness", 0.0, 1e3, &c->stiffness);
    if (text_is(word, "drag")) return take_number(s, "drag", 0.0, 1.0, &c->drag);
    if (text_is(word, "gravity")) return take_number(s, "gravity", -1e3, 1e3, &c->gravity);
    if (text_is(word, "radius")) return take_number(s, "radius", 0.0, 1e3, &c->radius);
    if (text_is(word, "hits")) return take_hits(s, c);
    if (text_is(word, "end")) {
        c->has_end = 1;
        return take_place(s, "end", c->end);
    }
    if (text_is(word, "to")) {
        if (text_take_on_line(s, &name)) return 1;
        return name.size ? name_copy(s, name, &c->to) : text_fail(s, word.line, "`to` needs the name of a joint");
    }
    return text_fail(s, word.line, "'%s' is not understood: " WORDS, text_show(word, shown));
}

static int read_chain(text_scan *s, springs_text *out, uint32_t line)
{
    springs_chain *grown = realloc(out->chains, (out->chain_count + 1u) * sizeof *grown), *c;
    text_word word;
    if (!grown) return text_fail(s, line, "out of memory");
    out->chains = grown;
    c = &grown[out->chain_count++];
    memset(c, 0, sizeof *c);
    c->line = line;
    c->stiffness = 1.0f;
    c->drag = 0.4f;
    if (text_take_on_line(s, &word)) return 1;
    if (!word.size) return text_fail(s, line, "the joint is missing: " WORDS);
    if (name_copy(s, word, &c->joint) || text_take_on_line(s, &word)) return 1;
    while (word.size) {
        if (take_option(s, word, c) || text_take_on_line(s, &word)) return 1;
    }
    return 0;
}

/* ---- a collider ---- */

static int read_collider(text_scan *s, springs_text *out, uint32_t line)
{
    springs_collider *grown = realloc(out->colliders, (out->collider_count + 1u) * sizeof *grown), *c;
    text_word word;
    text_scan ahead;
    if (!grown) return text_fail(s, line, "out of memory");
    out->colliders = grown;
    c = &grown[out->collider_count++];
    memset(c, 0, sizeof *c);
    c->line = line;
    if (text_take_on_line(s, &word)) return 1;
    if (!word.size)
        return text_fail(s, line, "the joint is missing: a collider is `collider JOINT RADIUS [X Y Z [X Y Z]]`");
    if (name_copy(s, word, &c->joint) || take_number(s, "radius", 1e-6, 1e3, &c->radius)) return 1;
    ahead = *s;
    if (text_take_on_line(&ahead, &word)) return 1;
    if (word.size && take_place(s, "X Y Z", c->from)) return 1;
    memcpy(c->to, c->from, sizeof c->to);
    ahead = *s;
    if (text_take_on_line(&ahead, &word)) return 1;
    if (word.size && take_place(s, "X Y Z", c->to)) return 1;
    if (text_take_on_line(s, &word)) return 1;
    return word.size ? text_fail(s, line, "a word too many: a collider is `collider JOINT RADIUS [X Y Z [X Y Z]]`") : 0;
}

/* ---- lines ---- */

static int read_line(text_scan *s, springs_text *out)
{
    char shown[TEXT_SHOWN];
    text_word word;
    if (text_take_on_line(s, &word)) return 1;
    if (!word.size) return 0; /* a comment */
    if (text_is(word, "chain")) return read_chain(s, out, word.line);
    if (text_is(word, "collider")) return read_collider(s, out, word.line);
    return text_fail(s, word.line, "'%s' is neither `chain` nor `collider`", text_show(word, shown));
}

springs_text *springs_text_new(void)
{
    return calloc(1, sizeof(springs_text));
}

/* Frees the rest of a line that could not be read. */
static void drop(springs_text *t, uint32_t chains, uint32_t colliders)
{
    for (; t->chain_count > chains; t->chain_count--) {
        springs_chain *c = &t->chains[t->chain_count - 1u];
        free(c->joint);
        free(c->to);
        free(c->hits);
    }
    for (; t->collider_count > colliders; t->collider_count--) free(t->colliders[t->collider_count - 1u].joint);
}

void springs_text_free(springs_text *text)
{
    if (!text) return;
    drop(text, 0, 0);
    free(text->chains);
    free(text->colliders);
    free(text);
}

int springs_text_add(springs_text *springs, const char *text, size_t size, uint32_t *line, model_error *error)
{
    text_scan s;
    text_start(&s, text, size, error);
    while (text_next_line(&s)) {
        const uint32_t chains = springs->chain_count, colliders = springs->collider_count;
        *line = s.line;
        if (read_line(&s, springs)) {
            drop(springs, chains, colliders);
            return 1;
        }
    }
    return 0;
}

int springs_text_read(springs_text *springs, const char *path, uint32_t *line, model_error *error)
{
    size_t size = 0;
    char *text = input_read_text(path, &size, error);
    int failed;
    if (!text) return 1;
    failed = springs_text_add(springs, text, size, line, error);
    if (!failed && !springs->chain_count) {
        text_scan s;
        *line = 1;
        text_start(&s, text, size, error);
        failed = text_fail(&s, 1, "the file has no chain: " WORDS);
    }
    if (failed) error->where[0] = 0; /* *line has the line */
    free(text);
    return failed;
}
