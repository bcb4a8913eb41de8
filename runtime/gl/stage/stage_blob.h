/* stage_blob.h: blob shadows (blob.h) drawn on the ground.
 *
 *   noh_stage_blob_create   the GL objects; noh_stage_blob_delete, noh_stage_blob_restore
 *   noh_stage_blob_draw     all blobs of a view
 *
 * Draw them after the ground and before characters. A blob multiplies the colours in the framebuffer, so it works on any
 * ground, and on a background without one. It takes no GPU memory besides its program.
 *
 * Threads: the context's own thread. */
#ifndef NOH_STAGE_GL_STAGE_BLOB_H
#define NOH_STAGE_GL_STAGE_BLOB_H

#include "stage/actors/blob.h"
#include "gl/stage/stage_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_BLOBS_DRAWN 32 /* blobs in one draw call */

typedef struct noh_stage_blob {
    noh_gl_drawable drawable;
    uint32_t draws; /* draw calls so far */
} noh_stage_blob;

/* errors  DATA, GL, MEMORY as noh_gl_program_create. It then has no GL objects */
noh_result noh_stage_blob_create(const noh_gl_device *device, noh_stage_blob *out, noh_error *error);
void noh_stage_blob_delete(noh_stage_blob *blob);

/* Create the GL objects again in a new context (gl_lost.h). `log` as in noh_gl_device.
 * errors  as noh_stage_blob_create */
noh_result noh_stage_blob_restore(noh_stage_blob *blob, char *log, size_t log_bytes, noh_error *error);

/* Draw into the current framebuffer and viewport, NOH_BLOBS_DRAWN blobs per draw call.
 * shapes  blobs[count]
 * state   gl_state.h */
void noh_stage_blob_draw(noh_stage_blob *blob, const noh_stage_view *view, const noh_blob *blobs, uint32_t count);

#ifdef __cplusplus
}
#endif

#endif
