/* stage_hair.h: the hair of an actor (wig.h) drawn: all strips in one call for each of its passes.
 *
 *   noh_stage_hair_size, noh_stage_hair_bytes   exact bytes on the CPU and on the GPU
 *   noh_stage_hair_create                       shaders and the texture of control hairs; _delete, _restore
 *   noh_stage_hair_update                       upload where an actor's control hairs are
 *   noh_stage_hair_draw                         what a view sees of it; noh_stage_hair_draw_shadow
 *
 * The vertex shader makes strips out of their numbers and a texture of control hairs (haircut.h); light is
 * Kajiya's and Kay's in two lobes. The opaque core of strips writes depth, then their fringe is blended.
 *
 * Threads: the context's own thread; noh_stage_hair_size and noh_stage_hair_bytes, any.
 * source   Kajiya, Kay: Rendering Fur with Three Dimensional Textures, 1989; Scheuermann: Practical Real-Time Hair
 *          Rendering and Shading, 2004 */
#ifndef NOH_STAGE_GL_STAGE_HAIR_H
#define NOH_STAGE_GL_STAGE_HAIR_H

#include "stage/actors/wig.h"
#include "gl/stage/stage_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_stage_hair {
    const noh_gl_api *gl;
    noh_gl_ledger *ledger;
    const noh_wig *wig;
    float *points; /* [hair_count][point_count][3] */
    int lit, encode_srgb;
    noh_gl_texture texture; /* GL_RGB32F: control hairs, then the corners of patches */
    unsigned color, depth;  /* programs */
    unsigned vertex_array;
    float world[12];        /* from head space */
    float pixels_per_metre; /* of head space; 0: nothing sees it */
    uint32_t views;         /* a bit for each that does */
    uint32_t draws;         /* calls of all noh_stage_hair_draw so far */
    uint32_t sets, bodies;  /* of a crowd (stage_hairs.h): sets of control hairs, heads; 0: one head */
} noh_stage_hair;

/* The exact bytes: 12 a control point. */
size_t noh_stage_hair_size(const noh_haircut *cut);

/* The exact bytes on the GPU: 12 a control point, and as many for each patch as a control hair has where they are
 * fewer than its points, rounded up to whole rows. */
uint64_t noh_stage_hair_bytes(const noh_haircut *cut);

/* Make it for one actor of a kind whose part is that of the wig, which must stay.
 * memory       [bytes] at least noh_stage_hair_size, aligned to NOH_MEMORY_ALIGN; it stays with the hair
 * lit          its stage has a light
 * encode_srgb  as in noh_stage_desc
 * errors       ARG memory is NULL or misaligned; MEMORY it is too small; DATA, GL, MEMORY as noh_gl_program_create and
 *              noh_gl_texture_create: nothing is left behind */
noh_result noh_stage_hair_create(const noh_gl_device *device, const noh_wig *wig, void *memory, size_t bytes, int lit,
                                 int encode_srgb, noh_stage_hair *out, noh_error *error);
void noh_stage_hair_delete(noh_stage_hair *hair);

/* Make its GL objects again in a new context (gl_lost.h). `log` as in noh_gl_device.
 * errors  as noh_stage_hair_create: it then has no GL objects */
noh_result noh_stage_hair_restore(noh_stage_hair *hair, char *log, size_t log_bytes, noh_error *error);

/* After noh_stage_frame_end: take over where an actor and its hair are.
 * part    of noh_kind_desc.parts
 * errors  NOT_FOUND the actor is gone or has no such part: nothing is drawn until the next update */
noh_result noh_stage_hair_update(noh_stage_hair *hair, noh_stage *stage, noh_actor actor, uint32_t part,
                                 noh_error *error);

/* Draw it into the framebuffer and viewport that are set, after the stage: one draw call for the core, one for the
 * fringe. From 50 pixels a metre down it fades, pixel by pixel, into what is painted on the head; from 25 down nothing
 * is drawn.
 * pass   NOH_PASS_COLOR, or one of its halves, or NOH_PASS_DEPTH
 * state  as noh_gl_draw_end leaves it */
void noh_stage_hair_draw(noh_stage_hair *hair, const noh_stage *stage, uint32_t view, noh_pass pass);

/* Add it to the shadow map, after noh_stage_draw_shadow. Framebuffer 0 is bound afterwards. */
void noh_stage_hair_draw_shadow(noh_stage_hair *hair, const noh_stage *stage, uint32_t view);

#ifdef __cplusplus
}
#endif

#endif
