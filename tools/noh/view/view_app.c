#include "view/view_app.h"
#include "cli/message.h"
#include "file/png_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- opening ---- */

static void keep_failure(view_app *a, int status)
{
    snprintf(a->message, sizeof a->message, "%s", status ? tool_last_failure() : "");
}

static void figure_pixels(const view_app *a, int *x, int *y, uint32_t *width, uint32_t *height)
{
    float box[4];
    view_app_stage(a, box);
    *x = (int)(box[0] * a->scale);
    *y = (int)((a->window_height - box[3]) * a->scale);
    *width = (uint32_t)fmaxf((box[2] - box[0]) * a->scale, 1.0f);
    *height = (uint32_t)fmaxf((box[3] - box[1]) * a->scale, 1.0f);
}

static void open_timers(view_app *a)
{
    noh_gl_timer_init(&a->times.accumulate_timer, &a->gpu.gl, &a->gpu.caps);
    noh_gl_timer_init(&a->times.draw_timer, &a->gpu.gl, &a->gpu.caps);
}

int view_app_open(view_app *a, const view_model_desc *desc)
{
    int x, y, status = view_screen_open(&a->screen, &a->gpu);
    a->desc = *desc;
    a->show_panels = a->show_layers = a->follow = 1;
    a->speed = 1.0f;
    a->layer_gain = 1.0f;
    a->lod.settings.pixels = 1.0f;
    a->screen.width = desc->width;
    a->screen.height = desc->height;
    a->window_width = (float)desc->width;
    a->window_height = (float)desc->height;
    a->scale = 1.0f;
    figure_pixels(a, &x, &y, &a->desc.width, &a->desc.height);
    if (!status) status = view_model_open(&a->gpu, &a->desc, &a->model);
    if (status) {
        return status;
    }
    a->wish = a->desc;
    open_timers(a);
    a->times.accumulate = a->times.draw = a->times.accumulate_timer.available ? 0.0 : -1.0;
    view_frame_all(a);
    return 0;
}

void view_app_close(view_app *a)
{
    noh_gl_timer_delete(&a->times.accumulate_timer, &a->gpu.gl);
    noh_gl_timer_delete(&a->times.draw_timer, &a->gpu.gl);
    view_model_close(a->model);
    view_screen_close(&a->screen);
}

void view_app_lost(view_app *a)
{
    memset(&a->screen, 0, sizeof a->screen);
    memset(&a->times.accumulate_timer, 0, sizeof a->times.accumulate_timer);
    memset(&a->times.draw_timer, 0, sizeof a->times.draw_timer);
    view_model_lost(a->model, &a->gpu);
}

int view_app_restore(view_app *a)
{
    const int status = view_screen_open(&a->screen, &a->gpu);
    open_timers(a);
    return status ? status : view_model_restore(a->model, &a->gpu);
}

int view_app_show(view_app *a, const char *path)
{
    view_model_desc desc = a->desc;
    view_model *shown;
    int status;
    desc.path = path;
    desc.anim = NULL; /* another pack's clips belonged to the old model */
    status = view_model_open(&a->gpu, &desc, &shown);
    keep_failure(a, status);
    if (status) {
        return status;
    }
    view_model_close(a->model);
    a->model = shown;
    a->desc = a->wish = desc;
    a->desc.path = a->wish.path = shown->path;
    memset(&a->log, 0, sizeof a->log);
    view_frame_all(a);
    return 0;
}

/* ---- the camera ---- */

void view_app_stage(const view_app *a, float box[4])
{
    box[0] = a->show_panels ? VIEW_LEFT : 0.0f;
    box[1] = 0.0f;
    box[2] = fmaxf(a->window_width - (a->show_panels ? VIEW_RIGHT : 0.0f), box[0] + 1.0f);
    box[3] = fmaxf(a->window_height - (a->show_panels ? VIEW_BOTTOM : 0.0f), 1.0f);
}

void view_frame_all(view_app *a)
{
    const bounds around = view_model_bounds(a->model);
    int x, y;
    uint32_t width, height;
    figure_pixels(a, &x, &y, &width, &height);
    a->orbit = orbit_fit(&around, (double)width / (double)height);
    scene_anchor(&a->model->scene, a->anchor);
}

/* A clip that walks takes the camera along, and back where it begins again. */
static void follow(view_app *a)
{
    double anchor[3];
    scene_anchor(&a->model->scene, anchor);
    for (int c = 0; c < 3; c++) {
        a->orbit.center[c] += a->follow ? anchor[c] - a->anchor[c] : 0.0;
        a->anchor[c] = anchor[c];
    }
}

void view_turn(view_app *a, double dx, double dy)
{
    a->orbit.azimuth -= dx * 0.01;
    a->orbit.elevation = fmin(fmax(a->orbit.elevation + dy * 0.01, -1.5), 1.5);
}

void view_pan(view_app *a, double dx, double dy)
{
    double right[3], up[3], back[3], per_point;
    float box[4];
    view_app_stage(a, box);
    per_point = 0.536 * a->orbit.distance / (double)(box[3] - box[1]); /* twice the tangent of 15 degrees */
    orbit_axes(&a->orbit, right, up, back);
    for (int c = 0; c < 3; c++) {
        a->orbit.center[c] += (up[c] * dy - right[c] * dx) * per_point;
    }
}

void view_zoom(view_app *a, double steps)
{
    const double distance = a->orbit.distance * exp(-0.12 * steps);
    a->orbit.distance = fmin(fmax(distance, a->orbit.radius * 0.05), a->orbit.radius * 50.0);
}

/* ---- playing ---- */

