/* egl.c: an OpenGL ES context through EGL: the system's own or ANGLE's; headless, or in a window of the caller.
 *
 * ANGLE's two libraries are looked up in the folder named by the environment variable NOH_ANGLE (tools/angle.sh fills
 * one), then in the folders of Debian's chromium; some of its versions contain them. */
#define EGL_EGL_PROTOTYPES 0
#include "platforms.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* From EGL_ANGLE_platform_angle, which not every eglext.h has. */
#define ANGLE_PLATFORM 0x3202
#define ANGLE_PLATFORM_TYPE 0x3203
#define ANGLE_TYPE_VULKAN 0x3450
#define ANGLE_DEVICE_TYPE 0x3209
#define ANGLE_DEVICE_SWIFTSHADER 0x3487

#define EGL_HINT "to install on Debian: libegl1 libgles2 libegl-mesa0 libgl1-mesa-dri\n"
#define ANGLE_HINT "set NOH_ANGLE to the folder with ANGLE's libEGL.so and libGLESv2.so (tools/angle.sh makes one)\n"
#define DEVICES_MAX 16

/* X(field, name in the type PFNEGL...PROC) */
#define EGL_FUNCTIONS(X)                          \
    X(GetError, GETERROR)                         \
    X(GetDisplay, GETDISPLAY)                     \
    X(Initialize, INITIALIZE)                     \
    X(Terminate, TERMINATE)                       \
    X(QueryString, QUERYSTRING)                   \
    X(BindAPI, BINDAPI)                           \
    X(ChooseConfig, CHOOSECONFIG)                 \
    X(CreateContext, CREATECONTEXT)               \
    X(DestroyContext, DESTROYCONTEXT)             \
    X(CreatePbufferSurface, CREATEPBUFFERSURFACE) \
    X(CreateWindowSurface, CREATEWINDOWSURFACE)   \
    X(QuerySurface, QUERYSURFACE)                 \
    X(SwapBuffers, SWAPBUFFERS)                   \
    X(DestroySurface, DESTROYSURFACE)             \
    X(MakeCurrent, MAKECURRENT)                   \
    X(GetProcAddress, GETPROCADDRESS)

typedef struct egl_api {
#define EGL_FIELD(field, TYPE) PFNEGL##TYPE##PROC field;
    EGL_FUNCTIONS(EGL_FIELD)
#undef EGL_FIELD
    void *gles; /* libGLESv2, for names unknown to eglGetProcAddress; may be NULL */
} egl_api;

struct noh_platform_context {
    egl_api egl;
    EGLDisplay display;
    EGLContext context;
    EGLSurface surface; /* EGL_NO_SURFACE if none is needed */
};

/* What each attempt needs: the EGL functions, the desc, and the message to append failures to. */
typedef struct attempt {
    egl_api egl;
    const noh_platform_desc *desc;
    char *message;
    size_t message_bytes;
    noh_platform_context *made;
} attempt;

static void say(attempt *at, const char *way, const char *what)
{
    noh_message_add(at->message, at->message_bytes, "%s: %s (EGL error 0x%04x)\n", way, what,
                    (unsigned)at->egl.GetError());
}

/* Search a whole word in a list separated by spaces. */
static int lists(const char *extensions, const char *name)
{
    size_t length = strlen(name);
    const char *p = extensions;
    while (p && (p = strstr(p, name)) != NULL) {
        int starts = p == extensions || p[-1] == ' ';
        if (starts && (p[length] == ' ' || p[length] == 0)) return 1;
        p += length;
    }
    return 0;
}

/* --- display, config, context, surface --- */

static EGLContext create_context(const egl_api *egl, EGLDisplay display, EGLConfig config, int highest)
{
    for (int version = highest; version >= 300; version -= 10) {
        const EGLint attributes[] = { EGL_CONTEXT_MAJOR_VERSION, version / 100, EGL_CONTEXT_MINOR_VERSION,
                                      version / 10 % 10, EGL_NONE };
        EGLContext context = egl->CreateContext(display, config, EGL_NO_CONTEXT, attributes);
        if (context != EGL_NO_CONTEXT) return context;
    }
    /* EGL 1.4 without EGL_KHR_create_context takes only the major version. */
    const EGLint attributes[] = { EGL_CONTEXT_CLIENT_VERSION, 3, EGL_NONE };
    return egl->CreateContext(display, config, EGL_NO_CONTEXT, attributes);
}

