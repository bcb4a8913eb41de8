#include "overlay.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "tool_shaders.gen.h"

#define NEARER 1e-4f        /* of the depth range: edges in front of the surface that they bound */
#define NORMAL_SHARE 0.012f /* of the figure's height: how long the line of a normal is */

typedef struct overlay_vertex {
    float position[3], normal[3];
    uint8_t color[4]; /* linear */
} overlay_vertex;

/* The drawing of one mesh. */
typedef struct drawing {
    overlay_vertex *vertices;
    uint32_t *indices;
    uint32_t vertex_count, index_count;
} drawing;

/* ---- GL ---- */

static void describe_vertices(overlay *o)
{
    const noh_gl_api *gl = &o->g->gl;
    const GLsizei stride = (GLsizei)sizeof(overlay_vertex);
    gl->GenVertexArrays(1, &o->vertex_array);
    gl->GenBuffers(1, &o->vertex_buffer);
    gl->GenBuffers(1, &o->index_buffer);
    gl->BindVertexArray(o->vertex_array);
    gl->BindBuffer(GL_ARRAY_BUFFER, o->vertex_buffer);
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, o->index_buffer);
    for (GLuint i = 0; i < 3; i++) gl->EnableVertexAttribArray(i);
    gl->VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, stride, NULL);
    gl->VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, stride, (const void *)offsetof(overlay_vertex, normal));
    gl->VertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride, (const void *)offsetof(overlay_vertex, color));
    gl->BindVertexArray(0);
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
}

int overlay_open(overlay *o, gpu *g)
{
    const noh_gl_program_desc desc = { .name = "overlay",
                                       .vertex = &noh_shader_overlay_vert,
                                       .fragment = &noh_shader_overlay_frag };
    noh_error error = { NOH_OK, "", 0, 0 };
    char log[4096] = "";
    memset(o, 0, sizeof *o);
    if (noh_gl_program_create(&g->gl, &desc, &o->program, log, sizeof log, &error)) {
        fputs(log, stderr);
        return tool_fail_error("overlay", &error);
    }
    o->g = g;
    o->u_view_projection = g->gl.GetUniformLocation(o->program, "u_view_projection");
    o->u_key = g->gl.GetUniformLocation(o->program, "u_key");
    o->u_nearer = g->gl.GetUniformLocation(o->program, "u_nearer");
    o->u_shaded = g->gl.GetUniformLocation(o->program, "u_shaded");
    describe_vertices(o);
    return 0;
}

void overlay_close(overlay *o)
{
    if (o->g) {
        noh_gl_program_delete(&o->g->gl, NULL, &o->program);
        o->g->gl.DeleteVertexArrays(1, &o->vertex_array);
        o->g->gl.DeleteBuffers(1, &o->vertex_buffer);
        o->g->gl.DeleteBuffers(1, &o->index_buffer);
    }
    memset(o, 0, sizeof *o);
}

/* in_lines: the indices are pairs, else triangles. */
static void draw(overlay *o, const drawing *d, int in_lines, const noh_gl_camera *camera)
{
    const noh_gl_api *gl = &o->g->gl;
    gl->BindVertexArray(o->vertex_array);
    gl->BindBuffer(GL_ARRAY_BUFFER, o->vertex_buffer);
    gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(d->vertex_count * sizeof *d->vertices), d->vertices, GL_STREAM_DRAW);
    gl->BufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(d->index_count * sizeof *d->indices), d->indices,
                   GL_STREAM_DRAW);
    gl->UseProgram(o->program);
    gl->UniformMatrix4fv(o->u_view_projection, 1, GL_FALSE, camera->view_projection);
    gl->Uniform3fv(o->u_key, 1, camera->key);
    gl->Uniform1f(o->u_nearer, in_lines ? NEARER : 0.0f);
    gl->Uniform1f(o->u_shaded, in_lines ? 0.0f : 1.0f);
    gl->Enable(GL_DEPTH_TEST);
    gl->DepthFunc(in_lines ? GL_LEQUAL : GL_LESS);
    gl->DepthMask(!in_lines);
    gl->Enable(GL_BLEND);
    gl->BlendEquation(GL_FUNC_ADD);
    gl->BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl->DrawElements(in_lines ? GL_LINES : GL_TRIANGLES, (GLsizei)d->index_count, GL_UNSIGNED_INT, NULL);
    gl->Disable(GL_BLEND);
    gl->DepthMask(GL_TRUE);
    gl->DepthFunc(GL_LESS);
    gl->Disable(GL_DEPTH_TEST);
    gl->UseProgram(0);
    gl->BindVertexArray(0);
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
}

/* ---- colours ---- */

/* Hues a golden angle apart, in three degrees of lightness. */
void overlay_joint_color(uint32_t joint, float rgb[3])
{
    const float hue = fmodf((float)joint * 0.61803399f, 1.0f) * 6.2831853f, light = 0.30f + 0.12f * (float)(joint % 3u);
    rgb[0] = light + 0.28f * cosf(hue);
    rgb[1] = light + 0.28f * cosf(hue - 2.0943951f);
    rgb[2] = light + 0.28f * cosf(hue + 2.0943951f);
}

