/* stage_blob_internal.h: the private part of noh_gl.h. */
#ifndef NOH_STAGE_GL_STAGE_BLOB_INTERNAL_H
#define NOH_STAGE_GL_STAGE_BLOB_INTERNAL_H

#include "noh/noh_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_BLOBS_DRAWN 32 /* blobs in one draw call */

#ifdef __cplusplus
}
#endif

#endif
