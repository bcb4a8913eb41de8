#include "view/view_compare.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

uint32_t view_compare_columns(const view_compare *c)
{
    return c->is.with == VIEW_COMPARE_OFF ? 1u : 3u;
}

void view_compare_close(view_compare *c)
{
    if (c->has_canvas) canvas_close(&c->canvas);
    if (c->is.with != VIEW_COMPARE_OFF) setting_close(&c->setting);
    c->has_canvas = 0;
    c->is = (view_compare_how){ VIEW_COMPARE_OFF, 0, NOH_MORPH_AUTO };
    c->beside = NULL;
}

static int open_second(view_compare *c, const view_model *m, gpu *g, const view_model_desc *desc)
{
    view_model_desc second = *desc;
    int status;
    second.alive = 0;
    if (c->how.with == VIEW_COMPARE_PATH) second.morph_path = c->how.path;
    status = setting_open(m, g, &second, &c->setting);
    if (status) return status;
    c->is = c->how;
    c->beside = m->figure;
    setting_carry(m->figure, c->setting.figure);
    return 0;
}

int view_compare_fit(view_compare *c, const view_model *m, gpu *g, const view_model_desc *desc)
{
    const int same = memcmp(&c->how, &c->is, sizeof c->how) == 0;
    int status = 0;
    if (c->is.with != VIEW_COMPARE_OFF && (!same || c->beside != m->figure)) view_compare_close(c);
    if (c->how.with == VIEW_COMPARE_OFF) return 0;
    if (m->show_bones) {
        c->how.with = VIEW_COMPARE_OFF;
        return tool_fail(m->path, "bones have neither levels nor paths to compare");
    }
    if (c->is.with == VIEW_COMPARE_OFF) status = open_second(c, m, g, desc);
    if (!status && (!c->has_canvas || c->canvas.width != m->canvas.width || c->canvas.height != m->canvas.height)) {
        if (c->has_canvas) canvas_close(&c->canvas);
        status = canvas_open(&c->canvas, g, m->canvas.width, m->canvas.height);
        c->has_canvas = !status;
    }
    if (status) {
        view_compare_close(c);
        c->how.with = VIEW_COMPARE_OFF;
    }
    return status;
}

/* ---- a frame ---- */

void view_compare_step(view_compare *c, const view_model *m, uint32_t ticks)
{
    if (c->is.with == VIEW_COMPARE_OFF) return;
    setting_carry_tracks(m->figure, c->setting.figure);
    (void)noh_stage_step(c->setting.figure->stage, ticks, NULL, NULL, NULL);
}

static void hold(const view_compare *c, const view_model *m)
{
    const figure *f = c->setting.figure;
    for (uint32_t i = 0; i < m->target_count; i++) {
        const view_target *t = &m->targets[i];
        for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
            if (t->floats[k] == NOH_NONE) continue;
            (void)noh_actor_hold_float(f->stage, f->actors[k], t->floats[k], t->value, t->held ? 1.0f : 0.0f, NULL);
        }
    }
}

int view_compare_pose(view_compare *c, const view_model *m, const view_lod *shown, const noh_gl_camera *camera)
{
    figure *f = c->setting.figure;
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_stage_view views[2];
    view_lod second = *shown;
    uint32_t view_count, jobs;
    if (c->is.with == VIEW_COMPARE_OFF) return 0;
    if (c->is.with == VIEW_COMPARE_LEVEL) view_lod_level(&second, c->is.level);
    hold(c, m);
    view_lod_look(&second, f);
    figure_set_floor(f, m->figure->shows_floor, m->figure->floor);
    view_count = figure_views(f, camera, c->canvas.height, views);
    views[0].cut = 1;
    if (noh_stage_frame_begin(f->stage, views, view_count, &error)) return tool_fail_error(m->path, &error);
    while ((jobs = noh_stage_jobs(f->stage)) > 0) {
        for (uint32_t i = 0; i < jobs; i++) noh_stage_job(f->stage, i);
    }
    return noh_stage_frame_end(f->stage, &error) ? tool_fail_error(m->path, &error) : 0;
}

/* How many pixels of both pictures differ, and how much. */
static int count_differing(view_compare *c, canvas *first)
{
    const size_t pixels = (size_t)first->width * first->height;
    uint8_t *a = malloc(pixels * 4u), *b = malloc(pixels * 4u);
    int status = a && b ? 0 : tool_fail("view", "out of memory");
    if (!status) status = canvas_read(first, a);
    if (!status) status = canvas_read(&c->canvas, b);
    c->differing = c->most = 0;
    for (size_t i = 0; i < pixels && !status; i++) {
        uint32_t most = 0;
        for (size_t k = 0; k < 3; k++) {
            const uint32_t d = (uint32_t)abs((int)a[4 * i + k] - (int)b[4 * i + k]);
            most = d > most ? d : most;
        }
        c->differing += most > 1u;
        c->most = most > c->most ? most : c->most;
    }
    free(a);
    free(b);
    return status;
}

int view_compare_draw(view_compare *c, view_model *m, overlay *o, const view_over *over, const noh_gl_camera *camera)
{
    view_model second = *m; /* it draws by the setting */
    int status;
    if (c->is.with == VIEW_COMPARE_OFF) return 0;
    second.figure = c->setting.figure;
    memcpy(second.bones, c->setting.bones, sizeof second.bones);
    status = view_model_draw(&second, &c->canvas, o, over, camera);
    return status ? status : count_differing(c, &m->canvas);
}
