/* view_lod.h: the LOD level that the viewer shows: a fixed one, or by the error in pixels.
 *
 *   view_lod_level, view_lod_pixels   the switch
 *   view_lod_next                        cycles through its positions
 *   view_lod_frame                       choose for this frame, of a posed model
 *   view_lod_text                        the choice, in words
 *
 * It does nothing where bones are drawn. */
#ifndef NOH_NOH_VIEW_VIEW_LOD_H
#define NOH_NOH_VIEW_VIEW_LOD_H

#include "view/view_model.h"

#define VIEW_PIXELS_LEAST 0.25f
#define VIEW_PIXELS_MOST 16.0f

typedef struct view_lod {
    noh_lod_settings settings; /* pixels: the allowed error */
    int by_pixels;
    uint32_t level; /* the fixed level; 0: the full mesh */
    int64_t clock;  /* ticks, for fades */

    /* what the last frame showed, of all items */
    uint32_t finest, coarsest; /* levels */
    float fade;                /* progress of the latest fade; 1: none is under way */
    float error_px;            /* the largest, as the runtime states it */
    uint32_t left_out;         /* targets with weights */
} view_lod;

void view_lod_level(view_lod *d, uint32_t level);
void view_lod_pixels(view_lod *d);
void view_lod_next(view_lod *d, const view_model *m);

/* seconds since the last frame. Chooses levels, and zeroes weights too small to be seen until the scene is posed again.
 */
void view_lod_frame(view_lod *d, view_model *m, const orbit *at, double seconds);

void view_lod_text(const view_lod *d, char *text, size_t bytes);

#endif
