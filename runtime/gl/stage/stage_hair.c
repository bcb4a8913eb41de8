#include "core/base/assert_internal.h"
#include "life/hair/haircut_internal.h"
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
#include "gl/stage/drawable_internal.h"
#include "gl/stage/stage_gl_internal.h"
#include "stage/actors/actor_hair_internal.h"
#include "gl/device/gl_debug_internal.h"
#include "gl/draw/gl_light_internal.h"
#include "shaders.gen.h"

#define SIDE_TEXELS 1024u /* of the texture; only an extreme desc needs more rows */
#define HEAD_TEXELS 5u    /* 3 rows of 4 from head space; first control hair, melanin and fade, strips */
#define PIECE_TEXELS 128u /* uploaded at a time */

enum {
    U_CAMERA = NOH_DRAWABLE_OWN,
    U_COUNTS,
    U_WIDTHS,
    U_CURL,
    U_CROWD,
    U_MIDDLE,
    U_ROOT,
    U_TIP,
    U_EYE,
    U_LIGHT,
    U_ALPHA
};

/* ---- texture ---- */

/* Rows of the texture: control hairs of all sets, then patches, then heads. */
typedef struct layout {
    uint32_t width, height; /* texels */
    uint32_t in_row;        /* control hairs in a row */
    uint32_t patches;       /* first row of patches */
    uint32_t heads;         /* first row of heads */
    uint32_t rest;          /* the set of hair at rest; NOH_NONE: all hair moves */
} layout;

static uint32_t rows_of(uint32_t count, uint32_t in_row)
{
    return (count + in_row - 1u) / in_row;
}

/* As narrow as SIDE_TEXELS rows allow: that wastes least. */
static layout layout_of(const noh_actor_hair_desc *d)
{
    const noh_pack_hair_header *h = d->cut->header;
    const int all_move = d->in_state && d->near_max >= d->head_max;
    const uint32_t hairs = h->hair_count * (d->near_max + (all_move ? 0u : 1u));
    layout l;
    l.rest = all_move ? NOH_NONE : d->near_max;
    for (l.in_row = 1;; l.in_row++) {
        l.width = l.in_row * h->point_count;
        l.patches = rows_of(hairs, l.in_row);
        l.heads = l.patches + rows_of(2u * h->patch_count, l.width);
        l.height = l.heads + rows_of(HEAD_TEXELS * d->head_max, l.width);
        if (l.height <= SIDE_TEXELS || l.width + h->point_count > SIDE_TEXELS) return l;
    }
}

static noh_gl_texture_desc texture_of(const layout *l)
{
    return (noh_gl_texture_desc){ .format = GL_RGB32F, .width = l->width, .height = l->height };
}

static size_t carve(const noh_actor_hair_desc *d, noh_arena *arena, noh_stage_hair *out)
{
    const layout l = layout_of(d);
    const size_t points = 3u * (size_t)d->cut->header->hair_count * d->cut->header->point_count;
    const size_t table = 3u * (size_t)l.width * (l.height - l.heads);
    float *at[2] = { noh_arena_carve(arena, points * sizeof(float), 16),
                     noh_arena_carve(arena, table * sizeof(float), 16) };
    if (out) {
        out->points = at[0];
        out->table = at[1];
        memset(out->table, 0, table * sizeof(float));
    }
    return arena->used;
}

size_t noh_stage_hair_size(const noh_actor_hair_desc *desc)
{
    noh_arena arena = noh_arena_measure();
    NOH_ASSERT(desc && desc->cut);
    return carve(desc, &arena, NULL);
}

uint64_t noh_stage_hair_bytes(const noh_actor_hair_desc *desc)
{
    NOH_ASSERT(desc && desc->cut);
    const layout l = layout_of(desc);
    const noh_gl_texture_desc d = texture_of(&l);
    return noh_gl_texture_bytes(&d);
}

/* ---- uploads, with the texture bound ---- */

