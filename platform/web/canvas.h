/* canvas.h: a multisampled sRGB target of the canvas's size, and the way from it to the page. */
#ifndef NOH_PLATFORM_WEB_CANVAS_H
#define NOH_PLATFORM_WEB_CANVAS_H

#include "noh.h"

typedef struct web_canvas {
    const noh_gl_api *gl;
    noh_gl_ledger *ledger;
    uint32_t width, height;
    noh_gl_renderbuffer color, depth;
    noh_gl_texture resolved;
    GLuint framebuffer, resolved_framebuffer, program, vertex_array;
} web_canvas;

/* Zeros is a canvas that holds nothing; opening it again with another size replaces what it holds. */
noh_result web_canvas_open(web_canvas *c, const noh_gl_api *gl, noh_gl_ledger *ledger, uint32_t width, uint32_t height,
                           uint32_t samples, noh_error *error);
void web_canvas_close(web_canvas *c, const noh_gl_api *gl);

/* Bind and clear; resolve and show. */
void web_canvas_begin(const web_canvas *c);
void web_canvas_show(const web_canvas *c);

#endif
