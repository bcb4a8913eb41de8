/* gl_lost.h: recovery after a lost context.
 *
 * All GL objects of a lost context are gone; packs, weights and poses in your memory stay valid. Make a new context,
 * fill the same noh_gl_api with noh_gl_api_load (objects point to this table), and restore each object:
 *
 *   noh_gl_mesh_restore, noh_gl_picture_restore, noh_gl_renderer_restore  gl_draw.h
 *   noh_gl_morph_restore                                                  gl_morph.h
 *   noh_gl_skin_restore                                                   gl_skin.h
 *
 * Each removes the old names from the ledger without calling GL, because in the new context these names may belong to
 * other objects, and makes new objects from the pack. The ledger then has the same bytes as before. The new context
 * must have the same capabilities as the old one: probe it with noh_gl_caps_probe. If they differ, or if there is no
 * new context, release the objects without calling GL and plan again: pass the table below to a noh_gl_*_delete that
 * takes an api, and call noh_gl_*_forget for the others. For a stage, copy the table below over your own, then call
 * noh_stage_delete.
 *
 *   noh_gl_lost_api  a table whose delete functions do nothing
 *
 * Threads: any; the table's functions do nothing. */
#ifndef NOH_GL_GL_LOST_H
#define NOH_GL_GL_LOST_H

#include "gl/device/gl_api.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A table whose delete functions do nothing; all other functions are NULL. */
const noh_gl_api *noh_gl_lost_api(void);

#ifdef __cplusplus
}
#endif

#endif
