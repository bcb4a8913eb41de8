/* canvas.h: the render target of pictures. */
#ifndef NOH_NOH_GPU_CANVAS_H
#define NOH_NOH_GPU_CANVAS_H

#include "gpu.h"

/* The background, as linear light and as sRGB bytes. */
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
/* Clear the depth: later draws cover earlier ones. */
void canvas_clear_depth(const canvas *c);
/* Resolve into the texture. Leaves framebuffer 0 bound. */
void canvas_resolve(canvas *c);
/* Resolve and read: rgba[height][width][4], top row first. */
int canvas_read(canvas *c, uint8_t *rgba);

/* Turn pixels as GL reads them into a picture: top row first, and opaque (blended meshes leave other values in alpha).
 * Prints an error and returns an exit code; 0 on success. */
int picture_from_gl(uint8_t *rgba, uint32_t width, uint32_t height);

#endif
