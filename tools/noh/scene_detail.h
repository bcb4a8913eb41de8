/* scene_detail.h: the LOD level of each item of a scene, chosen by its error in pixels.
 *
 *   scene_detail_open / scene_detail_close
 *   scene_detail_scale    pixels per metre at an item's nearest point
 *   scene_detail_choose   for a frame
 *   scene_detail_fix      a fixed level instead
 *   scene_detail_targets  weights without those of targets too small to be seen
 *
 * It chooses mesh levels and targets; joints, influences and update rates stay full. */
#ifndef NOH_TOOL_SCENE_DETAIL_H
#define NOH_TOOL_SCENE_DETAIL_H

#include "noh_gl.h"
#include "scene.h"

/* One item: the levels that it has, and the one chosen. */
typedef struct item_detail {
    noh_mesh_level levels[NOH_LEVELS_MAX];
    noh_detail_table table;
    noh_detail state;
    float *reach_m; /* [target_count of its mesh] */
} item_detail;

typedef struct scene_detail {
    item_detail *items; /* [item_count] */
    uint32_t item_count;
    float *matrices;    /* [joints of the largest skin][12] */
} scene_detail;

/* The scene must be at its finest level. Prints an error and returns an exit code; 0 on success. */
int scene_detail_open(scene_detail *d, const pack_file *file, const scene *s);
void scene_detail_close(scene_detail *d);

/* For the item's pose and a picture of that height, in pixels. By depth, not distance, so that it holds across the picture. */
float scene_detail_scale(const scene_detail *d, const pack_file *file, const scene *s, uint32_t item, const noh_gl_camera *camera,
                         uint32_t height);

/* Choose a level. The first choice, and the first after scene_detail_fix, does not fade. */
void scene_detail_choose(scene_detail *d, uint32_t item, const noh_detail_settings *settings, float pixels_per_metre, int64_t clock);

/* A level past the item's last means the last. No targets are left out. */
void scene_detail_fix(scene_detail *d, uint32_t item, uint32_t level, float pixels_per_metre);

/* After scene_detail_choose: weights to kept[count] (may alias), 0 where a target is left out. Returns how many of these had
 * a weight. */
uint32_t scene_detail_targets(scene_detail *d, uint32_t item, const noh_detail_settings *settings, const float *weights, uint32_t count,
                              float *kept);

#endif
