/* gl_shadow.c: soft shadows by a variance shadow map (Donnelly, Lauritzen: Variance shadow maps, I3D 2006). The depth
 * of casters becomes two moments at a quarter of the side, blurred along x and then y, and filtered at half the side;
 * noh_key_shadow of common_environment.glsl reads them once. */
#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"
#include "gl/device/gl_api_internal.h"
#include "gl/device/gl_debug_internal.h"
#include "gl/device/gl_memory_internal.h"
#include "gl/device/gl_names_internal.h"
#include "gl/device/gl_state_internal.h"
#include "gl/draw/gl_light_internal.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"

#include <string.h>

#include "shaders.gen.h"

#define LAMP 0.3f      /* width of a penumbra by the distance between caster and receiver */
#define SIGMA 0.005f   /* of the blur, in units of the world */
#define SIGMA_MIN 1.6f /* of the blur, in texels */
#define SIGMA_MAX 3.0f
#define KEPT 0.83f       /* of a Gaussian's variance, when it is cut off after two sigma */
#define REDUCED 0.078f   /* the variance that the first pass adds, in texels of a quarter of the side */
#define FILTERED 0.1875f /* and the last one */

static uint32_t half_of(uint32_t shadow_px)
{
    return (shadow_px + 1u) / 2u;
}

static uint32_t quarter_of(uint32_t shadow_px)
{
    return (shadow_px + 3u) / 4u;
}

static noh_gl_texture_desc soft_desc(uint32_t side)
{
    return (noh_gl_texture_desc){ GL_RG16F, side, side, 0, 1, GL_LINEAR, 0 };
}

uint64_t noh_gl_soft_bytes(uint32_t shadow_px)
{
    const noh_gl_texture_desc rows = soft_desc(quarter_of(shadow_px)), moments = soft_desc(half_of(shadow_px));
    return noh_gl_texture_bytes(&rows) + noh_gl_texture_bytes(&moments);
}

/* Of the blur, in texels of the soft map. */
static float sigma_of(float radius, uint32_t shadow_px)
{
    const float sigma = SIGMA * 0.25f * (float)shadow_px / radius;
    return sigma < SIGMA_MIN ? SIGMA_MIN : sigma > SIGMA_MAX ? SIGMA_MAX : sigma;
}

float noh_gl_soft_hardness(float radius, uint32_t shadow_px)
{
    const float width = 2.56f * sigma_of(radius, shadow_px); /* of a blurred edge, from a tenth to nine tenths */
    return width * 4.0f / (float)shadow_px / LAMP;
}

static noh_result create_program(noh_gl_light *l, char *log, size_t log_bytes, noh_error *error)
{
    static const char *const samplers[] = { "u_from" };
    noh_gl_program_desc d;
    memset(&d, 0, sizeof d);
    d.name = "soft shadow";
    d.vertex = &noh_shader_probe_triangle_vert;
    d.fragment = &noh_shader_shadow_blur_frag;
    d.samplers = samplers;
    d.sampler_count = 1;
    d.ledger = l->ledger;
    const noh_result result = noh_gl_program_create(l->gl, &d, &l->blur, log, log_bytes, error);
    if (result) return result;
    l->u_blur = l->gl->GetUniformLocation(l->blur, "u_blur");
    l->gl->GenVertexArrays(1, &l->vertex_array);
    return noh_gl_error_check(l->gl, "the driver refused a call while making a soft shadow map", 0, error);
}

static void attach(const noh_gl_light *l, const noh_gl_texture *to)
{
    l->gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, to->name, 0);
}

noh_result noh_gl_soft_create(noh_gl_light *light, char *log, size_t log_bytes, noh_error *error)
{
    noh_gl_light *l = light;
    const noh_gl_texture_desc rows = soft_desc(quarter_of(l->desc.shadow_px)),
                              moments = soft_desc(half_of(l->desc.shadow_px));
    int kept[2];
    noh_result result = noh_gl_texture_create(l->gl, l->ledger, &rows, &l->rows, error);
    if (!result) result = noh_gl_texture_create(l->gl, l->ledger, &moments, &l->moments, error);
    if (!result) result = noh_gl_framebuffer_create(l->gl, l->ledger, &l->soft_framebuffer, error);
    if (result) return result;
    noh_gl_framebuffers_keep(l->gl, kept);
    l->gl->BindFramebuffer(GL_FRAMEBUFFER, l->soft_framebuffer);
    attach(l, &l->rows);
    if (l->gl->CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        result = noh_fail(error, NOH_ERR_GL, "the driver cannot draw to the soft shadow map", 0, 0);
    }
    noh_gl_framebuffers_put_back(l->gl, kept);
    if (!result) result = noh_gl_error_check(l->gl, "the driver refused a soft shadow map", l->rows.bytes, error);
    return result ? result : create_program(l, log, log_bytes, error);
}

