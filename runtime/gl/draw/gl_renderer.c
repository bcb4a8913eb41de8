/* gl_renderer.c: the plain renderer's programs and texture. The keys of all variants are listed first, then compiled: a
 * restore compiles the same list again. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/compiler_internal.h"
#include "gl/device/gl_api_internal.h"
#include "gl/draw/gl_draw_internal.h"
#include "gl/draw/gl_variants_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "gl/draw/gl_material_internal.h"
#include "gl/device/gl_names_internal.h"
#include "gl/draw/gl_light_internal.h"
#include "gl/draw/gl_renderer_internal.h"
#include "gl/device/gl_state_internal.h"
#include "gl/device/gl_debug_internal.h"

static noh_result create_white(noh_gl_renderer *r, noh_error *error)
{
    static const uint8_t texel[4] = { 255, 255, 255, 255 };
    noh_gl_texture_desc desc = { GL_RGBA8, 1, 1, 0, 0, 0, 0 };
    noh_gl_pixels kept;
    noh_result result = noh_gl_texture_create(r->gl, r->ledger, &desc, &r->white, error);
    if (!result) {
        r->gl->BindTexture(GL_TEXTURE_2D, r->white.name);
        noh_gl_label(r->gl, GL_TEXTURE, r->white.name, "renderer white", NULL);
        noh_gl_unpack_begin(r->gl, &kept);
        r->gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, texel);
        noh_gl_unpack_end(r->gl, &kept);
        r->gl->BindTexture(GL_TEXTURE_2D, 0);
        result = noh_gl_error_check(r->gl, "the driver refused the renderer's white texel", r->white.bytes, error);
    }
    return result; /* on error, create_objects deletes */
}

/* ---- choosing variants ---- */

/* Key fields set by the renderer, not by a mesh. Depth variants do not depend on colours. */
static noh_gl_variant_key completed(noh_gl_variant_key key, int encode_srgb, int lit, int without_tangents, int shading)
{
    if (shading == NOH_SHADING_PHONE && !key.depth) key.features |= NOH_FEATURE_PHONE;
    key.encode_srgb = (uint8_t)(encode_srgb && !key.depth);
    key.lit = (uint8_t)(key.depth ? 0 : lit);
    if (!key.lit) key.transfer = 0;
    key.two_layers = (uint8_t)(without_tangents && !key.depth);
    return key;
}

static noh_debug_view view_of(const noh_gl_renderer_desc *desc)
{
    return desc->shaders && desc->shaders->view ? desc->shaders->view : desc->view;
}

/* Shaders of your own draw no outlines, nor do debug views. */
static int has_outlines(const noh_gl_renderer_desc *desc)
{
    return view_of(desc) == NOH_VIEW_LIT && !(desc->shaders && (desc->shaders->vertex || desc->shaders->fragment));
}

typedef struct wish {
    const noh_gl_renderer_desc *desc;
    const noh_mesh *mesh;
    noh_gl_variant_list *list;
    noh_error *error;
} wish;

static noh_result want_one(const wish *w, noh_gl_variant_key key)
{
    noh_gl_variant_list *list = w->list;
    key = completed(key, w->desc->encode_srgb, w->desc->lit, w->desc->without_tangents, (int)w->desc->shading);
    for (uint32_t i = 0; i < list->count; i++) {
        if (memcmp(&list->keys[i], &key, sizeof key) == 0) {
            return NOH_OK;
        }
    }
    if (list->count == NOH_GL_VARIANTS_MAX) {
        return noh_fail(w->error, NOH_ERR_LIMIT, "the meshes need more shader variants than NOH_GL_VARIANTS_MAX",
                        NOH_GL_VARIANTS_MAX, 0);
    }
    list->keys[list->count++] = key;
    return NOH_OK;
}

/* The variant that draws every pixel, and if the renderer fades, the variant that draws some. */
static noh_result want_fades(const wish *w, noh_gl_variant_key key)
{
    noh_result result = want_one(w, key);
    if (!result && w->desc->fades) {
        key.fade = 1;
        result = want_one(w, key);
    }
    return result;
}

static int has_cut_materials(const noh_mesh *mesh)
{
    int cut = 0;
    for (uint32_t i = 0; i < mesh->header->submesh_count; i++) {
        const noh_material *m = noh_mesh_material(mesh, &mesh->submeshes[i]);
        cut |= (m->flags & NOH_MATERIAL_MASK) || noh_material_has_core(m);
    }
    return cut;
}

/* The variants of a key for all materials of a mesh. */
static noh_result want_features(const wish *w, noh_gl_variant_key key)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < w->mesh->header->submesh_count && !result; i++) {
        const noh_material *m = noh_mesh_material(w->mesh, &w->mesh->submeshes[i]);
        key.features = noh_gl_features_of(w->mesh, m);
        result = want_fades(w, key);
        key.features = has_outlines(w->desc) ? noh_gl_outline_features(m) : 0;
        if (!result && key.features) result = want_fades(w, key);
    }
    return result;
}

/* The variants of all passes. */
static noh_result want(const wish *w, const noh_gl_skin_binding *skin, int crowd)
{
    const noh_gl_variant_key key = noh_gl_variant_key_of(w->mesh, skin, crowd, w->desc->layers_uint, view_of(w->desc));
    noh_result result = NOH_OK;
    if (w->desc->passes != NOH_PASSES_DEPTH) {
        result = want_features(w, key);
    }
    if (!result && w->desc->passes != NOH_PASSES_COLOR) {
        result = want_fades(w, noh_gl_variant_key_depth(key, 0));
        if (!result && has_cut_materials(w->mesh)) {
            result = want_fades(w, noh_gl_variant_key_depth(key, 1));
        }
    }
    return result;
}

