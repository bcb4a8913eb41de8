/* start.h: the start of the stage's example programs: error messages, a pack, a GL context. Link EGL. */
#ifndef NOH_EXAMPLES_START_H
#define NOH_EXAMPLES_START_H

#include <stdio.h>
#include <stdlib.h>

#include "egl_context.h"
#include "noh/base.h"
#include "noh/pack.h"
#include "noh/gl_device.h"

static int start_fail(const noh_gl *gl, const char *what, const noh_error *e)
{
    fprintf(stderr, "%s: %s (at %llu, need %llu)\n%s", what, e->what, (unsigned long long)e->where,
            (unsigned long long)e->need, gl->log);
    return 1;
}

/* Read a pack into memory that is never freed; 0 on success. */
static int start_pack(const noh_gl *gl, const char *path, noh_pack *pack)
{
    FILE *in = fopen(path, "rb");
    long length = in && fseek(in, 0, SEEK_END) == 0 ? ftell(in) : -1;
    void *data = length > 0 ? malloc((size_t)length) : NULL;
    size_t bytes = in && data && fseek(in, 0, SEEK_SET) == 0 ? fread(data, 1, (size_t)length, in) : 0;
    noh_error e;
    if (in) fclose(in);
    return noh_pack_open(data, bytes, pack, &e) ? start_fail(gl, path, &e) : 0;
}

/* Create a context without a window and load its GL functions; 0 on success. */
static int start_gl(noh_gl *gl)
{
    noh_error e = { NOH_ERR_GL, "cannot create an OpenGL ES 3 context", 0, 0 };
    return egl_context_open() || noh_gl_open(gl, egl_context_get, NULL, &e) ? start_fail(gl, "GL", &e) : 0;
}

#endif
