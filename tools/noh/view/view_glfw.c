/* The functions that the viewer calls, and those that Dear ImGui's backend for GLFW calls in its versions up to 1.90.
 * Hidden: were they visible, the library's own calls would end here too. */
#pragma GCC visibility push(hidden)
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#pragma GCC visibility pop

#include "view_glfw.h"

#include <string.h>

#include "cli/message.h"
#include "platforms.h"

/* VALUE(result, name, parameters, arguments), NOTHING(name, parameters, arguments) */
#define CALLS(VALUE, NOTHING)                                                                                         \
    VALUE(int, Init, (void), ())                                                                                      \
    VALUE(int, GetError, (const char **description), (description))                                                   \
    VALUE(GLFWerrorfun, SetErrorCallback, (GLFWerrorfun callback), (callback))                                        \
    VALUE(double, GetTime, (void), ())                                                                                \
    NOTHING(WindowHint, (int hint, int value), (hint, value))                                                         \
    VALUE(GLFWwindow *, CreateWindow, (int x, int y, const char *title, GLFWmonitor *monitor, GLFWwindow *share),     \
          (x, y, title, monitor, share))                                                                              \
    NOTHING(DestroyWindow, (GLFWwindow * window), (window))                                                           \
    VALUE(int, WindowShouldClose, (GLFWwindow * window), (window))                                                    \
    NOTHING(SetWindowTitle, (GLFWwindow * window, const char *title), (window, title))                                \
    NOTHING(GetWindowPos, (GLFWwindow * window, int *x, int *y), (window, x, y))                                      \
    NOTHING(SetWindowPos, (GLFWwindow * window, int x, int y), (window, x, y))                                        \
    NOTHING(GetWindowSize, (GLFWwindow * window, int *x, int *y), (window, x, y))                                     \
    NOTHING(SetWindowSize, (GLFWwindow * window, int x, int y), (window, x, y))                                       \
    NOTHING(GetFramebufferSize, (GLFWwindow * window, int *x, int *y), (window, x, y))                                \
    NOTHING(GetWindowContentScale, (GLFWwindow * window, float *x, float *y), (window, x, y))                         \
    NOTHING(ShowWindow, (GLFWwindow * window), (window))                                                              \
    NOTHING(FocusWindow, (GLFWwindow * window), (window))                                                             \
    VALUE(int, GetWindowAttrib, (GLFWwindow * window, int attribute), (window, attribute))                            \
    NOTHING(SetWindowAttrib, (GLFWwindow * window, int attribute, int value), (window, attribute, value))             \
    NOTHING(SetWindowOpacity, (GLFWwindow * window, float opacity), (window, opacity))                                \
    VALUE(void *, GetWindowUserPointer, (GLFWwindow * window), (window))                                              \
    NOTHING(SetWindowUserPointer, (GLFWwindow * window, void *pointer), (window, pointer))                            \
    VALUE(GLFWwindowposfun, SetWindowPosCallback, (GLFWwindow * window, GLFWwindowposfun f), (window, f))             \
    VALUE(GLFWwindowsizefun, SetWindowSizeCallback, (GLFWwindow * window, GLFWwindowsizefun f), (window, f))          \
    VALUE(GLFWwindowclosefun, SetWindowCloseCallback, (GLFWwindow * window, GLFWwindowclosefun f), (window, f))       \
    VALUE(GLFWwindowrefreshfun, SetWindowRefreshCallback, (GLFWwindow * window, GLFWwindowrefreshfun f), (window, f)) \
    VALUE(GLFWwindowfocusfun, SetWindowFocusCallback, (GLFWwindow * window, GLFWwindowfocusfun f), (window, f))       \
    NOTHING(PollEvents, (void), ())                                                                                   \
    NOTHING(WaitEventsTimeout, (double timeout), (timeout))                                                           \
    VALUE(int, GetInputMode, (GLFWwindow * window, int mode), (window, mode))                                         \
    NOTHING(SetInputMode, (GLFWwindow * window, int mode, int value), (window, mode, value))                          \
    VALUE(int, GetKey, (GLFWwindow * window, int key), (window, key))                                                 \
    VALUE(const char *, GetKeyName, (int key, int scancode), (key, scancode))                                         \
    VALUE(int, GetMouseButton, (GLFWwindow * window, int button), (window, button))                                   \
    NOTHING(GetCursorPos, (GLFWwindow * window, double *x, double *y), (window, x, y))                                \
    NOTHING(SetCursorPos, (GLFWwindow * window, double x, double y), (window, x, y))                                  \
    VALUE(GLFWcursor *, CreateStandardCursor, (int shape), (shape))                                                   \
    NOTHING(DestroyCursor, (GLFWcursor * cursor), (cursor))                                                           \
    NOTHING(SetCursor, (GLFWwindow * window, GLFWcursor * cursor), (window, cursor))                                  \
    VALUE(GLFWkeyfun, SetKeyCallback, (GLFWwindow * window, GLFWkeyfun f), (window, f))                               \
    VALUE(GLFWcharfun, SetCharCallback, (GLFWwindow * window, GLFWcharfun f), (window, f))                            \
    VALUE(GLFWmousebuttonfun, SetMouseButtonCallback, (GLFWwindow * window, GLFWmousebuttonfun f), (window, f))       \
    VALUE(GLFWcursorposfun, SetCursorPosCallback, (GLFWwindow * window, GLFWcursorposfun f), (window, f))             \
    VALUE(GLFWcursorenterfun, SetCursorEnterCallback, (GLFWwindow * window, GLFWcursorenterfun f), (window, f))       \
    VALUE(GLFWscrollfun, SetScrollCallback, (GLFWwindow * window, GLFWscrollfun f), (window, f))                      \
    VALUE(GLFWdropfun, SetDropCallback, (GLFWwindow * window, GLFWdropfun f), (window, f))                            \
    VALUE(GLFWmonitorfun, SetMonitorCallback, (GLFWmonitorfun f), (f))                                                \
    VALUE(GLFWmonitor **, GetMonitors, (int *count), (count))                                                         \
    NOTHING(GetMonitorPos, (GLFWmonitor * monitor, int *x, int *y), (monitor, x, y))                                  \
    NOTHING(GetMonitorWorkarea, (GLFWmonitor * monitor, int *x, int *y, int *w, int *h), (monitor, x, y, w, h))       \
    NOTHING(GetMonitorContentScale, (GLFWmonitor * monitor, float *x, float *y), (monitor, x, y))                     \
    VALUE(const GLFWvidmode *, GetVideoMode, (GLFWmonitor * monitor), (monitor))                                      \
    VALUE(const float *, GetJoystickAxes, (int joystick, int *count), (joystick, count))                              \
    VALUE(const unsigned char *, GetJoystickButtons, (int joystick, int *count), (joystick, count))                   \
    VALUE(int, GetGamepadState, (int joystick, GLFWgamepadstate *state), (joystick, state))                           \
    NOTHING(SetClipboardString, (GLFWwindow * window, const char *text), (window, text))                              \
    VALUE(const char *, GetClipboardString, (GLFWwindow * window), (window))                                          \
    NOTHING(MakeContextCurrent, (GLFWwindow * window), (window))                                                      \
    NOTHING(SwapBuffers, (GLFWwindow * window), (window))                                                             \
    NOTHING(SwapInterval, (int interval), (interval))                                                                 \
    VALUE(int, ExtensionSupported, (const char *extension), (extension))                                              \
    VALUE(GLFWglproc, GetProcAddress, (const char *name), (name))

