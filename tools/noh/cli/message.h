/* message.h: exit codes and errors. Every error is one line on stderr, "noh: SUBJECT: failure (place)"; with
 * --json the last one is also an object on stdout, {"error": ...}, which main prints. */
#ifndef NOH_NOH_CLI_MESSAGE_H
#define NOH_NOH_CLI_MESSAGE_H

#include "noh/base.h"

#define EXIT_FAILED 1 /* the input or the check failed */
#define EXIT_USAGE 2  /* the command line is wrong */

#ifdef __cplusplus
extern "C" {
#endif

#ifdef __GNUC__
#define MESSAGE_FORMAT(text, first) __attribute__((format(printf, text, first)))
#else
#define MESSAGE_FORMAT(text, first)
#endif

/* Print "noh: subject: text" and return EXIT_FAILED. */
int tool_fail(const char *subject, const char *format, ...) MESSAGE_FORMAT(2, 3);
/* The library's error as a message about `subject`. */
int tool_fail_error(const char *subject, const noh_error *error);
/* Print "noh: text" and a pointer to `noh help`; return EXIT_USAGE. */
int tool_usage(const char *format, ...) MESSAGE_FORMAT(1, 2);

/* "s" after a count of several: printf("%u clip%s", n, plural(n)). */
const char *plural(uint64_t count);

/* The last error. */
typedef struct tool_error {
    int status;                   /* EXIT_FAILED or EXIT_USAGE; 0: there was none */
    noh_result result;            /* NOH_OK: not an error of the library, `where` and `need` mean nothing */
    char subject[512], what[512]; /* cut to fit */
    uint64_t where, need;         /* see noh_error */
} tool_error;

const tool_error *tool_last_error(void);
/* From now on errors are recorded and not printed. */
void tool_errors_quiet(void);
/* Its text; "" before any. */
const char *tool_last_failure(void);

#ifdef __cplusplus
}
#endif

#endif
