#include "gl/stage/stage_terrain.h"

#include <string.h>

#include "gl/device/gl_debug.h"
#include "gl/device/gl_lost.h"
#include "gl/device/gl_state_internal.h"
#include "gl/device/gl_program.h"
#include "gl/device/gl_shader_text.h"
#include "shaders.gen.h"
#include "gl/stage/stage_gl_internal.h"

#define PIECES_MAX 8u

/* ---- bytes ---- */

static noh_gl_texture_desc texture_desc(const noh_field *field)
{
    noh_gl_texture_desc d;
    memset(&d, 0, sizeof d);
    d.format = GL_R16UI;
    d.width = field->width;
    d.height = field->depth;
    return d;
}

size_t noh_stage_terrain_size(const noh_field *field)
{
    return noh_terrain_lod_size(field);
}

uint64_t noh_stage_terrain_bytes(const noh_field *field)
{
    const noh_gl_texture_desc d = texture_desc(field);
    return noh_gl_texture_bytes(&d);
}

/* ---- GL objects ---- */

static noh_result create_program(const noh_stage_terrain *t, int depth, GLuint *program, char *log, size_t log_bytes,
                                 noh_error *error)
{
    static const char *const samplers[] = { "u_heights", "noh_environment", "noh_shadow_map" };
    const char *pieces[PIECES_MAX] = { "precision highp float;\nprecision highp int;\n",
                                       depth         ? "#define NOH_DEPTH_ONLY\n"
                                       : t->desc.lit ? "#define NOH_LIT\n"
                                                     : "",
                                       noh_gl_shader_text("common_fade.glsl"),
                                       noh_gl_shader_text("common_fragment.glsl"),
                                       noh_gl_shader_text("common_environment.glsl") };
    noh_gl_source fragment = noh_shader_terrain_frag;
    noh_gl_program_desc desc;
    NOH_ASSERT(5u + fragment.piece_count <= PIECES_MAX);
    for (uint32_t i = 0; i < fragment.piece_count; i++) pieces[5u + i] = fragment.pieces[i];
    fragment.piece_count += 5u;
    fragment.pieces = pieces;
    memset(&desc, 0, sizeof desc);
    desc.name = depth ? "terrain depth" : "terrain";
    desc.defines = t->desc.encode_srgb ? "#define NOH_ENCODE_SRGB\n" : NULL;
    desc.vertex = &noh_shader_terrain_vert;
    desc.fragment = &fragment;
    desc.samplers = samplers;
    desc.sampler_count = 3;
    desc.ledger = t->ledger;
    return noh_gl_program_create(t->gl, &desc, program, log, log_bytes, error);
}

static void upload(const noh_stage_terrain *t)
{
    const noh_field *f = &t->lod.field;
    noh_gl_pixels kept;
    t->gl->ActiveTexture(GL_TEXTURE0);
    t->gl->BindTexture(GL_TEXTURE_2D, t->heights.name);
    noh_gl_unpack_begin(t->gl, &kept);
    t->gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, (GLsizei)f->width, (GLsizei)f->depth, GL_RED_INTEGER,
                         GL_UNSIGNED_SHORT, f->heights);
    noh_gl_unpack_end(t->gl, &kept);
    t->gl->BindTexture(GL_TEXTURE_2D, 0);
}

static noh_result create_objects(noh_stage_terrain *t, char *log, size_t log_bytes, noh_error *error)
{
    const noh_gl_texture_desc d = texture_desc(&t->lod.field);
    noh_result result = noh_gl_texture_create(t->gl, t->ledger, &d, &t->heights, error);
    if (!result) result = create_program(t, 0, &t->color, log, log_bytes, error);
    if (!result) result = create_program(t, 1, &t->depth, log, log_bytes, error);
    if (result) {
        noh_stage_terrain_delete(t);
        return result;
    }
    t->gl->GenVertexArrays(1, &t->vertex_array);
    upload(t);
    return NOH_OK;
}

