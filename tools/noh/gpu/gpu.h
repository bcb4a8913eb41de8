/* gpu.h: a GL context for the verbs that draw, and the library's objects with their memory. */
#ifndef NOH_NOH_GPU_GPU_H
#define NOH_NOH_GPU_GPU_H

#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "platform.h"

typedef struct gpu {
    const noh_platform *platform;
    noh_platform_context *context;
    noh_gl_api gl;
    noh_gl_caps caps;
    noh_gl_ledger ledger; /* the memory of the library's objects */
} gpu;

/* Make a context of that driver ("egl" when NULL) and probe it. Prints an error and returns an exit code; 0 on success.
 */
int gpu_open(gpu *g, const char *driver);
/* For verbs that read pictures or vertices back: also refuses a driver that draws nothing ("null"). */
int gpu_open_drawing(gpu *g, const char *driver);
/* 1 if the driver can read vertices back, by transform feedback. */
int gpu_gives_vertices(const noh_gl_api *gl);
void gpu_close(gpu *g);

/* One noh_gl_morph with its memory. */
typedef struct gpu_morph {
    void *memory;
    size_t bytes;
    noh_gl_morph *morph;
} gpu_morph;

/* Prints an error about `subject` and returns an exit code; 0 on success. */
int gpu_morph_open(gpu_morph *m, gpu *g, const noh_gl_morph_desc *desc, const char *subject);
void gpu_morph_close(gpu_morph *m);

#endif
