/* gl_material_internal.h (private to gl/): the material of a submesh. */
#ifndef NOH_GL_GL_MATERIAL_INTERNAL_H
#define NOH_GL_GL_MATERIAL_INTERNAL_H

#include "mesh/mesh.h"

/* glTF's default material for a submesh without one. */
const noh_material *noh_gl_material_of(const noh_mesh *mesh, const noh_submesh *submesh);

#endif
