/* gl_caps.c: the probe of a context's abilities.
 *
 * Each ability is tested the way the library uses it: known floats are drawn into the three layers of an array texture
 * and read back. A driver may claim a format and then clamp, round or drop the values written to it, so only the values
 * read back count. Each layer gets different values, which reveals swapped and missing layers. */
#include "core/base/math_internal.h"
#include "core/base/assert_internal.h"
#include "gl/device/gl_api_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"

#include <string.h>

#include "gl/device/gl_state_internal.h"
#include "gl/device/gl_debug_internal.h"
#include "gl/device/gl_quirks_internal.h"
#include "core/base/half_internal.h"
#include "shaders.gen.h"

#define TEXELS 16
#define FLOATS (TEXELS * 4)
#define LAYERS 3
#define PASSES 3 /* rows of values: the first is stored, then one draw blends two on top of it */

/* The GL objects that all probes share. */
typedef struct probe {
    const noh_gl_api *api;
    GLuint vertex_array;
    GLuint framebuffer;
    GLuint values;   /* texture, TEXELS x PASSES RGBA32F: what the fragment shaders write */
    GLuint floats;   /* program that writes the values */
    GLuint bits;     /* program that writes their bits as integers */
    GLint first_row; /* uniform location in `floats` */
} probe;

/* The result of drawing into a float format. */
typedef struct float_result {
    int stored, stored_exact, blended, blended_exact;
    noh_half_mode store_mode, blend_mode;
} float_result;

/* --- the numbers --- */

/* 64 floats of both signs with full mantissas and magnitudes from 2^-20 to 2^2, by a linear congruential generator
 * (Numerical Recipes' constants). Their halves and sums include ties, denormals, and roundings up and down. */
static void make_values(float values[FLOATS], uint32_t pass)
{
    uint32_t state = 0x9e3779b9u * (pass + 1);
    for (uint32_t i = 0; i < FLOATS; i++) {
        state = state * 1664525u + 1013904223u;
        uint32_t exponent = 107u + (state >> 9) % 22u;
        uint32_t sign = state & 0x80000000u;
        state = state * 1664525u + 1013904223u;
        uint32_t bits = sign | (exponent << 23) | (state >> 9);
        /* Every fourth value lies exactly between two halves: ties distinguish the rounding modes. */
        if (i % 4 == 3) bits = (bits & ~0x1fffu) | 0x1000u;
        memcpy(&values[i], &bits, sizeof bits);
    }
}

/* The value that probe_floats.frag writes to a layer; i counts the channels of its texels. */
static float value_at(const float values[FLOATS], uint32_t layer, uint32_t i)
{
    return values[(i + layer * 4) % FLOATS];
}

/* --- drawing and reading back --- */

static GLuint make_array(const noh_gl_api *gl, GLenum format)
{
    GLuint texture = 0;
    gl->GenTextures(1, &texture);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, texture);
    gl->TexStorage3D(GL_TEXTURE_2D_ARRAY, 1, format, TEXELS, 1, LAYERS);
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, 0);
    return texture;
}

static void attach(const probe *p, GLuint texture, uint32_t attachment, uint32_t layer)
{
    p->api->FramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + attachment, texture, 0, (GLint)layer);
}

/* Attach the three layers as draw buffers. Return 0 if the driver refuses. */
static int attach_layers(const probe *p, GLuint texture)
{
    static const GLenum buffers[LAYERS] = { GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2 };
    p->api->BindFramebuffer(GL_FRAMEBUFFER, p->framebuffer);
    for (uint32_t i = 0; i < LAYERS; i++) attach(p, texture, i, i);
    p->api->DrawBuffers(LAYERS, buffers);
    GLenum status = p->api->CheckFramebufferStatus(GL_FRAMEBUFFER);
    return noh_gl_error_take(p->api) == GL_NO_ERROR && status == GL_FRAMEBUFFER_COMPLETE;
}

static void detach_layers(const probe *p)
{
    static const GLenum one = GL_COLOR_ATTACHMENT0;
    p->api->BindFramebuffer(GL_FRAMEBUFFER, p->framebuffer);
    for (uint32_t i = 0; i < LAYERS; i++) attach(p, 0, i, 0);
    p->api->DrawBuffers(1, &one);
    p->api->ReadBuffer(GL_COLOR_ATTACHMENT0);
}

