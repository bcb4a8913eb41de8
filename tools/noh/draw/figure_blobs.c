/* figure_blobs.c: what a figure stands on: its shadow on a floor and soft spots under its feet. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/message.h"
#include "figure.h"
#include "figure_body.h"

#define LEVEL 0.05   /* of its height: a floor so near to y = 0 is there */
#define CONTACT 0.6f /* darkness of the spots where a shadow falls, too */

/* The ground of a figure that stands on none: y = 0, where its lowest point is near that, else that point. */
static int find_floor(figure *f)
{
    const int status = figure_pose(f);
    bounds box;
    if (status) return status;
    box = figure_bounds(f, FRAME_FULL);
    f->height = box.high[1] - box.low[1];
    f->floor = fabs(box.low[1]) < LEVEL * (box.high[1] - box.low[1]) ? 0.0f : (float)box.low[1];
    return 0;
}

static int on_own_ground(const figure *f)
{
    return f->desc.body && f->desc.body->has_ground;
}

int figure_open_blobs(figure *f)
{
    char log[4096] = "";
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_gl_device device;
    if (!f->g || !f->desc.light || (!f->desc.light->has_blobs && !f->level.drawable.gl && !on_own_ground(f))) return 0;
    if (!f->desc.light->has_blobs && !f->desc.light->has_shadow) return 0;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        (void)noh_blob_rig_make(&f->kinds[k], &f->blob_rigs[k], NULL); /* draws nothing: no spots */
    }
    device = (noh_gl_device){ &f->g->gl, &f->g->caps, &f->g->ledger, log, sizeof log };
    if (noh_stage_blob_create(&device, &f->blob, &error)) {
        fputs(log, stderr);
        return tool_fail_error("spots under feet", &error);
    }
    return 0;
}

void figure_draw_blobs(figure *f)
{
    const noh_plane floor_plane = { { 0.0f, 1.0f, 0.0f }, f->floor };
    const noh_world floor_world = { .planes = &floor_plane, .plane_count = 1 };
    const noh_ground ground = { on_own_ground(f) ? &f->desc.body->world : &floor_world, NULL, NULL };
    if (!f->desc.light->has_blobs && !f->shows_floor && !on_own_ground(f)) return;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        noh_blob blobs[NOH_BLOBS_MAX];
        const uint32_t count = noh_actor_blobs(f->stage, f->actors[k], &f->blob_rigs[k], &ground, blobs);
        for (uint32_t i = 0; i < count && !f->desc.light->has_blobs; i++) blobs[i].darkness *= CONTACT;
        noh_stage_blob_draw(&f->blob, &f->seen, blobs, count);
    }
}

/* ---- a shadow on a floor ---- */

#define REACHES 3.0f /* radii of what casts it */

/* A body; a head hangs in the air, and so does a thing on a joint. */
static int stands(const figure *f)
{
    int joints = 0;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) joints |= f->plan.kinds[k].joint_count > 1;
    return joints && !figure_is_head(f);
}

int figure_open_floor(figure *f)
{
    char log[4096] = "";
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_gl_device device;
    int status = f->g && f->desc.light ? find_floor(f) : 0;
    if (status || !f->g || !f->desc.light || !f->desc.light->has_shadow || on_own_ground(f) || !stands(f))
        return status;
    device = (noh_gl_device){ &f->g->gl, &f->g->caps, &f->g->ledger, log, sizeof log };
    if (noh_stage_floor_create(&device, 0, &f->level, &error)) {
        fputs(log, stderr);
        return tool_fail_error("a shadow on a floor", &error);
    }
    figure_set_floor(f, 1, f->floor);
    return 0;
}

void figure_set_floor(figure *f, int on, float height)
{
    f->shows_floor = on && f->level.drawable.gl && f->desc.view == NOH_VIEW_LIT;
    if (f->shows_floor) f->floor = height;
}

void figure_fit_floor(figure *f, double lowest)
{
    if (f->shows_floor && fabs(lowest - (double)f->floor) < LEVEL * f->height) f->floor = (float)lowest;
}

void figure_draw_floor(const figure *f)
{
    const lighting *l = f->desc.light;
    const float disc[4] = { l->sphere[0], f->floor, l->sphere[2], REACHES * l->sphere[3] };
    noh_stage_floor_draw(&f->level, noh_stage_light_of(f->stage), &l->told, &f->seen, disc);
}
