/* drawing.h: pictures of a scene: its meshes, or its skeletons drawn as bones. */
#ifndef NOH_NOH_DRAW_DRAWING_H
#define NOH_NOH_DRAW_DRAWING_H

#include "bones.h"
#include "gpu/canvas.h"
#include "load.h"

typedef struct drawing {
    const scene *scene;
    load load;    /* with meshes */
    bones *bones; /* [player_count], with bones */
    uint32_t bones_count;
    canvas canvas;
    int has_canvas;
} drawing;

/* 1 where bones are to be drawn: they were asked for, or there are no meshes. Prints an error and returns -1 where
 * there is no skeleton either. */
int drawing_shows_bones(const scene *s, const pack_file *file, int asked_for);

/* The world bounds of what is drawn. */
bounds drawing_bounds(const scene *s, const pack_file *file, int face, int show_bones);

/* Make everything that drawing needs. Prints an error and returns an exit code; 0 on success. */
int drawing_open(drawing *d, gpu *g, const pack_file *file, const scene *s, const load_options *o, int show_bones,
                 uint32_t width, uint32_t height);
void drawing_close(drawing *d);

/* Draw the scene into the canvas, as it was at the last load_update. */
void drawing_paint(drawing *d, const noh_gl_camera *camera);

/* Update the load, paint, and read the picture: rgba[height][width][4], top row first. */
int drawing_read(drawing *d, const noh_gl_camera *camera, uint8_t *rgba);

#endif
