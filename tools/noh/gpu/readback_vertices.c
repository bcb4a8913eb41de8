/* readback_vertices.c: every vertex as mesh.vert leaves it, through transform feedback, so that the shader that is
 * tested is the shader that draws. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gpu.h"
#include "cli/message.h"
#include "readback.h"
#include "noh/low_core.h"

/* The shader variant that draws such a mesh, with transform feedback; the last one is cached. */
static int use_variant(readback *r, noh_gl_variant_key key)
{
    static const char *const varyings[] = { "v_model", "v_normal", "v_tangent", "v_world", "v_uv" };
    noh_error error = { NOH_OK, "", 0, 0 };
    char log[4096] = "";
    if (r->variant.program && memcmp(&r->variant.key, &key, sizeof key) == 0) {
        return 0;
    }
    noh_gl_variant_delete(&r->g->gl, NULL, &r->variant);
    if (noh_gl_variant_create(&(noh_gl_device){ &r->g->gl, NULL, NULL, log, sizeof log }, key, NULL, varyings, 5,
                              &r->variant, &error)) {
        fputs(log, stderr);
        return tool_fail_error("readback", &error);
    }
    return 0;
}

static void set_up(gpu *g, const noh_gl_variant *v, const noh_gl_mesh *mesh, const noh_gl_morph_binding *morph)
{
    static const float rows[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
    const noh_mesh_header *h = mesh->mesh.header;
    const float uv[8] = { h->uv_offset[0], h->uv_offset[1], h->uv_scale[0], h->uv_scale[1], h->uv_per_unit };
    const noh_gl_api *gl = &g->gl;
    gl->UseProgram(v->program);
    gl->Uniform4fv(v->u_uv, v->key.uv_targets ? 2 : 1, uv);
    gl->Uniform4fv(v->u_world, 3, rows);
    gl->Uniform4fv(v->u_normal, 3, rows);
    if (morph) {
        gl->Uniform4i(v->u_morph, morph->tile_x, morph->tile_y, morph->width_log2, morph->touched);
        noh_gl_morph_bind(gl, morph);
    }
    gl->VertexAttribI4i(NOH_ATTRIBUTE_TANGENT, 0, 0, 0, 1);
    gl->VertexAttrib4f(NOH_ATTRIBUTE_UV, 0.0f, 0.0f, 0.0f, 1.0f);
    noh_gl_mesh_bind(gl, mesh, morph);
    if (morph) noh_gl_morph_bind_streams(gl, v->u_streams, morph);
}

static void tear_down(gpu *g)
{
    const noh_gl_api *gl = &g->gl;
    gl->BindVertexArray(0);
    gl->UseProgram(0);
    gl->BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    gl->BindBufferBase(GL_UNIFORM_BUFFER, 0, 0);
    gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_PALETTES);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_LAYERS);
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, 0);
    gl->BindTexture(GL_TEXTURE_2D, 0);
}

/* Draw all vertices with one palette, and keep in `out` those that use it (NOH_NONE: all). */
static int capture(gpu *g, const noh_gl_mesh *mesh, uint32_t palette, uint32_t count, readback_vertex *out)
{
    const noh_gl_api *gl = &g->gl;
    uint32_t vertex_count = mesh->mesh.header->vertex_count;
    size_t total = (size_t)vertex_count * count;
    const readback_vertex *mapped;
    gl->Enable(GL_RASTERIZER_DISCARD);
    gl->BeginTransformFeedback(GL_POINTS);
    gl->DrawArraysInstanced(GL_POINTS, 0, (GLsizei)vertex_count, (GLsizei)count);
    gl->EndTransformFeedback();
    gl->Disable(GL_RASTERIZER_DISCARD);
    mapped = gl->MapBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, (GLsizeiptr)(total * sizeof *mapped), GL_MAP_READ_BIT);
    for (size_t i = 0; mapped && i < total; i++) {
        if (palette == NOH_NONE || noh_mesh_palette(&mesh->mesh, (uint32_t)(i % vertex_count)) == palette) {
            out[i] = mapped[i];
        }
    }
    return !mapped || !gl->UnmapBuffer(GL_TRANSFORM_FEEDBACK_BUFFER);
}

int readback_skinned(readback *r, const noh_gl_mesh *mesh, const noh_gl_morph_binding *morph,
                     const noh_gl_skin_binding *skin, uint32_t crowd, readback_vertex *out)
{
    const noh_gl_api *gl = &r->g->gl;
    uint32_t count = crowd ? crowd : 1u, palettes = skin ? mesh->mesh.header->palette_count : 0, palette = 0;
    GLuint buffer;
    GLenum error;
    noh_gl_variant_key key = noh_gl_variant_key_of(&mesh->mesh, skin, crowd != 0, morph ? morph->is_uint : 0,
                                                   NOH_VIEW_LIT);
    int status, lost;
    key.two_layers = morph && morph->layer_count == 2;
    status = use_variant(r, key);
    if (!status && !gpu_gives_vertices(gl)) {
        status = tool_fail("readback", "this driver has no transform feedback");
    }
    if (status) {
        return status;
    }
    gl->GenBuffers(1, &buffer);
    gl->BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
    gl->BufferData(GL_TRANSFORM_FEEDBACK_BUFFER, (GLsizeiptr)sizeof *out * mesh->mesh.header->vertex_count * count,
                   NULL, GL_STREAM_READ);
    set_up(r->g, &r->variant, mesh, morph);
    do {
        if (skin) {
            noh_gl_variant_skin(gl, &r->variant, &mesh->mesh, skin, palette);
        }
        lost = capture(r->g, mesh, palettes ? palette : NOH_NONE, count, out);
    } while (++palette < palettes && !lost);
    noh_gl_mesh_unbind(gl, mesh, morph);
    tear_down(r->g);
    gl->DeleteBuffers(1, &buffer);
    error = gl->GetError();
    return lost || error ? tool_fail("readback", "the driver cannot read vertices back (GL error 0x%x)", error) : 0;
}

int readback_vertices_uv(readback *r, const noh_gl_mesh *mesh, const noh_gl_morph_binding *binding, float *positions,
                         float *normals, float *tangents, float *uvs)
{
    size_t count = mesh->mesh.header->vertex_count;
    readback_vertex *vertices = malloc(count * sizeof *vertices);
    int status = vertices ? readback_skinned(r, mesh, binding, NULL, 0, vertices)
                          : tool_fail("readback", "out of memory");
    for (size_t v = 0; v < count && !status; v++) {
        memcpy(positions + 3 * v, vertices[v].position, 12);
        memcpy(normals + 3 * v, vertices[v].normal, 12);
        memcpy(tangents + 3 * v, vertices[v].tangent, 12);
        if (uvs) memcpy(uvs + 2 * v, vertices[v].uv, 8);
    }
    free(vertices);
    return status;
}

int readback_vertices(readback *r, const noh_gl_mesh *mesh, const noh_gl_morph_binding *binding, float *positions,
                      float *normals, float *tangents)
{
    return readback_vertices_uv(r, mesh, binding, positions, normals, tangents, NULL);
}
