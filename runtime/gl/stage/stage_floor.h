/* stage_floor.h: the shadow of what stands on a level floor, where there is no mesh for it to fall on.
 *
 *   noh_stage_floor_create   its program; noh_stage_floor_delete, noh_stage_floor_restore
 *   noh_stage_floor_draw     the shadow on a disc
 *
 * Draw it behind the background and before characters, once the shadow map was drawn. What is there is multiplied by what
 * the shadow leaves of the light, so the floor itself is not seen: it works on any picture. No memory on the GPU but a
 * program's.
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
    const noh_gl_api *gl;
    noh_gl_ledger *ledger;
    int encode_srgb;
    unsigned program, vertex_array;
} noh_stage_floor;

/* encode_srgb  as in noh_stage_desc
 * errors       DATA, GL, MEMORY as noh_gl_program_create: nothing is left behind */
noh_result noh_stage_floor_create(const noh_gl_device *device, int encode_srgb, noh_stage_floor *out, noh_error *error);
void noh_stage_floor_delete(noh_stage_floor *level);

/* Make its GL objects again in a new context (gl_lost.h). `log` as in noh_gl_device.
 * errors  as noh_stage_floor_create: it then has no GL objects */
noh_result noh_stage_floor_restore(noh_stage_floor *level, char *log, size_t log_bytes, noh_error *error);

/* Into the framebuffer and viewport that are set. From below nothing is seen of it; without a shadow map nothing is drawn.
 * light   of the stage: noh_stage_light_of
 * shapes  disc[4]: centre in the world, radius; the shadow fades over the outer half. Twice the radius that
 *         noh_lighting_shadow was told holds the shadow of a light that stands at 45 degrees or higher
 * state   gl_state.h */
void noh_stage_floor_draw(const noh_stage_floor *level, const noh_gl_light *light, const noh_lighting *lighting,
                          const noh_stage_view *view, const float disc[4]);

#ifdef __cplusplus
}
#endif

#endif
