#include "view/view_app.h"
#include "cli/message.h"
#include "file/png_file.h"
#include "gl/device/gl_timer_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/low_motion.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- opening ---- */

void view_tell(view_app *a)
{
    snprintf(a->message, sizeof a->message, "%s", tool_last_failure());
}

void view_keep(view_app *a, int status)
{
    snprintf(a->message, sizeof a->message, "%s", status ? tool_last_failure() : "");
}

static void open_timers(view_app *a)
{
    noh_gl_timer_init(&a->times.accumulate_timer, &a->gpu.gl, &a->gpu.caps);
    noh_gl_timer_init(&a->times.draw_timer, &a->gpu.gl, &a->gpu.caps);
}

static void set_defaults(view_app *a, const view_model_desc *desc)
{
    a->desc = *desc;
    a->window.show_panels = a->window.show_layers = a->camera.follow = a->cut = 1;
    a->ground.shown = desc->root_motion;
    a->speed = a->how.speed = a->how.weight = 1.0f;
    a->how.fade_s = 0.2f;
    a->how.loop = NOH_LOOP_REPEAT; /* a clip on show repeats */
    a->layer_gain = a->lod.wrinkles = 1.0f;
    a->lod.pixels = 1.0f;
    a->over.joint = NOH_NONE;
    a->compare.gain = 8.0f;
    a->film.hz = 30;
    view_lights_open(&a->lights, desc->light);
    if (!a->film.path[0]) snprintf(a->film.path, sizeof a->film.path, "noh.gif");
}

static int open_screen(view_app *a)
{
    int status = view_screen_open(&a->screen, &a->gpu);
    if (!status) status = view_marks_open(&a->marks, &a->gpu);
    if (!status) status = overlay_open(&a->overlay, &a->gpu);
    open_timers(a);
    return status;
}

int view_app_begin(view_app *a)
{
    a->window.show_panels = 1;
    return open_screen(a);
}

void view_app_blank(view_app *a, float scale)
{
    a->window.scale = scale;
    a->window.width = (float)a->screen.width / scale;
    a->window.height = (float)a->screen.height / scale;
    view_screen_begin(&a->screen);
}

int view_app_open(view_app *a, const view_model_desc *desc)
{
    int x, y, status = 0;
    set_defaults(a, desc);
    a->screen.width = desc->width;
    a->screen.height = desc->height;
    a->window.width = (float)desc->width;
    a->window.height = (float)desc->height;
    a->window.scale = 1.0f;
    view_figure_pixels(a, &x, &y, &a->desc.width, &a->desc.height);
    if (!status) status = view_model_open(&a->gpu, &a->desc, &a->model);
    if (status) {
        return status;
    }
    a->desc.converted = NULL;
    a->desc.path = a->model->path;
    a->request.desc = a->desc;
    a->times.accumulate = a->times.draw = a->times.accumulate_timer.available ? 0.0 : -1.0;
    view_begin_model(a);
    return 0;
}

void view_app_close(view_app *a)
{
    view_load_cancel(&a->files.load);
    view_capture_close(&a->capture);
    view_export_stop(&a->film.job);
    view_compare_close(&a->compare);
    noh_gl_timer_delete(&a->times.accumulate_timer, &a->gpu.gl);
    noh_gl_timer_delete(&a->times.draw_timer, &a->gpu.gl);
    view_forget_frames(a);
    view_model_close(a->model);
    a->model = NULL;
    view_presets_free(&a->presets);
    view_undo_forget(&a->undo);
    overlay_close(&a->overlay);
    view_marks_close(&a->marks);
    view_screen_close(&a->screen);
    view_lights_close(&a->lights);
}

void view_app_lost(view_app *a)
{
    const noh_gl_api gl = a->gpu.gl;
    memset(&a->screen, 0, sizeof a->screen);
    memset(&a->overlay, 0, sizeof a->overlay);
    a->marks.g = NULL;
    memset(&a->times.accumulate_timer, 0, sizeof a->times.accumulate_timer);
    memset(&a->times.draw_timer, 0, sizeof a->times.draw_timer);
    a->compare.has_canvas = 0;
    a->gpu.gl = *noh_gl_lost_api();
    view_compare_close(&a->compare); /* it is opened again by the next frame */
    a->gpu.gl = gl;
    view_export_stop(&a->film.job);
    view_model_lost(a->model, &a->gpu);
}

