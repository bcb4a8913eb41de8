/* view_hand.c: the pointer's effects on the figure: faces look at it, clicks pick, clicks with Alt push. */
#include <math.h>
#include <stdio.h>

#include "cli/message.h"
#include "noh/low_gl.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "view/view_app.h"

/* ---- picking ---- */

void view_point_window(view_app *a, float x, float y, int inside)
{
    float box[4];
    view_app_stage(a, box);
    a->window.has_pointer = inside;
    a->window.pointer[0] = (x - box[0]) * a->window.scale;
    a->window.pointer[1] = (y - box[1]) * a->window.scale;
}

/* Faces look at the pointer as if it hung in the air, two fifths of the way from the camera to them. */
void view_look_at_pointer(const view_app *a, const noh_gl_camera *camera)
{
    const figure *f = a->model->figure;
    const noh_stage_view view = figure_view(camera, a->model->canvas.height);
    float origin[3], way[3], length;
    const int found = a->window.has_pointer &&
                      noh_view_ray(&view, a->window.pointer[0], a->window.pointer[1], a->model->canvas.width,
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
    view_pick_at(&a->pick, a->model, &a->camera.orbit, (x - box[0]) * a->window.scale, (y - box[1]) * a->window.scale);
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
    orbit_camera(&a->camera.orbit, &camera);
    status = view_fall_push(a->model, pick, camera.eye);
    view_keep(a, status);
    a->playing |= !status; /* while clips are paused time stands still */
}

void view_push_window(view_app *a, float x, float y)
{
    view_pick pick;
    float box[4];
    view_app_stage(a, box);
    view_pick_at(&pick, a->model, &a->camera.orbit, (x - box[0]) * a->window.scale, (y - box[1]) * a->window.scale);
    if (pick.is_on) push(a, &pick);
}

void view_push(view_app *a)
{
    push(a, NULL);
}
