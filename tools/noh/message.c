#include <stdarg.h>

#include "noh_tool.h"

static char last_failure[512];

int tool_fail(const char *subject, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fprintf(stderr, "noh: %s: ", subject);
    vfprintf(stderr, format, args);
    fputc('\n', stderr);
    va_end(args);
    va_start(args, format);
    vsnprintf(last_failure, sizeof last_failure, format, args);
    va_end(args);
    return EXIT_FAILED;
}

const char *tool_last_failure(void)
{
    return last_failure;
}

int tool_usage(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fputs("noh: ", stderr);
    vfprintf(stderr, format, args);
    fputs(" (try `noh help`)\n", stderr);
    va_end(args);
    return EXIT_USAGE;
}

int tool_fail_error(const char *subject, const noh_error *error)
{
    switch (error->result) {
    case NOH_ERR_DATA:
        return tool_fail(subject, "%s (byte %llu)", error->what, (unsigned long long)error->where);
    case NOH_ERR_MEMORY:
        return tool_fail(subject, "%s (%llu bytes, %llu needed)", error->what, (unsigned long long)error->where,
                         (unsigned long long)error->need);
    case NOH_ERR_LIMIT:
        return tool_fail(subject, "%s (%llu)", error->what, (unsigned long long)error->need);
    case NOH_ERR_GL:
        return tool_fail(subject, "%s (GL error 0x%llx)", error->what, (unsigned long long)error->where);
    default:
        return tool_fail(subject, "%s (%s)", error->what, noh_result_text(error->result));
    }
}
