#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

#include "gl/device/gl_state_internal.h"
#include "gl/stage/drawable_internal.h"
#include "gl/stage/stage_gl_internal.h"
#include "shaders.gen.h"

enum { U_CAMERA = NOH_DRAWABLE_OWN, U_DISC };

static noh_gl_drawable_desc desc_of(int encode_srgb)
{
    static const char *const uniforms[] = { "u_camera", "u_disc" };
    return (noh_gl_drawable_desc){ .name = { "floor" },
                                   .vertex = &noh_shader_floor_vert,
                                   .fragment = &noh_shader_floor_frag,
                                   .defines = noh_gl_encode_define(encode_srgb),
                                   .lit = 1,
                                   .uniforms = uniforms,
                                   .uniform_count = 2 };
}

noh_result noh_stage_floor_create(const noh_gl_device *device, int encode_srgb, noh_stage_floor *out, noh_error *error)
{
    const noh_gl_drawable_desc desc = desc_of(encode_srgb);
    NOH_ASSERT(out);
    out->encode_srgb = encode_srgb;
    return noh_gl_drawable_create(device, &desc, &out->drawable, error);
}

void noh_stage_floor_delete(noh_stage_floor *shadow)
{
    NOH_ASSERT(shadow);
    noh_gl_drawable_delete(&shadow->drawable);
}

noh_result noh_stage_floor_restore(noh_stage_floor *shadow, char *log, size_t log_bytes, noh_error *error)
{
    NOH_ASSERT(shadow);
    const noh_gl_drawable_desc desc = desc_of(shadow->encode_srgb);
    return noh_gl_drawable_restore(&shadow->drawable, &desc, log, log_bytes, error);
}

void noh_stage_floor_draw(const noh_stage_floor *shadow, const noh_gl_light *light, const noh_lighting *lighting,
                          const noh_stage_view *view, const float disc[4])
{
    noh_gl_raster raster;
    noh_stage_view near_by;
    float origin[3];
    NOH_ASSERT(shadow && shadow->drawable.gl && light && lighting && view && disc);
    const noh_gl_drawable *d = &shadow->drawable;
    const int *uniforms = d->uniforms[NOH_DRAWABLE_COLOR];
    if (!light->desc.shadow_px || view->eye[1] <= disc[1]) return;
    noh_view_origin(view, origin);
    noh_view_less(view, origin, &near_by);
    noh_gl_drawable_begin(d, NOH_DRAWABLE_COLOR);
    noh_gl_drawable_light(d, light, lighting, origin);
    d->gl->UniformMatrix4fv(uniforms[U_CAMERA], 1, GL_FALSE, near_by.view_projection);
    d->gl->Uniform4f(uniforms[U_DISC], disc[0] - origin[0], disc[1] - origin[1], disc[2] - origin[2], disc[3]);
    noh_gl_multiply_begin(d->gl, &raster);
    d->gl->BlendFuncSeparate(GL_ZERO, GL_SRC_COLOR, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    d->gl->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, 1);
    noh_gl_drawable_end(d, &raster);
}