void noh_gl_soft_delete(noh_gl_light *light)
{
    noh_gl_program_delete(light->gl, light->ledger, &light->blur);
    if (light->vertex_array) light->gl->DeleteVertexArrays(1, &light->vertex_array);
    light->vertex_array = 0;
    noh_gl_framebuffer_delete(light->gl, light->ledger, &light->soft_framebuffer);
    noh_gl_texture_delete(light->gl, light->ledger, &light->rows);
    noh_gl_texture_delete(light->gl, light->ledger, &light->moments);
}

/* The depth of the floor in the light's clip space: plane[0] x + plane[1] y + plane[2]. plane[3]: 1, or 0 where the
 * light grazes the floor or comes from below. */
static void floor_plane(const float m[16], float floor, float radius, float plane[4])
{
    const float x0 = m[4] * floor + m[12], y0 = m[5] * floor + m[13], z0 = m[6] * floor + m[14];
    const float det = m[0] * m[9] - m[8] * m[1];
    memset(plane, 0, 4 * sizeof *plane);
    if (m[6] >= 0.0f || det * det * radius * radius * radius * radius < 0.01f) return;
    plane[0] = (m[2] * m[9] - m[10] * m[1]) / det;
    plane[1] = (m[10] * m[0] - m[2] * m[8]) / det;
    plane[2] = z0 - plane[0] * x0 - plane[1] * y0;
    plane[3] = 1.0f;
}

/* Weights of a texel of the blurred map and of three neighbours on each side: base to the square of the distance, which
 * is a Gaussian, by bisection of its base. Reducing the depths and filtering the result blur, too. */
static void weights_of(float sigma, float weights[4])
{
    const float wanted = 0.25f * KEPT * sigma * sigma - REDUCED - FILTERED; /* variance */
    float low = 0.0f, high = 1.0f, all = 1.0f;
    for (int turn = 0; turn < 16; turn++) {
        const float b = 0.5f * (low + high), b4 = b * b * b * b, b9 = b4 * b4 * b;
        all = 1.0f + 2.0f * (b + b4 + b9);
        *(2.0f * (b + 4.0f * b4 + 9.0f * b9) < wanted * all ? &low : &high) = b;
        weights[1] = b, weights[2] = b4, weights[3] = b9;
    }
    weights[0] = 1.0f;
    for (int i = 0; i < 4; i++) weights[i] /= all;
}

void noh_gl_soft_blur(const noh_gl_light *light, const float view_projection[16], const noh_lighting *lighting)
{
    const noh_gl_api *gl = light->gl;
    const float *m = view_projection;
    const float radius = 1.0f / noh_sqrt(m[0] * m[0] + m[4] * m[4] + m[8] * m[8]); /* of a parallel view */
    const GLsizei side = (GLsizei)quarter_of(light->desc.shadow_px), half = (GLsizei)half_of(light->desc.shadow_px);
    float blur[3][4] = { { 0.0f, (float)side, 2.0f / (float)light->desc.shadow_px } };
    weights_of(sigma_of(radius, light->desc.shadow_px), blur[1]);
    if (lighting && lighting->has_floor) floor_plane(m, lighting->floor, radius, blur[2]);
    gl->BindFramebuffer(GL_FRAMEBUFFER, light->soft_framebuffer);
    gl->Viewport(0, 0, side, side);
    gl->UseProgram(light->blur);
    gl->BindVertexArray(light->vertex_array);
    noh_gl_samplers_none(gl, 0, 1);
    gl->ActiveTexture(GL_TEXTURE0);
    for (int pass = 0; pass < 4; pass++) {
        const int to_moments = pass & 1; /* rows along x lie in a corner of it */
        const unsigned blurred = to_moments ? light->rows.name : light->moments.name;
        attach(light, to_moments ? &light->moments : &light->rows);
        gl->BindTexture(GL_TEXTURE_2D, pass ? blurred : light->depth.name);
        if (pass == 3) gl->Viewport(0, 0, half, half);
        blur[0][0] = (float)pass;
        gl->Uniform4fv(light->u_blur, 3, blur[0]);
        gl->DrawArraysInstanced(GL_TRIANGLES, 0, 3, 1);
    }
    gl->BindTexture(GL_TEXTURE_2D, 0);
    gl->BindVertexArray(0);
    gl->UseProgram(0);
}
