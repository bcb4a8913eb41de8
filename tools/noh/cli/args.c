#define _POSIX_C_SOURCE 200809L /* stat */

#include "args.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "noh/base.h"
#include "message.h"
#include "convert/base/nearest.h"

#define OPTIONS_MAX 128

int parse_level(double value, uint32_t *level)
{
    if (!(value >= 0.0 && value < NOH_LOD_LEVELS_MAX) || value != (double)(uint32_t)value) {
        return tool_usage("--lod must be a whole number from 0 to %u", NOH_LOD_LEVELS_MAX - 1u);
    }
    *level = (uint32_t)value;
    return 0;
}

int parse_levels(const char *text, uint32_t *count, int *by_error)
{
    double value = 1.0;
    *by_error = strcmp(text, "auto") == 0;
    if (!*by_error &&
        (tool_number(text, &value) || value < 1.0 || value > NOH_LOD_LEVELS_MAX || value != (double)(uint32_t)value)) {
        return tool_usage("--lod must be auto or a whole number from 1 to %u, not '%s'", NOH_LOD_LEVELS_MAX, text);
    }
    *count = (uint32_t)value;
    return 0;
}

int tool_number(const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    return end == text || *end || !isfinite(*value);
}

/* 640x480: two whole numbers from 1 to 8192. */
static int parse_size(const char *text, uint32_t size[2])
{
    char *end;
    unsigned long w, h;
    if (text[0] < '0' || text[0] > '9') {
        return 1;
    }
    w = strtoul(text, &end, 10);
    if (*end != 'x' || end[1] < '0' || end[1] > '9') {
        return 1;
    }
    h = strtoul(end + 1, &end, 10);
    if (*end || !w || !h || w > 8192 || h > 8192) {
        return 1;
    }
    size[0] = (uint32_t)w;
    size[1] = (uint32_t)h;
    return 0;
}

int tool_switch(const char *name, const char *text, int *on)
{
    *on = strcmp(text, "on") == 0;
    return *on || strcmp(text, "off") == 0 ? 0 : tool_usage("%s must be on or off, not '%s'", name, text);
}

static int add_item(const option *o, option_list *list, const char *text)
{
    if (list->count == OPTION_LIST_MAX) {
        return tool_usage("%s may be given at most %d times", o->name, OPTION_LIST_MAX);
    }
    list->items[list->count++] = text;
    return 0;
}

static int set_value(const option *o, void *args, const char *text)
{
    void *value = (char *)args + o->at;
    switch (o->kind) {
    case OPTION_TEXT:
    case OPTION_INPUT:
    case OPTION_OUTPUT: *(const char **)value = text; break;
    case OPTION_NUMBER:
        return tool_number(text, (double *)value) ? tool_usage("%s must be a number, not '%s'", o->name, text) : 0;
    case OPTION_SIZE:
        return parse_size(text, (uint32_t *)value)
                   ? tool_usage("%s must be WIDTHxHEIGHT, 1 to 8192 each, not '%s'", o->name, text)
                   : 0;
    case OPTION_INPUTS:
    case OPTION_LIST: return add_item(o, (option_list *)value, text);
    case OPTION_FLAG: *(int *)value = 1; break;
    }
    return 0;
}

const option *args_find(const verb *v, const char *name)
{
    for (int i = 0; i < v->option_count; i++) {
        if (strcmp(v->options[i].name, name) == 0) {
            return &v->options[i];
        }
    }
    return NULL;
}

/* ---- what was given ---- */

typedef struct given {
    const char *text[OPTIONS_MAX]; /* by the option's index: its last value, "" for a flag; NULL: not given */
    const char **files;
    int file_count;
} given;

static int unknown_option(const verb *v, const char *name)
{
    const char *names[OPTIONS_MAX], *near;
    for (int i = 0; i < v->option_count; i++) {
        names[i] = v->options[i].name;
    }
    near = nearest_name(name, names, (size_t)v->option_count);
    return near ? tool_usage("noh %s has no option %s (did you mean %s?)", v->name, name, near)
                : tool_usage("noh %s has no option %s", v->name, name);
}

/* 1 if the option that `length` bytes of a list name was given; "--only=mesh": with that value. */
static int was_given(const verb *v, const given *g, const char *word, size_t length)
{
    const char *equals = memchr(word, '=', length);
    const size_t name = equals ? (size_t)(equals - word) : length;
    for (int i = 0; i < v->option_count; i++) {
        if (g->text[i] && strlen(v->options[i].name) == name && memcmp(v->options[i].name, word, name) == 0) {
            return !equals ||
                   (strlen(g->text[i]) == length - name - 1 && memcmp(g->text[i], equals + 1, length - name - 1) == 0);
        }
    }
    return 0;
}

/* The first word of a list that was given, or NULL. */
static const char *first_given(const verb *v, const given *g, const char *list, size_t *length)
{
    while (list && *list) {
        *length = strcspn(list, " ");
        if (was_given(v, g, list, *length)) {
            return list;
        }
        list += *length + (list[*length] == ' ');
    }
    return NULL;
}

