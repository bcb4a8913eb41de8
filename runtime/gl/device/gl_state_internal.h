/* gl_state_internal.h (private): how the library saves the state of gl_device.h. */
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
    NOH_KEEP_FUNCTIONS = 32, /* blend functions, even if blending is on */
    NOH_KEEP_COVERAGE = 64,  /* alpha to coverage */
    NOH_KEEP_ALL = 127
};

/* Save the parts not yet saved. Initialise `kept` to 0. */
void noh_gl_raster_keep(const noh_gl_api *gl, noh_gl_raster *raster, uint32_t parts);
/* Restore the saved parts. */
void noh_gl_raster_put_back(const noh_gl_api *gl, const noh_gl_raster *raster);

/* Enable the depth test with the caller's function, adjusted as in gl_device.h. Saves only NOH_KEEP_TESTS and
 * NOH_KEEP_COVERAGE. */
void noh_gl_tests_begin(const noh_gl_api *gl, noh_gl_raster *raster);
/* 0: alpha to coverage is off; 1: the caller has it on; 3: it is on in a target of one sample, where a dither replaces
 * it. Only opaque passes use it. */
int noh_gl_is_covering(const noh_gl_raster *raster);
/* 1: the caller's depth decreases with distance. */
int noh_gl_is_reversed(const noh_gl_raster *raster);
/* Blend without writing depth, with the caller's blending or else straight alpha. End it before other passes. */
void noh_gl_blend_begin(const noh_gl_api *gl, noh_gl_raster *raster);
void noh_gl_blend_end(const noh_gl_api *gl, const noh_gl_raster *raster);
/* For darkening passes: depth test as noh_gl_tests_begin, no depth writes, no culling, blending on. The caller then
 * sets the blend functions. */
void noh_gl_multiply_begin(const noh_gl_api *gl, noh_gl_raster *raster);
/* For backdrops: no depth test or writes, no blending, no culling. */
void noh_gl_behind_begin(const noh_gl_api *gl, noh_gl_raster *raster);
/* Write only depth. End it before other passes. */
void noh_gl_depth_only_begin(const noh_gl_api *gl, noh_gl_raster *raster);
void noh_gl_depth_only_end(const noh_gl_api *gl, const noh_gl_raster *raster);

/* The bound framebuffers: draw, read. */
void noh_gl_framebuffers_keep(const noh_gl_api *gl, int kept[2]);
void noh_gl_framebuffers_put_back(const noh_gl_api *gl, const int kept[2]);

/* Set the state of a new context, for draws into a texture. The caller then binds a framebuffer and sets the
 * viewport. */
void noh_gl_offscreen_begin(const noh_gl_api *gl, noh_gl_offscreen *kept);
void noh_gl_offscreen_end(const noh_gl_api *gl, const noh_gl_offscreen *kept);

/* Tightly packed rows of pixels in memory for TexSubImage; _pack: for ReadPixels too. */
void noh_gl_unpack_begin(const noh_gl_api *gl, noh_gl_pixels *kept);
void noh_gl_unpack_end(const noh_gl_api *gl, const noh_gl_pixels *kept);
void noh_gl_pack_begin(const noh_gl_api *gl, noh_gl_pixels *kept);
void noh_gl_pack_end(const noh_gl_api *gl, const noh_gl_pixels *kept);

/* Bind the shadow map's framebuffer and set viewport and state. End with noh_gl_light_end_shadow. */
struct noh_gl_light;
void noh_gl_light_bind_shadow(const struct noh_gl_light *light);

/* Unbind sampler objects, which would override the filters of the textures. */
void noh_gl_samplers_none(const noh_gl_api *gl, uint32_t first, uint32_t count);

#endif