static void fill_colours(noh_stage_terrain_desc *d)
{
    static const float grass[3] = { 0.17f, 0.21f, 0.09f }, rock[3] = { 0.25f, 0.22f, 0.19f };
    if (d->flat[0] + d->flat[1] + d->flat[2] <= 0.0f) memcpy(d->flat, grass, sizeof grass);
    if (d->steep[0] + d->steep[1] + d->steep[2] <= 0.0f) memcpy(d->steep, rock, sizeof rock);
}

noh_result noh_stage_terrain_create(const noh_gl_device *device, const noh_field *field,
                                    const noh_stage_terrain_desc *desc, void *memory, size_t bytes,
                                    noh_stage_terrain *out, noh_error *error)
{
    NOH_ASSERT(device && device->api && device->ledger && field && out);
    const uint32_t most = field->width > field->depth ? field->width : field->depth;
    memset(out, 0, sizeof *out);
    if (device->caps && most > device->caps->texture_size_max) {
        return noh_fail(error, NOH_ERR_LIMIT, "a terrain has more heights along a side than a texture has texels",
                        device->caps->texture_size_max, most);
    }
    const noh_result result = noh_terrain_lod_init(memory, bytes, field, &out->lod, error);
    if (result) return result;
    out->gl = device->api;
    out->ledger = device->ledger;
    if (desc) out->desc = *desc;
    fill_colours(&out->desc);
    return create_objects(out, device->log, device->log_bytes, error);
}

void noh_stage_terrain_delete(noh_stage_terrain *terrain)
{
    NOH_ASSERT(terrain && terrain->gl);
    if (terrain->vertex_array) terrain->gl->DeleteVertexArrays(1, &terrain->vertex_array);
    terrain->vertex_array = 0;
    noh_gl_program_delete(terrain->gl, terrain->ledger, &terrain->color);
    noh_gl_program_delete(terrain->gl, terrain->ledger, &terrain->depth);
    noh_gl_texture_delete(terrain->gl, terrain->ledger, &terrain->heights);
}

noh_result noh_stage_terrain_restore(noh_stage_terrain *terrain, char *log, size_t log_bytes, noh_error *error)
{
    const noh_gl_api *gl;
    NOH_ASSERT(terrain && terrain->gl);
    gl = terrain->gl;
    terrain->gl = noh_gl_lost_api();
    noh_stage_terrain_delete(terrain);
    terrain->gl = gl;
    return create_objects(terrain, log, log_bytes, error);
}

/* ---- drawing ---- */

void noh_stage_terrain_choose(noh_stage_terrain *terrain, const noh_stage_view *view, float pixels)
{
    NOH_ASSERT(terrain && view);
    noh_terrain_lod_choose(&terrain->lod, view->view_projection, view->eye, view->height_px, pixels);
}

static GLint named(const noh_stage_terrain *t, GLuint program, const char *name)
{
    return t->gl->GetUniformLocation(program, name);
}

static void bind_light(const noh_stage_terrain *t, const noh_stage *s, const noh_stage_view *v)
{
    const noh_stage_gl *gl = s->gpu;
    const noh_gl_api *api = t->gl;
    float rows[NOH_LIGHTING_ROWS][4], origin[3];
    noh_lighting near_by;
    if (!gl->light || !gl->lighting) return;
    const float *key = gl->lighting->key_direction;
    noh_view_origin(v, origin);
    noh_gl_lighting_less(gl->lighting, origin, &near_by);
    noh_lighting_pack(&near_by, gl->light->desc.shadow_px, rows);
    api->Uniform4fv(named(t, t->color, "noh_lighting"), (GLsizei)NOH_LIGHTING_ROWS, rows[0]);
    api->Uniform3f(named(t, t->color, "noh_key"), key[0], key[1], key[2]);
    api->ActiveTexture(GL_TEXTURE1);
    api->BindTexture(GL_TEXTURE_CUBE_MAP, gl->light->cube.name);
    api->ActiveTexture(GL_TEXTURE2);
    api->BindTexture(GL_TEXTURE_2D, gl->light->shadow.name);
}

