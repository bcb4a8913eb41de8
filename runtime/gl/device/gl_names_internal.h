/* gl_names_internal.h (private): GL's names and types, for the library's own files. Of GL's functions only types: calls go
 * through noh_gl_api. */
#ifndef NOH_GL_GL_NAMES_INTERNAL_H
#define NOH_GL_GL_NAMES_INTERNAL_H

#ifndef GL_GLES_PROTOTYPES
#define GL_GLES_PROTOTYPES 0
#endif
#include <GLES3/gl32.h>
#include <GLES2/gl2ext.h>

#endif
