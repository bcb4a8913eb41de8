/* gl_morph_shared.c: code shared by the paths: tiles, records of weights, framebuffers, the vertex stream, and the GL
 * state around a draw. */
#include <string.h>

#include "gl/device/gl_api_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/pack.h"
#include "gl/morph/gl_morph_internal.h"
#include "gl/device/gl_state_internal.h"
#include "gl/device/gl_debug_internal.h"
#include "gl/device/gl_memory_internal.h"

/* ---- positions ---- */

void noh_gl_morph_tile(const noh_gl_morph *m, uint32_t instance, uint32_t *x, uint32_t *y)
{
    const noh_gl_morph_mesh *mesh = &m->meshes[m->instance_mesh[instance]];
    uint32_t i = instance - mesh->first_instance;
    *x = i % mesh->columns << mesh->mesh.header->morph_width_log2;
    *y = mesh->band_y + i / mesh->columns * noh_gl_morph_pitch(mesh->mesh.header);
}

noh_mesh noh_gl_morph_view(const noh_gl_morph *m, uint32_t instance)
{
    const noh_mesh *mesh = m->table_count > m->mesh_count ? &m->source : &m->meshes[m->instance_mesh[instance]].mesh;
    return m->levels[instance] > mesh->header->level ? noh_mesh_at_lod(mesh, m->levels[instance]) : *mesh;
}

const noh_gl_morph_mesh *noh_gl_morph_tables(const noh_gl_morph *m, uint32_t instance)
{
    const noh_gl_morph_mesh *coarse = m->meshes + m->mesh_count;
    if (m->table_count > m->mesh_count && m->source.header->level >= coarse->mesh.header->level) {
        return coarse;
    }
    return &m->meshes[m->meshes[m->instance_mesh[instance]].owner];
}

uint32_t noh_gl_morph_first_weight(const noh_gl_morph *m, uint32_t instance)
{
    const noh_gl_morph_mesh *mesh = &m->meshes[m->instance_mesh[instance]];
    return mesh->first_weight + (instance - mesh->first_instance) * mesh->mesh.header->target_count;
}

/* ---- shader inputs ---- */

void noh_gl_morph_put_record(uint32_t record[4], const noh_target *target, float weight, uint32_t last)
{
    /* the same products as on the CPU, so that both round alike */
    const float scaled[3] = { target->position_scale * weight, target->normal_scale * weight,
                              target->tangent_scale * weight };
    memcpy(record, scaled, sizeof scaled);
    record[3] = last;
}

uint32_t noh_gl_morph_target_bits(const noh_target *t)
{
    return t->position_bits | (uint32_t)t->normal_bits << 8 | (uint32_t)t->tangent_bits << 16;
}

static void set_constants(const noh_gl_morph *m)
{
    m->gl->Uniform3i(m->u_tables, (GLint)m->record_table.width_log2, (GLint)m->starts.width_log2,
                     (GLint)m->tiles_across_log2);
    m->gl->Uniform2f(m->u_atlas, 2.0f / (float)m->plan.atlas_width, 2.0f / (float)m->plan.atlas_height);
}

void noh_gl_morph_constants(noh_gl_morph *m)
{
    m->u_tables = m->gl->GetUniformLocation(m->program, "u_tables");
    m->u_atlas = m->gl->GetUniformLocation(m->program, "u_atlas");
    m->gl->UseProgram(m->program);
    set_constants(m);
    m->gl->UseProgram(0);
}

/* ---- GL objects ---- */

