/* noh: the command line program. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "noh/base.h"
#include "convert/base/refused_memory.h"
#include "help/help.h"
#include "cli/json.h"
#include "cli/message.h"
#include "cli/verbs.h"

/* The names of enum noh_result, without their prefix. */
static const char *result_name(const tool_error *e)
{
    static const char *const names[] = { "failed", "arg",       "memory",      "data", "version",
                                         "limit",  "not_found", "unsupported", "gl" };
    if (e->status == EXIT_USAGE) {
        return "usage";
    }
    return (size_t)e->result < sizeof names / sizeof names[0] ? names[e->result] : "failed";
}

/* Results whose `where` is a byte or an index, so that 0 means the first. */
static int places(noh_result result)
{
    return result == NOH_ERR_DATA || result == NOH_ERR_NOT_FOUND;
}

/* For a verb that failed before it printed its JSON. */
static void print_error_json(const tool_error *e)
{
    json j = json_begin();
    json_open(&j, "error", '{');
    json_text(&j, "result", result_name(e));
    json_text(&j, "subject", e->subject);
    json_text(&j, "what", e->what);
    if (e->where || places(e->result)) {
        json_integer(&j, "where", e->where);
    } else {
        json_null(&j, "where");
    }
    if (e->need) {
        json_integer(&j, "need", e->need);
    } else {
        json_null(&j, "need");
    }
    json_close(&j, '}');
    (void)json_end(&j);
}

static int asks_for_json(const verb *v, int argc, char **argv)
{
    for (int i = 0; i < argc; i++) {
        if (strcmp(argv[i], "--json") == 0) {
            return args_find(v, "--json") != NULL;
        }
    }
    return 0;
}

static int run_verb(const verb *v, int argc, char **argv)
{
    int status = args_read(v, argc, argv);
    if (status == ARGS_HELP) {
        help_verb(stdout, v);
        return 0;
    }
    if (!status) {
        status = v->run(v->args);
    }
    if (status && tool_last_error()->status && !json_was_printed() && asks_for_json(v, argc, argv)) {
        print_error_json(tool_last_error());
    }
    return status;
}

static int asks_for_help(const char *text)
{
    return strcmp(text, "--help") == 0 || strcmp(text, "-h") == 0;
}

static int run(int argc, char **argv)
{
    const verb *v;
    int count;
    if (argc < 2) {
        help_print(stdout);
        return EXIT_USAGE;
    }
    if (asks_for_help(argv[1])) {
        help_print(stdout);
        return 0;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("noh %s\n", NOH_VERSION);
        return 0;
    }
    if (strcmp(argv[1], "help") == 0) {
        return help_run(argc - 2, argv + 2);
    }
    if (strcmp(argv[1], "lab") == 0 && (argc == 2 || asks_for_help(argv[2]))) {
        help_lab(stdout);
        return argc == 2 ? EXIT_USAGE : 0;
    }
    v = verb_read(argc - 1, argv + 1, &count);
    return v ? run_verb(v, argc - 1 - count, argv + 1 + count) : EXIT_USAGE;
}

int main(int argc, char **argv)
{
    int status, code = 0;
    exit_where_memory_is_refused();
    status = run(argc, argv);
    if (fflush(stdout) || ferror(stdout)) {
        code = errno;
        status = tool_fail("standard output", "cannot write: %s", code ? strerror(code) : "input/output error");
    }
    return status;
}