/* Corners never change. */
static void upload_patches(const noh_stage_hair *h, const layout *l)
{
    const noh_haircut *cut = noh_actor_hair_desc_of(h->hair)->cut;
    const uint32_t all = 2u * cut->header->patch_count;
    float piece[3u * PIECE_TEXELS];
    for (uint32_t at = 0; at < all;) {
        const uint32_t x = at % l->width, in_row = l->width - x, left = all - at;
        uint32_t count = in_row < left ? in_row : left;
        count = count < PIECE_TEXELS ? count : PIECE_TEXELS;
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t *corners = cut->patches + 2u * (size_t)(at + i);
            piece[3u * i] = (float)corners[0];
            piece[3u * i + 1u] = (float)corners[1];
            piece[3u * i + 2u] = 0.0f;
        }
        h->drawable.gl->TexSubImage2D(GL_TEXTURE_2D, 0, (GLint)x, (GLint)(l->patches + at / l->width), (GLsizei)count,
                                      1, GL_RGB, GL_FLOAT, piece);
        at += count;
    }
}

/* points: of all control hairs of a head */
static void upload_set(const noh_stage_hair *h, const layout *l, uint32_t set, const float *points)
{
    const noh_pack_hair_header *head = noh_actor_hair_desc_of(h->hair)->cut->header;
    const uint32_t first = set * head->hair_count;
    for (uint32_t at = 0; at < head->hair_count;) {
        const uint32_t x = (first + at) % l->in_row, left = head->hair_count - at, room = l->in_row - x;
        const uint32_t rows = x || left < room ? 1u : left / l->in_row;
        const uint32_t hairs = rows > 1u ? l->in_row : left < room ? left : room;
        h->drawable.gl->TexSubImage2D(GL_TEXTURE_2D, 0, (GLint)(x * head->point_count),
                                      (GLint)((first + at) / l->in_row), (GLsizei)(hairs * head->point_count),
                                      (GLsizei)rows, GL_RGB, GL_FLOAT, points + 3u * (size_t)at * head->point_count);
        at += hairs * rows;
    }
}

static void begin_uploads(const noh_stage_hair *h, noh_gl_pixels *kept)
{
    h->drawable.gl->ActiveTexture(GL_TEXTURE0);
    h->drawable.gl->BindTexture(GL_TEXTURE_2D, h->drawable.texture.name);
    noh_gl_unpack_begin(h->drawable.gl, kept);
}

static void end_uploads(const noh_stage_hair *h, const noh_gl_pixels *kept)
{
    noh_gl_unpack_end(h->drawable.gl, kept);
    h->drawable.gl->BindTexture(GL_TEXTURE_2D, 0);
}

/* ---- GL objects ---- */

static noh_gl_drawable_desc desc_of(const noh_stage_hair *h)
{
    static const char *const uniforms[] = {
        "u_view_projection", "u_counts", "u_widths", "u_curl", "u_crowd", "u_middle", "u_root", "u_tip", "u_eye",
        "u_light",           "u_alpha"
    };
    const layout l = layout_of(noh_actor_hair_desc_of(h->hair));
    return (noh_gl_drawable_desc){ .name = { "hair", "hair depth" },
                                   .vertex = &noh_shader_hair_vert,
                                   .fragment = &noh_shader_hair_frag,
                                   .defines = noh_gl_encode_define(h->encode_srgb),
                                   .lit = h->lit,
                                   .sampler = "u_points",
                                   .uniforms = uniforms,
                                   .uniform_count = sizeof uniforms / sizeof *uniforms,
                                   .texture = texture_of(&l) };
}

/* What stays in the texture. */
static noh_result fill(noh_stage_hair *h, noh_error *error)
{
    const noh_actor_hair_desc *d = noh_actor_hair_desc_of(h->hair);
    const layout l = layout_of(d);
    noh_gl_pixels kept;
    begin_uploads(h, &kept);
    if (l.rest != NOH_NONE) upload_set(h, &l, l.rest, d->cut->desc.rest);
    upload_patches(h, &l);
    end_uploads(h, &kept);
    return noh_gl_drawable_check(&h->drawable, error);
}

noh_result noh_stage_hair_create(const noh_gl_device *device, const noh_actor_hair *hair, void *memory, size_t bytes,
                                 int lit, int encode_srgb, noh_stage_hair *out, noh_error *error)
{
    noh_arena arena;
    NOH_ASSERT(hair && out);
    const noh_actor_hair_desc *d = noh_actor_hair_desc_of(hair);
    noh_result result = noh_arena_open(&arena, memory, bytes, noh_stage_hair_size(d), error);
    if (result) return result;
    memset(out, 0, sizeof *out);
    carve(d, &arena, out);
    out->hair = hair;
    out->lit = lit;
    out->encode_srgb = encode_srgb;
    const noh_gl_drawable_desc desc = desc_of(out);
    result = noh_gl_drawable_create(device, &desc, &out->drawable, error);
    return result ? result : fill(out, error);
}

