/* stage_decal_internal.h: the private part of noh_gl.h. */
#ifndef NOH_STAGE_GL_STAGE_DECAL_INTERNAL_H
#define NOH_STAGE_GL_STAGE_DECAL_INTERNAL_H

#include "noh/noh_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_STAGE_DECALS_BYTES 4096u /* on the GPU, without the picture */

#ifdef __cplusplus
}
#endif

#endif
