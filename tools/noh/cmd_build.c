/* cmd_build.c: glTF, .bvh and .rcl in, one pack out: the model of the first file that has meshes, the clips of all. */
#define _POSIX_C_SOURCE 200809L /* isatty */

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "convert/convert.h"
#include "noh_tool.h"
#include "pack/format.h"

typedef struct build_args {
    const char *inputs[64], *output, *rects, *only, *events, *lod;
    int input_count, quiet, loop, mask, keep_parts, lod_fast;
    double error_um, rate, error_cm, shell_cm, unit_cm, influences, palette;
    option_list dual_quaternion, two_streams, clip_errors, joint_errors;
} build_args;

static int set_motion(const build_args *a, convert_options *o)
{
    if (a->rate < 0.0 || a->rate > 1000.0 || a->error_cm <= 0.0 || a->shell_cm <= 0.0 || a->unit_cm <= 0.0) {
        return tool_usage("--rate wants up to 1000 Hz; --error-cm, --shell-cm and --unit-cm want numbers over 0");
    }
    if (a->only && strcmp(a->only, "mesh") != 0 && strcmp(a->only, "anim") != 0) {
        return tool_usage("--only wants mesh or anim, not '%s'", a->only);
    }
    o->motion.rate_hz = a->rate;
    o->motion.unit_cm = a->unit_cm;
    o->motion.check_loops = a->loop;
    o->motion.clip.error_cm = a->error_cm;
    o->motion.clip.shell_cm = a->shell_cm;
    o->motion.clip.open_loop = a->mask;
    o->motion.clip_errors = (named_errors){ a->clip_errors.items, (uint32_t)a->clip_errors.count };
    o->motion.joint_errors = (named_errors){ a->joint_errors.items, (uint32_t)a->joint_errors.count };
    o->only = !a->only ? CONVERT_ALL : a->only[0] == 'm' ? CONVERT_MESH : CONVERT_MOTION;
    o->events = a->events;
    return 0;
}

static int set_skin(const build_args *a, convert_options *o)
{
    if (a->influences < 1 || a->influences > MODEL_INFLUENCES_MAX || a->influences != (double)(uint32_t)a->influences) {
        return tool_usage("--influences wants a whole number from 1 to %u", MODEL_INFLUENCES_MAX);
    }
    if (a->palette < 4 || a->palette > NOH_PALETTE_JOINTS_MAX || a->palette != (double)(uint32_t)a->palette) {
        return tool_usage("--palette wants a whole number of joints from 4 to %u", NOH_PALETTE_JOINTS_MAX);
    }
    o->skin.influences = (uint32_t)a->influences;
    o->skin.palette = (uint32_t)a->palette;
    o->skin.keep_parts = a->keep_parts;
    o->two_streams = a->two_streams.items;
    o->two_stream_count = (uint32_t)a->two_streams.count;
    o->skin.dual_quaternion = a->dual_quaternion.items;
    o->skin.dual_quaternion_count = (uint32_t)a->dual_quaternion.count;
    return 0;
}

static int set_lod(const build_args *a, convert_options *o)
{
    o->lod.mode = a->lod_fast ? LOD_FAST : LOD_QUALITY;
    return a->lod ? parse_levels(a->lod, &o->lod.level_count, &o->lod.by_error) : 0;
}

static int read_args(int argc, char **argv, build_args *a, convert_options *o)
{
    double rects;
    const option options[] = {
        { "-o", OPTION_TEXT, &a->output }, { "--error-um", OPTION_NUMBER, &a->error_um },
        { "--rects", OPTION_TEXT, &a->rects }, { "--quiet", OPTION_FLAG, &a->quiet },
        { "--rate", OPTION_NUMBER, &a->rate }, { "--error-cm", OPTION_NUMBER, &a->error_cm },
        { "--shell-cm", OPTION_NUMBER, &a->shell_cm }, { "--unit-cm", OPTION_NUMBER, &a->unit_cm },
        { "--loop", OPTION_FLAG, &a->loop }, { "--for-masks", OPTION_FLAG, &a->mask },
        { "--only", OPTION_TEXT, &a->only }, { "--events", OPTION_TEXT, &a->events },
        { "--influences", OPTION_NUMBER, &a->influences }, { "--palette", OPTION_NUMBER, &a->palette },
        { "--dual-quaternion", OPTION_LIST, &a->dual_quaternion }, { "--keep-parts", OPTION_FLAG, &a->keep_parts },
        { "--two-stream", OPTION_LIST, &a->two_streams }, { "--clip-error", OPTION_LIST, &a->clip_errors },
        { "--joint-error", OPTION_LIST, &a->joint_errors }, { "--lod", OPTION_TEXT, &a->lod },
        { "--lod-fast", OPTION_FLAG, &a->lod_fast }
    };
    int status = tool_options(argc, argv, options, sizeof options / sizeof options[0], a->inputs, 64, &a->input_count);
    if (status) {
        return status;
    }
    if (a->input_count == 0 || !a->output) {
        return tool_usage("build wants an input and -o OUT.noh");
    }
    if (a->error_um <= 0.0 || a->error_um > 1e6) {
        return tool_usage("--error-um wants a number over 0 and up to 1000000");
    }
    o->morph.error_um = (float)a->error_um;
    status = set_motion(a, o);
    if (!status) {
        status = set_skin(a, o);
    }
    if (!status) {
        status = set_lod(a, o);
    }
    if (status) {
        return status;
    }
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
    static build_args a;
    convert_options o;
    convert_failure failure;
    noh_error error = { NOH_OK, "", 0, 0 };
    byte_buffer pack = { NULL, 0, 0, 0 };
    int status;
    memset(&a, 0, sizeof a);
    memset(&o, 0, sizeof o);
    a.error_um = 10.0;
    a.error_cm = 0.01;
    a.shell_cm = 3.0;
    a.unit_cm = 1.0;
    a.influences = MODEL_INFLUENCES_MAX;
    a.palette = NOH_PALETTE_JOINTS_MAX;
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
