/* scene.h: what a pack draws: its meshes, where its nodes place them, and their weights. */
#ifndef NOH_PLATFORM_WEB_SCENE_H
#define NOH_PLATFORM_WEB_SCENE_H

#include "noh_gl.h"

#define WEB_MESHES_MAX 64u
#define WEB_ITEMS_MAX 128u
#define WEB_WEIGHTS_MAX 8192u /* for all items together */

typedef struct web_item {
    uint32_t node; /* NOH_NONE in a pack without nodes */
    uint32_t mesh, instance, first_weight;
} web_item;

typedef struct web_scene {
    noh_pack pack;
    noh_mesh meshes[WEB_MESHES_MAX];
    uint32_t instance_counts[WEB_MESHES_MAX];
    web_item items[WEB_ITEMS_MAX];
    uint32_t item_count, weight_count, name_count;
    const char *names[NOH_TARGETS_MAX]; /* of targets, each once */
    float weights[WEB_WEIGHTS_MAX];
} web_scene;

/* List what scene->pack draws, which must be open.
 * errors  LIMIT more of something than the page has room for; DATA nothing to draw */
noh_result web_scene_list(web_scene *scene, noh_error *error);

/* The item's world matrix, 3 rows of 4. */
const float *web_scene_world(const web_scene *scene, const web_item *item);

/* Reset an item's weights to the pack's. */
void web_scene_reset(web_scene *scene, const web_item *item);

/* Set a target, given by its index in `names`, in every mesh that has it; get it from the first of them. */
void web_scene_set_weight(web_scene *scene, uint32_t target, float weight);
float web_scene_weight(const web_scene *scene, uint32_t target);

#endif
