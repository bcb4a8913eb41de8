/* graph_words.c: the words and options of a line of a graph text. */
#include "graph_internal.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/clip.h"
#include "convert/base/nearest.h"

int graph_fail(graph_reader *r, uint32_t line, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(r->error->what, sizeof r->error->what, format, arguments);
    va_end(arguments);
    r->error->where[0] = '\0';
    *r->line = line;
    return 1;
}

const char *graph_hint(const char *name, const char *const *candidates, size_t count, char hint[GRAPH_HINT])
{
    const char *near = nearest_name(name, candidates, count);
    hint[0] = '\0';
    if (near) (void)snprintf(hint, GRAPH_HINT, "; did you mean '%.80s'?", near);
    return hint;
}

/* A name of the file, kept until it is freed; NULL when out of memory. */
static const char *keep(graph_file *file, text_word word)
{
    char *copy = text_copy(word);
    if (file->pool_count == file->pool_room) {
        uint32_t room = file->pool_room ? file->pool_room * 2 : 256;
        char **larger = realloc(file->pool, room * sizeof *larger);
        if (!larger) {
            free(copy);
            return NULL;
        }
        file->pool = larger;
        file->pool_room = room;
    }
    if (copy) file->pool[file->pool_count++] = copy;
    return copy;
}

/* The text between quotes; *more is 0 at the end of the line, and at a comment. */
static int next_text(graph_reader *r, text_word *word, int *quoted, int *more)
{
    text_scan *s = &r->text;
    const char *close;
    *word = text_next_on_line(s);
    *quoted = word->size > 0 && word->text[0] == '"';
    *more = word->size > 0 && word->text[0] != '#';
    if (word->size > 0 && !*more) {
        s->at = word->text;
        (void)text_rest_of_line(s);
    }
    if (!*quoted) return 0;
    close = ++word->text;
    while (close < s->end && *close != '"' && *close != '\n') ++close;
    if (close == s->end || *close != '"') return graph_fail(r, word->line, "a quote is not closed");
    word->size = (size_t)(close - word->text);
    s->at = close + 1;
    return word->size ? 0 : graph_fail(r, word->line, "a name is empty");
}

int graph_split(graph_reader *r)
{
    r->word_count = r->next = 0;
    for (;;) {
        text_word text;
        graph_word *w = &r->words[r->word_count];
        int quoted, more;
        char *equals;
        if (next_text(r, &text, &quoted, &more)) return 1;
        if (!more) return 0;
        if (r->word_count == GRAPH_WORDS_MAX)
            return graph_fail(r, text.line, "a line has more than %u words", GRAPH_WORDS_MAX);
        if (text.size >= NOH_NAME_BYTES_MAX)
            return graph_fail(r, text.line, "a word is longer than %u bytes", NOH_NAME_BYTES_MAX - 1u);
        w->text = keep(r->file, text);
        w->value = NULL;
        w->line = text.line;
        if (!w->text) return graph_fail(r, text.line, "there is not enough memory to read this file");
        equals = quoted ? NULL : strchr(r->file->pool[r->file->pool_count - 1u], '=');
        if (equals) {
            *equals = '\0';
            w->value = equals + 1;
        }
        ++r->word_count;
    }
}

graph_word graph_take(graph_reader *r)
{
    const graph_word none = { "", NULL, r->words[0].line };
    while (r->next < r->word_count && r->words[r->next].value) ++r->next;
    return r->next < r->word_count ? r->words[r->next++] : none;
}

int graph_take_needed(graph_reader *r, const char *what, graph_word *out)
{
    *out = graph_take(r);
    return out->text[0] ? 0 : graph_fail(r, out->line, "%s is missing after '%.60s'", what, r->words[0].text);
}

const char *graph_option(graph_reader *r, const char *key)
{
    for (uint32_t i = 0; i < r->word_count; ++i) {
        const char *value = r->words[i].value;
        if (value && strcmp(r->words[i].text, key) == 0) {
            memmove(r->words + i, r->words + i + 1, (r->word_count - i - 1u) * sizeof *r->words);
            --r->word_count;
            r->next -= i < r->next;
            return value;
        }
    }
    return NULL;
}

int graph_done(graph_reader *r, const char *options)
{
    const graph_word extra = graph_take(r);
    char list[256], hint[GRAPH_HINT];
    const char *candidates[16];
    size_t count = 0;
    if (extra.text[0])
        return graph_fail(r, extra.line, "'%.60s' is one word too many after '%.60s'", extra.text, r->words[0].text);
    for (uint32_t i = 0; i < r->word_count; ++i) {
        if (!r->words[i].value) continue;
        (void)snprintf(list, sizeof list, "%s", options);
        for (char *word = strtok(list, " "); word && count < 16; word = strtok(NULL, " ")) candidates[count++] = word;
        return graph_fail(r, r->words[i].line, "'%.60s' has no option '%.60s', or has it twice%s", r->words[0].text,
                          r->words[i].text, graph_hint(r->words[i].text, candidates, count, hint));
    }
    return 0;
}

int graph_number(graph_reader *r, uint32_t line, const char *text, double *out)
{
    const text_word word = { text, strlen(text), line };
    if (!text_number(&r->text, word, out)) return 0;
    r->error->where[0] = '\0';
    *r->line = line;
    return 1;
}

int graph_option_number(graph_reader *r, const char *key, double low, double high, double *out)
{
    const uint32_t line = r->words[0].line;
    const char *text = graph_option(r, key);
    if (!text) return 0;
    if (graph_number(r, line, text, out)) return 1;
    return *out >= low && *out <= high ? 0 : graph_fail(r, line, "%s=%.60s must be %.9g to %.9g", key, text, low, high);
}

int graph_option_ticks(graph_reader *r, const char *key, uint32_t *out)
{
    double seconds = (double)*out / NOH_TICKS_PER_SECOND;
    if (graph_option_number(r, key, 0.0, 3600.0, &seconds)) return 1;
    *out = (uint32_t)floor(seconds * NOH_TICKS_PER_SECOND + 0.5);
    return 0;
}

int graph_option_word(graph_reader *r, const char *key, const char *const *words, uint32_t *out)
{
    const uint32_t line = r->words[0].line;
    const char *text = graph_option(r, key);
    char hint[GRAPH_HINT];
    size_t count = 0;
    if (!text) return 0;
    for (; words[count]; ++count) {
        if (strcmp(words[count], text) == 0) {
            *out = (uint32_t)count;
            return 0;
        }
    }
    return graph_fail(r, line, "%s has no value '%.60s'%s", key, text, graph_hint(text, words, count, hint));
}
