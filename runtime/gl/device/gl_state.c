/* gl_state.c: saves and restores the GL state that noh changes.
 *
 * Draws save each part of the state on its first change: an opaque pass makes six GL queries. */
#include "core/base/assert_internal.h"
#include "gl/device/gl_api_internal.h"
#include "noh/gl_device.h"

#include <string.h>

#include "gl/device/gl_state_internal.h"

/* Of desktop OpenGL. */
#define PRIMITIVE_RESTART 0x8F9Du
#define COLOR_LOGIC_OP 0x0BF2u
#define CLIP_ORIGIN 0x935Cu
#define CLIP_DEPTH_MODE 0x935Du
#define LOWER_LEFT 0x8CA1u
#define NEGATIVE_ONE_TO_ONE 0x935Eu

/* ---- switches ---- */

typedef struct gl_switch {
    uint16_t cap, part;
} gl_switch;

static const gl_switch switches[] = {
    { GL_BLEND, NOH_KEEP_BLEND },          { GL_DEPTH_TEST, NOH_KEEP_TESTS },
    { GL_CULL_FACE, NOH_KEEP_TESTS },      { GL_PRIMITIVE_RESTART_FIXED_INDEX, NOH_KEEP_TESTS },
    { PRIMITIVE_RESTART, NOH_KEEP_TESTS }, { GL_SCISSOR_TEST, NOH_KEEP_REST },
    { GL_STENCIL_TEST, NOH_KEEP_REST },    { GL_RASTERIZER_DISCARD, NOH_KEEP_REST },
    { COLOR_LOGIC_OP, NOH_KEEP_REST },     { NOH_GL_PROGRAM_POINT_SIZE, NOH_KEEP_REST },
    { GL_SAMPLE_ALPHA_TO_COVERAGE, NOH_KEEP_COVERAGE },
};
#define SWITCHES (sizeof switches / sizeof switches[0])
#define BIT_BLEND 1u
#define BIT_COVERAGE (1u << (SWITCHES - 1u))
#define BIT_ONE_SAMPLE (1u << SWITCHES) /* of the target of what covers */

static int has_switch(const noh_gl_api *gl, uint32_t cap)
{
    switch (cap) {
    case PRIMITIVE_RESTART:
    case COLOR_LOGIC_OP:
    case NOH_GL_PROGRAM_POINT_SIZE: return !gl->is_es;
    case GL_PRIMITIVE_RESTART_FIXED_INDEX:
        /* WebGL, which cannot map buffers, has primitive restart always on and no switch for it */
        return gl->is_es ? gl->MapBufferRange != NULL : gl->version >= 430;
    default: return 1;
    }
}

static void set_switch(const noh_gl_api *gl, uint32_t cap, int on)
{
    if (on) {
        gl->Enable(cap);
    } else {
        gl->Disable(cap);
    }
}

/* ---- render state ---- */

static uint16_t get_enum(const noh_gl_api *gl, uint32_t what)
{
    int value = 0;
    gl->GetIntegerv(what, &value);
    return (uint16_t)value;
}

static const uint16_t blend_questions[6] = { GL_BLEND_SRC_RGB,   GL_BLEND_DST_RGB,      GL_BLEND_SRC_ALPHA,
                                             GL_BLEND_DST_ALPHA, GL_BLEND_EQUATION_RGB, GL_BLEND_EQUATION_ALPHA };

