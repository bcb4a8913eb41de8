#include "view/view_window.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "file/film_file.h"
#include "view/view_events.h"
#include "view/view_script.h"

#define LOOK_S 0.5 /* how often an idle viewer checks its file for changes */

/* ---- a frame ---- */

static int measure(view_window *w, float *scale)
{
    int pixels[2];
    if (!view_context_measure(&w->context, pixels, scale, w->units)) return 0;
    w->app.screen.width = (uint32_t)pixels[0];
    w->app.screen.height = (uint32_t)pixels[1];
    return 1;
}

static int draw_frame(view_window *w, double seconds)
{
    view_input input;
    float scale;
    int status;
    if (!measure(w, &scale)) {
        return 0;
    }
    status = view_app_frame(&w->app, scale, seconds);
    if (status) {
        return status;
    }
    view_take_input(w, &input);
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

/* A still picture is redrawn only after an event, or after its file has changed. */
static void wait_events(view_window *w, int moving)
{
    if (moving || view_app_moves(&w->app) || w->awake > 0) {
        glfwPollEvents();
    } else {
        glfwWaitEventsTimeout(LOOK_S);
        w->app.times.last_ns = 0;
    }
    w->awake -= w->awake > 0;
}

/* Remake everything on the GPU in a new window; camera, clips and sliders keep their state. */
static int restore(view_window *w)
{
    int status;
    view_app_lost(&w->app);
    status = view_context_reopen(&w->context, w->app.model->path);
    if (!status) status = view_app_restore(&w->app);
    if (!status) view_listen(w);
    memset(&w->input, 0, sizeof w->input);
    w->drag = w->lose = 0;
    return status;
}

/* The file that is shown gives the window its name. */
static void name_window(view_window *w, char shown[1024])
{
    if (strcmp(shown, w->app.model->path) == 0) return;
    snprintf(shown, 1024, "%s", w->app.model->path);
    glfwSetWindowTitle(w->context.window, shown);
}

/* ---- the loop ---- */

/* Frames by a count or a script instead of the clock. */
typedef struct fixed_frames {
    view_script *script; /* NULL: none */
    film film;
    int has_film;
    uint8_t *rgba;
} fixed_frames;

/* Every second frame of 1/60 s. */
static int add_to_film(view_window *w, fixed_frames *fixed, const view_run *run, uint32_t frame)
{
    canvas *c = &w->app.model->canvas;
    int status = 0;
    if (!run->film || frame % 2u) return 0;
    if (!fixed->has_film) {
        fixed->rgba = malloc((size_t)c->width * c->height * 4u);
        status = fixed->rgba ? film_open(&fixed->film, run->film, c->width, c->height, 30)
                             : tool_fail(run->film, "out of memory");
        fixed->has_film = !status;
    }
    if (!status) status = canvas_read(c, fixed->rgba);
    if (!status && film_add(&fixed->film, fixed->rgba)) {
        fixed->has_film = 0;
        (void)film_close(&fixed->film, 1); /* it printed the reason */
        status = EXIT_FAILED;
    }
    return status;
}

static int end_fixed(fixed_frames *fixed, int status)
{
    if (fixed->has_film) {
        const int failed = film_close(&fixed->film, !status);
        status = status ? status : failed;
    }
    view_script_close(fixed->script);
    free(fixed->rgba);
    return status;
}

static int one_frame(view_window *w, fixed_frames *fixed, const view_run *run, uint32_t frame, double seconds)
{
    int status = draw_frame(w, seconds);
    if (!status && run->screenshot && frame + 1 == run->frames) status = view_save(&w->app, run->screenshot, 1);
    if (!status) status = add_to_film(w, fixed, run, frame);
    save_when_asked(w);
    view_app_poll(&w->app);
    view_app_after(&w->app);
    if (!w->app.lazy) glfwSwapBuffers(w->context.window);
    wait_events(w, run->frames || fixed->script);
    if (!status && (w->lose || view_context_lost(&w->context))) status = restore(w);
    return status;
}

static int loop(view_window *w, const view_run *run)
{
    const int is_fixed = run->frames || run->script;
    fixed_frames fixed;
    char shown[1024] = "";
    uint64_t last = noh_clock_ns();
    int status = 0, ends = 0;
    memset(&fixed, 0, sizeof fixed);
    if (run->script && !(fixed.script = view_script_open(run->script))) return EXIT_FAILED;
    for (uint32_t frame = 0; !status && !ends; frame++) {
        const uint64_t now = noh_clock_ns();
        const double seconds = (double)(now - last) * 1e-9;
        last = now;
        name_window(w, shown);
        status = one_frame(w, &fixed, run, frame, is_fixed ? 1.0 / 60.0 : seconds < 0.1 ? seconds : 0.1);
        ends = glfwWindowShouldClose(w->context.window) || w->app.window.quits ||
               (run->frames && frame + 1 >= run->frames);
        if (!status && fixed.script) {
            const int step = view_script_step(fixed.script, w);
            status = step < 0 ? EXIT_FAILED : 0;
            ends |= step > 0;
        }
    }
    return end_fixed(&fixed, status);
}

/* ---- opening ---- */

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

/* Converts the model in another process while the window shows the progress. *converted is empty if the file is a pack,
 * or if the window was closed before the end. */
static int convert(view_window *w, const view_run *run, byte_buffer *converted)
{
    view_load *load = &w->app.files.load;
    int status;
    memset(converted, 0, sizeof *converted);
    if (!view_is_model(run->desc.path)) return 0;
    status = view_load_start(load, run->desc.path, run->desc.levels);
    while (!status && view_load_poll(load) == VIEW_LOAD_RUNS) {
        view_input input;
        float scale;
        if (measure(w, &scale)) {
            view_app_blank(&w->app, scale);
            view_take_input(w, &input);
            view_panels_frame(&w->app, &input, 1.0 / 60.0);
            glfwSwapBuffers(w->context.window);
        }
        glfwWaitEventsTimeout(0.05);
        if (glfwWindowShouldClose(w->context.window) || w->app.window.quits || load->state == VIEW_LOAD_NONE) {
            view_load_cancel(load);
            w->app.window.quits = 1;
            return 0;
        }
    }
    if (status || load->state == VIEW_LOAD_FAILED) return EXIT_FAILED;
    return view_load_take(load, converted);
}

static int show(view_window *w, const view_run *run)
{
    byte_buffer converted;
    view_model_desc desc = run->desc;
    int status = view_app_begin(&w->app);
    if (!status) status = view_panels_open(run->script != NULL);
    view_listen(w);
    if (!status && run->vmc) status = view_capture_open(&w->app.capture, run->vmc);
    if (!status) status = convert(w, run, &converted);
    if (status || w->app.window.quits) {
        view_panels_close();
        view_app_close(&w->app);
        return status;
    }
    desc.drivers = run->vmc ? w->app.capture.drivers : NULL;
    desc.converted = converted.count ? &converted : NULL;
    w->app.files.presets_path = run->presets;
    w->app.lazy = run->script != NULL;
    w->app.autoplay = run->plays && !run->clip;
    status = view_app_open(&w->app, &desc);
    w->app.autoplay = run->plays;
    w->app.camera.follow = !run->fixed_camera;
    if (!status && run->clip) status = start_clip(&w->app, run->clip);
    if (!status && run->data) status = view_show_data(&w->app, run->data);
    if (!status) status = loop(w, run);
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
    w.context.interval = run->frames || run->script ? 0 : 1;
    status = view_context_open(&w.context, run->desc.width, run->desc.height, run->desc.path);
    if (!status) status = show(&w, run);
    view_context_close(&w.context);
    return status;
}
