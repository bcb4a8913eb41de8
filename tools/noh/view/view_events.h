/* view_events.h: the window's state and input events, from GLFW or from a script (view_script.h).
 *
 *   view_listen      register the GLFW callbacks
 *   view_on_button, view_on_move, view_on_wheel, view_on_key, view_on_letter, view_on_drop
 *   view_take_input  passes the input to the panels, once a frame */
#ifndef NOH_NOH_VIEW_VIEW_EVENTS_H
#define NOH_NOH_VIEW_VIEW_EVENTS_H

#include "view/view_context.h"
#include "view/panels/view_panels.h"

#define AWAKE_FRAMES 4 /* drawn after an input before an unchanging picture idles */

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

void view_listen(view_window *w);

/* Points of the window; GLFW's buttons, keys and modifiers. */
void view_on_button(view_window *w, int button, int action, int mods);
void view_on_move(view_window *w, double x, double y);
void view_on_wheel(view_window *w, double steps);
void view_on_key(view_window *w, int key, int action, int mods);
void view_on_letter(view_window *w, unsigned letter);
void view_on_drop(view_window *w, const char *path);

void view_take_input(view_window *w, view_input *input);

#endif
