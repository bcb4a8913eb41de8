/* stage_names.c: clips, layers, floats and joints of a kind, by name. */

#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "core/base/name_internal.h"
#include "stage/cast/stage_internal.h"

uint32_t noh_stage_clip_count(const noh_stage_kind *k)
{
    return k->bank ? k->bank->clips.clip_count : 0;
}

static const noh_source_type *source_of(const noh_stage_kind *k)
{
    return k->modules[NOH_SLOT_SOURCE].type ? k->modules[NOH_SLOT_SOURCE].type->source : NULL;
}

/* ---- a name by its index ---- */

const noh_pack *noh_stage_clip_pack(const noh_stage_kind *k, uint32_t clip)
{
    return k->desc->clip_packs ? k->desc->clip_packs[k->bank->packs[clip]] : k->desc->clips;
}

/* The chunk itself may not be in memory. */
const noh_pack_chunk *noh_stage_clip_chunk(const noh_stage_kind *k, uint32_t clip)
{
    const noh_pack *pack = noh_stage_clip_pack(k, clip);
    return &pack->chunks[pack->runs[NOH_CHUNK_CLIP].first + k->bank->pack_clips[clip]];
}

static const char *clip_name(const noh_stage_kind *k, uint32_t index)
{
    return index < noh_stage_clip_count(k)
               ? noh_pack_string(noh_stage_clip_pack(k, index), noh_stage_clip_chunk(k, index)->name)
               : NULL;
}

static const char *float_name(const noh_stage_kind *k, uint32_t index)
{
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        const noh_stage_mesh *mesh = &k->meshes[m];
        if (index - mesh->first_float < mesh->mesh.header->target_count) {
            return noh_pack_string(mesh->mesh.pack, mesh->mesh.targets[index - mesh->first_float].name);
        }
    }
    return index < k->float_count ? "" : NULL; /* clips keep the hashes of named floats */
}

static const char *set_name(const noh_stage_kind *k, uint32_t index)
{
    if (index > k->desc->texture_set_count) return NULL;
    return index && k->desc->texture_sets[index - 1u].name ? k->desc->texture_sets[index - 1u].name : "";
}

const char *noh_stage_name(const noh_stage *stage, uint32_t kind, noh_name what, uint32_t index)
{
    const noh_source_type *source;
    const noh_stage_kind *k;
    NOH_ASSERT(stage && kind < stage->desc.kind_count);
    k = &stage->kinds[kind];
    source = source_of(k);
    switch (what) {
    case NOH_NAME_CLIP: return clip_name(k, index);
    case NOH_NAME_LAYER: return index < k->layer_count ? k->layers[index].name : NULL;
    case NOH_NAME_FLOAT: return float_name(k, index);
    case NOH_NAME_JOINT:
        return index < k->skeleton.joint_count ? noh_pack_joint_name(k->desc->mesh, k->desc->skeleton, index) : NULL;
    case NOH_NAME_GRAPH:
    case NOH_NAME_PARAMETER:
    case NOH_NAME_MACHINE: return source ? source->name(k, what, index) : NULL;
    case NOH_NAME_TEXTURE_SET: return set_name(k, index);
    case NOH_NAME_MESH: return index < k->plan->mesh_count ? k->meshes[index].mesh.name : NULL;
    }
    return NULL;
}

/* ---- an index by its name ---- */

static uint32_t count_of(const noh_stage_kind *k, noh_name what)
{
    const noh_source_type *source = source_of(k);
    switch (what) {
    case NOH_NAME_CLIP: return noh_stage_clip_count(k);
    case NOH_NAME_LAYER: return k->layer_count;
    case NOH_NAME_FLOAT: return k->float_count;
    case NOH_NAME_JOINT: return k->skeleton.joint_count;
    case NOH_NAME_GRAPH:
    case NOH_NAME_PARAMETER:
    case NOH_NAME_MACHINE: return source ? source->name_count(k, what) : 0;
    case NOH_NAME_TEXTURE_SET: return k->desc->texture_set_count + 1u;
    case NOH_NAME_MESH: return k->plan->mesh_count;
    }
    return 0;
}

uint32_t noh_stage_find(const noh_stage *stage, uint32_t kind, noh_name what, const char *name)
{
    NOH_ASSERT(stage && name && kind < stage->desc.kind_count);
    const noh_stage_kind *k;
    const uint32_t hash = noh_hash_name(name);
    uint32_t count;
    k = &stage->kinds[kind];
    count = count_of(k, what);
    for (uint32_t i = 0; i < count; i++) {
        const char *own;
        if (what == NOH_NAME_CLIP && k->set.clips[i].name_hash != hash) continue;
        if (what == NOH_NAME_FLOAT && k->named.name_hashes[i] != hash) continue;
        own = noh_stage_name(stage, kind, what, i);
        /* of a named float of clips the hash is all there is */
        if (own && (noh_names_equal(own, name) || (what == NOH_NAME_FLOAT && !own[0]))) return i;
    }
    return NOH_NONE;
}
