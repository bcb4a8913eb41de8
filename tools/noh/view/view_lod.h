/* view_lod.h: the LOD level that the viewer shows: a fixed one, or by the error in pixels; and its wrinkles.
 *
 *   view_lod_level, view_lod_pixels   the switch
 *   view_lod_next                     cycles through the settings
 *   view_lod_look                     sets it on a figure
 *   view_lod_begin, view_lod_end      before and after a frame of the model
 *   view_lod_text                     describes the last frame, in words
 *
 * It does nothing where bones are drawn. */
#ifndef NOH_NOH_VIEW_VIEW_LOD_H
#define NOH_NOH_VIEW_VIEW_LOD_H

#include "view/view_model.h"

#define VIEW_PIXELS_LEAST 0.25f
#define VIEW_PIXELS_MOST 16.0f

typedef struct view_lod {
    float pixels; /* the allowed error */
    int by_pixels;
    uint32_t level;     /* the fixed level; 0: the full mesh */
    int wrinkle_models; /* NOH_WRINKLE_BY_*, in place of the pack's models; 0: the pack's */
    float wrinkles;     /* 0..1: how much of them shows */

    /* the last frame, over all kinds */
    uint32_t finest, coarsest; /* levels */
    uint32_t fading;           /* actors between two levels */
    float error_px;            /* the largest error, by the runtime */
    uint32_t weights;          /* of targets that were drawn */
} view_lod;

void view_lod_level(view_lod *d, uint32_t level);
void view_lod_pixels(view_lod *d);
void view_lod_next(view_lod *d, const view_model *m);

/* How a figure with meshes is drawn. */
void view_lod_look(const view_lod *d, const figure *f);
void view_lod_begin(const view_lod *d, view_model *m);
void view_lod_end(view_lod *d, const view_model *m);

void view_lod_text(const view_lod *d, char *text, size_t bytes);

#endif
