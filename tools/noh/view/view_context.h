/* view_context.h: a GLFW window and its GL context, which may be lost.
 *
 *   view_context_open / view_context_close
 *   view_context_lost     whether the context is gone
 *   view_context_reopen   another window and context in its place
 *   view_context_measure  the window's size and the screen's density */
#ifndef NOH_NOH_VIEW_VIEW_CONTEXT_H
#define NOH_NOH_VIEW_VIEW_CONTEXT_H

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "gpu/gpu.h"

typedef struct view_context {
    GLFWwindow *window; /* NULL: none is open */
    gpu *gpu;
    int native;                              /* the context by GLX or WGL instead of EGL */
    int interval;                            /* screen refreshes to wait for a swap */
    GLenum(GL_APIENTRY *reset_status)(void); /* NULL: losses are not reported here */
    int errors;                              /* reported by GL */
} view_context;

/* Fills g's table and capabilities; c->gpu, native and interval are the caller's. width, height in points.
 * Prints an error and returns an exit code; 0 on success. */
int view_context_open(view_context *c, uint32_t width, uint32_t height, const char *title);
void view_context_close(view_context *c);

int view_context_lost(const view_context *c);

/* A new window of the same size in the same place, since GLFW makes no context without one; fills the same table. It
 * has no callbacks yet. On failure there is no context, and the table's calls do nothing (gl_device.h). */
int view_context_reopen(view_context *c, const char *title);

/* pixels[2]: of the framebuffer. scale: pixels in a point. units[2]: points in a unit of the window system, in which
 * the mouse is reported. Returns 0 while the window has no pixels. */
int view_context_measure(const view_context *c, int pixels[2], float *scale, float units[2]);

#endif
