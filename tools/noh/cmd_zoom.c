/* cmd_zoom.c: a slow zoom out and in, drawn at chosen levels of detail and beside it at the full one, and measured:
 * nothing of the levels may show. */
#include <stdlib.h>
#include <string.h>

#include "zoom.h"

#define FADE_TICKS 12000 /* a quarter of a second */

typedef struct zoom_args {
    const char *pack, *output, *anim, *driver;
    double frames, near, far, pixels, time_s, jitter, every;
    uint32_t size[2];
    int as_json, no_fades;
    option_list weights, clips;
} zoom_args;

/* ---- telling ---- */

static void print_result(const zoom *z, const zoom_args *a)
{
    const zoom_result *r = &z->worst;
    const double most = ZOOM_SLACK * a->pixels;
    printf("%s: %u frames from %.3g to %.3g m and back, %ux%u, knob %g pixels\n", a->pack, z->path.frames, z->path.near, z->path.far, z->path.side,
           z->path.side, a->pixels);
    printf("  silhouettes off by at most   %6.3f pixels  (allowed: %g), slits and holes by %.3f\n", r->silhouette_px, most, r->hole_px);
    printf("  the surface off by at most   %6.3f pixels  (allowed: %g), claimed %.3f\n", r->position_px, most, r->claimed_px);
    printf("  changed by detail in a frame %6.3f of 255  (allowed: %g), by the zoom %.3f\n", r->pop, ZOOM_POP, r->zoom_change);
    printf("  frame to frame more by       %6.3f of 255 than full pictures  (allowed: %g)\n", r->excess, ZOOM_POP);
    printf("  levels entered: %u out, %u in, each at most %u times; %u times from a camera that shakes by %g %%  (allowed: once)\n", r->entered[0],
           r->entered[1], r->most_entered, r->most_entered_shaken, 100.0 * a->jitter);
    printf("  targets left out: at most %u at once\n", r->targets_left_out);
    printf("%s: %s\n", a->pack, zoom_result_ok(r, a->pixels) ? "ok" : "FAILED");
}

static void print_json(const zoom *z, const zoom_args *a)
{
    const zoom_result *r = &z->worst;
    json j = json_begin(stdout);
    json_integer(&j, "frames", z->path.frames);
    json_integer(&j, "size", z->path.side);
    json_number(&j, "near", z->path.near);
    json_number(&j, "far", z->path.far);
    json_number(&j, "pixels", a->pixels);
    json_number(&j, "silhouette_px", r->silhouette_px);
    json_number(&j, "hole_px", r->hole_px);
    json_number(&j, "position_px", r->position_px);
    json_number(&j, "claimed_px", r->claimed_px);
    json_number(&j, "pop", r->pop);
    json_number(&j, "excess", r->excess);
    json_number(&j, "zoom_change", r->zoom_change);
    json_integer(&j, "levels_out", r->entered[0]);
    json_integer(&j, "levels_in", r->entered[1]);
    json_integer(&j, "most_entered", r->most_entered);
    json_integer(&j, "most_entered_shaken", r->most_entered_shaken);
    json_integer(&j, "targets_left_out", r->targets_left_out);
    json_bool(&j, "ok", zoom_result_ok(r, a->pixels));
    json_end(&j);
}

/* ---- doing ---- */

static int measure(zoom *z, const zoom_args *a)
{
    zoom_strip strip;
    int status = zoom_run_open(z);
    if (!status && a->output) {
        z->strip = &strip;
        status = zoom_strip_open(&strip, z);
    }
    if (!status) status = zoom_run(z, a->jitter);
    if (!status && a->output) status = zoom_strip_write(&strip, a->output);
    if (z->strip) {
        zoom_strip_close(&strip);
    }
    zoom_run_close(z);
    if (!status) {
        (a->as_json ? print_json : print_result)(z, a);
    }
    return status ? status : zoom_result_ok(&z->worst, a->pixels) ? 0 : EXIT_FAILED;
}

