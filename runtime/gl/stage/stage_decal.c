#include "core/base/assert_internal.h"
#include "gl/device/gl_api_internal.h"
#include "gl/draw/gl_draw_internal.h"
#include "gl/draw/gl_renderer_internal.h"
#include "stage/actors/decal_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/marks.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

#include <string.h>

#include "gl/device/gl_state_internal.h"
#include "gl/stage/drawable_internal.h"
#include "gl/stage/stage_patch_internal.h"
#include "shaders.gen.h"

#define ROW_TEXELS 4u
#define ROWS_SENT 16u /* rows uploaded at a time: they are on the stack */
#define NUDGE 2e-5f   /* of depth, towards the eye */

/* ---- programs ---- */

static const char *const uniform_names[] = { "u_marks", "u_towards", "u_corner_row" };
enum { U_MARKS, U_TOWARDS, U_CORNER_ROW, UNIFORMS };

/* Locations in one program of the shader, which has a variant for each kind of mesh. */
struct noh_decal_program {
    unsigned program;
    int uniforms[UNIFORMS];
};

static uint32_t variant_count(const noh_stage *stage)
{
    return (uint32_t)(((const noh_stage_gl *)stage->gpu)->variants_bytes / sizeof(noh_gl_variant));
}

static void made(void *user, const noh_gl_api *api, GLuint program, noh_gl_variant_key key)
{
    noh_stage_decals *d = user;
    noh_decal_program *p = &d->programs[d->program_count++];
    (void)key;
    NOH_ASSERT(d->program_count <= variant_count(d->stage));
    p->program = program;
    noh_gl_find_uniforms(api, program, uniform_names, UNIFORMS, p->uniforms);
}

static void bind(void *user, const noh_gl_api *api, GLuint program, const noh_material *material)
{
    const noh_stage_decals *d = user;
    const noh_decal_picture *picture = &d->picture;
    const noh_decal_program *p = d->programs;
    (void)material;
    while (p->program != program) p++;
    api->Uniform3f(p->uniforms[U_MARKS], (float)d->count, picture->texture ? (float)picture->columns : 0.0f,
                   picture->texture ? (float)picture->rows : 0.0f);
    api->Uniform4f(p->uniforms[U_TOWARDS], d->reversed ? NUDGE : -NUDGE, 0.0f, 0.0f, 0.0f);
    api->Uniform1i(p->uniforms[U_CORNER_ROW], d->corners ? (GLint)d->corner_row : -1);
    api->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_USER + 2u);
    api->BindTexture(GL_TEXTURE_2D, d->corners);
    api->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_USER + 1u);
    api->BindTexture(GL_TEXTURE_2D, picture->texture ? picture->texture : d->shader->renderer.white.name);
    api->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_USER);
    api->BindTexture(GL_TEXTURE_2D, d->drawable.texture.name);
}

/* ---- life cycle ---- */

/* A texture with a row of texels for each decal. */
static const noh_gl_drawable_desc rows_desc = {
    .texture = { .format = GL_RGBA32F, .width = ROW_TEXELS, .height = NOH_DECALS_MAX }
};

/* d NULL: only measure. */
static size_t carve(const noh_stage *stage, noh_arena *arena, noh_stage_decals *d, void **shader)
{
    noh_decal_program *programs = noh_arena_carve(arena, variant_count(stage) * sizeof *programs, 16);
    *shader = noh_arena_carve(arena, noh_stage_shader_size(stage), 16);
    if (d) d->programs = programs;
    return arena->used;
}

size_t noh_stage_decals_size(const noh_stage *stage)
{
    noh_arena arena = noh_arena_measure();
    void *shader;
    NOH_ASSERT(stage);
    return NOH_PAGE || stage->gpu ? carve(stage, &arena, NULL, &shader) : 0;
}