static void draw(const probe *p, GLuint program, GLsizei instances)
{
    p->api->Viewport(0, 0, TEXELS, 1);
    p->api->ActiveTexture(GL_TEXTURE0);
    p->api->BindTexture(GL_TEXTURE_2D, p->values);
    p->api->BindVertexArray(p->vertex_array);
    p->api->UseProgram(program);
    p->api->DrawArraysInstanced(GL_TRIANGLES, 0, 3, instances);
}

/* Draw rows of values on top of each other and read all layers. One draw, like an accumulation, because a tiling GPU
 * may keep float32 sums in its tile until the draw ends. Return 0 on any GL error. */
static int draw_and_read(const probe *p, GLint first_row, GLsizei rows, float pixels[LAYERS][FLOATS])
{
    p->api->UseProgram(p->floats);
    p->api->Uniform1i(p->first_row, first_row);
    draw(p, p->floats, rows);
    memset(pixels, 0, sizeof(float) * LAYERS * FLOATS);
    for (uint32_t i = 0; i < LAYERS; i++) {
        p->api->ReadBuffer(GL_COLOR_ATTACHMENT0 + i);
        p->api->ReadPixels(0, 0, TEXELS, 1, GL_RGBA, GL_FLOAT, pixels[i]);
    }
    return noh_gl_error_take(p->api) == GL_NO_ERROR;
}

/* --- comparing ---
 *
 * The result is compared with four models: exact float32 sums, and halves rounded after each pass toward zero, after
 * each pass to nearest, or toward zero before each pass and to nearest after it. The values make the models differ,
 * also by ties; the model that matches every bit shows how this driver rounds. If none matches, half-float results are
 * only known within a bound. */

/* Expected contents of the target after some passes, by rounding model. */
typedef struct models {
    float exact[LAYERS][FLOATS];   /* float32 sums */
    float rtz[LAYERS][FLOATS];     /* halves rounded toward zero */
    float rne[LAYERS][FLOATS];     /* halves rounded to nearest, ties to even */
    float rtz_rne[LAYERS][FLOATS]; /* each term toward zero, the sum to nearest */
} models;

typedef struct comparison {
    int close, exact, rtz, rne, rtz_rne;
} comparison;

static void advance(models *m, uint32_t pass)
{
    float values[FLOATS];
    make_values(values, pass);
    for (uint32_t layer = 0; layer < LAYERS; layer++) {
        for (uint32_t i = 0; i < FLOATS; i++) {
            float value = value_at(values, layer, i);
            m->exact[layer][i] = m->exact[layer][i] + value;
            m->rtz[layer][i] = noh_half_round(m->rtz[layer][i] + value, NOH_HALF_RTZ);
            m->rne[layer][i] = noh_half_round(m->rne[layer][i] + value, NOH_HALF_RNE);
            m->rtz_rne[layer][i] = noh_half_round(m->rtz_rne[layer][i] + noh_half_round(value, NOH_HALF_RTZ),
                                                  NOH_HALF_RNE);
        }
    }
}

/* Close: within the error of a half-float accumulator in three passes over values below 4, flushed denormals included.
 * A missing pass exceeds it by far. */
static comparison compare(const models *m, float pixels[LAYERS][FLOATS])
{
    comparison out = { 1, 1, 1, 1, 1 };
    for (uint32_t layer = 0; layer < LAYERS; layer++) {
        for (uint32_t i = 0; i < FLOATS; i++) {
            float got = pixels[layer][i];
            float bound = 0x1p-7f * (noh_abs(m->exact[layer][i]) + 4.0f);
            /* negated, so that a NaN is not close */
            if (!(noh_abs(got - m->exact[layer][i]) <= bound)) out.close = 0;
            if (memcmp(&got, &m->exact[layer][i], sizeof got) != 0) out.exact = 0;
            if (memcmp(&got, &m->rtz[layer][i], sizeof got) != 0) out.rtz = 0;
            if (memcmp(&got, &m->rne[layer][i], sizeof got) != 0) out.rne = 0;
            if (memcmp(&got, &m->rtz_rne[layer][i], sizeof got) != 0) out.rtz_rne = 0;
        }
    }
    return out;
}

/* Without blending, RTZ_RNE gives the same bits as RTZ, so the plain modes are tested first. */
static noh_half_mode mode_of(const comparison *c)
{
    if (c->rtz && c->rne) return NOH_HALF_UNKNOWN;
    return c->rtz ? NOH_HALF_RTZ : c->rne ? NOH_HALF_RNE : c->rtz_rne ? NOH_HALF_RTZ_RNE : NOH_HALF_UNKNOWN;
}

