/* noh_gl.h: what the library keeps to itself of runtime/noh/noh_gl.h. */
#ifndef NOH_STAGE_GL_STAGE_PATCH_H
#define NOH_STAGE_GL_STAGE_PATCH_H

#include "noh/noh_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_PATCH_WIDTH 256u /* texels in a row of the texture */
#define NOH_PATCH_ROWS(capacity, triangles) \
    (((capacity) + 1u + (triangles) + NOH_PATCH_WIDTH - 1u) / NOH_PATCH_WIDTH) /* for a level */

/* The exact bytes on the GPU: indices and a texture of corners, for two levels. Neither argument may be 0. */
#define NOH_STAGE_PATCHES_BYTES(capacity, triangles) \
    (24u * (uint64_t)(triangles) + 8u * NOH_PATCH_WIDTH * NOH_PATCH_ROWS(capacity, triangles))

#ifdef __cplusplus
}
#endif

#endif
