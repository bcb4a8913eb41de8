#include "message.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static tool_error last;
static int is_quiet;

void tool_errors_quiet(void)
{
    is_quiet = 1;
}

static void print(const char *subject, const char *format, va_list args, const char *end)
{
    if (is_quiet) return;
    fputs("noh: ", stderr);
    if (subject) fprintf(stderr, "%s: ", subject);
    vfprintf(stderr, format, args);
    fputs(end, stderr);
}

static void record(int status, const char *subject, const char *format, va_list args)
{
    memset(&last, 0, sizeof last);
    last.status = status;
    snprintf(last.subject, sizeof last.subject, "%s", subject);
    vsnprintf(last.what, sizeof last.what, format, args);
}

int tool_fail(const char *subject, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    print(subject, format, args, "\n");
    va_end(args);
    va_start(args, format);
    record(EXIT_FAILED, subject, format, args);
    va_end(args);
    return EXIT_FAILED;
}

int tool_usage(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    print(NULL, format, args, " (try `noh help`)\n");
    va_end(args);
    va_start(args, format);
    record(EXIT_USAGE, "command line", format, args);
    va_end(args);
    return EXIT_USAGE;
}

const tool_error *tool_last_error(void)
{
    return &last;
}

const char *tool_last_failure(void)
{
    return last.what;
}

static int print_error(const char *subject, const noh_error *error, const char *what)
{
    unsigned long long where = error->where, need = error->need;
    switch (error->result) {
    case NOH_ERR_DATA: return tool_fail(subject, "%s (byte %llu)", what, where);
    case NOH_ERR_MEMORY: return tool_fail(subject, "%s (%llu bytes, %llu needed)", what, where, need);
    case NOH_ERR_VERSION: return tool_fail(subject, "%s (this noh reads version %llu)", what, need);
    case NOH_ERR_LIMIT: return tool_fail(subject, "%s (%llu)", what, need);
    case NOH_ERR_GL: return tool_fail(subject, "%s (GL error 0x%llx)", what, where);
    default: return tool_fail(subject, "%s (%s)", what, noh_result_text(error->result));
    }
}

int tool_fail_error(const char *subject, const noh_error *error)
{
    const char *what = error->what ? error->what : noh_result_text(error->result);
    print_error(subject, error, what);
    snprintf(last.what, sizeof last.what, "%s", what);
    last.result = error->result;
    last.where = error->where;
    last.need = error->need;
    return EXIT_FAILED;
}

const char *plural(uint64_t count)
{
    return count == 1 ? "" : "s";
}
