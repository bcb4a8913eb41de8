#include "gl/stage/stage_decal.h"

#include <string.h>

#include "gl/device/gl_lost.h"
#include "gl/device/gl_state_internal.h"
#include "shaders.gen.h"
#include "gl/stage/stage_patch_internal.h"

#define ROW_TEXELS 4u
#define ROWS_SENT 16u /* at once: what fits on the stack */
#define NUDGE 2e-5f   /* of depth, towards the eye */

/* ---- what there is ---- */

static void bind(void *user, const noh_gl_api *api, GLuint program, const noh_material *material)
{
    const noh_stage_decals *d = user;
    (void)material;
    api->Uniform3f(api->GetUniformLocation(program, "u_marks"), (float)d->count,
                   d->picture.texture ? (float)d->picture.columns : 0.0f,
                   d->picture.texture ? (float)d->picture.rows : 0.0f);
    api->Uniform4f(api->GetUniformLocation(program, "u_towards"), d->reversed ? NUDGE : -NUDGE, 0.0f, 0.0f, 0.0f);
    api->Uniform1i(api->GetUniformLocation(program, "u_corner_row"), d->corners ? (GLint)d->corner_row : -1);
    api->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_USER + 2u);
    api->BindTexture(GL_TEXTURE_2D, d->corners);
    api->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_USER + 1u);
    api->BindTexture(GL_TEXTURE_2D, d->picture.texture ? d->picture.texture : d->shader->renderer.white.name);
    api->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_USER);
    api->BindTexture(GL_TEXTURE_2D, d->rows.name);
}

static noh_result create_rows(noh_stage_decals *d, noh_error *error)
{
    noh_gl_texture_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.format = GL_RGBA32F;
    desc.width = ROW_TEXELS;
    desc.height = NOH_DECALS_MAX;
    return noh_gl_texture_create(d->gl, d->ledger, &desc, &d->rows, error);
}

size_t noh_stage_decals_size(const noh_stage *stage)
{
    return noh_stage_shader_size(stage);
}

noh_result noh_stage_decals_create(noh_stage *stage, const noh_gl_device *device, void *memory, size_t bytes,
                                   const noh_decal_picture *picture, noh_stage_decals *out, noh_error *error)
{
    static const char *const samplers[] = { "u_decals", "u_picture", "u_corners" };
    noh_gl_shader_desc desc;
    noh_result result;
    NOH_ASSERT(stage && device && out);
    memset(out, 0, sizeof *out);
    memset(&desc, 0, sizeof desc);
    out->gl = device->api;
    out->ledger = device->ledger;
    out->stage = stage;
    if (picture) out->picture = *picture;
    desc.name = "decals";
    desc.vertex = noh_shader_decal_vertex_glsl;
    desc.defines = "#define NOH_REST\n";
    desc.fragment = noh_shader_decal_fragment_glsl;
    desc.samplers = samplers;
    desc.sampler_count = 3;
    desc.bind = bind;
    desc.user = out;
    result = noh_stage_shader_create(stage, memory, bytes, &desc, device->log, device->log_bytes, &out->shader, error);
    if (result) return result;
    result = create_rows(out, error);
    if (result) noh_stage_decals_delete(out);
    return result;
}

void noh_stage_decals_delete(noh_stage_decals *decals)
{
    NOH_ASSERT(decals && decals->gl);
    if (decals->shader) noh_stage_shader_delete(decals->shader);
    decals->shader = NULL;
    noh_gl_texture_delete(decals->gl, decals->ledger, &decals->rows);
}

noh_result noh_stage_decals_restore(noh_stage_decals *decals, const noh_decal_picture *picture, char *log,
                                    size_t log_bytes, noh_error *error)
{
    noh_result result;
    NOH_ASSERT(decals && decals->shader);
    memset(&decals->picture, 0, sizeof decals->picture);
    if (picture) decals->picture = *picture;
    noh_gl_texture_delete(noh_gl_lost_api(), decals->ledger, &decals->rows);
    result = noh_stage_shader_restore(decals->shader, log, log_bytes, error);
    if (!result) result = create_rows(decals, error);
    return result;
}

/* ---- drawing ---- */

static void set_row(const noh_decals *ring, uint32_t index, float row[ROW_TEXELS][4])
{
    const noh_decal *d = &ring->decals[index];
    memcpy(row[0], d->centre, 3 * sizeof(float));
    memcpy(row[1], d->right, 3 * sizeof(float));
    memcpy(row[2], d->normal, 3 * sizeof(float));
    for (int i = 0; i < 3; i++) row[3][i] = (float)d->color[i] / 255.0f;
    row[0][3] = d->size;
    row[1][3] = (float)d->tile;
    row[2][3] = noh_decal_alpha(ring, index) * (float)d->color[3] / 255.0f;
    row[3][3] = d->roughness;
}

