/* view_camera.c: the camera: by hand, and with the figure. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "view/view_app.h"

/* ---- the picture in the window ---- */

void view_app_stage(const view_app *a, float box[4])
{
    box[0] = a->window.show_panels ? VIEW_LEFT : 0.0f;
    box[1] = 0.0f;
    box[2] = fmaxf(a->window.width - (a->window.show_panels ? VIEW_RIGHT : 0.0f), box[0] + 1.0f);
    box[3] = fmaxf(a->window.height - (a->window.show_panels ? VIEW_BOTTOM : 0.0f), 1.0f);
}

void view_figure_pixels(const view_app *a, int *x, int *y, uint32_t *width, uint32_t *height)
{
    const float columns = a->compare.how.with == VIEW_COMPARE_OFF ? 1.0f : 3.0f;
    float box[4];
    view_app_stage(a, box);
    *x = (int)(box[0] * a->window.scale);
    *y = (int)((a->window.height - box[3]) * a->window.scale);
    *width = (uint32_t)fmaxf((box[2] - box[0]) / columns * a->window.scale, 1.0f);
    *height = (uint32_t)fmaxf((box[3] - box[1]) * a->window.scale, 1.0f);
}

/* ---- framing ---- */

void view_forget_frames(view_app *a)
{
    framing_close(a->camera.framing);
    free(a->camera.framed);
    free(a->camera.boxes);
    free(a->camera.boxed);
    a->camera.framing = NULL;
    a->camera.framed = a->camera.boxed = NULL;
    a->camera.boxes = NULL;
}

static int open_frames(view_app *a)
{
    const size_t count = a->model->clip_count + 1u;
    if (a->camera.framing || a->camera.boxed) return a->camera.framing != NULL;
    a->camera.framed = calloc(count, 1);
    a->camera.boxes = calloc(count, sizeof *a->camera.boxes);
    a->camera.boxed = calloc(count, 1);
    if (a->camera.framed && a->camera.boxes && a->camera.boxed)
        a->camera.framing = framing_open(&a->model->figure->desc);
    return a->camera.framing != NULL;
}

/* Mark the clips that play; 1 where a clip plays that was not framed. */
static int mark_playing(view_app *a, uint8_t *playing)
{
    const view_model *m = a->model;
    int more = 0;
    for (uint32_t k = 0; k < m->figure->stage_desc.kind_count; k++) {
        const noh_controller *c = view_controller(m, k, NULL);
        for (uint32_t t = 0; t < c->track_count; t++) {
            const noh_track *track = noh_controller_track(c, t);
            for (uint32_t i = 0; i < m->clip_count && track->mode == NOH_TRACK_ON; i++) {
                if (m->clips[i].clips[k] == track->clip && view_layer_of(t) == VIEW_BODY) playing[i] = 1;
            }
        }
    }
    for (uint32_t i = 0; i < m->clip_count; i++) more |= playing[i] && !a->camera.framed[i] && a->camera.boxed[i] != 2;
    return more;
}

/* The box of what plays, at where the figure is now. Returns 0 where nothing moves it. */
static int box_of_playing(view_app *a, const uint8_t *playing, bounds *box)
{
    double anchor[3];
    int any = 0;
    view_model_anchor(a->model, anchor);
    for (uint32_t i = 0; i < a->model->clip_count; i++) {
        if (!playing[i]) continue;
        if (!a->camera.boxed[i])
            a->camera.boxed[i] = framing_clip(a->camera.framing, a->model->clips[i].name, &a->camera.boxes[i]) ? 1 : 2;
        if (a->camera.boxed[i] != 1) continue;
        *box = any ? bounds_union(*box, a->camera.boxes[i]) : a->camera.boxes[i];
        any = 1;
    }
    for (int c = 0; c < 3 && any; c++) {
        box->low[c] += anchor[c];
        box->high[c] += anchor[c];
    }
    return any;
}

