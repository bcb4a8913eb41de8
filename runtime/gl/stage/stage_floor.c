#include "gl/stage/stage_floor.h"

#include <string.h>

#include "gl/device/gl_lost.h"
#include "gl/device/gl_state_internal.h"
#include "gl/device/gl_program.h"
#include "shaders.gen.h"
#include "gl/stage/lit_source_internal.h"
#include "gl/stage/stage_gl_internal.h"

static noh_result create_objects(noh_stage_floor *f, char *log, size_t log_bytes, noh_error *error)
{
    static const char *const samplers[] = { "noh_environment", "noh_shadow_map" };
    noh_lit_source fragment;
    noh_gl_program_desc desc;
    noh_result result;
    noh_lit_source_of(&noh_shader_floor_frag, &fragment);
    memset(&desc, 0, sizeof desc);
    desc.name = "floor";
    desc.defines = f->encode_srgb ? "#define NOH_ENCODE_SRGB\n" : NULL;
    desc.vertex = &noh_shader_floor_vert;
    desc.fragment = &fragment.source;
    desc.samplers = samplers;
    desc.sampler_count = 2;
    desc.ledger = f->ledger;
    result = noh_gl_program_create(f->gl, &desc, &f->program, log, log_bytes, error);
    if (result == NOH_OK) f->gl->GenVertexArrays(1, &f->vertex_array);
    return result;
}

noh_result noh_stage_floor_create(const noh_gl_device *device, int encode_srgb, noh_stage_floor *out, noh_error *error)
{
    NOH_ASSERT(device && device->api && device->ledger && out);
    memset(out, 0, sizeof *out);
    out->gl = device->api;
    out->ledger = device->ledger;
    out->encode_srgb = encode_srgb;
    return create_objects(out, device->log, device->log_bytes, error);
}

void noh_stage_floor_delete(noh_stage_floor *level)
{
    NOH_ASSERT(level && level->gl);
    if (level->vertex_array) level->gl->DeleteVertexArrays(1, &level->vertex_array);
    level->vertex_array = 0;
    noh_gl_program_delete(level->gl, level->ledger, &level->program);
}

noh_result noh_stage_floor_restore(noh_stage_floor *level, char *log, size_t log_bytes, noh_error *error)
{
    const noh_gl_api *gl;
    NOH_ASSERT(level && level->gl);
    gl = level->gl;
    level->gl = noh_gl_lost_api();
    noh_stage_floor_delete(level);
    level->gl = gl;
    return create_objects(level, log, log_bytes, error);
}

static void begin(const noh_stage_floor *f, const noh_gl_light *light, noh_gl_raster *raster)
{
    const noh_gl_api *gl = f->gl;
    gl->ActiveTexture(GL_TEXTURE1);
    gl->BindTexture(GL_TEXTURE_2D, light->shadow.name);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_CUBE_MAP, light->cube.name);
    noh_gl_samplers_none(gl, 0, 2);
    noh_gl_multiply_begin(gl, raster);
    gl->BlendFuncSeparate(GL_ZERO, GL_SRC_COLOR, GL_ZERO, GL_ONE);
    gl->BindVertexArray(f->vertex_array);
}

static void end(const noh_gl_api *gl, const noh_gl_raster *raster)
{
    gl->BindVertexArray(0);
    noh_gl_raster_put_back(gl, raster);
    gl->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
    gl->ActiveTexture(GL_TEXTURE1);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->UseProgram(0);
}

void noh_stage_floor_draw(const noh_stage_floor *level, const noh_gl_light *light, const noh_lighting *lighting,
                          const noh_stage_view *view, const float disc[4])
{
    const noh_gl_api *gl;
    noh_gl_raster raster;
    noh_lighting near_light;
    noh_stage_view near_by;
    float rows[NOH_LIGHTING_ROWS][4], origin[3];
    NOH_ASSERT(level && level->gl && light && lighting && view && disc);
    gl = level->gl;
    if (!light->desc.shadow_px || view->eye[1] <= disc[1]) return;
    noh_view_origin(view, origin);
    noh_view_less(view, origin, &near_by);
    noh_gl_lighting_less(lighting, origin, &near_light);
    noh_lighting_pack(&near_light, light->desc.shadow_px, rows);
    gl->UseProgram(level->program);
    gl->UniformMatrix4fv(gl->GetUniformLocation(level->program, "u_camera"), 1, GL_FALSE, near_by.view_projection);
    gl->Uniform4f(gl->GetUniformLocation(level->program, "u_disc"), disc[0] - origin[0], disc[1] - origin[1],
                  disc[2] - origin[2], disc[3]);
    gl->Uniform4fv(gl->GetUniformLocation(level->program, "noh_lighting"), (GLsizei)NOH_LIGHTING_ROWS, rows[0]);
    gl->Uniform3f(gl->GetUniformLocation(level->program, "noh_key"), lighting->key_direction[0],
                  lighting->key_direction[1], lighting->key_direction[2]);
    begin(level, light, &raster);
    gl->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, 1);
    end(gl, &raster);
}
