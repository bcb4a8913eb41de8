#include "core/base/assert_internal.h"
#include "gl/device/gl_api_internal.h"
#include "life/physics/terrain_lod_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

#include <string.h>

#include "gl/device/gl_state_internal.h"
#include "gl/stage/drawable_internal.h"
#include "gl/stage/stage_gl_internal.h"
#include "gl/device/gl_debug_internal.h"
#include "gl/draw/gl_light_internal.h"
#include "shaders.gen.h"

enum { U_CAMERA = NOH_DRAWABLE_OWN, U_ORIGIN, U_SCALE, U_LIGHT, U_FLAT, U_STEEP, U_BLOCK, U_EDGES };

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

static noh_gl_drawable_desc desc_of(const noh_stage_terrain *t)
{
    static const char *const uniforms[] = { "u_view_projection", "u_origin", "u_scale", "u_light", "u_flat",
                                            "u_steep",           "u_block",  "u_edges" };
    return (noh_gl_drawable_desc){ .name = { "terrain", "terrain depth" },
                                   .vertex = &noh_shader_terrain_vert,
                                   .fragment = &noh_shader_terrain_frag,
                                   .defines = noh_gl_encode_define(t->desc.encode_srgb),
                                   .lit = t->desc.lit,
                                   .sampler = "u_heights",
                                   .uniforms = uniforms,
                                   .uniform_count = 8,
                                   .texture = texture_desc(&t->lod.field) };
}

static noh_result upload(noh_stage_terrain *t, noh_error *error)
{
    const noh_gl_api *gl = t->drawable.gl;
    const noh_field *f = &t->lod.field;
    noh_gl_pixels kept;
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, t->drawable.texture.name);
    noh_gl_unpack_begin(gl, &kept);
    gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, (GLsizei)f->width, (GLsizei)f->depth, GL_RED_INTEGER, GL_UNSIGNED_SHORT,
                      f->heights);
    noh_gl_unpack_end(gl, &kept);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    return noh_gl_drawable_check(&t->drawable, error);
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
    NOH_ASSERT(field && out);
    const uint32_t most = field->width > field->depth ? field->width : field->depth;
    noh_result result = noh_gl_device_check(device, 0, error);
    memset(out, 0, sizeof *out);
    if (result) return result;
    if (device->caps && most > device->caps->texture_size_max) {
        return noh_fail(error, NOH_ERR_LIMIT,
                        "the height field is wider than the largest texture: split it or lower its resolution",
                        device->caps->texture_size_max, most);
    }
    result = noh_terrain_lod_init(memory, bytes, field, &out->lod, error);
    if (result) return result;
    if (desc) out->desc = *desc;
    fill_colours(&out->desc);
    const noh_gl_drawable_desc drawable = desc_of(out);
    result = noh_gl_drawable_create(device, &drawable, &out->drawable, error);
    return result ? result : upload(out, error);
}

void noh_stage_terrain_delete(noh_stage_terrain *terrain)
{
    NOH_ASSERT(terrain);
    noh_gl_drawable_delete(&terrain->drawable);
}

noh_result noh_stage_terrain_restore(noh_stage_terrain *terrain, char *log, size_t log_bytes, noh_error *error)
{
    NOH_ASSERT(terrain);
    const noh_gl_drawable_desc desc = desc_of(terrain);
    const noh_result result = noh_gl_drawable_restore(&terrain->drawable, &desc, log, log_bytes, error);
    return result ? result : upload(terrain, error);
}

/* ---- drawing ---- */

void noh_stage_terrain_choose(noh_stage_terrain *terrain, const noh_stage_view *view, float pixels)
{
    NOH_ASSERT(terrain && view);
    noh_terrain_lod_choose(&terrain->lod, view->view_projection, view->eye, view->height_px, pixels);
}