static int choose_config(const attempt *at, EGLDisplay display, EGLint surface_type, EGLConfig *config)
{
    const EGLint attributes[] = { EGL_SURFACE_TYPE,
                                  surface_type,
                                  EGL_RENDERABLE_TYPE,
                                  EGL_OPENGL_ES3_BIT,
                                  EGL_RED_SIZE,
                                  8,
                                  EGL_GREEN_SIZE,
                                  8,
                                  EGL_BLUE_SIZE,
                                  8,
                                  EGL_ALPHA_SIZE,
                                  8,
                                  EGL_SAMPLES,
                                  at->desc->samples,
                                  EGL_NONE };
    EGLint count = 0;
    return at->egl.ChooseConfig(display, attributes, config, 1, &count) && count > 0;
}

/* The native types are pointers on some systems and integers on others. */
static EGLSurface create_window(const attempt *at, EGLDisplay display, EGLConfig config)
{
    EGLNativeWindowType window = (EGLNativeWindowType)at->desc->native_window;
    return at->egl.CreateWindowSurface(display, config, window, NULL);
}

static EGLSurface create_pbuffer(const attempt *at, EGLDisplay display, EGLConfig config)
{
    EGLint width = at->desc->width ? (EGLint)at->desc->width : 1;
    EGLint height = at->desc->height ? (EGLint)at->desc->height : 1;
    const EGLint attributes[] = { EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE };
    return at->egl.CreatePbufferSurface(display, config, attributes);
}

/* The surface that the context draws to, and its description for messages. */
typedef struct surface_kind {
    EGLint type; /* of the config; 0: no surface at all */
    EGLSurface (*create)(const attempt *at, EGLDisplay display, EGLConfig config);
    const char *no_config, *no_current;
} surface_kind;

static const surface_kind no_surface = { 0, NULL, "no config for OpenGL ES 3",
                                         "cannot make current without a surface" };
static const surface_kind pbuffer = { EGL_PBUFFER_BIT, create_pbuffer, "no pbuffer config for OpenGL ES 3",
                                      "cannot make current with a pbuffer" };
static const surface_kind window = { EGL_WINDOW_BIT, create_window, "no window config for OpenGL ES 3",
                                     "cannot make current with the window" };

static int make_context(attempt *at, EGLDisplay display, const char *way, const surface_kind *kind)
{
    const egl_api *egl = &at->egl;
    int highest = at->desc->es_version ? at->desc->es_version : 320;
    EGLConfig config;
    if (!choose_config(at, display, kind->type, &config)) {
        say(at, way, kind->no_config);
        return 0;
    }
    EGLContext context = create_context(egl, display, config, highest);
    if (context == EGL_NO_CONTEXT) {
        say(at, way, "no OpenGL ES 3.x context");
        return 0;
    }
    EGLSurface surface = kind->create ? kind->create(at, display, config) : EGL_NO_SURFACE;
    int usable = !kind->create || surface != EGL_NO_SURFACE;
    if (usable && egl->MakeCurrent(display, surface, surface, context)) {
        *at->made = (noh_platform_context){ at->egl, display, context, surface };
        return 1;
    }
    say(at, way, kind->no_current);
    if (surface != EGL_NO_SURFACE) egl->DestroySurface(display, surface);
    egl->DestroyContext(display, context);
    return 0;
}