noh_result noh_stage_decals_create(noh_stage *stage, const noh_gl_device *device, void *memory, size_t bytes,
                                   const noh_decal_picture *picture, noh_stage_decals *out, noh_error *error)
{
    static const char *const samplers[] = { "u_decals", "u_picture", "u_corners" };
    const noh_gl_shader_desc desc = { .name = "decals",
                                      .vertex = noh_shader_decal_vertex_glsl,
                                      .defines = "#define NOH_REST\n",
                                      .fragment = noh_shader_decal_fragment_glsl,
                                      .samplers = samplers,
                                      .sampler_count = 3,
                                      .bind = bind,
                                      .made = made,
                                      .user = out };
    noh_arena arena;
    void *shader;
    NOH_ASSERT(stage && out);
    memset(out, 0, sizeof *out);
    noh_result result = noh_gl_stage_check(stage, error);
    if (!result) result = noh_gl_device_check(device, 0, error);
    if (!result) result = noh_arena_open(&arena, memory, bytes, noh_stage_decals_size(stage), error);
    if (result) return result;
    out->stage = stage;
    if (picture) out->picture = *picture;
    (void)carve(stage, &arena, out, &shader);
    result = noh_gl_drawable_create(device, &rows_desc, &out->drawable, error);
    if (!result) {
        result = noh_stage_shader_create(stage, shader, noh_stage_shader_size(stage), &desc, device->log,
                                         device->log_bytes, &out->shader, error);
    }
    if (result) noh_stage_decals_delete(out);
    return result;
}

void noh_stage_decals_delete(noh_stage_decals *decals)
{
    NOH_ASSERT(decals);
    if (decals->shader) noh_stage_shader_delete(decals->shader);
    decals->shader = NULL;
    noh_gl_drawable_delete(&decals->drawable);
}

noh_result noh_stage_decals_restore(noh_stage_decals *decals, const noh_decal_picture *picture, char *log,
                                    size_t log_bytes, noh_error *error)
{
    NOH_ASSERT(decals && decals->shader);
    memset(&decals->picture, 0, sizeof decals->picture);
    if (picture) decals->picture = *picture;
    decals->program_count = 0;
    noh_gl_renderer_forget(&decals->shader->renderer);
    noh_result result = noh_gl_drawable_restore(&decals->drawable, &rows_desc, log, log_bytes, error);
    if (!result) result = noh_stage_shader_restore(decals->shader, log, log_bytes, error);
    if (result) { /* nothing is left, and it may be restored again */
        noh_stage_shader_delete(decals->shader);
        noh_gl_drawable_delete(&decals->drawable);
    }
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
    noh_gl_unpack_begin(d->drawable.gl, &kept);
    d->drawable.gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, (GLint)first, ROW_TEXELS, (GLsizei)count, GL_RGBA, GL_FLOAT,
                                  rows);
    noh_gl_unpack_end(d->drawable.gl, &kept);
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
    noh_gl_samplers_none(d->drawable.gl, NOH_UNIT_USER, 3);
    d->drawable.gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_USER);
    d->drawable.gl->BindTexture(GL_TEXTURE_2D, d->drawable.texture.name);
    for (uint32_t first = 0; first < d->count; first += ROWS_SENT) {
        const uint32_t now = d->count - first < ROWS_SENT ? d->count - first : ROWS_SENT;
        for (uint32_t i = 0; i < now; i++) set_row(ring, marks[first + i], rows[i]);
        send_rows(d, rows, first, now);
    }
}

static void unbind(const noh_stage_decals *d)
{
    for (uint32_t i = 3; i-- > 0;) {
        d->drawable.gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_USER + i);
        d->drawable.gl->BindTexture(GL_TEXTURE_2D, 0);
    }
}

/* Draw the triangles that have decals, or all triangles. */
static void draw_share(noh_stage_decals *decals, noh_stage_patches *patches, noh_gl_alone *alone, uint32_t mesh,
                       const noh_stage_part *share, const noh_decals *ring)
{
    noh_gl_triangles triangles;
    decals->corners = 0;
    if (patches) {
        if (!noh_gl_patches_grow(patches, alone, mesh, share->level, ring, &triangles, &decals->corner_row)) return;
        decals->corners = patches->drawable.texture.name;
        noh_gl_draw_triangles(&decals->shader->renderer, &triangles);
    }
    noh_gl_draw_alone(alone, mesh, share);
    noh_gl_draw_triangles(&decals->shader->renderer, NULL);
    decals->draws++;
}

static void draw_mesh(noh_stage_decals *decals, noh_stage_patches *patches, noh_gl_alone *alone, uint32_t mesh,
                      const noh_decals *ring)
{
    noh_stage_part shares[2];
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
    noh_gl_blend_begin(decals->drawable.gl, raster);
    if (patches) noh_gl_patches_begin(patches, &alone);
    for (uint32_t m = 0; m < alone.mesh_count; m++) draw_mesh(decals, patches, &alone, m, ring);
    unbind(decals);
    noh_gl_draw_end(&decals->shader->renderer);
    return NOH_OK;
}
