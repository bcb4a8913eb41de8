#include "view/view_marks.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "tool_shaders.gen.h"
#include "cli/message.h"

static const float grid_color[4] = { 0.30f, 0.31f, 0.33f, 0.55f }, path_color[4] = { 0.85f, 0.45f, 0.11f, 1.0f },
                   point_color[4] = { 0.85f, 0.45f, 0.11f, 1.0f };

/* ---- GL ---- */

static void describe_corners(view_marks *k)
{
    const noh_gl_api *gl = &k->g->gl;
    const GLsizei stride = (GLsizei)sizeof k->corners[0];
    gl->GenVertexArrays(1, &k->vertex_array);
    gl->GenBuffers(1, &k->buffer);
    gl->BindVertexArray(k->vertex_array);
    gl->BindBuffer(GL_ARRAY_BUFFER, k->buffer);
    gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)sizeof k->corners, NULL, GL_DYNAMIC_DRAW);
    gl->EnableVertexAttribArray(0);
    gl->EnableVertexAttribArray(1);
    gl->VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, stride, NULL);
    gl->VertexAttribPointer(1, 4, GL_FLOAT, GL_FALSE, stride, (const void *)(uintptr_t)12u);
    gl->BindVertexArray(0);
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
}

int view_marks_open(view_marks *k, gpu *g)
{
    noh_gl_program_desc desc;
    noh_error error = { NOH_OK, "", 0, 0 };
    char log[4096] = "";
    memset(k, 0, sizeof *k);
    memset(&desc, 0, sizeof desc);
    desc.name = "marks";
    desc.vertex = &noh_shader_view_marks_vert;
    desc.fragment = &noh_shader_view_marks_frag;
    if (noh_gl_program_create(&g->gl, &desc, &k->program, log, sizeof log, &error)) {
        fputs(log, stderr);
        return tool_fail_error("view", &error);
    }
    k->g = g;
    k->u_view_projection = g->gl.GetUniformLocation(k->program, "u_view_projection");
    describe_corners(k);
    return 0;
}

void view_marks_close(view_marks *k)
{
    if (k->g) {
        noh_gl_program_delete(&k->g->gl, NULL, &k->program);
        k->g->gl.DeleteBuffers(1, &k->buffer);
        k->g->gl.DeleteVertexArrays(1, &k->vertex_array);
    }
    k->g = NULL;
}

static void draw(view_marks *k, const orbit *o, int in_front)
{
    const noh_gl_api *gl = &k->g->gl;
    noh_gl_camera camera;
    orbit_camera(o, &camera);
    gl->BindBuffer(GL_ARRAY_BUFFER, k->buffer);
    gl->BufferSubData(GL_ARRAY_BUFFER, 0, (GLsizeiptr)(k->count * sizeof k->corners[0]), k->corners);
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    gl->UseProgram(k->program);
    gl->UniformMatrix4fv(k->u_view_projection, 1, GL_FALSE, camera.view_projection);
    gl->Enable(GL_BLEND);
    gl->BlendEquation(GL_FUNC_ADD);
    gl->BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    if (!in_front) gl->Enable(GL_DEPTH_TEST);
    gl->DepthFunc(GL_LESS);
    gl->DepthMask(GL_FALSE);
    gl->BindVertexArray(k->vertex_array);
    gl->DrawArrays(GL_TRIANGLES, 0, (GLsizei)k->count);
    gl->BindVertexArray(0);
    gl->UseProgram(0);
    gl->DepthMask(GL_TRUE);
    gl->Disable(GL_DEPTH_TEST);
    gl->Disable(GL_BLEND);
    k->count = 0;
}

/* ---- shapes ---- */

/* The length of a pixel at the camera's target. */
static double pixel_of(const orbit *o, uint32_t picture_height)
{
    return 2.0 * tan(ORBIT_VIEW_RAD / 2.0) * o->distance / (double)picture_height;
}

static void corner(view_marks *k, const double at[3], const float color[4], float alpha)
{
    float *c = k->corners[k->count++];
    for (int i = 0; i < 3; i++) {
        c[i] = (float)at[i];
        c[3 + i] = color[i];
    }
    c[6] = color[3] * alpha;
}