int view_app_restore(view_app *a)
{
    const int status = open_screen(a);
    return status ? status : view_model_restore(a->model, &a->gpu);
}

/* ---- playing ---- */

void view_play(view_app *a, uint32_t clip, int beside)
{
    const int status = view_start(a->model, clip, &a->how, beside);
    view_keep(a, status);
    a->playing = a->playing || !status;
}

void view_graph_start(view_app *a, uint32_t n)
{
    const int status = view_graph_play(a->model, n, a->how.fade_s);
    view_keep(a, status);
    a->playing = a->playing || !status;
}

void view_pad_choose(view_app *a, uint32_t clip)
{
    view_keep(a, view_pad_toggle(&a->pad, a->model, clip));
}

void view_pad_switch(view_app *a)
{
    if (a->pad.plays) {
        view_pad_stop(&a->pad, a->model);
    } else {
        view_keep(a, view_pad_play(&a->pad, a->model));
        a->playing |= a->pad.plays;
    }
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
    snprintf(log->lines[log->next], sizeof log->lines[0], "%9.3f s   %s: %s / %s   weight %.2f", event->clock_s,
             event->layer, event->clip, event->key, (double)event->weight);
    log->next = (log->next + 1) % VIEW_LINES;
    log->total++;
}

/* ---- walking ---- */

void view_walk(view_app *a, int root_motion)
{
    a->request.desc.root_motion = root_motion;
    a->ground.shown |= root_motion;
    a->request.reload = 1;
}

void view_walk_home(view_app *a)
{
    view_model_send_home(a->model);
    memset(&a->ground.walked, 0, sizeof a->ground.walked);
}

