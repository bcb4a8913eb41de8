/* view_app.h: the viewer's state: camera, playback, times, requests of the panels. No window and no panels.
 *
 *   view_app_begin, view_app_blank    a window without a model yet
 *   view_app_open / view_app_close
 *   view_app_lost, view_app_restore   restore everything on the GPU after a lost context
 *   view_app_show        replace the model by a pack or a converted model
 *   view_app_load        begin to convert a model, or show a pack at once; view_app_poll: show it when it is done, and
 *                        again when the file has changed on disk
 *   view_app_frame       advance time, draw the figure into the window
 *   view_app_moves       whether the next frame will differ
 *   view_app_after       carry out the requests of the panels
 *   view_play            play a clip; view_play_first plays the initial one
 *   view_pick_window     pick the point under the mouse
 *   view_push_window, view_push   push the figure under a point, or at its chest
 *   view_walk            root motion on and off; view_walk_home back to the origin
 *   view_toggle_play     play and pause; starts the first clip where none is on
 *   view_tell            show the last error in the window
 *   view_print           the state, as lines of text
 *   view_save            a picture
 *
 * The camera (view_camera.c):
 *   view_turn, view_pan, view_zoom   by hand
 *   view_frame_all       frame all clips that play, from the front
 *   view_follow          follows the figure and turns about it; frames other clips until it is moved by hand */
#ifndef NOH_NOH_VIEW_VIEW_APP_H
#define NOH_NOH_VIEW_VIEW_APP_H

#include <stdio.h>

#include "draw/framing.h"
#include "gl/device/gl_timer_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/pack.h"
#include "view/view_capture.h"
#include "view/view_compare.h"
#include "view/view_export.h"
#include "view/view_fall.h"
#include "view/view_lights.h"
#include "view/view_load.h"
#include "view/view_lod.h"
#include "view/view_marks.h"
#include "view/view_presets.h"
#include "view/view_screen.h"
#include "view/view_undo.h"
#include "view/view_watch.h"

#define VIEW_LINES 64
#define VIEW_HISTORY 120

/* Layout, points of the window. */
#define VIEW_LEFT 300
#define VIEW_RIGHT 360
#define VIEW_BOTTOM 116
#define VIEW_TURNTABLE_S 12.0 /* a turn */
#define VIEW_FRAMED_MAX 64u   /* clips that are framed together */

/* Milliseconds, smoothed over some frames; below 0: unknown. */
typedef struct view_times {
    float frame_ms[VIEW_HISTORY]; /* a ring, `next` is the oldest */
    uint32_t next;
    uint64_t last_ns; /* start of the last frame; 0: none, or the viewer was idle since */
    double frame, animate, accumulate, draw;
    noh_gl_timer accumulate_timer, draw_timer;
} view_times;

/* Callback keys that fired, as text: a ring, `next` is the oldest. */
typedef struct view_log {
    char lines[VIEW_LINES][160];
    uint32_t next, total;
} view_log;

#define VIEW_PATH 1024

/* Where the figure was on the floor: a ring, `next` is the oldest. */
typedef struct view_path {
    float points[VIEW_PATH][2]; /* x, z */
    uint32_t next, count;
} view_path;

