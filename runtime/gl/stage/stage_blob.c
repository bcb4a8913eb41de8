#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/marks.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

#include <string.h>

#include "gl/device/gl_state_internal.h"
#include "gl/stage/drawable_internal.h"
#include "shaders.gen.h"
#include "stage/cast/stage_internal.h"

#define ROWS 3u
#define TEXT_OF(number) #number
#define TEXT(number) TEXT_OF(number)

enum { U_CAMERA = NOH_DRAWABLE_OWN, U_ROWS };

static const char *const uniform_names[] = { "u_camera", "u_rows" };
static const noh_gl_drawable_desc drawable_desc = { .name = { "blob" },
                                                    .vertex = &noh_shader_blob_vert,
                                                    .fragment = &noh_shader_blob_frag,
                                                    .defines = "#define NOH_BLOBS_DRAWN " TEXT(NOH_BLOBS_DRAWN) "\n",
                                                    .bare = 1,
                                                    .uniforms = uniform_names,
                                                    .uniform_count = 2 };

noh_result noh_stage_blob_create(const noh_gl_device *device, noh_stage_blob *out, noh_error *error)
{
    NOH_ASSERT(out);
    out->draws = 0;
    return noh_gl_drawable_create(device, &drawable_desc, &out->drawable, error);
}

void noh_stage_blob_delete(noh_stage_blob *blob)
{
    NOH_ASSERT(blob);
    noh_gl_drawable_delete(&blob->drawable);
}

noh_result noh_stage_blob_restore(noh_stage_blob *blob, char *log, size_t log_bytes, noh_error *error)
{
    NOH_ASSERT(blob);
    return noh_gl_drawable_restore(&blob->drawable, &drawable_desc, log, log_bytes, error);
}

static void begin(const noh_stage_blob *b, const noh_stage_view *view, const float origin[3], noh_gl_raster *raster)
{
    const noh_gl_drawable *d = &b->drawable;
    noh_stage_view near_by;
    noh_view_less(view, origin, &near_by);
    noh_gl_drawable_begin(d, NOH_DRAWABLE_COLOR);
    d->gl->UniformMatrix4fv(d->uniforms[NOH_DRAWABLE_COLOR][U_CAMERA], 1, GL_FALSE, near_by.view_projection);
    noh_gl_multiply_begin(d->gl, raster);
    d->gl->BlendFuncSeparate(GL_ZERO, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
}

static void draw_some(noh_stage_blob *b, const noh_blob *blobs, uint32_t count, const float origin[3])
{
    float rows[ROWS * NOH_BLOBS_DRAWN][4];
    for (uint32_t i = 0; i < count; i++) {
        float(*row)[4] = rows + ROWS * i;
        for (int n = 0; n < 3; n++) row[0][n] = blobs[i].centre[n] - origin[n];
        memcpy(row[1], blobs[i].along, 3 * sizeof(float));
        memcpy(row[2], blobs[i].across, 3 * sizeof(float));
        row[0][3] = blobs[i].darkness;
        row[1][3] = row[2][3] = 0.0f;
    }
    const noh_gl_drawable *d = &b->drawable;
    d->gl->Uniform4fv(d->uniforms[NOH_DRAWABLE_COLOR][U_ROWS], (GLsizei)(ROWS * count), rows[0]);
    d->gl->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, (GLsizei)count);
    b->draws++;
}

void noh_stage_blob_draw(noh_stage_blob *blob, const noh_stage_view *view, const noh_blob *blobs, uint32_t count)
{
    noh_gl_raster raster;
    float origin[3];
    NOH_ASSERT(blob && blob->drawable.gl && view && (blobs || !count));
    if (!count) return;
    noh_view_origin(view, origin);
    begin(blob, view, origin, &raster);
    for (uint32_t first = 0; first < count; first += NOH_BLOBS_DRAWN) {
        draw_some(blob, blobs + first, count - first < NOH_BLOBS_DRAWN ? count - first : NOH_BLOBS_DRAWN, origin);
    }
    noh_gl_drawable_end(&blob->drawable, &raster);
}