/* --- the probes --- */

static void probe_blend(const probe *p, models *m, float_result *out)
{
    float pixels[LAYERS][FLOATS];
    p->api->BlendEquation(GL_FUNC_ADD);
    p->api->BlendFunc(GL_ONE, GL_ONE);
    p->api->Enable(GL_BLEND);
    int drawn = draw_and_read(p, 1, PASSES - 1, pixels);
    p->api->Disable(GL_BLEND);
    p->api->BlendFunc(GL_ONE, GL_ZERO);
    for (uint32_t pass = 1; pass < PASSES; pass++) advance(m, pass);
    comparison sum = compare(m, pixels);
    if (!drawn || !sum.close) return;
    out->blended = 1;
    out->blended_exact = sum.exact;
    out->blend_mode = mode_of(&sum);
}

static void probe_store(const probe *p, models *m, float_result *out)
{
    static const GLfloat clear[4] = { 7.0f, 7.0f, 7.0f, 7.0f };
    float pixels[LAYERS][FLOATS];
    for (GLint i = 0; i < LAYERS; i++) p->api->ClearBufferfv(GL_COLOR, i, clear);
    int drawn = draw_and_read(p, 0, 1, pixels);
    advance(m, 0);
    comparison stored = compare(m, pixels);
    if (!drawn || !stored.close) return;
    out->stored = 1;
    out->stored_exact = stored.exact;
    out->store_mode = mode_of(&stored);
}

static float_result probe_floats(const probe *p, GLenum format)
{
    float_result out;
    models m;
    memset(&out, 0, sizeof out);
    memset(&m, 0, sizeof m);
    GLuint texture = make_array(p->api, format);
    if (noh_gl_error_take(p->api) == GL_NO_ERROR && attach_layers(p, texture)) {
        probe_store(p, &m, &out);
        if (out.stored) probe_blend(p, &m, &out);
    }
    detach_layers(p);
    p->api->DeleteTextures(1, &texture);
    noh_gl_error_take(p->api);
    return out;
}

/* The same three layers as integers. */
static int probe_u32(const probe *p)
{
    uint32_t pixels[FLOATS];
    float values[FLOATS];
    make_values(values, 0);
    GLuint texture = make_array(p->api, GL_RGBA32UI);
    int right = noh_gl_error_take(p->api) == GL_NO_ERROR && attach_layers(p, texture);
    if (right) draw(p, p->bits, 1);
    for (uint32_t layer = 0; layer < LAYERS && right; layer++) {
        memset(pixels, 0, sizeof pixels);
        p->api->ReadBuffer(GL_COLOR_ATTACHMENT0 + layer);
        p->api->ReadPixels(0, 0, TEXELS, 1, GL_RGBA_INTEGER, GL_UNSIGNED_INT, pixels);
        right = noh_gl_error_take(p->api) == GL_NO_ERROR;
        for (uint32_t i = 0; i < FLOATS; i++) {
            float value = value_at(values, layer, i);
            right = right && memcmp(&value, &pixels[i], sizeof value) == 0;
        }
    }
    detach_layers(p);
    p->api->DeleteTextures(1, &texture);
    noh_gl_error_take(p->api);
    return right;
}

/* Layered drawing is tested in RGBA8, because float rendering is a separate capability. */
static int draw_layers(const probe *p, GLuint program, GLuint texture)
{
    static const GLfloat clear[4] = { 1.0f, 1.0f, 1.0f, 1.0f };
    static const GLenum buffer = GL_COLOR_ATTACHMENT0;
    const noh_gl_api *gl = p->api;
    gl->BindFramebuffer(GL_FRAMEBUFFER, p->framebuffer);
    gl->FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture, 0);
    gl->DrawBuffers(1, &buffer);
    if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) return 0;
    gl->ClearBufferfv(GL_COLOR, 0, clear);
    draw(p, program, 1);
    return noh_gl_error_take(gl) == GL_NO_ERROR;
}

