/* gl_renderer.c: the plain renderer's programs and texture. The keys of all variants are listed first, then compiled: a
 * restore compiles the same list again. */
#include <string.h>

#include "gl/gl_debug.h"
#include "gl/gl_draw.h"
#include "gl/gl_lost.h"
#include "gl/gl_material_internal.h"

static noh_result create_white(noh_gl_renderer *r, noh_error *error)
{
    static const uint8_t texel[4] = { 255, 255, 255, 255 };
    noh_gl_texture_desc desc = { GL_RGBA8, 1, 1, 0, 0, 0, 0 };
    noh_result result = noh_gl_texture_create(r->gl, r->ledger, &desc, &r->white, error);
    if (!result) {
        r->gl->BindTexture(GL_TEXTURE_2D, r->white.name);
        noh_gl_label(r->gl, GL_TEXTURE, r->white.name, "renderer white", NULL);
        r->gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, texel);
        r->gl->BindTexture(GL_TEXTURE_2D, 0);
        result = noh_gl_error_check(r->gl, "the driver refuses the renderer's white texel", r->white.bytes, error);
    }
    return result; /* on error, create_objects deletes */
}

/* ---- which variants ---- */

/* What the renderer decides, not a mesh: depth is the same whatever colours are. */
static noh_gl_variant_key completed(const noh_gl_renderer *r, noh_gl_variant_key key)
{
    key.encode_srgb = (uint8_t)(r->encode_srgb && !key.depth);
    key.lit = (uint8_t)(r->lit && !key.depth);
    key.two_layers = (uint8_t)(r->without_tangents && !key.depth);
    return key;
}

static noh_result want_one(noh_gl_renderer *r, noh_gl_variant_key key, noh_error *error)
{
    if (noh_gl_renderer_variant(r, key)) {
        return NOH_OK;
    }
    if (r->variant_count == NOH_GL_VARIANTS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "the meshes need more shader variants than the limit",
                        NOH_GL_VARIANTS_MAX, 0);
    }
    r->variants[r->variant_count++].key = completed(r, key);
    return NOH_OK;
}

/* The variant that draws every pixel, and if the renderer fades, the one that draws some. */
static noh_result want_fades(noh_gl_renderer *r, noh_gl_variant_key key, noh_error *error)
{
    noh_result result = want_one(r, key, error);
    if (!result && r->fades) {
        key.fade = 1;
        result = want_one(r, key, error);
    }
    return result;
}

const noh_material *noh_gl_material_of(const noh_mesh *mesh, const noh_submesh *submesh)
{
    static const noh_material plain = { .base_color_texture = NOH_NONE,
                                        .base_color = { 1.0f, 1.0f, 1.0f, 1.0f },
                                        .metallic = 1.0f,
                                        .roughness = 1.0f,
                                        .alpha_cutoff = 0.5f,
                                        .normal_scale = 1.0f,
                                        .occlusion_strength = 1.0f,
                                        .f0 = { 0.04f, 0.04f, 0.04f },
                                        .normal_texture = NOH_NONE,
                                        .surface_texture = NOH_NONE,
                                        .emissive_texture = NOH_NONE,
                                        .wrinkle_texture = NOH_NONE,
                                        .wrinkle_models = 0,
                                        .wrinkle_weights = { NOH_NONE, NOH_NONE, NOH_NONE } };
    return submesh->material == NOH_NONE ? &plain : &mesh->pack->materials[submesh->material];
}

static int has_cut_materials(const noh_mesh *mesh)
{
    int cut = 0;
    for (uint32_t i = 0; i < mesh->header->submesh_count; i++) {
        const noh_material *m = noh_gl_material_of(mesh, &mesh->submeshes[i]);
        cut |= (m->flags & NOH_MATERIAL_MASK) || noh_gl_has_core(m);
    }
    return cut;
}

/* Those of a key for all materials of a mesh. */
static noh_result want_features(noh_gl_renderer *r, const noh_mesh *mesh, noh_gl_variant_key key, noh_error *error)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < mesh->header->submesh_count && !result; i++) {
        key.features = noh_gl_features_of(mesh, noh_gl_material_of(mesh, &mesh->submeshes[i]));
        result = want_fades(r, key, error);
    }
    return result;
}

/* The variants of all passes. */
static noh_result want(noh_gl_renderer *r, const noh_mesh *mesh, noh_gl_variant_key key, noh_error *error)
{
    noh_result result = NOH_OK;
    if (r->passes != NOH_PASSES_DEPTH) {
        result = want_features(r, mesh, key, error);
    }
    if (!result && r->passes != NOH_PASSES_COLOR) {
        result = want_fades(r, noh_gl_variant_key_depth(key, 0), error);
        if (!result && has_cut_materials(mesh)) {
            result = want_fades(r, noh_gl_variant_key_depth(key, 1), error);
        }
    }
    return result;
}

