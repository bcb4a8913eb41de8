/* glfw.c: an OpenGL ES context in a GLFW window, shown or hidden. libglfw is opened when a context is created, so
 * building needs neither its header nor its library. */
#include "platforms.h"

#include <stdlib.h>

/* From GLFW/glfw3.h, version 3. */
#define GLFW_VISIBLE 0x00020004
#define GLFW_SAMPLES 0x0002100D
#define GLFW_CLIENT_API 0x00022001
#define GLFW_CONTEXT_VERSION_MAJOR 0x00022002
#define GLFW_CONTEXT_VERSION_MINOR 0x00022003
#define GLFW_CONTEXT_CREATION_API 0x0002200B
#define GLFW_OPENGL_ES_API 0x00030002
#define GLFW_NATIVE_CONTEXT_API 0x00036001
#define GLFW_EGL_CONTEXT_API 0x00036002

typedef struct glfw_window glfw_window;
typedef struct glfw_monitor glfw_monitor;

/* X(field, result, parameters) */
#define GLFW_FUNCTIONS(X)                                                                                     \
    X(Init, int, (void))                                                                                      \
    X(WindowHint, void, (int hint, int value))                                                                \
    X(CreateWindow, glfw_window *, (int width, int height, const char *title, glfw_monitor *, glfw_window *)) \
    X(DestroyWindow, void, (glfw_window *))                                                                   \
    X(MakeContextCurrent, void, (glfw_window *))                                                              \
    X(GetCurrentContext, glfw_window *, (void))                                                               \
    X(GetProcAddress, noh_gl_proc, (const char *name))                                                        \
    X(GetFramebufferSize, void, (glfw_window *, int *width, int *height))                                     \
    X(SwapBuffers, void, (glfw_window *))                                                                     \
    X(GetError, int, (const char **description))

struct noh_platform_context {
#define GLFW_FIELD(field, result, parameters) result(*field) parameters;
    GLFW_FUNCTIONS(GLFW_FIELD)
#undef GLFW_FIELD
    glfw_window *window;
};

static int load(noh_platform_context *to, char *message, size_t message_bytes)
{
    void *library = noh_library_open("libglfw.so.3", message, message_bytes);
    const char *missing = NULL;
    if (!library) return 0;
#define GLFW_TAKE(field, result, parameters)                                    \
    to->field = (result(*) parameters)noh_library_proc(library, "glfw" #field); \
    if (!missing && !to->field) missing = "glfw" #field;
    GLFW_FUNCTIONS(GLFW_TAKE)
#undef GLFW_TAKE
    if (missing) noh_message_add(message, message_bytes, "libglfw.so.3: has no %s\n", missing);
    return !missing;
}

static void say(const noh_platform_context *c, const char *what, char *message, size_t message_bytes)
{
    const char *reason = NULL;
    c->GetError(&reason);
    noh_message_add(message, message_bytes, "%s: %s\n", what, reason ? reason : "no reason given");
}

static glfw_window *open_window(const noh_platform_context *c, const noh_platform_desc *desc, int version, int api)
{
    c->WindowHint(GLFW_VISIBLE, desc->window != NULL);
    c->WindowHint(GLFW_SAMPLES, desc->samples);
    c->WindowHint(GLFW_CLIENT_API, GLFW_OPENGL_ES_API);
    c->WindowHint(GLFW_CONTEXT_CREATION_API, api);
    c->WindowHint(GLFW_CONTEXT_VERSION_MAJOR, version / 100);
    c->WindowHint(GLFW_CONTEXT_VERSION_MINOR, version / 10 % 10);
    return c->CreateWindow(desc->width ? (int)desc->width : 1, desc->height ? (int)desc->height : 1,
                           desc->window ? desc->window : "noh", NULL, NULL);
}

/* EGL first, which returns the requested version; then GLX or WGL. */
static int open_any(noh_platform_context *c, const noh_platform_desc *desc, char *message, size_t message_bytes)
{
    static const int apis[] = { GLFW_EGL_CONTEXT_API, GLFW_NATIVE_CONTEXT_API };
    if (!c->Init()) {
        say(c, "glfwInit", message, message_bytes);
        return 0;
    }
    for (size_t i = 0; i < sizeof apis / sizeof *apis; i++) {
        for (int version = desc->es_version ? desc->es_version : 320; version >= 300; version -= 10) {
            c->window = open_window(c, desc, version, apis[i]);
            if (c->window) return 1;
        }
        say(c, i ? "glfwCreateWindow, native context" : "glfwCreateWindow, EGL context", message, message_bytes);
    }
    return 0;
}

static noh_result make_current(noh_platform_context *context)
{
    context->MakeContextCurrent(context->window);
    return context->GetCurrentContext() == context->window ? NOH_OK : NOH_ERR_GL;
}

/* GLFW stays initialised: other windows of the process may share it. */
static void destroy(noh_platform_context *context)
{
    if (!context) return;
    if (context->window) context->DestroyWindow(context->window);
    free(context);
}

static noh_result create(const noh_platform_desc *desc, noh_platform_context **out, char *message, size_t message_bytes)
{
    static const noh_platform_desc defaults;
    if (message_bytes) message[0] = 0;
    noh_platform_context *context = calloc(1, sizeof *context);
    if (!context) return NOH_ERR_MEMORY;
    if (load(context, message, message_bytes) && open_any(context, desc ? desc : &defaults, message, message_bytes) &&
        make_current(context) == NOH_OK) {
        if (message_bytes) message[0] = 0;
        *out = context;
        return NOH_OK;
    }
    noh_message_add(message, message_bytes,
                    "to install on Debian: libglfw3; it needs a display (DISPLAY, or xvfb-run)\n");
    destroy(context);
    return NOH_ERR_UNSUPPORTED;
}

static noh_gl_proc get_proc(void *user, const char *name)
{
    const noh_platform_context *context = user;
    return context->GetProcAddress(name);
}

/* glfwGetError also clears a pending error. */
static noh_result present(noh_platform_context *context)
{
    context->GetError(NULL);
    context->SwapBuffers(context->window);
    return context->GetError(NULL) == 0 ? NOH_OK : NOH_ERR_GL;
}

static void size(noh_platform_context *context, uint32_t *width, uint32_t *height)
{
    int w = 0, h = 0;
    context->GetFramebufferSize(context->window, &w, &h);
    *width = w > 0 ? (uint32_t)w : 0;
    *height = h > 0 ? (uint32_t)h : 0;
}

const noh_platform noh_platform_glfw = {
    "glfw", "a GLFW window, hidden unless it has a title", create, make_current, get_proc, present, size, destroy
};