void view_play(view_app *a, uint32_t clip, int beside)
{
    const int status = beside ? view_add(a->model, clip) : view_start(a->model, clip);
    keep_failure(a, status);
    a->playing = a->playing || !status;
}

void view_toggle_play(view_app *a)
{
    if (view_plays(a->model)) {
        a->playing = !a->playing;
    } else if (a->model->clip_count) {
        view_play(a, 0, 0);
    }
}

static void log_event(void *user, const view_passed *event)
{
    view_log *log = (view_log *)user;
    snprintf(log->lines[log->next], sizeof log->lines[0], "%9.3f s   %s / %s   track %u, weight %.2f", event->clock_s,
             event->clip, event->key, event->track, (double)event->weight);
    log->next = (log->next + 1) % VIEW_LINES;
    log->total++;
}

/* ---- a frame ---- */

static void smooth(double *value, double now)
{
    *value = *value > 0.0 ? *value + 0.1 * (now - *value) : now;
}

static void poll_timer(noh_gl_timer *timer, const noh_gl_api *gl, double *ms)
{
    uint64_t ns;
    while (noh_gl_timer_poll(timer, gl, &ns) == NOH_OK) {
        smooth(ms, (double)ns * 1e-6);
    }
}

static void animate(view_app *a, double seconds)
{
    const uint64_t start = noh_clock_ns();
    if (a->playing) {
        view_step(a->model, seconds * (double)a->speed, log_event, &a->log);
    }
    view_model_pose(a->model);
    follow(a);
    smooth(&a->times.animate, (double)(noh_clock_ns() - start) * 1e-6);
}

static int fit_canvas(view_app *a, int *x, int *y)
{
    canvas *c = &a->model->drawing.canvas;
    uint32_t width, height;
    figure_pixels(a, x, y, &width, &height);
    a->orbit.aspect = (double)width / (double)height;
    a->desc.width = a->wish.width = width;
    a->desc.height = a->wish.height = height;
    if (width == c->width && height == c->height) {
        return 0;
    }
    canvas_close(c);
    a->model->drawing.has_canvas = 0;
    if (canvas_open(c, &a->gpu, width, height)) {
        return EXIT_FAILED;
    }
    a->model->drawing.has_canvas = 1;
    return 0;
}

/* Deltas of positions are in model units: at gain 1 the largest is white or black. */
static void draw_layers(view_app *a)
{
    const load *l = &a->model->drawing.load;
    const float gain = a->layer_gain;
    const float gains[3] = { 0.5f * gain / a->model->delta_max, gain, gain };
    if (l->morph.morph && a->show_panels && a->show_layers) {
        view_screen_layers(&a->screen, l->morph.morph, gains);
    }
}

static int draw(view_app *a)
{
    const noh_gl_api *gl = &a->gpu.gl;
    view_times *t = &a->times;
    drawing *d = &a->model->drawing;
    noh_gl_camera camera;
    noh_gl_morph_stats stats;
    int status = 0;
    memset(&stats, 0, sizeof stats);
    orbit_camera(&a->orbit, &camera);
    noh_gl_timer_begin(&t->accumulate_timer, gl);
    if (!d->bones) status = load_update(&d->load, &stats);
    noh_gl_timer_end(&t->accumulate_timer, gl);
    if (status) {
        return status;
    }
    t->stats = stats.instances ? stats : t->stats;
    noh_gl_timer_begin(&t->draw_timer, gl);
    drawing_paint(d, &camera);
    noh_gl_timer_end(&t->draw_timer, gl);
    poll_timer(&t->accumulate_timer, gl, &t->accumulate);
    poll_timer(&t->draw_timer, gl, &t->draw);
    return 0;
}

static void time_frame(view_times *t)
{
    const uint64_t now = noh_clock_ns();
    if (t->last_ns) {
        const double ms = (double)(now - t->last_ns) * 1e-6;
        smooth(&t->frame, ms);
        t->frame_ms[t->next] = (float)ms;
        t->next = (t->next + 1) % VIEW_HISTORY;
    }
    t->last_ns = now;
}

int view_app_frame(view_app *a, float scale, double seconds)
{
    int x, y, status;
    a->scale = scale;
    a->window_width = (float)a->screen.width / scale;
    a->window_height = (float)a->screen.height / scale;
    time_frame(&a->times);
    animate(a, seconds);
    status = fit_canvas(a, &x, &y);
    if (!status) {
        view_lod_frame(&a->lod, a->model, &a->orbit, seconds);
        status = draw(a);
    }
    if (status) {
        return status;
    }
    draw_layers(a);
    view_screen_picture(&a->screen, &a->model->drawing.canvas, x, y);
    return 0;
}

int view_app_moves(const view_app *a)
{
    return a->lod.fade < 1.0f || (a->playing && view_plays(a->model));
}

void view_app_after(view_app *a)
{
    int status;
    if (!a->wants_reload) {
        return;
    }
    a->wants_reload = 0;
    status = view_model_reload(a->model, &a->gpu, &a->wish);
    keep_failure(a, status);
    if (status) {
        a->wish = a->desc;
    } else {
        a->desc = a->wish;
    }
}

int view_save(view_app *a, const char *path, int with_panels)
{
    canvas *c = &a->model->drawing.canvas;
    const uint32_t width = with_panels ? a->screen.width : c->width,
                   height = with_panels ? a->screen.height : c->height;
    uint8_t *rgba = malloc((size_t)width * height * 4);
    int status = rgba ? 0 : tool_fail(path, "out of memory");
    if (!status) status = with_panels ? view_screen_read(&a->screen, rgba) : canvas_read(c, rgba);
    if (!status) status = tool_write_png(path, width, height, rgba);
    free(rgba);
    keep_failure(a, status);
    return status;
}
