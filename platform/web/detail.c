#include "detail.h"

#include <string.h>

#define VIEW_RAD 0.52359878f /* the page's camera is 30 degrees high */

void web_detail_open(web_detail *d, const web_scene *scene)
{
    memset(d, 0, sizeof *d);
    d->level = WEB_DETAIL_AUTO;
    for (uint32_t i = 0; i < scene->pack.mesh_count; i++) {
        noh_detail_table *table = &d->tables[i];
        noh_detail_mesh_levels(&scene->meshes[i], d->levels[i], table);
        d->level_count = table->mesh_level_count > d->level_count ? table->mesh_level_count : d->level_count;
    }
}

static float depth_of(const web_scene *scene, const web_item *item, const float *matrices, const noh_gl_camera *camera)
{
    const noh_mesh *mesh = &scene->meshes[item->mesh];
    const float *weights = scene->weights + item->first_weight;
    float box[6];
    if (matrices) {
        noh_skin_box(mesh, matrices, weights, box);
    } else {
        noh_mesh_box(mesh, NULL, weights, box);
    }
    return noh_detail_depth(camera->view_projection, web_scene_world(scene, item), box);
}

void web_detail_choose(web_detail *d, const web_scene *scene, uint32_t item, const float *matrices, const noh_gl_camera *camera,
                       uint32_t height)
{
    const noh_detail_table *table = &d->tables[scene->items[item].mesh];
    noh_detail *state = &d->states[item];
    float scale;
    if (d->level_count < 2) return;
    scale = noh_detail_scale(depth_of(scene, &scene->items[item], matrices, camera), VIEW_RAD, height);
    if (d->level == WEB_DETAIL_AUTO) {
        noh_detail_choose(state, table, &d->settings, scale, NULL, d->clock);
    } else {
        noh_detail_fix(state, table, (uint32_t)d->level, scale);
    }
}

const float *web_detail_weights(web_detail *d, const web_scene *scene, uint32_t item)
{
    const noh_mesh *mesh = &scene->meshes[scene->items[item].mesh];
    const float *weights = scene->weights + scene->items[item].first_weight;
    if (d->level != WEB_DETAIL_AUTO || d->level_count < 2) return weights;
    noh_detail_target_reach(mesh, d->reach_m);
    noh_detail_targets(&d->states[item], &d->settings, weights, d->reach_m, mesh->header->target_count, d->kept);
    return d->kept;
}
