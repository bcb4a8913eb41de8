/* main.c: the converter of the page (worker.js): the verbs `build` and `pack` of noh, by the same options. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "cli/message.h"
#include "cli/verbs.h"
#include "convert/base/webp_file.h"

/* Progress is printed, as on a terminal: worker.js reads it. */
int isatty(int descriptor)
{
    return descriptor == 2;
}

/* libwebp is found at run time elsewhere; a page has none. */
int webp_begins(const unsigned char *bytes, size_t count)
{
    return count > 16 && memcmp(bytes, "RIFF", 4) == 0 && memcmp(bytes + 8, "WEBPVP8", 7) == 0;
}

int webp_read(const unsigned char *bytes, size_t count, uint64_t pixels_max, uint32_t *width, uint32_t *height,
              unsigned char **rgba, model_error *error)
{
    (void)bytes;
    (void)count;
    (void)pixels_max;
    (void)width;
    (void)height;
    (void)rgba;
    return model_fail(error, "",
                      "it is a WebP picture, which a page does not convert: noh build does, or save it "
                      "as PNG or JPEG");
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
