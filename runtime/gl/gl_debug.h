/* gl_debug.h: names for what RenderDoc and apitrace show (KHR_debug).
 *
 *   noh_gl_label        name an object
 *   noh_gl_group_begin  open a named group of calls
 *   noh_gl_group_end    close it
 *
 * All do nothing where the context has no debug functions. Every object that the
 * library makes is labelled and every pass is in a group.
 *
 * Threads: the context's own thread, for every function. */
#ifndef NOH_GL_GL_DEBUG_H
#define NOH_GL_GL_DEBUG_H

#include "base/limits.h"
#include "gl/gl_api.h"

#ifdef __cplusplus
extern "C" {
#endif

/* kind: GL_BUFFER, GL_TEXTURE, GL_PROGRAM, GL_VERTEX_ARRAY, GL_FRAMEBUFFER or
 * GL_RENDERBUFFER; the object must have been bound once. The text is "what of"; of
 * NULL or "": only what. */
void noh_gl_label(const noh_gl_api *api, GLenum kind, GLuint name, const char *what, const char *of);

/* Groups nest; each begin has its end. The text as above. */
void noh_gl_group_begin(const noh_gl_api *api, const char *what, const char *of);
void noh_gl_group_end(const noh_gl_api *api);

#ifdef __cplusplus
}
#endif

#endif
