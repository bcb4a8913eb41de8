/* cmd_build.c: glTF in, one pack out. */
#define _POSIX_C_SOURCE 200809L /* isatty */

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "convert/convert.h"
#include "noh_tool.h"

typedef struct build_args {
    const char *inputs[64], *output, *rects;
    int input_count, quiet, json;
    double error_um;
} build_args;

static int read_args(int argc, char **argv, build_args *a, convert_options *o)
{
    double rects;
    const option options[] = {
        { "-o", OPTION_TEXT, &a->output }, { "--error-um", OPTION_NUMBER, &a->error_um },
        { "--rects", OPTION_TEXT, &a->rects }, { "--quiet", OPTION_FLAG, &a->quiet }
    };
    int status = tool_options(argc, argv, options, 4, a->inputs, 64, &a->input_count);
    if (status) {
        return status;
    }
    if (a->input_count == 0 || !a->output) {
        return tool_usage("build wants one input and -o OUT.noh");
    }
    if (a->error_um <= 0.0 || a->error_um > 1e6) {
        return tool_usage("--error-um wants a number over 0 and up to 1000000");
    }
    o->morph.error_um = (float)a->error_um;
    if (a->rects && strcmp(a->rects, "auto") != 0) {
        if (tool_number(a->rects, &rects) || rects < 1 || rects > 65535 || rects != (double)(uint32_t)rects) {
            return tool_usage("--rects wants auto or a whole number from 1 to 65535, not '%s'", a->rects);
        }
        o->morph.rects = (uint32_t)rects;
    }
    return 0;
}

int verb_build(int argc, char **argv)
{
    build_args a;
    convert_options o;
    convert_failure failure;
    noh_error error = { NOH_OK, "", 0, 0 };
    byte_buffer pack = { NULL, 0, 0, 0 };
    int status;
    memset(&a, 0, sizeof a);
    memset(&o, 0, sizeof o);
    a.error_um = 10.0;
    status = read_args(argc, argv, &a, &o);
    if (status) {
        return status;
    }
    o.report = a.quiet ? NULL : stdout;
    o.progress = !a.quiet && isatty(STDERR_FILENO) ? stderr : NULL;
    if (convert_files(a.inputs, a.input_count, &o, &pack, &failure)) {
        return failure.error.where[0] ? tool_fail(failure.file, "%s (%s)", failure.error.what, failure.error.where)
                                      : tool_fail(failure.file, "%s", failure.error.what);
    }
    if (noh_file_write(a.output, pack.bytes, pack.count, &error)) {
        status = tool_fail(a.output, "cannot write: %s", error.what);
    } else if (!a.quiet) {
        printf("%s: %zu bytes\n", a.output, pack.count);
    }
    buffer_free(&pack);
    return status;
}
