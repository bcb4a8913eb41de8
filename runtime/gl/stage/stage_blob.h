/* stage_blob.h: the spots of blob.h drawn on the ground.
 *
 *   noh_stage_blob_create   its program; noh_stage_blob_delete, noh_stage_blob_restore
 *   noh_stage_blob_draw     all spots of a view
 *
 * Draw them behind the ground and before characters. What is there is multiplied by what a spot leaves, so it works on
 * any ground, and on a picture that has none. No memory on the GPU but a program's.
 *
 * Threads: the context's own thread. */
#ifndef NOH_STAGE_GL_STAGE_BLOB_H
#define NOH_STAGE_GL_STAGE_BLOB_H

#include "stage/actors/blob.h"
#include "gl/stage/stage_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_BLOBS_DRAWN 32 /* in one draw */

typedef struct noh_stage_blob {
    const noh_gl_api *gl;
    noh_gl_ledger *ledger;
    unsigned program, vertex_array;
    int camera, rows; /* uniforms */
    uint32_t draws;   /* calls of all noh_stage_blob_draw so far */
} noh_stage_blob;

/* errors  DATA, GL, MEMORY as noh_gl_program_create: nothing is left behind */
noh_result noh_stage_blob_create(const noh_gl_device *device, noh_stage_blob *out, noh_error *error);
void noh_stage_blob_delete(noh_stage_blob *blob);

/* Make its GL objects again in a new context (gl_lost.h). `log` as in noh_gl_device.
 * errors  as noh_stage_blob_create: it then has no GL objects */
noh_result noh_stage_blob_restore(noh_stage_blob *blob, char *log, size_t log_bytes, noh_error *error);

/* Into the framebuffer and viewport that are set; NOH_BLOBS_DRAWN to a draw.
 * shapes  blobs[count]
 * state   gl_state.h */
void noh_stage_blob_draw(noh_stage_blob *blob, const noh_stage_view *view, const noh_blob *blobs, uint32_t count);

#ifdef __cplusplus
}
#endif

#endif
