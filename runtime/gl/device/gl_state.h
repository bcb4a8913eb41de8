/* gl_state.h: the GL state that noh needs and leaves, and saving and restoring it.
 *
 *   noh_gl_state_save     save the state that noh's calls may change
 *   noh_gl_state_restore  restore it
 *
 * Render state is yours. Each call sets the state it needs and restores it; it reads only the state it changes, a dozen
 * glGet per frame. Bindings are left empty. On entry only the state in the column "uses yours" matters:
 *
 *   call                          uses yours                      sets and puts back            leaves
 *   noh_stage_draw,               draw framebuffer, viewport,     depth test (on), culling,     (1)
 *   noh_gl_draw_begin to _end,    depth function (2), depth       primitive restart;
 *   noh_stage_decals_draw,        mask, depth range, clip         front face, where an
 *   noh_stage_patches_draw,       control, front face, cull       instance is mirrored;
 *   noh_stage_hair_draw,          mode, colour mask, scissor,     in a depth pass the colour
 *   noh_stage_hairs_draw,         stencil, polygon offset,        mask; in a blended pass the
 *   noh_stage_terrain_draw        sRGB write, sample state,       depth mask and, where
 *                                 blending (3)                    GL_BLEND is off, blending
 *   noh_stage_blob_draw,          the same, except blending     the same, and blending        (1)
 *   noh_stage_floor_draw,         and the depth mask
 *   noh_backdrop_draw
 *   noh_stage_draw_shadow,        cull mode, polygon offset       all else, framebuffers and    (1)
 *   noh_gl_light_begin_shadow                                     viewport too
 *   to _end_shadow, _draw_shadow
 *   noh_stage_frame_end,          nothing                         all, framebuffers and         (1)
 *   noh_gl_morph_update,                                          viewport too; pixel store
 *   noh_gl_skin_update,
 *   noh_gl_caps_probe
 *   _init, _create, _restore,     nothing                         pixel store                   (1), and texture unit 0
 *   _fill, _upload                                                                              or the last used active
 *   noh_gl_mesh_bind, _unbind,    the program                     nothing                       what they bind
 *   noh_gl_morph_bind_streams
 *   all others                    nothing                         nothing                       what was there
 *
 * (1) None bound: program, vertex array, renderbuffer, uniform buffer 0, the array, uniform, pixel and copy buffers
 *     that were used, and textures and samplers of the used units (below NOH_UNIT_USER, and units that your shader
 *     shares with noh). Undefined: the active unit and the current values of vertex attributes.
 * (2) GL_LESS and GL_GREATER are drawn as GL_LEQUAL and GL_GEQUAL, so that colours can follow a depth pass. For
 *     reversed depth use your own projection, a clear to 0 and GL_GREATER. With GL_EQUAL draw only NOH_PASS_OPAQUE,
 *     after NOH_PASS_DEPTH, which has the same depths to the bit, and NOH_PASS_BLENDED with another function.
 * (3) If GL_BLEND is on, its functions and equations are yours, for each draw buffer. If it is off, blended passes
 *     blend straight alpha, and restore the state of draw buffer 0 for all.
 *
 * No transform feedback may be active. On desktop GL, polygons must be filled (glPolygonMode).
 *
 * Threads: the context's own thread. */
#ifndef NOH_GL_GL_STATE_H
#define NOH_GL_GL_STATE_H

#include "gl/device/gl_api.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Render state that draws change; only the fields in `kept` are valid. */
typedef struct noh_gl_raster {
    uint16_t kept, enabled; /* bits of gl_state.c */
    uint16_t depth_func, front_face;
    uint16_t blend[6];              /* source and destination of colour, of alpha; equation of both */
    uint8_t color_mask, depth_mask; /* bit c: channel c */
} noh_gl_raster;

/* Render state that draws into textures change. */
typedef struct noh_gl_offscreen {
    noh_gl_raster raster;
    int framebuffers[2]; /* draw, read */
    int viewport[4], scissor[4];
    int clip[2]; /* origin and depth mode; 0 without glClipControl */
    float depth_range[2];
} noh_gl_offscreen;

/* Pixel store state. */
typedef struct noh_gl_pixels {
    int unpack[6], unpack_buffer, pack[4], pack_buffer;
} noh_gl_pixels;

#define NOH_GL_STATE_UNITS 16u

typedef struct noh_gl_state {
    noh_gl_offscreen offscreen;
    noh_gl_pixels pixels;
    int program, vertex_array, array_buffer, uniform_buffer, copy_buffers[2], renderbuffer;
    int uniform_range[3]; /* of binding 0: buffer, first byte, bytes (0: all) */
    int active_unit;
    struct {
        int texture_2d, texture_array, texture_cube, sampler;
    } units[NOH_GL_STATE_UNITS];
} noh_gl_state;

/* Save and restore the state that noh's calls may change, except the current values of vertex attributes. Saving takes
 * about a hundred glGet: save once around many calls. Do not restore bindings of objects deleted in between. */
void noh_gl_state_save(const noh_gl_api *api, noh_gl_state *state);
void noh_gl_state_restore(const noh_gl_api *api, const noh_gl_state *state);

#ifdef __cplusplus
}
#endif

#endif
