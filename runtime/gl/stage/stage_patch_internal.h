/* stage_patch_internal.h (private to gl/stage/): between stage_decal.c, which draws decals, and stage_patch.c, which
 * knows the triangles over which they have grown. */
#ifndef NOH_STAGE_GL_STAGE_PATCH_INTERNAL_H
#define NOH_STAGE_GL_STAGE_PATCH_INTERNAL_H

#include "gl/stage/stage_gl_internal.h"
#include "noh/base.h"
#include "noh/low_gl.h"
#include "noh/marks.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_PATCH_WIDTH 256u /* texels in a row of the texture */
#define NOH_PATCH_ROWS(capacity, triangles) \
    (((capacity) + 1u + (triangles) + NOH_PATCH_WIDTH - 1u) / NOH_PATCH_WIDTH) /* for a level */

#ifdef __cplusplus
}
#endif

/* The visible decals on one mesh of the pack, the oldest first: marks[returned] are indices in the ring. */
uint32_t noh_gl_decals_of(const noh_decals *ring, uint32_t mesh, uint8_t marks[NOH_DECALS_MAX]);

/* patches  NULL: decals are projected */
noh_result noh_gl_decals_draw(noh_stage_decals *decals, noh_stage_patches *patches, uint32_t view, noh_actor actor,
                              const noh_decals *ring, noh_error *error);

/* Call it before the meshes of a draw. */
void noh_gl_patches_begin(noh_stage_patches *patches, const noh_gl_alone *alone);

/* Get the triangles of the decals on one mesh at one LOD level of the actor. They grow now if they have not yet.
 * row      where the first decal begins in the texture of corners
 * returns  0: there are no triangles */
int noh_gl_patches_grow(noh_stage_patches *patches, const noh_gl_alone *alone, uint32_t mesh, uint32_t level,
                        const noh_decals *ring, noh_gl_triangles *out, uint32_t *row);

#endif
