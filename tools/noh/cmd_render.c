/* cmd_render.c: one picture. */
#include <stdlib.h>
#include <string.h>

#include "stage.h"

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

static int read_args(int argc, char **argv, render_args *a)
{
    const option options[] = {
        { "-o", OPTION_TEXT, &a->output },          { "--size", OPTION_SIZE, a->size },
        { "--weight", OPTION_LIST, &a->weights },   { "--clip", OPTION_LIST, &a->clips },
        { "--time", OPTION_NUMBER, &a->time_s },    { "--path", OPTION_TEXT, &a->path },
        { "--accumulate", OPTION_TEXT, &a->accumulate }, { "--driver", OPTION_TEXT, &a->driver },
        { "--camera", OPTION_TEXT, &a->view.camera }, { "--debug", OPTION_TEXT, &a->debug },
        { "--anim", OPTION_TEXT, &a->anim },        { "--bones", OPTION_FLAG, &a->show_bones },
        { "--lod", OPTION_NUMBER, &a->lod }
    };
    int count, status = tool_options(argc, argv, options, sizeof options / sizeof options[0], &a->pack, 1, &count);
    if (!status) status = parse_path(a->path, &a->load.path);
    if (!status) status = parse_accumulate(a->accumulate, &a->load.accumulate);
    if (!status) status = parse_debug(a->debug, &a->load.view);
    if (!status) status = parse_level(a->lod, &a->level);
    if (!status && (!a->pack || !a->output)) {
        status = tool_usage("render wants a pack and -o OUT.png");
    }
    a->view.width = a->size[0];
    a->view.height = a->size[1];
    return status;
}

static void print_done(const render_args *a, const stage *st)
{
    const noh_gl_morph_plan *plan;
    if (st->bones) {
        printf("%s: %ux%u, bones\n", a->output, a->size[0], a->size[1]);
        return;
    }
    plan = noh_gl_morph_plan_of(st->load.morph.morph);
    printf("%s: %ux%u, %s-%s (%s)\n", a->output, a->size[0], a->size[1], noh_morph_path_name(plan->path),
           noh_accumulate_name(plan->accumulate), plan->reason);
}

/* The full mesh frames the picture, whatever level is drawn. */
static int draw(gpu *g, const pack_file *file, scene *s, const render_args *a, int show_bones, uint8_t *rgba)
{
    stage st;
    noh_gl_camera camera;
    bounds box = stage_bounds(s, file, view_wants_face(&a->view), show_bones);
    int status = view_camera(&a->view, &box, &camera);
    if (!status) status = scene_set_level(s, file, a->level);
    if (!status) {
        status = stage_open(&st, g, file, s, &a->load, show_bones, a->size[0], a->size[1]);
    }
    if (status) {
        return status;
    }
    status = stage_draw(&st, &camera, rgba);
    if (!status) {
        print_done(a, &st);
    }
    stage_close(&st);
    return status;
}

static int pose_and_draw(const pack_file *file, const render_args *a)
{
    uint8_t *rgba = malloc((size_t)a->size[0] * a->size[1] * 4);
    scene s;
    gpu g;
    int show_bones, status = rgba ? scene_init(&s, file) : tool_fail(file->path, "out of memory");
    if (!status) {
        show_bones = stage_shows_bones(&s, file, a->show_bones);
        status = show_bones < 0 ? EXIT_FAILED : scene_open_anim(&s, file, a->anim);
        if (!status && a->clips.count) status = scene_set_clips(&s, file, &a->clips, a->time_s);
        if (!status) status = scene_set_weights(&s, file, &a->weights);
        if (!status) status = gpu_open(&g, a->driver);
        if (!status) {
            status = draw(&g, file, &s, a, show_bones, rgba);
            gpu_close(&g);
        }
        scene_free(&s);
    }
    if (!status) {
        status = tool_write_png(a->output, a->size[0], a->size[1], rgba);
    }
    free(rgba);
    return status;
}

int verb_render(int argc, char **argv)
{
    static render_args a;
    pack_file file;
    int status;
    memset(&a, 0, sizeof a);
    a.size[0] = a.size[1] = 512;
    status = read_args(argc, argv, &a);
    if (!status) {
        status = pack_file_open(&file, a.pack);
        if (!status) {
            status = pose_and_draw(&file, &a);
            pack_file_close(&file);
        }
    }
    return status;
}
