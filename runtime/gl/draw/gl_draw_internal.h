/* gl_draw_internal.h: the private part of low_gl.h. */
#ifndef NOH_GL_GL_DRAW_INTERNAL_H
#define NOH_GL_GL_DRAW_INTERNAL_H

#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Find the variant of a key; encode_srgb and two_layers are taken from the renderer (0 for depth). NULL: no mesh of the
 * renderer's desc needs it. */
const noh_gl_variant *noh_gl_renderer_variant(const noh_gl_renderer *renderer, noh_gl_variant_key key);

/* Set the triangles for the next noh_gl_draw_mesh calls; noh_gl_draw_begin resets them to all. Borrowed until then.
 * NULL: all. */
void noh_gl_draw_triangles(noh_gl_renderer *renderer, const noh_gl_triangles *triangles);

/* Set the buffer of indices that the next draws use in place of the mesh's, with the same levels at the same places;
 * noh_gl_draw_begin resets it to 0, the mesh's own. */
void noh_gl_draw_cover(noh_gl_renderer *renderer, unsigned indices);

/* What the next draws show as of the last frame; noh_gl_draw_begin resets it to NULL, as they are now. Borrowed until
 * then. A crowd has world and tile in its rows. */
typedef struct noh_gl_before {
    float view_projection[16];
    float world[12];
    float tile[4]; /* noh_gl_tile_floats */
} noh_gl_before;
void noh_gl_draw_before(noh_gl_renderer *renderer, const noh_gl_before *before);

/* Whether a context, or a plan for one, can hold a texture. ETC2 and EAC are decoded for those without.
 * errors  UNSUPPORTED the texture has ASTC blocks and `astc` is 0 */
noh_result noh_gl_picture_check(const noh_texture *texture, int astc, noh_error *error);

/* The functions of low_gl.h for the levels from `first` on, which are then the object's levels from 0 on. */
uint64_t noh_gl_picture_bytes_from(const noh_texture *texture, int etc2, uint32_t first);
noh_result noh_gl_picture_create_from(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_texture *texture,
                                      uint32_t first, noh_gl_texture *out, noh_error *error);

/* A texture without pixels; errors as noh_gl_picture_create. */
noh_result noh_gl_picture_create_empty(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_texture *texture,
                                       uint32_t first, noh_gl_texture *out, noh_error *error);

/* Make a mesh with the buffers of `of`, which has the same levels. The last mesh that has them deletes them.
 * errors  as noh_gl_mesh_create */
noh_result noh_gl_mesh_create_on(const noh_gl_api *api, const noh_mesh *mesh, const noh_gl_mesh *of, noh_gl_mesh *out,
                                 noh_error *error);

/* Upload the next piece of its pixels.
 * ranges   *at: initially 0, then as left by the previous call; *bytes: most bytes to send, at least 64 for progress;
 *          the bytes sent are subtracted
 * returns  1 once everything is uploaded */
int noh_gl_picture_fill(const noh_gl_api *api, const noh_texture *texture, uint32_t first,
                        const noh_gl_texture *picture, uint32_t *at, uint32_t *bytes);

#ifdef __cplusplus
}
#endif

#endif