static int read_layers(const probe *p, GLuint texture)
{
    int right = 1;
    for (uint32_t layer = 0; layer < LAYERS; layer++) {
        uint8_t pixels[FLOATS];
        memset(pixels, 0, sizeof pixels);
        attach(p, texture, 0, layer);
        p->api->ReadBuffer(GL_COLOR_ATTACHMENT0);
        p->api->ReadPixels(0, 0, TEXELS, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
        uint32_t want = 51u * (layer + 1u);
        for (uint32_t i = 0; i < FLOATS; i++) right = right && pixels[i] + 1u >= want && pixels[i] <= want + 1u;
    }
    return noh_gl_error_take(p->api) == GL_NO_ERROR && right;
}

static int probe_layered(const probe *p)
{
    const noh_gl_api *gl = p->api;
    if (!gl->FramebufferTexture) return 0;
    noh_gl_program_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.name = "noh probe layers";
    desc.vertex = &noh_shader_probe_triangle_vert;
    desc.geometry = &noh_shader_probe_layers_geom;
    desc.fragment = &noh_shader_probe_layers_frag;
    desc.version = noh_gl_geometry_version(gl);
    desc.geometry_defines = noh_gl_geometry_defines(gl);
    GLuint program = 0;
    if (noh_gl_program_create(gl, &desc, &program, NULL, 0, NULL) != NOH_OK) {
        noh_gl_error_take(gl);
        return 0;
    }
    GLuint texture = make_array(gl, GL_RGBA8);
    int right = draw_layers(p, program, texture) && read_layers(p, texture);
    detach_layers(p);
    gl->DeleteTextures(1, &texture);
    noh_gl_program_delete(gl, NULL, &program);
    noh_gl_error_take(gl);
    return right;
}

static void draw_points(const probe *p, GLuint program, uint8_t pixels[4 * 16 * 16])
{
    static const GLfloat clear[4] = { 0.0f, 0.0f, 0.0f, 0.0f };
    const noh_gl_api *gl = p->api;
    gl->Viewport(0, 0, 16, 16);
    gl->ClearBufferfv(GL_COLOR, 0, clear);
    gl->BindVertexArray(p->vertex_array);
    gl->UseProgram(program);
    gl->BlendEquation(GL_FUNC_ADD);
    gl->BlendFunc(GL_ONE, GL_ONE);
    gl->Enable(GL_BLEND);
    if (!gl->is_es) gl->Enable(NOH_GL_PROGRAM_POINT_SIZE);
    gl->DrawArraysInstanced(GL_POINTS, 0, 8, 1);
    if (!gl->is_es) gl->Disable(NOH_GL_PROGRAM_POINT_SIZE);
    gl->Disable(GL_BLEND);
    gl->ReadPixels(0, 0, 16, 16, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
}

/* Points over half of the 4 x 4 blocks of a layer, each added once. Reveals texels that are covered twice, not at all,
 * or by the neighbouring block's point. */
static int probe_points(const probe *p)
{
    const noh_gl_api *gl = p->api;
    GLuint program = 0, texture = 0;
    noh_gl_program_desc desc;
    uint8_t pixels[4 * 16 * 16];
    memset(&desc, 0, sizeof desc);
    desc.name = "noh probe points";
    desc.vertex = &noh_shader_probe_points_vert;
    desc.fragment = &noh_shader_probe_points_frag;
    if (noh_gl_program_create(gl, &desc, &program, NULL, 0, NULL) != NOH_OK) {
        noh_gl_error_take(gl);
        return 0;
    }
    gl->GenTextures(1, &texture);
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, texture);
    gl->TexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_RGBA8, 16, 16, 1);
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, 0);
    memset(pixels, 0, sizeof pixels);
    gl->BindFramebuffer(GL_FRAMEBUFFER, p->framebuffer);
    attach(p, texture, 0, 0);
    int right = gl->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    if (right) draw_points(p, program, pixels);
    for (uint32_t i = 0; i < 16 * 16; i++) {
        const uint32_t on = (i % 16 / 4 + i / 16 / 4) % 2, got = pixels[4 * i];
        right = right && (on ? got >= 50u && got <= 52u : got == 0u);
    }
    detach_layers(p);
    gl->DeleteTextures(1, &texture);
    noh_gl_program_delete(gl, NULL, &program);
    return noh_gl_error_take(gl) == GL_NO_ERROR && right;
}

