/* gl_api_internal.h: the private part of gl_device.h. */
#ifndef NOH_GL_GL_API_INTERNAL_H
#define NOH_GL_GL_API_INTERNAL_H

#include <stddef.h>

#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== what a GPU can do ======== */

/* `version` and `geometry_defines` for the desc of a program with a geometry stage. The version is NULL
 * without geometry shaders; the defines are NULL if no #extension is needed. */
const char *noh_gl_geometry_version(const noh_gl_api *api);
const char *noh_gl_geometry_defines(const noh_gl_api *api);

/* 1 if the context lists the extension, otherwise 0. name: in full, "GL_EXT_...". */
int noh_gl_has_extension(const noh_gl_api *api, const char *name);

/* needs_caps: its caps, too, must be there
 * errors  ARG the device is NULL or has no API, ledger or needed caps: noh_gl_open fills them in (gl_open.c) */
noh_result noh_gl_device_check(const noh_gl_device *device, int needs_caps, noh_error *error);

/* Desktop OpenGL: vertex shaders set the point size, as they always do in OpenGL ES. */
#define NOH_GL_PROGRAM_POINT_SIZE 0x8642u

/* Return pending GL errors as a noh_result and clear them. Every create function clears pending errors first and calls
 * this last, so it never returns NOH_OK after the driver refused a call.
 * errors  MEMORY GL_OUT_OF_MEMORY; GL any other error. `where` is the GL error; `what` and `need` are the arguments */
noh_result noh_gl_error_check(const noh_gl_api *api, const char *what, uint64_t need, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