/* Between five colours of rising lightness but the last: none, little, half, much, all. */
void overlay_heat(float weight, float rgb[3])
{
    static const float stops[5][3] = { { 0.015f, 0.02f, 0.09f },
                                       { 0.02f, 0.13f, 0.55f },
                                       { 0.03f, 0.48f, 0.22f },
                                       { 0.85f, 0.72f, 0.05f },
                                       { 0.85f, 0.06f, 0.02f } };
    const float at = fminf(fmaxf(weight, 0.0f), 1.0f) * 4.0f;
    const int below = at < 4.0f ? (int)at : 3;
    const float share = at - (float)below;
    for (int c = 0; c < 3; c++) rgb[c] = stops[below][c] + share * (stops[below + 1][c] - stops[below][c]);
}

static void set_color(overlay_vertex *v, const float rgb[3], float alpha)
{
    for (int c = 0; c < 3; c++) v->color[c] = (uint8_t)(fminf(fmaxf(rgb[c], 0.0f), 1.0f) * 255.0f + 0.5f);
    v->color[3] = (uint8_t)(alpha * 255.0f + 0.5f);
}

/* The colours of a mesh's skin. skin NULL: rigid. joint: of the skeleton */
static void color_skin(drawing *d, const noh_mesh *mesh, const noh_skin *skin, overlay_kind kind, uint32_t joint)
{
    for (uint32_t v = 0; v < d->vertex_count; v++) {
        uint32_t joints[NOH_INFLUENCES_MAX];
        float weights[NOH_INFLUENCES_MAX], rgb[3] = { 0.0f, 0.0f, 0.0f }, one[3], of_joint = 0.0f;
        const uint32_t count = skin ? noh_mesh_influences(mesh, v, joints, weights) : 0;
        for (uint32_t i = 0; i < count; i++) {
            overlay_joint_color(skin->joints[joints[i]], one);
            for (int c = 0; c < 3; c++) rgb[c] += weights[i] * one[c];
            if (skin->joints[joints[i]] == joint) of_joint += weights[i];
        }
        if (kind == OVERLAY_WEIGHTS) overlay_heat(of_joint, rgb);
        if (!count) rgb[0] = rgb[1] = rgb[2] = 0.2f;
        set_color(&d->vertices[v], rgb, 1.0f);
    }
}

/* ---- one mesh ---- */

static void place(overlay_vertex *to, const noh_vertex *from, const float world[12])
{
    for (int r = 0; r < 3; r++) {
        const float *row = world + 4 * r, *p = from->position, *n = from->normal;
        to->position[r] = row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3];
        to->normal[r] = row[0] * n[0] + row[1] * n[1] + row[2] * n[2];
    }
}

static int make_triangles(drawing *d, const noh_mesh *mesh)
{
    d->index_count = mesh->header->index_count;
    d->indices = malloc(sizeof *d->indices * (d->index_count + 1u));
    for (uint32_t i = 0; i < d->index_count && d->indices; i++) d->indices[i] = noh_mesh_index(mesh, i);
    return d->indices != NULL;
}

/* Each triangle's edges; what two triangles share is drawn twice, to the same pixels. */
static int make_edges(drawing *d, const noh_mesh *mesh)
{
    const uint32_t corners = mesh->header->index_count;
    const float rgb[3] = { 0.02f, 0.02f, 0.03f };
    d->index_count = 2u * corners;
    d->indices = malloc(sizeof *d->indices * (d->index_count + 1u));
    for (uint32_t i = 0; i < corners && d->indices; i++) {
        d->indices[2u * i] = noh_mesh_index(mesh, i);
        d->indices[2u * i + 1u] = noh_mesh_index(mesh, i % 3u == 2u ? i - 2u : i + 1u);
    }
    for (uint32_t v = 0; v < d->vertex_count; v++) set_color(&d->vertices[v], rgb, 1.0f);
    return d->indices != NULL;
}

/* A second vertex at the end of each normal. */
static int make_normals(drawing *d, const noh_mesh *mesh, float length)
{
    const float foot[3] = { 0.02f, 0.10f, 0.35f }, tip[3] = { 0.25f, 0.65f, 0.95f };
    const uint32_t count = mesh->header->vertex_count;
    d->index_count = d->vertex_count = 2u * count;
    d->indices = malloc(sizeof *d->indices * (d->index_count + 1u));
    for (uint32_t v = 0; v < count && d->indices; v++) {
        overlay_vertex *from = &d->vertices[v], *to = &d->vertices[count + v];
        const float *n = from->normal, size = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        *to = *from;
        for (int c = 0; c < 3 && size > 0.0f; c++) to->position[c] += n[c] / size * length;
        set_color(from, foot, 1.0f);
        set_color(to, tip, 1.0f);
        d->indices[2u * v] = v;
        d->indices[2u * v + 1u] = count + v;
    }
    return d->indices != NULL;
}

