#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "cmocka.h"

enum { PASSED, FAILED, SKIPPED };

static jmp_buf leave;
static const char *filter;

void cmocka_set_test_filter(const char *text)
{
    filter = text;
}

void print_message(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
}

void print_error(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
}

void cross_skip(void)
{
    longjmp(leave, SKIPPED);
}

void cross_fail(const char *file, int line, const char *format, ...)
{
    va_list arguments;
    printf("# %s:%d: ", file, line);
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
    printf("\n");
    longjmp(leave, FAILED);
}

void cross_same(int same, const char *what, const char *file, int line)
{
    if (!same) cross_fail(file, line, "not true: %s", what);
}

void cross_integers(uint64_t a, uint64_t b, int want_equal, const char *what, const char *file, int line)
{
    if ((a == b) != want_equal) cross_fail(file, line, "not true: %s (%lld, %lld)", what, (long long)a, (long long)b);
}

void cross_texts(const char *a, const char *b, const char *file, int line)
{
    if (strcmp(a, b) != 0) cross_fail(file, line, "'%s' is not '%s'", a, b);
}

void cross_memory(const void *a, const void *b, size_t bytes, const char *file, int line)
{
    const unsigned char *x = a, *y = b;
    for (size_t i = 0; i < bytes; i++) {
        if (x[i] != y[i])
            cross_fail(file, line, "byte %lu of %lu is %u, not %u", (unsigned long)i, (unsigned long)bytes, x[i], y[i]);
    }
}

static int run_one(const struct CMUnitTest *test)
{
    void *state = test->initial_state;
    switch (setjmp(leave)) {
    case PASSED: test->run(&state); return PASSED;
    case SKIPPED: return SKIPPED;
    default: return FAILED;
    }
}

int cross_run(const struct CMUnitTest *tests, size_t count, cross_fixture set_up, cross_fixture tear_down)
{
    void *state = NULL;
    int failures = 0, told = 0;
    if (set_up && set_up(&state)) {
        printf("not ok 1 - set up\n1..1\n");
        return 1;
    }
    for (size_t i = 0; i < count; i++) {
        if (filter && strcmp(filter, tests[i].name) != 0) continue;
        int result = run_one(&tests[i]);
        failures += result == FAILED;
        printf("%sok %d - %s%s\n", result == FAILED ? "not " : "", ++told, tests[i].name,
               result == SKIPPED ? " # SKIP" : "");
    }
    if (tear_down && tear_down(&state)) failures++;
    printf("1..%d\n", told);
    return failures;
}
