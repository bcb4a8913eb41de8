#include "view/view_app.h"
#include "cli/message.h"
#include "file/png_file.h"
#include "stage/view.h"

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
    a->show_panels = a->show_layers = a->follow = a->cut = 1;
    a->show_floor = desc->root_motion;
    a->speed = a->how.speed = a->how.weight = 1.0f;
    a->how.fade_s = 0.2f;
    a->layer_gain = a->lod.wrinkles = 1.0f;
    a->lod.pixels = 1.0f;
    a->screen.width = desc->width;
    a->screen.height = desc->height;
    a->window_width = (float)desc->width;
    a->window_height = (float)desc->height;
    a->scale = 1.0f;
    figure_pixels(a, &x, &y, &a->desc.width, &a->desc.height);
    if (!status) status = view_marks_open(&a->marks, &a->gpu);
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
    view_marks_close(&a->marks);
    view_screen_close(&a->screen);
}

void view_app_lost(view_app *a)
{
    memset(&a->screen, 0, sizeof a->screen);
    a->marks.g = NULL;
    memset(&a->times.accumulate_timer, 0, sizeof a->times.accumulate_timer);
    memset(&a->times.draw_timer, 0, sizeof a->times.draw_timer);
    view_model_lost(a->model, &a->gpu);
}

int view_app_restore(view_app *a)
{
    int status = view_screen_open(&a->screen, &a->gpu);
    open_timers(a);
    if (!status) status = view_marks_open(&a->marks, &a->gpu);
    return status ? status : view_model_restore(a->model, &a->gpu);
}

int view_app_show(view_app *a, const char *path)
{
    view_model_desc desc = a->desc;
    view_model *shown;
    int status;
    desc.path = path;
    desc.anim = desc.part = NULL; /* another pack's clips belonged to the old model */
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
    memset(&a->pad, 0, sizeof a->pad);
    memset(&a->pick, 0, sizeof a->pick);
    memset(&a->fall, 0, sizeof a->fall);
    memset(&a->walked, 0, sizeof a->walked);
    a->part[0] = 0;
    a->cut = 1;
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
    a->floor = fabs(around.low[1]) < 0.05 * a->orbit.radius ? 0.0 : around.low[1];
    view_model_anchor(a->model, a->anchor);
}

