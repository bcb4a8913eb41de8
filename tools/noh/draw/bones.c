#include "bones.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/low_motion.h"
#include "tool_shaders.gen.h"
#include "cli/message.h"

#define CORNERS 24u /* 8 triangles */
#define FLOATS 9u   /* of a corner: position, normal, colour */
#define JOINT_FLOATS (2u * CORNERS * FLOATS)

/* ---- geometry ---- */

static void corner_of(float *out, const float position[3], const float normal[3], const float color[3])
{
    memcpy(out, position, 12);
    memcpy(out + 3, normal, 12);
    memcpy(out + 6, color, 12);
}

static void cross(const float a[3], const float b[3], float out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void normalize(float v[3])
{
    float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int c = 0; c < 3 && length > 0.0f; c++) {
        v[c] /= length;
    }
}

/* Flat triangles between two tips and a ring of four. */
static float *octahedron(float *out, const float tips[2][3], const float ring[4][3], const float color[3])
{
    for (unsigned t = 0; t < 2; t++) {
        for (unsigned i = 0; i < 4; i++) {
            const float *a = ring[t ? (i + 1) % 4 : i], *b = ring[t ? i : (i + 1) % 4], *tip = tips[t];
            float u[3], v[3], normal[3];
            for (int c = 0; c < 3; c++) {
                u[c] = b[c] - a[c];
                v[c] = tip[c] - a[c];
            }
            cross(u, v, normal);
            normalize(normal);
            corner_of(out, a, normal, color);
            corner_of(out + FLOATS, b, normal, color);
            corner_of(out + 2 * FLOATS, tip, normal, color);
            out += 3 * FLOATS;
        }
    }
    return out;
}

/* Thickest at a sixth of the length, as modelling programs draw bones. */
static float *draw_bone(float *out, const float from[3], const float to[3], float width_max, const float color[3])
{
    float along[3], side[3], up[3], tips[2][3], ring[4][3];
    const float x[3] = { 1.0f, 0.0f, 0.0f }, y[3] = { 0.0f, 1.0f, 0.0f };
    float length;
    for (int c = 0; c < 3; c++) {
        along[c] = to[c] - from[c];
    }
    length = sqrtf(along[0] * along[0] + along[1] * along[1] + along[2] * along[2]);
    cross(fabsf(along[1]) < 0.9f * length ? y : x, along, side);
    normalize(side);
    cross(along, side, up);
    normalize(up);
    for (int c = 0; c < 3; c++) {
        float middle = from[c] + along[c] / 6.0f, width = fminf(length * 0.12f, width_max);
        tips[0][c] = to[c];
        tips[1][c] = from[c];
        ring[0][c] = middle + side[c] * width;
        ring[1][c] = middle + up[c] * width;
        ring[2][c] = middle - side[c] * width;
        ring[3][c] = middle - up[c] * width;
    }
    return octahedron(out, (const float(*)[3])tips, (const float(*)[3])ring, color);
}

static float *draw_joint(float *out, const float at[3], float radius, const float color[3])
{
    float tips[2][3], ring[4][3];
    for (int c = 0; c < 3; c++) {
        tips[0][c] = at[c] + (c == 1 ? radius : 0.0f);
        tips[1][c] = at[c] - (c == 1 ? radius : 0.0f);
        for (int i = 0; i < 4; i++) {
            int axis = i % 2 ? 0 : 2;
            ring[i][c] = at[c] + (c == axis ? (i < 2 ? radius : -radius) : 0.0f);
        }
    }
    return octahedron(out, (const float(*)[3])tips, (const float(*)[3])ring, color);
}

static void joint_place(const float *matrices, uint32_t joint, float out[3])
{
    for (int r = 0; r < 3; r++) {
        out[r] = matrices[12 * joint + 4 * (uint32_t)r + 3];
    }
}

/* A joint that is its parent's only child continues the chain. */
static uint32_t chain_of(const noh_skeleton *s, uint32_t joint)
{
    while (s->parents[joint] != NOH_JOINT_ROOT) {
        uint32_t parent = s->parents[joint], siblings = 0;
        for (uint32_t j = parent + 1; j < s->joint_count; j++) {
            siblings += s->parents[j] == parent;
        }
        if (siblings != 1) {
            break;
        }
        joint = parent;
    }
    return joint;
}

/* Hues a golden angle apart, so that neighbouring chains differ; light, of low saturation. */
static void chain_color(uint32_t chain, float color[3])
{
    float hue = fmodf((float)chain * 0.61803399f, 1.0f) * 6.2831853f;
    color[0] = 0.42f + 0.30f * cosf(hue);
    color[1] = 0.42f + 0.30f * cosf(hue - 2.0943951f);
    color[2] = 0.42f + 0.30f * cosf(hue + 2.0943951f);
}

