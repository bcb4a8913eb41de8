#include "scene.h"

#include <string.h>

void web_scene_reset(web_scene *scene, const web_item *item)
{
    const noh_mesh *mesh = &scene->meshes[item->mesh];
    const float *defaults = mesh->weights;
    if (item->node != NOH_NONE && scene->pack.nodes[item->node].first_weight != NOH_NONE) {
        defaults = scene->pack.node_weights + scene->pack.nodes[item->node].first_weight;
    }
    memcpy(scene->weights + item->first_weight, defaults, sizeof *defaults * mesh->header->target_count);
}

static noh_result add_item(web_scene *scene, uint32_t node, uint32_t mesh, noh_error *error)
{
    uint32_t count = scene->meshes[mesh].header->target_count;
    if (scene->item_count == WEB_ITEMS_MAX || scene->weight_count + count > WEB_WEIGHTS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "more meshes or weights than the page has room for", node, 0);
    }
    web_item *item = &scene->items[scene->item_count++];
    item->node = node;
    item->mesh = mesh;
    item->instance = scene->instance_counts[mesh]++;
    item->first_weight = scene->weight_count;
    web_scene_reset(scene, item);
    scene->weight_count += count;
    return NOH_OK;
}

static void add_names(web_scene *scene, const noh_mesh *mesh)
{
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        const char *name = noh_pack_string(&scene->pack, mesh->targets[t].name);
        uint32_t i = 0;
        while (i < scene->name_count && strcmp(scene->names[i], name) != 0) i++;
        if (i == scene->name_count && i < NOH_TARGETS_MAX) scene->names[scene->name_count++] = name;
    }
}

noh_result web_scene_list(web_scene *scene, noh_error *error)
{
    const noh_pack *pack = &scene->pack;
    noh_result result = NOH_OK;
    if (pack->mesh_count > WEB_MESHES_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "more meshes than the page has room for", pack->mesh_count,
                        WEB_MESHES_MAX);
    }
    for (uint32_t i = 0; i < pack->mesh_count; i++) {
        noh_pack_mesh_at(pack, i, &scene->meshes[i], NULL);
        add_names(scene, &scene->meshes[i]);
    }
    for (uint32_t n = 0; n < pack->node_count && !result; n++) {
        if (pack->nodes[n].mesh != NOH_NONE) result = add_item(scene, n, pack->nodes[n].mesh, error);
    }
    for (uint32_t i = 0; i < pack->mesh_count && !pack->node_count && !result; i++) {
        result = add_item(scene, NOH_NONE, i, error);
    }
    if (!result && !scene->item_count) result = noh_fail(error, NOH_ERR_DATA, "the pack has nothing to draw", 0, 0);
    return result;
}

const float *web_scene_world(const web_scene *scene, const web_item *item)
{
    static const float identity[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
    return item->node == NOH_NONE ? identity : scene->pack.nodes[item->node].world;
}

/* NULL where the item's mesh has no such target. */
static const float *find_weight(const web_scene *scene, const web_item *item, uint32_t target)
{
    const noh_mesh *mesh = &scene->meshes[item->mesh];
    uint32_t t = noh_mesh_find_target(mesh, scene->names[target]);
    return t < mesh->header->target_count ? &scene->weights[item->first_weight + t] : NULL;
}

void web_scene_set_weight(web_scene *scene, uint32_t target, float weight)
{
    for (uint32_t i = 0; i < scene->item_count; i++) {
        const float *at = find_weight(scene, &scene->items[i], target);
        if (at) scene->weights[at - scene->weights] = weight;
    }
}

float web_scene_weight(const web_scene *scene, uint32_t target)
{
    const float *at = NULL;
    for (uint32_t i = 0; i < scene->item_count && !at; i++) at = find_weight(scene, &scene->items[i], target);
    return at ? *at : 0.0f;
}
