#include "view/view_context.h"

#include <string.h>

#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "cli/message.h"
#include "view/view_glfw.h"

/* ---- the window ---- */

static int fail_glfw(const char *what)
{
    const char *reason = NULL;
    glfwGetError(&reason);
    return tool_fail("view", "%s: %s", what, reason ? reason : "no reason given");
}

/* The highest OpenGL ES version available; with `robust`, losses are reported. */
static GLFWwindow *make_version(const view_context *c, int width, int height, const char *title, int robust)
{
    GLFWwindow *window = NULL;
    for (int version = 32; version >= 30 && !window; version--) {
        glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_ES_API);
        glfwWindowHint(GLFW_CONTEXT_CREATION_API, c->native ? GLFW_NATIVE_CONTEXT_API : GLFW_EGL_CONTEXT_API);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, version / 10);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, version % 10);
        glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, robust ? GLFW_LOSE_CONTEXT_ON_RESET : GLFW_NO_ROBUSTNESS);
        glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
        window = glfwCreateWindow(width, height, title, NULL, NULL);
    }
    return window;
}

static int make_window(view_context *c, int width, int height, const char *title)
{
    c->window = make_version(c, width, height, title, 1);
    if (!c->window) {
        c->window = make_version(c, width, height, title, 0);
    }
    return c->window ? 0 : fail_glfw("no window with OpenGL ES 3");
}

/* ---- its context ---- */

static void GL_APIENTRY on_gl_message(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                      const GLchar *message, const void *user)
{
    view_context *c = (view_context *)(uintptr_t)user;
    (void)source;
    (void)id;
    (void)severity;
    (void)length;
    if (type == GL_DEBUG_TYPE_ERROR) {
        c->errors++;
        tool_fail("GL", "%s", message);
    }
}

/* Called after the probe, which provokes errors on purpose. */
static void watch_errors(view_context *c)
{
    const noh_gl_api *gl = &c->gpu->gl;
    if (gl->DebugMessageCallback) {
        gl->Enable(GL_DEBUG_OUTPUT);
        gl->Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        gl->DebugMessageCallback(on_gl_message, c);
    }
}

static noh_gl_proc find_proc(void *user, const char *name)
{
    (void)user;
    return glfwGetProcAddress(name);
}

/* Core in OpenGL ES 3.2, and in two extensions; looking it up without them is not allowed. */
static void find_reset_status(view_context *c, const noh_gl_caps *caps)
{
    const char *name = NULL;
    if (caps->version >= 320) {
        name = "glGetGraphicsResetStatus";
    } else if (glfwExtensionSupported("GL_KHR_robustness")) {
        name = "glGetGraphicsResetStatusKHR";
    } else if (glfwExtensionSupported("GL_EXT_robustness")) {
        name = "glGetGraphicsResetStatusEXT";
    }
    c->reset_status = name ? (GLenum(GL_APIENTRY *)(void))glfwGetProcAddress(name) : NULL;
}

static int start_context(view_context *c, noh_gl_caps *caps)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    glfwMakeContextCurrent(c->window);
    glfwSwapInterval(c->interval);
    if (noh_gl_api_load(&c->gpu->gl, find_proc, NULL, &error) || noh_gl_caps_probe(&c->gpu->gl, caps, &error)) {
        return tool_fail_error("view", &error);
    }
    c->gpu->gl.decode = noh_etc2_decode;
    find_reset_status(c, caps);
    watch_errors(c);
    return 0;
}

int view_context_open(view_context *c, uint32_t width, uint32_t height, const char *title)
{
    const int status = view_glfw_load();
    if (status) return status;
    if (!glfwInit()) {
        return fail_glfw("no display (DISPLAY, or xvfb-run)");
    }
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    if (make_window(c, (int)width, (int)height, title)) {
        return EXIT_FAILED;
    }
    return start_context(c, &c->gpu->caps);
}

void view_context_close(view_context *c)
{
    if (c->window) {
        glfwDestroyWindow(c->window);
    }
    c->window = NULL; /* GLFW stays initialised: drivers do not survive its termination */
}

int view_context_lost(const view_context *c)
{
    return c->reset_status && c->reset_status() != GL_NO_ERROR;
}

static int reopen(view_context *c, const char *title)
{
    noh_gl_caps caps;
    int place[2], size[2], status;
    glfwGetWindowPos(c->window, &place[0], &place[1]);
    glfwGetWindowSize(c->window, &size[0], &size[1]);
    view_context_close(c);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_FALSE); /* the first window was scaled already */
    status = make_window(c, size[0], size[1], title);
    if (!status) {
        glfwSetWindowPos(c->window, place[0], place[1]);
        status = start_context(c, &caps);
    }
    /* A plan for the old driver may not work on another. */
    if (!status && memcmp(&caps, &c->gpu->caps, sizeof caps) != 0) {
        status = tool_fail("view", "the GL context was lost and came back with another driver (%s): restart noh view",
                           caps.renderer);
    }
    return status;
}

int view_context_reopen(view_context *c, const char *title)
{
    const int status = reopen(c, title);
    if (status) {
        c->gpu->gl = *noh_gl_lost_api();
        view_context_close(c);
    }
    return status;
}

int view_context_measure(const view_context *c, int pixels[2], float *scale, float units[2])
{
    int size[2];
    float scales[2];
    glfwGetWindowSize(c->window, &size[0], &size[1]);
    glfwGetFramebufferSize(c->window, &pixels[0], &pixels[1]);
    glfwGetWindowContentScale(c->window, &scales[0], &scales[1]);
    if (size[0] < 1 || size[1] < 1 || pixels[0] < 1 || pixels[1] < 1) {
        return 0; /* minimised */
    }
    *scale = scales[0] > 0.0f ? scales[0] : 1.0f;
    for (int i = 0; i < 2; i++) {
        units[i] = (float)pixels[i] / (float)size[i] / *scale;
    }
    return 1;
}