static void begin(const noh_stage_terrain *t, int program, const noh_stage *s, const noh_stage_view *v,
                  noh_gl_raster *raster)
{
    const noh_gl_drawable *d = &t->drawable;
    const noh_gl_api *gl = d->gl;
    const int *uniforms = d->uniforms[program];
    const noh_field *f = &t->lod.field;
    const float *flat = t->desc.flat, *steep = t->desc.steep;
    noh_stage_view near_by;
    float o[3];
    noh_view_origin(v, o);
    noh_view_less(v, o, &near_by);
    noh_gl_drawable_begin(d, program);
    gl->UniformMatrix4fv(uniforms[U_CAMERA], 1, GL_FALSE, near_by.view_projection);
    gl->Uniform4f(uniforms[U_ORIGIN], f->origin[0] - o[0], f->origin[1] - o[1], f->origin[2] - o[2], f->spacing);
    gl->Uniform4f(uniforms[U_SCALE], f->scale, 0.0f, 0.0f, 0.0f);
    gl->Uniform4f(uniforms[U_LIGHT], v->light[0], v->light[1], v->light[2], 0.0f);
    gl->Uniform4f(uniforms[U_FLAT], flat[0], flat[1], flat[2], 1.0f);
    gl->Uniform4f(uniforms[U_STEEP], steep[0], steep[1], steep[2], 1.0f);
    if (t->desc.lit && s && program == NOH_DRAWABLE_COLOR) {
        const noh_stage_gl *of = s->gpu;
        if (noh_stage_light_of(s) && of->lighting) noh_gl_drawable_light(d, of->light, of->lighting, o);
    }
    noh_gl_tests_begin(gl, raster);
    gl->Disable(GL_CULL_FACE);
}

static void draw_blocks(noh_stage_terrain *t, int program, int all)
{
    const noh_gl_api *gl = t->drawable.gl;
    const int *uniforms = t->drawable.uniforms[program];
    t->draws = t->triangles = 0;
    for (uint32_t i = 0; i < t->lod.width * t->lod.depth; i++) {
        const noh_terrain_piece p = noh_terrain_lod_block(&t->lod, i);
        if (!all && !t->lod.seen[i]) continue;
        gl->Uniform4i(uniforms[U_BLOCK], (GLint)p.column, (GLint)p.row, (GLint)p.side, (GLint)p.step);
        gl->Uniform4i(uniforms[U_EDGES], (GLint)p.edges[0], (GLint)p.edges[1], (GLint)p.edges[2], (GLint)p.edges[3]);
        gl->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, (GLsizei)(2u * (p.side + 1u)), (GLsizei)p.side);
        t->draws++;
        t->triangles += 2u * p.side * p.side;
    }
}

void noh_stage_terrain_draw(noh_stage_terrain *terrain, const noh_stage *stage, const noh_stage_view *view)
{
    noh_gl_raster raster;
    NOH_ASSERT(terrain && terrain->drawable.gl && view);
    noh_gl_group_begin(terrain->drawable.gl, "noh terrain", NULL);
    begin(terrain, NOH_DRAWABLE_COLOR, stage, view, &raster);
    draw_blocks(terrain, NOH_DRAWABLE_COLOR, 0);
    noh_gl_drawable_end(&terrain->drawable, &raster);
    noh_gl_group_end(terrain->drawable.gl);
}

void noh_stage_terrain_draw_shadow(noh_stage_terrain *terrain, const noh_stage *stage, const noh_stage_view *view)
{
    noh_gl_raster raster;
    NOH_ASSERT(terrain && terrain->drawable.gl && stage && view);
    const noh_stage_gl *gl = stage->gpu;
    const noh_gl_light *light = noh_stage_light_of(stage);
    if (!light || !light->framebuffer) return;
    noh_gl_group_begin(terrain->drawable.gl, "noh terrain's shadow", NULL);
    noh_gl_light_bind_shadow(light);
    begin(terrain, NOH_DRAWABLE_DEPTH, NULL, view, &raster);
    noh_gl_depth_only_begin(terrain->drawable.gl, &raster);
    draw_blocks(terrain, NOH_DRAWABLE_DEPTH, 1);
    noh_gl_drawable_end(&terrain->drawable, &raster);
    noh_gl_light_end_shadow(light, view->view_projection, gl->lighting);
}
