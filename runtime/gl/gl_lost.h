/* gl_lost.h: after a context is gone.
 *
 * A lost context takes every GL object with it. What lies in your memory stays:
 * packs, weights, poses. Make a context, fill the same noh_gl_api with
 * noh_gl_api_load (the table is used where it is), and restore each object:
 *
 *   noh_gl_mesh_restore, noh_gl_picture_restore, noh_gl_renderer_restore  gl_draw.h
 *   noh_gl_morph_restore                                                  gl_morph.h
 *   noh_gl_skin_restore                                                   gl_skin.h
 *
 * They count the old names out of the ledger without a call to GL (in the new
 * context these names may be somebody else's objects) and make new ones from the
 * pack, so that the ledger stands as before, to the byte. The new context must have
 * the abilities that the old one had: noh_gl_caps_probe again, and where they differ
 * delete with the table below and plan anew.
 *
 *   noh_gl_lost_api  a table whose glDelete* do nothing: any noh_gl_*_delete that
 *                    takes an api counts its object out with it */
#ifndef NOH_GL_GL_LOST_H
#define NOH_GL_GL_LOST_H

#include "gl/gl_api.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Every function but glDelete* is NULL. */
const noh_gl_api *noh_gl_lost_api(void);

#ifdef __cplusplus
}
#endif

#endif
