#include "view/view_window.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "view/view_context.h"
#include "view/view_panels.h"
#include "cli/message.h"

#define AWAKE_FRAMES 4       /* drawn after an input before an unchanging picture idles */
#define VIEW_LIGHT_STEP 15.0 /* degrees */
#define SETTLE_FRAMES 3      /* until a click shows: press, release, pose */
#define CLICK_POINTS 3.0     /* a click moves the mouse less */

typedef struct view_window {
    view_context context;
    view_app app;
    float units[2]; /* points in a unit of the window system */
    int lose;       /* simulate a lost context */
    view_input input;
    uint8_t pressed[3], keys_pressed[512]; /* since the last frame: a click may be shorter than one */
    float pressed_at[2];
    int drag;       /* GLFW's button + 1 that drags the camera, 0: none */
    int pushes;     /* with Alt: a click pushes */
    double dragged; /* so far, points: a press that hardly moves is a click */
    double mouse[2];
    int awake;
    int save_in[2]; /* frames until the figure, the window is saved; 0: not requested */
    uint32_t saved; /* pictures */
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
    return w->mouse[0] >= (double)box[0] && w->mouse[0] < (double)box[2] && w->mouse[1] >= (double)box[1] &&
           w->mouse[1] < (double)box[3];
}

static void on_button(GLFWwindow *window, int button, int action, int mods)
{
    view_window *w = of(window);
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
        w->dragged = 0.0;
        w->pushes = (mods & GLFW_MOD_ALT) != 0;
    } else if (action == GLFW_RELEASE && w->drag == button + 1) {
        if (button == GLFW_MOUSE_BUTTON_LEFT && w->dragged < CLICK_POINTS) {
            (w->pushes ? view_push_window : view_pick_window)(&w->app, w->input.mouse[0], w->input.mouse[1]);
        }
        w->drag = 0;
    }
}

static void on_move(GLFWwindow *window, double window_x, double window_y)
{
    view_window *w = of(window);
    const double x = window_x * (double)w->units[0], y = window_y * (double)w->units[1];
    const double dx = x - w->mouse[0], dy = y - w->mouse[1];
    w->mouse[0] = x;
    w->mouse[1] = y;
    w->input.mouse[0] = (float)x;
    w->input.mouse[1] = (float)y;
    view_point_window(&w->app, (float)x, (float)y, on_stage(w));
    w->dragged += fabs(dx) + fabs(dy);
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
    case GLFW_KEY_P: view_push(a); break;
    case GLFW_KEY_L: view_lod_next(&a->lod, a->model); break;
    case GLFW_KEY_LEFT_BRACKET: view_turn_light(a, -VIEW_LIGHT_STEP); break;
    case GLFW_KEY_RIGHT_BRACKET: view_turn_light(a, VIEW_LIGHT_STEP); break;
    case GLFW_KEY_I: view_print(a); break;
    case GLFW_KEY_TAB: a->show_panels = !a->show_panels; break;
    case GLFW_KEY_F10: w->lose = 1; break;
    case GLFW_KEY_F11: w->save_in[0] = SETTLE_FRAMES; break;
    case GLFW_KEY_F12: w->save_in[1] = SETTLE_FRAMES; break;
    case GLFW_KEY_ESCAPE: glfwSetWindowShouldClose(w->context.window, GLFW_TRUE); break;
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
    float scale;
    int pixels[2], status;
    if (!view_context_measure(&w->context, pixels, &scale, w->units)) {
        return 0;
    }
    w->app.screen.width = (uint32_t)pixels[0];
    w->app.screen.height = (uint32_t)pixels[1];
    status = view_app_frame(&w->app, scale, seconds);
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

/* An unchanging picture is redrawn only after an event. */
static void wait_events(view_window *w, const view_run *run)
{
    const int moving = run->frames || view_app_moves(&w->app);
    if (moving || w->awake > 0) {
        glfwPollEvents();
    } else {
        glfwWaitEvents();
        w->app.times.last_ns = 0;
    }
    w->awake -= w->awake > 0;
}

static void listen(view_window *w)
{
    GLFWwindow *window = w->context.window;
    glfwSetWindowUserPointer(window, w);
    glfwSetMouseButtonCallback(window, on_button);
    glfwSetCursorPosCallback(window, on_move);
    glfwSetScrollCallback(window, on_wheel);
    glfwSetKeyCallback(window, on_key);
    glfwSetCharCallback(window, on_letter);
    glfwSetDropCallback(window, on_drop);
    glfwSetWindowRefreshCallback(window, on_change);
    w->awake = AWAKE_FRAMES;
}

/* Remake everything on the GPU in a new window; camera, clips and sliders keep their state. */
static int restore(view_window *w)
{
    int status;
    view_app_lost(&w->app);
    status = view_context_reopen(&w->context, w->app.model->path);
    if (!status) status = view_app_restore(&w->app);
    if (!status) listen(w);
    memset(&w->input, 0, sizeof w->input);
    w->drag = w->lose = 0;
    return status;
}

static int loop(view_window *w, const view_run *run)
{
    uint64_t last = noh_clock_ns();
    int status = 0;
    for (uint32_t frame = 0;
         !status && !glfwWindowShouldClose(w->context.window) && (!run->frames || frame < run->frames); frame++) {
        const uint64_t now = noh_clock_ns();
        const double seconds = (double)(now - last) * 1e-9;
        last = now;
        status = draw_frame(w, run->frames ? 1.0 / 60.0 : seconds < 0.1 ? seconds : 0.1);
        if (!status && run->screenshot && frame + 1 == run->frames) {
            status = view_save(&w->app, run->screenshot, 1);
        }
        save_when_asked(w);
        view_app_after(&w->app);
        glfwSwapBuffers(w->context.window);
        wait_events(w, run);
        if (!status && (w->lose || view_context_lost(&w->context))) {
            status = restore(w);
        }
    }
    return status;
}

static int show(view_window *w, const view_run *run)
{
    int status = view_app_open(&w->app, &run->desc);
    if (!status) status = view_panels_open();
    w->app.follow = !run->fixed_camera;
    if (!status && run->clip) status = start_clip(&w->app, run->clip);
    if (!status && run->data) status = view_show_data(&w->app, run->data);
    if (!status) {
        listen(w);
        status = loop(w, run);
    }
    view_panels_close();
    view_app_close(&w->app);
    if (!status && w->context.errors) {
        status = tool_fail("view", "GL reported %d errors", w->context.errors);
    }
    return status;
}

int view_window_run(const view_run *run)
{
    static view_window w;
    int status;
    memset(&w, 0, sizeof w);
    w.context.gpu = &w.app.gpu;
    w.context.native = run->native;
    w.context.interval = run->frames ? 0 : 1;
    status = view_context_open(&w.context, run->desc.width, run->desc.height, run->desc.path);
    if (!status) status = show(&w, run);
    view_context_close(&w.context);
    return status;
}
