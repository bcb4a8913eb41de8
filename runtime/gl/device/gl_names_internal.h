/* gl_names_internal.h (private): GL's constants and types, and its function types; calls go through noh_gl_api. */
#ifndef NOH_GL_GL_NAMES_INTERNAL_H
#define NOH_GL_GL_NAMES_INTERNAL_H

#ifndef GL_GLES_PROTOTYPES
#define GL_GLES_PROTOTYPES 0
#endif
#include <GLES3/gl32.h>
#include <GLES2/gl2ext.h>

#endif
