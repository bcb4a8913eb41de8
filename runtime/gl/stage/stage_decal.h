/* stage_decal.h: the marks of decal.h drawn on actors.
 *
 *   noh_stage_decals_size, noh_stage_decals_create   programs for the meshes of a stage, and room for one ring;
 *                                                    _delete, _restore
 *   noh_stage_decals_draw                            the marks of an actor
 *
 * Whatever rests within a mark's sphere and faces as it does has it, also a fold that only touches there;
 * stage_patch.h draws the same marks without.
 *
 * The meshes that have marks are drawn once more, all marks of one in one draw: pixels without a mark are discarded,
 * the others are blended over the surface, lit as it is, with its normal map and wrinkles. Levels may fade meanwhile.
 *
 * On the GPU: 4,096 bytes, and a picture of yours. Threads: the context's own thread. */
#ifndef NOH_STAGE_GL_STAGE_DECAL_H
#define NOH_STAGE_GL_STAGE_DECAL_H

#include "stage/actors/decal.h"
#include "gl/stage/stage_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_STAGE_DECALS_BYTES 4096u /* on the GPU */

/* What is drawn on the marks: tiles of a texture, from its upper left corner on. */
typedef struct noh_decal_picture {
    unsigned texture;       /* GL_TEXTURE_2D, sRGB, with alpha that is not multiplied in; 0: round spots, without one */
    uint32_t columns, rows; /* of tiles, 1..; texture 0: not used */
} noh_decal_picture;

typedef struct noh_decal_program noh_decal_program;

typedef struct noh_stage_decals {
    noh_gl_drawable drawable; /* a texture, GL_RGBA32F, 4 x NOH_DECALS_MAX */
    noh_stage *stage;
    noh_stage_shader *shader;
    noh_decal_program *programs; /* [program_count] of the shader */
    uint32_t program_count;
    noh_decal_picture picture;
    /* of the current draw: */
    uint32_t count;
    unsigned corners; /* texture of stage_patch.h; 0: decals are projected */
    uint32_t corner_row;
    int reversed; /* depth falls with distance */

    uint32_t draws; /* draw calls so far */
} noh_stage_decals;

/* The exact bytes of memory, of a stage with `gpu`. */
size_t noh_stage_decals_size(const noh_stage *stage);

/* memory   [bytes] at least noh_stage_decals_size, aligned to NOH_MEMORY_ALIGN; it stays with the decals
 * device   as the stage was made with
 * picture  NULL: round spots. Its texture must stay
 * out      must stay where it is: shaders know it
 * errors   ARG, MEMORY, DATA, GL as noh_stage_shader_create and noh_gl_texture_create: nothing is left behind */
noh_result noh_stage_decals_create(noh_stage *stage, const noh_gl_device *device, void *memory, size_t bytes,
                                   const noh_decal_picture *picture, noh_stage_decals *out, noh_error *error);
void noh_stage_decals_delete(noh_stage_decals *decals);

/* Make its GL objects again in a new context (gl_lost.h); picture as in noh_stage_decals_create. `log` as in
 * noh_gl_device.
 * errors  as noh_stage_decals_create: it then has no GL objects */
noh_result noh_stage_decals_restore(noh_stage_decals *decals, const noh_decal_picture *picture, char *log,
                                    size_t log_bytes, noh_error *error);

/* After noh_stage_draw of NOH_PASS_OPAQUE or NOH_PASS_COLOR of the same view, into the same framebuffer.
 * ring    of that actor
 * state   as noh_gl_draw_end leaves it
 * errors  NOT_FOUND the actor is gone, or the view did not see it: nothing is drawn; ARG as noh_stage_draw */
noh_result noh_stage_decals_draw(noh_stage_decals *decals, uint32_t view, noh_actor actor, const noh_decals *ring,
                                 noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
