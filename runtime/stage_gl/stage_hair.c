#include "stage_gl/stage_hair.h"

#include <string.h>

#include "base/arena.h"
#include "base/quat.h"
#include "gl/gl_debug.h"
#include "gl/gl_lost.h"
#include "gl/gl_program.h"
#include "gl/gl_shader_text.h"
#include "pose/local_to_model.h"
#include "shaders.gen.h"
#include "stage_gl/stage_gl_internal.h"

#define PIECES_MAX 8u
#define VERTICES_OF(segments) (2u * ((segments) + 1u))

/* ---- bytes ---- */

static size_t point_count(const noh_haircut *cut)
{
    return (size_t)cut->header->hair_count * cut->header->point_count;
}

/* Rows of corners: two texels a patch. */
static uint32_t patch_rows(const noh_haircut *cut)
{
    const uint32_t width = cut->header->point_count;
    return (2u * cut->header->patch_count + width - 1u) / width;
}

static noh_gl_texture_desc texture_desc(const noh_haircut *cut)
{
    noh_gl_texture_desc d;
    memset(&d, 0, sizeof d);
    d.format = GL_RGB32F;
    d.width = cut->header->point_count;
    d.height = cut->header->hair_count + patch_rows(cut);
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
    const noh_gl_texture_desc d = texture_desc(cut);
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
    const uint32_t width = cut->header->point_count;
    float row[3u * NOH_HAIR_POINTS_MAX];
    for (uint32_t y = 0; y < patch_rows(cut); y++) {
        memset(row, 0, sizeof row);
        for (uint32_t x = 0; x < width; x++) {
            const uint32_t texel = y * width + x, patch = texel / 2u;
            if (patch >= cut->header->patch_count) break;
            row[3u * x] = (float)cut->patches[4u * patch + 2u * (texel & 1u)];
            row[3u * x + 1u] = (float)cut->patches[4u * patch + 2u * (texel & 1u) + 1u];
        }
        h->gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, (GLint)(cut->header->hair_count + y), (GLsizei)width, 1, GL_RGB,
                             GL_FLOAT, row);
    }
}

static void upload_points(const noh_stage_hair *h)
{
    const noh_pack_hair_header *head = h->wig->cut->header;
    h->gl->ActiveTexture(GL_TEXTURE0);
    h->gl->BindTexture(GL_TEXTURE_2D, h->texture.name);
    h->gl->PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    h->gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, (GLsizei)head->point_count, (GLsizei)head->hair_count, GL_RGB,
                         GL_FLOAT, h->points);
}

static noh_result create_objects(noh_stage_hair *h, char *log, size_t log_bytes, noh_error *error)
{
    const noh_gl_texture_desc d = texture_desc(h->wig->cut);
    noh_result result = noh_gl_texture_create(h->gl, h->ledger, &d, &h->texture, error);
    if (!result) result = create_program(h, 0, &h->color, log, log_bytes, error);
    if (!result) result = create_program(h, 1, &h->depth, log, log_bytes, error);
    if (result) {
        noh_stage_hair_delete(h);
        return result;
    }
    h->gl->GenVertexArrays(1, &h->vertex_array);
    upload_points(h);
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
    return create_objects(out, device->log, device->log_bytes, error);
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
    return create_objects(hair, log, log_bytes, error);
}

/* ---- where it is ---- */

/* From head space into the world, as the actor is shown. */
static void place(noh_stage_hair *h, const noh_stage *s, const noh_stage_kind *k, noh_actor actor,
                  const noh_stage_shown *shown)
{
    const float units = 1.0f / h->wig->cut->header->metres;
    float to_joint[12] = { units, 0.0f, 0.0f, 0.0f, 0.0f, units, 0.0f, 0.0f, 0.0f, 0.0f, units, 0.0f };
    float joint[12], rotation[4], at[3];
    memcpy(joint, shown->world, sizeof joint);
    if (h->wig->joint < k->skeleton.joint_count && noh_actor_joint(s, actor, h->wig->joint, joint, NULL) == NOH_OK) {
        noh_stage_joint_at(k, k->skeleton.bind_pose, h->wig->joint, rotation, at);
        noh_quat_conjugate(rotation, rotation);
        for (int i = 0; i < 3; i++) {
            float axis[3] = { i == 0 ? units : 0.0f, i == 1 ? units : 0.0f, i == 2 ? units : 0.0f };
            noh_quat_rotate(rotation, axis, axis);
            for (int r = 0; r < 3; r++) to_joint[4 * r + i] = axis[r];
        }
        noh_quat_rotate(rotation, at, at);
        for (int r = 0; r < 3; r++) to_joint[4 * r + 3] = -at[r];
    }
    noh_matrix_multiply(joint, to_joint, h->world);
}

noh_result noh_stage_hair_update(noh_stage_hair *hair, noh_stage *stage, noh_actor actor, uint32_t part,
                                 noh_error *error)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    const void *state = noh_actor_part(stage, actor, part);
    NOH_ASSERT(hair && stage);
    hair->views = 0;
    if (!a || !state) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "the actor is gone, has no such part, or a frame has begun", part, 0);
    }
    const noh_stage_shown *shown = &stage->shown[a - stage->actors];
    if (shown->frame != stage->frame) return NOH_OK;
    hair->views = shown->views;
    hair->pixels_per_metre = shown->scale / hair->wig->cut->header->metres * a->place.scale;
    place(hair, stage, k, actor, shown);
    noh_wig_points(hair->wig, state, hair->points);
    upload_points(hair);
    hair->gl->BindTexture(GL_TEXTURE_2D, 0);
    return NOH_OK;
}

