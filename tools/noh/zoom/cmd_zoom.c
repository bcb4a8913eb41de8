/* cmd_zoom.c: a slow zoom out and back, drawn at the chosen LOD levels and in full, and compared: the levels must not
 * be visible. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "zoom.h"
#include "cli/json.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/report_stream.h"
#include "cli/verbs.h"

#define FADE_TICKS 12000 /* a quarter of a second */

typedef struct zoom_args {
    const char *pack, *output, *anim, *driver;
    double frames, near, far, pixels, time_s, jitter, every;
    uint32_t size[2];
    int as_json, no_fades;
    option_list weights, clips;
} zoom_args;

/* ---- printing ---- */

static int print_result(const zoom *z, const zoom_args *a)
{
    FILE *out = report_stream(a->output);
    const zoom_result *r = &z->worst;
    const double most = ZOOM_SLACK * a->pixels;
    fprintf(out, "%s: %u frames from %.3g to %.3g m and back, %ux%u, %g pixels allowed\n", a->pack, z->path.frames,
            z->path.near, z->path.far, z->path.side, z->path.side, a->pixels);
    fprintf(out, "  largest silhouette error     %6.3f pixels  (allowed: %g), slits and holes %.3f\n", r->silhouette_px,
            most, r->hole_px);
    fprintf(out, "  largest surface error        %6.3f pixels  (allowed: %g), claimed %.3f\n", r->position_px, most,
            r->claimed_px);
    fprintf(out, "  a level change alters        %6.3f of 255  (allowed: %g), the zoom itself %.3f\n", r->pop, ZOOM_POP,
            r->zoom_change);
    fprintf(out, "  extra change between frames  %6.3f of 255  (allowed: %g), compared with the full mesh\n", r->excess,
            ZOOM_POP);
    fprintf(
        out,
        "  levels entered               %u out, %u back; each at most %u times  (allowed: 1), %u with a camera shaken by %g %%\n",
        r->entered[0], r->entered[1], r->most_entered, r->most_entered_shaken, 100.0 * a->jitter);
    fprintf(out, "  targets left out             %u at once, at most\n", r->targets_left_out);
    fprintf(out, "%s: %s\n", a->pack, zoom_result_ok(r, a->pixels) ? "ok" : "FAILED");
    return 0;
}

static int print_json(const zoom *z, const zoom_args *a)
{
    const zoom_result *r = &z->worst;
    json j = json_begin();
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
    return json_end(&j);
}

/* ---- measuring ---- */

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
    if (z->strip) zoom_strip_close(&strip);
    zoom_run_close(z);
    if (!status) {
        status = (a->as_json ? print_json : print_result)(z, a);
    }
    return status ? status : zoom_result_ok(&z->worst, a->pixels) ? 0 : EXIT_FAILED;
}

static int zoom_subject_of(const zoom_subject *subject, const zoom_args *a)
{
    gpu g;
    zoom z;
    int status;
    memset(&z, 0, sizeof z);
    z.subject = subject;
    z.g = &g;
    z.every = (uint32_t)a->every;
    status = zoom_path_open(&z.path, subject, a->near, a->far, a->size[0], (uint32_t)a->frames);
    if (!status) status = gpu_open_drawing(&g, a->driver);
    if (!status) {
        status = measure(&z, a);
        gpu_close(&g);
    }
    zoom_path_close(&z.path);
    return status;
}

static int zoom_pack(const pack_file *file, const zoom_args *a)
{
    zoom_subject s = { .clips = &a->clips, .weights = &a->weights, .time_s = a->time_s };
    pack_file anim;
    int status = 0;
    s.desc.file = file;
    s.desc.track_count = (uint32_t)a->clips.count;
    s.desc.held_float_count = (uint32_t)a->weights.count;
    /* the library's defaults, spelt out because the path is planned by them */
    s.desc.lod = (noh_lod_settings){
        (float)a->pixels, { 0.3f, 0.1f, 0.05f, 0.1f, 0.45f }, 0.3f, 0.15f, a->no_fades ? 1 : FADE_TICKS
    };
    if (a->clips.count) status = figure_open_clips(&anim, a->anim, file, &s.desc.clips);
    if (!status) status = zoom_subject_of(&s, a);
    if (s.desc.clips) figure_close_clips(&anim, s.desc.clips);
    return status;
}

