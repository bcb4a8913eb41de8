/* stage_terrain.h: a height field drawn as the ground of a stage, in blocks at the levels of terrain_lod.h.
 *
 *   noh_stage_terrain_size, noh_stage_terrain_bytes   exact bytes on the CPU and on the GPU
 *   noh_stage_terrain_create                          shaders and the texture of heights; _delete, _restore
 *   noh_stage_terrain_choose                          levels for a view
 *   noh_stage_terrain_draw                            what it sees; noh_stage_terrain_draw_shadow
 *
 * There are no vertices: the vertex shader makes them of their numbers and a texture of the field's heights as they
 * are, 16 bits each. A block is one draw, of at most 2,048 triangles; no block changes a byte on the GPU.
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
    int lit, encode_srgb;    /* lit: its stage has a light; encode_srgb: as in noh_stage_desc */
    float flat[3], steep[3]; /* linear colours; default (0) those of grass and of rock */
} noh_stage_terrain_desc;

typedef struct noh_stage_terrain {
    const noh_gl_api *gl;
    noh_gl_ledger *ledger;
    noh_stage_terrain_desc desc;
    noh_terrain_lod lod;
    noh_gl_texture heights; /* GL_R16UI */
    unsigned color, depth;  /* programs */
    unsigned vertex_array;
    uint32_t draws, triangles; /* of the last noh_stage_terrain_draw */
} noh_stage_terrain;

/* Those of noh_terrain_lod_size; the GPU's: 2 a height. */
size_t noh_stage_terrain_size(const noh_field *field);
uint64_t noh_stage_terrain_bytes(const noh_field *field);

/* field    in the stage's unit; its heights have to stay
 * memory   [bytes] at least noh_stage_terrain_size, aligned to NOH_MEMORY_ALIGN; it stays with the terrain
 * errors   ARG memory is NULL or misaligned, or the field has fewer than 2 x 2 heights; LIMIT more heights along a side
 *          than a texture of device->caps has texels; MEMORY it is too small; DATA, GL, MEMORY as noh_gl_program_create
 *          and noh_gl_texture_create: nothing is left behind */
noh_result noh_stage_terrain_create(const noh_gl_device *device, const noh_field *field,
                                    const noh_stage_terrain_desc *desc, void *memory, size_t bytes,
                                    noh_stage_terrain *out, noh_error *error);
void noh_stage_terrain_delete(noh_stage_terrain *terrain);

/* Make its GL objects again in a new context (gl_lost.h). `log` as in noh_gl_device.
 * errors  as noh_stage_terrain_create: it then has no GL objects */
noh_result noh_stage_terrain_restore(noh_stage_terrain *terrain, char *log, size_t log_bytes, noh_error *error);

/* Blocks that a view sees, each at the coarsest level that is off by at most `pixels`; as long as there is no other
 * call, what is drawn is drawn so, the shadow too. */
void noh_stage_terrain_choose(noh_stage_terrain *terrain, const noh_stage_view *view, float pixels);

/* Draw it into the framebuffer and viewport that are set, before or after the stage's opaque pass.
 * stage    its light is the ground's; NULL where that has none
 * state    gl_state.h */
void noh_stage_terrain_draw(noh_stage_terrain *terrain, const noh_stage *stage, const noh_stage_view *view);

/* Add all of it to the stage's shadow map, after noh_stage_draw_shadow. */
void noh_stage_terrain_draw_shadow(noh_stage_terrain *terrain, const noh_stage *stage, const noh_stage_view *view);

#ifdef __cplusplus
}
#endif

#endif
