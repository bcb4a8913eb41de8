/* drawable.c: one life cycle for backdrops, floors, blobs, hair, decals, patches and terrains. */
#include "gl/stage/drawable_internal.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "gl/device/gl_api_internal.h"
#include "gl/draw/gl_light_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "gl/device/gl_state_internal.h"
#include "gl/stage/stage_gl_internal.h"

#define PIECES_MAX 8u

/* ---- programs ---- */

const char *noh_gl_encode_define(int encode_srgb)
{
    return encode_srgb ? "#define NOH_ENCODE_SRGB\n" : NULL;
}

void noh_gl_find_uniforms(const noh_gl_api *gl, GLuint program, const char *const *names, uint32_t count, int *out)
{
    for (uint32_t i = 0; i < count; i++) out[i] = gl->GetUniformLocation(program, names[i]);
}

static noh_result create_program(noh_gl_drawable *d, const noh_gl_device *device, const noh_gl_drawable_desc *desc,
                                 int which, noh_error *error)
{
    static const char *const light[NOH_DRAWABLE_OWN] = { "noh_lighting", "noh_key" };
    const char *samplers[NOH_DRAWABLE_UNITS] = { desc->sampler ? desc->sampler : "", "noh_environment",
                                                 "noh_shadow_map" };
    const char *pieces[PIECES_MAX] = { "precision highp float;\nprecision highp int;\n",
                                       which == NOH_DRAWABLE_DEPTH ? "#define NOH_DEPTH_ONLY\n"
                                       : !desc->lit                ? ""
                                       : d->is_soft                ? "#define NOH_LIT\n#define NOH_SHADOW_TAPS 0\n"
                                                                   : "#define NOH_LIT\n",
                                       noh_gl_shader_text("common_fade.glsl"),
                                       noh_gl_shader_text("common_fragment.glsl"),
                                       noh_gl_shader_text("common_environment.glsl") };
    noh_gl_source fragment = *desc->fragment;
    noh_gl_program_desc p;
    memset(&p, 0, sizeof p);
    if (!desc->bare) {
        NOH_ASSERT(5u + fragment.piece_count <= PIECES_MAX);
        for (uint32_t i = 0; i < fragment.piece_count; i++) pieces[5u + i] = fragment.pieces[i];
        fragment.piece_count += 5u;
        fragment.pieces = pieces;
        p.samplers = samplers;
        p.sampler_count = d->units = NOH_DRAWABLE_UNITS;
    }
    p.name = desc->name[which];
    p.defines = desc->defines;
    p.vertex = desc->vertex;
    p.fragment = &fragment;
    p.ledger = d->ledger;
    const noh_result result = noh_gl_program_create(d->gl, &p, &d->programs[which], device->log, device->log_bytes,
                                                    error);
    if (result) return result;
    NOH_ASSERT(NOH_DRAWABLE_OWN + desc->uniform_count <= NOH_DRAWABLE_UNIFORMS);
    noh_gl_find_uniforms(d->gl, d->programs[which], light, NOH_DRAWABLE_OWN, d->uniforms[which]);
    noh_gl_find_uniforms(d->gl, d->programs[which], desc->uniforms, desc->uniform_count,
                         d->uniforms[which] + NOH_DRAWABLE_OWN);
    return noh_gl_error_check(d->gl, "the driver refused to return the uniforms of a program", 0, error);
}

/* ---- objects ---- */

static void delete_objects(noh_gl_drawable *d, const noh_gl_api *gl)
{
    if (d->vertex_array) gl->DeleteVertexArrays(1, &d->vertex_array);
    d->vertex_array = 0;
    for (int i = 0; i < 2; i++) noh_gl_program_delete(gl, d->ledger, &d->programs[i]);
    noh_gl_buffer_delete(gl, d->ledger, &d->buffer);
    noh_gl_texture_delete(gl, d->ledger, &d->texture);
}

