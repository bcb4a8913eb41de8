#include "picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

int picture_shows_bones(const pack_file *file, int asked_for)
{
    if (!asked_for && figure_draws(&file->pack)) {
        return 0;
    }
    if (file->pack.runs[NOH_CHUNK_SKELETON].count) {
        return 1;
    }
    tool_fail(file->path, asked_for ? "the pack has no skeleton to draw" : "the pack has nothing to draw");
    return -1;
}

static int open_bones(picture *p, gpu *g)
{
    int status = 0;
    for (uint32_t k = 0; k < p->figure.stage_desc.kind_count && !status; k++) {
        const uint32_t joints = p->figure.plan.kinds[k].joint_count;
        status = joints ? bones_open(&p->bones[k], g, joints) : 0;
    }
    return status;
}

int picture_open(picture *p, gpu *g, const figure_desc *desc, int shows_bones, uint32_t width, uint32_t height)
{
    int status;
    memset(p, 0, sizeof *p);
    p->shows_bones = shows_bones;
    status = figure_open(&p->figure, desc, shows_bones ? NULL : g);
    if (!status && shows_bones) status = open_bones(p, g);
    if (!status) {
        status = canvas_open(&p->canvas, g, width, height);
        p->has_canvas = !status;
    }
    if (status) picture_close(p);
    return status;
}

void picture_close(picture *p)
{
    for (uint32_t k = 0; k < NOH_STAGE_KINDS_MAX; k++) bones_close(&p->bones[k]);
    overlay_close(&p->overlay);
    if (p->has_canvas) canvas_close(&p->canvas);
    if (p->figure.stage) figure_close(&p->figure);
    memset(p, 0, sizeof *p);
}

int picture_debug(picture *p, gpu *g, debug_kind kind, const char *joint)
{
    if (kind < DEBUG_WIREFRAME) return 0;
    p->debug = kind;
    if (kind == DEBUG_BONES) {
        return p->figure.desc.file->pack.runs[NOH_CHUNK_SKELETON].count
                   ? open_bones(p, g)
                   : tool_fail(p->figure.desc.file->path, "the pack has no skeleton to draw");
    }
    p->joint = NOH_NONE;
    const int status = kind == DEBUG_WEIGHTS ? overlay_joint(&p->figure, joint, &p->joint) : 0;
    return status ? status : overlay_open(&p->overlay, g);
}

bounds picture_bounds(const picture *p, view_frame frame)
{
    bounds box = { { INFINITY, INFINITY, INFINITY }, { -INFINITY, -INFINITY, -INFINITY } };
    if (!p->shows_bones) {
        return figure_bounds(&p->figure, frame);
    }
    for (uint32_t k = 0; k < p->figure.stage_desc.kind_count; k++) {
        noh_skeleton skeleton;
        float *joints = figure_joints(&p->figure, k, &skeleton);
        if (joints) box = bounds_union(box, bones_bounds(skeleton.joint_count, joints));
        free(joints);
    }
    return box;
}

static void draw_bones(picture *p, const noh_gl_camera *camera)
{
    for (uint32_t k = 0; k < p->figure.stage_desc.kind_count; k++) {
        noh_skeleton skeleton;
        float *joints = figure_joints(&p->figure, k, &skeleton);
        if (joints) bones_draw(&p->bones[k], &skeleton, joints, camera);
        free(joints);
    }
}

/* The figure, with what --debug shows over it or in its place. */
static int paint_debug(picture *p, const noh_gl_camera *camera)
{
    const int instead = p->debug == DEBUG_JOINTS || p->debug == DEBUG_WEIGHTS;
    int status = instead ? 0 : figure_draw(&p->figure);
    if (status) return status;
    switch (p->debug) {
    case DEBUG_WIREFRAME: return overlay_draw(&p->overlay, &p->figure, OVERLAY_WIREFRAME, NOH_NONE, camera);
    case DEBUG_JOINTS: return overlay_draw(&p->overlay, &p->figure, OVERLAY_JOINTS, NOH_NONE, camera);
    case DEBUG_WEIGHTS: return overlay_draw(&p->overlay, &p->figure, OVERLAY_WEIGHTS, p->joint, camera);
    case DEBUG_BONES:
        canvas_clear_depth(&p->canvas); /* they show through the body */
        draw_bones(p, camera);
        return 0;
    default: return 0;
    }
}

int picture_paint(picture *p, const noh_gl_camera *camera)
{
    const int status = p->shows_bones ? figure_pose(&p->figure) : figure_look(&p->figure, camera, p->canvas.height);
    if (status) {
        return status;
    }
    canvas_begin(&p->canvas);
    if (!p->shows_bones) {
        return paint_debug(p, camera);
    }
    draw_bones(p, camera);
    return 0;
}

int picture_read(picture *p, const noh_gl_camera *camera, uint8_t *rgba)
{
    const int status = picture_paint(p, camera);
    return status ? status : canvas_read(&p->canvas, rgba);
}
