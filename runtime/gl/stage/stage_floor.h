/* stage_floor.h: the shadow of actors on a level floor that has no mesh.
 *
 *   noh_stage_floor_create   the GL objects; noh_stage_floor_delete, noh_stage_floor_restore
 *   noh_stage_floor_draw     the shadow on a disc
 *
 * Draw it after the background and before characters, once the shadow map is drawn. It multiplies the colours in the
 * framebuffer and the floor itself is invisible, so it works on any background. It takes no GPU memory besides its
 * program.
 *
 * Threads: the context's own thread. */
#ifndef NOH_STAGE_GL_STAGE_FLOOR_H
#define NOH_STAGE_GL_STAGE_FLOOR_H

#include "stage/cast/view.h"
#include "gl/stage/stage_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_stage_floor {
    noh_gl_drawable drawable;
    int encode_srgb;
} noh_stage_floor;

/* encode_srgb  as in noh_stage_desc
 * errors       DATA, GL, MEMORY as noh_gl_program_create. It then has no GL objects */
noh_result noh_stage_floor_create(const noh_gl_device *device, int encode_srgb, noh_stage_floor *out, noh_error *error);
void noh_stage_floor_delete(noh_stage_floor *shadow);

/* Create the GL objects again in a new context (gl_lost.h). `log` as in noh_gl_device.
 * errors  as noh_stage_floor_create */
noh_result noh_stage_floor_restore(noh_stage_floor *shadow, char *log, size_t log_bytes, noh_error *error);

/* Draw into the current framebuffer and viewport. Nothing is drawn from below, nor without a shadow map.
 * light   noh_stage_light_of the stage
 * shapes  disc[4]: world position of the centre, radius. The shadow fades over the outer half. A light at 45 degrees or
 *         higher keeps its shadow within twice the radius given to noh_lighting_shadow
 * state   gl_state.h */
void noh_stage_floor_draw(const noh_stage_floor *shadow, const noh_gl_light *light, const noh_lighting *lighting,
                          const noh_stage_view *view, const float disc[4]);

#ifdef __cplusplus
}
#endif

#endif
