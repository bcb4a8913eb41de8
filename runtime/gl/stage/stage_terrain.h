/* stage_terrain.h: a height field drawn as the ground of a stage, in blocks at the levels of terrain_lod.h.
 *
 *   noh_stage_terrain_size, noh_stage_terrain_bytes   exact bytes on the CPU and on the GPU
 *   noh_stage_terrain_create                          the GL objects; _delete, _restore
 *   noh_stage_terrain_choose                          LOD levels for a view
 *   noh_stage_terrain_draw                            draw the visible blocks; noh_stage_terrain_draw_shadow
 *
 * There are no vertex buffers: the vertex shader computes vertices from their numbers and a texture of the 16-bit
 * heights. Each block is one draw call of at most 2,048 triangles. Drawing uploads nothing.
 *
 * Threads: the context's own thread; noh_stage_terrain_size and noh_stage_terrain_bytes, any. */
#ifndef NOH_STAGE_GL_STAGE_TERRAIN_H
#define NOH_STAGE_GL_STAGE_TERRAIN_H

#include "life/physics/terrain_lod.h"
#include "gl/stage/stage_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Zeros are good values. */
typedef struct noh_stage_terrain_desc {
    int lit, encode_srgb;    /* lit: the stage has a light; encode_srgb: as in noh_stage_desc */
    float flat[3], steep[3]; /* linear colours; default (0) grass and rock */
} noh_stage_terrain_desc;

typedef struct noh_stage_terrain {
    noh_gl_drawable drawable; /* with the heights in a GL_R16UI texture */
    noh_stage_terrain_desc desc;
    noh_terrain_lod lod;
    uint32_t draws, triangles; /* of the last draw */
} noh_stage_terrain;

/* The first is noh_terrain_lod_size; the second is 2 bytes per height. */
size_t noh_stage_terrain_size(const noh_field *field);
uint64_t noh_stage_terrain_bytes(const noh_field *field);

/* field    in the unit of the stage; its heights must outlive the terrain
 * desc     NULL: zeros
 * memory   [bytes] at least noh_stage_terrain_size, aligned to NOH_MEMORY_ALIGN; the terrain keeps it
 * errors   ARG memory is NULL or misaligned, or the field has fewer than 2 x 2 heights; LIMIT a side of the field has more
 *          heights than the largest texture of device->caps has texels; MEMORY `bytes` is too small; DATA, GL, MEMORY as
 *          noh_gl_program_create and noh_gl_texture_create. It then has no GL objects */
noh_result noh_stage_terrain_create(const noh_gl_device *device, const noh_field *field,
                                    const noh_stage_terrain_desc *desc, void *memory, size_t bytes,
                                    noh_stage_terrain *out, noh_error *error);
void noh_stage_terrain_delete(noh_stage_terrain *terrain);

/* Create the GL objects again in a new context (gl_lost.h). `log` as in noh_gl_device.
 * errors  as noh_stage_terrain_create */
noh_result noh_stage_terrain_restore(noh_stage_terrain *terrain, char *log, size_t log_bytes, noh_error *error);

/* Choose the visible blocks, each at the coarsest level with an error of at most `pixels`. All later draws, the shadow
 * too, use this choice. */
void noh_stage_terrain_choose(noh_stage_terrain *terrain, const noh_stage_view *view, float pixels);

/* Draw into the current framebuffer and viewport, before or after the opaque pass of the stage.
 * stage    provides the light; NULL: none
 * state    gl_state.h */
void noh_stage_terrain_draw(noh_stage_terrain *terrain, const noh_stage *stage, const noh_stage_view *view);

/* Add the whole field to the shadow map of the stage, after noh_stage_draw_shadow. */
void noh_stage_terrain_draw_shadow(noh_stage_terrain *terrain, const noh_stage *stage, const noh_stage_view *view);

#ifdef __cplusplus
}
#endif

#endif