static int check_args(const zoom_args *a)
{
    if (!(a->frames >= 4.0 && a->frames <= 100000.0) || a->frames != (double)(uint32_t)a->frames) {
        return tool_usage("--frames must be a whole number from 4 to 100000");
    }
    if (!(a->pixels > 0.0 && a->pixels <= 100.0)) {
        return tool_usage("--pixels must be a number above 0, up to 100");
    }
    if (!(a->every >= 1.0 && a->every <= 100000.0) || a->every != (double)(uint32_t)a->every) {
        return tool_usage("--every must be a whole number from 1 to 100000");
    }
    if (!(a->jitter >= 0.0 && a->jitter < 1.0)) {
        return tool_usage("--jitter must be a number from 0, below 1");
    }
    if (a->size[0] != a->size[1] || a->size[0] > 8192u / ZOOM_FINE || a->size[0] % 2u) {
        return tool_usage("--size must be a square with an even side of at most %u", 8192u / ZOOM_FINE);
    }
    if (a->clips.count > (int)NOH_LAYER_TRACKS_MAX) {
        return tool_usage("--clip may be given at most %u times", NOH_LAYER_TRACKS_MAX);
    }
    return 0;
}

static int run(void *args)
{
    const zoom_args *a = args;
    pack_file file;
    int status = check_args(a);
    if (!status) status = pack_file_open(&file, a->pack);
    if (!status) {
        status = zoom_pack(&file, a);
        pack_file_close(&file);
    }
    return status;
}

static zoom_args arguments;

static const option options[] = {
    { .name = "-o",
      .kind = OPTION_OUTPUT,
      .at = offsetof(zoom_args, output),
      .value = "OUT.png",
      .what = "a strip of twelve frames: with LOD levels, in full, and coloured by level",
      .example = "zoom.png" },
    { .name = "--frames",
      .kind = OPTION_NUMBER,
      .at = offsetof(zoom_args, frames),
      .value = "N",
      .initial = "600",
      .what = "frames out and back, 4 to 100000, 60 a second",
      .example = "120" },
    { .name = "--pixels",
      .kind = OPTION_NUMBER,
      .at = offsetof(zoom_args, pixels),
      .value = "N",
      .initial = "1",
      .what = "the largest error that LOD levels may have on screen, pixels, over 0, at most 100",
      .example = "2" },
    { .name = "--near",
      .kind = OPTION_NUMBER,
      .at = offsetof(zoom_args, near),
      .value = "M",
      .what =
          "nearest distance from the camera to the middle of the scene, metres; default: one that shows every level for a while",
      .example = "0.5" },
    { .name = "--far",
      .kind = OPTION_NUMBER,
      .at = offsetof(zoom_args, far),
      .value = "M",
      .what = "farthest distance, metres; default: as for --near",
      .example = "20" },
    { .name = "--size",
      .kind = OPTION_SIZE,
      .at = offsetof(zoom_args, size),
      .value = "NxN",
      .what = "size of the pictures, pixels, square and even, at most 2048; default: large enough for the scene",
      .example = "512x512" },
    OPTION_WEIGHT(zoom_args, weights, .needs = NULL),
    OPTION_CLIP(zoom_args, clips, .needs = NULL),
    OPTION_TIME(zoom_args, time_s, .needs = "--clip"),
    OPTION_ANIM(zoom_args, anim, .needs = "--clip"),
    { .name = "--every",
      .kind = OPTION_NUMBER,
      .at = offsetof(zoom_args, every),
      .value = "N",
      .initial = "1",
      .what = "measure silhouettes only in every N-th frame, 1 to 100000, and at each change of level",
      .example = "8" },
    { .name = "--jitter",
      .kind = OPTION_NUMBER,
      .at = offsetof(zoom_args, jitter),
      .value = "X",
      .initial = "0.03",
      .what = "how far a second camera shakes, as a share of its distance, 0 to below 1",
      .example = "0.1" },
    { .name = "--no-fades", .kind = OPTION_FLAG, .at = offsetof(zoom_args, no_fades), .what = "change levels at once" },
    OPTION_DRIVER(zoom_args, driver, .initial = "egl"),
    OPTION_JSON(zoom_args, as_json),
};

const verb verb_zoom = {
    .name = "lab zoom",
    .files = "PACK|MODEL",
    .what = "compare LOD levels with the full mesh in a slow zoom out and back: silhouettes, surfaces, pops, flicker",
    .more =
        "Fails (exit code 1) if silhouettes or the surface are off by more than 1.25 times --pixels, if a change of level is visible, or if a level is entered twice on the way out or on the way back.",
    .example = "face.noh -o zoom.png\nface.noh --frames 120 --pixels 2 --json",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(zoom_args, pack),
    .args = &arguments,
    .run = run,
};
