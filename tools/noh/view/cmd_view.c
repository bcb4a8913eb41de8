/* cmd_view.c: a pack or a model in a window. view_window.c opens it, or view_without.c reports missing libraries. */
#include <string.h>

#include "view/view_window.h"
#include "gpu/gpu_args.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/verbs.h"

typedef struct view_args {
    const char *path, *accumulate, *driver, *camera, *face, *springs, *play, *tier;
    double frames;
    uint32_t size[2];
    light_options light;
    lighting lit;
    view_run run;
} view_args;

static int check_args(view_args *a)
{
    uint32_t levels;
    int by_error, status = parse_path(a->path, &a->run.desc.morph_path);
    if (!status) status = parse_accumulate(a->accumulate, &a->run.desc.accumulate);
    if (!status && a->run.desc.levels) status = parse_levels(a->run.desc.levels, &levels, &by_error);
    if (status) {
        return status;
    }
    if (a->frames < 0.0 || a->frames > 1e6 || a->frames != (double)(uint32_t)a->frames) {
        return tool_usage("--frames must be a whole number up to 1000000");
    }
    if (a->run.screenshot && a->frames < 1.0) {
        return tool_usage("--screenshot needs --frames N: it is taken after the last frame");
    }
    if (a->run.film && a->frames < 1.0) {
        return tool_usage("--film needs --frames N, the frames to show");
    }
    if (a->run.script && a->frames > 0.0) {
        return tool_usage("--frames has no effect with --script, which counts its own frames");
    }
    if (strcmp(a->driver, "egl") != 0 && strcmp(a->driver, "native") != 0) {
        return tool_usage("--driver must be egl or native, not '%s'", a->driver);
    }
    if (strcmp(a->camera, "follow") != 0 && strcmp(a->camera, "fixed") != 0) {
        return tool_usage("--camera must be follow or fixed, not '%s'", a->camera);
    }
    return 0;
}

static int run(void *args)
{
    view_args *a = args;
    int springs = 1, status = check_args(a);
    if (!status && lighting_wanted(&a->light, NULL, !a->run.desc.show_bones)) {
        status = lighting_open(&a->lit, &a->light);
        a->run.desc.light = &a->lit;
    }
    if (status) {
        return status;
    }
    a->run.frames = (uint32_t)a->frames;
    a->run.plays = !a->run.frames;
    a->run.desc.alive = a->run.plays && !a->run.vmc;
    if ((a->face && tool_switch("--face", a->face, &a->run.desc.alive)) ||
        (a->play && tool_switch("--play", a->play, &a->run.plays)) || tool_switch("--springs", a->springs, &springs)) {
        return EXIT_USAGE;
    }
    a->run.desc.without_springs = !springs;
    if (figure_tier(a->tier, &a->run.desc.shading)) return EXIT_USAGE;
    a->run.fixed_camera = strcmp(a->camera, "fixed") == 0;
    a->run.native = a->driver[0] == 'n';
    a->run.desc.width = a->size[0];
    a->run.desc.height = a->size[1];
    status = view_window_run(&a->run);
    if (a->run.desc.light) lighting_close(&a->lit);
    return status;
}

static view_args arguments;

