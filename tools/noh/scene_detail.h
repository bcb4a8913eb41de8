/* scene_detail.h: how much detail each item of a scene is shown with, by what it is off in pixels.
 *
 *   scene_detail_open / scene_detail_close
 *   scene_detail_scale    how many pixels a metre is where an item is nearest to the camera
 *   scene_detail_choose   for a frame
 *   scene_detail_fix      one level instead
 *   scene_detail_targets  weights without those of targets that cannot be seen
 *
 * Mesh levels and targets: joints, influences and rates stay full. */
#ifndef NOH_TOOL_SCENE_DETAIL_H
#define NOH_TOOL_SCENE_DETAIL_H

#include "noh_gl.h"
#include "scene.h"

/* What can be left out of one item, and what is. */
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

/* Of a scene at its finest level. Prints an error and returns an exit code; 0 on success. */
int scene_detail_open(scene_detail *d, const pack_file *file, const scene *s);
void scene_detail_close(scene_detail *d);

/* As the item is posed, in a picture of that height; by its depth, so that it holds across the picture. */
float scene_detail_scale(const scene_detail *d, const pack_file *file, const scene *s, uint32_t item, const noh_gl_camera *camera,
                         uint32_t height);

/* The first time, and after scene_detail_fix, without a fade. */
void scene_detail_choose(scene_detail *d, uint32_t item, const noh_detail_settings *settings, float pixels_per_metre, int64_t clock);

/* Past the item's last level: that one. No targets are left out. */
void scene_detail_fix(scene_detail *d, uint32_t item, uint32_t level, float pixels_per_metre);

/* After scene_detail_choose. kept (may be weights) is 0 where a target is left out. Returns how many are that had a weight. */
uint32_t scene_detail_targets(scene_detail *d, uint32_t item, const noh_detail_settings *settings, const float *weights, uint32_t count,
                              float *kept);

#endif