/* A flat strip from a to b, `side` to either side, with an alpha at either end. */
static void strip(view_marks *k, const double a[3], const double b[3], const double side[3], const float color[4],
                  const float alpha[2])
{
    double at[4][3];
    static const int order[6] = { 0, 1, 2, 2, 1, 3 };
    if (k->count + 6u > VIEW_MARKS_CORNERS) {
        return;
    }
    for (int i = 0; i < 3; i++) {
        at[0][i] = a[i] - side[i];
        at[1][i] = a[i] + side[i];
        at[2][i] = b[i] - side[i];
        at[3][i] = b[i] + side[i];
    }
    for (int i = 0; i < 6; i++) corner(k, at[order[i]], color, alpha[order[i] / 2]);
}

/* ---- the floor ---- */

/* Between cells: 1, 2 or 5 times a power of ten, some ten of them across. */
static double cell_of(double radius)
{
    const double power = pow(10.0, floor(log10(radius / 4.0))), of = radius / 4.0 / power;
    return power * (of < 2.0 ? 1.0 : of < 5.0 ? 2.0 : 5.0);
}

/* Lines along one axis, at multiples of the cell, each fading towards the rim of a disc. */
static void lines(view_marks *k, const orbit *o, int axis, double height, double rim, double width)
{
    const int across = 2 - axis;
    const double cell = cell_of(o->radius), middle = o->center[across];
    for (double at = ceil((middle - rim) / cell) * cell; at <= middle + rim; at += cell) {
        const double half = sqrt(fmax(rim * rim - (at - middle) * (at - middle), 0.0));
        const float fade[3] = { 0.0f, (float)(half / rim), 0.0f };
        double ends[3][3], side[3] = { 0.0, 0.0, 0.0 };
        side[across] = width;
        for (int i = 0; i < 3; i++) {
            ends[i][across] = at;
            ends[i][1] = height;
            ends[i][axis] = o->center[axis] + (i - 1) * half;
        }
        strip(k, ends[0], ends[1], side, grid_color, fade);
        strip(k, ends[1], ends[2], side, grid_color, fade + 1);
    }
}

void view_marks_floor(view_marks *k, const orbit *o, double height, uint32_t picture_height)
{
    const double rim = 1.9 * o->radius, width = 0.75 * pixel_of(o, picture_height);
    lines(k, o, 0, height, rim, width);
    lines(k, o, 2, height, rim, width);
    draw(k, o, 0);
}

/* ---- the path ---- */

void view_marks_path(view_marks *k, const orbit *o, double height, const float *points, uint32_t count,
                     uint32_t picture_height)
{
    const double width = 1.5 * pixel_of(o, picture_height);
    const float alpha[2] = { 1.0f, 1.0f };
    for (uint32_t i = 1; i < count; i++) {
        const double a[3] = { (double)points[2 * i - 2], height, (double)points[2 * i - 1] };
        const double b[3] = { (double)points[2 * i], height, (double)points[2 * i + 1] };
        const double x = b[0] - a[0], z = b[2] - a[2], length = sqrt(x * x + z * z);
        const double side[3] = { length > 0.0 ? -z / length * width : 0.0, 0.0,
                                 length > 0.0 ? x / length * width : 0.0 };
        strip(k, a, b, side, path_color, alpha);
    }
    draw(k, o, 0);
}

/* ---- the point ---- */

void view_marks_point(view_marks *k, const orbit *o, const float point[3], uint32_t picture_height)
{
    const double pixel = pixel_of(o, picture_height), radius = 5.0 * pixel;
    const float alpha[2] = { 1.0f, 1.0f };
    double axes[3][3];
    orbit_axes(o, axes[0], axes[1], axes[2]);
    for (int i = 0; i < 24; i++) {
        double ends[2][3], side[3];
        for (int e = 0; e < 2; e++) {
            const double angle = 6.283185307179586 * (i + e) / 24.0;
            for (int c = 0; c < 3; c++) {
                const double out = cos(angle) * axes[0][c] + sin(angle) * axes[1][c];
                ends[e][c] = (double)point[c] + radius * out;
                if (!e) side[c] = pixel * out;
            }
        }
        strip(k, ends[0], ends[1], side, point_color, alpha);
    }
    draw(k, o, 1);
}
