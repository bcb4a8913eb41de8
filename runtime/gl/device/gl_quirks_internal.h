/* gl_quirks_internal.h: the private part of low_gl.h. */
#ifndef NOH_GL_GL_QUIRKS_INTERNAL_H
#define NOH_GL_GL_QUIRKS_INTERNAL_H

#include "noh/low_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

/* All entries: [*count]. */
const noh_gl_quirk *noh_gl_quirk_table(uint32_t *count);

#ifdef __cplusplus
}
#endif

#endif
