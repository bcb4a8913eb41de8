#include "view/view_lod.h"

#include <stdio.h>

/* ---- the switch ---- */

void view_lod_level(view_lod *d, uint32_t level)
{
    d->by_pixels = 0;
    d->level = level;
}

void view_lod_pixels(view_lod *d)
{
    d->by_pixels = 1;
}

void view_lod_next(view_lod *d, const view_model *m)
{
    if (m->costs.count < 2) {
        return;
    }
    if (d->by_pixels) {
        view_lod_level(d, 0);
    } else if (d->level + 1u < m->costs.count) {
        view_lod_level(d, d->level + 1u);
    } else {
        view_lod_pixels(d);
    }
}

/* ---- a frame ---- */

static void choose_item(view_lod *d, view_model *m, uint32_t item, float scale)
{
    float *weights = m->scene.items[item].weights;
    if (!d->by_pixels) {
        scene_lod_fix(&m->lod, item, d->level, scale);
        return;
    }
    scene_lod_choose(&m->lod, item, &d->settings, scale, d->clock);
    d->left_out += scene_lod_targets(&m->lod, item, &d->settings, weights,
                                     m->scene.meshes[m->scene.items[item].mesh].header->target_count, weights);
}

static void note_item(view_lod *d, const noh_lod *state)
{
    const float fade = noh_lod_fade(state, d->clock), error_px = noh_lod_error_pixels(state);
    d->finest = state->mesh < d->finest ? state->mesh : d->finest;
    d->coarsest = state->mesh > d->coarsest ? state->mesh : d->coarsest;
    d->fade = fade < d->fade ? fade : d->fade;
    d->error_px = error_px > d->error_px ? error_px : d->error_px;
}

void view_lod_frame(view_lod *d, view_model *m, const orbit *at, double seconds)
{
    noh_gl_camera camera;
    orbit_camera(at, &camera);
    d->clock += (int64_t)(seconds * NOH_TICKS_PER_SECOND);
    d->finest = NOH_LOD_LEVELS_MAX;
    d->coarsest = d->left_out = 0;
    d->fade = 1.0f;
    d->error_px = 0.0f;
    for (uint32_t i = 0; !m->drawing.bones && m->costs.count > 1 && i < m->lod.item_count; i++) {
        choose_item(d, m, i, scene_lod_scale(&m->lod, &m->file, &m->scene, i, &camera, m->drawing.canvas.height));
        note_item(d, &m->lod.items[i].state);
        load_set_lod(&m->drawing.load, i, &m->lod.items[i].state, d->clock);
    }
}

void view_lod_text(const view_lod *d, char *text, size_t bytes)
{
    char fade[32] = "";
    if (d->fade < 1.0f) {
        snprintf(fade, sizeof fade, ", faded in by %.0f %%", 100.0 * (double)d->fade);
    }
    if (d->finest == d->coarsest) {
        snprintf(text, bytes, "level %u%s", d->finest, fade);
    } else {
        snprintf(text, bytes, "levels %u to %u%s", d->finest, d->coarsest, fade);
    }
}
