/* zoom_run.c: every frame of a zoom drawn twice, with levels and without, and measured. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "zoom.h"
#include "cli/message.h"

#define SAMPLES 4u /* per pixel, of the pictures whose colours are compared */

/* ---- opening ---- */

static int picture_open(zoom_picture *p, uint32_t side)
{
    p->rgba = malloc((size_t)side * side * 4);
    return !p->rgba;
}

static int open_pictures(zoom *z)
{
    const uint32_t side = z->path.side;
    int failed = picture_open(&z->fine_full, side * ZOOM_FINE) || picture_open(&z->fine_kept, side * ZOOM_FINE) ||
                 picture_open(&z->standing, side);
    for (int i = 0; i < 2; i++) {
        failed = failed || picture_open(&z->seen_full[i], side) || picture_open(&z->seen_kept[i], side);
    }
    z->before = calloc(z->path.lod.item_count + 1u, sizeof *z->before);
    failed = failed || !z->before;
    return failed ? tool_fail(z->file->path, "out of memory for pictures of %ux%u", side, side) : 0;
}

int zoom_run_open(zoom *z)
{
    load_options o;
    int status;
    memset(&o, 0, sizeof o);
    status = load_open(&z->full_load, z->g, z->file, z->full, &o);
    o.fades = 1;
    if (!status) status = load_open(&z->kept_load, z->g, z->file, z->kept, &o);
    if (!status) status = load_update(&z->full_load, NULL);
    if (!status) status = zoom_target_open(&z->fine, z->g, z->path.side * ZOOM_FINE, 0);
    if (!status) status = zoom_target_open(&z->seen, z->g, z->path.side, SAMPLES);
    return status ? status : open_pictures(z);
}

void zoom_run_close(zoom *z)
{
    load *loads[2] = { &z->full_load, &z->kept_load };
    for (int i = 0; i < 2; i++) {
        if (loads[i]->g) {
            load_close(loads[i]);
        }
        free(z->seen_full[i].rgba);
        free(z->seen_kept[i].rgba);
    }
    zoom_target_close(&z->fine);
    zoom_target_close(&z->seen);
    zoom_surface_close(&z->surface);
    free(z->fine_full.rgba);
    free(z->fine_kept.rgba);
    free(z->standing.rgba);
    free(z->before);
}

/* ---- choosing ---- */

static int same_lod(const load_lod *a, const load_lod *b)
{
    int same = a->part_count == b->part_count;
    for (uint32_t i = 0; i < a->part_count && same; i++) {
        same = a->parts[i].level == b->parts[i].level && a->parts[i].from == b->parts[i].from &&
               a->parts[i].to == b->parts[i].to;
    }
    return same;
}

/* An item's weights without the targets left out. Returns 1 where they changed since the last frame. */
static int choose_weights(zoom *z, uint32_t item)
{
    const uint32_t count = z->full->meshes[z->full->items[item].mesh].header->target_count;
    const float *weights = z->full->items[item].weights;
    float kept[NOH_TARGETS_MAX];
    const uint32_t left_out = scene_lod_targets(&z->path.lod, item, &z->path.settings, weights, count, kept);
    int changed;
    z->worst.targets_left_out = left_out > z->worst.targets_left_out ? left_out : z->worst.targets_left_out;
    changed = memcmp(kept, z->kept->items[item].weights, sizeof *kept * count) != 0;
    memcpy(z->kept->items[item].weights, kept, sizeof *kept * count);
    return changed;
}

/* What is drawn in this frame, against the one before. */
static void swap_lods(zoom *z)
{
    for (uint32_t i = 0; i < z->path.lod.item_count; i++) {
        const load_lod swap = z->kept_load.lods[i];
        z->kept_load.lods[i] = z->before[i];
        z->before[i] = swap;
    }
}

/* Choose, and hand it to the load. *changed: something is drawn otherwise than before, and z->standing shows from this
 * frame's place what was; *full: nothing is left out. */
static int choose(zoom *z, uint32_t frame, float scale, const noh_gl_camera *camera, int *changed, int *full)
{
    int status = 0;
    *changed = 0;
    *full = 1;
    zoom_path_choose(&z->path, frame, scale);
    for (uint32_t i = 0; i < z->path.lod.item_count; i++) {
        const noh_lod *lod = &z->path.lod.items[i].state;
        const load_lod *now = &z->kept_load.lods[i];
        z->before[i] = *now;
        load_set_lod(&z->kept_load, i, lod, (int64_t)ZOOM_TICKS * frame);
        *changed |= choose_weights(z, i) | !same_lod(&z->before[i], now);
        *full &= now->part_count == 1 && now->parts[0].level == 0 && lod->skipped_m <= 0.0f;
        z->worst.claimed_px = fmax(z->worst.claimed_px, (double)noh_lod_error_pixels(lod));
    }
    if (frame && *changed) {
        swap_lods(z);
        status = zoom_target_draw(&z->seen, &z->kept_load, camera, &z->standing);
        swap_lods(z);
    }
    return status ? status : load_update(&z->kept_load, NULL);
}

