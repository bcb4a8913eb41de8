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

static uint32_t target_count(const figure *f, const noh_actor_mesh *shown)
{
    noh_mesh mesh;
    (void)noh_pack_mesh_at(&f->desc.file->pack, shown->mesh, &mesh, NULL);
    return mesh.header->target_count;
}

/* Over all meshes; at least the number shown. */
static size_t count_weights(const figure *f)
{
    size_t count = 0;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        for (uint32_t i = 0; i < f->kinds[k].node_count; i++) {
            const noh_pack *pack = f->kinds[k].mesh;
            const uint32_t node = f->kinds[k].nodes[i];
            const noh_actor_mesh shown = { .mesh = pack->node_count ? pack->nodes[node].mesh : node };
            count += target_count(f, &shown);
        }
    }
    return count;
}

static int open_pictures(zoom *z)
{
    const uint32_t side = z->path.side;
    int failed = picture_open(&z->fine_full, side * ZOOM_FINE) || picture_open(&z->fine_kept, side * ZOOM_FINE) ||
                 picture_open(&z->standing, side);
    for (int i = 0; i < 2; i++) {
        failed = failed || picture_open(&z->seen_full[i], side) || picture_open(&z->seen_kept[i], side);
    }
    z->weights = calloc(count_weights(&z->kept) + 1u, sizeof *z->weights);
    failed = failed || !z->weights;
    return failed ? tool_fail(z->subject->desc.file->path, "out of memory for pictures of %ux%u", side, side) : 0;
}

int zoom_run_open(zoom *z)
{
    const uint32_t fade_ticks = z->subject->desc.lod.fade_ticks;
    int status = zoom_subject_open(z->subject, z->g, 0, fade_ticks, &z->full);
    if (!status) status = zoom_subject_open(z->subject, z->g, 1, fade_ticks, &z->kept);
    if (!status) status = zoom_target_open(&z->fine, z->g, z->path.side * ZOOM_FINE, 0);
    if (!status) status = zoom_target_open(&z->seen, z->g, z->path.side, SAMPLES);
    return status ? status : open_pictures(z);
}

void zoom_run_close(zoom *z)
{
    for (int i = 0; i < 2; i++) {
        free(z->seen_full[i].rgba);
        free(z->seen_kept[i].rgba);
    }
    if (z->full.stage) figure_close(&z->full);
    if (z->kept.stage) figure_close(&z->kept);
    zoom_target_close(&z->fine);
    zoom_target_close(&z->seen);
    zoom_surface_close(&z->surface);
    free(z->fine_full.rgba);
    free(z->fine_kept.rgba);
    free(z->standing.rgba);
    free(z->weights);
}

/* ---- drawn levels ---- */

/* Compares a frame with the frame before and with the full mesh. */
typedef struct shown_frame {
    int changed;       /* something is drawn otherwise than in the frame before */
    int is_full;       /* nothing is left out */
    uint32_t left_out; /* targets */
} shown_frame;

/* The weights of one mesh, which begin at *first of the zoom's. */
static int take_weights(zoom *z, uint32_t kind, uint32_t index, size_t *first, shown_frame *now)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_actor_mesh full, kept;
    uint32_t count;
    if (noh_actor_mesh_at(z->full.stage, z->full.actors[kind], index, &full, NULL, &error) ||
        noh_actor_mesh_at(z->kept.stage, z->kept.actors[kind], index, &kept, NULL, &error)) {
        return tool_fail_error(z->subject->desc.file->path, &error);
    }
    count = target_count(&z->kept, &kept);
    for (uint32_t t = 0; t < count; t++) {
        now->left_out += full.weights[t] != 0.0f && kept.weights[t] == 0.0f;
    }
    now->changed |= memcmp(z->weights + *first, kept.weights, sizeof *kept.weights * count) != 0;
    memcpy(z->weights + *first, kept.weights, sizeof *kept.weights * count);
    *first += count;
    return 0;
}

/* Fields one by one: the error and the scale change in every frame. */
static int same_detail(const noh_actor_detail *a, const noh_actor_detail *b)
{
    return a->level == b->level && a->level_before == b->level_before && !(a->fade < b->fade || a->fade > b->fade) &&
           a->joint_count == b->joint_count && a->influence_count == b->influence_count;
}