static int open_scene(scene *s, const pack_file *file, const zoom_args *a)
{
    int status = scene_init(s, file);
    if (!status) status = scene_open_anim(s, file, a->anim);
    if (!status && a->clips.count) status = scene_set_clips(s, file, &a->clips, a->time_s);
    return status ? status : scene_set_weights(s, file, &a->weights);
}

static int zoom_pack(const pack_file *file, const zoom_args *a)
{
    /* shares are the library's own; the others are here because the way is planned by them */
    const noh_detail_settings settings = { (float)a->pixels, { 0.3f, 0.1f, 0.05f, 0.1f, 0.45f }, 0.3f, 0.15f, a->no_fades ? 1 : FADE_TICKS };
    scene full, kept;
    gpu g;
    zoom z;
    int status;
    memset(&z, 0, sizeof z);
    memset(&full, 0, sizeof full);
    memset(&kept, 0, sizeof kept);
    z.file = file;
    z.g = &g;
    z.every = (uint32_t)a->every;
    z.full = &full;
    z.kept = &kept;
    status = open_scene(&full, file, a);
    if (!status) status = open_scene(&kept, file, a);
    if (!status) status = zoom_path_open(&z.path, file, &full, &settings, a->near, a->far, a->size[0], (uint32_t)a->frames);
    if (!status) status = gpu_open(&g, a->driver);
    if (!status) {
        status = measure(&z, a);
        gpu_close(&g);
    }
    zoom_path_close(&z.path);
    scene_free(&full);
    scene_free(&kept);
    return status;
}

static int check_args(const zoom_args *a)
{
    if (!a->pack) {
        return tool_usage("zoom wants a pack");
    }
    if (!(a->frames >= 4.0 && a->frames <= 100000.0) || a->frames != (double)(uint32_t)a->frames) {
        return tool_usage("--frames wants a whole number from 4 to 100000");
    }
    if (!(a->pixels > 0.0 && a->pixels <= 100.0)) {
        return tool_usage("--pixels wants a number above 0, up to 100");
    }
    if (!(a->every >= 1.0 && a->every <= 100000.0) || a->every != (double)(uint32_t)a->every) {
        return tool_usage("--every wants a whole number from 1 to 100000");
    }
    if (!(a->jitter >= 0.0 && a->jitter < 1.0)) {
        return tool_usage("--jitter wants a number from 0, below 1");
    }
    if (a->size[0] != a->size[1] || a->size[0] > 8192u / ZOOM_FINE || a->size[0] % 2u) {
        return tool_usage("--size wants a square with an even side of at most %u", 8192u / ZOOM_FINE);
    }
    return 0;
}

int verb_zoom(int argc, char **argv)
{
    static zoom_args a;
    const option options[] = {
        { "-o", OPTION_TEXT, &a.output },          { "--frames", OPTION_NUMBER, &a.frames },
        { "--near", OPTION_NUMBER, &a.near },      { "--far", OPTION_NUMBER, &a.far },
        { "--pixels", OPTION_NUMBER, &a.pixels },  { "--size", OPTION_SIZE, a.size },
        { "--weight", OPTION_LIST, &a.weights },   { "--clip", OPTION_LIST, &a.clips },
        { "--time", OPTION_NUMBER, &a.time_s },    { "--anim", OPTION_TEXT, &a.anim },
        { "--jitter", OPTION_NUMBER, &a.jitter },  { "--no-fades", OPTION_FLAG, &a.no_fades },
        { "--driver", OPTION_TEXT, &a.driver },    { "--json", OPTION_FLAG, &a.as_json },
        { "--every", OPTION_NUMBER, &a.every }
    };
    pack_file file;
    int count, status;
    memset(&a, 0, sizeof a);
    a.frames = 600.0;
    a.pixels = 1.0;
    a.jitter = 0.03;
    a.every = 1.0;
    status = tool_options(argc, argv, options, sizeof options / sizeof options[0], &a.pack, 1, &count);
    if (!status) status = check_args(&a);
    if (!status) status = pack_file_open(&file, a.pack);
    if (!status) {
        status = zoom_pack(&file, &a);
        pack_file_close(&file);
    }
    return status;
}
