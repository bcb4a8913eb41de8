/* view_marks.h: draws around the figure: a floor with a grid, the walked path, the picked point.
 *
 *   view_marks_open / view_marks_close
 *   view_marks_floor, view_marks_path, view_marks_point   into the framebuffer that is bound, after the figure */
#ifndef NOH_NOH_VIEW_VIEW_MARKS_H
#define NOH_NOH_VIEW_VIEW_MARKS_H

#include "draw/camera.h"
#include "gpu/gpu.h"

#define VIEW_MARKS_CORNERS 6144u /* of one call */

typedef struct view_marks {
    gpu *g;
    GLuint program, vertex_array, buffer;
    GLint u_view_projection;
    uint32_t count;                       /* corners, as they are collected */
    float corners[VIEW_MARKS_CORNERS][7]; /* position, linear colour, alpha */
} view_marks;

/* Prints an error and returns an exit code; 0 on success. */
int view_marks_open(view_marks *k, gpu *g);
void view_marks_close(view_marks *k);

/* A grid at this height, as far as the camera's planes reach around its target. */
void view_marks_floor(view_marks *k, const orbit *o, double height, uint32_t picture_height);

/* A line over the floor through points[count][2], x and z. */
void view_marks_path(view_marks *k, const orbit *o, double height, const float *points, uint32_t count,
                     uint32_t picture_height);

/* A ring around a point, in front of everything. */
void view_marks_point(view_marks *k, const orbit *o, const float point[3], uint32_t picture_height);

#endif
