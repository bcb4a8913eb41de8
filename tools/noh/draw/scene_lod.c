#include "scene_lod.h"

#include <stdlib.h>
#include <string.h>

#include "camera.h"
#include "cli/message.h"

static int open_item(item_lod *item, const noh_mesh *mesh)
{
    const uint32_t targets = mesh->header->target_count;
    noh_lod_mesh_levels(mesh, item->levels, &item->table);
    item->radius_m = calloc(targets + 1u, sizeof *item->radius_m);
    if (item->radius_m) {
        noh_lod_target_radii(mesh, item->radius_m);
    }
    return !item->radius_m;
}

static uint32_t most_joints(const pack_file *file)
{
    uint32_t most = 0;
    noh_skin skin;
    for (uint32_t i = 0; noh_pack_skin_at(&file->pack, i, &skin, NULL) == NOH_OK; i++) {
        most = skin.header->joint_count > most ? skin.header->joint_count : most;
    }
    return most;
}

int scene_lod_open(scene_lod *d, const pack_file *file, const scene *s)
{
    int failed;
    memset(d, 0, sizeof *d);
    d->items = calloc(s->item_count + 1u, sizeof *d->items);
    d->matrices = calloc(most_joints(file) + 1u, 12 * sizeof(float));
    failed = !d->items || !d->matrices;
    for (; d->item_count < s->item_count && !failed; d->item_count++) {
        failed = open_item(&d->items[d->item_count], &s->meshes[s->items[d->item_count].mesh]);
    }
    return failed ? tool_fail(file->path, "out of memory") : 0;
}

void scene_lod_close(scene_lod *d)
{
    for (uint32_t i = 0; i < d->item_count; i++) {
        free(d->items[i].radius_m);
    }
    free(d->items);
    free(d->matrices);
    memset(d, 0, sizeof *d);
}

/* Bounds of an item in its pose, before its node's transform. */
static void item_box(const scene_lod *d, const scene *s, uint32_t item, float box[6])
{
    const noh_mesh *mesh = &s->meshes[s->items[item].mesh];
    const float *weights = s->items[item].weights;
    noh_skin skin;
    if (noh_pack_skin_at(mesh->pack, mesh->header->skin, &skin, NULL)) {
        noh_mesh_box(mesh, NULL, weights, box);
        return;
    }
    scene_skin_matrices(s, &skin, d->matrices);
    noh_skin_box(mesh, d->matrices, weights, box);
}

float scene_lod_scale(const scene_lod *d, const pack_file *file, const scene *s, uint32_t item,
                      const noh_gl_camera *camera, uint32_t height)
{
    float box[6];
    item_box(d, s, item, box);
    return noh_lod_scale(noh_lod_depth(camera->view_projection, scene_world(s, file, item), box), (float)ORBIT_VIEW_RAD,
                         height);
}

void scene_lod_choose(scene_lod *d, uint32_t item, const noh_lod_settings *settings, float pixels_per_metre,
                      int64_t clock)
{
    item_lod *i = &d->items[item];
    noh_lod_choose(&i->state, &i->table, settings, pixels_per_metre, NULL, clock);
}

uint32_t scene_lod_targets(scene_lod *d, uint32_t item, const noh_lod_settings *settings, const float *weights,
                           uint32_t count, float *kept)
{
    uint32_t with_weight = 0;
    for (uint32_t t = 0; t < count; t++) {
        with_weight += weights[t] != 0.0f;
    }
    return with_weight -
           noh_lod_targets(&d->items[item].state, settings, weights, d->items[item].radius_m, count, kept);
}
