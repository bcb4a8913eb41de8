#include "gl/stage/backdrop.h"

#include <string.h>

#include "gl/device/gl_lost.h"
#include "gl/device/gl_state_internal.h"
#include "gl/device/gl_program.h"
#include "shaders.gen.h"
#include "gl/stage/lit_source_internal.h"

static noh_result create_objects(noh_backdrop *b, char *log, size_t log_bytes, noh_error *error)
{
    static const char *const samplers[] = { "noh_environment" };
    noh_lit_source fragment;
    noh_gl_program_desc desc;
    noh_result result;
    noh_lit_source_of(&noh_shader_backdrop_frag, &fragment);
    memset(&desc, 0, sizeof desc);
    desc.name = "backdrop";
    desc.defines = b->encode_srgb ? "#define NOH_ENCODE_SRGB\n" : NULL;
    desc.vertex = &noh_shader_backdrop_vert;
    desc.fragment = &fragment.source;
    desc.samplers = samplers;
    desc.sampler_count = 1;
    desc.ledger = b->ledger;
    result = noh_gl_program_create(b->gl, &desc, &b->program, log, log_bytes, error);
    if (result == NOH_OK) b->gl->GenVertexArrays(1, &b->vertex_array);
    return result;
}

noh_result noh_backdrop_create(const noh_gl_device *device, int encode_srgb, noh_backdrop *out, noh_error *error)
{
    NOH_ASSERT(device && device->api && device->ledger && out);
    memset(out, 0, sizeof *out);
    out->gl = device->api;
    out->ledger = device->ledger;
    out->encode_srgb = encode_srgb;
    return create_objects(out, device->log, device->log_bytes, error);
}

void noh_backdrop_delete(noh_backdrop *backdrop)
{
    NOH_ASSERT(backdrop && backdrop->gl);
    if (backdrop->vertex_array) backdrop->gl->DeleteVertexArrays(1, &backdrop->vertex_array);
    backdrop->vertex_array = 0;
    noh_gl_program_delete(backdrop->gl, backdrop->ledger, &backdrop->program);
}

noh_result noh_backdrop_restore(noh_backdrop *backdrop, char *log, size_t log_bytes, noh_error *error)
{
    const noh_gl_api *gl;
    NOH_ASSERT(backdrop && backdrop->gl);
    gl = backdrop->gl;
    backdrop->gl = noh_gl_lost_api();
    noh_backdrop_delete(backdrop);
    backdrop->gl = gl;
    return create_objects(backdrop, log, log_bytes, error);
}

/* Rays through the lower left corner, and what a width and a height add, of the length at which they reach one plane.
 */
static void corner_rays(const noh_stage_view *view, float rays[3][4])
{
    static const float corners[3][2] = { { -0.5f, 0.5f }, { 0.5f, 0.5f }, { -0.5f, -0.5f } };
    float origin[3], forward[3] = { 0.0f, 0.0f, -1.0f };
    memset(rays, 0, 12 * sizeof(float));
    (void)noh_view_ray(view, 0.0f, 0.0f, 1, 1, origin, forward);
    for (int i = 0; i < 3; i++) {
        float d[3] = { 0.0f, 0.0f, -1.0f }, along;
        (void)noh_view_ray(view, corners[i][0], corners[i][1], 1, 1, origin, d);
        along = d[0] * forward[0] + d[1] * forward[1] + d[2] * forward[2];
        for (int k = 0; k < 3; k++) rays[i][k] = d[k] / along - (i ? rays[0][k] : 0.0f);
    }
}

/* The light from below and from above, of as many bands as shaders have. */
static void gradient_ends(const noh_lighting *lighting, float ends[2][4])
{
    static const float normals[2][3] = { { 0.0f, -1.0f, 0.0f }, { 0.0f, 1.0f, 0.0f } };
    noh_light rest = lighting->rest;
    if (rest.order > 3u) rest.order = 3u;
    memset(ends, 0, 8 * sizeof(float));
    for (int i = 0; i < 2; i++) {
        noh_light_irradiance(&rest, normals[i], ends[i]);
        for (int k = 0; k < 3; k++) ends[i][k] = ends[i][k] > 0.0f ? ends[i][k] : 0.0f;
    }
}

void noh_backdrop_draw(const noh_backdrop *backdrop, noh_backdrop_kind kind, const noh_gl_light *light,
                       const noh_lighting *lighting, const noh_stage_view *view)
{
    NOH_ASSERT(backdrop && light && lighting && view);
    const noh_gl_api *gl = backdrop->gl;
    const GLuint program = backdrop->program;
    float rows[NOH_LIGHTING_ROWS][4], rays[3][4], ends[2][4];
    noh_gl_raster raster;
    noh_lighting_pack(lighting, 0, rows);
    corner_rays(view, rays);
    gradient_ends(lighting, ends);
    gl->UseProgram(program);
    gl->Uniform4fv(gl->GetUniformLocation(program, "noh_lighting"), (GLsizei)NOH_LIGHTING_ROWS, rows[0]);
    gl->Uniform4fv(gl->GetUniformLocation(program, "u_rays"), 3, rays[0]);
    gl->Uniform4fv(gl->GetUniformLocation(program, "u_ends"), 2, ends[0]);
    gl->Uniform4f(gl->GetUniformLocation(program, "u_kind"), kind == NOH_BACKDROP_LIGHT ? 1.0f : 0.0f, 0.0f, 0.0f,
                  0.0f);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_CUBE_MAP, light->cube.name);
    noh_gl_samplers_none(gl, 0, 1);
    noh_gl_behind_begin(gl, &raster);
    gl->BindVertexArray(backdrop->vertex_array);
    gl->DrawArraysInstanced(GL_TRIANGLES, 0, 3, 1);
    gl->BindVertexArray(0);
    noh_gl_raster_put_back(gl, &raster);
    gl->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
    gl->UseProgram(0);
}