static void bind(const noh_stage_terrain *t, GLuint program, const noh_stage_view *v, noh_gl_raster *raster)
{
    const noh_gl_api *api = t->gl;
    const noh_field *f = &t->lod.field;
    const float *flat = t->desc.flat, *steep = t->desc.steep;
    noh_stage_view near_by;
    float o[3];
    noh_view_origin(v, o);
    noh_view_less(v, o, &near_by);
    api->UseProgram(program);
    api->UniformMatrix4fv(named(t, program, "u_view_projection"), 1, GL_FALSE, near_by.view_projection);
    api->Uniform4f(named(t, program, "u_origin"), f->origin[0] - o[0], f->origin[1] - o[1], f->origin[2] - o[2],
                   f->spacing);
    api->Uniform4f(named(t, program, "u_scale"), f->scale, 0.0f, 0.0f, 0.0f);
    api->Uniform4f(named(t, program, "u_light"), v->light[0], v->light[1], v->light[2], 0.0f);
    api->Uniform4f(named(t, program, "u_flat"), flat[0], flat[1], flat[2], 1.0f);
    api->Uniform4f(named(t, program, "u_steep"), steep[0], steep[1], steep[2], 1.0f);
    api->ActiveTexture(GL_TEXTURE0);
    api->BindTexture(GL_TEXTURE_2D, t->heights.name);
    api->BindVertexArray(t->vertex_array);
    noh_gl_samplers_none(api, 0, 3);
    noh_gl_tests_begin(api, raster);
    api->Disable(GL_CULL_FACE);
}

static void unbind(const noh_stage_terrain *t)
{
    const noh_gl_api *api = t->gl;
    api->BindVertexArray(0);
    api->ActiveTexture(GL_TEXTURE2);
    api->BindTexture(GL_TEXTURE_2D, 0);
    api->ActiveTexture(GL_TEXTURE1);
    api->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
    api->ActiveTexture(GL_TEXTURE0);
    api->BindTexture(GL_TEXTURE_2D, 0);
    api->UseProgram(0);
}

static void draw_blocks(noh_stage_terrain *t, GLuint program, int all)
{
    const GLint block = named(t, program, "u_block"), edges = named(t, program, "u_edges");
    t->draws = t->triangles = 0;
    for (uint32_t i = 0; i < t->lod.width * t->lod.depth; i++) {
        const noh_terrain_piece p = noh_terrain_lod_block(&t->lod, i);
        if (!all && !t->lod.seen[i]) continue;
        t->gl->Uniform4i(block, (GLint)p.column, (GLint)p.row, (GLint)p.side, (GLint)p.step);
        t->gl->Uniform4i(edges, (GLint)p.edges[0], (GLint)p.edges[1], (GLint)p.edges[2], (GLint)p.edges[3]);
        t->gl->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, (GLsizei)(2u * (p.side + 1u)), (GLsizei)p.side);
        t->draws++;
        t->triangles += 2u * p.side * p.side;
    }
}

void noh_stage_terrain_draw(noh_stage_terrain *terrain, const noh_stage *stage, const noh_stage_view *view)
{
    noh_gl_raster raster;
    NOH_ASSERT(terrain && view);
    noh_gl_group_begin(terrain->gl, "noh terrain", NULL);
    bind(terrain, terrain->color, view, &raster);
    if (terrain->desc.lit && stage) bind_light(terrain, stage, view);
    draw_blocks(terrain, terrain->color, 0);
    noh_gl_raster_put_back(terrain->gl, &raster);
    unbind(terrain);
    noh_gl_group_end(terrain->gl);
}

void noh_stage_terrain_draw_shadow(noh_stage_terrain *terrain, const noh_stage *stage, const noh_stage_view *view)
{
    const noh_stage_gl *gl = stage->gpu;
    noh_gl_raster raster;
    NOH_ASSERT(terrain && gl && view);
    if (!gl->light || !gl->light->framebuffer) return;
    noh_gl_group_begin(terrain->gl, "noh terrain's shadow", NULL);
    noh_gl_light_bind_shadow(gl->light);
    bind(terrain, terrain->depth, view, &raster);
    noh_gl_depth_only_begin(terrain->gl, &raster);
    draw_blocks(terrain, terrain->depth, 1);
    noh_gl_raster_put_back(terrain->gl, &raster);
    unbind(terrain);
    noh_gl_light_end_shadow(gl->light);
}