void noh_gl_raster_keep(const noh_gl_api *gl, noh_gl_raster *r, uint32_t parts)
{
    const uint32_t wanted = parts & ~(uint32_t)r->kept;
    for (uint32_t i = 0; i < SWITCHES; i++) {
        if (!(switches[i].part & wanted) || !has_switch(gl, switches[i].cap)) continue;
        r->enabled = (uint16_t)((r->enabled & ~(1u << i)) | (gl->IsEnabled(switches[i].cap) ? 1u << i : 0u));
    }
    if (wanted & NOH_KEEP_TESTS) r->depth_func = get_enum(gl, GL_DEPTH_FUNC);
    if (wanted & NOH_KEEP_FACE) r->front_face = get_enum(gl, GL_FRONT_FACE);
    if (wanted & NOH_KEEP_COLORS) {
        int mask[4] = { 1, 1, 1, 1 };
        gl->GetIntegerv(GL_COLOR_WRITEMASK, mask);
        r->color_mask = 0;
        for (uint32_t c = 0; c < 4u; c++) r->color_mask = (uint8_t)(r->color_mask | (mask[c] ? 1u << c : 0u));
    }
    if (wanted & NOH_KEEP_BLEND) {
        for (uint32_t i = 0; i < 6u; i++) r->blend[i] = get_enum(gl, blend_questions[i]);
        r->depth_mask = get_enum(gl, GL_DEPTH_WRITEMASK) != 0;
    }
    r->kept = (uint16_t)(r->kept | wanted);
}

static void put_colors(const noh_gl_api *gl, uint32_t mask)
{
    gl->ColorMask(mask & 1u, mask >> 1 & 1u, mask >> 2 & 1u, mask >> 3 & 1u);
}

void noh_gl_raster_put_back(const noh_gl_api *gl, const noh_gl_raster *r)
{
    for (uint32_t i = 0; i < SWITCHES; i++) {
        if (!(switches[i].part & r->kept) || !has_switch(gl, switches[i].cap)) continue;
        set_switch(gl, switches[i].cap, r->enabled >> i & 1);
    }
    if (r->kept & NOH_KEEP_TESTS) gl->DepthFunc(r->depth_func);
    if (r->kept & NOH_KEEP_FACE) gl->FrontFace(r->front_face);
    if (r->kept & NOH_KEEP_COLORS) put_colors(gl, r->color_mask);
    if (r->kept & NOH_KEEP_BLEND) {
        /* With blending on, the caller's functions, one set per draw buffer, were not changed unless FUNCTIONS is
         * kept. */
        if (!(r->enabled & BIT_BLEND) || (r->kept & NOH_KEEP_FUNCTIONS)) {
            gl->BlendFuncSeparate(r->blend[0], r->blend[1], r->blend[2], r->blend[3]);
            gl->BlendEquationSeparate(r->blend[4], r->blend[5]);
        }
        gl->DepthMask(r->depth_mask);
    }
}

void noh_gl_tests_begin(const noh_gl_api *gl, noh_gl_raster *r)
{
    r->kept = r->enabled = 0;
    noh_gl_raster_keep(gl, r, NOH_KEEP_TESTS | NOH_KEEP_COVERAGE);
    if (r->enabled & BIT_COVERAGE) {
        int samples = 0;
        gl->GetIntegerv(GL_SAMPLES, &samples);
        if (samples < 2) r->enabled |= BIT_ONE_SAMPLE;
    }
    for (uint32_t i = 0; i < SWITCHES; i++) {
        const uint32_t cap = switches[i].cap;
        if (cap == GL_DEPTH_TEST) {
            gl->Enable(cap);
        } else if ((switches[i].part & NOH_KEEP_TESTS) && (r->enabled >> i & 1u)) {
            gl->Disable(cap);
        }
    }
    if (r->depth_func == GL_LESS) gl->DepthFunc(GL_LEQUAL);
    if (r->depth_func == GL_GREATER) gl->DepthFunc(GL_GEQUAL);
}

int noh_gl_is_covering(const noh_gl_raster *r)
{
    return !(r->enabled & BIT_COVERAGE) ? 0 : r->enabled & BIT_ONE_SAMPLE ? 3 : 1;
}

/* Alpha is no share of the pixel where it blends, and nothing where only depth is drawn. */
static void set_coverage(const noh_gl_api *gl, const noh_gl_raster *r, int on)
{
    if (noh_gl_is_covering(r)) set_switch(gl, GL_SAMPLE_ALPHA_TO_COVERAGE, on);
}

int noh_gl_is_reversed(const noh_gl_raster *r)
{
    return r->depth_func == GL_GREATER || r->depth_func == GL_GEQUAL;
}

