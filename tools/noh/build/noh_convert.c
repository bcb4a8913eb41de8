#define _GNU_SOURCE /* fopencookie */

#include "noh_convert.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "build/build_options.h"
#include "cli/message.h"
#include "convert/base/input_file.h"
#include "noh/base.h"

#define ARGUMENTS_MAX 256
#define LINE_BYTES 1024

/* ---- messages ---- */

/* A stream whose lines go to the caller. */
typedef struct line_stream {
    const noh_convert_desc *desc;
    noh_convert_kind kind;
    FILE *file;
    int escapes; /* 1: within an escape of a terminal, which ends with a letter */
    size_t count;
    char line[LINE_BYTES]; /* longer lines are cut */
} line_stream;

static const char *without(const char *line, const char *begin)
{
    const size_t length = strlen(begin);
    return strncmp(line, begin, length) == 0 ? line + length : line;
}

/* As a terminal shows progress: a carriage return ends a line too. */
static void end_line(line_stream *s)
{
    s->line[s->count] = '\0';
    while (s->count && s->line[s->count - 1] == ' ') s->line[--s->count] = '\0';
    const char *line = without(s->line, "warning: ");
    if (*line) s->desc->message(s->desc->user, s->kind, line);
    s->count = 0;
}

static ssize_t take(void *cookie, const char *bytes, size_t count)
{
    line_stream *s = cookie;
    for (size_t i = 0; i < count; i++) {
        const char lower = (char)(bytes[i] | 32);
        if (bytes[i] == '\033' || s->escapes)
            s->escapes = bytes[i] == '\033' || lower < 'a' || lower > 'z';
        else if (bytes[i] == '\n' || bytes[i] == '\r')
            end_line(s);
        else if (s->count < LINE_BYTES - 1u)
            s->line[s->count++] = bytes[i];
    }
    return (ssize_t)count;
}

static FILE *stream_open(line_stream *s, const noh_convert_desc *desc, noh_convert_kind kind)
{
    const cookie_io_functions_t functions = { NULL, take, NULL, NULL };
    s->desc = desc;
    s->kind = kind;
    s->escapes = 0;
    s->count = 0;
    s->file = desc->message ? fopencookie(s, "w", functions) : NULL;
    return s->file;
}

static void stream_close(line_stream *s)
{
    if (!s->file) return;
    (void)fclose(s->file);
    if (s->count) end_line(s);
}

static void name_missing(const noh_convert_desc *desc, const input_list *inputs)
{
    for (uint32_t i = 0; i < inputs->count && desc->message; i++) {
        if (!inputs->entries[i].is_there) desc->message(desc->user, NOH_CONVERT_MISSING, inputs->entries[i].path);
    }
}

/* ---- the conversion ---- */

static noh_convert_result read_arguments(const noh_convert_desc *desc, convert_options *o)
{
    static const char output[] = "-o", none[] = "";
    char *argv[ARGUMENTS_MAX] = { (char *)output, (char *)none };
    if (desc->argument_count > ARGUMENTS_MAX - 2u) {
        (void)tool_usage("there are %u arguments, and at most %u are read", desc->argument_count, ARGUMENTS_MAX - 2u);
        return NOH_CONVERT_ARGUMENTS;
    }
    for (uint32_t i = 0; i < desc->argument_count; i++) argv[2 + i] = (char *)desc->arguments[i];
    return build_options_read((int)desc->argument_count + 2, argv, o) ? NOH_CONVERT_ARGUMENTS : NOH_CONVERT_OK;
}

static noh_convert_result hand_over(const noh_convert_desc *desc, const byte_buffer *made, noh_convert_pack *pack)
{
    pack->bytes = desc->allocate ? desc->allocate(desc->user, made->count) : malloc(made->count);
    if (!pack->bytes) {
        (void)tool_fail("pack", "there is no memory for its %zu bytes", made->count);
        return NOH_CONVERT_MEMORY;
    }
    memcpy(pack->bytes, made->bytes, made->count);
    pack->count = made->count;
    return NOH_CONVERT_OK;
}

static noh_convert_result convert(const noh_convert_desc *desc, const convert_options *given, noh_convert_pack *pack)
{
    noh_convert_result result = NOH_CONVERT_FILES;
    byte_buffer made = { NULL, 0, 0, 0 };
    input_list inputs = { NULL, 0, 0 };
    line_stream report, warnings, progress;
    convert_options o = *given;
    convert_failure failure;
    int count;
    const char *const *names = build_inputs(&count);
    memset(&failure, 0, sizeof failure);
    o.report = stream_open(&report, desc, NOH_CONVERT_REPORT);
    o.warnings = stream_open(&warnings, desc, NOH_CONVERT_WARNING);
    o.progress = stream_open(&progress, desc, NOH_CONVERT_PROGRESS);
    o.inputs = &inputs;
    if (convert_files(names, count, &o, &made, &failure))
        (void)build_fail(&failure);
    else
        result = hand_over(desc, &made, pack);
    stream_close(&report);
    stream_close(&warnings);
    stream_close(&progress);
    name_missing(desc, &inputs);
    inputs_free(&inputs);
    buffer_free(&made);
    return result;
}

noh_convert_result noh_convert(const noh_convert_desc *desc, noh_convert_pack *pack)
{
    input_held *held = desc->files ? calloc(desc->file_count + 1u, sizeof *held) : NULL;
    noh_convert_result result = desc->files && !held ? NOH_CONVERT_MEMORY : NOH_CONVERT_OK;
    convert_options options;
    memset(pack, 0, sizeof *pack);
    tool_errors_quiet();
    for (uint32_t i = 0; i < desc->file_count && held; i++)
        held[i] = (input_held){ desc->files[i].name, desc->files[i].bytes, desc->files[i].count };
    if (held) inputs_hold(held, desc->file_count);
    if (result != NOH_CONVERT_OK) (void)tool_fail("files", "there is no memory for a list of %u", desc->file_count);
    if (result == NOH_CONVERT_OK) result = read_arguments(desc, &options);
    if (result == NOH_CONVERT_OK) result = convert(desc, &options, pack);
    if (result != NOH_CONVERT_OK) {
        (void)snprintf(pack->error, sizeof pack->error, "%s: %s", tool_last_error()->subject, tool_last_failure());
    }
    inputs_hold(NULL, 0);
    free(held);
    return result;
}

const char *noh_convert_version(void)
{
    return NOH_VERSION;
}
