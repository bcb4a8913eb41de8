/* low_gl.h: what the library keeps to itself of runtime/noh/low_gl.h. */
#ifndef NOH_GL_GL_SKIN_H
#define NOH_GL_GL_SKIN_H

#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The names "auto", "uniform", "texture". */
const char *noh_palette_mode_name(noh_palette_mode mode);

/* Set matrices in two halves, so that several threads may write different instances at once, with no other call on the
 * object meanwhile. An update sends written matrices only if noh_gl_skin_touch was called for the instance afterwards.
 * returns  1 if a row changed */
int noh_gl_skin_write_matrices(noh_gl_skin *skin, uint32_t instance, const float *matrices);
void noh_gl_skin_touch(noh_gl_skin *skin, uint32_t instance);

/* The first row of a palette, counted from the instance's own first row. */
uint32_t noh_gl_palette_row(const noh_gl_skin_binding *binding, const noh_mesh *mesh, uint32_t palette);

/* Rows of one joint of a mesh: 3 or 4. In a uniform buffer, the range to bind for a palette begins at byte
 * 16 * (binding.first + noh_gl_palette_row(...)) and holds NOH_PALETTE_JOINTS_MAX joints. */
uint32_t noh_gl_joint_rows(const noh_mesh *mesh);

/* Get the rows that transform normals: the inverse transpose of the 3 x 3 part of a placement, up to a positive factor.
 * They are its cofactors times the sign of its determinant, without division, so the normals of a mirrored node still
 * point outwards. (The matrix itself would be correct only for rotations and uniform scales.) Returns the determinant.
 * source  Turkowski, "Properties of Surface-Normal Transformations", Graphics Gems (1990) */
float noh_gl_normal_rows(const float world[12], float rows[12]);

#ifdef __cplusplus
}
#endif

#endif