/* A clip that walks takes the camera along, and back where it begins again; who falls does not. */
static void follow(view_app *a)
{
    const int goes = a->follow && !view_fall_lasts(&a->fall, a->model);
    double anchor[3];
    view_model_anchor(a->model, anchor);
    for (int c = 0; c < 3; c++) {
        a->orbit.center[c] += goes ? anchor[c] - a->anchor[c] : 0.0;
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

void view_turn_light(view_app *a, double degrees)
{
    lighting *light = a->desc.light;
    if (light) lighting_turn(light, remainder(light->degrees + degrees, 360.0));
}

/* ---- playing ---- */

void view_play(view_app *a, uint32_t clip, int beside)
{
    const int status = view_start(a->model, clip, &a->how, beside);
    keep_failure(a, status);
    a->playing = a->playing || !status;
}

void view_graph_start(view_app *a, uint32_t n)
{
    const int status = view_graph_play(a->model, n, a->how.fade_s);
    keep_failure(a, status);
    a->playing = a->playing || !status;
}

void view_pad_choose(view_app *a, uint32_t clip)
{
    keep_failure(a, view_pad_toggle(&a->pad, a->model, clip));
}

void view_pad_switch(view_app *a)
{
    if (a->pad.plays) {
        view_pad_stop(&a->pad, a->model);
    } else {
        keep_failure(a, view_pad_play(&a->pad, a->model));
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

/* ---- picking ---- */

void view_point_window(view_app *a, float x, float y, int inside)
{
    float box[4];
    view_app_stage(a, box);
    a->has_pointer = inside;
    a->pointer[0] = (x - box[0]) * a->scale;
    a->pointer[1] = (y - box[1]) * a->scale;
}

/* Faces look at the pointer as if it hung in the air, two fifths of the way from the camera to them. */
static void look_at_pointer(const view_app *a, const noh_gl_camera *camera)
{
    const figure *f = a->model->figure;
    const noh_stage_view view = figure_view(camera, a->model->canvas.height);
    float origin[3], way[3], length;
    const int found = a->has_pointer && noh_view_ray(&view, a->pointer[0], a->pointer[1], a->model->canvas.width,
                                                     a->model->canvas.height, origin, way);
    length = found ? sqrtf(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]) : 1.0f;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        float sphere[4], point[3], far;
        if (!(f->faces_found >> k & 1u)) continue;
        if (!found || noh_actor_sphere(f->stage, f->actors[k], sphere, NULL)) {
            (void)noh_actor_look_at(f->stage, f->actors[k], NULL, NULL);
            continue;
        }
        far = hypotf(hypotf(sphere[0] - camera->eye[0], sphere[1] - camera->eye[1]), sphere[2] - camera->eye[2]);
        for (int i = 0; i < 3; i++) point[i] = camera->eye[i] + way[i] / length * 0.4f * far;
        (void)noh_actor_look_at(f->stage, f->actors[k], point, NULL);
    }
}

void view_pick_window(view_app *a, float x, float y)
{
    char text[512];
    float box[4];
    view_app_stage(a, box);
    view_pick_at(&a->pick, a->model, &a->orbit, (x - box[0]) * a->scale, (y - box[1]) * a->scale);
    if (a->pick.is_on) {
        view_pick_text(&a->pick, a->model, text, sizeof text);
        printf("picked %s\n", text);
        fflush(stdout);
    }
}

/* ---- pushing ---- */

static void push(view_app *a, const view_pick *pick)
{
    noh_gl_camera camera;
    int status;
    orbit_camera(&a->orbit, &camera);
    status = view_fall_push(a->model, pick, camera.eye);
    keep_failure(a, status);
    a->playing |= !status; /* while clips are paused time stands still */
}

void view_push_window(view_app *a, float x, float y)
{
    view_pick pick;
    float box[4];
    view_app_stage(a, box);
    view_pick_at(&pick, a->model, &a->orbit, (x - box[0]) * a->scale, (y - box[1]) * a->scale);
    if (pick.is_on) push(a, &pick);
}

void view_push(view_app *a)
{
    push(a, NULL);
}

/* ---- walking ---- */

void view_walk(view_app *a, int root_motion)
{
    a->wish.root_motion = root_motion;
    a->show_floor |= root_motion;
    a->wants_reload = 1;
}

void view_walk_home(view_app *a)
{
    view_model_send_home(a->model);
    memset(&a->walked, 0, sizeof a->walked);
}

/* A point of the path for each hundredth of the figure's size. */
static void note_place(view_app *a)
{
    const noh_place place = view_model_place(a->model);
    view_path *p = &a->walked;
    const float *last = p->points[(p->next + VIEW_PATH - 1u) % VIEW_PATH];
    const float x = place.position[0], z = place.position[2];
    if (a->model->root_motion &&
        (!p->count || hypot((double)(x - last[0]), (double)(z - last[1])) > 0.01 * a->orbit.radius)) {
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
        if (status) keep_failure(a, status);
        view_step(a->model, ticks, log_event, &a->log);
    } else if (a->model->touched) {
        view_step(a->model, 1, log_event, &a->log);
    }
    view_pad_frame(&a->pad, a->model);
    view_model_hold(a->model);
    view_lod_begin(&a->lod, a->model);
    follow(a);
    note_place(a);
    orbit_camera(&a->orbit, &camera);
    look_at_pointer(a, &camera);
    status = view_model_pose(a->model, &camera, a->cut || stands);
    a->cut = 0;
    smooth(&a->times.animate, (double)(noh_clock_ns() - start) * 1e-6);
    return status;
}

static int fit_canvas(view_app *a, int *x, int *y)
{
    uint32_t width, height;
    figure_pixels(a, x, y, &width, &height);
    a->orbit.aspect = (double)width / (double)height;
    a->desc.width = a->wish.width = width;
    a->desc.height = a->wish.height = height;
    return view_model_fit(a->model, &a->gpu, width, height);
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
    a->data = strcmp(name, "base") == 0 ? VIEW_DATA_BASE : VIEW_DATA_DELTA;
    if (strcmp(name, "sums") == 0) a->data = VIEW_DATA_SUMS;
    if (a->data != VIEW_DATA_DELTA) return 0;
    a->data_target = has_mesh ? noh_mesh_find_target(&mesh, name) : NOH_NONE;
    return a->data_target == NOH_NONE ? figure_check_target(&a->model->file, name) : 0;
}

/* The mesh's own textures, or a target's, from the pack. */
static void draw_data(view_app *a)
{
    noh_mesh mesh;
    data_page page;
    if (!view_data_mesh(a->model, &mesh) || data_page_open(&page, &mesh)) return;
    if (a->data == VIEW_DATA_BASE) {
        data_page_base(&page, &mesh);
        view_screen_data(&a->screen, &page);
    } else if (a->data_target < mesh.header->target_count) {
        data_page_delta(&page, &mesh, a->data_target, a->layer_gain);
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
    if (!m->is_morphed || !a->show_panels || !a->show_layers) return;
    if (a->data != VIEW_DATA_SUMS) {
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
    const view_path *p = &a->walked;
    if (a->show_floor) view_marks_floor(&a->marks, &a->orbit, a->floor, height);
    for (uint32_t i = 0; i < p->count; i++) {
        memcpy(path[i], p->points[(p->next + VIEW_PATH - p->count + i) % VIEW_PATH], sizeof path[i]);
    }
    if (a->show_floor && p->count) view_marks_path(&a->marks, &a->orbit, a->floor, &path[0][0], p->count, height);
    if (a->pick.is_on) {
        view_pick_point(&a->pick, a->model, point);
        view_marks_point(&a->marks, &a->orbit, point, height);
    }
}

static int draw(view_app *a)
{
    const noh_gl_api *gl = &a->gpu.gl;
    view_times *t = &a->times;
    noh_gl_camera camera;
    noh_error error = { NOH_OK, "", 0, 0 };
    int status;
    orbit_camera(&a->orbit, &camera);
    noh_gl_timer_begin(&t->accumulate_timer, gl);
    status = noh_stage_frame_end(a->model->figure->stage, &error) ? tool_fail_error(a->model->path, &error) : 0;
    noh_gl_timer_end(&t->accumulate_timer, gl);
    if (status) {
        return status;
    }
    view_lod_end(&a->lod, a->model);
    noh_gl_timer_begin(&t->draw_timer, gl);
    status = view_model_draw(a->model, &camera);
    noh_gl_timer_end(&t->draw_timer, gl);
    draw_marks(a);
    poll_timer(&t->accumulate_timer, gl, &t->accumulate);
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

int view_app_frame(view_app *a, float scale, double seconds)
{
    int x, y, status;
    a->scale = scale;
    a->window_width = (float)a->screen.width / scale;
    a->window_height = (float)a->screen.height / scale;
    time_frame(&a->times);
    status = fit_canvas(a, &x, &y);
    if (!status) status = animate(a, seconds);
    if (!status) status = draw(a);
    if (status) {
        return status;
    }
    draw_layers(a);
    view_screen_picture(&a->screen, &a->model->canvas, x, y);
    return 0;
}

int view_app_moves(const view_app *a)
{
    return a->lod.fading || a->model->figure->faces_found || (a->playing && view_plays(a->model)) ||
           view_fall_lasts(&a->fall, a->model);
}

void view_app_after(view_app *a)
{
    int status;
    if (!a->wants_reload) {
        return;
    }
    a->wants_reload = 0;
    a->wish.part = a->part;
    status = view_model_reload(a->model, &a->gpu, &a->wish);
    keep_failure(a, status);
    if (status) {
        a->wish = a->desc;
        return;
    }
    a->desc = a->wish;
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
    int status = rgba ? 0 : tool_fail(path, "out of memory");
    if (!status) status = with_panels ? view_screen_read(&a->screen, rgba) : canvas_read(c, rgba);
    if (!status) status = tool_write_png(path, width, height, rgba);
    free(rgba);
    keep_failure(a, status);
    return status;
}