/* Variants for the bind pose, for all influences, and for each smaller number of influences. */
noh_result noh_gl_list_variants(const noh_gl_renderer_desc *desc, const noh_mesh *mesh, noh_gl_variant_list *list,
                                noh_error *error)
{
    const wish w = { desc, mesh, list, error };
    noh_gl_skin_binding skin = { .mode = NOH_PALETTE_AUTO };
    const uint32_t least = desc->fewer_influences ? 1u : NOH_INFLUENCES_MAX;
    noh_result result = want(&w, NULL, 0);
    skin.mode = desc->palettes;
    for (uint32_t limit = NOH_INFLUENCES_MAX; limit >= least && !result && desc->palettes; limit /= 2u) {
        skin.influences = limit;
        result = want(&w, &skin, 0);
        if (!result && desc->crowds) {
            result = want(&w, &skin, 1);
        }
    }
    return result;
}

const noh_gl_variant *noh_gl_renderer_variant(const noh_gl_renderer *r, noh_gl_variant_key key)
{
    NOH_ASSERT(r && r->variant_count <= NOH_GL_VARIANTS_MAX);
    key = completed(key, r->encode_srgb, r->lit, r->without_tangents, r->shading);
    for (uint32_t i = 0; i < r->variant_count; i++) {
        if (memcmp(&r->variants[i].key, &key, sizeof key) == 0) {
            return &r->variants[i];
        }
    }
    return NULL;
}

static noh_result check_desc(const noh_gl_renderer_desc *desc, noh_error *error)
{
    NOH_ASSERT(desc && (desc->meshes || !desc->mesh_count));
    if ((unsigned)desc->passes > NOH_PASSES_DEPTH) {
        return noh_fail(error, NOH_ERR_ARG, "renderer desc: unknown passes", (uint64_t)desc->passes, 0);
    }
    if (desc->crowds && desc->palettes != NOH_PALETTE_TEXTURE) {
        return noh_fail(error, NOH_ERR_ARG, "crowds need palettes in a texture: use NOH_PALETTE_TEXTURE", 0, 0);
    }
    return NOH_OK;
}

static noh_result list_all(const noh_gl_renderer_desc *desc, noh_gl_variant_list *list, noh_error *error)
{
    noh_result result = check_desc(desc, error);
    list->count = 0;
    for (uint32_t i = 0; i < desc->mesh_count && !result; i++) {
        result = noh_gl_list_variants(desc, &desc->meshes[i], list, error);
    }
    return result;
}

size_t noh_gl_renderer_size(const noh_gl_renderer_desc *desc)
{
    noh_gl_variant_list list;
    return list_all(desc, &list, NULL) ? 0 : noh_gl_variants_size(&list);
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

/* Write the keys of all variants to the memory of the variants, so the list is off the stack before compiling. */
NOH_NEVER_INLINE static noh_result put_keys(const noh_gl_renderer_desc *desc, void *memory, size_t bytes,
                                            noh_gl_renderer *out, noh_error *error)
{
    noh_gl_variant_list list;
    noh_arena arena;
    noh_result result = list_all(desc, &list, error);
    if (!result) result = noh_arena_open(&arena, memory, bytes, noh_gl_variants_size(&list), error);
    if (result) {
        return result;
    }
    out->variants = noh_arena_carve(&arena, noh_gl_variants_size(&list), 16);
    out->variant_count = list.count;
    memset(out->variants, 0, noh_gl_variants_size(&list));
    for (uint32_t i = 0; i < list.count; i++) {
        out->variants[i].key = list.keys[i];
    }
    return NOH_OK;
}

noh_result noh_gl_renderer_create(const noh_gl_device *device, const noh_gl_renderer_desc *desc, void *memory,
                                  size_t bytes, noh_gl_renderer *out, noh_error *error)
{
    noh_gl_renderer_desc d;
    noh_result result;
    NOH_ASSERT(desc && out);
    result = noh_gl_device_check(device, 0, error);
    if (result) return result;
    d = *desc;
    d.lit = !desc->lit ? 0 : noh_gl_has_soft_shadows(device->caps) ? NOH_LIT_SOFT : 1;
    memset(out, 0, sizeof *out);
    out->gl = device->api;
    out->ledger = device->ledger;
    out->layers_uint = desc->layers_uint;
    out->without_tangents = desc->without_tangents != 0;
    out->encode_srgb = desc->encode_srgb != 0;
    out->fades = desc->fades != 0;
    out->lit = d.lit;
    out->shading = (uint8_t)desc->shading;
    out->view = view_of(desc);
    if (desc->shaders) {
        out->shaders = *desc->shaders;
    }
    result = put_keys(&d, memory, bytes, out, error);
    return result ? result : create_objects(out, device->log, device->log_bytes, error);
}

void noh_gl_renderer_delete(noh_gl_renderer *renderer)
{
    NOH_ASSERT(renderer && renderer->variant_count <= NOH_GL_VARIANTS_MAX);
    for (uint32_t i = 0; i < renderer->variant_count; i++) {
        noh_gl_variant_delete(renderer->gl, renderer->ledger, &renderer->variants[i]);
    }
    noh_gl_texture_delete(renderer->gl, renderer->ledger, &renderer->white);
}

void noh_gl_renderer_forget(noh_gl_renderer *renderer)
{
    const noh_gl_api *gl;
    NOH_ASSERT(renderer && renderer->gl && renderer->ledger);
    gl = renderer->gl;
    renderer->gl = noh_gl_lost_api();
    noh_gl_renderer_delete(renderer);
    renderer->gl = gl;
}

noh_result noh_gl_renderer_restore(noh_gl_renderer *renderer, char *log, size_t log_bytes, noh_error *error)
{
    noh_gl_renderer_forget(renderer);
    return create_objects(renderer, log, log_bytes, error);
}
