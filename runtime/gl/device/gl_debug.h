/* gl_debug.h: object labels and call groups for RenderDoc and apitrace (KHR_debug).
 *
 *   noh_gl_label        name an object
 *   noh_gl_group_begin  open a named group of calls
 *   noh_gl_group_end    close it
 *
 * All do nothing if the context has no debug functions. The library labels every object that it makes and groups every
 * pass.
 *
 * Threads: the context's own thread, for every function. */
#ifndef NOH_GL_GL_DEBUG_H
#define NOH_GL_GL_DEBUG_H

#include "core/base/limits.h"
#include "gl/device/gl_api.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Label an object "what of", or "what" if `of` is NULL or "". The label is cut to NOH_GL_LABEL_BYTES.
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