void noh_stage_hair_delete(noh_stage_hair *hair)
{
    NOH_ASSERT(hair);
    noh_gl_drawable_delete(&hair->drawable);
}

noh_result noh_stage_hair_restore(noh_stage_hair *hair, char *log, size_t log_bytes, noh_error *error)
{
    NOH_ASSERT(hair && hair->hair);
    const noh_gl_drawable_desc desc = desc_of(hair);
    const noh_result result = noh_gl_drawable_restore(&hair->drawable, &desc, log, log_bytes, error);
    hair->views = 0; /* until the next update */
    return result ? result : fill(hair, error);
}

/* ---- a frame ---- */

/* The group of a head with that many strips. */
static uint32_t group_of(uint32_t all_strips, uint32_t strips)
{
    uint32_t group = 0;
    while (group + 1u < NOH_HAIR_GROUPS && strips <= rows_of(all_strips, 2u << group)) group++;
    return group;
}

static void put_head(noh_stage_hair *h, const layout *l, const noh_hair_head *head, uint32_t at)
{
    const noh_haircut *cut = noh_actor_hair_desc_of(h->hair)->cut;
    float *out = h->table + 3u * HEAD_TEXELS * (size_t)at;
    memcpy(out, head->world, sizeof head->world);
    out[12] = (float)((head->slot == NOH_NONE ? l->rest : head->slot) * cut->header->hair_count);
    out[13] = (float)head->melanin + 0.5f * noh_haircut_fade(head->pixels_per_metre);
    out[14] = (float)noh_haircut_strips(cut, head->pixels_per_metre);
}

/* Sort the heads into the table by group. */
static void fill_table(noh_stage_hair *h, const layout *l)
{
    const noh_haircut *cut = noh_actor_hair_desc_of(h->hair)->cut;
    uint32_t count, next[NOH_HAIR_GROUPS], sum = 0;
    const noh_hair_head *heads = noh_actor_hair_heads(h->hair, &count);
    memset(h->groups, 0, sizeof h->groups);
    h->views = h->strips = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t strips = noh_haircut_strips(cut, heads[i].pixels_per_metre);
        noh_hair_group *group = &h->groups[group_of(cut->header->strip_count, strips)];
        group->count++;
        if (strips > group->strips) group->strips = strips;
        h->views |= heads[i].views;
        h->strips += strips;
    }
    for (uint32_t g = 0; g < NOH_HAIR_GROUPS; g++) {
        h->groups[g].first = next[g] = sum;
        sum += h->groups[g].count;
    }
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t strips = noh_haircut_strips(cut, heads[i].pixels_per_metre);
        put_head(h, l, &heads[i], next[group_of(cut->header->strip_count, strips)]++);
    }
}

void noh_stage_hair_update(noh_stage_hair *hair)
{
    NOH_ASSERT(hair && hair->drawable.gl);
    const layout l = layout_of(noh_actor_hair_desc_of(hair->hair));
    noh_gl_pixels kept;
    uint32_t count;
    const noh_hair_head *heads = noh_actor_hair_heads(hair->hair, &count);
    fill_table(hair, &l);
    if (!count) return;
    begin_uploads(hair, &kept);
    for (uint32_t i = 0; i < count; i++) {
        if (heads[i].slot == NOH_NONE) continue;
        noh_actor_hair_points(hair->hair, i, hair->points);
        upload_set(hair, &l, heads[i].slot, hair->points);
    }
    hair->drawable.gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, (GLint)l.heads, (GLsizei)l.width,
                                     (GLsizei)rows_of(HEAD_TEXELS * count, l.width), GL_RGB, GL_FLOAT, hair->table);
    end_uploads(hair, &kept);
}

/* ---- draws ---- */

static void set_shape(const noh_stage_hair *h, const layout *l, const int *uniforms)
{
    const noh_gl_api *gl = h->drawable.gl;
    const noh_pack_hair_header *d = noh_actor_hair_desc_of(h->hair)->cut->header;
    gl->Uniform4f(uniforms[U_COUNTS], (float)d->point_count, (float)l->patches, (float)d->patch_count,
                  (float)d->segment_count);
    gl->Uniform4f(uniforms[U_WIDTHS], 0.5f * d->width_root, 0.5f * d->width_tip, d->scatter, d->gloss);
    gl->Uniform4f(uniforms[U_CURL], d->curl_radius, d->curl_turns, 0.0f, (float)l->in_row);
    gl->Uniform4f(uniforms[U_MIDDLE], d->middle[0], d->middle[1], d->middle[2], 0.0f);
    gl->Uniform4f(uniforms[U_ROOT], d->color_root[0], d->color_root[1], d->color_root[2], 1.0f);
    gl->Uniform4f(uniforms[U_TIP], d->color_tip[0], d->color_tip[1], d->color_tip[2], 1.0f);
}

