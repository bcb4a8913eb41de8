/* gl_memory_internal.h: the private part of low_gl.h. */
#ifndef NOH_GL_GL_MEMORY_INTERNAL_H
#define NOH_GL_GL_MEMORY_INTERNAL_H

#include "noh/gl_device.h"
#include "noh/low_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The bytes of one texel of an internal format; 0 for a block format, or one that noh does not use. */
uint32_t noh_gl_texel_bytes(unsigned format);

#ifdef __cplusplus
}
#endif

#endif
