/* stage_hairs.c: hair of a crowd drawn. */
#include "core/base/assert.h"
#include "life/hair/haircut.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

#include <string.h>

#include "gl/device/gl_state_internal.h"
#include "gl/stage/stage_gl_internal.h"
#include "gl/stage/stage_hair_internal.h"

/* Those that move, then those at rest. */
static uint32_t sets_of(const noh_wigs_desc *d)
{
    return d->near_max + 1u;
}

/* ---- bytes ---- */

static size_t point_floats(const noh_wigs_desc *d)
{
    return 3u * (size_t)d->wig->cut->header->hair_count * d->wig->cut->header->point_count;
}

static size_t table_floats(const noh_wigs_desc *d)
{
    const noh_hair_layout l = noh_hair_layout_of(d->wig->cut, sets_of(d), d->actor_max);
    return 3u * (size_t)l.width * (l.height - l.bodies);
}

size_t noh_stage_hairs_size(const noh_wigs_desc *desc)
{
    noh_arena arena = noh_arena_measure();
    NOH_ASSERT(desc && desc->wig);
    (void)noh_arena_carve(&arena, point_floats(desc) * sizeof(float), 16);
    (void)noh_arena_carve(&arena, table_floats(desc) * sizeof(float), 16);
    return arena.used;
}

uint64_t noh_stage_hairs_bytes(const noh_wigs_desc *desc)
{
    NOH_ASSERT(desc && desc->wig);
    const noh_gl_texture_desc d = noh_hair_texture(desc->wig->cut, sets_of(desc), desc->actor_max);
    return noh_gl_texture_bytes(&d);
}

/* ---- made ---- */

/* Those at rest are uploaded once. */
static noh_result create(noh_stage_hairs *h, char *log, size_t log_bytes, noh_error *error)
{
    const noh_wigs_desc *d = noh_wigs_desc_of(h->wigs);
    noh_wig_points(d->wig, NULL, h->hair.points);
    const noh_result result = noh_hair_create_objects(&h->hair, log, log_bytes, error);
    if (result) return result;
    noh_hair_upload(&h->hair, d->near_max);
    h->hair.gl->BindTexture(GL_TEXTURE_2D, 0);
    return NOH_OK;
}

noh_result noh_stage_hairs_create(const noh_gl_device *device, const noh_wigs *wigs, void *memory, size_t bytes,
                                  int lit, int encode_srgb, noh_stage_hairs *out, noh_error *error)
{
    noh_arena arena;
    NOH_ASSERT(device && device->api && device->ledger && wigs && out);
    const noh_wigs_desc *d = noh_wigs_desc_of(wigs);
    const noh_result result = noh_arena_open(&arena, memory, bytes, noh_stage_hairs_size(d), error);
    if (result) return result;
    memset(out, 0, sizeof *out);
    out->hair.points = noh_arena_carve(&arena, point_floats(d) * sizeof(float), 16);
    out->table = noh_arena_carve(&arena, table_floats(d) * sizeof(float), 16);
    memset(out->table, 0, table_floats(d) * sizeof(float));
    out->wigs = wigs;
    out->hair.gl = device->api;
    out->hair.ledger = device->ledger;
    out->hair.wig = d->wig;
    out->hair.lit = lit;
    out->hair.encode_srgb = encode_srgb;
    out->hair.sets = sets_of(d);
    out->hair.bodies = d->actor_max;
    return create(out, device->log, device->log_bytes, error);
}

void noh_stage_hairs_delete(noh_stage_hairs *hairs)
{
    noh_stage_hair_delete(&hairs->hair);
}

noh_result noh_stage_hairs_restore(noh_stage_hairs *hairs, char *log, size_t log_bytes, noh_error *error)
{
    const noh_gl_api *gl = hairs->hair.gl;
    hairs->hair.gl = noh_gl_lost_api();
    noh_stage_hair_delete(&hairs->hair);
    hairs->hair.gl = gl;
    return create(hairs, log, log_bytes, error);
}

/* ---- a frame ---- */

/* Heads of a group have at most so many strips. */
static uint32_t strips_of_group(const noh_wigs_desc *d, uint32_t group)
{
    const uint32_t all = d->wig->cut->header->strip_count;
    return (all + (1u << group) - 1u) >> group;
}

static uint32_t group_of(const noh_wigs_desc *d, uint32_t strips)
{
    uint32_t group = 0;
    while (group + 1u < NOH_HAIRS_GROUPS && strips <= strips_of_group(d, group + 1u)) group++;
    return group;
}

