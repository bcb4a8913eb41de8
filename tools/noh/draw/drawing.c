#include "drawing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

int stage_shows_bones(const scene *s, const pack_file *file, int asked_for)
{
    if (!asked_for && s->item_count) {
        return 0;
    }
    for (uint32_t i = 0; i < s->player_count; i++) {
        if (s->players[i].skeleton.joint_count) {
            return 1;
        }
    }
    tool_fail(file->path, asked_for ? "the pack has no skeleton to draw" : "the pack has nothing to draw");
    return -1;
}

bounds stage_bounds(const scene *s, const pack_file *file, int face, int show_bones)
{
    bounds box = { { INFINITY, INFINITY, INFINITY }, { -INFINITY, -INFINITY, -INFINITY } };
    if (!show_bones) {
        return scene_bounds(s, file, face);
    }
    for (uint32_t i = 0; i < s->player_count; i++) {
        if (s->players[i].skeleton.joint_count) {
            box = bounds_union(box, bones_bounds(s->players[i].skeleton.joint_count, s->players[i].joint_matrices));
        }
    }
    return box;
}

static int open_bones(stage *st, gpu *g)
{
    int status = 0;
    st->bones = calloc(st->scene->player_count, sizeof *st->bones);
    if (!st->bones) {
        return tool_fail("bones", "out of memory");
    }
    for (; st->bones_count < st->scene->player_count && !status; st->bones_count++) {
        const uint32_t joints = st->scene->players[st->bones_count].skeleton.joint_count;
        status = joints ? bones_open(&st->bones[st->bones_count], g, joints) : 0;
    }
    return status;
}

int stage_open(stage *st, gpu *g, const pack_file *file, const scene *s, const load_options *o, int show_bones,
               uint32_t width, uint32_t height)
{
    int status;
    memset(st, 0, sizeof *st);
    st->scene = s;
    status = show_bones ? open_bones(st, g) : load_open(&st->load, g, file, s, o);
    if (!status) {
        status = canvas_open(&st->canvas, g, width, height);
        st->has_canvas = !status;
    }
    if (status) {
        stage_close(st);
    }
    return status;
}

void stage_close(stage *st)
{
    for (uint32_t i = 0; i < st->bones_count; i++) {
        bones_close(&st->bones[i]);
    }
    free(st->bones);
    if (st->has_canvas) {
        canvas_close(&st->canvas);
    }
    if (st->load.g) {
        load_close(&st->load);
    }
    memset(st, 0, sizeof *st);
}

static void draw_bones(stage *st, const noh_gl_camera *camera)
{
    for (uint32_t i = 0; i < st->bones_count; i++) {
        const scene_player *p = &st->scene->players[i];
        if (p->skeleton.joint_count) {
            bones_draw(&st->bones[i], &p->skeleton, p->joint_matrices, camera);
        }
    }
}

void stage_paint(stage *st, const noh_gl_camera *camera)
{
    canvas_begin(&st->canvas);
    if (st->bones) {
        draw_bones(st, camera);
    } else {
        load_draw(&st->load, camera);
    }
}

int stage_draw(stage *st, const noh_gl_camera *camera, uint8_t *rgba)
{
    int status = st->bones ? 0 : load_update(&st->load, NULL);
    if (status) {
        return status;
    }
    stage_paint(st, camera);
    return canvas_read(&st->canvas, rgba);
}