noh_result noh_gl_morph_framebuffer(noh_gl_morph *m, int which, GLuint *framebuffer, noh_error *error)
{
    static const GLenum attachments[3] = { GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2 };
    noh_result result = noh_gl_framebuffer_create(m->gl, m->ledger, framebuffer, error);
    GLenum status;
    int kept[2];
    if (result) {
        return result;
    }
    noh_gl_framebuffers_keep(m->gl, kept);
    m->gl->BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
    if (which == NOH_LAYERS_LAYERED) {
        m->gl->FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, m->layers.name, 0);
    } else if (which == NOH_LAYERS_ALL) {
        for (GLint layer = 0; layer < (GLint)m->plan.layer_count; layer++) {
            m->gl->FramebufferTextureLayer(GL_FRAMEBUFFER, attachments[layer], m->layers.name, 0, layer);
        }
        m->gl->DrawBuffers((GLsizei)m->plan.layer_count, attachments);
    } else {
        m->gl->FramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, m->layers.name, 0, which);
    }
    noh_gl_label(m->gl, GL_FRAMEBUFFER, *framebuffer, "morph target of", noh_morph_path_name(m->plan.path));
    status = m->gl->CheckFramebufferStatus(GL_FRAMEBUFFER);
    noh_gl_framebuffers_put_back(m->gl, kept);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        noh_gl_error_take(m->gl);
        return noh_fail(error, NOH_ERR_GL, "the driver refused the accumulation framebuffer", status, 0);
    }
    return noh_gl_error_check(m->gl, "the driver refused a call while making the accumulation framebuffer", 0, error);
}

noh_result noh_gl_morph_stream(noh_gl_morph *m, const char *attribute, GLint components, uint64_t bytes,
                               GLuint instanced, noh_error *error)
{
    GLuint location;
    noh_result result = noh_gl_buffer_create(m->gl, m->ledger, GL_ARRAY_BUFFER, bytes, NULL, GL_STREAM_DRAW, &m->stream,
                                             error);
    if (result) {
        return result;
    }
    m->a_stream = location = (GLuint)m->gl->GetAttribLocation(m->program, attribute);
    m->gl->GenVertexArrays(1, &m->vertex_array);
    m->gl->BindVertexArray(m->vertex_array);
    m->gl->BindBuffer(GL_ARRAY_BUFFER, m->stream.name);
    m->gl->EnableVertexAttribArray(location);
    m->gl->VertexAttribIPointer(location, components, GL_UNSIGNED_INT, 0, NULL);
    if (instanced) m->gl->VertexAttribDivisor(location, 1);
    noh_gl_label(m->gl, GL_BUFFER, m->stream.name, "morph stream", NULL);
    noh_gl_label(m->gl, GL_VERTEX_ARRAY, m->vertex_array, "morph stream", NULL);
    m->gl->BindVertexArray(0);
    m->gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    return noh_gl_error_check(m->gl, "the driver refused the vertex array of the accumulator", 0, error);
}

/* ---- the state around a draw ---- */

void noh_gl_morph_begin(const noh_gl_morph *m, noh_gl_offscreen *kept)
{
    const GLuint names[3] = { m->tiles.name, m->record_table.texture.name, m->starts.texture.name };
    for (unsigned i = 3; i-- > 0;) { /* downwards, so that unit 0 is active at the end */
        m->gl->ActiveTexture(GL_TEXTURE0 + i);
        m->gl->BindTexture(GL_TEXTURE_2D, names[i]);
    }
    noh_gl_samplers_none(m->gl, 0, 3);
    noh_gl_offscreen_begin(m->gl, kept);
    m->gl->Viewport(0, 0, (GLsizei)m->plan.atlas_width, (GLsizei)m->plan.atlas_height);
    m->gl->UseProgram(m->program);
    if (m->programs) set_constants(m); /* another one may have used it since */
    m->gl->BindVertexArray(m->vertex_array);
}

void noh_gl_morph_end(const noh_gl_morph *m, const noh_gl_offscreen *kept)
{
    for (unsigned i = 3; i-- > 0;) {
        m->gl->ActiveTexture(GL_TEXTURE0 + i);
        m->gl->BindTexture(GL_TEXTURE_2D, 0);
    }
    m->gl->UseProgram(0);
    m->gl->BindVertexArray(0);
    m->gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    if (kept) noh_gl_offscreen_end(m->gl, kept);
}
