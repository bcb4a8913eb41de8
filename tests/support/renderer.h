/* renderer.h: renderers for tests. At most RENDERERS_MAX live at a time: their memory goes round. */
#ifndef NOH_TEST_RENDERER_H
#define NOH_TEST_RENDERER_H

#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"

#define RENDERERS_MAX 8u

static inline noh_result renderer_create(const noh_gl_device *device, const noh_gl_renderer_desc *desc,
                                         noh_gl_renderer *out, noh_error *error)
{
    static union {
        noh_gl_variant variants[NOH_GL_VARIANTS_MAX];
        double aligned;
    } memory[RENDERERS_MAX];
    static uint32_t next;
    return noh_gl_renderer_create(device, desc, &memory[next++ % RENDERERS_MAX], sizeof memory[0], out, error);
}

#endif
