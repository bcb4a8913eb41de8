#include "core/base/assert.h"
#include "gl/draw/gl_light.h"
#include "life/hair/haircut.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

#include <string.h>

#include "gl/device/gl_state_internal.h"
#include "shaders.gen.h"
#include "gl/stage/stage_gl_internal.h"
#include "gl/stage/stage_hair_internal.h"

#define PIECES_MAX 8u
#define ROW_TEXELS 1024u  /* of a crowd's texture, at most */
#define PIECE_TEXELS 128u /* uploaded at a time */

/* ---- bytes ---- */

static size_t point_count(const noh_haircut *cut)
{
    return (size_t)cut->header->hair_count * cut->header->point_count;
}

noh_hair_layout noh_hair_layout_of(const noh_haircut *cut, uint32_t sets, uint32_t bodies)
{
    const noh_pack_hair_header *h = cut->header;
    const uint32_t hairs = h->hair_count * (sets ? sets : 1u);
    noh_hair_layout l;
    l.in_row = sets && h->point_count < ROW_TEXELS ? ROW_TEXELS / h->point_count : 1u;
    l.width = l.in_row * h->point_count;
    l.patches = (hairs + l.in_row - 1u) / l.in_row;
    l.bodies = l.patches + (2u * h->patch_count + l.width - 1u) / l.width;
    l.height = l.bodies + (NOH_HAIR_BODY_TEXELS * bodies + l.width - 1u) / l.width;
    return l;
}

noh_gl_texture_desc noh_hair_texture(const noh_haircut *cut, uint32_t sets, uint32_t bodies)
{
    const noh_hair_layout l = noh_hair_layout_of(cut, sets, bodies);
    noh_gl_texture_desc d;
    memset(&d, 0, sizeof d);
    d.format = GL_RGB32F;
    d.width = l.width;
    d.height = l.height;
    return d;
}

size_t noh_stage_hair_size(const noh_haircut *cut)
{
    noh_arena arena = noh_arena_measure();
    NOH_ASSERT(cut);
    (void)noh_arena_carve(&arena, point_count(cut) * 3u * sizeof(float), 16);
    return arena.used;
}

uint64_t noh_stage_hair_bytes(const noh_haircut *cut)
{
    const noh_gl_texture_desc d = noh_hair_texture(cut, 0, 0);
    return noh_gl_texture_bytes(&d);
}

/* ---- GL objects ---- */

static noh_result create_program(const noh_stage_hair *h, int depth, GLuint *program, char *log, size_t log_bytes,
                                 noh_error *error)
{
    static const char *const samplers[] = { "u_points", "noh_environment", "noh_shadow_map" };
    const char *pieces[PIECES_MAX] = { "precision highp float;\nprecision highp int;\n",
                                       depth    ? "#define NOH_DEPTH_ONLY\n"
                                       : h->lit ? "#define NOH_LIT\n"
                                                : "",
                                       noh_gl_shader_text("common_fade.glsl"),
                                       noh_gl_shader_text("common_fragment.glsl"),
                                       noh_gl_shader_text("common_environment.glsl") };
    noh_gl_source fragment = noh_shader_hair_frag;
    noh_gl_program_desc desc;
    NOH_ASSERT(5u + fragment.piece_count <= PIECES_MAX);
    for (uint32_t i = 0; i < fragment.piece_count; i++) pieces[5u + i] = fragment.pieces[i];
    fragment.piece_count += 5u;
    fragment.pieces = pieces;
    memset(&desc, 0, sizeof desc);
    desc.name = depth ? "hair depth" : "hair";
    desc.defines = h->encode_srgb ? "#define NOH_ENCODE_SRGB\n" : NULL;
    desc.vertex = &noh_shader_hair_vert;
    desc.fragment = &fragment;
    desc.samplers = samplers;
    desc.sampler_count = 3;
    desc.ledger = h->ledger;
    return noh_gl_program_create(h->gl, &desc, program, log, log_bytes, error);
}