noh_result noh_gl_drawable_create(const noh_gl_device *device, const noh_gl_drawable_desc *desc, noh_gl_drawable *out,
                                  noh_error *error)
{
    NOH_ASSERT(out);
    noh_result result = noh_gl_device_check(device, 0, error);
    memset(out, 0, sizeof *out);
    if (result) return result;
    const noh_gl_api *gl = device->api;
    out->gl = gl;
    out->ledger = device->ledger;
    out->is_soft = noh_gl_has_soft_shadows(device->caps);
    if (desc->texture.width) result = noh_gl_texture_create(gl, out->ledger, &desc->texture, &out->texture, error);
    if (!result && desc->index_bytes) {
        noh_gl_error_take(gl);
        gl->BindVertexArray(0);
        result = noh_gl_drawable_check(out, error);
    }
    if (!result && desc->index_bytes) {
        result = noh_gl_buffer_create(gl, out->ledger, GL_ELEMENT_ARRAY_BUFFER, desc->index_bytes, NULL,
                                      GL_DYNAMIC_DRAW, &out->buffer, error);
    }
    for (int i = 0; i < 2 && !result; i++) {
        if (desc->name[i]) result = create_program(out, device, desc, i, error);
    }
    if (result) {
        delete_objects(out, gl);
        return result;
    }
    if (desc->name[0]) gl->GenVertexArrays(1, &out->vertex_array);
    return noh_gl_drawable_check(out, error);
}

noh_result noh_gl_drawable_check(noh_gl_drawable *d, noh_error *error)
{
    const noh_result result = noh_gl_error_check(d->gl, "the driver refused a call while making a drawable", 0, error);
    if (result) delete_objects(d, d->gl);
    return result;
}

void noh_gl_drawable_delete(noh_gl_drawable *d)
{
    NOH_ASSERT(d);
    if (d->gl) delete_objects(d, d->gl);
}

noh_result noh_gl_drawable_restore(noh_gl_drawable *d, const noh_gl_drawable_desc *desc, char *log, size_t log_bytes,
                                   noh_error *error)
{
    NOH_ASSERT(d && d->gl);
    const noh_gl_caps caps = { .render_f16 = d->is_soft };
    const noh_gl_device device = { d->gl, &caps, d->ledger, log, log_bytes };
    delete_objects(d, noh_gl_lost_api());
    return noh_gl_drawable_create(&device, desc, d, error);
}

/* ---- draws ---- */

void noh_gl_drawable_begin(const noh_gl_drawable *d, int program)
{
    d->gl->UseProgram(d->programs[program]);
    d->gl->BindVertexArray(d->vertex_array);
    noh_gl_samplers_none(d->gl, 0, d->units);
    if (!d->texture.name) return;
    d->gl->ActiveTexture(GL_TEXTURE0);
    d->gl->BindTexture(GL_TEXTURE_2D, d->texture.name);
}

void noh_gl_drawable_light(const noh_gl_drawable *d, const noh_gl_light *light, const noh_lighting *lighting,
                           const float origin[3])
{
    const float *key = lighting->key_direction;
    const int *uniforms = d->uniforms[NOH_DRAWABLE_COLOR];
    float rows[NOH_LIGHTING_ROWS][4];
    noh_lighting near_by;
    NOH_ASSERT(d->is_soft == light->is_soft); /* both were made with the same noh_gl_device.caps */
    noh_gl_lighting_less(lighting, origin, &near_by);
    noh_lighting_pack(&near_by, light->desc.shadow_px, rows);
    d->gl->Uniform4fv(uniforms[NOH_DRAWABLE_LIGHTING], (GLsizei)NOH_LIGHTING_ROWS, rows[0]);
    d->gl->Uniform3f(uniforms[NOH_DRAWABLE_KEY], key[0], key[1], key[2]);
    d->gl->ActiveTexture(GL_TEXTURE0 + NOH_DRAWABLE_UNIT_ENVIRONMENT);
    d->gl->BindTexture(GL_TEXTURE_CUBE_MAP, light->cube.name);
    d->gl->ActiveTexture(GL_TEXTURE0 + NOH_DRAWABLE_UNIT_SHADOW);
    d->gl->BindTexture(GL_TEXTURE_2D, noh_gl_light_map(light));
}

void noh_gl_drawable_end(const noh_gl_drawable *d, const noh_gl_raster *raster)
{
    noh_gl_raster_put_back(d->gl, raster);
    d->gl->BindVertexArray(0);
    for (uint32_t unit = d->units; unit-- > 0;) {
        d->gl->ActiveTexture(GL_TEXTURE0 + unit);
        d->gl->BindTexture(unit == NOH_DRAWABLE_UNIT_ENVIRONMENT ? GL_TEXTURE_CUBE_MAP : GL_TEXTURE_2D, 0);
    }
    d->gl->UseProgram(0);
}
