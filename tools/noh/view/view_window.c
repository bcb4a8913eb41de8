#include "view/view_window.h"

#include <string.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "view/view_panels.h"

#define AWAKE_FRAMES 4 /* drawn after an input before a still picture rests */
#define SETTLE_FRAMES 3 /* until what was clicked shows: press, release, pose */

typedef struct view_window {
    GLFWwindow *window;
    view_app app;
    view_input input;
    uint8_t pressed[3], keys_pressed[512]; /* since the last frame: a click may be shorter than one */
    float pressed_at[2];
    int drag;                              /* GLFW's button + 1 that drags the camera, 0: none */
    double mouse[2];
    int awake;
    int save_in[2];                        /* frames until the figure, the window is saved; 0: they are not asked for */
    uint32_t saved;                        /* pictures */
    int gl_errors;
} view_window;

static view_window *of(GLFWwindow *window)
{
    view_window *w = glfwGetWindowUserPointer(window);
    w->awake = AWAKE_FRAMES;
    return w;
}

/* ---- events ---- */

static int on_stage(const view_window *w)
{
    float box[4];
    view_app_stage(&w->app, box);
    return w->mouse[0] >= (double)box[0] && w->mouse[0] < (double)box[2] && w->mouse[1] >= (double)box[1] && w->mouse[1] < (double)box[3];
}

static void on_button(GLFWwindow *window, int button, int action, int mods)
{
    view_window *w = of(window);
    (void)mods;
    if (button > GLFW_MOUSE_BUTTON_MIDDLE) {
        return;
    }
    w->input.buttons[button] = action == GLFW_PRESS;
    w->pressed[button] |= action == GLFW_PRESS;
    if (action == GLFW_PRESS) {
        memcpy(w->pressed_at, w->input.mouse, sizeof w->pressed_at);
    }
    if (action == GLFW_PRESS && !w->drag && on_stage(w) && !view_panels_hold_mouse()) {
        w->drag = button + 1;
    } else if (action == GLFW_RELEASE && w->drag == button + 1) {
        w->drag = 0;
    }
}

static void on_move(GLFWwindow *window, double x, double y)
{
    view_window *w = of(window);
    const double dx = x - w->mouse[0], dy = y - w->mouse[1];
    w->mouse[0] = x;
    w->mouse[1] = y;
    w->input.mouse[0] = (float)x;
    w->input.mouse[1] = (float)y;
    if (w->drag == GLFW_MOUSE_BUTTON_LEFT + 1) {
        view_turn(&w->app, dx, dy);
    } else if (w->drag) {
        view_pan(&w->app, dx, dy);
    }
}

static void on_wheel(GLFWwindow *window, double x, double y)
{
    view_window *w = of(window);
    (void)x;
    if (on_stage(w) && !view_panels_hold_mouse()) {
        view_zoom(&w->app, y);
    } else {
        w->input.wheel += (float)y;
    }
}

static void on_letter(GLFWwindow *window, unsigned letter)
{
    view_window *w = of(window);
    if (w->input.letter_count < (int)(sizeof w->input.letters / sizeof w->input.letters[0])) {
        w->input.letters[w->input.letter_count++] = letter;
    }
}

static void on_command(view_window *w, int key)
{
    view_app *a = &w->app;
    switch (key) {
    case GLFW_KEY_SPACE: view_toggle_play(a); break;
    case GLFW_KEY_F: view_frame_all(a); break;
    case GLFW_KEY_TAB: a->show_panels = !a->show_panels; break;
    case GLFW_KEY_F11: w->save_in[0] = SETTLE_FRAMES; break;
    case GLFW_KEY_F12: w->save_in[1] = SETTLE_FRAMES; break;
    case GLFW_KEY_ESCAPE: glfwSetWindowShouldClose(w->window, GLFW_TRUE); break;
    default: break;
    }
}

