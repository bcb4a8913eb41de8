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

#define ORBIT_VIEW_RAD 0.5235987755982988 /* the height of the view: 30 degrees */

/* Where a camera is: round a centre. Angles in radians, lengths in model units. */
typedef struct orbit {
    double azimuth, elevation, distance;
    double center[3], radius; /* what it looks at; the radius of what is to be between its near and far planes */
    double aspect;            /* width over height */
} orbit;

/* One that holds the box, from the front. */
orbit orbit_fit(const bounds *box, double aspect);
/* Its unit axes in the world; `back` points from the centre to the eye. */
void orbit_axes(const orbit *o, double right[3], double up[3], double back[3]);
/* A perspective camera, lit from over the left shoulder. */
void orbit_camera(const orbit *o, noh_gl_camera *camera);

/* A camera by the options, that holds the box. 0, or EXIT_USAGE after printing. */
int view_camera(const view_options *o, const bounds *box, noh_gl_camera *camera);
/* 1 when the option asks for the face. */
int view_wants_face(const view_options *o);

/* The background, as linear light and as the sRGB bytes that it becomes. */
#define CANVAS_BACKGROUND_LINEAR 0.075f, 0.078f, 0.085f
#define CANVAS_BACKGROUND_SRGB 78, 79, 82

#define DESKTOP_FRAMEBUFFER_SRGB 0x8DB9 /* desktop GL encodes only when asked to; ES always does */

/* A multisampled sRGB target. */
typedef struct canvas {
    gpu *g;
    uint32_t width, height;
    GLuint framebuffer, color, depth, resolved_framebuffer;
    GLuint resolved; /* a texture */
} canvas;

int canvas_open(canvas *c, gpu *g, uint32_t width, uint32_t height);
void canvas_close(canvas *c);
/* Bind, set the viewport, clear to the background. */
void canvas_begin(canvas *c);
/* Resolve into the texture. Leaves framebuffer 0 bound. */
void canvas_resolve(canvas *c);
/* Resolve and read: rgba[height][width][4], top row first. */
int canvas_read(canvas *c, uint8_t *rgba);

/* Pixels as GL reads them into a picture: the top row first, opaque (what blended meshes left in alpha is not the
 * picture's). Prints an error and returns an exit code; 0 on success. */
int picture_from_gl(uint8_t *rgba, uint32_t width, uint32_t height);

/* Draw light text on a dark strip into a picture; scale 1 is about 7 pixels high. */
void draw_text(uint8_t *rgba, uint32_t width, uint32_t height, int x, int y, int scale, const char *text);

#endif
