/* gl_open.h: GL as a program needs it, in one object: functions, capabilities, a ledger of bytes, a log of shaders.
 *
 *     static noh_gl gl;
 *     noh_gl_open(&gl, get_proc, NULL, &error)            with a context of OpenGL ES 3 current
 *     noh_stage_init(memory, bytes, &gl.device, ...)
 *
 * Threads: the thread of the GL context. */
#ifndef NOH_GL_DEVICE_OPEN_H
#define NOH_GL_DEVICE_OPEN_H

#include "gl/device/gl_caps.h"
#include "gl/device/gl_memory.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_GL_LOG_BYTES 4096u

typedef struct noh_gl {
    noh_gl_api api;
    noh_gl_caps caps;
    noh_gl_ledger ledger;
    noh_gl_device device;       /* points to the other members: for each call that makes GL objects */
    char log[NOH_GL_LOG_BYTES]; /* why the last shader was refused; "" if none was */
} noh_gl;

/* Load GL's functions through `get`, find out what the GPU can do, and set up `device` with an empty ledger. *gl must
 * stay where it is: `device` and all objects that are made with it point into it. Nothing is left on the GPU. In a
 * new context after a lost one call noh_gl_api_load for `api` instead: the ledger goes on (gl_lost.h).
 * errors  as noh_gl_api_load and noh_gl_caps_probe: *gl is then undefined, but for an empty log */
noh_result noh_gl_open(noh_gl *gl, noh_gl_get_proc get, void *user, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
