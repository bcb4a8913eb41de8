/* gl_renderer_internal.h: lists the variants that a renderer compiles. Also serves callers that need their number
 * before the meshes are in one array. */
#ifndef NOH_GL_GL_RENDERER_INTERNAL_H
#define NOH_GL_GL_RENDERER_INTERNAL_H

#include "noh/base.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

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