static const noh_skin *skin_of(const noh_mesh *mesh, noh_skin *skin)
{
    return noh_pack_skin_at(mesh->pack, mesh->header->skin, skin, NULL) == NOH_OK ? skin : NULL;
}

/* The largest side of the box around a drawing's vertices. */
static float size_of(const drawing *d)
{
    float low[3], high[3], most = 0.0f;
    for (uint32_t v = 0; v < d->vertex_count; v++) {
        for (int c = 0; c < 3; c++) {
            const float at = d->vertices[v].position[c];
            low[c] = v ? fminf(low[c], at) : at;
            high[c] = v ? fmaxf(high[c], at) : at;
        }
    }
    for (int c = 0; c < 3 && d->vertex_count; c++) most = fmaxf(most, high[c] - low[c]);
    return most;
}

static int draw_mesh(overlay *o, const figure *f, uint32_t kind, uint32_t index, overlay_kind what, uint32_t joint,
                     const noh_gl_camera *camera)
{
    const int in_lines = what == OVERLAY_WIREFRAME || what == OVERLAY_NORMALS;
    drawing d = { NULL, NULL, 0, 0 };
    noh_actor_mesh shown;
    noh_mesh mesh;
    noh_skin skin;
    noh_vertex *vertices;
    int made = 0;
    if (noh_actor_mesh_at(f->stage, f->actors[kind], index, &shown, NULL, NULL) != NOH_OK) return 0;
    vertices = figure_deform(f, kind, index, shown.level, &mesh, &shown);
    if (!vertices) return EXIT_FAILED;
    d.vertex_count = mesh.header->vertex_count;
    d.vertices = malloc(sizeof *d.vertices * (2u * d.vertex_count + 1u));
    for (uint32_t v = 0; v < d.vertex_count && d.vertices; v++) place(&d.vertices[v], &vertices[v], shown.world);
    free(vertices);
    if (d.vertices && what == OVERLAY_WIREFRAME) made = make_edges(&d, &mesh);
    if (d.vertices && what == OVERLAY_NORMALS) made = make_normals(&d, &mesh, NORMAL_SHARE * size_of(&d));
    if (d.vertices && !in_lines) {
        color_skin(&d, &mesh, skin_of(&mesh, &skin), what, joint);
        made = make_triangles(&d, &mesh);
    }
    if (made) draw(o, &d, in_lines, camera);
    free(d.vertices);
    free(d.indices);
    return made ? 0 : tool_fail(f->desc.file->path, "out of memory");
}

int overlay_draw(overlay *o, const figure *f, overlay_kind kind, uint32_t joint, const noh_gl_camera *camera)
{
    int status = 0;
    for (uint32_t k = 0; k < f->stage_desc.kind_count && !status; k++) {
        for (uint32_t i = 0; i < f->plan.kinds[k].mesh_count && !status; i++) {
            status = draw_mesh(o, f, k, i, kind, k ? NOH_NONE : joint, camera);
        }
    }
    return status;
}

/* ---- joints ---- */

uint32_t overlay_main_joint(const figure *f)
{
    const uint32_t joint_count = f->plan.kinds[0].joint_count;
    const noh_pack *pack = f->kinds[0].mesh;
    double *moved = calloc(joint_count + 1u, sizeof *moved);
    uint32_t most = NOH_NONE;
    noh_mesh mesh;
    for (uint32_t i = 0; moved && joint_count && noh_pack_mesh_at(pack, i, &mesh, NULL) == NOH_OK; i++) {
        noh_skin skin;
        if (!skin_of(&mesh, &skin) || skin.header->skeleton != f->kinds[0].skeleton) continue;
        for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
            uint32_t joints[NOH_INFLUENCES_MAX];
            float weights[NOH_INFLUENCES_MAX];
            const uint32_t count = noh_mesh_influences(&mesh, v, joints, weights);
            for (uint32_t n = 0; n < count; n++) moved[skin.joints[joints[n]]] += (double)weights[n];
        }
    }
    for (uint32_t j = 0; moved && j < joint_count; j++) {
        if (moved[j] > (most == NOH_NONE ? 0.0 : moved[most])) most = j;
    }
    free(moved);
    return most;
}

int overlay_joint(const figure *f, const char *name, uint32_t *joint)
{
    const uint32_t count = f->plan.kinds[0].joint_count;
    const char **names;
    int status;
    *joint = name ? noh_stage_find(f->stage, 0, NOH_NAME_JOINT, name) : overlay_main_joint(f);
    if (*joint != NOH_NONE) return 0;
    if (!count || !name) return tool_fail(f->desc.file->path, "the pack has no skin, so no weights of joints");
    names = calloc(count, sizeof *names);
    for (uint32_t j = 0; names && j < count; j++) names[j] = noh_stage_name(f->stage, 0, NOH_NAME_JOINT, j);
    status = names ? figure_fail_unknown(f->desc.file->path, "joint", name, names, count)
                   : tool_fail(f->desc.file->path, "out of memory");
    free(names);
    return status;
}