/* ---- measuring ---- */

static int measure_positions(zoom *z, float scale)
{
    int status = 0;
    for (uint32_t i = 0; i < z->path.lod.item_count; i++) {
        const load_lod *d = &z->kept_load.lods[i];
        for (uint32_t k = 0; k < d->part_count && !status; k++) {
            double metres = 0.0;
            status = zoom_surface_distance(&z->surface, z->file, z->full, z->kept, i, d->parts[k].level, &metres);
            z->worst.position_px = fmax(z->worst.position_px, metres * (double)scale);
        }
    }
    return status;
}

static int measure_silhouettes(zoom *z, const noh_gl_camera *camera)
{
    zoom_shift shift;
    int status = zoom_target_draw(&z->fine, &z->full_load, camera, &z->fine_full);
    if (!status) status = zoom_target_draw(&z->fine, &z->kept_load, camera, &z->fine_kept);
    if (!status) {
        shift = zoom_compare_silhouettes(&z->fine_full, &z->fine_kept);
        z->worst.silhouette_px = fmax(z->worst.silhouette_px, shift.covered / ZOOM_FINE);
        z->worst.hole_px = fmax(z->worst.hole_px, shift.uncovered / ZOOM_FINE);
    }
    return status;
}

/* Against the frame before; changed: z->standing shows this frame at the levels of the one before. */
static void measure_changes(zoom *z, uint32_t frame, int changed)
{
    const uint32_t now = frame % 2u;
    const double zooms = zoom_compare_colors(&z->seen_full[!now], &z->seen_full[now]);
    const double shows = zoom_compare_colors(&z->seen_kept[!now], &z->seen_kept[now]);
    const double pops = changed ? zoom_compare_colors(&z->standing, &z->seen_kept[now]) : 0.0;
    z->worst.pop = fmax(z->worst.pop, pops);
    z->worst.excess = fmax(z->worst.excess, shows - zooms);
    z->worst.zoom_change += zooms / (z->path.frames - 1u);
}

static void frame_targets(zoom *z)
{
    const double radius = z->path.at.radius, distance = z->path.at.distance;
    const double share = radius / sqrt(distance * distance - radius * radius) / tan(ORBIT_VIEW_RAD / 2.0);
    zoom_target_frame(&z->fine, share);
    zoom_target_frame(&z->seen, share);
}

static int run_frame(zoom *z, uint32_t frame)
{
    const float scale = zoom_path_place(&z->path, frame, 1.0);
    noh_gl_camera camera;
    int changed = 0, full = 0, status;
    orbit_camera(&z->path.at, &camera);
    frame_targets(z);
    status = choose(z, frame, scale, &camera, &changed, &full);
    if (!status) status = zoom_target_draw(&z->seen, &z->full_load, &camera, &z->seen_full[frame % 2u]);
    if (!status) status = zoom_target_draw(&z->seen, &z->kept_load, &camera, &z->seen_kept[frame % 2u]);
    if (!status && !full) status = measure_positions(z, scale);
    if (!status && !full && (changed || frame % z->every == 0)) status = measure_silhouettes(z, &camera);
    if (!status && frame) {
        measure_changes(z, frame, changed);
    }
    return status || !z->strip ? status : zoom_strip_take(z->strip, z, &camera, frame);
}

int zoom_run(zoom *z, double jitter)
{
    int status = 0;
    z->worst.most_entered_shaken = zoom_path_jitter(&z->path, jitter);
    for (uint32_t frame = 0; frame < z->path.frames && !status; frame++) {
        status = run_frame(z, frame);
    }
    z->worst.most_entered = zoom_path_most_entered(&z->path);
    for (int way = 0; way < 2; way++) {
        z->worst.entered[way] = zoom_path_entered(&z->path, way);
    }
    return status;
}

int zoom_result_ok(const zoom_result *r, double pixels)
{
    return r->silhouette_px <= ZOOM_SLACK * pixels && r->position_px <= ZOOM_SLACK * pixels && r->pop <= ZOOM_POP &&
           r->excess <= ZOOM_POP && r->most_entered <= 1 && r->most_entered_shaken <= 1;
}
