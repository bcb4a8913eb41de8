#include "place_draw.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "gpu/canvas.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

#define SHOWN_FRAMES 24u /* before the picture, so that feet and levels have settled */
#define RADIAN 0.017453292519943295

static int camera_of(const place_scene *s, noh_stage_view *view)
{
    const place_area *a = &s->place->area;
    const float wide = hypotf(a->high[0] - a->low[0], a->high[1] - a->low[1]);
    double azimuth = 0.0, elevation = 25.0, distance = 1.2 * (double)wide, x = 0.5 * (double)(a->low[0] + a->high[0]),
           z = 0.5 * (double)(a->low[1] + a->high[1]);
    char end;
    if (s->options->camera) {
        const int count = sscanf(s->options->camera, "%lf,%lf,%lf,%lf,%lf%c", &azimuth, &elevation, &distance, &x, &z,
                                 &end);
        if (count != 3 && count != 5) {
            return tool_usage("--camera of a place must be AZ,EL,DIST or AZ,EL,DIST,X,Z, not '%s'", s->options->camera);
        }
    }
    if (!(fabs(x) <= 1e5) || !(fabs(z) <= 1e5) || !(fabs(azimuth) <= 3600.0) ||
        !(elevation >= -89.0 && elevation <= 89.0) || !(distance > 0.0 && distance < 1e5)) {
        return tool_usage("--camera needs EL from -89 to 89, DIST above 0, and a point near the place");
    }
    const float at[2] = { (float)x, (float)z }, target[3] = { at[0], 1.0f + place_scene_height(s->place, at), at[1] };
    noh_view_orbit(view, target, (float)(azimuth * RADIAN), (float)(elevation * RADIAN), (float)distance,
                   s->options->width, s->options->height);
    return 0;
}

/* All steps up to the time; frames before the last one are not drawn. */
static int run(place_scene *s, const noh_stage_view *view, double time_s)
{
    const uint32_t steps = (uint32_t)(time_s * 30.0 + 0.5);
    int status = 0;
    while (s->step < steps || s->step < 2u) {
        const uint32_t i = s->step;
        place_scene_step(s);
        if (i + SHOWN_FRAMES >= steps && !status) status = place_scene_show(s, view);
    }
    return status;
}

static int paint(place_scene *s, gpu *g, const noh_stage_view *view, uint8_t *rgba)
{
    canvas target;
    int status = place_scene_shadow(s, view);
    if (status) return status;
    status = canvas_open(&target, g, s->options->width, s->options->height);
    if (status) return status;
    canvas_begin(&target);
    g->gl.Enable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    status = place_scene_draw(s, view);
    g->gl.Disable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    if (!status) status = canvas_read(&target, rgba);
    canvas_close(&target);
    return status;
}

/* Each picture into its columns. */
static int paint_all(place_scene *s, gpu *g, const noh_stage_view *view, uint8_t *rgba)
{
    const place_draw_options *o = s->options;
    const size_t row = (size_t)o->width * 4u;
    uint8_t *one = malloc(row * o->height);
    int status = one ? 0 : tool_fail(s->file->path, "out of memory");
    for (uint32_t i = 0; i < o->count && !status; i++) {
        status = run(s, view, o->time_s + i * o->apart_s);
        if (!status) status = paint(s, g, view, one);
        for (uint32_t y = 0; y < o->height && !status; y++) {
            memcpy(rgba + (y * (size_t)o->count + i) * row, one + y * row, row);
        }
    }
    free(one);
    return status;
}

static void take_drawn(const place_scene *s, place_drawn *d)
{
    uint64_t cpu, on_gpu;
    drawn_hair_bytes(&s->hair, &cpu, &on_gpu);
    memset(d, 0, sizeof *d);
    d->stats = *noh_stage_stats_of(s->stage);
    d->agents = place_life_agents(s->life);
    d->level_count = s->plan.kinds[PLACE_PEOPLE].level_count;
    d->near_count = s->near_count;
    d->fell = s->fell;
    d->down = s->down;
    d->cpu_bytes = s->plan.cpu_bytes + cpu;
    d->gpu_bytes = s->plan.gpu_bytes + on_gpu;
    d->walkers_bytes = s->walkers_bytes;
    d->crowd_bytes = place_life_bytes(s->life);
    if (!s->terrain.drawable.gl) return;
    d->terrain_bytes = noh_stage_terrain_size(s->place->ground);
    d->terrain_gpu_bytes = noh_stage_terrain_bytes(s->place->ground);
    d->terrain_blocks = s->terrain.draws;
    d->terrain_triangles = s->terrain.triangles;
}

int place_draw(gpu *g, const pack_file *file, const place_file *place, const place_draw_options *o, uint8_t *rgba,
               place_drawn *drawn)
{
    static place_scene s;
    noh_stage_view view;
    int status = place_scene_open(&s, g, file, place, o);
    if (!status) status = camera_of(&s, &view);
    if (!status) {
        memcpy(view.light, s.light.told.key_direction, sizeof view.light);
        status = paint_all(&s, g, &view, rgba);
    }
    if (!status) take_drawn(&s, drawn);
    place_scene_close(&s);
    return status;
}
