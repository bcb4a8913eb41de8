/* scene_lod.h: the LOD level of each item of a scene, chosen by its error in pixels.
 *
 *   scene_lod_open / scene_lod_close
 *   scene_lod_scale    pixels per metre at an item's nearest point
 *   scene_lod_choose   for a frame
 *   scene_lod_targets  weights without those of targets too small to be seen
 *
 * It chooses LOD levels of the mesh and targets; joints, influences and update rates stay full. */
#ifndef NOH_NOH_DRAW_SCENE_LOD_H
#define NOH_NOH_DRAW_SCENE_LOD_H

#include "noh_gl.h"
#include "scene/scene.h"

/* One item: its levels, and the chosen one. */
typedef struct item_lod {
    noh_lod_mesh levels[NOH_LOD_LEVELS_MAX];
    noh_lod_table table;
    noh_lod state;
    float *radius_m; /* [target_count of its mesh] */
} item_lod;

typedef struct scene_lod {
    item_lod *items; /* [item_count] */
    uint32_t item_count;
    float *matrices; /* [joints of the largest skin][12] */
} scene_lod;

/* The scene must be at its finest level. Prints an error and returns an exit code; 0 on success. */
int scene_lod_open(scene_lod *d, const pack_file *file, const scene *s);
void scene_lod_close(scene_lod *d);

/* Pixels per metre at the nearest point of an item in its pose; height: of the picture, pixels. By depth, not distance,
 * so that it is the same across the picture. */
float scene_lod_scale(const scene_lod *d, const pack_file *file, const scene *s, uint32_t item,
                      const noh_gl_camera *camera, uint32_t height);

/* Choose a level. The first choice does not fade. */
void scene_lod_choose(scene_lod *d, uint32_t item, const noh_lod_settings *settings, float pixels_per_metre,
                      int64_t clock);

/* After scene_lod_choose: weights to kept[count] (may alias), 0 where a target is left out. Returns how many of
 * these had a weight. */
uint32_t scene_lod_targets(scene_lod *d, uint32_t item, const noh_lod_settings *settings, const float *weights,
                           uint32_t count, float *kept);

#endif
