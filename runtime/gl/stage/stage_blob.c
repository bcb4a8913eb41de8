#include "gl/stage/stage_blob.h"

#include <string.h>

#include "gl/device/gl_lost.h"
#include "gl/device/gl_state_internal.h"
#include "gl/device/gl_program.h"
#include "shaders.gen.h"
#include "stage/cast/stage_internal.h"

#define ROWS 3u
#define TEXT_OF(number) #number
#define TEXT(number) TEXT_OF(number)

static noh_result create_objects(noh_stage_blob *b, char *log, size_t log_bytes, noh_error *error)
{
    noh_gl_program_desc desc;
    noh_result result;
    memset(&desc, 0, sizeof desc);
    desc.name = "blob";
    desc.defines = "#define NOH_BLOBS_DRAWN " TEXT(NOH_BLOBS_DRAWN) "\n";
    desc.vertex = &noh_shader_blob_vert;
    desc.fragment = &noh_shader_blob_frag;
    desc.ledger = b->ledger;
    result = noh_gl_program_create(b->gl, &desc, &b->program, log, log_bytes, error);
    if (result) return result;
    b->gl->GenVertexArrays(1, &b->vertex_array);
    b->camera = b->gl->GetUniformLocation(b->program, "u_camera");
    b->rows = b->gl->GetUniformLocation(b->program, "u_rows");
    return NOH_OK;
}

noh_result noh_stage_blob_create(const noh_gl_device *device, noh_stage_blob *out, noh_error *error)
{
    NOH_ASSERT(device && device->api && device->ledger && out);
    memset(out, 0, sizeof *out);
    out->gl = device->api;
    out->ledger = device->ledger;
    return create_objects(out, device->log, device->log_bytes, error);
}

void noh_stage_blob_delete(noh_stage_blob *blob)
{
    NOH_ASSERT(blob && blob->gl);
    if (blob->vertex_array) blob->gl->DeleteVertexArrays(1, &blob->vertex_array);
    blob->vertex_array = 0;
    noh_gl_program_delete(blob->gl, blob->ledger, &blob->program);
}

noh_result noh_stage_blob_restore(noh_stage_blob *blob, char *log, size_t log_bytes, noh_error *error)
{
    const noh_gl_api *gl;
    NOH_ASSERT(blob && blob->gl);
    gl = blob->gl;
    blob->gl = noh_gl_lost_api();
    noh_stage_blob_delete(blob);
    blob->gl = gl;
    return create_objects(blob, log, log_bytes, error);
}

static void begin(const noh_stage_blob *b, const noh_stage_view *view, const float origin[3], noh_gl_raster *raster)
{
    const noh_gl_api *gl = b->gl;
    noh_stage_view near_by;
    noh_view_less(view, origin, &near_by);
    gl->UseProgram(b->program);
    gl->UniformMatrix4fv(b->camera, 1, GL_FALSE, near_by.view_projection);
    noh_gl_multiply_begin(gl, raster);
    gl->BlendFuncSeparate(GL_ZERO, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    gl->BindVertexArray(b->vertex_array);
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
    b->gl->Uniform4fv(b->rows, (GLsizei)(ROWS * count), rows[0]);
    b->gl->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, (GLsizei)count);
    b->draws++;
}

void noh_stage_blob_draw(noh_stage_blob *blob, const noh_stage_view *view, const noh_blob *blobs, uint32_t count)
{
    noh_gl_raster raster;
    float origin[3];
    NOH_ASSERT(blob && blob->gl && view && (blobs || !count));
    if (!count) return;
    noh_view_origin(view, origin);
    begin(blob, view, origin, &raster);
    for (uint32_t first = 0; first < count; first += NOH_BLOBS_DRAWN) {
        draw_some(blob, blobs + first, count - first < NOH_BLOBS_DRAWN ? count - first : NOH_BLOBS_DRAWN, origin);
    }
    blob->gl->BindVertexArray(0);
    noh_gl_raster_put_back(blob->gl, &raster);
    blob->gl->UseProgram(0);
}
