/* gl_lost.h: after a context was lost.
 *
 * A lost context takes every GL object with it. What is in your memory is still valid: packs, weights, poses. Make a
 * new context, fill the same noh_gl_api with noh_gl_api_load (objects point to that table), and restore each object:
 *
 *   noh_gl_mesh_restore, noh_gl_picture_restore, noh_gl_renderer_restore  gl_draw.h
 *   noh_gl_morph_restore                                                  gl_morph.h
 *   noh_gl_skin_restore                                                   gl_skin.h
 *
 * Each takes the old names out of the ledger without calling GL, because in the new context these names may be other
 * objects, and makes new objects from the pack. The ledger is then as before, to the byte. The new context must have
 * the capabilities of the old one: probe it with noh_gl_caps_probe. If they differ, or if there is no new context, let
 * go of the objects without calling GL, and plan again: noh_gl_*_delete that take an api take the table below, the
 * others have a noh_gl_*_forget. A stage has neither: copy the table below over your own, then noh_stage_delete.
 *
 *   noh_gl_lost_api  a table whose delete functions do nothing
 *
 * Threads: any; the table touches nothing. */
#ifndef NOH_GL_GL_LOST_H
#define NOH_GL_GL_LOST_H

#include "gl/device/gl_api.h"

#ifdef __cplusplus
extern "C" {
#endif

/* All its other functions are NULL. */
const noh_gl_api *noh_gl_lost_api(void);

#ifdef __cplusplus
}
#endif

#endif
