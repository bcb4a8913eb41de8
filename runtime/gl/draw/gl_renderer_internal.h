/* gl_renderer_internal.h: lists the variants that a renderer compiles. Also serves callers that need their number
 * before the meshes are in one array. */
#ifndef NOH_GL_GL_RENDERER_INTERNAL_H
#define NOH_GL_GL_RENDERER_INTERNAL_H

#include "noh/base.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

/* The exact GPU bytes of a mesh's buffers. `mesh` may be any LOD level: data used only by finer levels is not
 * counted. */
uint64_t noh_gl_mesh_bytes(const noh_mesh *mesh);

/* Release the GL objects of a lost context without GL calls (gl_device.h). They may be restored later. */
void noh_gl_renderer_forget(noh_gl_renderer *renderer);

/* Set the light of a renderer with `lit`, from the next noh_gl_draw_begin on. Both are borrowed, and read by draws. */
void noh_gl_renderer_light(noh_gl_renderer *renderer, const noh_gl_light *light, const noh_lighting *lighting);

/* Draw only blended submeshes with materials of this priority in the next noh_gl_draw_mesh and noh_gl_draw_crowd calls.
 * To sort the meshes of a figure, draw them once for each priority, from low to high, and within a priority from far to
 * near. NOH_PRIORITY_ANY, the state after noh_gl_draw_begin: all, from low to high, and for equal priorities in the
 * order of the pack. Opaque submeshes are always drawn. */
void noh_gl_draw_priority(noh_gl_renderer *renderer, int priority);

/* Set the wrinkle models for the next noh_gl_draw_mesh and noh_gl_draw_crowd calls.
 * models    NOH_WRINKLE_BY_*; 0, the state after noh_gl_draw_begin: the material's
 * smoothed  0..255: how far wrinkles are smoothed out; 255: completely */
void noh_gl_draw_wrinkle_look(noh_gl_renderer *renderer, uint32_t models, uint32_t smoothed);

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

typedef struct noh_gl_variant_list {
    noh_gl_variant_key keys[NOH_GL_VARIANTS_MAX];
    uint32_t count;
} noh_gl_variant_list;

/* Add every variant that may draw a mesh; `meshes` of the desc is not read. Start with a count of 0.
 * errors  LIMIT more than NOH_GL_VARIANTS_MAX */
noh_result noh_gl_list_variants(const noh_gl_renderer_desc *desc, const noh_mesh *mesh, noh_gl_variant_list *list,
                                noh_error *error);
static inline size_t noh_gl_variants_size(const noh_gl_variant_list *list)
{
    return list->count * sizeof(noh_gl_variant);
}

#endif
