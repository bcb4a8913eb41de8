/* template.c: the starting point of a port.
 *
 * Copy this file, name it after your system, and replace the system_* functions by its calls. Nothing else in noh has
 * to change. Add the noh_platform at the end to platforms.h and platform.c to use it with the tools, or use it alone.
 * README.md describes each part. */
#include "platforms.h"

#include <stdlib.h>

/* ---- your system's calls: declared here so that this file compiles as it is ---- */

typedef struct system_context system_context;
system_context *system_context_open(int es_version, unsigned width, unsigned height, int samples, const char **why_not);
int system_context_bind(system_context *context); /* 0: refused */
void *system_context_window(system_context *context);
int system_window_swap(void *window); /* 0: the surface or the context is lost */
void system_window_size(void *window, unsigned *width, unsigned *height);
noh_gl_proc system_gl_lookup(const char *name);
void system_context_close(system_context *context);
void *system_file_view(const char *path, size_t *bytes);
void system_file_release(void *view, size_t bytes);
uint64_t system_clock_ns(void);

/* ---- the context ---- */

/* Your system's handles of the context: one allocation, or a static if there is only one context. */
struct noh_platform_context {
    system_context *context;
};

/* Make it current on this thread, which alone may then call noh's GL functions. */
static noh_result make_current(noh_platform_context *c)
{
    return system_context_bind(c->context) ? NOH_OK : NOH_ERR_GL;
}

/* Try the highest version of OpenGL ES first, down to 3.0, which is enough. Add a line to the message for each failed
 * attempt: the user sees nothing else. */
static noh_result create(const noh_platform_desc *desc, noh_platform_context **out, char *message, size_t message_bytes)
{
    static const noh_platform_desc defaults;
    const noh_platform_desc *d = desc ? desc : &defaults;
    if (message_bytes) message[0] = 0;
    noh_platform_context *c = calloc(1, sizeof *c);
    if (!c) return NOH_ERR_MEMORY;
    for (int version = d->es_version ? d->es_version : 320; version >= 300 && !c->context; version -= 10) {
        const char *why_not = "";
        c->context = system_context_open(version, d->width, d->height, d->samples, &why_not);
        if (!c->context)
            noh_message_add(message, message_bytes, "OpenGL ES %d.%d: %s\n", version / 100, version / 10 % 10, why_not);
    }
    if (c->context && make_current(c) == NOH_OK) {
        if (message_bytes) message[0] = 0;
        *out = c;
        return NOH_OK;
    }
    noh_message_add(message, message_bytes, "to get a context here: ...\n");
    if (c->context) system_context_close(c->context);
    free(c);
    return NOH_ERR_UNSUPPORTED;
}

/* A function for a name such as "glDrawElements", NULL if there is none. Systems without a lookup have a header
 * instead: compare the name with the list in README.md and return the address. Some lookups return a stub for any name,
 * so noh checks versions and extensions first. */
static noh_gl_proc get_proc(void *user, const char *name)
{
    (void)user;
    return system_gl_lookup(name);
}

/* On NOH_ERR_GL the application creates a new context and restores the objects (gl_device.h). */
static noh_result present(noh_platform_context *c)
{
    return system_window_swap(system_context_window(c->context)) ? NOH_OK : NOH_ERR_GL;
}

/* In pixels, not in points: high-density displays differ. */
static void size(noh_platform_context *c, uint32_t *width, uint32_t *height)
{
    unsigned w = 0, h = 0;
    system_window_size(system_context_window(c->context), &w, &h);
    *width = w;
    *height = h;
}

static void destroy(noh_platform_context *c)
{
    if (!c) return;
    system_context_close(c->context);
    free(c);
}

extern const noh_platform noh_platform_template;
const noh_platform noh_platform_template = {
    "template", "what your system is", create, make_current, get_proc, present, size, destroy
};

/* ---- files and clocks: they replace file.c ---- */

/* The whole file, read only, aligned to 16 bytes, for as long as its pack is used. A mapping takes no memory, but a
 * plain read into your own block works too. */
noh_result noh_file_map(const char *path, noh_file *out, noh_error *error)
{
    size_t bytes = 0;
    void *view = system_file_view(path, &bytes);
    if (!view) return noh_fail(error, NOH_ERR_NOT_FOUND, "your system's message", 0, 0);
    out->data = view;
    out->bytes = bytes;
    return NOH_OK;
}

void noh_file_unmap(noh_file *file)
{
    union {
        const void *in;
        void *out;
    } view = { file->data };
    if (view.in) system_file_release(view.out, file->bytes);
    file->data = NULL;
    file->bytes = 0;
}

/* For your frame loop. The library has no clock: pass it the elapsed ticks. */
uint64_t noh_clock_ns(void)
{
    return system_clock_ns();
}
