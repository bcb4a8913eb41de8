/* gl_shadow.c: soft shadows by a variance shadow map (Donnelly, Lauritzen: Variance shadow maps, I3D 2006). The depth
 * of casters becomes two moments, blurred along x and then y at half the side; noh_key_shadow of
 * common_environment.glsl reads them once. */
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
#define SIGMA_MIN 1.5f /* of the blur, in texels */
#define SIGMA_MAX 3.0f

static noh_gl_texture_desc soft_desc(uint32_t shadow_px)
{
    const uint32_t side = (shadow_px + 1u) / 2u;
    return (noh_gl_texture_desc){ GL_RG16F, side, side, 0, 1, GL_LINEAR, 0 };
}

uint64_t noh_gl_soft_bytes(uint32_t shadow_px)
{
    const noh_gl_texture_desc desc = soft_desc(shadow_px);
    return 2u * noh_gl_texture_bytes(&desc);
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
    const noh_gl_texture_desc desc = soft_desc(l->desc.shadow_px);
    int kept[2];
    noh_result result = noh_gl_texture_create(l->gl, l->ledger, &desc, &l->rows, error);
    if (!result) result = noh_gl_texture_create(l->gl, l->ledger, &desc, &l->moments, error);
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

void noh_gl_soft_blur(const noh_gl_light *light, const float view_projection[16], const noh_lighting *lighting)
{
    const noh_gl_api *gl = light->gl;
    const float *m = view_projection;
    const float radius = 1.0f / noh_sqrt(m[0] * m[0] + m[4] * m[4] + m[8] * m[8]); /* of a parallel view */
    const float sigma = sigma_of(radius, light->desc.shadow_px);
    const GLsizei side = (GLsizei)((light->desc.shadow_px + 1u) / 2u);
    float blur[2][4] = { { 1.0f, 0.0f, 2.0f * sigma, (float)side } };
    if (lighting && lighting->has_floor) floor_plane(m, lighting->floor, radius, blur[1]);
    gl->BindFramebuffer(GL_FRAMEBUFFER, light->soft_framebuffer);
    gl->Viewport(0, 0, side, side);
    gl->UseProgram(light->blur);
    gl->BindVertexArray(light->vertex_array);
    noh_gl_samplers_none(gl, 0, 1);
    gl->ActiveTexture(GL_TEXTURE0);
    for (int pass = 0; pass < 2; pass++) {
        attach(light, pass ? &light->moments : &light->rows);
        gl->BindTexture(GL_TEXTURE_2D, pass ? light->rows.name : light->depth.name);
        if (pass) blur[0][0] = 0.0f, blur[0][1] = 1.0f, blur[0][2] = sigma;
        gl->Uniform4fv(light->u_blur, 2, blur[0]);
        gl->DrawArraysInstanced(GL_TRIANGLES, 0, 3, 1);
    }
    gl->BindTexture(GL_TEXTURE_2D, 0);
    gl->BindVertexArray(0);
    gl->UseProgram(0);
}