static void begin(const noh_stage_hair *h, const layout *l, int program, const noh_stage *s, const noh_stage_view *v)
{
    const noh_gl_drawable *d = &h->drawable;
    const noh_stage_gl *gl = s->gpu;
    const int *uniforms = d->uniforms[program];
    noh_gl_drawable_begin(d, program);
    set_shape(h, l, uniforms);
    d->gl->UniformMatrix4fv(uniforms[U_CAMERA], 1, GL_FALSE, v->view_projection);
    d->gl->Uniform4f(uniforms[U_EYE], v->eye[0], v->eye[1], v->eye[2], v->height_px ? 1.0f : 0.0f);
    d->gl->Uniform4f(uniforms[U_LIGHT], v->light[0], v->light[1], v->light[2], 0.0f);
    if (h->lit && noh_stage_light_of(s) && gl->lighting && program == NOH_DRAWABLE_COLOR) {
        noh_gl_drawable_light(d, gl->light, gl->lighting, s->origin);
    }
}

/* Draw the pixels with an alpha from `low` up to `high`, smaller heads first. */
static void draw_groups(noh_stage_hair *h, const layout *l, int program, float low, float high)
{
    const noh_gl_api *gl = h->drawable.gl;
    const int *uniforms = h->drawable.uniforms[program];
    const noh_pack_hair_header *d = noh_actor_hair_desc_of(h->hair)->cut->header;
    gl->Uniform4f(uniforms[U_ALPHA], low, high, 0.0f, 0.0f);
    for (uint32_t g = NOH_HAIR_GROUPS; g-- > 0;) {
        const noh_hair_group *group = &h->groups[g];
        if (!group->count) continue;
        gl->Uniform4f(uniforms[U_CROWD], (float)group->strips, (float)group->first, (float)l->heads,
                      (float)d->strip_count);
        gl->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, (GLsizei)(2u * (d->segment_count + 1u)),
                                (GLsizei)(group->strips * group->count));
        h->draws++;
    }
}

void noh_stage_hair_draw(noh_stage_hair *hair, const noh_stage *stage, uint32_t view, noh_pass pass)
{
    NOH_ASSERT(hair && hair->drawable.gl && stage);
    const noh_gl_api *gl = hair->drawable.gl;
    const layout l = layout_of(noh_actor_hair_desc_of(hair->hair));
    const int program = pass == NOH_PASS_DEPTH ? NOH_DRAWABLE_DEPTH : NOH_DRAWABLE_COLOR;
    noh_gl_raster raster;
    if (view >= stage->view_count || !(hair->views >> view & 1u)) return;
    begin(hair, &l, program, stage, &stage->views[view]);
    noh_gl_tests_begin(gl, &raster);
    gl->Disable(GL_CULL_FACE);
    if (pass == NOH_PASS_DEPTH) noh_gl_depth_only_begin(gl, &raster);
    if (pass != NOH_PASS_BLENDED) draw_groups(hair, &l, program, 0.9f, 2.0f);
    if (pass != NOH_PASS_OPAQUE && pass != NOH_PASS_DEPTH) {
        noh_gl_blend_begin(gl, &raster);
        draw_groups(hair, &l, program, 0.01f, 0.9f);
    }
    noh_gl_drawable_end(&hair->drawable, &raster);
}

void noh_stage_hair_draw_shadow(noh_stage_hair *hair, const noh_stage *stage, uint32_t view)
{
    NOH_ASSERT(hair && hair->drawable.gl && stage);
    const noh_stage_gl *gl = stage->gpu;
    const noh_gl_light *light = noh_stage_light_of(stage);
    if (!light || !light->framebuffer) return;
    noh_gl_group_begin(hair->drawable.gl, "noh hair's shadow", NULL);
    noh_gl_light_bind_shadow(light);
    noh_stage_hair_draw(hair, stage, view, NOH_PASS_DEPTH);
    noh_gl_light_end_shadow(light, stage->views[view].view_projection, gl->lighting ? &gl->lighting_less : NULL);
}
