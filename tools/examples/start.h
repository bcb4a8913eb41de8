/* start.h: what the programs of the stage begin with: a message, a pack, a context of GL. Link EGL. */
#ifndef NOH_EXAMPLES_START_H
#define NOH_EXAMPLES_START_H

#include <stdio.h>
#include <stdlib.h>

#include "egl_context.h"

typedef struct start {
    noh_gl_api gl;
    noh_gl_caps caps;
    noh_gl_ledger ledger;
    noh_gl_device device; /* of the three above */
    char log[4096];       /* what the driver said of shaders */
} start;

static int start_fail(const start *s, const char *what, const noh_error *e)
{
    fprintf(stderr, "%s: %s (at %llu, need %llu)\n%s", what, e->what, (unsigned long long)e->where,
            (unsigned long long)e->need, s->log);
    return 1;
}

/* A pack, in memory that stays; 0 on success. */
static int start_pack(const start *s, const char *path, noh_pack *pack)
{
    FILE *in = fopen(path, "rb");
    long length = in && fseek(in, 0, SEEK_END) == 0 ? ftell(in) : -1;
    void *data = length > 0 ? malloc((size_t)length) : NULL;
    size_t bytes = in && data && fseek(in, 0, SEEK_SET) == 0 ? fread(data, 1, (size_t)length, in) : 0;
    noh_error e;
    if (in) fclose(in);
    return noh_pack_open(data, bytes, pack, &e) ? start_fail(s, path, &e) : 0;
}

/* A context without a window; 0 on success. */
static int start_gl(start *s)
{
    noh_error e = { NOH_ERR_GL, "there is no context of OpenGL ES 3", 0, 0 };
    s->device = (noh_gl_device){ &s->gl, &s->caps, &s->ledger, s->log, sizeof s->log };
    return egl_context_open() || noh_gl_api_load(&s->gl, egl_context_get, NULL, &e) ||
                   noh_gl_caps_probe(&s->gl, &s->caps, &e)
               ? start_fail(s, "GL", &e)
               : 0;
}

#endif
