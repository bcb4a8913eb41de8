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

static void set_look(const figure *f, const noh_appearance *look)
{
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        (void)noh_actor_set_appearance(f->stage, f->actors[k], look, NULL);
    }
}

void view_lod_look(const view_lod *d, const figure *f)
{
    noh_appearance look = { 0 };
    look.wrinkle_models = (uint8_t)d->wrinkle_models;
    look.smoothed = (uint8_t)(255.5f - 255.0f * d->wrinkles);
    if (d->by_pixels) {
        look.pixels = d->pixels;
    } else {
        look.level = 1u + d->level;
    }
    set_look(f, &look);
}

void view_lod_begin(const view_lod *d, view_model *m)
{
    const noh_appearance posed = { .posed = 1 };
    if (m->show_bones) {
        set_look(m->figure, &posed);
    } else {
        view_lod_look(d, m->figure);
    }
}

static uint32_t count_weights(const view_model *m, uint32_t kind)
{
    noh_actor_mesh shown;
    uint32_t count = 0;
    for (uint32_t i = 0; noh_actor_mesh_at(m->figure->stage, m->figure->actors[kind], i, &shown, NULL, NULL) == NOH_OK;
         i++) {
        noh_mesh mesh;
        (void)noh_pack_mesh_at(&m->file.pack, shown.mesh, &mesh, NULL);
        for (uint32_t t = 0; t < mesh.header->target_count; t++) count += shown.weights[t] != 0.0f;
    }
    return count;
}

void view_lod_end(view_lod *d, const view_model *m)
{
    const noh_stage_stats *stats = noh_stage_stats_of(m->figure->stage);
    d->finest = NOH_LOD_LEVELS_MAX;
    d->coarsest = d->weights = 0;
    d->fading = stats->fading;
    d->error_px = stats->error_pixels;
    for (uint32_t level = 0; level < NOH_LOD_LEVELS_MAX; level++) {
        if (!stats->at_level[level]) continue;
        d->finest = level < d->finest ? level : d->finest;
        d->coarsest = level;
    }
    for (uint32_t k = 0; k < m->figure->stage_desc.kind_count; k++) d->weights += count_weights(m, k);
}

void view_lod_text(const view_lod *d, char *text, size_t bytes)
{
    const char *fading = d->fading ? ", fading" : "";
    if (d->finest >= d->coarsest) {
        snprintf(text, bytes, "level %u%s", d->coarsest, fading);
    } else {
        snprintf(text, bytes, "levels %u to %u%s", d->finest, d->coarsest, fading);
    }
}
