/* view_window.h: the viewer's window: GLFW, its events, the loop. */
#ifndef NOH_NOH_VIEW_VIEW_WINDOW_H
#define NOH_NOH_VIEW_VIEW_WINDOW_H

#include "view/view_app.h"

typedef struct view_run {
    view_model_desc desc;   /* width, height: of the window */
    const char *clip;       /* to play from the start; NULL: none */
    const char *data;       /* the data textures to show from the start (view_show_data); NULL: the sums */
    const char *script;     /* a text that moves the hand (view_script.h); NULL: none */
    const char *film;       /* of the frames, every second; NULL: none */
    const char *presets;    /* the file of user presets; NULL: in the model's folder */
    const char *vmc;        /* where a capture is received (view_capture.h); NULL: nowhere */
    int plays;              /* a model that is opened plays its first clip */
    int fixed_camera;       /* the camera does not follow the figure */
    int native;             /* the context by GLX or WGL instead of EGL */
    uint32_t frames;        /* draw this many, each 1/60 s of the clips, and end; 0: until the window is closed */
    const char *screenshot; /* of the last of them; NULL: none */
} view_run;

/* Prints an error and returns an exit code; 0 when the window was closed and GL reported no errors. */
int view_window_run(const view_run *run);

#endif