#define FIELD(result, name, parameters, arguments) result(*name) parameters;
#define FIELD_OF_NOTHING(name, parameters, arguments) void(*name) parameters;
static struct {
    CALLS(FIELD, FIELD_OF_NOTHING)
} library;

#define FORWARD(result, name, parameters, arguments) \
    result glfw##name parameters                     \
    {                                                \
        return library.name arguments;               \
    }
#define FORWARD_NOTHING(name, parameters, arguments) \
    void glfw##name parameters                       \
    {                                                \
        library.name arguments;                      \
    }
CALLS(FORWARD, FORWARD_NOTHING)

int view_glfw_load(void)
{
    char message[512] = "";
    void *opened = noh_library_open("libglfw.so.3", message, sizeof message);
    const char *missing = NULL;
    if (!opened) {
        return tool_fail("view",
                         "windows need libglfw.so.3, which is not installed (Debian: apt install libglfw3): %.*s",
                         (int)strcspn(message, "\n"), message);
    }
#define TAKE(result, name, parameters, arguments)                                \
    library.name = (result(*) parameters)noh_library_proc(opened, "glfw" #name); \
    if (!missing && !library.name) missing = "glfw" #name;
#define TAKE_NOTHING(name, parameters, arguments) TAKE(void, name, parameters, arguments)
    CALLS(TAKE, TAKE_NOTHING)
    return missing ? tool_fail("view", "libglfw.so.3 has no %s: GLFW 3.3 or later is needed", missing) : 0;
}
