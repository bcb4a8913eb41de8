/* platform.h: GL contexts, files and clocks for the tools and tests.
 *
 *   noh_platform_find      a platform by name: "egl", "angle", "osmesa", "glfw", "null"
 *   noh_platform_names     all names, for messages
 *   noh_file_map / noh_file_unmap / noh_file_write
 *   noh_clock_ns / noh_cpu_clock_ns / noh_thread_clock_ns
 *
 * A game replaces this folder with its own: start from template.c, with README.md as the guide. It may use libc; the
 * library in runtime/ never calls it. GL libraries are opened when a context is created, so a program that never draws
 * needs none of them. They stay open until the process ends, because drivers cannot be unloaded safely.
 *
 * Threads: a context belongs to the thread on which it is current; null has one context for the whole process. Files
 * and clocks: any thread. */
#ifndef NOH_PLATFORM_PLATFORM_H
#define NOH_PLATFORM_PLATFORM_H

#include <GLES3/gl32.h>
#include <GLES2/gl2ext.h>

#include "noh/base.h"
#include "noh/gl_device.h"

typedef struct noh_platform_context noh_platform_context;

/* Zero means the default. */
typedef struct noh_platform_desc {
    int es_version;  /* highest OpenGL ES version wanted, 300, 310 or 320; 0: 320. Lower versions are tried in turn.
                      * osmesa creates desktop GL 4.5 down to 3.3 */
    uint32_t width;  /* of the default framebuffer, pixels; 0: 1. An EGL without pbuffers has no default */
    uint32_t height; /* framebuffer, so draw into framebuffer objects */
    int samples;     /* of the default framebuffer; 0: none. osmesa has none */

    const char *window;   /* glfw: the title of a window to show; NULL: hidden. Other platforms have no window */
    void *native_display; /* egl: the argument of eglGetDisplay, with native_window */
    void *native_window;  /* egl: draw into this native window (EGLNativeWindowType as a pointer);
                           * NULL: headless. width and height are ignored: the window has its own size */
} noh_platform_desc;

typedef struct noh_platform {
    const char *name; /* "egl" */
    const char *what; /* one line for users */

    /* Make a context and make it current on this thread.
     * memory  one malloc, freed by destroy
     * errors  NOH_ERR_UNSUPPORTED no way worked: `message` (message_bytes, at least 1)
     *         lists what was tried and what to install; NOH_ERR_MEMORY */
    noh_result (*create)(const noh_platform_desc *desc, noh_platform_context **out, char *message,
                         size_t message_bytes);
    /* Make it current on this thread. NOH_ERR_GL: the system refused. */
    noh_result (*make_current)(noh_platform_context *context);
    /* A noh_gl_get_proc; user is the noh_platform_context. */
    noh_gl_proc (*get_proc)(void *user, const char *name);
    /* Show the default framebuffer; without a window, only flush.
     * errors  NOH_ERR_GL the surface or the context is lost: create both again */
    noh_result (*present)(noh_platform_context *context);
    /* The current size of the default framebuffer, in pixels; the user may resize a window. */
    void (*size)(noh_platform_context *context, uint32_t *width, uint32_t *height);
    /* Also destroys all objects of the context. NULL is allowed. */
    void (*destroy)(noh_platform_context *context);
} noh_platform;

/* NULL: no such platform. */
const noh_platform *noh_platform_find(const char *name);

/* "egl, angle, osmesa, glfw, null" */
const char *noh_platform_names(void);

/* A file in memory, read only. */
typedef struct noh_file {
    const void *data; /* page aligned; NULL for an empty file */
    size_t bytes;
} noh_file;

/* errors  NOH_ERR_NOT_FOUND, NOH_ERR_ARG (a folder, a pipe), NOH_ERR_MEMORY; `what` is
 *         the system's message, `where` its errno */
noh_result noh_file_map(const char *path, noh_file *out, noh_error *error);
void noh_file_unmap(noh_file *file);

/* Write a whole file or change nothing: the bytes go to a new file in the same folder, which is then renamed, so that a
 * reader sees either the old file or the new one. A symbolic link stays; its target is replaced. A device, a FIFO and
 * this process's own standard output (/dev/stdout) cannot be replaced and are written to directly.
 * errors  NOH_ERR_DATA the system refuses; `what` is its message, or what to do, `where` its errno */
noh_result noh_file_write(const char *path, const void *data, size_t bytes, noh_error *error);

/* Nanoseconds of a steady clock, from any start. */
uint64_t noh_clock_ns(void);

/* Nanoseconds of processor time used by this process, summed over all threads. */
uint64_t noh_cpu_clock_ns(void);

/* Nanoseconds of processor time used by the calling thread. Linux reads it exactly; under a limit of processor time
 * (`ulimit -t`) it counts a process's time in ticks of 1 to 10 ms. */
uint64_t noh_thread_clock_ns(void);

#endif
