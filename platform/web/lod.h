/* lod.h: the LOD level of each item of a scene: one level for all, or the coarsest that an error in pixels allows. */
#ifndef NOH_PLATFORM_WEB_LOD_H
#define NOH_PLATFORM_WEB_LOD_H

#include "scene.h"

#define WEB_LOD_AUTO (-1)

typedef struct web_lod {
    noh_lod_mesh levels[WEB_MESHES_MAX][NOH_LOD_LEVELS_MAX];
    noh_lod_table tables[WEB_MESHES_MAX];
    noh_lod states[WEB_ITEMS_MAX];
    float kept[NOH_TARGETS_MAX], radius_m[NOH_TARGETS_MAX]; /* of the item that web_lod_weights was called for */
    uint32_t level_count;                                   /* the most that any mesh has */
    int level; /* 0: the full mesh; WEB_LOD_AUTO: the coarsest that the settings allow */
    noh_lod_settings settings;
    int64_t clock; /* ticks; fades run by it */
} web_lod;

/* Prepare the items of a listed scene. A pack without LOD levels is always shown in full. */
void web_lod_open(web_lod *lod, const web_scene *scene);

/* Choose the level of an item in its current pose. Call it before web_lod_weights.
 * shapes  matrices[joint_count of its skin][12], NULL: rigid
 * height  of the canvas, in pixels */
void web_lod_choose(web_lod *lod, const web_scene *scene, uint32_t item, const float *matrices,
                    const noh_gl_camera *camera, uint32_t height);

/* The item's weights, with 0 for targets whose effect is too small to be seen; valid until the next call. */
const float *web_lod_weights(web_lod *lod, const web_scene *scene, uint32_t item);

#endif
