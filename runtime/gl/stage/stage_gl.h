/* stage_gl.h: a stage drawn by OpenGL ES 3.
 *
 *   noh_stage_on_gl           its address goes into noh_stage_desc.gpu; noh_stage_init then takes a noh_gl_device
 *   noh_stage_draw            one pass of what a view of the last frame sees
 *   noh_stage_set_lighting    the light of a stage with noh_stage_desc.light
 *   noh_stage_draw_shadow     its shadow map
 *   noh_stage_shader_size     shaders of your own in place of the library's:
 *   noh_stage_shader_create   in every variant that the kinds of the stage need
 *   noh_stage_shader_delete, noh_stage_shader_restore
 *   noh_stage_morph_plan      how its targets are accumulated
 *   noh_actor_on_gl           the GL objects of an actor, for draws of your own
 *
 * On the GPU a mesh of a pack is there once, however many kinds draw it. Actors at the same level are drawn by one call
 * for each submesh, those that fade between two levels one by one.
 *
 * Threads: the context's own thread. */
#ifndef NOH_STAGE_GL_STAGE_GL_H
#define NOH_STAGE_GL_STAGE_GL_H

#include "gl/draw/gl_draw.h"
#include "gl/draw/gl_light.h"
#include "stage/cast/stage.h"

#ifdef __cplusplus
extern "C" {
#endif

extern const noh_stage_gpu noh_stage_on_gl;

typedef enum noh_pass {
    NOH_PASS_COLOR = 0, /* opaque, then blended */
    NOH_PASS_OPAQUE,
    NOH_PASS_BLENDED,
    NOH_PASS_DEPTH /* what NOH_PASS_OPAQUE draws, positions alone: shadow maps, depth first */
} noh_pass;

typedef struct noh_stage_shader noh_stage_shader;

#define NOH_DRAWABLE_UNIFORMS 14u

/* The GL objects of a backdrop, a floor, blobs, hair, decals, patches or a terrain: private to their functions. All
 * zeros: not created, and deleting it does nothing. */
typedef struct noh_gl_drawable {
    const noh_gl_api *gl; /* NULL: not created */
    noh_gl_ledger *ledger;
    uint32_t units;       /* texture units that its programs read, from 0 on */
    unsigned programs[2]; /* 0: colour, 1: depth alone */
    unsigned vertex_array;
    noh_gl_texture texture;
    noh_gl_buffer buffer;
    int uniforms[2][NOH_DRAWABLE_UNIFORMS]; /* locations in each program; -1: not used by it */
} noh_gl_drawable;

/* Draw what the view-th view of the last frame sees, into the framebuffer and viewport that are set. In a view without
 * height_px actors with no_shadow are left out.
 * shader  NULL: the library's
 * state   gl_state.h: depth function, front face and blending are yours
 * errors  ARG the stage is lit and no lighting was set; the last frame had no such view, or a frame has begun and not
 * ended; or the desc is without_shader or without_depth, and this draw needs it */
noh_result noh_stage_draw(noh_stage *stage, noh_pass pass, uint32_t view, noh_stage_shader *shader, noh_error *error);

/* What shaders are told of the light from now on; only in a stage with noh_stage_desc.light, which draws no colour
 * without it. Borrowed, and read at each noh_stage_draw. NULL: none. */
void noh_stage_set_lighting(noh_stage *stage, const noh_lighting *lighting);

/* Its textures, for shaders of your own that show what is behind; NULL without noh_stage_desc.light. */
const noh_gl_light *noh_stage_light_of(const noh_stage *stage);

/* Draw what a view sees into the stage's shadow map: one without height_px, as noh_view_shadow makes it.
 * state   gl_state.h
 * errors  ARG as noh_stage_draw of NOH_PASS_DEPTH; the desc has no light with a shadow map */
noh_result noh_stage_draw_shadow(noh_stage *stage, uint32_t view, noh_error *error);

/* Shaders of your own (gl_variants.h; shaders_es/README.md says what they can call). They are made in memory of yours.
 * log     as in noh_gl_device: what the driver says of them
 * errors  ARG memory is NULL or misaligned; MEMORY it is too small; else as noh_gl_renderer_create */
size_t noh_stage_shader_size(const noh_stage *stage);
noh_result noh_stage_shader_create(noh_stage *stage, void *memory, size_t bytes, const noh_gl_shader_desc *desc,
                                   char *log, size_t log_bytes, noh_stage_shader **shader, noh_error *error);
void noh_stage_shader_delete(noh_stage_shader *shader);

/* After a lost context.
 * errors  as noh_gl_renderer_restore */
noh_result noh_stage_shader_restore(noh_stage_shader *shader, char *log, size_t log_bytes, noh_error *error);

/* How the first mesh that has targets is accumulated, or would be in a stage of this plan: path, format and reason.
 * Needs no driver.
 * errors  as noh_gl_morph_plan_make */
noh_result noh_stage_morph_plan(const noh_stage_desc *desc, const noh_gl_caps *caps, const noh_stage_plan *plan,
                                noh_gl_morph_plan *out, noh_error *error);

/* A mesh of an actor on the GPU. */
typedef struct noh_stage_drawn {
    const noh_gl_mesh *mesh; /* the stage's, valid as long as it is */
    noh_gl_morph_binding morph;
    noh_gl_skin_binding skin;
    int is_morphed, is_skinned;     /* 0: that binding is zeros, and not to be used */
    const noh_gl_texture *pictures; /* [texture_count] of its mesh pack, of the texture set that the actor wears */
} noh_stage_drawn;

/* The index-th mesh of an actor, as noh_actor_mesh_at counts them. Valid until the next frame.
 * errors  NOT_FOUND the actor is gone, has no such mesh, or no view of the last frame saw it */
noh_result noh_actor_on_gl(noh_stage *stage, noh_actor actor, uint32_t index, noh_stage_drawn *out, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