/* A driver may list the extension and have a counter of 0 bits: it cannot measure time. */
static int probe_timer(const noh_gl_api *gl)
{
    if (!gl->TimeGenQueries || !gl->TimeDeleteQueries || !gl->TimeBeginQuery || !gl->TimeEndQuery ||
        !gl->TimeGetQueryiv || !gl->TimeGetQueryObjectuiv || !gl->TimeGetQueryObjectui64v) {
        return 0;
    }
    GLint bits = 0;
    GLuint query = 0;
    gl->TimeGetQueryiv(GL_TIME_ELAPSED_EXT, GL_QUERY_COUNTER_BITS_EXT, &bits);
    gl->TimeGenQueries(1, &query);
    gl->TimeBeginQuery(GL_TIME_ELAPSED_EXT, query);
    gl->TimeEndQuery(GL_TIME_ELAPSED_EXT);
    gl->TimeDeleteQueries(1, &query);
    return noh_gl_error_take(gl) == GL_NO_ERROR && bits > 0;
}

/* --- texts and limits --- */

static uint64_t hash_text(uint64_t hash, const char *text)
{
    do {
        hash = (hash ^ (uint8_t)*text) * 0x100000001b3u;
    } while (*text++);
    return hash;
}

static void copy_text(const noh_gl_api *api, GLenum what, char *to, size_t room, uint64_t *hash)
{
    const char *text = (const char *)api->GetString(what);
    if (!text) text = "";
    *hash = hash_text(*hash, text);
    size_t i = 0;
    for (; text[i] && i + 1 < room; i++) to[i] = text[i];
    to[i] = 0;
}

static uint32_t get_limit(const noh_gl_api *api, GLenum what)
{
    GLint value = 0;
    api->GetIntegerv(what, &value);
    return value > 0 ? (uint32_t)value : 0;
}

static void read_limits(const noh_gl_api *api, noh_gl_caps *out)
{
    out->version = api->version;
    out->is_es = api->is_es;
    out->renderer_hash = 0xcbf29ce484222325u;
    copy_text(api, GL_VENDOR, out->vendor, sizeof out->vendor, &out->renderer_hash);
    copy_text(api, GL_RENDERER, out->renderer, sizeof out->renderer, &out->renderer_hash);
    copy_text(api, GL_VERSION, out->version_text, sizeof out->version_text, &out->renderer_hash);
    out->texture_size_max = get_limit(api, GL_MAX_TEXTURE_SIZE);
    out->array_layers_max = get_limit(api, GL_MAX_ARRAY_TEXTURE_LAYERS);
    out->draw_buffers_max = get_limit(api, GL_MAX_DRAW_BUFFERS);
    out->color_attachments_max = get_limit(api, GL_MAX_COLOR_ATTACHMENTS);
    out->samples_max = get_limit(api, GL_MAX_SAMPLES);
    out->vertex_textures_max = get_limit(api, GL_MAX_VERTEX_TEXTURE_IMAGE_UNITS);
    out->vertex_attributes_max = get_limit(api, GL_MAX_VERTEX_ATTRIBS);
    out->uniform_block_bytes_max = get_limit(api, GL_MAX_UNIFORM_BLOCK_SIZE);
    out->uniform_offset_align = get_limit(api, GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT);
}

const char *noh_gl_geometry_version(const noh_gl_api *api)
{
    NOH_ASSERT(api);
    if (!api->FramebufferTexture) return NULL;
    return api->geometry_ext ? "#version 310 es\n" : "#version 320 es\n";
}

const char *noh_gl_geometry_defines(const noh_gl_api *api)
{
    NOH_ASSERT(api);
    if (api->geometry_ext == 1) return "#extension GL_EXT_geometry_shader : require\n";
    if (api->geometry_ext == 2) return "#extension GL_OES_geometry_shader : require\n";
    return NULL;
}

/* --- the entire probe --- */

static noh_result make_programs(probe *p, noh_error *error)
{
    static const char *const samplers[] = { "values" };
    noh_gl_program_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.name = "noh probe";
    desc.vertex = &noh_shader_probe_triangle_vert;
    desc.samplers = samplers;
    desc.sampler_count = 1;
    desc.fragment = &noh_shader_probe_floats_frag;
    noh_result result = noh_gl_program_create(p->api, &desc, &p->floats, NULL, 0, error);
    if (result != NOH_OK) return result;
    desc.fragment = &noh_shader_probe_bits_frag;
    return noh_gl_program_create(p->api, &desc, &p->bits, NULL, 0, error);
}