static void on_key(GLFWwindow *window, int key, int code, int action, int mods)
{
    view_window *w = of(window);
    (void)code;
    (void)mods;
    if (key < 0 || key >= (int)sizeof w->input.keys) {
        return;
    }
    w->input.keys[key] = action != GLFW_RELEASE;
    w->keys_pressed[key] |= action == GLFW_PRESS;
    if (action == GLFW_PRESS && (key >= GLFW_KEY_F1 || !view_panels_want_keys())) {
        on_command(w, key);
    }
}

static void on_drop(GLFWwindow *window, int count, const char **paths)
{
    view_window *w = of(window);
    if (count && view_app_show(&w->app, paths[count - 1]) == 0) {
        glfwSetWindowTitle(window, w->app.model->path);
    }
}

static void on_change(GLFWwindow *window)
{
    of(window);
}

/* ---- opening ---- */

static void GL_APIENTRY on_gl_message(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length, const GLchar *message,
                                      const void *user)
{
    view_window *w = (view_window *)(uintptr_t)user;
    (void)source;
    (void)id;
    (void)severity;
    (void)length;
    if (type == GL_DEBUG_TYPE_ERROR) {
        w->gl_errors++;
        tool_fail("GL", "%s", message);
    }
}

/* After the probe of the capabilities, which tries what may be refused. */
static void watch_errors(view_window *w)
{
    const noh_gl_api *gl = &w->app.gpu.gl;
    if (gl->DebugMessageCallback) {
        gl->Enable(GL_DEBUG_OUTPUT);
        gl->Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        gl->DebugMessageCallback(on_gl_message, w);
    }
}

static noh_gl_proc find_proc(void *user, const char *name)
{
    (void)user;
    return glfwGetProcAddress(name);
}

static int fail_glfw(const char *what)
{
    const char *reason = NULL;
    glfwGetError(&reason);
    return tool_fail("view", "%s: %s", what, reason ? reason : "no reason given");
}

static GLFWwindow *make_window(const view_run *run)
{
    GLFWwindow *window = NULL;
    for (int version = 32; version >= 30 && !window; version--) {
        glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_ES_API);
        glfwWindowHint(GLFW_CONTEXT_CREATION_API, run->native ? GLFW_NATIVE_CONTEXT_API : GLFW_EGL_CONTEXT_API);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, version / 10);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, version % 10);
        glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
        window = glfwCreateWindow((int)run->desc.width, (int)run->desc.height, run->desc.path, NULL, NULL);
    }
    return window;
}

static void listen(view_window *w)
{
    glfwSetWindowUserPointer(w->window, w);
    glfwSetMouseButtonCallback(w->window, on_button);
    glfwSetCursorPosCallback(w->window, on_move);
    glfwSetScrollCallback(w->window, on_wheel);
    glfwSetKeyCallback(w->window, on_key);
    glfwSetCharCallback(w->window, on_letter);
    glfwSetDropCallback(w->window, on_drop);
    glfwSetWindowRefreshCallback(w->window, on_change);
}

static int open_window(view_window *w, const view_run *run)
{
    gpu *g = &w->app.gpu;
    noh_error error = { NOH_OK, "", 0, 0 };
    w->window = make_window(run);
    if (!w->window) {
        return fail_glfw("no window with OpenGL ES 3");
    }
    glfwMakeContextCurrent(w->window);
    glfwSwapInterval(run->frames ? 0 : 1);
    if (noh_gl_api_load(&g->gl, find_proc, NULL, &error) || noh_gl_caps_probe(&g->gl, &g->caps, &error)) {
        return tool_fail_error("view", &error);
    }
    watch_errors(w);
    return 0;
}

/* ---- the loop ---- */

static int start_clip(view_app *a, const char *name)
{
    for (uint32_t i = 0; i < a->model->clip_count; i++) {
        if (strcmp(a->model->clips[i].name, name) == 0) {
            view_play(a, i, 0);
            return 0;
        }
    }
    return tool_fail(a->model->path, "no clip named '%s' (`noh clip` lists them)", name);
}

