/* view_panels.h: the panels, by Dear ImGui. All C++ of the viewer is behind this header. */
#ifndef NOH_NOH_VIEW_PANELS_VIEW_PANELS_H
#define NOH_NOH_VIEW_PANELS_VIEW_PANELS_H

#ifdef __cplusplus
extern "C" {
#endif

#include "view/view_app.h"

/* The input since the last frame. */
typedef struct view_input {
    float mouse[2]; /* points */
    int buttons[3]; /* left, right, middle: down, or pressed since the last frame */
    float wheel;
    uint8_t keys[512];    /* by GLFW's codes: down, or pressed since the last frame */
    unsigned letters[32]; /* [letter_count] typed */
    int letter_count;
} view_input;

/* 0, or an exit code after printing. */
/* scripted  1: controls are found by name */
int view_panels_open(int scripted);
void view_panels_close(void);

/* Take the input, lay out the panels, draw them over the window. */
void view_panels_frame(view_app *a, const view_input *input, double seconds);

/* Whether a slider is dragged or a list open: then the panels own the mouse everywhere. */
int view_panels_hold_mouse(void);
/* Once more what was laid out last, where frames are not drawn (view_app.lazy). */
void view_panels_draw(view_app *a);

/* Find a control by its label; "walk/play" selects the one inside "walk" if there are several. box: left, top, right,
 * bottom. Returns 0: none in the last frame, 1: it is in the window, 2: it must be scrolled to. */
int view_panels_find(const char *name, float box[4]);
/* Scroll to it, in the next frame. */
void view_panels_want(const char *name);
/* Whether a list is open, which Esc closes. */
int view_panels_has_list(void);
/* Whether a text is being typed. */
int view_panels_want_keys(void);

#ifdef __cplusplus
}
#endif
#endif
