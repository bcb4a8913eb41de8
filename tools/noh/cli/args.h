/* args.h: the arguments of a verb, read by its table of options. Its help, the man page and the shell completion are
 * made from the same table. */
#ifndef NOH_NOH_CLI_ARGS_H
#define NOH_NOH_CLI_ARGS_H

#include <stddef.h>
#include <stdint.h>

typedef enum option_kind {
    OPTION_FLAG,   /* int: 1 where it is given */
    OPTION_TEXT,   /* const char *; INPUT and OUTPUT likewise */
    OPTION_NUMBER, /* double */
    OPTION_SIZE,   /* uint32_t[2], as 640x480 */
    OPTION_LIST,   /* option_list, may repeat */
    OPTION_INPUT,  /* a file that is read */
    OPTION_INPUTS, /* option_list of such, may repeat */
    OPTION_OUTPUT  /* a file that is written; it must not be one that is read */
} option_kind;

#define OPTION_LIST_MAX 1024

typedef struct option_list {
    const char *items[OPTION_LIST_MAX];
    int count;
} option_list;

typedef struct option {
    const char *name; /* "--size" */
    option_kind kind;
    size_t at; /* offsetof the value in the verb's arguments */
    int required;
    const char *value;   /* what follows it, for the help: "PACK", "auto|f32|f16"; NULL: nothing (FLAG) */
    const char *initial; /* the default, as text; NULL: 0, none */
    const char *what;    /* its meaning, unit and range */
    const char *example; /* a value; NULL where `value` lists all or there is none */
    const char *needs;   /* one of these must be given too, else it has no effect; separated by blanks: "--clip --to" */
    const char *excludes; /* it has no effect with any of these; "--only=mesh": with this value */
} option;

typedef struct verb {
    const char *name;
    const char *files;   /* the positional arguments, for the help: "PACK" */
    const char *what;    /* one line */
    const char *more;    /* paragraphs below the options; NULL: none */
    const char *example; /* arguments after the verb, one call a line */
    const option *options;
    int option_count;
    int file_max;         /* takes 1 to this many files */
    const char *instead;  /* an option in place of the files, which excludes them; NULL: none */
    const char *without;  /* an option with which files are optional; NULL: none */
    size_t files_at;      /* offsetof const char *[file_max] */
    size_t file_count_at; /* offsetof an int; used if file_max is over 1 */
    void *args;
    int (*run)(void *args); /* returns an exit code */
} verb;

#define ARGS_HELP (-1) /* no exit code: --help was asked for */

/* Read argv into v->args, which is all zero. Returns 0, ARGS_HELP, or EXIT_USAGE after printing the mistake. */
int args_read(const verb *v, int argc, char **argv);

const option *args_find(const verb *v, const char *name);

/* Parse text as a double. 0 if all of it is one finite number. */
int tool_number(const char *text, double *value);
/* *on: 1 for "on". Prints an error and returns an exit code; 0 on success. */
int tool_switch(const char *name, const char *text, int *on);

/* --lod: a whole number from 0, the full mesh. Returns an exit code. */
int parse_level(double value, uint32_t *level);
/* --lod of verbs that convert: auto, or the number of levels with the full one. Returns an exit code. */
int parse_levels(const char *text, uint32_t *count, int *by_error);

#endif
