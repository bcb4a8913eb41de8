/* gl_material_internal.h (private to gl/): the material of a submesh. */
#ifndef NOH_GL_GL_MATERIAL_INTERNAL_H
#define NOH_GL_GL_MATERIAL_INTERNAL_H

#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"

/* glTF's default material for a submesh without one. */
const noh_material *noh_gl_material_of(const noh_mesh *mesh, const noh_submesh *submesh);

/* The features of a material's outline; 0: it has none. */
uint32_t noh_gl_outline_features(const noh_material *m);

/* The core of a blended surface, where alpha is at least this, is drawn as opaque. */
#define NOH_GL_CORE_ALPHA 0.9f

static inline int noh_gl_has_core(const noh_material *m)
{
    return (m->flags & NOH_MATERIAL_BLEND) && m->base_color_texture != NOH_NONE;
}

#endif
