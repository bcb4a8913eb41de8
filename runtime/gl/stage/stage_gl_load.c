/* stage_gl_load.c: LOD levels that are loaded later: room for them, their upload, and what is drawn meanwhile.
 *
 * Buffers and tables have the size of the finest level of the plan. The coarse levels of a mesh are a prefix, drawn
 * while the rest is uploaded. Targets are different, since a level may leave some out: the coarse level has tables of
 * its own, and the accumulators switch to the fine tables once these are complete. */
#include <string.h>

#include "gl/device/gl_api_internal.h"
#include "gl/draw/gl_draw_internal.h"
#include "gl/morph/gl_morph_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "gl/stage/stage_gl_internal.h"
#include "gl/draw/gl_renderer_internal.h"

/* ---- room ---- */

static uint32_t levels_of(const noh_mesh *mesh)
{
    return mesh->header->level_count - mesh->header->level;
}

size_t noh_gl_room_size(const noh_mesh *mesh)
{
    return levels_of(mesh) * sizeof *mesh->header + mesh->header->submesh_count * sizeof *mesh->submeshes;
}

/* A chunk of a mesh with headers and the submeshes of the finest level. All other offsets are 0. */
noh_mesh noh_gl_room_make(const noh_mesh *mesh, const noh_mesh *coarse, void *memory)
{
    noh_mesh_header *headers = memory;
    noh_mesh room = *coarse;
    const uint32_t count = levels_of(mesh);
    memcpy(headers, mesh->header, count * sizeof *headers);
    memcpy(headers + count, mesh->submeshes, mesh->header->submesh_count * sizeof *mesh->submeshes);
    for (uint32_t i = 0; i < count; i++) {
        noh_mesh_header *h = &headers[i];
        h->level_first = mesh->header->level;
        h->positions_offset = h->attributes_offset = h->indices_offset = h->targets_offset = h->weights_offset = 0;
        h->rects_offset = h->texels_offset = h->target_boxes_offset = h->influences_offset = h->palettes_offset = 0;
        h->palette_joints_offset = h->joint_boxes_offset = 0;
        h->submeshes_offset = count * (uint32_t)sizeof *headers;
    }
    room.header = headers;
    return noh_mesh_at_lod(&room, mesh->header->level);
}

/* ---- uploading ---- */

static void fill_mesh(const noh_gl_device *device, const noh_gl_model *model, const noh_mesh *from)
{
    uint64_t at = 0;
    uint32_t bytes;
    do {
        bytes = UINT32_MAX;
    } while (!noh_gl_mesh_fill(device->api, &model->mesh, from, &at, &bytes));
}

static noh_result make_coarse(const noh_gl_device *device, noh_gl_model *model, noh_error *error)
{
    const noh_result result = noh_gl_mesh_create_empty(device->api, device->ledger, &model->room, &model->coarse,
                                                       &model->mesh, error);
    if (result) return result;
    fill_mesh(device, model, &model->coarse);
    return noh_gl_error_check(device->api, "the driver refused the buffers of a mesh", 0, error);
}

noh_result noh_gl_model_make_mesh(const noh_stage_gl *gl, noh_gl_model *model, const noh_mesh *mesh, int slot,
                                  noh_error *error)
{
    const noh_gl_device *d = &gl->device;
    const noh_gl_mesh *of;
    if (model->load_kind != NOH_NONE) return make_coarse(d, model, error);
    of = noh_gl_shares(gl) ? noh_gl_shared_mesh(gl, mesh) : NULL;
    model->taken = of != NULL;
    if (of) return noh_gl_mesh_create_on(d->api, mesh, of, &model->mesh, error);
    return slot ? noh_gl_mesh_create_empty(d->api, d->ledger, mesh, mesh, &model->mesh, error)
                : noh_gl_mesh_create(d->api, d->ledger, mesh, &model->mesh, error);
}

/* The finest level of the plan in the pack that was loaded later, with the materials and skin of the kind's pack. */
static noh_mesh brought(const noh_stage *s, const noh_gl_model *model)
{
    noh_mesh mesh;
    (void)noh_pack_mesh_at(s->kinds[model->load_kind].finer.from, model->mesh_index, &mesh, NULL);
    mesh.pack = model->coarse.pack;
    return noh_gl_as_lit(&s->desc, &mesh, model->room.header->level);
}

static int load_model(const noh_stage *s, noh_gl_model *model, uint32_t *bytes)
{
    const noh_gl_device *d = &((const noh_stage_gl *)s->gpu)->device;
    const noh_mesh mesh = brought(s, model);
    return noh_gl_mesh_fill(d->api, &model->mesh, &mesh, &model->mesh_at, bytes) &&
           (!model->morph || noh_gl_morph_fill(model->morph, &mesh, &model->morph_at, bytes));
}

int noh_gl_load(noh_stage *s, uint32_t load_kind, int anew, uint32_t *bytes)
{
    noh_stage_gl *gl = s->gpu;
    int done = 1;
    for (uint32_t i = 0; i < gl->model_count; i++) {
        noh_gl_model *model = &gl->models[i];
        if (model->load_kind != load_kind) continue;
        if (anew) {
            model->mesh_at = 0;
            model->morph_at = 0;
            done = 0;
        }
        done = done && load_model(s, model, bytes);
    }
    return done;
}

static void use_model(const noh_stage *s, noh_gl_model *model, int loaded)
{
    const noh_mesh mesh = loaded ? brought(s, model) : model->coarse;
    model->loaded = loaded;
    model->mesh.mesh = mesh;
    if (model->morph) noh_gl_morph_use(model->morph, &mesh);
}

void noh_gl_use(noh_stage *s, uint32_t load_kind, int loaded)
{
    noh_stage_gl *gl = s->gpu;
    for (uint32_t i = 0; i < gl->model_count; i++) {
        if (gl->models[i].load_kind == load_kind) use_model(s, &gl->models[i], loaded);
    }
}

/* ---- a new context ---- */

static noh_result restore_morph(const noh_stage_gl *gl, noh_gl_morph *morph, noh_error *error)
{
    const noh_gl_texture *tiles = NULL;
    if (noh_gl_shares(gl)) {
        const noh_gl_tiles_key key = noh_gl_morph_key_of(morph);
        tiles = noh_gl_shared_tiles(gl, &key);
    }
    return noh_gl_morph_remake(morph, tiles, NULL, 0, error);
}

noh_result noh_gl_model_set_mesh(const noh_gl_model *model, noh_error *error)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < model->part_count && result == NOH_OK; i++) {
        result = noh_gl_morph_set_mesh(model->morph, i, &model->mesh, error);
    }
    return result;
}

noh_result noh_gl_model_restore(const noh_stage *s, noh_gl_model *model, int slot, noh_error *error)
{
    const noh_stage_gl *gl = s->gpu;
    const noh_mesh mesh = model->mesh.mesh;
    noh_result result = noh_gl_model_make_mesh(gl, model, &mesh, slot, error);
    if (result == NOH_OK && model->morph) result = restore_morph(gl, model->morph, error);
    if (result == NOH_OK && model->morph) result = noh_gl_model_set_mesh(model, error);
    model->mesh_at = 0;
    model->morph_at = 0;
    if (result == NOH_OK && model->load_kind != NOH_NONE && model->loaded) {
        uint32_t bytes;
        do {
            bytes = UINT32_MAX;
        } while (!load_model(s, model, &bytes));
        use_model(s, model, 1);
    }
    return result;
}