static void put_body(noh_stage_hairs *h, const noh_wigs_body *b, uint32_t at)
{
    const noh_wigs_desc *d = noh_wigs_desc_of(h->wigs);
    const uint32_t set = b->slot == NOH_NONE ? d->near_max : b->slot;
    float *out = h->table + 3u * NOH_HAIR_BODY_TEXELS * (size_t)at;
    memcpy(out, b->world, sizeof b->world);
    out[12] = (float)(set * d->wig->cut->header->hair_count);
    out[13] = noh_haircut_fade(b->pixels_per_metre);
    out[14] = (float)noh_haircut_strips(d->wig->cut, b->pixels_per_metre);
}

/* The table, group after group. */
static void fill_table(noh_stage_hairs *h)
{
    const noh_wigs_desc *d = noh_wigs_desc_of(h->wigs);
    uint32_t count, next[NOH_HAIRS_GROUPS], sum = 0;
    const noh_wigs_body *bodies = noh_wigs_bodies(h->wigs, &count);
    memset(h->count, 0, sizeof h->count);
    h->views = h->strips = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t strips = noh_haircut_strips(d->wig->cut, bodies[i].pixels_per_metre);
        h->count[group_of(d, strips)]++;
        h->views |= bodies[i].views;
        h->strips += strips;
    }
    for (uint32_t g = 0; g < NOH_HAIRS_GROUPS; g++) {
        h->first[g] = next[g] = sum;
        sum += h->count[g];
    }
    for (uint32_t i = 0; i < count; i++) {
        put_body(h, &bodies[i], next[group_of(d, noh_haircut_strips(d->wig->cut, bodies[i].pixels_per_metre))]++);
    }
}

void noh_stage_hairs_update(noh_stage_hairs *hairs)
{
    const noh_wigs_desc *d = noh_wigs_desc_of(hairs->wigs);
    const noh_hair_layout l = noh_hair_layout_of(d->wig->cut, hairs->hair.sets, hairs->hair.bodies);
    const noh_gl_api *gl = hairs->hair.gl;
    noh_gl_pixels kept;
    uint32_t count;
    const noh_wigs_body *bodies = noh_wigs_bodies(hairs->wigs, &count);
    fill_table(hairs);
    if (!count) return;
    for (uint32_t i = 0; i < count; i++) {
        if (bodies[i].slot == NOH_NONE) continue;
        noh_wigs_points(hairs->wigs, i, hairs->hair.points);
        noh_hair_upload(&hairs->hair, bodies[i].slot);
    }
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, hairs->hair.texture.name);
    noh_gl_unpack_begin(gl, &kept);
    gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, (GLint)l.bodies, (GLsizei)l.width,
                      (GLsizei)((NOH_HAIR_BODY_TEXELS * count + l.width - 1u) / l.width), GL_RGB, GL_FLOAT,
                      hairs->table);
    noh_gl_unpack_end(gl, &kept);
    gl->BindTexture(GL_TEXTURE_2D, 0);
}

/* ---- drawing ---- */

static void draw_groups(void *user, GLuint program, float low, float high)
{
    noh_stage_hairs *h = user;
    const noh_wigs_desc *d = noh_wigs_desc_of(h->wigs);
    const noh_hair_layout l = noh_hair_layout_of(d->wig->cut, h->hair.sets, h->hair.bodies);
    for (uint32_t g = NOH_HAIRS_GROUPS; g-- > 0;) {
        const uint32_t each = strips_of_group(d, g);
        if (!h->count[g]) continue;
        h->hair.gl->Uniform4f(h->hair.gl->GetUniformLocation(program, "u_crowd"), (float)each, (float)h->first[g],
                              (float)l.bodies, (float)d->wig->cut->header->strip_count);
        noh_hair_draw_strips(&h->hair, program, each * h->count[g], low, high);
    }
}

void noh_stage_hairs_draw(noh_stage_hairs *hairs, const noh_stage *stage, uint32_t view, noh_pass pass)
{
    NOH_ASSERT(stage && stage->gpu);
    if (view >= stage->view_count || !(hairs->views >> view & 1u)) return;
    noh_hair_draw_pass(&hairs->hair, stage, view, pass, 0, draw_groups, hairs);
}

void noh_stage_hairs_draw_shadow(noh_stage_hairs *hairs, const noh_stage *stage, uint32_t view)
{
    if (!noh_hair_begin_shadow(&hairs->hair, stage)) return;
    noh_stage_hairs_draw(hairs, stage, view, NOH_PASS_DEPTH);
    noh_gl_light_end_shadow(((const noh_stage_gl *)stage->gpu)->light);
}