void noh_gl_blend_begin(const noh_gl_api *gl, noh_gl_raster *r)
{
    noh_gl_raster_keep(gl, r, NOH_KEEP_BLEND);
    if (!(r->enabled & BIT_BLEND)) {
        gl->Enable(GL_BLEND);
        gl->BlendEquation(GL_FUNC_ADD);
        gl->BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    }
    set_coverage(gl, r, 0);
    gl->DepthMask(GL_FALSE);
}

void noh_gl_blend_end(const noh_gl_api *gl, const noh_gl_raster *r)
{
    if (!(r->enabled & BIT_BLEND)) gl->Disable(GL_BLEND);
    set_coverage(gl, r, 1);
    gl->DepthMask(r->depth_mask);
}

/* Changes the blend functions even if the caller has blending on, so it sets NOH_KEEP_FUNCTIONS. */
void noh_gl_multiply_begin(const noh_gl_api *gl, noh_gl_raster *r)
{
    noh_gl_tests_begin(gl, r);
    noh_gl_raster_keep(gl, r, NOH_KEEP_BLEND | NOH_KEEP_FUNCTIONS);
    set_coverage(gl, r, 0);
    gl->Disable(GL_CULL_FACE);
    gl->DepthMask(GL_FALSE);
    gl->Enable(GL_BLEND);
    gl->BlendEquation(GL_FUNC_ADD);
}

void noh_gl_behind_begin(const noh_gl_api *gl, noh_gl_raster *r)
{
    noh_gl_tests_begin(gl, r);
    noh_gl_raster_keep(gl, r, NOH_KEEP_BLEND);
    set_coverage(gl, r, 0);
    gl->Disable(GL_DEPTH_TEST);
    gl->Disable(GL_BLEND);
    gl->Disable(GL_CULL_FACE);
}

void noh_gl_depth_only_begin(const noh_gl_api *gl, noh_gl_raster *r)
{
    noh_gl_raster_keep(gl, r, NOH_KEEP_COLORS);
    set_coverage(gl, r, 0);
    put_colors(gl, 0);
}

void noh_gl_depth_only_end(const noh_gl_api *gl, const noh_gl_raster *r)
{
    set_coverage(gl, r, 1);
    put_colors(gl, r->color_mask);
}

/* ---- draws into textures ---- */

void noh_gl_framebuffers_keep(const noh_gl_api *gl, int kept[2])
{
    kept[0] = kept[1] = 0;
    gl->GetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &kept[0]);
    gl->GetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &kept[1]);
}

void noh_gl_framebuffers_put_back(const noh_gl_api *gl, const int kept[2])
{
    gl->BindFramebuffer(GL_DRAW_FRAMEBUFFER, (GLuint)kept[0]);
    gl->BindFramebuffer(GL_READ_FRAMEBUFFER, (GLuint)kept[1]);
}

static void keep_offscreen(const noh_gl_api *gl, noh_gl_offscreen *o)
{
    memset(o, 0, sizeof *o);
    noh_gl_raster_keep(gl, &o->raster, NOH_KEEP_ALL);
    noh_gl_framebuffers_keep(gl, o->framebuffers);
    gl->GetIntegerv(GL_VIEWPORT, o->viewport);
    gl->GetIntegerv(GL_SCISSOR_BOX, o->scissor);
    gl->GetFloatv(GL_DEPTH_RANGE, o->depth_range);
    if (!gl->ClipControl) return;
    gl->GetIntegerv(CLIP_ORIGIN, &o->clip[0]);
    gl->GetIntegerv(CLIP_DEPTH_MODE, &o->clip[1]);
}

void noh_gl_offscreen_begin(const noh_gl_api *gl, noh_gl_offscreen *o)
{
    keep_offscreen(gl, o);
    for (uint32_t i = 0; i < SWITCHES; i++) {
        if (o->raster.enabled >> i & 1) gl->Disable(switches[i].cap);
    }
    put_colors(gl, 15u);
    gl->DepthMask(GL_TRUE);
    gl->FrontFace(GL_CCW);
    gl->DepthRangef(0.0f, 1.0f);
    if (gl->ClipControl) gl->ClipControl(LOWER_LEFT, NEGATIVE_ONE_TO_ONE);
}

