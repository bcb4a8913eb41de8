/* cmd_view.c: a pack or a model in a window. */
#include <string.h>

#include "view/view_window.h"

typedef struct view_args {
    const char *path, *accumulate, *driver, *lod;
    double frames;
    uint32_t size[2];
    view_run run;
} view_args;

static int check_args(view_args *a)
{
    if (!a->run.desc.path) {
        return tool_usage("view wants a pack or a model");
    }
    if (a->frames < 0.0 || a->frames > 1e6 || a->frames != (double)(uint32_t)a->frames) {
        return tool_usage("--frames wants a whole number up to 1000000");
    }
    if (a->run.screenshot && a->frames < 1.0) {
        return tool_usage("--screenshot wants --frames N, after which it is taken");
    }
    if (a->driver && strcmp(a->driver, "egl") != 0 && strcmp(a->driver, "native") != 0) {
        return tool_usage("--driver wants egl or native, not '%s'", a->driver);
    }
    a->run.frames = (uint32_t)a->frames;
    a->run.native = a->driver && a->driver[0] == 'n';
    a->run.desc.width = a->size[0];
    a->run.desc.height = a->size[1];
    return 0;
}

static int read_args(int argc, char **argv, view_args *a)
{
    const option options[] = {
        { "--anim", OPTION_TEXT, &a->run.desc.anim },        { "--clip", OPTION_TEXT, &a->run.clip },
        { "--path", OPTION_TEXT, &a->path },                 { "--accumulate", OPTION_TEXT, &a->accumulate },
        { "--driver", OPTION_TEXT, &a->driver },             { "--frames", OPTION_NUMBER, &a->frames },
        { "--screenshot", OPTION_TEXT, &a->run.screenshot }, { "--size", OPTION_SIZE, a->size },
        { "--bones", OPTION_FLAG, &a->run.desc.show_bones }, { "--lod", OPTION_TEXT, &a->lod }
    };
    int count, status = tool_options(argc, argv, options, sizeof options / sizeof options[0], &a->run.desc.path, 1, &count);
    if (!status) status = parse_path(a->path, &a->run.desc.load.path);
    if (!status) status = parse_accumulate(a->accumulate, &a->run.desc.load.accumulate);
    if (!status && a->lod) status = parse_levels(a->lod, &a->run.desc.lod.level_count, &a->run.desc.lod.by_error);
    a->run.desc.lod.mode = LOD_FAST; /* conversion stays quick */
    return status ? status : check_args(a);
}

int verb_view(int argc, char **argv)
{
    view_args a;
    int status;
    memset(&a, 0, sizeof a);
    a.size[0] = 1280;
    a.size[1] = 800;
    status = read_args(argc, argv, &a);
    return status ? status : view_window_run(&a.run);
}
