/* lod.h: the LOD level of each item of a scene: one for all, or what an error in pixels allows. */
#ifndef NOH_PLATFORM_WEB_LOD_H
#define NOH_PLATFORM_WEB_LOD_H

#include "scene.h"

#define WEB_LOD_AUTO (-1)

typedef struct web_lod {
    noh_lod_mesh levels[WEB_MESHES_MAX][NOH_LOD_LEVELS_MAX];
    noh_lod_table tables[WEB_MESHES_MAX];
    noh_lod states[WEB_ITEMS_MAX];
    float kept[NOH_TARGETS_MAX], radius_m[NOH_TARGETS_MAX]; /* of the item at hand */
    uint32_t level_count;                                   /* the most that any mesh has */
    int level; /* that is shown, 0 the full mesh; WEB_LOD_AUTO: what the settings allow */
    noh_lod_settings settings;
    int64_t clock; /* ticks, for fades */
} web_lod;

/* Of a scene that was listed. Packs without levels are always shown in full. */
void web_lod_open(web_lod *lod, const web_scene *scene);

/* Choose an item's level in its current pose. Call before web_lod_weights.
 * shapes  matrices[joints of its skin][12], NULL: rigid; height of the canvas in pixels */
void web_lod_choose(web_lod *lod, const web_scene *scene, uint32_t item, const float *matrices,
                    const noh_gl_camera *camera, uint32_t height);

/* The item's weights, 0 for targets too small to be seen; valid until the next call. */
const float *web_lod_weights(web_lod *lod, const web_scene *scene, uint32_t item);

#endif