static void take_presses(view_window *w, view_input *input)
{
    *input = w->input;
    for (int i = 0; i < 3; i++) {
        input->buttons[i] |= w->pressed[i];
        if (w->pressed[i]) {
            memcpy(input->mouse, w->pressed_at, sizeof input->mouse);
        }
    }
    for (size_t k = 0; k < sizeof input->keys; k++) {
        input->keys[k] |= w->keys_pressed[k];
    }
    memset(w->pressed, 0, sizeof w->pressed);
    memset(w->keys_pressed, 0, sizeof w->keys_pressed);
    w->input.letter_count = 0;
    w->input.wheel = 0.0f;
}

static int draw_frame(view_window *w, double seconds)
{
    view_input input;
    int width, height, pixels[2], status;
    glfwGetWindowSize(w->window, &width, &height);
    glfwGetFramebufferSize(w->window, &pixels[0], &pixels[1]);
    if (width < 1 || height < 1 || pixels[0] < 1 || pixels[1] < 1) {
        return 0; /* minimised */
    }
    w->app.screen.width = (uint32_t)pixels[0];
    w->app.screen.height = (uint32_t)pixels[1];
    status = view_app_frame(&w->app, (float)width, (float)height, seconds);
    if (status) {
        return status;
    }
    take_presses(w, &input);
    view_panels_frame(&w->app, &input, seconds);
    return 0;
}

static void save(view_window *w, int with_panels)
{
    char path[64];
    snprintf(path, sizeof path, "noh-%s-%u.png", with_panels ? "window" : "figure", ++w->saved);
    if (view_save(&w->app, path, with_panels) == 0) {
        printf("%s\n", path);
        fflush(stdout);
    }
}

static void save_when_asked(view_window *w)
{
    for (int i = 0; i < 2; i++) {
        if (w->save_in[i] && --w->save_in[i] == 0) {
            save(w, i);
        }
    }
}

/* A picture in which nothing moves is drawn again only when something happens. */
static void wait_events(view_window *w, const view_run *run)
{
    const int moving = run->frames || (w->app.playing && view_plays(w->app.model));
    if (moving || w->awake > 0) {
        glfwPollEvents();
    } else {
        glfwWaitEvents();
        w->app.times.last_ns = 0;
    }
    w->awake -= w->awake > 0;
}

static int loop(view_window *w, const view_run *run)
{
    uint64_t last = noh_clock_ns();
    int status = 0;
    for (uint32_t frame = 0; !status && !glfwWindowShouldClose(w->window) && (!run->frames || frame < run->frames); frame++) {
        const uint64_t now = noh_clock_ns();
        const double seconds = (double)(now - last) * 1e-9;
        last = now;
        status = draw_frame(w, run->frames ? 1.0 / 60.0 : seconds < 0.1 ? seconds : 0.1);
        if (!status && run->screenshot && frame + 1 == run->frames) {
            status = view_save(&w->app, run->screenshot, 1);
        }
        save_when_asked(w);
        view_app_after(&w->app);
        glfwSwapBuffers(w->window);
        wait_events(w, run);
    }
    return status;
}

static int show(view_window *w, const view_run *run)
{
    int status = view_app_open(&w->app, &run->desc);
    if (!status) status = view_panels_open(&w->app);
    if (!status && run->clip) status = start_clip(&w->app, run->clip);
    if (!status) {
        listen(w);
        w->awake = AWAKE_FRAMES;
        status = loop(w, run);
    }
    view_panels_close();
    view_app_close(&w->app);
    if (!status && w->gl_errors) {
        status = tool_fail("view", "GL reported %d errors", w->gl_errors);
    }
    return status;
}

int view_window_run(const view_run *run)
{
    static view_window w;
    int status;
    memset(&w, 0, sizeof w);
    if (!glfwInit()) {
        return fail_glfw("no display (DISPLAY, or xvfb-run)");
    }
    status = open_window(&w, run);
    if (!status) status = show(&w, run);
    if (w.window) {
        glfwDestroyWindow(w.window);
    }
    return status; /* GLFW stays: drivers do not survive being closed */
}
