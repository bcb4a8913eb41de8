/* gl_material_internal.h (private to gl/): what a material needs of a variant. */
#ifndef NOH_GL_GL_MATERIAL_INTERNAL_H
#define NOH_GL_GL_MATERIAL_INTERNAL_H

#include "core/mesh/mesh_internal.h"
#include "noh/format.h"

/* The features of a material's outline; 0: it has none. */
uint32_t noh_gl_outline_features(const noh_material *m);

#endif
