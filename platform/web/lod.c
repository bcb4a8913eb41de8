#include "lod.h"

#include <string.h>

#define VIEW_RAD 0.52359878f /* the page's camera is 30 degrees high */

void web_lod_open(web_lod *d, const web_scene *scene)
{
    memset(d, 0, sizeof *d);
    d->level = WEB_LOD_AUTO;
    for (uint32_t i = 0; i < scene->pack.mesh_count; i++) {
        noh_lod_table *table = &d->tables[i];
        noh_lod_mesh_levels(&scene->meshes[i], d->levels[i], table);
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
    return noh_lod_depth(camera->view_projection, web_scene_world(scene, item), box);
}

void web_lod_choose(web_lod *d, const web_scene *scene, uint32_t item, const float *matrices,
                    const noh_gl_camera *camera, uint32_t height)
{
    const noh_lod_table *table = &d->tables[scene->items[item].mesh];
    noh_lod *state = &d->states[item];
    float scale;
    if (d->level_count < 2) return;
    scale = noh_lod_scale(depth_of(scene, &scene->items[item], matrices, camera), VIEW_RAD, height);
    if (d->level == WEB_LOD_AUTO) {
        noh_lod_choose(state, table, &d->settings, scale, NULL, d->clock);
    } else {
        noh_lod_set_mesh(state, table, (uint32_t)d->level, scale);
    }
}

const float *web_lod_weights(web_lod *d, const web_scene *scene, uint32_t item)
{
    const noh_mesh *mesh = &scene->meshes[scene->items[item].mesh];
    const float *weights = scene->weights + scene->items[item].first_weight;
    if (d->level != WEB_LOD_AUTO || d->level_count < 2) return weights;
    noh_lod_target_radii(mesh, d->radius_m);
    noh_lod_targets(&d->states[item], &d->settings, weights, d->radius_m, mesh->header->target_count, d->kept);
    return d->kept;
}
