/* gl_draw.c: the plain renderer's draws.
 *
 * Everything opaque is drawn first and writes depth. What is blended follows: it is hidden by opaque surfaces but does
 * not write depth, so that two blended surfaces never hide each other, whatever their order. */
#include "gl/gl_draw.h"

#include "gl/gl_debug.h"

void noh_gl_draw_begin(const noh_gl_renderer *r, const noh_gl_camera *camera)
{
    NOH_ASSERT(r && r->gl && camera);
    noh_gl_group_begin(r->gl, "noh meshes", NULL);
    r->gl->Enable(GL_DEPTH_TEST);
    r->gl->DepthFunc(GL_LEQUAL);
    r->gl->DepthMask(GL_TRUE);
    r->gl->BlendEquation(GL_FUNC_ADD);
    r->gl->BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    for (uint32_t i = 0; i < r->variant_count; i++) {
        const noh_gl_variant *v = &r->variants[i];
        r->gl->UseProgram(v->program);
        r->gl->UniformMatrix4fv(v->u_view_projection, 1, GL_FALSE, camera->view_projection);
        r->gl->Uniform3fv(v->u_camera, 1, camera->eye);
        r->gl->Uniform3fv(v->u_key, 1, camera->key);
    }
}

/* ---- uniforms, attributes, textures ---- */

static void set_mesh(const noh_gl_renderer *r, const noh_gl_variant *v, const noh_gl_mesh *mesh,
                     const noh_gl_morph_binding *morph)
{
    const noh_mesh_header *h = mesh->mesh.header;
    r->gl->UseProgram(v->program);
    r->gl->Uniform4f(v->u_uv, h->uv_offset[0], h->uv_offset[1], h->uv_scale[0], h->uv_scale[1]);
    r->gl->Uniform3f(v->u_bounds_min, h->bounds_min[0], h->bounds_min[1], h->bounds_min[2]);
    r->gl->Uniform3f(v->u_bounds_size, h->bounds_max[0] - h->bounds_min[0], h->bounds_max[1] - h->bounds_min[1],
                     h->bounds_max[2] - h->bounds_min[2]);
    if (morph) {
        r->gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_LAYERS);
        r->gl->BindTexture(GL_TEXTURE_2D_ARRAY, morph->texture);
    }
    r->gl->VertexAttribI4i(NOH_ATTRIBUTE_TANGENT, 0, 0, 0, 1);
    r->gl->VertexAttrib4f(NOH_ATTRIBUTE_UV, 0.0f, 0.0f, 0.0f, 1.0f);
    r->gl->VertexAttrib4f(NOH_ATTRIBUTE_COLOR, 1.0f, 1.0f, 1.0f, 1.0f);
    r->gl->BindVertexArray(mesh->vertex_array);
}

/* What is set for one instance. Those of a crowd have it in rows of their own instead. */
static void set_instance(const noh_gl_renderer *r, const noh_gl_variant *v, const float world[12],
                         const noh_gl_morph_binding *morph)
{
    float rows[12], determinant = noh_gl_normal_rows(world, rows);
    r->gl->FrontFace(determinant < 0.0f ? GL_CW : GL_CCW);
    r->gl->Uniform4fv(v->u_world, 3, world);
    r->gl->Uniform4fv(v->u_normal, 3, rows);
    if (morph) {
        r->gl->Uniform4i(v->u_morph, morph->tile_x, morph->tile_y, morph->width_log2, morph->touched);
    } else {
        r->gl->Uniform4i(v->u_morph, 0, 0, 0, 0);
    }
}

static const noh_material *material_of(const noh_gl_mesh *mesh, const noh_submesh *submesh)
{
    /* glTF's default material */
    static const noh_material plain = { 0, 0, 0, NOH_NONE, { 1.0f, 1.0f, 1.0f, 1.0f }, 1.0f, 1.0f, 0.5f, 0 };
    return submesh->material == NOH_NONE ? &plain : &mesh->mesh.pack->materials[submesh->material];
}

static void set_material(const noh_gl_renderer *r, const noh_gl_variant *v, const noh_material *m,
                         const noh_gl_texture *pictures)
{
    GLuint texture = m->base_color_texture == NOH_NONE ? r->white.name : pictures[m->base_color_texture].name;
    NOH_ASSERT(texture); /* the picture was created */
    r->gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_BASE_COLOR);
    r->gl->BindTexture(GL_TEXTURE_2D, texture);
    r->gl->Uniform4fv(v->u_base_color, 1, m->base_color);
    r->gl->Uniform4f(v->u_material, m->roughness, m->metallic, (m->flags & NOH_MATERIAL_MASK) ? m->alpha_cutoff : -1.0f,
                     (m->flags & NOH_MATERIAL_UNLIT) ? 1.0f : 0.0f);
    if (m->flags & NOH_MATERIAL_DOUBLE_SIDED) {
        r->gl->Disable(GL_CULL_FACE);
    } else {
        r->gl->Enable(GL_CULL_FACE);
    }
}

/* ---- drawing ---- */

static const noh_gl_lod whole = { 0, 0.0f, 1.0f };