static const option options[] = {
    OPTION_ANIM(view_args, run.desc.anim, .needs = NULL),
    { .name = "--face",
      .kind = OPTION_TEXT,
      .at = offsetof(view_args, face),
      .value = "on|off",
      .what = "whether faces blink, breathe, and look at the pointer; default: on, off with --frames or --vmc" },
    OPTION_SPRINGS(view_args, springs),
    OPTION_WEIGHT_RULES(view_args, run.desc.weight_rules),
    OPTION_TIER(view_args, tier, .needs = NULL),
    { .name = "--play",
      .kind = OPTION_TEXT,
      .at = offsetof(view_args, play),
      .value = "on|off",
      .what =
          "whether a clip plays at once: idle, or the first clip that moves joints; default: on, off with --frames or --clip" },
    { .name = "--vmc",
      .kind = OPTION_TEXT,
      .at = offsetof(view_args, run.vmc),
      .value = "[ADDRESS:]PORT",
      .what =
          "move the figure as a capture sends it by the VMC protocol, over UDP: bones, root, expressions, ARKit's shapes; from this machine, unless an ADDRESS such as 0.0.0.0 lets others send",
      .example = "39539" },
    { .name = "--clip",
      .kind = OPTION_TEXT,
      .at = offsetof(view_args, run.clip),
      .value = "NAME",
      .what = "play this clip from the start",
      .example = "walk" },
    { .name = "--data",
      .kind = OPTION_TEXT,
      .at = offsetof(view_args, run.data),
      .value = "sums|base|TARGET",
      .what = "the data textures in the panel: accumulated sums, the mesh's base, or a target's deltas; default: sums",
      .example = "jawOpen" },
    { .name = "--camera",
      .kind = OPTION_TEXT,
      .at = offsetof(view_args, camera),
      .value = "follow|fixed",
      .initial = "follow",
      .what = "whether the camera follows a figure that walks over the ground" },
    { .name = "--walk",
      .kind = OPTION_FLAG,
      .at = offsetof(view_args, run.desc.root_motion),
      .what = "show a floor, over which clips move the figure" },
    { .name = "--bones",
      .kind = OPTION_FLAG,
      .at = offsetof(view_args, run.desc.show_bones),
      .what = "draw the skeletons instead of the meshes" },
    { .name = "--lod",
      .kind = OPTION_TEXT,
      .at = offsetof(view_args, run.desc.levels),
      .value = "auto|N",
      .what =
          "number of LOD levels when converting a model, including the full mesh, 1 to 8; auto: up to five, by error",
      .example = "4" },
    OPTIONS_LIGHT(view_args, light, "auto", .needs = NULL),
    OPTION_PATH(view_args, path, .initial = "auto"),
    OPTION_ACCUMULATE(view_args, accumulate, .initial = "auto"),
    { .name = "--driver",
      .kind = OPTION_TEXT,
      .at = offsetof(view_args, driver),
      .value = "egl|native",
      .initial = "egl",
      .what = "how the window creates its GL context" },
    { .name = "--size",
      .kind = OPTION_SIZE,
      .at = offsetof(view_args, size),
      .value = "WxH",
      .initial = "1280x800",
      .what = "size of the window, points, 1 to 8192 each",
      .example = "1600x900" },
    { .name = "--frames",
      .kind = OPTION_NUMBER,
      .at = offsetof(view_args, frames),
      .value = "N",
      .what = "draw this many frames, 1/60 s of clip time apart, and exit; default: run until the window is closed",
      .example = "60" },
    { .name = "--screenshot",
      .kind = OPTION_OUTPUT,
      .at = offsetof(view_args, run.screenshot),
      .value = "OUT.png",
      .what = "write a picture of the last frame",
      .example = "window.png" },
    { .name = "--film",
      .kind = OPTION_OUTPUT,
      .at = offsetof(view_args, run.film),
      .value = "OUT.gif",
      .what =
          "write every second frame of the figure as a film of 30 pictures a second: .gif, .mp4, .webm or .apng with ffmpeg, or numbered .png files",
      .example = "walk.gif",
      .needs = "--frames" },
    { .name = "--presets",
      .kind = OPTION_TEXT,
      .at = offsetof(view_args, run.presets),
      .value = "FILE",
      .what = "text file for your own presets; default: the model's name with .presets",
      .example = "faces.presets" },
    { .name = "--script",
      .kind = OPTION_INPUT,
      .at = offsetof(view_args, run.script),
      .value = "FILE",
      .what =
          "run a script that moves the mouse, presses keys, saves pictures and checks the state frame by frame (noh help FORMATS), then exit",
      .example = "hand.txt" },
};

const verb verb_view = {
    .name = "view",
    .files = "PACK|MODEL",
    .what = "open a window with sliders, presets, clips, levels, light and films; shows files dropped on it",
    .example =
        "head.glb\nbody.noh --clip walk\nbody.noh --frames 60 --screenshot window.png\nbody.noh --clip walk --frames 120 --film walk.gif",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(view_args, run.desc.path),
    .args = &arguments,
    .run = run,
};
