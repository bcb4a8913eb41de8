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

/* Make a mesh without contents, for levels loaded later. Only the headers of `room`, the finest level that may be
 * loaded, are read, and they must stay. Before drawing, fill it from `mesh`, a coarser level of the same mesh; draws
 * show no finer level. After filling a finer level, set out->mesh to it, or back again.
 * errors  as noh_gl_mesh_create */
noh_result noh_gl_mesh_create_empty(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_mesh *room,
                                    const noh_mesh *mesh, noh_gl_mesh *out, noh_error *error);

/* Upload the next piece of a mesh and all its coarser levels, possibly from another pack than `room`. Data shared by
 * levels is overwritten with equal bytes, so the mesh may be drawn meanwhile. Leaves vertex array 0 bound.
 * ranges   *at: initially 0, then as left by the previous call; *bytes: most bytes to send, at least 64 for progress;
 *          the bytes sent are subtracted
 * returns  1 once everything is uploaded */
int noh_gl_mesh_fill(const noh_gl_api *api, const noh_gl_mesh *mesh, const noh_mesh *from, uint64_t *at,
                     uint32_t *bytes);

/* Find the variant of a key; encode_srgb and two_layers are taken from the renderer (0 for depth). NULL: no mesh of the
 * renderer's desc needs it. */
const noh_gl_variant *noh_gl_renderer_variant(const noh_gl_renderer *renderer, noh_gl_variant_key key);

#define NOH_PRIORITY_ANY 1000

/* Set the triangles for the next noh_gl_draw_mesh calls; noh_gl_draw_begin resets them to all. Borrowed until then.
 * NULL: all. */
void noh_gl_draw_triangles(noh_gl_renderer *renderer, const noh_gl_triangles *triangles);

#ifdef __cplusplus
}
#endif

#endif