/* Every variant that the mesh may be drawn by: in the bind pose; with all its influences; and with each lower number.
 */
static noh_result want_mesh(noh_gl_renderer *r, const noh_gl_renderer_desc *desc, const noh_mesh *mesh,
                            noh_error *error)
{
    noh_gl_skin_binding skin = { NOH_PALETTE_AUTO, 0, 0, 0, 0, 0, 0 };
    uint32_t least = desc->fewer_influences ? 1u : NOH_INFLUENCES_MAX;
    noh_result result = want(r, mesh, noh_gl_variant_key_of(mesh, NULL, 0, r->layers_uint, r->view), error);
    skin.mode = desc->palettes;
    for (uint32_t limit = NOH_INFLUENCES_MAX; limit >= least && !result && desc->palettes; limit /= 2u) {
        skin.influences = limit;
        result = want(r, mesh, noh_gl_variant_key_of(mesh, &skin, 0, r->layers_uint, r->view), error);
        if (!result && desc->crowds) {
            result = want(r, mesh, noh_gl_variant_key_of(mesh, &skin, 1, r->layers_uint, r->view), error);
        }
    }
    return result;
}

const noh_gl_variant *noh_gl_renderer_variant(const noh_gl_renderer *r, noh_gl_variant_key key)
{
    NOH_ASSERT(r && r->variant_count <= NOH_GL_VARIANTS_MAX);
    key = completed(r, key);
    for (uint32_t i = 0; i < r->variant_count; i++) {
        if (memcmp(&r->variants[i].key, &key, sizeof key) == 0) {
            return &r->variants[i];
        }
    }
    return NULL;
}

/* ---- making ---- */

static noh_result create_objects(noh_gl_renderer *r, char *log, size_t log_bytes, noh_error *error)
{
    const noh_gl_device device = { r->gl, NULL, r->ledger, log, log_bytes };
    noh_result result = create_white(r, error);
    for (uint32_t i = 0; i < r->variant_count && !result; i++) {
        result = noh_gl_variant_create(&device, r->variants[i].key, &r->shaders, NULL, 0, &r->variants[i], error);
    }
    if (result) {
        noh_gl_renderer_delete(r);
    }
    return result;
}

noh_result noh_gl_renderer_create(const noh_gl_device *device, const noh_gl_renderer_desc *desc, noh_gl_renderer *out,
                                  noh_error *error)
{
    noh_result result = NOH_OK;
    NOH_ASSERT(device && device->api && device->ledger && desc && out && (desc->meshes || !desc->mesh_count));
    if ((unsigned)desc->passes > NOH_PASSES_DEPTH) {
        return noh_fail(error, NOH_ERR_ARG, "renderer desc has unknown passes", (uint64_t)desc->passes, 0);
    }
    if (desc->crowds && desc->palettes != NOH_PALETTE_TEXTURE) {
        return noh_fail(error, NOH_ERR_ARG, "crowds want palettes in a texture", 0, 0);
    }
    memset(out, 0, sizeof *out);
    out->gl = device->api;
    out->ledger = device->ledger;
    out->layers_uint = desc->layers_uint != 0;
    out->without_tangents = desc->without_tangents != 0;
    out->encode_srgb = desc->encode_srgb != 0;
    out->fades = desc->fades != 0;
    out->lit = desc->lit != 0;
    out->view = desc->view;
    out->passes = desc->passes;
    if (desc->shaders) {
        out->shaders = *desc->shaders;
        if (desc->shaders->view) out->view = desc->shaders->view;
    }
    for (uint32_t i = 0; i < desc->mesh_count && !result; i++) {
        result = want_mesh(out, desc, &desc->meshes[i], error);
    }
    if (!result) {
        result = create_objects(out, device->log, device->log_bytes, error);
    }
    return result;
}

void noh_gl_renderer_delete(noh_gl_renderer *renderer)
{
    NOH_ASSERT(renderer && renderer->variant_count <= NOH_GL_VARIANTS_MAX);
    for (uint32_t i = 0; i < renderer->variant_count; i++) {
        noh_gl_variant_delete(renderer->gl, renderer->ledger, &renderer->variants[i]);
    }
    noh_gl_texture_delete(renderer->gl, renderer->ledger, &renderer->white);
}

noh_result noh_gl_renderer_restore(noh_gl_renderer *renderer, char *log, size_t log_bytes, noh_error *error)
{
    const noh_gl_api *gl;
    NOH_ASSERT(renderer && renderer->gl && renderer->ledger);
    gl = renderer->gl;
    renderer->gl = noh_gl_lost_api();
    noh_gl_renderer_delete(renderer);
    renderer->gl = gl;
    return create_objects(renderer, log, log_bytes, error);
}