static int take_detail(zoom *z, uint32_t kind, shown_frame *now)
{
    const uint32_t finest = z->full.plan.kinds[kind].finest_level;
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_actor_detail full, kept;
    if (noh_actor_detail_of(z->full.stage, z->full.actors[kind], &full, &error) ||
        noh_actor_detail_of(z->kept.stage, z->kept.actors[kind], &kept, &error)) {
        return tool_fail_error(z->subject->desc.file->path, &error);
    }
    now->changed |= !same_detail(&kept, &z->details[kind]);
    now->is_full &= kept.level == finest && kept.level_before == finest && kept.joint_count == full.joint_count &&
                    kept.influence_count == full.influence_count;
    z->details[kind] = kept;
    z->worst.claimed_px = fmax(z->worst.claimed_px, (double)(kept.error_m * kept.pixels_per_metre));
    return 0;
}

static int take_shown(zoom *z, shown_frame *now)
{
    size_t first = 0;
    int status = 0;
    *now = (shown_frame){ 0, 1, 0 };
    for (uint32_t k = 0; k < z->kept.stage_desc.kind_count && !status; k++) {
        status = take_detail(z, k, now);
        for (uint32_t i = 0; i < z->kept.plan.kinds[k].mesh_count && !status; i++) {
            status = take_weights(z, k, i, &first, now);
        }
    }
    now->is_full &= now->left_out == 0;
    z->worst.targets_left_out = now->left_out > z->worst.targets_left_out ? now->left_out : z->worst.targets_left_out;
    return status;
}

/* ---- measuring ---- */

static int measure_actor(zoom *z, uint32_t kind)
{
    const noh_actor_detail *d = &z->details[kind];
    const uint32_t levels[2] = { d->level, d->level_before };
    int status = 0;
    for (uint32_t l = 0; l < (d->level != d->level_before ? 2u : 1u) && !status; l++) {
        for (uint32_t i = 0; i < z->kept.plan.kinds[kind].mesh_count && !status; i++) {
            const zoom_mesh at = { kind, i, levels[l], d->joint_count };
            double metres = 0.0;
            status = zoom_surface_distance(&z->surface, &z->full, &z->kept, &at, &metres);
            z->worst.position_px = fmax(z->worst.position_px, metres * (double)d->pixels_per_metre);
        }
    }
    return status;
}

static int measure_positions(zoom *z)
{
    int status = 0;
    for (uint32_t k = 0; k < z->kept.stage_desc.kind_count && !status; k++) status = measure_actor(z, k);
    return status;
}

static int measure_silhouettes(zoom *z)
{
    zoom_shift shift;
    int status = zoom_target_draw(&z->fine, &z->full, 0, NULL, &z->fine_full);
    if (!status) status = zoom_target_draw(&z->fine, &z->kept, 0, NULL, &z->fine_kept);
    if (!status) {
        shift = zoom_compare_silhouettes(&z->fine_full, &z->fine_kept);
        z->worst.silhouette_px = fmax(z->worst.silhouette_px, shift.covered / ZOOM_FINE);
        z->worst.hole_px = fmax(z->worst.hole_px, shift.uncovered / ZOOM_FINE);
    }
    return status;
}

/* Against the frame before; changed: something else is drawn than there. */
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

/* After the frame before: draw it from this frame's place, then draw this frame. */
static int show(zoom *z, uint32_t frame, shown_frame *now)
{
    int status = 0;
    zoom_path_place(&z->path, frame, 1.0);
    frame_targets(z);
    if (frame) status = zoom_target_draw(&z->seen, &z->kept, 1, NULL, &z->standing);
    if (!status) status = zoom_path_show(&z->path, frame, 1.0, &z->full);
    if (!status) status = zoom_path_show(&z->path, frame, 1.0, &z->kept);
    if (!status) status = take_shown(z, now);
    if (!status) zoom_path_count(&z->path, frame, &z->kept);
    return status;
}

static int run_frame(zoom *z, uint32_t frame)
{
    shown_frame now;
    int status = show(z, frame, &now);
    if (!status) status = zoom_target_draw(&z->seen, &z->full, 0, NULL, &z->seen_full[frame % 2u]);
    if (!status) status = zoom_target_draw(&z->seen, &z->kept, 0, NULL, &z->seen_kept[frame % 2u]);
    if (!status && !now.is_full) status = measure_positions(z);
    if (!status && !now.is_full && (now.changed || frame % z->every == 0)) status = measure_silhouettes(z);
    if (!status && frame) {
        measure_changes(z, frame, now.changed);
    }
    return status || !z->strip ? status : zoom_strip_take(z->strip, z, frame);
}

int zoom_run(zoom *z, double jitter)
{
    int status = zoom_path_jitter(&z->path, jitter, &z->worst.most_entered_shaken);
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
