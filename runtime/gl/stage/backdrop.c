#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/light.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

#include <string.h>

#include "gl/device/gl_state_internal.h"
#include "gl/stage/drawable_internal.h"
#include "gl/light/light_internal.h"
#include "shaders.gen.h"

enum { U_RAYS = NOH_DRAWABLE_OWN, U_ENDS, U_KIND };

static noh_gl_drawable_desc desc_of(int encode_srgb)
{
    static const char *const uniforms[] = { "u_rays", "u_ends", "u_kind" };
    return (noh_gl_drawable_desc){ .name = { "backdrop" },
                                   .vertex = &noh_shader_backdrop_vert,
                                   .fragment = &noh_shader_backdrop_frag,
                                   .defines = noh_gl_encode_define(encode_srgb),
                                   .lit = 1,
                                   .uniforms = uniforms,
                                   .uniform_count = 3 };
}

noh_result noh_backdrop_create(const noh_gl_device *device, int encode_srgb, noh_backdrop *out, noh_error *error)
{
    const noh_gl_drawable_desc desc = desc_of(encode_srgb);
    NOH_ASSERT(out);
    out->encode_srgb = encode_srgb;
    return noh_gl_drawable_create(device, &desc, &out->drawable, error);
}

void noh_backdrop_delete(noh_backdrop *backdrop)
{
    NOH_ASSERT(backdrop);
    noh_gl_drawable_delete(&backdrop->drawable);
}

noh_result noh_backdrop_restore(noh_backdrop *backdrop, char *log, size_t log_bytes, noh_error *error)
{
    NOH_ASSERT(backdrop);
    const noh_gl_drawable_desc desc = desc_of(backdrop->encode_srgb);
    return noh_gl_drawable_restore(&backdrop->drawable, &desc, log, log_bytes, error);
}

/* The ray through the lower left corner, and what the width and the height of the viewport add to it. Rays end on one
 * plane. */
static void corner_rays(const noh_stage_view *view, float rays[3][4])
{
    static const float corners[3][2] = { { -0.5f, 0.5f }, { 0.5f, 0.5f }, { -0.5f, -0.5f } };
    float origin[3], forward[3] = { 0.0f, 0.0f, -1.0f };
    memset(rays, 0, 12 * sizeof(float));
    (void)noh_view_ray(view, 0.0f, 0.0f, 1, 1, origin, forward);
    for (int i = 0; i < 3; i++) {
        float d[3] = { 0.0f, 0.0f, -1.0f }, along;
        (void)noh_view_ray(view, corners[i][0], corners[i][1], 1, 1, origin, d);
        along = d[0] * forward[0] + d[1] * forward[1] + d[2] * forward[2];
        for (int k = 0; k < 3; k++) rays[i][k] = d[k] / along - (i ? rays[0][k] : 0.0f);
    }
}

/* Light from below and from above, from the bands that shaders use. */
static void gradient_ends(const noh_lighting *lighting, float ends[2][4])
{
    static const float normals[2][3] = { { 0.0f, -1.0f, 0.0f }, { 0.0f, 1.0f, 0.0f } };
    noh_light rest = lighting->rest;
    if (rest.order > 3u) rest.order = 3u;
    memset(ends, 0, 8 * sizeof(float));
    for (int i = 0; i < 2; i++) {
        noh_light_irradiance(&rest, normals[i], ends[i]);
        for (int k = 0; k < 3; k++) ends[i][k] = ends[i][k] > 0.0f ? ends[i][k] : 0.0f;
    }
}

void noh_backdrop_draw(const noh_backdrop *backdrop, noh_backdrop_kind kind, const noh_gl_light *light,
                       const noh_lighting *lighting, const noh_stage_view *view)
{
    static const float origin[3];
    float rays[3][4], ends[2][4];
    noh_gl_raster raster;
    NOH_ASSERT(backdrop && backdrop->drawable.gl && light && lighting && view);
    const noh_gl_drawable *d = &backdrop->drawable;
    const noh_gl_api *gl = d->gl;
    const int *uniforms = d->uniforms[NOH_DRAWABLE_COLOR];
    corner_rays(view, rays);
    gradient_ends(lighting, ends);
    noh_gl_drawable_begin(d, NOH_DRAWABLE_COLOR);
    noh_gl_drawable_light(d, light, lighting, origin);
    gl->Uniform4fv(uniforms[U_RAYS], 3, rays[0]);
    gl->Uniform4fv(uniforms[U_ENDS], 2, ends[0]);
    gl->Uniform4f(uniforms[U_KIND], kind == NOH_BACKDROP_LIGHT ? 1.0f : 0.0f, 0.0f, 0.0f, 0.0f);
    noh_gl_behind_begin(gl, &raster);
    gl->DrawArraysInstanced(GL_TRIANGLES, 0, 3, 1);
    noh_gl_drawable_end(d, &raster);
}