/* An option without effect is an error: the caller expected one. */
static int check_effects(const verb *v, const given *g)
{
    for (int i = 0; i < v->option_count; i++) {
        const option *o = &v->options[i];
        const char *word;
        size_t length = 0;
        if (!g->text[i]) {
            continue;
        }
        if (o->needs && !first_given(v, g, o->needs, &length)) {
            return tool_usage("%s has no effect without %s%s", o->name, strchr(o->needs, ' ') ? "one of " : "",
                              o->needs);
        }
        word = first_given(v, g, o->excludes, &length);
        if (word) {
            return tool_usage("%s has no effect with %.*s", o->name, (int)length, word);
        }
    }
    return 0;
}

/* 1 if two paths lead to the same regular file. */
static int same_file(const char *a, const char *b)
{
    struct stat x, y;
    return stat(a, &x) == 0 && stat(b, &y) == 0 && S_ISREG(x.st_mode) && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}

/* An output must not be an input. */
static int check_output(const verb *v, const given *g, const option *o, const char *path)
{
    for (int i = 0; i < g->file_count; i++) {
        if (same_file(path, g->files[i])) {
            return tool_usage("%s would overwrite the input '%s'", o->name, g->files[i]);
        }
    }
    for (int i = 0; i < v->option_count; i++) {
        if ((v->options[i].kind == OPTION_INPUT || v->options[i].kind == OPTION_INPUTS) && g->text[i] &&
            same_file(path, g->text[i])) {
            return tool_usage("%s would overwrite '%s', which %s reads", o->name, g->text[i], v->options[i].name);
        }
    }
    return 0;
}

/* Files are needed, unless the option in their place or the option without them is given. */
static int check_files(const verb *v, const given *g)
{
    const int instead = v->instead && was_given(v, g, v->instead, strlen(v->instead));
    if (instead) {
        return g->file_count ? tool_usage("'%s' has no effect with %s", g->files[0], v->instead) : 0;
    }
    if (g->file_count || (v->without && was_given(v, g, v->without, strlen(v->without)))) {
        return 0;
    }
    const char *other = v->instead ? v->instead : v->without;
    return other ? tool_usage("noh %s needs %s or %s", v->name, v->files, other)
                 : tool_usage("noh %s needs %s", v->name, v->files);
}

static int check_all(const verb *v, const given *g)
{
    int status = check_files(v, g);
    for (int i = 0; i < v->option_count && !status; i++) {
        const option *o = &v->options[i];
        if (o->required && !g->text[i]) {
            status = tool_usage("noh %s needs %s %s", v->name, o->name, o->value);
        } else if (o->kind == OPTION_OUTPUT && g->text[i]) {
            status = check_output(v, g, o, g->text[i]);
        }
    }
    return status ? status : check_effects(v, g);
}

/* ---- reading ---- */

static int set_defaults(const verb *v)
{
    int status = 0;
    for (int i = 0; i < v->option_count && !status; i++) {
        status = v->options[i].initial ? set_value(&v->options[i], v->args, v->options[i].initial) : 0;
    }
    return status;
}

static int add_file(const verb *v, given *g, const char *path)
{
    if (g->file_count == v->file_max) {
        return tool_usage("'%s' is one file too many", path);
    }
    g->files[g->file_count++] = path;
    return 0;
}

/* Read the option argv[*at]; *at advances to its value, if it takes one. */
static int read_option(const verb *v, given *g, int argc, char **argv, int *at)
{
    const char *name = argv[*at];
    const option *o = args_find(v, name);
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0) {
        return ARGS_HELP;
    }
    if (!o) {
        return unknown_option(v, name);
    }
    if (o->kind != OPTION_FLAG && ++*at == argc) {
        return tool_usage("%s needs a value", name);
    }
    g->text[o - v->options] = o->kind == OPTION_FLAG ? "" : argv[*at];
    return set_value(o, v->args, argv[*at]);
}

int args_read(const verb *v, int argc, char **argv)
{
    given g;
    int only_files = 0, status = set_defaults(v);
    if (v->option_count > OPTIONS_MAX) return tool_usage("noh %s has more options than OPTIONS_MAX in args.c", v->name);
    memset(&g, 0, sizeof g);
    g.files = (const char **)(void *)((char *)v->args + v->files_at);
    for (int i = 0; i < argc && !status; i++) {
        if (only_files || argv[i][0] != '-' || !argv[i][1]) {
            status = add_file(v, &g, argv[i]);
        } else if (strcmp(argv[i], "--") == 0) {
            only_files = 1;
        } else {
            status = read_option(v, &g, argc, argv, &i);
        }
    }
    if (!status) {
        status = check_all(v, &g);
    }
    if (!status && v->file_max > 1) {
        *(int *)(void *)((char *)v->args + v->file_count_at) = g.file_count;
    }
    return status;
}
