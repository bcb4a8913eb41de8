#include "drawing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

int drawing_shows_bones(const scene *s, const pack_file *file, int asked_for)
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

bounds drawing_bounds(const scene *s, const pack_file *file, int face, int show_bones)
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

static int open_bones(drawing *d, gpu *g)
{
    int status = 0;
    d->bones = calloc(d->scene->player_count, sizeof *d->bones);
    if (!d->bones) {
        return tool_fail("bones", "out of memory");
    }
    for (; d->bones_count < d->scene->player_count && !status; d->bones_count++) {
        const uint32_t joints = d->scene->players[d->bones_count].skeleton.joint_count;
        status = joints ? bones_open(&d->bones[d->bones_count], g, joints) : 0;
    }
    return status;
}

int drawing_open(drawing *d, gpu *g, const pack_file *file, const scene *s, const load_options *o, int show_bones,
                 uint32_t width, uint32_t height)
{
    int status;
    memset(d, 0, sizeof *d);
    d->scene = s;
    status = show_bones ? open_bones(d, g) : load_open(&d->load, g, file, s, o);
    if (!status) {
        status = canvas_open(&d->canvas, g, width, height);
        d->has_canvas = !status;
    }
    if (status) {
        drawing_close(d);
    }
    return status;
}

void drawing_close(drawing *d)
{
    for (uint32_t i = 0; i < d->bones_count; i++) {
        bones_close(&d->bones[i]);
    }
    free(d->bones);
    if (d->has_canvas) {
        canvas_close(&d->canvas);
    }
    if (d->load.g) {
        load_close(&d->load);
    }
    memset(d, 0, sizeof *d);
}

static void draw_bones(drawing *d, const noh_gl_camera *camera)
{
    for (uint32_t i = 0; i < d->bones_count; i++) {
        const scene_player *p = &d->scene->players[i];
        if (p->skeleton.joint_count) {
            bones_draw(&d->bones[i], &p->skeleton, p->joint_matrices, camera);
        }
    }
}

void drawing_paint(drawing *d, const noh_gl_camera *camera)
{
    canvas_begin(&d->canvas);
    if (d->bones) {
        draw_bones(d, camera);
    } else {
        load_draw(&d->load, camera);
    }
}

int drawing_read(drawing *d, const noh_gl_camera *camera, uint8_t *rgba)
{
    int status = d->bones ? 0 : load_update(&d->load, NULL);
    if (status) {
        return status;
    }
    drawing_paint(d, camera);
    return canvas_read(&d->canvas, rgba);
}