static void send_rows(const noh_stage_decals *d, float rows[ROWS_SENT][ROW_TEXELS][4], uint32_t first, uint32_t count)
{
    noh_gl_pixels kept;
    noh_gl_unpack_begin(d->gl, &kept);
    d->gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, (GLint)first, ROW_TEXELS, (GLsizei)count, GL_RGBA, GL_FLOAT, rows);
    noh_gl_unpack_end(d->gl, &kept);
}

uint32_t noh_gl_decals_of(const noh_decals *ring, uint32_t mesh, uint8_t marks[NOH_DECALS_MAX])
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < ring->capacity; i++) {
        const uint32_t at = (ring->next + i) % ring->capacity;
        if (ring->decals[at].mesh == mesh && noh_decal_alpha(ring, at) > 0.0f) marks[count++] = (uint8_t)at;
    }
    return count;
}

static void upload_rows(noh_stage_decals *d, const noh_decals *ring, uint32_t mesh)
{
    float rows[ROWS_SENT][ROW_TEXELS][4];
    uint8_t marks[NOH_DECALS_MAX];
    d->count = noh_gl_decals_of(ring, mesh, marks);
    noh_gl_samplers_none(d->gl, NOH_UNIT_USER, 3);
    d->gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_USER);
    d->gl->BindTexture(GL_TEXTURE_2D, d->rows.name);
    for (uint32_t first = 0; first < d->count; first += ROWS_SENT) {
        const uint32_t now = d->count - first < ROWS_SENT ? d->count - first : ROWS_SENT;
        for (uint32_t i = 0; i < now; i++) set_row(ring, marks[first + i], rows[i]);
        send_rows(d, rows, first, now);
    }
}

static void unbind(const noh_stage_decals *d)
{
    for (uint32_t i = 3; i-- > 0;) {
        d->gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_USER + i);
        d->gl->BindTexture(GL_TEXTURE_2D, 0);
    }
}

/* The triangles that have marks, or all. */
static void draw_share(noh_stage_decals *decals, noh_stage_patches *patches, const noh_gl_alone *alone, uint32_t mesh,
                       const noh_gl_share *share, const noh_decals *ring)
{
    noh_gl_triangles triangles;
    decals->corners = 0;
    if (patches) {
        if (!noh_gl_patches_grow(patches, alone, mesh, share->level, ring, &triangles, &decals->corner_row)) return;
        decals->corners = patches->corners.name;
        noh_gl_draw_triangles(&decals->shader->renderer, &triangles);
    }
    noh_gl_draw_alone(alone, mesh, share);
    noh_gl_draw_triangles(&decals->shader->renderer, NULL);
    decals->draws++;
}

static void draw_mesh(noh_stage_decals *decals, noh_stage_patches *patches, const noh_gl_alone *alone, uint32_t mesh,
                      const noh_decals *ring)
{
    noh_gl_share shares[2];
    const uint32_t count = noh_gl_alone_shares(alone, mesh, shares);
    upload_rows(decals, ring, noh_gl_alone_mesh(alone, mesh));
    for (uint32_t i = 0; i < count && decals->count; i++) draw_share(decals, patches, alone, mesh, &shares[i], ring);
}

noh_result noh_stage_decals_draw(noh_stage_decals *decals, uint32_t view, noh_actor actor, const noh_decals *ring,
                                 noh_error *error)
{
    return noh_gl_decals_draw(decals, NULL, view, actor, ring, error);
}

noh_result noh_gl_decals_draw(noh_stage_decals *decals, noh_stage_patches *patches, uint32_t view, noh_actor actor,
                              const noh_decals *ring, noh_error *error)
{
    noh_gl_alone alone;
    noh_gl_raster *raster;
    noh_result result;
    NOH_ASSERT(decals && decals->shader && ring && !noh_decals_check(ring));
    result = noh_gl_begin_alone(decals->stage, &decals->shader->renderer, view, actor, &alone, error);
    if (result) return result;
    raster = &decals->shader->renderer.raster;
    decals->reversed = noh_gl_is_reversed(raster);
    noh_gl_blend_begin(decals->gl, raster);
    if (patches) noh_gl_patches_begin(patches, &alone);
    for (uint32_t m = 0; m < alone.mesh_count; m++) draw_mesh(decals, patches, &alone, m, ring);
    unbind(decals);
    noh_gl_draw_end(&decals->shader->renderer);
    return NOH_OK;
}
