/* view.h: where to look from, and pixels out. */
#ifndef NOH_TOOL_VIEW_H
#define NOH_TOOL_VIEW_H

#include "load.h"

typedef struct bounds {
    double low[3], high[3];
} bounds;

/* The world bounds of the scene at its weights; with `face` only of vertices that targets move. */
bounds scene_bounds(const scene *s, const pack_file *file, int face);
bounds bounds_union(bounds a, bounds b);

typedef struct view_options {
    const char *camera; /* "face", "body" or "AZ,EL,DIST" in degrees and model units; NULL: body */
    uint32_t width, height;
} view_options;

/* A perspective camera (30 degrees high) that holds the box. 0, or EXIT_USAGE after printing. */
int view_camera(const view_options *o, const bounds *box, noh_gl_camera *camera);
/* 1 when the option asks for the face. */
int view_wants_face(const view_options *o);

/* The background, as linear light and as the sRGB bytes that it becomes. */
#define CANVAS_BACKGROUND_LINEAR 0.075f, 0.078f, 0.085f
#define CANVAS_BACKGROUND_SRGB 78, 79, 82

/* A multisampled sRGB target. */
typedef struct canvas {
    gpu *g;
    uint32_t width, height;
    GLuint framebuffer, color, depth, resolved_framebuffer, resolved;
} canvas;

int canvas_open(canvas *c, gpu *g, uint32_t width, uint32_t height);
void canvas_close(canvas *c);
/* Bind, set the viewport, clear to the background. */
void canvas_begin(canvas *c);
/* Resolve and read: rgba[height][width][4], top row first. */
int canvas_read(canvas *c, uint8_t *rgba);

/* Draw light text on a dark strip into a picture; scale 1 is about 7 pixels high. */
void draw_text(uint8_t *rgba, uint32_t width, uint32_t height, int x, int y, int scale, const char *text);

#endif
