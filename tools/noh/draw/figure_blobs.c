/* figure_blobs.c: the soft spots under a figure (--shadow blob), and its shadow on a floor. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/message.h"
#include "figure.h"
#include "figure_body.h"

#define LEVEL 0.05 /* of its height: a floor so near to y = 0 is there */

/* The ground of a figure that stands on none: y = 0, where its lowest point is near that, else that point. */
static int find_floor(figure *f)
{
    const int status = figure_pose(f);
    bounds box;
    if (status) return status;
    box = figure_bounds(f, FRAME_FULL);
    f->floor = fabs(box.low[1]) < LEVEL * (box.high[1] - box.low[1]) ? 0.0f : (float)box.low[1];
    return 0;
}

int figure_open_blobs(figure *f)
{
    char log[4096] = "";
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_gl_device device;
    if (!f->g || !f->desc.light || !f->desc.light->has_blobs) return 0;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        (void)noh_blob_rig_make(&f->kinds[k], &f->blob_rigs[k], NULL); /* draws nothing: no spots */
    }
    device = (noh_gl_device){ &f->g->gl, &f->g->caps, &f->g->ledger, log, sizeof log };
    if (noh_stage_blob_create(&device, &f->blob, &error)) {
        fputs(log, stderr);
        return tool_fail_error("spots under feet", &error);
    }
    return find_floor(f);
}

void figure_draw_blobs(figure *f)
{
    const noh_plane floor_plane = { { 0.0f, 1.0f, 0.0f }, f->floor };
    const noh_world floor_world = { .planes = &floor_plane, .plane_count = 1 };
    const figure_body *body = f->desc.body;
    const noh_ground ground = { body && body->has_ground ? &body->world : &floor_world, NULL, NULL };
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        noh_blob blobs[NOH_BLOBS_MAX];
        const uint32_t count = noh_actor_blobs(f->stage, f->actors[k], &f->blob_rigs[k], &ground, blobs);
        noh_stage_blob_draw(&f->blob, &f->seen, blobs, count);
    }
}

/* ---- a shadow on a floor ---- */

#define REACHES 3.0f /* radii of what casts it */

int figure_open_floor(figure *f)
{
    char log[4096] = "";
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_gl_device device;
    if (!f->g || !f->desc.on_floor || !f->desc.light || !f->desc.light->has_shadow) return 0;
    device = (noh_gl_device){ &f->g->gl, &f->g->caps, &f->g->ledger, log, sizeof log };
    if (noh_stage_floor_create(&device, 0, &f->level, &error)) {
        fputs(log, stderr);
        return tool_fail_error("a shadow on a floor", &error);
    }
    return 0;
}

void figure_set_floor(figure *f, int on, float height)
{
    f->shows_floor = on && f->level.drawable.gl && f->desc.view == NOH_VIEW_LIT;
    if (f->shows_floor) f->floor = height;
}

void figure_draw_floor(const figure *f)
{
    const lighting *l = f->desc.light;
    const float disc[4] = { l->sphere[0], f->floor, l->sphere[2], REACHES * l->sphere[3] };
    noh_stage_floor_draw(&f->level, noh_stage_light_of(f->stage), &l->told, &f->seen, disc);
}