/* Look at the clips that play, from where it looks. Returns 0 where none moves the figure. */
static int frame_playing(view_app *a, int only_new)
{
    uint8_t *playing;
    bounds box;
    int found = 0;
    if (a->model->show_bones || !a->model->clip_count || !open_frames(a)) return 0;
    playing = calloc(a->model->clip_count, 1);
    if (playing && (mark_playing(a, playing) || !only_new)) {
        found = box_of_playing(a, playing, &box);
        if (found) {
            orbit_frame(&a->camera.orbit, &box, ORBIT_MARGIN);
            memcpy(a->camera.framed, playing, a->model->clip_count);
            a->camera.framed_aspect = a->camera.orbit.aspect;
        }
    }
    free(playing);
    return found;
}

void view_frame_all(view_app *a)
{
    const bounds around = view_model_bounds(a->model);
    int x, y;
    uint32_t width, height;
    view_figure_pixels(a, &x, &y, &width, &height);
    a->camera.facing = a->model->figure->facing;
    view_turn_light(a, 0.0);
    a->camera.orbit = orbit_fit(&around, (double)width / (double)height, a->camera.facing);
    a->camera.framed_box = around;
    a->ground.height = fabs(around.low[1]) < 0.05 * a->camera.orbit.radius ? 0.0 : around.low[1];
    a->camera.by_hand = 0;
    view_model_anchor(a->model, a->camera.anchor);
    a->camera.framed_aspect = a->camera.orbit.aspect;
    (void)frame_playing(a, 0);
}

/* The picture has become wider or narrower: all that was in it is in it again, seen from where it was. */
static void frame_again(view_app *a)
{
    a->camera.framed_aspect = a->camera.orbit.aspect;
    if (!frame_playing(a, 0))
        a->camera.orbit.distance = orbit_fit(&a->camera.framed_box, a->camera.orbit.aspect, a->camera.facing).distance;
}

/* The camera follows a clip that walks, and returns when it restarts; it does not follow a fall. */
void view_follow(view_app *a, double seconds)
{
    const int falls = view_fall_lasts(&a->fall, a->model), goes = a->camera.follow && !falls;
    double anchor[3];
    view_model_anchor(a->model, anchor);
    for (int c = 0; c < 3; c++) {
        a->camera.orbit.center[c] += goes ? anchor[c] - a->camera.anchor[c] : 0.0;
        a->camera.anchor[c] = anchor[c];
    }
    if (goes && !a->camera.by_hand && a->camera.orbit.aspect != a->camera.framed_aspect) frame_again(a);
    if (goes && !a->camera.by_hand) (void)frame_playing(a, 1);
    if (a->camera.turntable && !a->film.job.is_on) {
        a->camera.orbit.azimuth = remainder(a->camera.orbit.azimuth + seconds * 6.283185307179586 / VIEW_TURNTABLE_S,
                                            6.283185307179586);
    }
}

/* ---- by hand ---- */

void view_turn(view_app *a, double dx, double dy)
{
    a->camera.orbit.azimuth -= dx * 0.01;
    a->camera.orbit.elevation = fmin(fmax(a->camera.orbit.elevation + dy * 0.01, -1.5), 1.5);
}

void view_pan(view_app *a, double dx, double dy)
{
    double right[3], up[3], back[3], per_point;
    float box[4];
    view_app_stage(a, box);
    per_point = 0.536 * a->camera.orbit.distance / (double)(box[3] - box[1]); /* twice the tangent of 15 degrees */
    orbit_axes(&a->camera.orbit, right, up, back);
    for (int c = 0; c < 3; c++) {
        a->camera.orbit.center[c] += (up[c] * dy - right[c] * dx) * per_point;
    }
    a->camera.by_hand = 1;
}

void view_zoom(view_app *a, double steps)
{
    const double distance = a->camera.orbit.distance * exp(-0.12 * steps);
    a->camera.orbit.distance = fmin(fmax(distance, a->camera.orbit.radius * 0.05), a->camera.orbit.radius * 50.0);
    a->camera.by_hand = 1;
}

void view_turn_light(view_app *a, double degrees)
{
    lighting *light = a->desc.light;
    if (light) lighting_turn(light, remainder(light->degrees + degrees, 360.0), a->camera.facing);
}