void noh_gl_offscreen_end(const noh_gl_api *gl, const noh_gl_offscreen *o)
{
    const noh_gl_raster *r = &o->raster;
    noh_gl_raster_put_back(gl, r);
    noh_gl_framebuffers_put_back(gl, o->framebuffers);
    gl->Viewport(o->viewport[0], o->viewport[1], o->viewport[2], o->viewport[3]);
    gl->Scissor(o->scissor[0], o->scissor[1], o->scissor[2], o->scissor[3]);
    gl->DepthRangef(o->depth_range[0], o->depth_range[1]);
    if (gl->ClipControl) gl->ClipControl((GLenum)o->clip[0], (GLenum)o->clip[1]);
}

/* ---- pixels ---- */

static const uint16_t unpack_questions[6] = { GL_UNPACK_ALIGNMENT,   GL_UNPACK_ROW_LENGTH,   GL_UNPACK_SKIP_ROWS,
                                              GL_UNPACK_SKIP_PIXELS, GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SKIP_IMAGES };
static const uint16_t pack_questions[4] = { GL_PACK_ALIGNMENT, GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS,
                                            GL_PACK_SKIP_PIXELS };

/* Set the first value, the alignment, to 1 and all others to 0. */
static void set_store(const noh_gl_api *gl, const uint16_t *questions, int *kept, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const int wanted = i == 0;
        gl->GetIntegerv(questions[i], &kept[i]);
        if (kept[i] != wanted) gl->PixelStorei(questions[i], wanted);
    }
}

static void put_store(const noh_gl_api *gl, const uint16_t *questions, const int *kept, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (kept[i] != (i == 0)) gl->PixelStorei(questions[i], kept[i]);
    }
}

void noh_gl_unpack_begin(const noh_gl_api *gl, noh_gl_pixels *p)
{
    memset(p, 0, sizeof *p);
    gl->GetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &p->unpack_buffer);
    if (p->unpack_buffer) gl->BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    set_store(gl, unpack_questions, p->unpack, 6u);
}

void noh_gl_unpack_end(const noh_gl_api *gl, const noh_gl_pixels *p)
{
    put_store(gl, unpack_questions, p->unpack, 6u);
    if (p->unpack_buffer) gl->BindBuffer(GL_PIXEL_UNPACK_BUFFER, (GLuint)p->unpack_buffer);
}

void noh_gl_pack_begin(const noh_gl_api *gl, noh_gl_pixels *p)
{
    noh_gl_unpack_begin(gl, p);
    gl->GetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &p->pack_buffer);
    if (p->pack_buffer) gl->BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    set_store(gl, pack_questions, p->pack, 4u);
}

void noh_gl_pack_end(const noh_gl_api *gl, const noh_gl_pixels *p)
{
    put_store(gl, pack_questions, p->pack, 4u);
    if (p->pack_buffer) gl->BindBuffer(GL_PIXEL_PACK_BUFFER, (GLuint)p->pack_buffer);
    noh_gl_unpack_end(gl, p);
}

void noh_gl_samplers_none(const noh_gl_api *gl, uint32_t first, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) gl->BindSampler(first + i, 0);
}

/* ---- all of it ---- */

