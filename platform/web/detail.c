#include "detail.h"

#include <string.h>

#define VIEW_RAD 0.52359878f /* the page's camera is 30 degrees high */

void web_detail_open(web_detail *d, const web_scene *scene)
{
    memset(d, 0, sizeof *d);
    d->level = WEB_DETAIL_AUTO;
    for (uint32_t i = 0; i < scene->pack.mesh_count; i++) {
        noh_detail_table *table = &d->tables[i];
        table->meshes = d->levels[i];
        table->mesh_level_count = noh_detail_mesh_levels(&scene->meshes[i], d->levels[i]);
        d->level_count = table->mesh_level_count > d->level_count ? table->mesh_level_count : d->level_count;
    }
}

/* How far in front of the camera the nearest corner of the item's box is: the last row of the matrix says. */
static float nearest_depth(const web_scene *scene, const web_item *item, const float *matrices, const noh_gl_camera *camera)
{
    const noh_mesh *mesh = &scene->meshes[item->mesh];
    const float *world = web_scene_world(scene, item), *weights = scene->weights + item->first_weight, *m = camera->view_projection;
    float box[6], nearest = 0.0f;
    if (matrices) {
        noh_skin_box(mesh, matrices, weights, box);
    } else {
        noh_mesh_box(mesh, NULL, weights, box);
    }
    for (int corner = 0; corner < 8; corner++) {
        const float x = box[corner & 1 ? 3 : 0], y = box[corner & 2 ? 4 : 1], z = box[corner & 4 ? 5 : 2];
        float depth = m[15];
        for (int r = 0; r < 3; r++) {
            const float *row = world + 4 * r;
            depth += m[4 * r + 3] * (row[0] * x + row[1] * y + row[2] * z + row[3]);
        }
        nearest = corner && nearest < depth ? nearest : depth;
    }
    return nearest;
}

void web_detail_choose(web_detail *d, const web_scene *scene, uint32_t item, const float *matrices, const noh_gl_camera *camera,
                       uint32_t height)
{
    const noh_detail_table *table = &d->tables[scene->items[item].mesh];
    noh_detail *state = &d->states[item];
    uint32_t level = (uint32_t)d->level;
    float scale;
    if (d->level_count < 2) return;
    scale = noh_detail_scale(nearest_depth(scene, &scene->items[item], matrices, camera), VIEW_RAD, height);
    if (d->level == WEB_DETAIL_AUTO) {
        if (!state->started) noh_detail_cut(state); /* what was shown before has no say */
        noh_detail_choose(state, table, &d->settings, scale, NULL, d->clock);
        return;
    }
    level = level < table->mesh_level_count ? level : table->mesh_level_count - 1u;
    memset(state, 0, sizeof *state);
    state->mesh = state->mesh_before = (uint8_t)level;
    state->error_m = table->meshes[level].error_m;
    state->pixels_per_metre = scale;
}

const float *web_detail_weights(web_detail *d, const web_scene *scene, uint32_t item)
{
    const noh_mesh *mesh = &scene->meshes[scene->items[item].mesh];
    const float *weights = scene->weights + scene->items[item].first_weight;
    if (d->level != WEB_DETAIL_AUTO || d->level_count < 2) return weights;
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        d->reach_m[t] = mesh->targets[t].max_displacement * mesh->header->world_scale;
    }
    noh_detail_targets(&d->states[item], &d->settings, weights, d->reach_m, mesh->header->target_count, d->kept);
    return d->kept;
}

uint32_t web_detail_parts(const web_detail *d, uint32_t item, noh_gl_detail parts[2])
{
    const noh_detail *state = &d->states[item];
    const float fade = noh_detail_fade(state, d->clock);
    parts[0] = (noh_gl_detail){state->mesh, 0.0f, fade};
    parts[1] = (noh_gl_detail){state->mesh_before, fade, 1.0f};
    if (fade > 0.0f && fade < 1.0f) return 2;
    parts[0] = (noh_gl_detail){fade < 1.0f ? state->mesh_before : state->mesh, 0.0f, 1.0f};
    return 1;
}

uint32_t web_detail_finest(const web_detail *d, uint32_t item)
{
    noh_gl_detail parts[2];
    const uint32_t count = web_detail_parts(d, item, parts);
    return count == 2 && parts[1].level < parts[0].level ? parts[1].level : parts[0].level;
}
