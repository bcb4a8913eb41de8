/* view_detail.h: how much detail the viewer shows: one level, or what the error in pixels allows.
 *
 *   view_detail_level, view_detail_pixels   the switch
 *   view_detail_next                        all of its positions in turn
 *   view_detail_frame                       for this frame, of a model that is posed
 *   view_detail_text                        what is shown, in words
 *
 * Where bones are drawn it does nothing. */
#ifndef NOH_TOOL_VIEW_DETAIL_H
#define NOH_TOOL_VIEW_DETAIL_H

#include "view/view_model.h"

#define VIEW_PIXELS_LEAST 0.25f
#define VIEW_PIXELS_MOST 16.0f

typedef struct view_detail {
    noh_detail_settings settings; /* pixels: the knob */
    int by_pixels;
    uint32_t level;               /* that is shown else; 0: the full mesh */
    int64_t clock;                /* ticks, for fades */

    /* what the last frame showed, of all items */
    uint32_t finest, coarsest;    /* levels */
    float fade;                   /* how far the change that has come the least has; 1: none is on */
    float error_px;               /* the largest that the runtime claims */
    uint32_t left_out;            /* targets with weights */
} view_detail;

void view_detail_level(view_detail *d, uint32_t level);
void view_detail_pixels(view_detail *d);
void view_detail_next(view_detail *d, const view_model *m);

/* seconds since the last one. Chooses, and takes weights that cannot be seen out of the scene until it is posed again. */
void view_detail_frame(view_detail *d, view_model *m, const orbit *at, double seconds);

void view_detail_text(const view_detail *d, char *text, size_t bytes);

#endif
