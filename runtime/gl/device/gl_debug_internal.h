/* gl_debug_internal.h: names of objects and groups of calls, for debuggers. */
#ifndef NOH_DEVICE_GL_DEBUG_INTERNAL_H
#define NOH_DEVICE_GL_DEBUG_INTERNAL_H

#include "noh/low_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== names for debuggers ========
 * Object labels and call groups for RenderDoc and apitrace (KHR_debug).
 *
 *   noh_gl_label        name an object
 *   noh_gl_group_begin  open a named group of calls
 *   noh_gl_group_end    close it
 *
 * All do nothing if the context has no debug functions. The library labels every object that it makes and groups every
 * pass.
 *
 * Threads: the context's own thread, for every function. */

/* Label an object with `what` and `of`, separated by a space, or with `what` alone if `of` is NULL or "". The label is
 * cut to NOH_GL_LABEL_BYTES.
 * kind  GL_BUFFER, GL_TEXTURE, GL_PROGRAM, GL_VERTEX_ARRAY, GL_FRAMEBUFFER or GL_RENDERBUFFER
 * name  the object, which must have been bound at least once */
void noh_gl_label(const noh_gl_api *api, unsigned kind, unsigned name, const char *what, const char *of);

/* Begin and end a group of calls, named like a label. Groups nest; each begin needs an end. */
void noh_gl_group_begin(const noh_gl_api *api, const char *what, const char *of);
void noh_gl_group_end(const noh_gl_api *api);

#ifdef __cplusplus
}
#endif

#endif
