#include "view/view_undo.h"

#include <stdlib.h>
#include <string.h>

#include "view/view_app.h"
#include "view/view_lights.h"

/* Everything but the targets. Compared as bytes: zeroed before it is filled. */
typedef struct settings {
    noh_morph_path path;
    noh_accumulate accumulate;
    noh_debug_view view;
    view_over over;
    view_compare_how compare;
    char light[VIEW_LIGHT_NAME];
    double degrees;
    lighting_background background;
    noh_tonemap tonemap;
    float lod_pixels, wrinkles;
    uint32_t lod_level;
    int lod_by_pixels, wrinkle_models, show_bones, show_floor, follow;
} settings;

typedef struct held_weight {
    float value;
    int held;
} held_weight;

typedef struct step {
    settings set;
    uint32_t count;
    held_weight targets[]; /* [count] */
} step;

static size_t bytes_of(uint32_t targets)
{
    return sizeof(step) + targets * sizeof(held_weight);
}

static step *capture(const view_app *a)
{
    const view_model *m = a->model;
    const lighting *light = a->desc.light;
    step *s = calloc(1, bytes_of(m->target_count));
    if (!s) return NULL;
    s->set.path = a->desc.morph_path;
    s->set.accumulate = a->desc.accumulate;
    s->set.view = a->desc.view;
    s->set.show_bones = a->desc.show_bones;
    s->set.over = a->over;
    s->set.compare = a->compare.how;
    memcpy(s->set.light, a->lights.name, sizeof s->set.light);
    s->set.degrees = light ? light->degrees : 0.0;
    s->set.background = light ? light->background : BACKGROUND_PLAIN;
    s->set.tonemap = light ? light->told.tonemap : NOH_TONEMAP_NONE;
    s->set.lod_pixels = a->lod.pixels;
    s->set.lod_level = a->lod.level;
    s->set.lod_by_pixels = a->lod.by_pixels;
    s->set.wrinkles = a->lod.wrinkles;
    s->set.wrinkle_models = a->lod.wrinkle_models;
    s->set.show_floor = a->ground.shown;
    s->set.follow = a->camera.follow;
    s->count = m->target_count;
    for (uint32_t t = 0; t < m->target_count; t++) {
        s->targets[t].held = m->targets[t].held;
        s->targets[t].value = m->targets[t].held ? m->targets[t].value : 0.0f;
    }
    return s;
}

void view_undo_note(view_app *a)
{
    view_undo_list *u = &a->undo;
    step *now = a->request.reload ? NULL : capture(a);
    if (!now) return;
    if (u->count && memcmp(u->steps[u->at], now, bytes_of(now->count)) == 0) {
        free(now);
        return;
    }
    while (u->count > u->at + 1u) free(u->steps[--u->count]); /* what was undone is not done again after this */
    if (u->count == VIEW_UNDO_MAX) {
        free(u->steps[0]);
        memmove(u->steps, u->steps + 1, (VIEW_UNDO_MAX - 1u) * sizeof u->steps[0]);
        u->count--;
    }
    u->at = u->count;
    u->steps[u->count++] = now;
}

static void set_targets(view_model *m, const step *s)
{
    for (uint32_t t = 0; t < m->target_count && t < s->count; t++) {
        if (s->targets[t].held)
            view_target_hold(&m->targets[t], s->targets[t].value);
        else
            view_target_let_go(&m->targets[t]);
    }
}

static void apply(view_app *a, const step *s)
{
    view_model_desc *wish = &a->request.desc;
    lighting *light;
    set_targets(a->model, s);
    a->over = s->set.over;
    a->compare.how = s->set.compare;
    a->lod.pixels = s->set.lod_pixels;
    a->lod.level = s->set.lod_level;
    a->lod.by_pixels = s->set.lod_by_pixels;
    a->lod.wrinkles = s->set.wrinkles;
    a->lod.wrinkle_models = s->set.wrinkle_models;
    a->ground.shown = s->set.show_floor;
    a->camera.follow = s->set.follow;
    if (strcmp(s->set.light, a->lights.name) != 0) view_light_choose(a, s->set.light);
    light = a->request.desc.light;
    if (light) {
        lighting_turn(light, s->set.degrees, a->camera.facing);
        light->background = s->set.background;
        light->told.tonemap = s->set.tonemap;
    }
    a->request.reload |= wish->morph_path != s->set.path || wish->accumulate != s->set.accumulate ||
                         wish->view != s->set.view || wish->show_bones != s->set.show_bones;
    wish->morph_path = s->set.path;
    wish->accumulate = s->set.accumulate;
    wish->view = s->set.view;
    wish->show_bones = s->set.show_bones;
}

static int go_to(view_app *a, uint32_t at)
{
    view_undo_list *u = &a->undo;
    if (at >= u->count) return 0;
    u->at = at;
    apply(a, u->steps[at]);
    return 1;
}

int view_undo(view_app *a)
{
    view_undo_note(a);
    return go_to(a, a->undo.at - 1u); /* past the last where it is the first */
}

int view_redo(view_app *a)
{
    view_undo_note(a);
    return go_to(a, a->undo.at + 1u);
}

void view_undo_forget(view_undo_list *u)
{
    while (u->count) free(u->steps[--u->count]);
    u->at = 0;
}