/* NULL if the renderer's desc did not ask for this variant, or if no pixel is to be drawn. */
static const noh_gl_variant *variant_of(const noh_gl_renderer *r, const noh_gl_mesh *mesh,
                                        const noh_gl_skin_binding *skin, int crowd, const noh_gl_lod *lod)
{
    noh_gl_variant_key key = noh_gl_variant_key_of(&mesh->mesh, skin, crowd, r->layers_uint, r->view);
    const noh_gl_variant *v;
    key.fade = lod->from > 0.0f || lod->to < 1.0f;
    v = noh_gl_renderer_variant(r, key);
    NOH_ASSERT(v);
    return lod->from < lod->to ? v : NULL;
}

static void draw_submesh(const noh_gl_renderer *r, const noh_gl_mesh *mesh, const noh_submesh *s, size_t level_first,
                         uint32_t count)
{
    const void *first = (const void *)(level_first + (uintptr_t)s->first_index * mesh->mesh.header->index_bytes);
    if (count == 1u) {
        r->gl->DrawElements(GL_TRIANGLES, (GLsizei)s->index_count, mesh->index_type, first);
    } else {
        r->gl->DrawElementsInstanced(GL_TRIANGLES, (GLsizei)s->index_count, mesh->index_type, first, (GLsizei)count);
    }
}

static void draw_submeshes(const noh_gl_renderer *r, const noh_gl_variant *v, const noh_gl_mesh *mesh,
                           const noh_gl_skin_binding *skin, uint32_t count, const noh_gl_lod *lod,
                           const noh_gl_texture *pictures, int pass)
{
    size_t first;
    const noh_mesh level = noh_gl_mesh_lod(mesh, lod->level, &first);
    uint32_t palette = NOH_NONE;
    r->gl->Uniform3f(v->u_lod, lod->from, lod->to, (float)level.header->level);
    if (pass == NOH_DRAW_BLENDED) {
        r->gl->Enable(GL_BLEND);
        r->gl->DepthMask(GL_FALSE);
    }
    for (uint32_t i = 0; i < level.header->submesh_count; i++) {
        const noh_submesh *s = &level.submeshes[i];
        const noh_material *m = material_of(mesh, s);
        int blended = (m->flags & NOH_MATERIAL_BLEND) != 0;
        if (blended == pass && s->index_count) {
            set_material(r, v, m, pictures);
            if (skin && s->palette != palette) {
                palette = s->palette;
                noh_gl_variant_skin(r->gl, v, &mesh->mesh, skin, palette);
            }
            draw_submesh(r, mesh, s, first, count);
        }
    }
    if (pass == NOH_DRAW_BLENDED) {
        r->gl->Disable(GL_BLEND);
        r->gl->DepthMask(GL_TRUE);
    }
}

void noh_gl_draw_mesh(const noh_gl_renderer *r, const noh_gl_mesh *mesh, const float world[12],
                      const noh_gl_morph_binding *morph, const noh_gl_skin_binding *skin, const noh_gl_lod *lod,
                      const noh_gl_texture *pictures, int pass)
{
    const noh_gl_lod *d = lod ? lod : &whole;
    const noh_gl_variant *v = variant_of(r, mesh, skin, 0, d);
    NOH_ASSERT(world && mesh->vertex_array && (pass == NOH_DRAW_OPAQUE || pass == NOH_DRAW_BLENDED));
    NOH_ASSERT(!morph || morph->is_uint == r->layers_uint);
    if (v) {
        set_mesh(r, v, mesh, morph);
        set_instance(r, v, world, morph);
        draw_submeshes(r, v, mesh, skin, 1, d, pictures, pass);
    }
}

void noh_gl_draw_crowd(const noh_gl_renderer *r, const noh_gl_mesh *mesh, const noh_gl_morph_binding *morph,
                       const noh_gl_skin_binding *first, uint32_t count, const noh_gl_lod *lod,
                       const noh_gl_texture *pictures, int pass)
{
    const noh_gl_lod *d = lod ? lod : &whole;
    const noh_gl_variant *v = variant_of(r, mesh, first, 1, d);
    NOH_ASSERT(mesh->vertex_array && (pass == NOH_DRAW_OPAQUE || pass == NOH_DRAW_BLENDED));
    NOH_ASSERT(!morph || morph->is_uint == r->layers_uint);
    if (v && count) {
        set_mesh(r, v, mesh, morph);
        r->gl->FrontFace(GL_CCW);
        draw_submeshes(r, v, mesh, first, count, d, pictures, pass);
    }
}

void noh_gl_draw_end(const noh_gl_renderer *r)
{
    NOH_ASSERT(r && r->gl);
    static const GLuint units[] = { NOH_UNIT_PALETTES, NOH_UNIT_BASE_COLOR };
    r->gl->BindVertexArray(0);
    r->gl->UseProgram(0);
    for (unsigned i = 0; i < sizeof units / sizeof units[0]; i++) {
        r->gl->ActiveTexture(GL_TEXTURE0 + units[i]);
        r->gl->BindTexture(GL_TEXTURE_2D, 0);
    }
    r->gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_LAYERS);
    r->gl->BindTexture(GL_TEXTURE_2D_ARRAY, 0);
    r->gl->BindBufferBase(GL_UNIFORM_BUFFER, 0, 0);
    r->gl->Disable(GL_DEPTH_TEST);
    r->gl->Disable(GL_CULL_FACE);
    r->gl->FrontFace(GL_CCW);
    noh_gl_group_end(r->gl);
}
