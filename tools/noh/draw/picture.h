/* picture.h: pictures of a figure: its meshes, or its skeletons drawn as bones. */
#ifndef NOH_NOH_DRAW_PICTURE_H
#define NOH_NOH_DRAW_PICTURE_H

#include "bones.h"
#include "debug_kind.h"
#include "figure.h"
#include "gpu/canvas.h"
#include "overlay.h"
#include "noh/base.h"
#include "noh/low_gl.h"

typedef struct picture {
    figure figure;
    int shows_bones;
    bones bones[NOH_STAGE_KINDS_MAX]; /* of kinds with joints */
    debug_kind debug;                 /* of picture_debug */
    overlay overlay;
    uint32_t joint; /* of DEBUG_WEIGHTS */
    canvas canvas;
    int has_canvas;
} picture;

/* 1 where bones are to be drawn: they were asked for, or there are no meshes. Prints an error and returns -1 where
 * there is no skeleton either. */
int picture_shows_bones(const pack_file *file, int asked_for);

/* Make everything that drawing needs, with a context that can draw. Prints an error and returns an exit code; 0 on
 * success. */
int picture_open(picture *p, gpu *g, const figure_desc *desc, int shows_bones, uint32_t width, uint32_t height);
void picture_close(picture *p);
/* The --debug views that figure_desc does not cover, once it is open. joint: as overlay_joint */
int picture_debug(picture *p, gpu *g, debug_kind kind, const char *joint);

/* The world bounds of the picture's contents, as posed. */
bounds picture_bounds(const picture *p, view_frame frame);

/* Draw the figure into the canvas, as it is. */
int picture_paint(picture *p, const noh_gl_camera *camera);
/* The same, and read the picture: rgba[height][width][4], top row first. */
int picture_read(picture *p, const noh_gl_camera *camera, uint8_t *rgba);

#endif
