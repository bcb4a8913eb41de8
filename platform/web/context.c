/* context.c: a WebGL 2 context on the element #canvas. WebGL has no lookup by name, so a table of the functions that
 * the library calls stands in for one, and no other GL function is linked into the page. */
#define GL_GLES_PROTOTYPES 1
#include "context.h"

#include <emscripten/html5.h>

#include <string.h>

#define CANVAS "#canvas"
#define UNMASKED_RENDERER 0x9246 /* of WEBGL_debug_renderer_info */

struct noh_platform_context {
    EMSCRIPTEN_WEBGL_CONTEXT_HANDLE handle;
};

static noh_platform_context only; /* one canvas, one context */

/* Browsers give a name of their own as GL_RENDERER. The driver's, which quirks are matched with, is another query. */
static const GLubyte *GL_APIENTRY get_string(GLenum what)
{
    const GLubyte *text = NULL;
    if (what == GL_RENDERER && emscripten_webgl_enable_extension(only.handle, "WEBGL_debug_renderer_info")) {
        text = glGetString(UNMASKED_RENDERER);
    }
    return text ? text : glGetString(what);
}

static const struct {
    const char *name;
    noh_gl_proc proc;
} functions[] = {
#define WEB_FUNCTION(field, TYPE) { "gl" #field, (noh_gl_proc)gl##field },
    NOH_GL_REQUIRED(WEB_FUNCTION)
#undef WEB_FUNCTION
};

void noh_web_enable_extensions(noh_platform_context *context)
{
    static const char *const wanted[] = { "EXT_color_buffer_float", "EXT_color_buffer_half_float", "EXT_float_blend",
                                          "WEBGL_compressed_texture_etc" };
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        emscripten_webgl_enable_extension(context->handle, wanted[i]);
    }
}

static noh_result make_current(noh_platform_context *context)
{
    return emscripten_webgl_make_context_current(context->handle) == EMSCRIPTEN_RESULT_SUCCESS ? NOH_OK : NOH_ERR_GL;
}

static noh_result create(const noh_platform_desc *desc, noh_platform_context **out, char *message, size_t message_bytes)
{
    EmscriptenWebGLContextAttributes attributes;
    (void)desc;
    (void)message;
    (void)message_bytes;
    emscripten_webgl_init_context_attributes(&attributes);
    attributes.majorVersion = 2;
    attributes.antialias = 1;
    attributes.depth = 1;
    attributes.alpha = 0;
    attributes.preserveDrawingBuffer = 1; /* so that the canvas can be saved */
    only.handle = emscripten_webgl_create_context(CANVAS, &attributes);
    if (only.handle <= 0 || make_current(&only) != NOH_OK) return NOH_ERR_UNSUPPORTED;
    noh_web_enable_extensions(&only);
    *out = &only;
    return NOH_OK;
}

static noh_gl_proc get_proc(void *user, const char *name)
{
    (void)user;
    if (strcmp(name, "glGetString") == 0) return (noh_gl_proc)get_string;
    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++) {
        if (strcmp(functions[i].name, name) == 0) return functions[i].proc;
    }
    return NULL;
}

/* The browser itself shows the canvas when the event handler or animation frame returns. */
static noh_result present(noh_platform_context *context)
{
    return emscripten_is_webgl_context_lost(context->handle) ? NOH_ERR_GL : NOH_OK;
}

static void size(noh_platform_context *context, uint32_t *width, uint32_t *height)
{
    int w = 0, h = 0;
    emscripten_webgl_get_drawing_buffer_size(context->handle, &w, &h);
    *width = (uint32_t)w;
    *height = (uint32_t)h;
}

static void destroy(noh_platform_context *context)
{
    if (context) emscripten_webgl_destroy_context(context->handle);
}

const noh_platform noh_platform_web = {
    "web", "WebGL 2 on the page's canvas", create, make_current, get_proc, present, size, destroy
};
