/* gl_state_internal.h (private): how the library keeps the state of gl_device.h. */
#ifndef NOH_GL_GL_STATE_INTERNAL_H
#define NOH_GL_GL_STATE_INTERNAL_H

#include "gl/device/gl_names_internal.h"
#include "noh/gl_device.h"
#include "noh/noh_gl.h"

enum {
    NOH_KEEP_TESTS = 1,      /* depth test, culling, primitive restart; the depth function */
    NOH_KEEP_FACE = 2,       /* front face */
    NOH_KEEP_COLORS = 4,     /* colour mask */
    NOH_KEEP_BLEND = 8,      /* blending, the depth mask */
    NOH_KEEP_REST = 16,      /* scissor and stencil tests, discard, logic operation, point size */
    NOH_KEEP_FUNCTIONS = 32, /* how to blend is changed even where blending is on */
    NOH_KEEP_ALL = 63
};

/* Read the parts that are not kept yet. Begin with kept 0. */
void noh_gl_raster_keep(const noh_gl_api *gl, noh_gl_raster *raster, uint32_t parts);
/* Set what is kept. */
void noh_gl_raster_put_back(const noh_gl_api *gl, const noh_gl_raster *raster);

/* Test depth by the caller's function, or what that stands for (gl_device.h). Keeps NOH_KEEP_TESTS alone. */
void noh_gl_tests_begin(const noh_gl_api *gl, noh_gl_raster *raster);
/* 1: the caller's depths fall with the distance. */
int noh_gl_is_reversed(const noh_gl_raster *raster);
/* Blend without writing depth, as the caller does or else straight alpha; and end it, so that other passes may follow. */
void noh_gl_blend_begin(const noh_gl_api *gl, noh_gl_raster *raster);
void noh_gl_blend_end(const noh_gl_api *gl, const noh_gl_raster *raster);
/* Darken what is there: test depth as noh_gl_tests_begin, write none, from both sides; then set how to blend. */
void noh_gl_multiply_begin(const noh_gl_api *gl, noh_gl_raster *raster);
/* Behind all: no depth, no blending, from both sides. */
void noh_gl_behind_begin(const noh_gl_api *gl, noh_gl_raster *raster);
/* Write depth alone, and end it. */
void noh_gl_depth_only_begin(const noh_gl_api *gl, noh_gl_raster *raster);
void noh_gl_depth_only_end(const noh_gl_api *gl, const noh_gl_raster *raster);

/* Which framebuffers are bound: draw, read. */
void noh_gl_framebuffers_keep(const noh_gl_api *gl, int kept[2]);
void noh_gl_framebuffers_put_back(const noh_gl_api *gl, const int kept[2]);

/* State as in a new context, for draws into a texture; then bind a framebuffer and set the viewport. */
void noh_gl_offscreen_begin(const noh_gl_api *gl, noh_gl_offscreen *kept);
void noh_gl_offscreen_end(const noh_gl_api *gl, const noh_gl_offscreen *kept);

/* Rows of pixels in memory, tightly packed, for TexSubImage; _pack: for ReadPixels, too. */
void noh_gl_unpack_begin(const noh_gl_api *gl, noh_gl_pixels *kept);
void noh_gl_unpack_end(const noh_gl_api *gl, const noh_gl_pixels *kept);
void noh_gl_pack_begin(const noh_gl_api *gl, noh_gl_pixels *kept);
void noh_gl_pack_end(const noh_gl_api *gl, const noh_gl_pixels *kept);

/* The shadow map's framebuffer and viewport, and the state that it is drawn in; noh_gl_light_end_shadow ends it. */
struct noh_gl_light;
void noh_gl_light_bind_shadow(const struct noh_gl_light *light);

/* A sampler object would hide how textures are filtered. */
void noh_gl_samplers_none(const noh_gl_api *gl, uint32_t first, uint32_t count);

#endif
