/* view_app.h: the viewer's state: camera, playback, times, requests of the panels. No window and no panels.
 *
 *   view_app_open / view_app_close
 *   view_app_lost, view_app_restore   everything on the GPU again, after a lost context
 *   view_app_show        a pack or a model instead of what is shown
 *   view_app_frame       advance time, draw the figure into the window
 *   view_app_moves       whether the next frame will differ
 *   view_app_after       carry out what the panels asked for
 *   view_turn, view_pan, view_zoom, view_frame_all   the camera
 *   view_play            a clip
 *   view_toggle_play     play and pause; starts the first clip where none is on
 *   view_save            a picture */
#ifndef NOH_NOH_VIEW_VIEW_APP_H
#define NOH_NOH_VIEW_VIEW_APP_H

#include "gl/gl_timer.h"
#include "view/view_lod.h"
#include "view/view_screen.h"

#define VIEW_LINES 64
#define VIEW_HISTORY 120

/* Layout, points of the window. */
#define VIEW_LEFT 300
#define VIEW_RIGHT 360
#define VIEW_BOTTOM 132

/* Milliseconds, smoothed over some frames; below 0: unknown. */
typedef struct view_times {
    float frame_ms[VIEW_HISTORY]; /* a ring, `next` is the oldest */
    uint32_t next;
    uint64_t last_ns; /* start of the last frame; 0: none, or the viewer was idle since */
    double frame, animate, accumulate, draw;
    noh_gl_timer accumulate_timer, draw_timer;
    noh_gl_morph_stats stats; /* of the last accumulation that was not empty */
} view_times;

/* Callback keys that fired, as text: a ring, `next` is the oldest. */
typedef struct view_log {
    char lines[VIEW_LINES][160];
    uint32_t next, total;
} view_log;

typedef struct view_app {
    gpu gpu;
    view_screen screen;
    view_model *model;    /* never NULL after view_app_open */
    view_model_desc desc; /* how it was opened; path and anim are the caller's */
    orbit orbit;
    double anchor[3]; /* where the figure stood in the last frame */
    int follow;       /* the orbit's centre goes with it */
    view_lod lod;
    float window_width, window_height; /* points */
    float scale;                       /* pixels in a point */
    int show_panels, show_layers, playing;
    float speed, layer_gain;
    view_times times;
    view_log log;
    char message[512]; /* the last error */

    view_model_desc wish; /* the panels ask for this one ... */
    int wants_reload;     /* ... to draw what is shown */
} view_app;

/* g: an open context, and the window's size. Prints an error and returns an exit code; 0 on success. */
int view_app_open(view_app *a, const view_model_desc *desc);
void view_app_close(view_app *a);

/* On failure the current model stays. */
int view_app_show(view_app *a, const char *path);

/* The context was lost: forget its object names. Then fill a->gpu for another context and restore, or close. */
void view_app_lost(view_app *a);
int view_app_restore(view_app *a);

/* scale: pixels in a point; the window's pixels are in a->screen. seconds: of the clips' time.
 * Prints an error and returns an exit code; 0 on success. */
int view_app_frame(view_app *a, float scale, double seconds);
void view_app_after(view_app *a);
/* 1 while clips play or LOD levels fade: the next frame will differ. */
int view_app_moves(const view_app *a);

/* The figure's part of the window: left, top, right, bottom in points. */
void view_app_stage(const view_app *a, float box[4]);

/* dx, dy in points, y down. */
void view_turn(view_app *a, double dx, double dy);
void view_pan(view_app *a, double dx, double dy);
void view_zoom(view_app *a, double steps);
void view_frame_all(view_app *a);
void view_toggle_play(view_app *a);
/* Start a clip, alone or beside those playing. */
void view_play(view_app *a, uint32_t clip, int beside);

/* The figure without the panels, or the whole window, to a file. */
int view_save(view_app *a, const char *path, int with_panels);

#endif
