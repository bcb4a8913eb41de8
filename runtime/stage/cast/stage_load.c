/* stage_load.c: levels that are loaded later, in pieces, used and dropped.
 *
 * The plan includes the levels of noh_kind_desc.finer, so that slots and buffers exist for them. Until they are loaded,
 * only levels of noh_kind_desc.mesh are chosen. The stage keeps only a hash of `finer`: the pack loaded later must have
 * the same levels. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "stage/cast/stage_internal.h"

/* ---- packs ---- */

noh_mesh noh_stage_whole_mesh(const noh_kind_desc *kind, uint32_t mesh)
{
    noh_mesh found;
    (void)noh_pack_mesh_at(kind->finer ? kind->finer : kind->mesh, mesh, &found, NULL);
    return found;
}

/* Of what levels up to a vertex count use: a finer pack's records must go on where a coarse one's end. */
static uint32_t hash_transfer(uint32_t hash, const noh_transfer_header *h, uint32_t vertex_count)
{
    const uint32_t kind[2] = { h->order, h->flags };
    const uint8_t *bytes = (const uint8_t *)h;
    hash = noh_crc32c(hash, kind, sizeof kind);
    hash = noh_crc32c(hash, bytes + h->records_offset,
                      (size_t)(vertex_count < h->vertex_count ? vertex_count : h->vertex_count) *
                          NOH_TRANSFER_RECORD_BYTES(h->order, h->flags));
    return noh_crc32c(hash, bytes + h->scales_offset, 4u * (size_t)h->target_count);
}

uint32_t noh_stage_hash_levels(const noh_mesh *mesh, uint32_t level)
{
    uint32_t hash = 0;
    for (uint32_t k = level; k < mesh->header->level_count; k++) {
        const noh_mesh at = noh_mesh_at_lod(mesh, k);
        noh_mesh_header h = *at.header;
        h.index_bytes = h.level_first = h.source_crc = 0; /* and where things lie: these are the pack's own */
        h.positions_offset = h.attributes_offset = h.indices_offset = h.submeshes_offset = h.targets_offset = 0;
        h.weights_offset = h.rects_offset = h.texels_offset = h.target_boxes_offset = 0;
        h.influences_offset = h.palettes_offset = h.palette_joints_offset = h.joint_boxes_offset = 0;
        hash = noh_crc32c(hash, &h, sizeof h);
        hash = noh_crc32c(hash, at.submeshes, h.submesh_count * sizeof *at.submeshes);
    }
    if (mesh->transfer && level < mesh->header->level_count) {
        hash = hash_transfer(hash, mesh->transfer, noh_mesh_at_lod(mesh, level).header->vertex_count);
    }
    return hash;
}

const char *noh_stage_bad_finer(const noh_kind_desc *kind)
{
    static const char *const another = "finer of a kind: not the pack that its mesh was stripped from";
    if (!kind->finer) return NULL;
    if (kind->finer->runs[NOH_CHUNK_MESH].count != kind->mesh->runs[NOH_CHUNK_MESH].count ||
        kind->finer->material_count != kind->mesh->material_count)
        return another;
    for (uint32_t i = 0; i < kind->mesh->runs[NOH_CHUNK_MESH].count; i++) {
        noh_mesh coarse, fine;
        uint32_t first;
        (void)noh_pack_mesh_at(kind->mesh, i, &coarse, NULL);
        (void)noh_pack_mesh_at(kind->finer, i, &fine, NULL);
        first = coarse.header->level_first;
        if (noh_mesh_source(&coarse) != noh_mesh_source(&fine)) return another;
        if (fine.header->level_first > first) return "finer of a kind: the kind's mesh already has finer levels";
        if (fine.header->level_count != coarse.header->level_count ||
            noh_stage_hash_levels(&fine, first) != noh_stage_hash_levels(&coarse, first))
            return another;
    }
    return NULL;
}

static int same_bytes(const noh_pack *a, const noh_pack *b)
{
    return (a ? a->bytes : NULL) == (b ? b->bytes : NULL);
}

uint32_t noh_stage_load_kind(const noh_stage_desc *desc, uint32_t kind)
{
    uint32_t i = desc->kinds[kind].changes ? kind : 0;
    while (i < kind && !(!desc->kinds[i].changes && same_bytes(desc->kinds[i].mesh, desc->kinds[kind].mesh) &&
                         same_bytes(desc->kinds[i].finer, desc->kinds[kind].finer))) {
        i++;
    }
    return i;
}

/* ---- what is there ---- */

/* Whether all meshes of a level are in the kind's own pack. */
static int is_there(const noh_stage_kind *k, uint32_t level)
{
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        if (k->plan->levels[level].mesh_levels[m] < k->meshes[m].mesh.header->level_first) return 0;
    }
    return 1;
}

void noh_stage_open_load(const noh_stage *s, const noh_stage_desc *desc, uint32_t kind)
{
    noh_stage_kind *k = &s->kinds[kind];
    k->first_there = k->plan->finest_level;
    while (k->first_there + 1u < k->plan->level_count && !is_there(k, k->first_there)) k->first_there++;
    k->finer.kind = desc->kinds[kind].finer ? noh_stage_load_kind(desc, kind) : NOH_NONE;
    for (uint32_t m = 0; m < k->plan->mesh_count && desc->kinds[kind].finer; m++) {
        const noh_mesh whole = noh_stage_whole_mesh(k->desc, k->meshes[m].item.mesh);
        k->meshes[m].finer_hash = noh_stage_hash_levels(&whole, k->plan->levels[k->plan->finest_level].mesh_levels[m]);
    }
}

