/* low_gl.h: what the library keeps to itself of runtime/noh/low_gl.h. */
#ifndef NOH_GL_GL_MORPH_H
#define NOH_GL_GL_MORPH_H

#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_LAYERS_STREAMS 2 /* values of is_uint */
#define NOH_LAYERS_VERTICES 3

/* Blocks of 4 x 4 accumulation texels touched by each target's rectangles, summed over targets; the unit of work of the
 * GPU paths. */
uint32_t noh_gl_morph_blocks(const noh_mesh *mesh);

/* Rows of such blocks, summed over rectangles; each is a quad on the blended paths. */
uint32_t noh_gl_morph_strips(const noh_mesh *mesh);

/* With desc.coarse: upload the next piece of the delta data of the finest of `meshes`, which is not used yet.
 * ranges   from: the whole mesh, at the finest level of `meshes` or a finer one; *at: initially 0, then as left by the
 *          previous call; *bytes: most bytes to send, at least 256 for progress; the bytes sent are subtracted
 * state    texture 0 of unit 0, the active one
 * returns  1 once everything is uploaded */
int noh_gl_morph_fill(noh_gl_morph *morph, const noh_mesh *from, uint32_t *at, uint32_t *bytes);

#ifdef __cplusplus
}
#endif

#endif
