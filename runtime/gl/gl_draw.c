/* gl_draw.c: the plain renderer. */
#include "gl/gl_draw.h"

#include <string.h>

#include "gl/gl_program.h"
#include "shaders.gen.h"

#define UNIT_LAYERS 0
#define UNIT_BASE_COLOR 1

static noh_result create_white(noh_gl_renderer *r, noh_error *error)
{
    static const uint8_t texel[4] = { 255, 255, 255, 255 };
    noh_gl_texture_desc desc = { GL_RGBA8, 1, 1, 0, 0, 0, 0 };
    noh_result result;
    r->gl->ActiveTexture(GL_TEXTURE0);
    result = noh_gl_texture_create(r->gl, r->ledger, &desc, &r->white, error);
    if (!result) {
        r->gl->BindTexture(GL_TEXTURE_2D, r->white.name);
        r->gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, texel);
        r->gl->BindTexture(GL_TEXTURE_2D, 0);
    }
    return result;
}

static void find_uniforms(noh_gl_renderer *r)
{
    const struct { const char *name; GLint *at; } uniforms[] = {
        { "u_view_projection", &r->u_view_projection }, { "u_world", &r->u_world }, { "u_normal", &r->u_normal },
        { "u_uv", &r->u_uv }, { "u_morph", &r->u_morph }, { "u_camera", &r->u_camera }, { "u_key", &r->u_key },
        { "u_base_color", &r->u_base_color }, { "u_material", &r->u_material }, { "u_bounds_min", &r->u_bounds_min },
        { "u_bounds_size", &r->u_bounds_size }
    };
    for (size_t i = 0; i < sizeof uniforms / sizeof uniforms[0]; i++) {
        *uniforms[i].at = r->gl->GetUniformLocation(r->program, uniforms[i].name);
    }
}

noh_result noh_gl_renderer_create(const noh_gl_api *api, noh_gl_ledger *ledger, noh_debug_view view, int layers_uint,
                                  noh_gl_renderer *out, char *log, size_t log_bytes, noh_error *error)
{
    static const char *const samplers[] = { "u_layers", "u_base_color_texture" };
    static const char *const defines[4][2] = {
        { "#define DEBUG_VIEW 0\n", "#define DEBUG_VIEW 0\n#define LAYERS_UINT\n" },
        { "#define DEBUG_VIEW 1\n", "#define DEBUG_VIEW 1\n#define LAYERS_UINT\n" },
        { "#define DEBUG_VIEW 2\n", "#define DEBUG_VIEW 2\n#define LAYERS_UINT\n" },
        { "#define DEBUG_VIEW 3\n", "#define DEBUG_VIEW 3\n#define LAYERS_UINT\n" }
    };
    noh_gl_renderer r;
    noh_gl_program_desc desc;
    noh_result result;
    memset(&r, 0, sizeof r);
    memset(&desc, 0, sizeof desc);
    r.gl = api;
    r.ledger = ledger;
    desc.name = "mesh";
    desc.vertex = &noh_shader_mesh_vert;
    desc.fragment = &noh_shader_mesh_frag;
    desc.defines = defines[(unsigned)view & 3u][layers_uint != 0];
    desc.samplers = samplers;
    desc.sampler_count = 2;
    desc.ledger = ledger;
    result = noh_gl_program_create(api, &desc, &r.program, log, log_bytes, error);
    if (!result) {
        result = create_white(&r, error);
    }
    if (result) {
        noh_gl_renderer_delete(&r);
        return result;
    }
    find_uniforms(&r);
    *out = r;
    return NOH_OK;
}

void noh_gl_renderer_delete(noh_gl_renderer *renderer)
{
    noh_gl_program_delete(renderer->gl, renderer->ledger, &renderer->program);
    noh_gl_texture_delete(renderer->gl, renderer->ledger, &renderer->white);
}

void noh_gl_draw_begin(const noh_gl_renderer *r, const noh_gl_camera *camera)
{
    r->gl->UseProgram(r->program);
    r->gl->Enable(GL_DEPTH_TEST);
    r->gl->DepthFunc(GL_LEQUAL);
    r->gl->DepthMask(GL_TRUE);
    r->gl->BlendEquation(GL_FUNC_ADD);
    r->gl->BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    r->gl->UniformMatrix4fv(r->u_view_projection, 1, GL_FALSE, camera->view_projection);
    r->gl->Uniform3fv(r->u_camera, 1, camera->eye);
    r->gl->Uniform3fv(r->u_key, 1, camera->key);
}

/* Rows of the inverse transpose, up to a positive factor: the cofactors, with the sign of
 * the determinant so that a mirrored node's normals still point outwards (row E4). */
static float normal_rows(const float w[12], float rows[12])
{
    float determinant;
    for (int i = 0; i < 3; i++) {
        const float *a = w + 4 * ((i + 1) % 3), *b = w + 4 * ((i + 2) % 3);
        rows[4 * i + 0] = a[1] * b[2] - a[2] * b[1];
        rows[4 * i + 1] = a[2] * b[0] - a[0] * b[2];
        rows[4 * i + 2] = a[0] * b[1] - a[1] * b[0];
        rows[4 * i + 3] = 0.0f;
    }
    determinant = w[0] * rows[0] + w[1] * rows[1] + w[2] * rows[2];
    for (int i = 0; determinant < 0.0f && i < 12; i++) {
        rows[i] = -rows[i];
    }
    return determinant;
}