/* A point of the path for each hundredth of the figure's size. */
static void note_place(view_app *a)
{
    const noh_place place = view_model_place(a->model);
    view_path *p = &a->ground.walked;
    const float *last = p->points[(p->next + VIEW_PATH - 1u) % VIEW_PATH];
    const float x = place.position[0], z = place.position[2];
    if (a->model->root_motion &&
        (!p->count || hypot((double)(x - last[0]), (double)(z - last[1])) > 0.01 * a->camera.orbit.radius)) {
        p->points[p->next][0] = x;
        p->points[p->next][1] = z;
        p->next = (p->next + 1u) % VIEW_PATH;
        p->count += p->count < VIEW_PATH;
    }
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

static void step(view_app *a, uint32_t ticks)
{
    view_compare_step(&a->compare, a->model, ticks);
    view_step(a->model, ticks, log_event, &a->log);
}

/* While clips are paused the stage's time stands still, and with it fades of LOD levels: they are cut then. A pose is
 * made when time has passed, so what was changed by hand takes a tick. */
static int animate(view_app *a, double seconds)
{
    const uint64_t start = noh_clock_ns();
    const int stands = !a->playing && view_plays(a->model);
    noh_gl_camera camera;
    int status;
    if (!stands) {
        const double passed = seconds * (double)(a->playing ? a->speed : 1.0f);
        const uint32_t ticks = noh_frame_clock_advance(&a->model->clock, passed);
        status = view_fall_step(&a->fall, a->model, &a->pad, ticks);
        if (status) view_keep(a, status);
        step(a, ticks);
    } else if (a->model->touched) {
        step(a, 1);
    }
    view_pad_frame(&a->pad, a->model);
    view_model_hold(a->model);
    view_lod_begin(&a->lod, a->model);
    view_follow(a, seconds);
    note_place(a);
    orbit_camera(&a->camera.orbit, &camera);
    view_look_at_pointer(a, &camera);
    status = view_model_pose(a->model, &camera, a->cut || stands);
    a->cut = 0;
    smooth(&a->times.animate, (double)(noh_clock_ns() - start) * 1e-6);
    return status;
}

static int fit_canvas(view_app *a, int *x, int *y)
{
    uint32_t width, height;
    int status;
    view_figure_pixels(a, x, y, &width, &height);
    a->camera.orbit.aspect = (double)width / (double)height;
    a->desc.width = a->request.desc.width = width;
    a->desc.height = a->request.desc.height = height;
    status = view_model_fit(a->model, &a->gpu, width, height);
    if (!status && view_compare_fit(&a->compare, a->model, &a->gpu, &a->desc)) view_tell(a);
    return status;
}

int view_data_mesh(const view_model *m, noh_mesh *mesh)
{
    for (uint32_t i = 0; noh_pack_mesh_at(&m->file.pack, i, mesh, NULL) == NOH_OK; i++) {
        if (mesh->header->touched_count) return 1;
    }
    return 0;
}

int view_show_data(view_app *a, const char *name)
{
    noh_mesh mesh;
    const int has_mesh = view_data_mesh(a->model, &mesh);
    a->textures.shown = strcmp(name, "base") == 0 ? VIEW_DATA_BASE : VIEW_DATA_DELTA;
    if (strcmp(name, "sums") == 0) a->textures.shown = VIEW_DATA_SUMS;
    if (a->textures.shown != VIEW_DATA_DELTA) return 0;
    a->textures.target = has_mesh ? noh_mesh_find_target(&mesh, name) : NOH_NONE;
    return a->textures.target == NOH_NONE ? figure_check_target(&a->model->file, name) : 0;
}

/* The mesh's own textures, or a target's, from the pack. */
static void draw_data(view_app *a)
{
    noh_mesh mesh;
    data_page page;
    if (!view_data_mesh(a->model, &mesh) || data_page_open(&page, &mesh)) return;
    if (a->textures.shown == VIEW_DATA_BASE) {
        data_page_base(&page, &mesh);
        view_screen_data(&a->screen, &page);
    } else if (a->textures.target < mesh.header->target_count) {
        data_page_delta(&page, &mesh, a->textures.target, a->layer_gain);
        view_screen_data(&a->screen, &page);
    }
    data_page_close(&page);
}

/* Deltas of positions are in model units: at gain 1 the largest is white or black. */
static void draw_layers(view_app *a)
{
    const view_model *m = a->model;
    const float gain = a->layer_gain;
    const float gains[3] = { 0.5f * gain / m->delta_max, gain, gain };
    noh_stage_drawn drawn;
    if (!m->is_morphed || !a->window.show_panels || !a->window.show_layers) return;
    if (a->textures.shown != VIEW_DATA_SUMS) {
        draw_data(a);
        return;
    }
    for (uint32_t i = 0;; i++) {
        if (noh_actor_on_gl(m->figure->stage, m->figure->actors[0], i, &drawn, NULL)) return;
        if (drawn.is_morphed) {
            view_screen_layers(&a->screen, &m->morph_plan, &drawn.morph, gains);
            return;
        }
    }
}

static void draw_marks(view_app *a)
{
    const uint32_t height = a->model->canvas.height;
    float path[VIEW_PATH][2], point[3];
    const view_path *p = &a->ground.walked;
    if (a->ground.shown) view_marks_floor(&a->marks, &a->camera.orbit, a->ground.height, height);
    for (uint32_t i = 0; i < p->count; i++) {
        memcpy(path[i], p->points[(p->next + VIEW_PATH - p->count + i) % VIEW_PATH], sizeof path[i]);
    }
    if (a->ground.shown && p->count)
        view_marks_path(&a->marks, &a->camera.orbit, a->ground.height, &path[0][0], p->count, height);
    if (a->pick.is_on) {
        view_pick_point(&a->pick, a->model, point);
        view_marks_point(&a->marks, &a->camera.orbit, point, height);
    }
}

/* Accumulation on the GPU. */
static int accumulate(view_app *a)
{
    const noh_gl_api *gl = &a->gpu.gl;
    view_times *t = &a->times;
    noh_error error = { NOH_OK, "", 0, 0 };
    int status;
    noh_gl_timer_begin(&t->accumulate_timer, gl);
    status = noh_stage_frame_end(a->model->figure->stage, &error) ? tool_fail_error(a->model->path, &error) : 0;
    noh_gl_timer_end(&t->accumulate_timer, gl);
    poll_timer(&t->accumulate_timer, gl, &t->accumulate);
    if (!status) view_lod_end(&a->lod, a->model);
    a->is_drawn = 0;
    return status;
}

int view_app_picture(view_app *a)
{
    const noh_gl_api *gl = &a->gpu.gl;
    view_times *t = &a->times;
    noh_gl_camera camera;
    int status;
    if (a->is_drawn) return 0;
    a->is_drawn = 1;
    orbit_camera(&a->camera.orbit, &camera);
    figure_set_floor(a->model->figure, 1, (float)a->ground.height);
    noh_gl_timer_begin(&t->draw_timer, gl);
    status = view_model_draw(a->model, &a->model->canvas, &a->overlay, &a->over, &camera);
    noh_gl_timer_end(&t->draw_timer, gl);
    if (!status && a->compare.is.with == VIEW_COMPARE_OFF) draw_marks(a);
    if (!status) status = view_compare_pose(&a->compare, a->model, &a->lod, &camera);
    if (!status) status = view_compare_draw(&a->compare, a->model, &a->overlay, &a->over, &camera);
    poll_timer(&t->draw_timer, gl, &t->draw);
    return status;
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

void view_app_present(view_app *a)
{
    canvas *first = &a->model->canvas;
    const int side = (int)first->width;
    uint32_t width, height;
    int x, y;
    draw_layers(a);
    view_figure_pixels(a, &x, &y, &width, &height);
    view_screen_begin(&a->screen);
    view_screen_picture(&a->screen, first, x, y);
    if (a->compare.is.with == VIEW_COMPARE_OFF) return;
    view_screen_picture(&a->screen, &a->compare.canvas, x + side, y);
    view_screen_difference(&a->screen, first, &a->compare.canvas, a->compare.gain, x + 2 * side, y);
}

int view_app_frame(view_app *a, float scale, double seconds)
{
    double radians = 0.0;
    int x, y, status;
    if (view_export_step(&a->film.job, &seconds, &radians)) a->camera.orbit.azimuth += radians;
    a->window.scale = scale;
    a->window.width = (float)a->screen.width / scale;
    a->window.height = (float)a->screen.height / scale;
    time_frame(&a->times);
    status = fit_canvas(a, &x, &y);
    if (view_capture_poll(&a->capture, a->model)) view_tell(a);
    if (!status) status = animate(a, seconds);
    if (!status) status = accumulate(a);
    if (!status && (!a->lazy || a->film.job.is_on)) status = view_app_picture(a);
    if (status) {
        return status;
    }
    if (view_export_frame(&a->film.job, &a->model->canvas)) view_tell(a);
    if (!a->lazy) view_app_present(a);
    if (!a->window.hand_busy) view_undo_note(a);
    return 0;
}

int view_app_moves(const view_app *a)
{
    return a->capture.is_open || a->lod.fading || a->film.job.is_on || a->camera.turntable ||
           a->files.load.state == VIEW_LOAD_RUNS || a->model->figure->faces_found ||
           (a->playing && view_plays(a->model)) || view_fall_lasts(&a->fall, a->model);
}

void view_app_after(view_app *a)
{
    int status;
    if (!a->request.reload) {
        return;
    }
    a->request.reload = 0;
    view_export_stop(&a->film.job);
    view_compare_close(&a->compare);
    a->request.desc.part = a->part;
    status = view_model_reload(a->model, &a->gpu, &a->request.desc);
    view_keep(a, status);
    if (status) {
        a->request.desc = a->desc;
        return;
    }
    a->desc = a->request.desc;
    a->cut = 1;
    memset(&a->fall, 0, sizeof a->fall);
    if (!a->desc.root_motion) view_walk_home(a);
}

int view_save(view_app *a, const char *path, int with_panels)
{
    canvas *c = &a->model->canvas;
    const uint32_t width = with_panels ? a->screen.width : c->width,
                   height = with_panels ? a->screen.height : c->height;
    uint8_t *rgba = malloc((size_t)width * height * 4);
    int status = rgba ? view_app_picture(a) : tool_fail(path, "out of memory");
    if (!status) status = with_panels ? view_screen_read(&a->screen, rgba) : canvas_read(c, rgba);
    if (!status) status = tool_write_png(path, width, height, rgba);
    free(rgba);
    view_keep(a, status);
    return status;
}
