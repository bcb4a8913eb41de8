/* cmd_render.c: one picture. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw/drawing.h"
#include "gpu/gpu_args.h"
#include "cli/message.h"
#include "file/png_file.h"
#include "cli/options.h"
#include "cli/report_stream.h"
#include "cli/verbs.h"

typedef struct render_args {
    const char *pack, *output, *anim, *path, *accumulate, *driver, *debug;
    uint32_t size[2];
    double time_s, lod;
    uint32_t level;
    int show_bones;
    option_list weights, clips;
    view_options view;
    load_options load;
} render_args;

static int parse_debug(const char *text, noh_debug_view *view)
{
    static const char *const names[] = { "none", "position", "normal", "tangent", "lod" };
    *view = NOH_VIEW_LIT;
    for (int i = 0; text && i < 5; i++) {
        if (strcmp(text, names[i]) == 0) {
            *view = (noh_debug_view)i;
            return 0;
        }
    }
    return text ? tool_usage("--debug wants none, position, normal, tangent or lod, not '%s'", text) : 0;
}

static int check_args(render_args *a)
{
    int status = parse_path(a->path, &a->load.path);
    if (!status) status = parse_accumulate(a->accumulate, &a->load.accumulate);
    if (!status) status = parse_debug(a->debug, &a->load.view);
    if (!status) status = parse_level(a->lod, &a->level);
    a->view.width = a->size[0];
    a->view.height = a->size[1];
    return status;
}

/* What was drawn: printed once the picture is written. */
typedef struct drawn {
    int bones;
    noh_gl_morph_plan plan; /* without bones */
} drawn;

static void print_done(const render_args *a, const drawn *d)
{
    FILE *out = report_stream(a->output);
    if (d->bones) {
        fprintf(out, "%s: %ux%u, bones\n", a->output, a->size[0], a->size[1]);
        return;
    }
    fprintf(out, "%s: %ux%u, %s-%s (%s)\n", a->output, a->size[0], a->size[1], noh_morph_path_name(d->plan.path),
            noh_accumulate_name(d->plan.accumulate), d->plan.reason);
}

static int draw(gpu *g, const pack_file *file, scene *s, const render_args *a, int show_bones, uint8_t *rgba,
                drawn *done)
{
    drawing d;
    noh_gl_camera camera;
    bounds box = drawing_bounds(s, file, view_wants_face(&a->view), show_bones);
    int status = view_camera(&a->view, &box, &camera);
    if (!status) status = scene_set_level(s, file, a->level);
    if (!status) {
        status = drawing_open(&d, g, file, s, &a->load, show_bones, a->size[0], a->size[1]);
    }
    if (status) {
        return status;
    }
    status = drawing_read(&d, &camera, rgba);
    done->bones = show_bones;
    if (!show_bones) {
        done->plan = *noh_gl_morph_plan_of(d.load.morph.morph);
    }
    drawing_close(&d);
    return status;
}

static int pose_and_draw(const pack_file *file, const render_args *a)
{
    uint8_t *rgba = malloc((size_t)a->size[0] * a->size[1] * 4);
    scene s;
    gpu g;
    drawn d;
    int show_bones, status = rgba ? scene_init(&s, file) : tool_fail(file->path, "out of memory");
    if (!status) {
        show_bones = drawing_shows_bones(&s, file, a->show_bones);
        status = show_bones < 0 ? EXIT_FAILED : scene_open_anim(&s, file, a->anim);
        if (!status && a->clips.count) status = scene_set_clips(&s, file, &a->clips, a->time_s);
        if (!status) status = scene_set_weights(&s, file, &a->weights);
        if (!status) status = gpu_open_drawing(&g, a->driver);
        if (!status) {
            status = draw(&g, file, &s, a, show_bones, rgba, &d);
            gpu_close(&g);
        }
        scene_free(&s);
    }
    if (!status) {
        status = tool_write_png(a->output, a->size[0], a->size[1], rgba);
    }
    if (!status) {
        print_done(a, &d);
    }
    free(rgba);
    return status;
}

static int run(void *args)
{
    render_args *a = args;
    pack_file file;
    int status = check_args(a);
    if (!status) {
        status = pack_file_open(&file, a->pack);
        if (!status) {
            status = pose_and_draw(&file, a);
            pack_file_close(&file);
        }
    }
    return status;
}

static render_args arguments;

static const option options[] = {
    { .name = "-o",
      .kind = OPTION_OUTPUT,
      .at = offsetof(render_args, output),
      .required = 1,
      .value = "OUT.png",
      .what = "the picture",
      .example = "face.png" },
    { .name = "--size",
      .kind = OPTION_SIZE,
      .at = offsetof(render_args, size),
      .value = "WxH",
      .initial = "512x512",
      .what = "size of the picture, pixels, 1 to 8192 each",
      .example = "1280x720" },
    OPTION_WEIGHT(render_args, weights, .excludes = "--bones"),
    OPTION_CLIP(render_args, clips, .needs = NULL),
    OPTION_TIME(render_args, time_s, .needs = "--clip"),
    OPTION_ANIM(render_args, anim, .needs = "--clip"),
    OPTION_CAMERA(render_args, view.camera, "body"),
    OPTION_LOD(render_args, lod, .excludes = "--bones"),
    { .name = "--bones",
      .kind = OPTION_FLAG,
      .at = offsetof(render_args, show_bones),
      .what = "draw the skeletons instead of the meshes; implied where the pack has no meshes" },
    { .name = "--debug",
      .kind = OPTION_TEXT,
      .at = offsetof(render_args, debug),
      .value = "none|position|normal|tangent|lod",
      .initial = "none",
      .what = "show this as colours instead of lighting",
      .excludes = "--bones" },
    OPTION_PATH(render_args, path, .initial = "auto", .excludes = "--bones"),
    OPTION_ACCUMULATE(render_args, accumulate, .initial = "auto", .excludes = "--bones"),
    OPTION_DRIVER(render_args, driver, .initial = "egl"),
};

const verb verb_render = {
    .name = "render",
    .files = "PACK",
    .what = "draw a picture",
    .example = "face.noh -o face.png --weight smile=1 --camera face\nbody.noh -o walk.png --clip walk --time 0.5",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(render_args, pack),
    .args = &arguments,
    .run = run,
};