/* The corners of patches never change. */
static void upload_patches(const noh_stage_hair *h)
{
    const noh_haircut *cut = h->wig->cut;
    const noh_hair_layout l = noh_hair_layout_of(cut, h->sets, h->bodies);
    const uint32_t all = 2u * cut->header->patch_count;
    float piece[3u * PIECE_TEXELS];
    noh_gl_pixels kept;
    noh_gl_unpack_begin(h->gl, &kept);
    for (uint32_t at = 0; at < all;) {
        const uint32_t x = at % l.width, in_row = l.width - x, left = all - at;
        uint32_t count = in_row < left ? in_row : left;
        count = count < PIECE_TEXELS ? count : PIECE_TEXELS;
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t *corners = cut->patches + 2u * (size_t)(at + i);
            piece[3u * i] = (float)corners[0];
            piece[3u * i + 1u] = (float)corners[1];
            piece[3u * i + 2u] = 0.0f;
        }
        h->gl->TexSubImage2D(GL_TEXTURE_2D, 0, (GLint)x, (GLint)(l.patches + at / l.width), (GLsizei)count, 1, GL_RGB,
                             GL_FLOAT, piece);
        at += count;
    }
    noh_gl_unpack_end(h->gl, &kept);
}

void noh_hair_upload(const noh_stage_hair *h, uint32_t set)
{
    const noh_pack_hair_header *head = h->wig->cut->header;
    const noh_hair_layout l = noh_hair_layout_of(h->wig->cut, h->sets, h->bodies);
    const uint32_t first = set * head->hair_count;
    noh_gl_pixels kept;
    h->gl->ActiveTexture(GL_TEXTURE0);
    h->gl->BindTexture(GL_TEXTURE_2D, h->texture.name);
    noh_gl_unpack_begin(h->gl, &kept);
    for (uint32_t at = 0; at < head->hair_count;) {
        const uint32_t x = (first + at) % l.in_row, left = head->hair_count - at, room = l.in_row - x;
        const uint32_t rows = x || left < room ? 1u : left / l.in_row;
        const uint32_t hairs = rows > 1u ? l.in_row : left < room ? left : room;
        h->gl->TexSubImage2D(GL_TEXTURE_2D, 0, (GLint)(x * head->point_count), (GLint)((first + at) / l.in_row),
                             (GLsizei)(hairs * head->point_count), (GLsizei)rows, GL_RGB, GL_FLOAT,
                             h->points + 3u * (size_t)at * head->point_count);
        at += hairs * rows;
    }
    noh_gl_unpack_end(h->gl, &kept);
}

noh_result noh_hair_create_objects(noh_stage_hair *h, char *log, size_t log_bytes, noh_error *error)
{
    const noh_gl_texture_desc d = noh_hair_texture(h->wig->cut, h->sets, h->bodies);
    noh_result result = noh_gl_texture_create(h->gl, h->ledger, &d, &h->texture, error);
    if (!result) result = create_program(h, 0, &h->color, log, log_bytes, error);
    if (!result) result = create_program(h, 1, &h->depth, log, log_bytes, error);
    if (result) {
        noh_stage_hair_delete(h);
        return result;
    }
    h->gl->GenVertexArrays(1, &h->vertex_array);
    noh_hair_upload(h, 0);
    upload_patches(h);
    h->gl->BindTexture(GL_TEXTURE_2D, 0);
    return NOH_OK;
}

noh_result noh_stage_hair_create(const noh_gl_device *device, const noh_wig *wig, void *memory, size_t bytes, int lit,
                                 int encode_srgb, noh_stage_hair *out, noh_error *error)
{
    noh_arena arena;
    NOH_ASSERT(device && device->api && device->ledger && wig && out);
    const noh_result result = noh_arena_open(&arena, memory, bytes, noh_stage_hair_size(wig->cut), error);
    if (result) return result;
    memset(out, 0, sizeof *out);
    out->points = noh_arena_carve(&arena, point_count(wig->cut) * 3u * sizeof(float), 16);
    out->gl = device->api;
    out->ledger = device->ledger;
    out->wig = wig;
    out->lit = lit;
    out->encode_srgb = encode_srgb;
    noh_wig_points(wig, NULL, out->points);
    return noh_hair_create_objects(out, device->log, device->log_bytes, error);
}

void noh_stage_hair_delete(noh_stage_hair *hair)
{
    NOH_ASSERT(hair && hair->gl);
    if (hair->vertex_array) hair->gl->DeleteVertexArrays(1, &hair->vertex_array);
    hair->vertex_array = 0;
    noh_gl_program_delete(hair->gl, hair->ledger, &hair->color);
    noh_gl_program_delete(hair->gl, hair->ledger, &hair->depth);
    noh_gl_texture_delete(hair->gl, hair->ledger, &hair->texture);
}

