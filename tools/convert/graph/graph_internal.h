/* graph_internal.h (private to graph/): the reader of graph texts: words, options, names. */
#ifndef NOH_CONVERT_GRAPH_GRAPH_INTERNAL_H
#define NOH_CONVERT_GRAPH_GRAPH_INTERNAL_H

#include "convert/base/text_scan.h"
#include "convert/graph/graph_text.h"

typedef struct graph_word {
    const char *text;  /* "": the line's end */
    const char *value; /* of KEY=VALUE, after the sign; NULL: not of that form, or quoted */
    uint32_t line;
} graph_word;

#define GRAPH_WORDS_MAX 256u

typedef struct graph_reader {
    text_scan text;
    graph_file *file;
    graph_def *g;                      /* the graph that statements belong to; NULL before the first */
    graph_node *node;                  /* the machine that `from` lines belong to, or NULL */
    graph_mask *mask;                  /* the mask that `below` and `joint` lines belong to, or NULL */
    graph_word words[GRAPH_WORDS_MAX]; /* of this statement */
    uint32_t word_count, next;
    uint32_t *line; /* out, of an error */
    model_error *error;
} graph_reader;

/* Fill the error and its line, and return 1. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
int graph_fail(graph_reader *r, uint32_t line, const char *format, ...);

/* "; did you mean 'x'?", or "": which of the names is nearest. */
#define GRAPH_HINT 128
const char *graph_hint(const char *name, const char *const *candidates, size_t count, char hint[GRAPH_HINT]);

/* Split the line into words. */
int graph_split(graph_reader *r);

/* The next word that is no option; "" at the end of the line. */
graph_word graph_take(graph_reader *r);
/* The same, which must be there. `what` is for the message: "a name". */
int graph_take_needed(graph_reader *r, const char *what, graph_word *out);
/* The value of the option, or NULL; each option is taken once. */
const char *graph_option(graph_reader *r, const char *key);
/* Checks that the line ends. `options`: the statement's options, for the message: "speed loop sync". */
int graph_done(graph_reader *r, const char *options);

int graph_number(graph_reader *r, uint32_t line, const char *text, double *out);
/* An option that is a number from low to high; left as it is when it is not given. */
int graph_option_number(graph_reader *r, const char *key, double low, double high, double *out);
/* An option in seconds, as ticks. */
int graph_option_ticks(graph_reader *r, const char *key, uint32_t *out);
/* An option that is one of the words, as its index; words end with NULL. */
int graph_option_word(graph_reader *r, const char *key, const char *const *words, uint32_t *out);

/* graph_link.c: resolve all names of a graph, with its nearest name for one that is not there. */
int graph_link(graph_reader *r, graph_def *g);
/* graph_desc.c: check the rest and lay it out, as for a graph made in code. After graph_link. */
int graph_make(graph_reader *r, graph_def *g);

#endif
