#include "view/view_events.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

#define LIGHT_STEP 15.0  /* degrees */
#define SETTLE_FRAMES 3  /* until a click shows: press, release, pose */
#define CLICK_POINTS 3.0 /* a click moves the mouse less */

/* ---- the mouse ---- */

static int on_stage(const view_window *w)
{
    float box[4];
    view_app_stage(&w->app, box);
    return w->mouse[0] >= (double)box[0] && w->mouse[0] < (double)box[2] && w->mouse[1] >= (double)box[1] &&
           w->mouse[1] < (double)box[3];
}

void view_on_button(view_window *w, int button, int action, int mods)
{
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

void view_on_move(view_window *w, double x, double y)
{
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

void view_on_wheel(view_window *w, double steps)
{
    if (on_stage(w) && !view_panels_hold_mouse()) {
        view_zoom(&w->app, steps);
    } else {
        w->input.wheel += (float)steps;
    }
}

/* ---- the keyboard ---- */

static void copy_weights(view_window *w)
{
    char *text = view_weights_copy(w->app.model);
    if (text) {
        glfwSetClipboardString(w->context.window, text);
    } else {
        tool_fail("copy", "no slider was moved: there is nothing to copy");
    }
    view_keep(&w->app, !text);
    free(text);
}

static void paste_weights(view_window *w)
{
    const char *text = glfwGetClipboardString(w->context.window);
    view_keep(&w->app, view_weights_paste(w->app.model, text ? text : ""));
}

static void escape(view_app *a)
{
    if (view_panels_has_list()) {
        return; /* it is closed */
    }
    if (a->window.show_help) {
        a->window.show_help = 0;
    } else {
        a->window.quit_asked = !a->window.quit_asked;
    }
}

static void on_control(view_window *w, int key, int shift)
{
    view_app *a = &w->app;
    switch (key) {
    case GLFW_KEY_Z: (void)(shift ? view_redo(a) : view_undo(a)); break;
    case GLFW_KEY_Y: (void)view_redo(a); break;
    case GLFW_KEY_C: copy_weights(w); break;
    case GLFW_KEY_V: paste_weights(w); break;
    case GLFW_KEY_Q: a->window.quit_asked = 1; break;
    default: break;
    }
}

static void on_command(view_window *w, int key)
{
    view_app *a = &w->app;
    switch (key) {
    case GLFW_KEY_SPACE: view_toggle_play(a); break;
    case GLFW_KEY_F: view_frame_all(a); break;
    case GLFW_KEY_T: a->camera.turntable = !a->camera.turntable; break;
    case GLFW_KEY_B: a->over.bones = !a->over.bones; break;
    case GLFW_KEY_W: a->over.wireframe = !a->over.wireframe; break;
    case GLFW_KEY_N: a->over.normals = !a->over.normals; break;
    case GLFW_KEY_P: view_push(a); break;
    case GLFW_KEY_L: view_lod_next(&a->lod, a->model); break;
    case GLFW_KEY_LEFT_BRACKET: view_turn_light(a, -LIGHT_STEP); break;
    case GLFW_KEY_RIGHT_BRACKET: view_turn_light(a, LIGHT_STEP); break;
    case GLFW_KEY_I: view_print(a, stdout); break;
    case GLFW_KEY_TAB: a->window.show_panels = !a->window.show_panels; break;
    case GLFW_KEY_F1: a->window.show_help = !a->window.show_help; break;
    case GLFW_KEY_F10: w->lose = 1; break;
    case GLFW_KEY_F11: w->save_in[0] = SETTLE_FRAMES; break;
    case GLFW_KEY_F12: w->save_in[1] = SETTLE_FRAMES; break;
    case GLFW_KEY_ESCAPE: escape(a); break;
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER: a->window.quits |= a->window.quit_asked; break;
    default: break;
    }
}

void view_on_key(view_window *w, int key, int action, int mods)
{
    if (key < 0 || key >= (int)sizeof w->input.keys) {
        return;
    }
    w->input.keys[key] = action != GLFW_RELEASE;
    w->keys_pressed[key] |= action == GLFW_PRESS;
    if (!w->app.model || action == GLFW_RELEASE || (key < GLFW_KEY_F1 && view_panels_want_keys())) {
        return;
    }
    if (mods & (GLFW_MOD_CONTROL | GLFW_MOD_SUPER)) {
        on_control(w, key, mods & GLFW_MOD_SHIFT);
    } else if (action == GLFW_PRESS) {
        on_command(w, key);
    }
}

void view_on_letter(view_window *w, unsigned letter)
{
    if (w->input.letter_count < (int)(sizeof w->input.letters / sizeof w->input.letters[0])) {
        w->input.letters[w->input.letter_count++] = letter;
    }
}

void view_on_drop(view_window *w, const char *path)
{
    if (w->app.model) (void)view_app_load(&w->app, path);
}

/* ---- from GLFW ---- */

static view_window *of(GLFWwindow *window)
{
    view_window *w = glfwGetWindowUserPointer(window);
    w->awake = AWAKE_FRAMES;
    return w;
}

static void hear_button(GLFWwindow *window, int button, int action, int mods)
{
    view_on_button(of(window), button, action, mods);
}

static void hear_move(GLFWwindow *window, double x, double y)
{
    view_window *w = of(window);
    view_on_move(w, x * (double)w->units[0], y * (double)w->units[1]);
}

static void hear_wheel(GLFWwindow *window, double x, double y)
{
    (void)x;
    view_on_wheel(of(window), y);
}

static void hear_key(GLFWwindow *window, int key, int code, int action, int mods)
{
    (void)code;
    view_on_key(of(window), key, action, mods);
}

static void hear_letter(GLFWwindow *window, unsigned letter)
{
    view_on_letter(of(window), letter);
}

static void hear_drop(GLFWwindow *window, int count, const char **paths)
{
    if (count) view_on_drop(of(window), paths[count - 1]);
}

static void hear_change(GLFWwindow *window)
{
    of(window);
}

void view_listen(view_window *w)
{
    GLFWwindow *window = w->context.window;
    glfwSetWindowUserPointer(window, w);
    glfwSetMouseButtonCallback(window, hear_button);
    glfwSetCursorPosCallback(window, hear_move);
    glfwSetScrollCallback(window, hear_wheel);
    glfwSetKeyCallback(window, hear_key);
    glfwSetCharCallback(window, hear_letter);
    glfwSetDropCallback(window, hear_drop);
    glfwSetWindowRefreshCallback(window, hear_change);
    w->awake = AWAKE_FRAMES;
}

void view_take_input(view_window *w, view_input *input)
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