noh_result noh_stage_hair_restore(noh_stage_hair *hair, char *log, size_t log_bytes, noh_error *error)
{
    const noh_gl_api *gl;
    NOH_ASSERT(hair && hair->gl);
    gl = hair->gl;
    hair->gl = noh_gl_lost_api();
    noh_stage_hair_delete(hair);
    hair->gl = gl;
    return noh_hair_create_objects(hair, log, log_bytes, error);
}

/* ---- where it is ---- */

noh_result noh_stage_hair_update(noh_stage_hair *hair, noh_stage *stage, noh_actor actor, uint32_t part,
                                 noh_error *error)
{
    NOH_ASSERT(hair && stage);
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    const void *state = noh_actor_part(stage, actor, part);
    hair->views = 0;
    if (!a || !state) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "the actor is gone, has no such part, or a frame has begun", part, 0);
    }
    if (!noh_wig_seen(hair->wig, stage, actor, hair->world, &hair->pixels_per_metre, &hair->views)) return NOH_OK;
    noh_wig_points(hair->wig, state, hair->points);
    noh_hair_upload(hair, 0);
    hair->gl->BindTexture(GL_TEXTURE_2D, 0);
    return NOH_OK;
}

/* ---- drawing ---- */

static GLint named(const noh_stage_hair *h, GLuint program, const char *name)
{
    return h->gl->GetUniformLocation(program, name);
}

/* strips  0: each body of a crowd has its own */
static void set_shape(const noh_stage_hair *h, GLuint program, uint32_t strips)
{
    const noh_pack_hair_header *d = h->wig->cut->header;
    const noh_hair_layout l = noh_hair_layout_of(h->wig->cut, h->sets, h->bodies);
    const float widen = 0.5f * noh_haircut_widen(h->wig->cut, strips);
    const float middle[4] = { d->middle[0], d->middle[1], d->middle[2], 0.0f };
    const float root[4] = { d->color_root[0], d->color_root[1], d->color_root[2], 1.0f };
    const float tip[4] = { d->color_tip[0], d->color_tip[1], d->color_tip[2], 1.0f };
    h->gl->Uniform4f(named(h, program, "u_counts"), (float)d->point_count, (float)l.patches, (float)d->patch_count,
                     (float)d->segment_count);
    h->gl->Uniform4f(named(h, program, "u_widths"), widen * d->width_root, widen * d->width_tip, d->scatter, d->gloss);
    h->gl->Uniform4f(named(h, program, "u_curl"), d->curl_radius, d->curl_turns, noh_haircut_fade(h->pixels_per_metre),
                     (float)l.in_row);
    h->gl->Uniform4f(named(h, program, "u_crowd"), 0.0f, 0.0f, 0.0f, 0.0f);
    h->gl->Uniform4fv(named(h, program, "u_middle"), 1, middle);
    h->gl->Uniform4fv(named(h, program, "u_root"), 1, root);
    h->gl->Uniform4fv(named(h, program, "u_tip"), 1, tip);
    h->gl->Uniform4fv(named(h, program, "u_world"), 3, h->world);
}

void noh_hair_bind(const noh_stage_hair *h, const noh_stage *s, GLuint program, const noh_stage_view *v,
                   uint32_t strips)
{
    const noh_stage_gl *gl = s->gpu;
    const noh_gl_api *api = h->gl;
    api->UseProgram(program);
    noh_gl_samplers_none(api, 0, 3);
    set_shape(h, program, strips);
    api->UniformMatrix4fv(named(h, program, "u_view_projection"), 1, GL_FALSE, v->view_projection);
    api->Uniform4f(named(h, program, "u_eye"), v->eye[0], v->eye[1], v->eye[2], v->height_px ? 1.0f : 0.0f);
    api->Uniform4f(named(h, program, "u_light"), v->light[0], v->light[1], v->light[2], 0.0f);
    if (h->lit && gl->light && gl->lighting && program == h->color) {
        float rows[NOH_LIGHTING_ROWS][4];
        const float *key = gl->lighting->key_direction;
        noh_lighting near_by;
        noh_gl_lighting_less(gl->lighting, s->origin, &near_by);
        noh_lighting_pack(&near_by, gl->light->desc.shadow_px, rows);
        api->Uniform4fv(named(h, program, "noh_lighting"), (GLsizei)NOH_LIGHTING_ROWS, rows[0]);
        api->Uniform3f(named(h, program, "noh_key"), key[0], key[1], key[2]);
        api->ActiveTexture(GL_TEXTURE1);
        api->BindTexture(GL_TEXTURE_CUBE_MAP, gl->light->cube.name);
        api->ActiveTexture(GL_TEXTURE2);
        api->BindTexture(GL_TEXTURE_2D, gl->light->shadow.name);
    }
    api->ActiveTexture(GL_TEXTURE0);
    api->BindTexture(GL_TEXTURE_2D, h->texture.name);
    api->BindVertexArray(h->vertex_array);
}