static noh_result start(probe *p, noh_error *error)
{
    const noh_gl_api *gl = p->api;
    noh_gl_error_take(gl);
    if (make_programs(p, error) != NOH_OK) {
        return noh_fail(error, NOH_ERR_GL, "cannot build the programs of the capability probe", noh_gl_error_take(gl),
                        0);
    }
    gl->GenVertexArrays(1, &p->vertex_array);
    gl->GenFramebuffers(1, &p->framebuffer);
    gl->GenTextures(1, &p->values);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, p->values);
    gl->TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, TEXELS, PASSES);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    for (uint32_t pass = 0; pass < PASSES; pass++) {
        float values[FLOATS];
        make_values(values, pass);
        gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, (GLint)pass, TEXELS, 1, GL_RGBA, GL_FLOAT, values);
    }
    p->first_row = gl->GetUniformLocation(p->floats, "first_row");
    GLenum code = noh_gl_error_take(gl);
    if (code != GL_NO_ERROR)
        return noh_fail(error, NOH_ERR_GL, "the driver refused the texture of the capability probe", code, 0);
    return NOH_OK;
}

static void finish(probe *p)
{
    const noh_gl_api *gl = p->api;
    gl->UseProgram(0);
    gl->BindVertexArray(0);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    gl->DeleteTextures(1, &p->values);
    gl->DeleteFramebuffers(1, &p->framebuffer);
    gl->DeleteVertexArrays(1, &p->vertex_array);
    noh_gl_program_delete(gl, NULL, &p->floats);
    noh_gl_program_delete(gl, NULL, &p->bits);
    noh_gl_error_take(gl);
}

static void run_probes(const probe *p, noh_gl_caps *caps)
{
    float_result f32 = probe_floats(p, GL_RGBA32F);
    caps->render_f32 = f32.stored_exact;
    caps->blend_f32 = f32.stored_exact && f32.blended;
    caps->blend_f32_exact = caps->blend_f32 && f32.blended_exact;
    float_result f16 = probe_floats(p, GL_RGBA16F);
    caps->render_f16 = f16.stored;
    caps->blend_f16 = f16.blended;
    caps->f16_store_mode = f16.store_mode;
    caps->f16_blend_mode = f16.blend_mode;
    if (noh_gl_quirk_find(caps->renderer, NOH_QUIRK_HALF_UNSURE)) {
        caps->f16_store_mode = caps->f16_blend_mode = NOH_HALF_UNKNOWN;
    }
    caps->render_u32 = probe_u32(p);
    caps->mrt3 = caps->render_f32 || caps->render_f16 || caps->render_u32;
    caps->layered = probe_layered(p);
    caps->block_points = probe_points(p);
    caps->timer_query = probe_timer(p->api);
    caps->etc2 = p->api->etc2;
    caps->astc = p->api->astc;
}

noh_result noh_gl_caps_probe(const noh_gl_api *api, noh_gl_caps *out, noh_error *error)
{
    if (!api) return noh_fail(error, NOH_ERR_ARG, "api is NULL", 0, 0);
    if (!out) return noh_fail(error, NOH_ERR_ARG, "out is NULL", 0, 0);
    noh_gl_caps caps;
    probe p;
    noh_gl_offscreen kept;
    noh_gl_pixels pixels;
    memset(&caps, 0, sizeof caps);
    memset(&p, 0, sizeof p);
    p.api = api;
    read_limits(api, &caps);
    noh_gl_group_begin(api, "noh probe", NULL);
    noh_gl_offscreen_begin(api, &kept);
    noh_gl_pack_begin(api, &pixels);
    noh_gl_samplers_none(api, 0, 1);
    noh_result result = start(&p, error);
    if (result == NOH_OK) run_probes(&p, &caps);
    finish(&p);
    noh_gl_pack_end(api, &pixels);
    noh_gl_offscreen_end(api, &kept);
    noh_gl_group_end(api);
    if (result == NOH_OK) *out = caps;
    return result;
}

/* ---- without a driver ---- */

void noh_gl_caps_nominal(noh_gl_caps *out)
{
    static const char name[] = "a nominal GLES 3.2 device";
    NOH_ASSERT(out);
    memset(out, 0, sizeof *out);
    out->version = 320;
    out->is_es = 1;
    memcpy(out->renderer, name, sizeof name);
    out->texture_size_max = 2048;
    out->array_layers_max = 256;
    out->draw_buffers_max = out->color_attachments_max = 4;
    out->uniform_block_bytes_max = 16384;
    out->vertex_textures_max = 16;
    out->vertex_attributes_max = 16;
    out->mrt3 = out->render_f32 = out->render_f16 = out->render_u32 = 1;
    out->blend_f32 = out->blend_f16 = out->blend_f32_exact = out->layered = 1;
    out->etc2 = out->astc = 1;
}
