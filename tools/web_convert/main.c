/* main.c: the converter of the page (worker.js): the verbs `build` and `pack` of noh, by the same options. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "cli/message.h"
#include "cli/verbs.h"

/* Progress is printed, as on a terminal: worker.js reads it. */
int isatty(int descriptor)
{
    return descriptor == 2;
}

static int run(const verb *v, int argc, char **argv)
{
    const int status = args_read(v, argc, argv);
    return status ? EXIT_USAGE : v->run(v->args);
}

int main(int argc, char **argv)
{
    int status = EXIT_USAGE;
    if (argc > 1 && strcmp(argv[1], "build") == 0)
        status = run(&verb_build, argc - 2, argv + 2);
    else if (argc > 1 && strcmp(argv[1], "pack") == 0)
        status = run(&verb_pack, argc - 2, argv + 2);
    else
        (void)tool_usage("build or pack, and their arguments");
    return fflush(stdout) || fflush(stderr) ? EXIT_FAILED : status;
}