#ifdef __cplusplus
extern "C" {
#endif

typedef enum view_data { VIEW_DATA_SUMS, VIEW_DATA_BASE, VIEW_DATA_DELTA } view_data;

/* The camera and its framing. */
typedef struct view_eye {
    orbit orbit;
    double anchor[3];     /* where the figure stood in the last frame */
    int follow;           /* the orbit's centre follows the figure */
    int turntable;        /* the camera turns about the figure */
    bounds framed_box;    /* what view_frame_all framed */
    double framed_aspect; /* the picture's aspect ratio when it did */
    double facing;        /* of the model: the camera and the light were turned to it */
    int by_hand;          /* moved by hand: other clips are not framed */
    framing *framing;     /* made for the model when first needed; NULL until then */
    uint8_t *framed;      /* [clip_count] 1: in the picture; NULL likewise */
    bounds *boxes;        /* [clip_count] of framing_clip */
    uint8_t *boxed;       /* [clip_count] 1: boxes has it, 2: the clip has no box */
} view_eye;

typedef struct view_window_state {
    float width, height; /* points */
    float scale;         /* pixels in a point */
    float pointer[2];    /* pixels of the canvas; faces look at it */
    int has_pointer;
    int show_panels, show_layers;
    int show_help;  /* the list of keys */
    int hand_busy;  /* a slider is held or a list is open: no undo step yet */
    int quit_asked; /* Esc was pressed: the panels ask for confirmation */
    int quits;
} view_window_state;

/* The floor, and root motion over it. */
typedef struct view_ground {
    int shown;
    double height;
    view_path walked;
} view_ground;

typedef struct view_film {
    view_export job;
    char path[256];
    int hz, turns;
} view_film;

typedef struct view_files {
    view_load load;
    view_watch watch;
    uint32_t reloads;         /* files read again after they changed on disk */
    const char *presets_path; /* NULL: in the model's folder */
} view_files;

/* The data textures drawn below the gain. */
typedef struct view_textures {
    view_data shown;
    uint32_t target; /* VIEW_DATA_DELTA: a target of view_data_mesh; past the last: none is shown */
} view_textures;

/* Requests of the panels, carried out by view_app_after. */
typedef struct view_request {
    view_model_desc desc;
    int reload; /* open the figure again with this desc */
} view_request;

typedef struct view_app {
    gpu gpu;
    view_screen screen;
    view_model *model;    /* never NULL after view_app_open */
    view_model_desc desc; /* how it was opened; path and anim are the caller's */
    view_eye camera;
    int cut; /* the next frame shows something else: nothing fades */
    view_lod lod;
    view_how how; /* the next clip */
    view_pad pad;
    view_pick pick;
    view_fall fall;
    view_marks marks;
    overlay overlay;
    view_over over;
    view_compare compare;
    view_film film;
    view_capture capture;
    view_lights lights;
    view_undo_list undo;
    view_presets presets;
    view_files files;
    int lazy;     /* draw a frame only when a script asks for its picture */
    int is_drawn; /* the last frame was drawn */
    int autoplay; /* a model that is opened plays its first clip */
    view_ground ground;
    int ramps;                     /* sliders of weights and speeds take how.fade_s to arrive */
    char part[NOH_NAME_BYTES_MAX]; /* the joint that view_model_desc.part names; "": none */
    view_window_state window;
    int playing;
    float speed, layer_gain;
    view_textures textures;
    view_times times;
    view_log log;
    char message[512]; /* the last error */
    view_request request;
} view_app;

/* The mesh whose data textures are shown: the first that targets move. Returns 0 where there is none. */
int view_data_mesh(const view_model *m, noh_mesh *mesh);

/* Show data textures: "sums", "base", or the deltas of the target of that name. Prints an error and returns an exit
 * code. */
int view_show_data(view_app *a, const char *name);

/* Before a model is there, with an open context in a->gpu: for panels over a blank window. Prints an error and returns
 * an exit code; 0 on success. view_app_close in any case. */
int view_app_begin(view_app *a);
void view_app_blank(view_app *a, float scale);

/* After view_app_begin. desc: with the window's size; desc->converted for a model. Prints an error and returns an exit
 * code; 0 on success. */
int view_app_open(view_app *a, const view_model_desc *desc);
void view_app_close(view_app *a);

/* converted: the pack of a model, taken over; NULL: the file is a pack. On failure the current model stays. */
int view_app_show(view_app *a, const char *path, byte_buffer *converted);
/* Show a pack at once; view_app_poll shows a model when its conversion is done. */
int view_app_load(view_app *a, const char *path);
/* Read a changed file again: weights, tracks of the same names, light and camera stay. */
void view_app_poll(view_app *a);
void view_tell(view_app *a);
/* status  0: clear the last error; else as view_tell */
void view_keep(view_app *a, int status);
/* Set up presets, camera and the first clip of a model that is shown. */
void view_begin_model(view_app *a);

/* The context was lost: forget its object names. Then fill a->gpu for another context and restore, or close. */
void view_app_lost(view_app *a);
int view_app_restore(view_app *a);

/* scale: pixels in a point; the window's pixels are in a->screen. seconds: of the clips' time.
 * Prints an error and returns an exit code; 0 on success. */
int view_app_frame(view_app *a, float scale, double seconds);
void view_app_after(view_app *a);
/* If a->lazy: draw the figure in its last pose, unless it is drawn already. Prints an error and returns an exit code;
 * 0 on success. */
int view_app_picture(view_app *a);
/* Copy the pictures into the window. */
void view_app_present(view_app *a);
/* 1 while clips play, change or fade: the next frame will differ. */
int view_app_moves(const view_app *a);

/* The figure's part of the window: left, top, right, bottom in points. */
void view_app_stage(const view_app *a, float box[4]);
/* The figure's picture, the first of several: its lower left corner and size. */
void view_figure_pixels(const view_app *a, int *x, int *y, uint32_t *width, uint32_t *height);

/* dx, dy in points, y down. */
void view_turn(view_app *a, double dx, double dy);
void view_pan(view_app *a, double dx, double dy);
void view_zoom(view_app *a, double steps);
void view_frame_all(view_app *a);
/* seconds: of the turntable. */
void view_follow(view_app *a, double seconds);
/* For another model: drop all measurements of the old one. */
void view_forget_frames(view_app *a);
/* Turn the light, where there is one. */
void view_turn_light(view_app *a, double degrees);
void view_toggle_play(view_app *a);
/* Start a clip with the settings a->how, in place of the clips on its layer or in addition to them. */
void view_play(view_app *a, uint32_t clip, int beside);
/* Play a clip whose name begins with idle, else the first that moves joints, else the first. */
void view_play_first(view_app *a);
/* A film of the picture: one turn, or the longest clip that plays, once, from its start. */
void view_export_begin(view_app *a);
void view_graph_start(view_app *a, uint32_t n);
/* Put a clip on the pad or take it off; play the pad, or stop. */
void view_pad_choose(view_app *a, uint32_t clip);
void view_pad_switch(view_app *a);
/* The mouse over the picture, at which faces look. inside 0: it is elsewhere */
void view_point_window(view_app *a, float x, float y, int inside);

void view_look_at_pointer(const view_app *a, const noh_gl_camera *camera);

/* Pick the point under the mouse and print it; nothing there: unpick. */
void view_pick_window(view_app *a, float x, float y);
/* Push the figure away from the camera: it falls, and gets up. Nothing there: no push. */
void view_push_window(view_app *a, float x, float y);
void view_push(view_app *a);
/* Takes effect with view_app_after. */
void view_walk(view_app *a, int root_motion);
void view_walk_home(view_app *a);
/* Prints tracks, pad, place, level, held weights and work in progress. */
void view_print(const view_app *a, FILE *out);

/* The figure without the panels, or the whole window, to a file. */
int view_save(view_app *a, const char *path, int with_panels);

#ifdef __cplusplus
}
#endif

#endif