static void set_mesh(const noh_gl_renderer *r, const noh_gl_mesh *mesh, const float world[12], const noh_gl_morph_binding *binding)
{
    const noh_mesh_header *h = mesh->mesh.header;
    float rows[12], determinant = normal_rows(world, rows);
    r->gl->FrontFace(determinant < 0.0f ? GL_CW : GL_CCW);
    r->gl->Uniform4fv(r->u_world, 3, world);
    r->gl->Uniform4fv(r->u_normal, 3, rows);
    r->gl->Uniform4f(r->u_uv, h->uv_offset[0], h->uv_offset[1], h->uv_scale[0], h->uv_scale[1]);
    r->gl->Uniform3f(r->u_bounds_min, h->bounds_min[0], h->bounds_min[1], h->bounds_min[2]);
    r->gl->Uniform3f(r->u_bounds_size, h->bounds_max[0] - h->bounds_min[0], h->bounds_max[1] - h->bounds_min[1],
                     h->bounds_max[2] - h->bounds_min[2]);
    r->gl->ActiveTexture(GL_TEXTURE0 + UNIT_LAYERS);
    if (binding) {
        r->gl->BindTexture(GL_TEXTURE_2D_ARRAY, binding->texture);
        r->gl->Uniform4i(r->u_morph, binding->tile_x, binding->tile_y, binding->width_log2, binding->touched);
    } else {
        r->gl->Uniform4i(r->u_morph, 0, 0, 0, 0);
    }
    r->gl->VertexAttribI4i(NOH_ATTRIBUTE_TANGENT, 0, 0, 0, 1);
    r->gl->VertexAttrib4f(NOH_ATTRIBUTE_UV, 0.0f, 0.0f, 0.0f, 1.0f);
    r->gl->VertexAttrib4f(NOH_ATTRIBUTE_COLOR, 1.0f, 1.0f, 1.0f, 1.0f);
    r->gl->BindVertexArray(mesh->vertex_array);
}

static const noh_material *material_of(const noh_gl_mesh *mesh, const noh_submesh *submesh)
{
    /* glTF's default material */
    static const noh_material plain = { 0, 0, 0, NOH_NONE, { 1.0f, 1.0f, 1.0f, 1.0f }, 1.0f, 1.0f, 0.5f, 0 };
    return submesh->material == NOH_NONE ? &plain : &mesh->mesh.pack->materials[submesh->material];
}

static void set_material(const noh_gl_renderer *r, const noh_material *m, const noh_gl_texture *pictures)
{
    GLuint texture = m->base_color_texture == NOH_NONE ? r->white.name : pictures[m->base_color_texture].name;
    r->gl->ActiveTexture(GL_TEXTURE0 + UNIT_BASE_COLOR);
    r->gl->BindTexture(GL_TEXTURE_2D, texture);
    r->gl->Uniform4fv(r->u_base_color, 1, m->base_color);
    r->gl->Uniform4f(r->u_material, m->roughness, m->metallic, (m->flags & NOH_MATERIAL_MASK) ? m->alpha_cutoff : -1.0f,
                     (m->flags & NOH_MATERIAL_UNLIT) ? 1.0f : 0.0f);
    if (m->flags & NOH_MATERIAL_DOUBLE_SIDED) {
        r->gl->Disable(GL_CULL_FACE);
    } else {
        r->gl->Enable(GL_CULL_FACE);
    }
}

void noh_gl_draw_mesh(const noh_gl_renderer *r, const noh_gl_mesh *mesh, const float world[12],
                      const noh_gl_morph_binding *binding, const noh_gl_texture *pictures, int pass)
{
    const noh_mesh_header *h = mesh->mesh.header;
    set_mesh(r, mesh, world, binding);
    if (pass == NOH_DRAW_BLENDED) {
        r->gl->Enable(GL_BLEND);
        r->gl->DepthMask(GL_FALSE);
    }
    for (uint32_t i = 0; i < h->submesh_count; i++) {
        const noh_submesh *s = &mesh->mesh.submeshes[i];
        const noh_material *m = material_of(mesh, s);
        int blended = (m->flags & NOH_MATERIAL_BLEND) != 0;
        if (blended == pass && s->index_count) {
            set_material(r, m, pictures);
            r->gl->DrawElements(GL_TRIANGLES, (GLsizei)s->index_count, mesh->index_type,
                                (const void *)((uintptr_t)s->first_index * h->index_bytes));
        }
    }
    if (pass == NOH_DRAW_BLENDED) {
        r->gl->Disable(GL_BLEND);
        r->gl->DepthMask(GL_TRUE);
    }
}

void noh_gl_draw_end(const noh_gl_renderer *r)
{
    r->gl->BindVertexArray(0);
    r->gl->UseProgram(0);
    r->gl->ActiveTexture(GL_TEXTURE0 + UNIT_BASE_COLOR);
    r->gl->BindTexture(GL_TEXTURE_2D, 0);
    r->gl->ActiveTexture(GL_TEXTURE0 + UNIT_LAYERS);
    r->gl->BindTexture(GL_TEXTURE_2D_ARRAY, 0);
    r->gl->Disable(GL_DEPTH_TEST);
    r->gl->Disable(GL_CULL_FACE);
    r->gl->FrontFace(GL_CCW);
}