static void set_first(noh_stage *s, uint32_t load_kind, int loaded)
{
    for (uint32_t i = load_kind; i < s->desc.kind_count; i++) {
        noh_stage_kind *k = &s->kinds[i];
        if (k->finer.kind == load_kind) k->table.mesh_level_first = loaded ? k->plan->finest_level : k->first_there;
    }
    if (s->gpu) s->desc.gpu->use(s, load_kind, loaded);
}

void noh_stage_load_piece(noh_stage *s)
{
    uint32_t bytes = s->desc.load_bytes;
    s->stats.loading = s->stats.coming = 0;
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        noh_stage_kind *k = &s->kinds[i];
        if (k->finer.hidden) {
            (void)s->desc.gpu->fill(s, i, &bytes);
            s->stats.loading++;
            s->stats.coming |= 1u << i;
        }
        if (k->finer.state != NOH_STAGE_LOADING) continue;
        if (!s->gpu || s->desc.gpu->load(s, i, 0, &bytes)) {
            k->finer.state = NOH_STAGE_LOADED;
            set_first(s, i, 1);
        } else {
            s->stats.loading++;
        }
    }
    if (!NOH_PAGE && s->gpu) s->desc.gpu->stream(s, &bytes);
    s->stats.load_bytes = s->desc.load_bytes - bytes;
}

/* ---- bringing and dropping ---- */

static int has_levels(const noh_kind_plan *plan, const noh_stage_mesh *m, uint32_t index, const noh_pack *pack,
                      noh_mesh *found)
{
    const uint32_t level = plan->levels[plan->finest_level].mesh_levels[index];
    return noh_pack_mesh_at(pack, m->item.mesh, found, NULL) == NOH_OK &&
           noh_mesh_source(found) == noh_mesh_source(&m->mesh) && found->header->level_first <= level &&
           found->header->level_count == m->mesh.header->level_count &&
           noh_stage_hash_levels(found, level) == m->finer_hash;
}

static noh_result check_pack(const noh_stage_kind *k, const noh_pack *pack, noh_error *error)
{
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        noh_mesh found;
        if (!has_levels(k->plan, &k->meshes[m], m, pack, &found)) {
            return noh_fail(error, NOH_ERR_DATA,
                            "a pack of finer levels: not the one that the kind's mesh was stripped from, or it lacks "
                            "levels that the plan has",
                            k->meshes[m].item.mesh, 0);
        }
    }
    return NOH_OK;
}

static noh_result check_call(const noh_stage *s, uint32_t kind, noh_error *error)
{
    if (kind >= s->desc.kind_count) {
        return noh_fail(error, NOH_ERR_ARG, "no such kind", kind, s->desc.kind_count);
    }
    return s->phase == NOH_STAGE_IDLE
               ? NOH_OK
               : noh_fail(error, NOH_ERR_ARG, "cannot load or drop levels during a step or a frame", 0, 0);
}

static int brings_any(const noh_stage *s, uint32_t load_kind)
{
    for (uint32_t i = load_kind; i < s->desc.kind_count; i++) {
        const noh_stage_kind *k = &s->kinds[i];
        if (k->finer.kind == load_kind && k->first_there > k->plan->finest_level) return 1;
    }
    return 0;
}

static void drop(noh_stage *s, uint32_t kind)
{
    if (s->kinds[kind].finer.kind != NOH_NONE) {
        noh_stage_kind *of = &s->kinds[s->kinds[kind].finer.kind];
        if (of->finer.state == NOH_STAGE_LOADED) set_first(s, s->kinds[kind].finer.kind, 0);
        of->finer.state = NOH_STAGE_DROPPED;
        of->finer.from = NULL;
    }
}

noh_result noh_stage_load_level(noh_stage *stage, uint32_t kind, const noh_pack *pack, noh_error *error)
{
    noh_result result;
    noh_stage_kind *of;
    uint32_t none = 0;
    NOH_ASSERT(stage);
    result = check_call(stage, kind, error);
    if (result == NOH_OK && !pack) {
        drop(stage, kind);
        return NOH_OK;
    }
    if (result == NOH_OK &&
        (stage->kinds[kind].finer.kind == NOH_NONE || !brings_any(stage, stage->kinds[kind].finer.kind))) {
        result = noh_fail(error, NOH_ERR_UNSUPPORTED, "a kind has no finer levels in the plan: see noh_kind_desc.finer",
                          kind, 0);
    }
    if (result != NOH_OK) {
        return result;
    }
    of = &stage->kinds[stage->kinds[kind].finer.kind];
    if (of->finer.from && of->finer.from->bytes == pack->bytes) {
        return NOH_OK;
    }
    for (uint32_t i = stage->kinds[kind].finer.kind; i < stage->desc.kind_count && result == NOH_OK; i++) {
        if (stage->kinds[i].finer.kind == stage->kinds[kind].finer.kind) {
            result = check_pack(&stage->kinds[i], pack, error);
        }
    }
    if (result == NOH_OK) {
        drop(stage, kind);
        of->finer.from = pack;
        of->finer.state = NOH_STAGE_LOADING;
        if (stage->gpu) (void)stage->desc.gpu->load(stage, stage->kinds[kind].finer.kind, 1, &none);
    }
    return result;
}
