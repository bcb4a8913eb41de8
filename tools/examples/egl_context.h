/* egl_context.h: an OpenGL ES 3 context without a window: on a surfaceless display if EGL has one, else on the default
 * display. It lasts until the program ends. Link EGL. */
#ifndef NOH_EXAMPLES_EGL_CONTEXT_H
#define NOH_EXAMPLES_EGL_CONTEXT_H

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl32.h>

#include "noh/gl_device.h"

/* A noh_gl_get_proc. */
static noh_gl_proc egl_context_get(void *user, const char *name)
{
    (void)user;
    return (noh_gl_proc)eglGetProcAddress(name);
}

/* Make it current; 0 on success. */
static int egl_context_open(void)
{
    static const EGLint wanted[] = { EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE };
    static const EGLint version[] = { EGL_CONTEXT_CLIENT_VERSION, 3, EGL_NONE };
    PFNEGLGETPLATFORMDISPLAYEXTPROC get = (PFNEGLGETPLATFORMDISPLAYEXTPROC)eglGetProcAddress(
        "eglGetPlatformDisplayEXT");
    EGLDisplay display = get ? get(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL) : EGL_NO_DISPLAY;
    EGLConfig config;
    EGLContext context;
    EGLint count = 0;
    if (display == EGL_NO_DISPLAY) display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    if (!eglInitialize(display, NULL, NULL) || !eglBindAPI(EGL_OPENGL_ES_API)) return 1;
    if (!eglChooseConfig(display, wanted, &config, 1, &count) || count == 0) return 1;
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
    return !context || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
}

#endif