static int try_display(attempt *at, EGLDisplay display, const char *way)
{
    if (display == EGL_NO_DISPLAY) {
        say(at, way, "no display");
        return 0;
    }
    if (!at->egl.Initialize(display, NULL, NULL)) {
        say(at, way, "eglInitialize failed");
        return 0;
    }
    if (!at->egl.BindAPI(EGL_OPENGL_ES_API)) {
        say(at, way, "no OpenGL ES");
    } else if (at->desc->native_window) {
        if (make_context(at, display, way, &window)) return 1;
    } else {
        /* A pbuffer first: without a surface, the default framebuffer is incomplete
         * and even draws with rasterisation discarded are refused there. */
        if (make_context(at, display, way, &pbuffer)) return 1;
        int surfaceless = lists(at->egl.QueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context");
        if (surfaceless && make_context(at, display, way, &no_surface)) return 1;
    }
    at->egl.Terminate(display);
    return 0;
}

/* --- the ways to a display --- */

static PFNEGLGETPLATFORMDISPLAYEXTPROC platform_display(const egl_api *egl)
{
    return (PFNEGLGETPLATFORMDISPLAYEXTPROC)egl->GetProcAddress("eglGetPlatformDisplayEXT");
}

static int try_surfaceless(attempt *at, const char *extensions)
{
    const char *way = "EGL_MESA_platform_surfaceless";
    PFNEGLGETPLATFORMDISPLAYEXTPROC get = platform_display(&at->egl);
    if (!get || !lists(extensions, way)) {
        noh_message_add(at->message, at->message_bytes, "%s: not supported by this EGL\n", way);
        return 0;
    }
    return try_display(at, get(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL), way);
}

static int try_devices(attempt *at, const char *extensions)
{
    const char *way = "EGL_EXT_platform_device";
    PFNEGLGETPLATFORMDISPLAYEXTPROC get = platform_display(&at->egl);
    PFNEGLQUERYDEVICESEXTPROC query = (PFNEGLQUERYDEVICESEXTPROC)at->egl.GetProcAddress("eglQueryDevicesEXT");
    EGLDeviceEXT devices[DEVICES_MAX];
    EGLint count = 0;
    if (!get || !query || !lists(extensions, way) || !query(DEVICES_MAX, devices, &count) || count < 1) {
        noh_message_add(at->message, at->message_bytes, "%s: no device\n", way);
        return 0;
    }
    for (EGLint i = 0; i < count; i++) {
        if (try_display(at, get(EGL_PLATFORM_DEVICE_EXT, devices[i], NULL), way)) return 1;
    }
    return 0;
}

static int try_system(attempt *at)
{
    const char *extensions = at->egl.QueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (at->desc->native_window) {
        return try_display(at, at->egl.GetDisplay((EGLNativeDisplayType)at->desc->native_display), "native display");
    }
    if (try_surfaceless(at, extensions)) return 1;
    if (try_devices(at, extensions)) return 1;
    return try_display(at, at->egl.GetDisplay(EGL_DEFAULT_DISPLAY), "default display");
}

static int try_angle(attempt *at)
{
    const char *way = "ANGLE on SwiftShader";
    static const EGLint attributes[] = { ANGLE_PLATFORM_TYPE, ANGLE_TYPE_VULKAN, ANGLE_DEVICE_TYPE,
                                         ANGLE_DEVICE_SWIFTSHADER, EGL_NONE };
    PFNEGLGETPLATFORMDISPLAYEXTPROC get = platform_display(&at->egl);
    if (!get) {
        say(at, way, "no eglGetPlatformDisplayEXT");
        return 0;
    }
    return try_display(at, get(ANGLE_PLATFORM, EGL_DEFAULT_DISPLAY, attributes), way);
}

/* --- libraries --- */

static int load_egl(attempt *at, const char *path)
{
    void *library = noh_library_open(path, at->message, at->message_bytes);
    if (!library) return 0;
    const char *missing = NULL;
#define EGL_TAKE(field, TYPE)                                                    \
    at->egl.field = (PFNEGL##TYPE##PROC)noh_library_proc(library, "egl" #field); \
    if (!missing && !at->egl.field) missing = "egl" #field;
    EGL_FUNCTIONS(EGL_TAKE)
#undef EGL_TAKE
    if (missing) noh_message_add(at->message, at->message_bytes, "%s: has no %s\n", path, missing);
    return !missing;
}

static int load_system(attempt *at)
{
    at->egl.gles = noh_library_open("libGLESv2.so.2", at->message, at->message_bytes);
    return load_egl(at, "libEGL.so.1");
}

static int load_angle_from(attempt *at, const char *folder)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/libGLESv2.so", folder);
    at->egl.gles = noh_library_open(path, at->message, at->message_bytes);
    if (!at->egl.gles) return 0;
    snprintf(path, sizeof path, "%s/libEGL.so", folder);
    return load_egl(at, path);
}

static int load_angle(attempt *at)
{
    const char *folder = getenv("NOH_ANGLE");
    if (folder) return load_angle_from(at, folder);
    return load_angle_from(at, "/usr/lib/chromium");
}

/* --- the interface --- */

static noh_result create_with(const noh_platform_desc *desc, noh_platform_context **out, char *message,
                              size_t message_bytes, int (*load)(attempt *), int (*make)(attempt *), const char *hint)
{
    static const noh_platform_desc defaults;
    if (message_bytes) message[0] = 0;
    noh_platform_context *context = calloc(1, sizeof *context);
    if (!context) return NOH_ERR_MEMORY;
    attempt at = {
        .desc = desc ? desc : &defaults, .message = message, .message_bytes = message_bytes, .made = context
    };
    if (load(&at) && make(&at)) {
        if (message_bytes) message[0] = 0;
        *out = context;
        return NOH_OK;
    }
    noh_message_add(message, message_bytes, "%s", hint);
    free(context);
    return NOH_ERR_UNSUPPORTED;
}

static noh_result create_system(const noh_platform_desc *desc, noh_platform_context **out, char *message, size_t bytes)
{
    return create_with(desc, out, message, bytes, load_system, try_system, EGL_HINT);
}

static noh_result create_angle(const noh_platform_desc *desc, noh_platform_context **out, char *message, size_t bytes)
{
    return create_with(desc, out, message, bytes, load_angle, try_angle, ANGLE_HINT);
}

static noh_result make_current(noh_platform_context *context)
{
    const egl_api *egl = &context->egl;
    EGLBoolean made = egl->MakeCurrent(context->display, context->surface, context->surface, context->context);
    return made ? NOH_OK : NOH_ERR_GL;
}

static noh_gl_proc get_proc(void *user, const char *name)
{
    const noh_platform_context *context = user;
    noh_gl_proc proc = (noh_gl_proc)context->egl.GetProcAddress(name);
    /* Before EGL 1.5, eglGetProcAddress need not return core functions. */
    if (!proc && context->egl.gles) proc = noh_library_proc(context->egl.gles, name);
    return proc;
}

static noh_result present(noh_platform_context *context)
{
    const egl_api *egl = &context->egl;
    if (context->surface == EGL_NO_SURFACE) return NOH_OK;
    return egl->SwapBuffers(context->display, context->surface) ? NOH_OK : NOH_ERR_GL;
}

static void size(noh_platform_context *context, uint32_t *width, uint32_t *height)
{
    EGLint side[2] = { 0, 0 };
    if (context->surface != EGL_NO_SURFACE) {
        context->egl.QuerySurface(context->display, context->surface, EGL_WIDTH, &side[0]);
        context->egl.QuerySurface(context->display, context->surface, EGL_HEIGHT, &side[1]);
    }
    *width = (uint32_t)side[0];
    *height = (uint32_t)side[1];
}

/* The display stays initialised: other contexts of the process may share it. */
static void destroy(noh_platform_context *context)
{
    if (!context) return;
    const egl_api *egl = &context->egl;
    egl->MakeCurrent(context->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context->surface != EGL_NO_SURFACE) egl->DestroySurface(context->display, context->surface);
    egl->DestroyContext(context->display, context->context);
    free(context);
}

const noh_platform noh_platform_egl = {
    "egl",         "the system's EGL (Mesa or a vendor's driver), headless or in your window",
    create_system, make_current,
    get_proc,      present,
    size,          destroy
};
const noh_platform noh_platform_angle = { "angle",      "ANGLE on SwiftShader, from a Chromium installation",
                                          create_angle, make_current,
                                          get_proc,     present,
                                          size,         destroy };