static size_t build(bones *b, const noh_skeleton *s, const float *matrices)
{
    bounds box = bones_bounds(s->joint_count, matrices);
    float *out = b->vertices, size = 0.0f;
    for (int c = 0; c < 3; c++) {
        size = fmaxf(size, (float)(box.high[c] - box.low[c]));
    }
    for (uint32_t j = 0; j < s->joint_count; j++) {
        float at[3], from[3], color[3];
        joint_place(matrices, j, at);
        chain_color(chain_of(s, j), color);
        out = draw_joint(out, at, 0.009f * size, color);
        if (s->parents[j] != NOH_JOINT_ROOT) {
            joint_place(matrices, s->parents[j], from);
            out = draw_bone(out, from, at, 0.03f * size, color);
        }
    }
    return (size_t)(out - b->vertices) / FLOATS;
}

bounds bones_bounds(uint32_t joint_count, const float *matrices)
{
    bounds b = { { INFINITY, INFINITY, INFINITY }, { -INFINITY, -INFINITY, -INFINITY } };
    for (uint32_t j = 0; j < joint_count; j++) {
        float at[3];
        joint_place(matrices, j, at);
        for (int c = 0; c < 3; c++) {
            b.low[c] = fmin(b.low[c], (double)at[c]);
            b.high[c] = fmax(b.high[c], (double)at[c]);
        }
    }
    return b;
}

/* ---- GL ---- */

static void describe_vertices(bones *b)
{
    const noh_gl_api *gl = &b->g->gl;
    gl->GenVertexArrays(1, &b->vertex_array);
    gl->GenBuffers(1, &b->buffer);
    gl->BindVertexArray(b->vertex_array);
    gl->BindBuffer(GL_ARRAY_BUFFER, b->buffer);
    gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(sizeof(float) * JOINT_FLOATS * b->joint_count), NULL, GL_DYNAMIC_DRAW);
    for (GLuint i = 0; i < 3; i++) {
        gl->EnableVertexAttribArray(i);
        gl->VertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, FLOATS * sizeof(float), (const void *)(uintptr_t)(12u * i));
    }
    gl->BindVertexArray(0);
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
}

int bones_open(bones *b, gpu *g, uint32_t joint_count)
{
    noh_gl_program_desc desc;
    noh_error error = { NOH_OK, "", 0, 0 };
    char log[4096] = "";
    memset(b, 0, sizeof *b);
    memset(&desc, 0, sizeof desc);
    b->g = g;
    b->joint_count = joint_count;
    b->vertices = malloc(sizeof(float) * JOINT_FLOATS * joint_count);
    if (!b->vertices) {
        return tool_fail("bones", "out of memory");
    }
    desc.name = "bones";
    desc.vertex = &noh_shader_bones_vert;
    desc.fragment = &noh_shader_bones_frag;
    if (noh_gl_program_create(&g->gl, &desc, &b->program, log, sizeof log, &error)) {
        fputs(log, stderr);
        bones_close(b);
        return tool_fail_error("bones", &error);
    }
    b->u_view_projection = g->gl.GetUniformLocation(b->program, "u_view_projection");
    b->u_key = g->gl.GetUniformLocation(b->program, "u_key");
    describe_vertices(b);
    return 0;
}

void bones_close(bones *b)
{
    if (b->g) {
        noh_gl_program_delete(&b->g->gl, NULL, &b->program);
        b->g->gl.DeleteBuffers(1, &b->buffer);
        b->g->gl.DeleteVertexArrays(1, &b->vertex_array);
    }
    free(b->vertices);
    memset(b, 0, sizeof *b);
}

void bones_draw(bones *b, const noh_skeleton *skeleton, const float *matrices, const noh_gl_camera *camera)
{
    const noh_gl_api *gl = &b->g->gl;
    size_t corners = build(b, skeleton, matrices);
    gl->BindBuffer(GL_ARRAY_BUFFER, b->buffer);
    gl->BufferSubData(GL_ARRAY_BUFFER, 0, (GLsizeiptr)(sizeof(float) * FLOATS * corners), b->vertices);
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    gl->UseProgram(b->program);
    gl->UniformMatrix4fv(b->u_view_projection, 1, GL_FALSE, camera->view_projection);
    gl->Uniform3fv(b->u_key, 1, camera->key);
    gl->Enable(GL_DEPTH_TEST);
    gl->DepthFunc(GL_LESS);
    gl->BindVertexArray(b->vertex_array);
    gl->DrawArrays(GL_TRIANGLES, 0, (GLsizei)corners);
    gl->BindVertexArray(0);
    gl->UseProgram(0);
    gl->Disable(GL_DEPTH_TEST);
}
