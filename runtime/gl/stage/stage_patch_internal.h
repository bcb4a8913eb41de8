/* stage_patch_internal.h (private to stage_gl/): between stage_decal.c, which draws marks, and stage_patch.c, which
 * knows where they have grown. */
#ifndef NOH_STAGE_GL_STAGE_PATCH_INTERNAL_H
#define NOH_STAGE_GL_STAGE_PATCH_INTERNAL_H

#include "gl/stage/stage_gl_internal.h"
#include "noh/base.h"
#include "noh/low_gl.h"
#include "noh/marks.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

/* The marks of one mesh of the pack that show, the oldest first: marks[returned], places in the ring. */
uint32_t noh_gl_decals_of(const noh_decals *ring, uint32_t mesh, uint8_t marks[NOH_DECALS_MAX]);

/* patches  NULL: marks are looked up alone */
noh_result noh_gl_decals_draw(noh_stage_decals *decals, noh_stage_patches *patches, uint32_t view, noh_actor actor,
                              const noh_decals *ring, noh_error *error);

/* Before the meshes of a draw. */
void noh_gl_patches_begin(noh_stage_patches *patches, const noh_gl_alone *alone);

/* The triangles of one mesh's marks at one of the actor's levels, grown if they were not.
 * row      where the first mark begins in patches->corners
 * returns  0: there are none */
int noh_gl_patches_grow(noh_stage_patches *patches, const noh_gl_alone *alone, uint32_t mesh, uint32_t level,
                        const noh_decals *ring, noh_gl_triangles *out, uint32_t *row);

#endif
