/* noh_gl.h: what the library keeps to itself of runtime/noh/noh_gl.h. */
#ifndef NOH_STAGE_GL_STAGE_BLOB_H
#define NOH_STAGE_GL_STAGE_BLOB_H

#include "noh/noh_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_BLOBS_DRAWN 32 /* blobs in one draw call */

#ifdef __cplusplus
}
#endif

#endif