void noh_hair_unbind(const noh_stage_hair *h)
{
    const noh_gl_api *api = h->gl;
    api->BindVertexArray(0);
    api->ActiveTexture(GL_TEXTURE2);
    api->BindTexture(GL_TEXTURE_2D, 0);
    api->ActiveTexture(GL_TEXTURE1);
    api->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
    api->ActiveTexture(GL_TEXTURE0);
    api->BindTexture(GL_TEXTURE_2D, 0);
    api->UseProgram(0);
}

void noh_hair_draw_strips(noh_stage_hair *h, GLuint program, uint32_t strips, float low, float high)
{
    const uint32_t vertices = 2u * (h->wig->cut->header->segment_count + 1u);
    h->gl->Uniform4f(named(h, program, "u_alpha"), low, high, 0.0f, 0.0f);
    h->gl->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, (GLsizei)vertices, (GLsizei)strips);
    h->draws++;
}

void noh_hair_draw_pass(noh_stage_hair *h, const noh_stage *s, uint32_t view, noh_pass pass, uint32_t strips,
                        noh_hair_strips_fn fn, void *user)
{
    const noh_gl_api *gl = h->gl;
    const GLuint program = pass == NOH_PASS_DEPTH ? h->depth : h->color;
    noh_gl_raster raster;
    noh_hair_bind(h, s, program, &s->views[view], strips);
    noh_gl_tests_begin(gl, &raster);
    gl->Disable(GL_CULL_FACE);
    if (pass == NOH_PASS_DEPTH) noh_gl_depth_only_begin(gl, &raster);
    if (pass != NOH_PASS_BLENDED) fn(user, program, 0.9f, 2.0f);
    if (pass != NOH_PASS_OPAQUE && pass != NOH_PASS_DEPTH) {
        noh_gl_blend_begin(gl, &raster);
        fn(user, program, 0.01f, 0.9f);
    }
    noh_gl_raster_put_back(gl, &raster);
    noh_hair_unbind(h);
}

/* ---- of one actor ---- */

static void draw_one(void *user, GLuint program, float low, float high)
{
    noh_stage_hair *h = user;
    noh_hair_draw_strips(h, program, noh_haircut_strips(h->wig->cut, h->pixels_per_metre), low, high);
}

void noh_stage_hair_draw(noh_stage_hair *hair, const noh_stage *stage, uint32_t view, noh_pass pass)
{
    NOH_ASSERT(stage && stage->gpu);
    const uint32_t strips = noh_haircut_strips(hair->wig->cut, hair->pixels_per_metre);
    if (view >= stage->view_count || !(hair->views >> view & 1u) || !strips) return;
    noh_hair_draw_pass(hair, stage, view, pass, strips, draw_one, hair);
}

int noh_hair_begin_shadow(const noh_stage_hair *h, const noh_stage *stage)
{
    const noh_stage_gl *gl = stage->gpu;
    NOH_ASSERT(gl);
    if (!gl->light || !gl->light->framebuffer) return 0;
    noh_gl_group_begin(h->gl, "noh hair's shadow", NULL);
    noh_gl_light_bind_shadow(gl->light);
    return 1;
}

void noh_stage_hair_draw_shadow(noh_stage_hair *hair, const noh_stage *stage, uint32_t view)
{
    if (!noh_hair_begin_shadow(hair, stage)) return;
    noh_stage_hair_draw(hair, stage, view, NOH_PASS_DEPTH);
    noh_gl_light_end_shadow(((const noh_stage_gl *)stage->gpu)->light);
}