static void save_bindings(const noh_gl_api *gl, noh_gl_state *s)
{
    gl->GetIntegerv(GL_CURRENT_PROGRAM, &s->program);
    gl->GetIntegerv(GL_VERTEX_ARRAY_BINDING, &s->vertex_array);
    gl->GetIntegerv(GL_ARRAY_BUFFER_BINDING, &s->array_buffer);
    gl->GetIntegerv(GL_UNIFORM_BUFFER_BINDING, &s->uniform_buffer);
    gl->GetIntegerv(GL_COPY_READ_BUFFER_BINDING, &s->copy_buffers[0]);
    gl->GetIntegerv(GL_COPY_WRITE_BUFFER_BINDING, &s->copy_buffers[1]);
    gl->GetIntegerv(GL_RENDERBUFFER_BINDING, &s->renderbuffer);
    gl->GetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, 0, &s->uniform_range[0]);
    gl->GetIntegeri_v(GL_UNIFORM_BUFFER_START, 0, &s->uniform_range[1]);
    gl->GetIntegeri_v(GL_UNIFORM_BUFFER_SIZE, 0, &s->uniform_range[2]);
}

void noh_gl_state_save(const noh_gl_api *api, noh_gl_state *state)
{
    NOH_ASSERT(api && state);
    memset(state, 0, sizeof *state);
    keep_offscreen(api, &state->offscreen);
    noh_gl_pack_begin(api, &state->pixels);
    noh_gl_pack_end(api, &state->pixels);
    save_bindings(api, state);
    api->GetIntegerv(GL_ACTIVE_TEXTURE, &state->active_unit);
    for (uint32_t i = 0; i < NOH_GL_STATE_UNITS; i++) {
        api->ActiveTexture(GL_TEXTURE0 + i);
        api->GetIntegerv(GL_TEXTURE_BINDING_2D, &state->units[i].texture_2d);
        api->GetIntegerv(GL_TEXTURE_BINDING_2D_ARRAY, &state->units[i].texture_array);
        api->GetIntegerv(GL_TEXTURE_BINDING_CUBE_MAP, &state->units[i].texture_cube);
        api->GetIntegerv(GL_SAMPLER_BINDING, &state->units[i].sampler);
    }
    api->ActiveTexture((GLenum)state->active_unit);
}

static void restore_bindings(const noh_gl_api *gl, const noh_gl_state *s)
{
    const int *range = s->uniform_range;
    gl->UseProgram((GLuint)s->program);
    gl->BindVertexArray((GLuint)s->vertex_array);
    gl->BindBuffer(GL_ARRAY_BUFFER, (GLuint)s->array_buffer);
    if (range[0] && range[2]) {
        gl->BindBufferRange(GL_UNIFORM_BUFFER, 0, (GLuint)range[0], range[1], range[2]);
    } else {
        gl->BindBufferBase(GL_UNIFORM_BUFFER, 0, (GLuint)range[0]);
    }
    gl->BindBuffer(GL_UNIFORM_BUFFER, (GLuint)s->uniform_buffer); /* also set by the binding above */
    gl->BindBuffer(GL_COPY_READ_BUFFER, (GLuint)s->copy_buffers[0]);
    gl->BindBuffer(GL_COPY_WRITE_BUFFER, (GLuint)s->copy_buffers[1]);
    gl->BindRenderbuffer(GL_RENDERBUFFER, (GLuint)s->renderbuffer);
}

void noh_gl_state_restore(const noh_gl_api *api, const noh_gl_state *state)
{
    noh_gl_pixels now;
    NOH_ASSERT(api && state);
    for (uint32_t i = 0; i < NOH_GL_STATE_UNITS; i++) {
        api->ActiveTexture(GL_TEXTURE0 + i);
        api->BindTexture(GL_TEXTURE_2D, (GLuint)state->units[i].texture_2d);
        api->BindTexture(GL_TEXTURE_2D_ARRAY, (GLuint)state->units[i].texture_array);
        api->BindTexture(GL_TEXTURE_CUBE_MAP, (GLuint)state->units[i].texture_cube);
        api->BindSampler(i, (GLuint)state->units[i].sampler);
    }
    api->ActiveTexture((GLenum)state->active_unit);
    restore_bindings(api, state);
    noh_gl_pack_begin(api, &now);
    noh_gl_pack_end(api, &state->pixels);
    if (!state->pixels.pack_buffer) api->BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    if (!state->pixels.unpack_buffer) api->BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    noh_gl_offscreen_end(api, &state->offscreen);
}
