#include "scene_detail.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int open_item(item_detail *item, const noh_mesh *mesh)
{
    const uint32_t targets = mesh->header->target_count;
    item->table.meshes = item->levels;
    item->table.mesh_level_count = noh_detail_mesh_levels(mesh, item->levels);
    item->reach_m = calloc(targets + 1u, sizeof *item->reach_m);
    for (uint32_t t = 0; item->reach_m && t < targets; t++) {
        item->reach_m[t] = mesh->targets[t].max_displacement * mesh->header->world_scale;
    }
    return !item->reach_m;
}

static uint32_t most_joints(const pack_file *file)
{
    uint32_t most = 0;
    noh_skin skin;
    for (uint32_t i = 0; noh_pack_skin_at(&file->pack, i, &skin) == NOH_OK; i++) {
        most = skin.header->joint_count > most ? skin.header->joint_count : most;
    }
    return most;
}

int scene_detail_open(scene_detail *d, const pack_file *file, const scene *s)
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

void scene_detail_close(scene_detail *d)
{
    for (uint32_t i = 0; i < d->item_count; i++) {
        free(d->items[i].reach_m);
    }
    free(d->items);
    free(d->matrices);
    memset(d, 0, sizeof *d);
}

/* Of an item as it is posed, before its node's placement. */
static void item_box(const scene_detail *d, const scene *s, uint32_t item, float box[6])
{
    const noh_mesh *mesh = &s->meshes[s->items[item].mesh];
    const float *weights = s->items[item].weights;
    noh_skin skin;
    if (noh_pack_skin_at(mesh->pack, mesh->header->skin, &skin)) {
        noh_mesh_box(mesh, NULL, weights, box);
        return;
    }
    scene_skin_matrices(s, &skin, d->matrices);
    noh_skin_box(mesh, d->matrices, weights, box);
}

float scene_detail_scale(const scene_detail *d, const pack_file *file, const scene *s, uint32_t item, const orbit *at, uint32_t height)
{
    const float *world = scene_world(s, file, item);
    double right[3], up[3], back[3], nearest = INFINITY;
    float box[6];
    orbit_axes(at, right, up, back);
    item_box(d, s, item, box);
    for (int corner = 0; corner < 8; corner++) {
        double depth = at->distance;
        for (int r = 0; r < 3; r++) {
            const float *row = world + 4 * r;
            const float x = box[corner & 1 ? 3 : 0], y = box[corner & 2 ? 4 : 1], z = box[corner & 4 ? 5 : 2];
            depth -= back[r] * ((double)(row[0] * x + row[1] * y + row[2] * z + row[3]) - at->center[r]);
        }
        nearest = fmin(nearest, depth);
    }
    return noh_detail_scale((float)nearest, (float)ORBIT_VIEW_RAD, height);
}

void scene_detail_choose(scene_detail *d, uint32_t item, const noh_detail_settings *settings, float pixels_per_metre, int64_t clock)
{
    item_detail *i = &d->items[item];
    if (!i->state.started) {
        noh_detail_cut(&i->state);
    }
    noh_detail_choose(&i->state, &i->table, settings, pixels_per_metre, NULL, clock);
}

void scene_detail_fix(scene_detail *d, uint32_t item, uint32_t level, float pixels_per_metre)
{
    item_detail *i = &d->items[item];
    const uint32_t last = i->table.mesh_level_count - 1u;
    memset(&i->state, 0, sizeof i->state);
    i->state.mesh = i->state.mesh_before = (uint8_t)(level < last ? level : last);
    i->state.error_m = i->levels[i->state.mesh].error_m;
    i->state.pixels_per_metre = pixels_per_metre;
}

uint32_t scene_detail_targets(scene_detail *d, uint32_t item, const noh_detail_settings *settings, const float *weights, uint32_t count,
                              float *kept)
{
    uint32_t with_weight = 0;
    for (uint32_t t = 0; t < count; t++) {
        with_weight += weights[t] != 0.0f;
    }
    return with_weight - noh_detail_targets(&d->items[item].state, settings, weights, d->items[item].reach_m, count, kept);
}
