/* backdrop.h: what is behind a lit stage: the light itself, blurred and dimmed, or a gradient of its colours.
 *
 *   noh_backdrop_create   its program; noh_backdrop_delete, noh_backdrop_restore
 *   noh_backdrop_draw     over the whole viewport
 *
 * Threads: the context's own thread. */
#ifndef NOH_STAGE_GL_BACKDROP_H
#define NOH_STAGE_GL_BACKDROP_H

#include "stage/cast/view.h"
#include "gl/stage/stage_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum noh_backdrop_kind {
    NOH_BACKDROP_GRADIENT, /* from what comes from below to what comes from above */
    NOH_BACKDROP_LIGHT     /* what is mirrored, as a rough surface does */
} noh_backdrop_kind;

typedef struct noh_backdrop {
    const noh_gl_api *gl;
    noh_gl_ledger *ledger;
    int encode_srgb;
    unsigned program, vertex_array;
} noh_backdrop;

/* encode_srgb  as in noh_stage_desc
 * errors       DATA, GL, MEMORY as noh_gl_program_create: nothing is left behind */
noh_result noh_backdrop_create(const noh_gl_device *device, int encode_srgb, noh_backdrop *out, noh_error *error);
void noh_backdrop_delete(noh_backdrop *backdrop);

/* Make its GL objects again in a new context (gl_lost.h). `log` as in noh_gl_device.
 * errors  as noh_backdrop_create: it then has no GL objects */
noh_result noh_backdrop_restore(noh_backdrop *backdrop, char *log, size_t log_bytes, noh_error *error);

/* Fill the framebuffer and viewport that are set with what `view` looks into, as `lighting` exposes and turns it.
 * light  of the stage: noh_stage_light_of
 * state  gl_state.h; depth is not written */
void noh_backdrop_draw(const noh_backdrop *backdrop, noh_backdrop_kind kind, const noh_gl_light *light,
                       const noh_lighting *lighting, const noh_stage_view *view);

#ifdef __cplusplus
}
#endif

#endif
