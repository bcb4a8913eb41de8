/* gl_debug.h: names that RenderDoc and apitrace show (KHR_debug).
 *
 *   noh_gl_label        name an object
 *   noh_gl_group_begin  open a named group of calls
 *   noh_gl_group_end    close it
 *
 * All do nothing where the context has no debug functions. The library labels every object that it makes and puts every
 * pass into a group.
 *
 * Threads: the context's own thread, for every function. */
#ifndef NOH_GL_GL_DEBUG_H
#define NOH_GL_GL_DEBUG_H

#include "core/base/limits.h"
#include "gl/device/gl_api.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Label an object with the text "what of", or only "what" where `of` is NULL or "". It is cut to NOH_GL_LABEL_BYTES.
 * kind  GL_BUFFER, GL_TEXTURE, GL_PROGRAM, GL_VERTEX_ARRAY, GL_FRAMEBUFFER or GL_RENDERBUFFER
 * name  an object that was bound at least once */
void noh_gl_label(const noh_gl_api *api, unsigned kind, unsigned name, const char *what, const char *of);

/* Groups nest; each begin needs its end. The text is made as above. */
void noh_gl_group_begin(const noh_gl_api *api, const char *what, const char *of);
void noh_gl_group_end(const noh_gl_api *api);

#ifdef __cplusplus
}
#endif

#endif
