/* osmesa.c: a desktop GL context that draws into memory, through OSMesa. It compiles the ES shaders and has every ES
 * 3.2 function. libOSMesa is opened when a context is created, so building needs neither its header nor its library. */
#include "platforms.h"

#include <stdlib.h>

/* From GL/osmesa.h, whose <GL/gl.h> conflicts with GLES3/gl32.h. */
#define OSMESA_FORMAT 0x22
#define OSMESA_DEPTH_BITS 0x30
#define OSMESA_PROFILE 0x33
#define OSMESA_CORE_PROFILE 0x34
#define OSMESA_CONTEXT_MAJOR_VERSION 0x36
#define OSMESA_CONTEXT_MINOR_VERSION 0x37
#define SIDE_MAX 16384u

typedef void *(*create_function)(const int *attributes, void *share);
typedef void (*destroy_function)(void *context);
typedef GLboolean (*make_current_function)(void *context, void *buffer, GLenum type, GLsizei width, GLsizei height);
typedef noh_gl_proc (*get_proc_function)(const char *name);
typedef void(GL_APIENTRY *finish_function)(void);

struct noh_platform_context {
    create_function create;
    destroy_function destroy;
    make_current_function make_current;
    get_proc_function get_proc;
    void *context;
    void *pixels; /* RGBA8, the default framebuffer */
    GLsizei width, height;
};

static int load(noh_platform_context *to, char *message, size_t message_bytes)
{
    void *library = noh_library_open("libOSMesa.so.8", NULL, 0);
    if (!library) library = noh_library_open("libOSMesa.so.6", NULL, 0);
    if (!library) library = noh_library_open("libOSMesa.so", message, message_bytes);
    if (!library) return 0;
    to->create = (create_function)noh_library_proc(library, "OSMesaCreateContextAttribs");
    to->destroy = (destroy_function)noh_library_proc(library, "OSMesaDestroyContext");
    to->make_current = (make_current_function)noh_library_proc(library, "OSMesaMakeCurrent");
    to->get_proc = (get_proc_function)noh_library_proc(library, "OSMesaGetProcAddress");
    if (to->create && to->destroy && to->make_current && to->get_proc) return 1;
    noh_message_add(message, message_bytes, "libOSMesa: too old, has no OSMesaCreateContextAttribs\n");
    return 0;
}

static void *create_core(const noh_platform_context *to)
{
    static const int versions[] = { 45, 43, 33 };
    for (size_t i = 0; i < sizeof versions / sizeof *versions; i++) {
        const int attributes[] = { OSMESA_FORMAT,
                                   GL_RGBA,
                                   OSMESA_DEPTH_BITS,
                                   24,
                                   OSMESA_PROFILE,
                                   OSMESA_CORE_PROFILE,
                                   OSMESA_CONTEXT_MAJOR_VERSION,
                                   versions[i] / 10,
                                   OSMESA_CONTEXT_MINOR_VERSION,
                                   versions[i] % 10,
                                   0,
                                   0 };
        void *context = to->create(attributes, NULL);
        if (context) return context;
    }
    return NULL;
}

static noh_result make_current(noh_platform_context *context)
{
    GLboolean made = context->make_current(context->context, context->pixels, GL_UNSIGNED_BYTE, context->width,
                                           context->height);
    return made ? NOH_OK : NOH_ERR_GL;
}

static void destroy(noh_platform_context *context)
{
    if (!context) return;
    if (context->context) context->destroy(context->context);
    free(context->pixels);
    free(context);
}

static noh_result fill(noh_platform_context *to, const noh_platform_desc *desc, char *message, size_t message_bytes)
{
    uint32_t width = desc && desc->width ? desc->width : 1;
    uint32_t height = desc && desc->height ? desc->height : 1;
    if (width > SIDE_MAX || height > SIDE_MAX) return NOH_ERR_LIMIT;
    to->width = (GLsizei)width;
    to->height = (GLsizei)height;
    to->pixels = calloc((size_t)width * height, 4);
    if (!to->pixels) return NOH_ERR_MEMORY;
    if (!load(to, message, message_bytes)) {
        noh_message_add(message, message_bytes, "to install on Debian: libosmesa6\n");
        return NOH_ERR_UNSUPPORTED;
    }
    to->context = create_core(to);
    if (to->context && make_current(to) == NOH_OK) return NOH_OK;
    noh_message_add(message, message_bytes, "OSMesa: no core profile 4.5, 4.3 or 3.3 context\n");
    return NOH_ERR_UNSUPPORTED;
}

static noh_result create(const noh_platform_desc *desc, noh_platform_context **out, char *message, size_t message_bytes)
{
    if (message_bytes) message[0] = 0;
    noh_platform_context *context = calloc(1, sizeof *context);
    if (!context) return NOH_ERR_MEMORY;
    noh_result result = fill(context, desc, message, message_bytes);
    if (result == NOH_OK)
        *out = context;
    else
        destroy(context);
    return result;
}

static noh_gl_proc get_proc(void *user, const char *name)
{
    const noh_platform_context *context = user;
    return context->get_proc(name);
}

/* No window: the pixels are in memory once GL has finished. */
static noh_result present(noh_platform_context *context)
{
    finish_function finish = (finish_function)context->get_proc("glFinish");
    if (!finish) return NOH_ERR_GL;
    finish();
    return NOH_OK;
}

static void size(noh_platform_context *context, uint32_t *width, uint32_t *height)
{
    *width = (uint32_t)context->width;
    *height = (uint32_t)context->height;
}

const noh_platform noh_platform_osmesa = { "osmesa", "Mesa's software renderer without a window system, desktop GL",
                                           create,   make_current,
                                           get_proc, present,
                                           size,     destroy };
