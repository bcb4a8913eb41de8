/* backdrop.h: the background of a lit stage: its environment, blurred and dimmed, or a gradient of its colours.
 *
 *   noh_backdrop_create   the GL objects; noh_backdrop_delete, noh_backdrop_restore
 *   noh_backdrop_draw     fill the viewport
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
    NOH_BACKDROP_GRADIENT, /* from the light from below to the light from above */
    NOH_BACKDROP_LIGHT     /* the environment as a rough mirror shows it */
} noh_backdrop_kind;

typedef struct noh_backdrop {
    noh_gl_drawable drawable;
    int encode_srgb;
} noh_backdrop;

/* encode_srgb  as in noh_stage_desc
 * errors       DATA, GL, MEMORY as noh_gl_program_create. It then has no GL objects */
noh_result noh_backdrop_create(const noh_gl_device *device, int encode_srgb, noh_backdrop *out, noh_error *error);
void noh_backdrop_delete(noh_backdrop *backdrop);

/* Create the GL objects again in a new context (gl_lost.h). `log` as in noh_gl_device.
 * errors  as noh_backdrop_create */
noh_result noh_backdrop_restore(noh_backdrop *backdrop, char *log, size_t log_bytes, noh_error *error);

/* Fill the current framebuffer and viewport with the background of `view`. Depth is not written.
 * light  noh_stage_light_of the stage
 * state  gl_state.h */
void noh_backdrop_draw(const noh_backdrop *backdrop, noh_backdrop_kind kind, const noh_gl_light *light,
                       const noh_lighting *lighting, const noh_stage_view *view);

#ifdef __cplusplus
}
#endif

#endif