/* ---- drawing ---- */

static GLint named(const noh_stage_hair *h, GLuint program, const char *name)
{
    return h->gl->GetUniformLocation(program, name);
}

static void set_shape(const noh_stage_hair *h, GLuint program, uint32_t strips)
{
    const noh_pack_hair_header *d = h->wig->cut->header;
    const float widen = 0.5f * noh_haircut_widen(h->wig->cut, strips);
    const float middle[4] = { d->middle[0], d->middle[1], d->middle[2], 0.0f };
    const float root[4] = { d->color_root[0], d->color_root[1], d->color_root[2], 1.0f };
    const float tip[4] = { d->color_tip[0], d->color_tip[1], d->color_tip[2], 1.0f };
    h->gl->Uniform4f(named(h, program, "u_counts"), (float)d->point_count, (float)d->hair_count, (float)d->patch_count,
                     (float)d->segment_count);
    h->gl->Uniform4f(named(h, program, "u_widths"), widen * d->width_root, widen * d->width_tip, d->scatter, d->gloss);
    h->gl->Uniform4f(named(h, program, "u_curl"), d->curl_radius, d->curl_turns, 0.0f, 0.0f);
    h->gl->Uniform4fv(named(h, program, "u_middle"), 1, middle);
    h->gl->Uniform4fv(named(h, program, "u_root"), 1, root);
    h->gl->Uniform4fv(named(h, program, "u_tip"), 1, tip);
    h->gl->Uniform4fv(named(h, program, "u_world"), 3, h->world);
}

static void bind(const noh_stage_hair *h, const noh_stage *s, GLuint program, const noh_stage_view *v, uint32_t strips)
{
    const noh_stage_gl *gl = s->gpu;
    const noh_gl_api *api = h->gl;
    api->UseProgram(program);
    set_shape(h, program, strips);
    api->UniformMatrix4fv(named(h, program, "u_view_projection"), 1, GL_FALSE, v->view_projection);
    api->Uniform4f(named(h, program, "u_eye"), v->eye[0], v->eye[1], v->eye[2], v->height_px ? 1.0f : 0.0f);
    api->Uniform4f(named(h, program, "u_light"), v->light[0], v->light[1], v->light[2], 0.0f);
    if (h->lit && gl->light && gl->lighting && program == h->color) {
        float rows[NOH_LIGHTING_ROWS][4];
        const float *key = gl->lighting->key_direction;
        noh_lighting_pack(gl->lighting, gl->light->desc.shadow_px, rows);
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

static void unbind(const noh_stage_hair *h)
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
    api->Disable(GL_DEPTH_TEST);
    api->Disable(GL_BLEND);
    api->DepthMask(GL_TRUE);
}

/* All strips: the alphas from `low` up to `high`. */
static void draw_strips(noh_stage_hair *h, GLuint program, uint32_t strips, float low, float high)
{
    const uint32_t vertices = VERTICES_OF(h->wig->cut->header->segment_count);
    h->gl->Uniform4f(named(h, program, "u_alpha"), low, high, 0.0f, 0.0f);
    h->gl->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, (GLsizei)vertices, (GLsizei)strips);
    h->draws++;
}

static void draw_depth(noh_stage_hair *h, const noh_stage *s, uint32_t view, uint32_t strips)
{
    bind(h, s, h->depth, &s->views[view], strips);
    h->gl->Enable(GL_DEPTH_TEST);
    h->gl->Disable(GL_BLEND);
    h->gl->Disable(GL_CULL_FACE);
    h->gl->ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    draw_strips(h, h->depth, strips, 0.9f, 2.0f);
    h->gl->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    unbind(h);
}

void noh_stage_hair_draw(noh_stage_hair *hair, const noh_stage *stage, uint32_t view, noh_pass pass)
{
    const noh_gl_api *gl = hair->gl;
    NOH_ASSERT(stage && stage->gpu);
    const uint32_t strips = noh_haircut_strips(hair->wig->cut, hair->pixels_per_metre);
    if (view >= stage->view_count || !(hair->views >> view & 1u) || !strips) return;
    if (pass == NOH_PASS_DEPTH) {
        draw_depth(hair, stage, view, strips);
        return;
    }
    bind(hair, stage, hair->color, &stage->views[view], strips);
    gl->Enable(GL_DEPTH_TEST);
    gl->Disable(GL_CULL_FACE);
    if (pass != NOH_PASS_BLENDED) {
        gl->Disable(GL_BLEND);
        draw_strips(hair, hair->color, strips, 0.9f, 2.0f);
    }
    if (pass != NOH_PASS_OPAQUE) {
        gl->Enable(GL_BLEND);
        gl->BlendEquation(GL_FUNC_ADD);
        gl->BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        gl->DepthMask(GL_FALSE);
        draw_strips(hair, hair->color, strips, 0.01f, 0.9f);
    }
    unbind(hair);
}

void noh_stage_hair_draw_shadow(noh_stage_hair *hair, const noh_stage *stage, uint32_t view)
{
    const noh_stage_gl *gl = stage->gpu;
    NOH_ASSERT(gl);
    if (!gl->light || !gl->light->framebuffer) return;
    noh_gl_group_begin(hair->gl, "noh hair's shadow", NULL);
    hair->gl->BindFramebuffer(GL_FRAMEBUFFER, gl->light->framebuffer);
    hair->gl->Viewport(0, 0, (GLsizei)gl->light->desc.shadow_px, (GLsizei)gl->light->desc.shadow_px);
    noh_stage_hair_draw(hair, stage, view, NOH_PASS_DEPTH);
    noh_gl_light_end_shadow(gl->light);
}
