/* context.c: a WebGL 2 context, accessed through gl.js. WebGL has no lookup by name: a table lists the functions
 * that the library calls, no others are imported, and get_proc is NULL. */
#define GL_GLES_PROTOTYPES 1
#include "context.h"

#include "gl/device/gl_api_internal.h"

/* Functions beyond GL. Strings are cut to fit and written with their terminating zero. */
#define NAMED(what) __attribute__((import_module("noh"), import_name(what)))
NAMED("string") void web_gl_string(GLenum what, char *text, uint32_t room);
NAMED("extension") void web_gl_extension(GLuint index, char *text, uint32_t room);
NAMED("enable") void web_gl_enable(void);
NAMED("lost") int web_gl_lost(void);
NAMED("width") uint32_t web_gl_width(void);
NAMED("height") uint32_t web_gl_height(void);

struct noh_platform_context {
    int unused;
};

static noh_platform_context only; /* gl.js holds the context */

/* GL_RENDERER is the driver's name, used to match quirks, if the browser reveals it. */
static const GLubyte *GL_APIENTRY get_string(GLenum what)
{
    static char text[256];
    web_gl_string(what, text, sizeof text);
    return (const GLubyte *)text;
}

static const GLubyte *GL_APIENTRY get_string_i(GLenum what, GLuint index)
{
    static char text[64];
    (void)what; /* only extensions exist */
    web_gl_extension(index, text, sizeof text);
    return (const GLubyte *)text;
}

/* Replaces gl_api_load.c, which looks functions up by name and links all names. */
noh_result noh_gl_api_load(noh_gl_api *api, noh_gl_get_proc get, void *user, noh_error *error)
{
    static const noh_gl_api table = {
#define glGetString get_string
#define glGetStringi get_string_i
#define WEB_FUNCTION(field, result, parameters) .field = (result(NOH_GL_CALL *) parameters)gl##field,
        NOH_GL_REQUIRED(WEB_FUNCTION)
#undef WEB_FUNCTION
            .version = 300,
        .is_es = 1
    };
    (void)get;
    (void)user;
    (void)error;
    *api = table;
    api->etc2 = noh_gl_has_extension(api, "WEBGL_compressed_texture_etc");
    api->astc = noh_gl_has_extension(api, "WEBGL_compressed_texture_astc");
    return NOH_OK;
}

void noh_web_enable_extensions(noh_platform_context *context)
{
    (void)context;
    web_gl_enable();
}

static noh_result make_current(noh_platform_context *context)
{
    (void)context;
    return NOH_OK;
}

static noh_result create(const noh_platform_desc *desc, noh_platform_context **out, char *message, size_t message_bytes)
{
    (void)desc;
    (void)message;
    (void)message_bytes;
    if (web_gl_lost()) return NOH_ERR_UNSUPPORTED;
    web_gl_enable();
    *out = &only;
    return NOH_OK;
}

/* The browser shows the canvas when the event handler or animation frame returns. */
static noh_result present(noh_platform_context *context)
{
    (void)context;
    return web_gl_lost() ? NOH_ERR_GL : NOH_OK;
}

static void size(noh_platform_context *context, uint32_t *width, uint32_t *height)
{
    (void)context;
    *width = web_gl_width();
    *height = web_gl_height();
}

static void destroy(noh_platform_context *context)
{
    (void)context;
}

const noh_platform noh_platform_web = { "web",  "WebGL 2 on a page's canvas", create, make_current, NULL, present, size,
                                        destroy };
