#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh_tool.h"

int parse_level(double value, uint32_t *level)
{
    if (!(value >= 0.0 && value < NOH_LEVELS_MAX) || value != (double)(uint32_t)value) {
        return tool_usage("--lod wants a whole number from 0 to %u", NOH_LEVELS_MAX - 1u);
    }
    *level = (uint32_t)value;
    return 0;
}

int parse_levels(const char *text, uint32_t *count, int *by_error)
{
    double value = 1.0;
    *by_error = strcmp(text, "auto") == 0;
    if (!*by_error && (tool_number(text, &value) || value < 1.0 || value > NOH_LEVELS_MAX || value != (double)(uint32_t)value)) {
        return tool_usage("--lod wants auto or a whole number from 1 to %u, not '%s'", NOH_LEVELS_MAX, text);
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

static int set_value(const option *o, const char *text)
{
    option_list *list = (option_list *)o->value;
    switch (o->kind) {
    case OPTION_TEXT:
        *(const char **)o->value = text;
        return 0;
    case OPTION_NUMBER:
        return tool_number(text, (double *)o->value) ? tool_usage("%s wants a number, not '%s'", o->name, text) : 0;
    case OPTION_SIZE:
        return parse_size(text, (uint32_t *)o->value) ? tool_usage("%s wants WIDTHxHEIGHT, 1 to 8192 each, not '%s'", o->name, text)
                                                      : 0;
    case OPTION_LIST:
        if (list->count == OPTION_LIST_MAX) {
            return tool_usage("more than %d times %s", OPTION_LIST_MAX, o->name);
        }
        list->items[list->count++] = text;
        return 0;
    case OPTION_FLAG:
        break;
    }
    return 0;
}

static const option *find_option(const option *options, int count, const char *name)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(options[i].name, name) == 0) {
            return &options[i];
        }
    }
    return NULL;
}

int tool_options(int argc, char **argv, const option *options, int option_count, const char **files, int file_max, int *file_count)
{
    *file_count = 0;
    for (int i = 0; i < argc; i++) {
        const option *o;
        if (argv[i][0] != '-' || !argv[i][1]) {
            if (*file_count == file_max) {
                return tool_usage("'%s' is one file too many", argv[i]);
            }
            files[(*file_count)++] = argv[i];
            continue;
        }
        o = find_option(options, option_count, argv[i]);
        if (!o) {
            return tool_usage("there is no option %s here", argv[i]);
        }
        if (o->kind == OPTION_FLAG) {
            *(int *)o->value = 1;
        } else if (i + 1 == argc) {
            return tool_usage("%s wants a value", argv[i]);
        } else {
            int status = set_value(o, argv[++i]);
            if (status) {
                return status;
            }
        }
    }
    return 0;
}
