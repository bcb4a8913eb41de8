/* stage_desc.c: what is wrong with a desc, and its defaults. */
#include "core/base/name_internal.h"
#include "stage/cast/stage_internal.h"
#include "motion/anim/controller_internal.h"
#include "motion/bank/clip_bank_internal.h"
#include "stage/character/lod_internal.h"
#include "noh/base.h"
#include "noh/pack.h"
#include "noh/clip.h"
#include "noh/noh.h"

const noh_layer_desc noh_stage_default_layers[3] = {
    { "body", NOH_LAYER_BASE, NULL, NULL, 0 },
    { "face", NOH_LAYER_OVER, "", NULL, 0 },
    { "add", NOH_LAYER_ADD, NULL, NULL, 0 },
};

uint32_t noh_stage_layer_tracks(const noh_layer_desc *layer)
{
    return layer->track_count ? layer->track_count : 2u;
}

uint32_t noh_stage_track_count(const noh_kind_desc *kind)
{
    uint32_t tracks = 0;
    for (uint32_t i = 0; i < kind->layer_count; i++) {
        tracks += noh_stage_layer_tracks(&kind->layers[i]);
    }
    return tracks;
}

uint32_t noh_stage_controller_flags(const noh_kind_desc *kind)
{
    return NOH_CONTROLLER_COVERS | (kind->inertia ? NOH_CONTROLLER_INERTIAL : 0u);
}

static noh_kind_desc filled_kind(const noh_kind_desc *kind)
{
    noh_kind_desc d = *kind;
    if (!d.name) d.name = "";
    if (!d.visible_max) d.visible_max = d.actor_count;
    if (!d.layers) {
        d.layers = noh_stage_default_layers;
        d.layer_count = 3;
    }
    if (!d.clips && !d.clip_packs) d.clips = d.mesh;
    if (d.mesh->runs[NOH_CHUNK_SKELETON].count == 0) d.skeleton = NOH_NONE;
    noh_stage_fill_modules(&d);
    if (!d.change_count) d.change_count = 3u * noh_stage_track_count(&d);
    d.held_float_count = d.held_float_count == NOH_NONE ? 0 : d.held_float_count ? d.held_float_count : 8u;
    return d;
}

noh_kind_desc noh_stage_kind_desc(const noh_stage_desc *desc, uint32_t kind)
{
    return filled_kind(&desc->kinds[kind]);
}

uint32_t noh_stage_slot_actors(const noh_kind_desc *kind)
{
    uint32_t most = kind->actor_count;
    for (uint32_t i = 0; kind->changes && i < kind->other_count; i++) {
        if (kind->others[i].actor_count > most) most = kind->others[i].actor_count;
    }
    return most;
}

noh_stage_desc noh_stage_desc_filled(const noh_stage_desc *desc)
{
    noh_stage_desc d = *desc;
    uint32_t actors = 0;
    for (uint32_t i = 0; i < d.kind_count; i++) {
        actors += noh_stage_slot_actors(&d.kinds[i]);
    }
    if (!d.height_px) d.height_px = 1080;
    if (!d.job_count) d.job_count = 1;
    if (!d.event_count) d.event_count = 64u + actors;
    if (!d.update_budget_ns) d.update_budget_ns = UINT64_MAX;
    if (!d.slot_moves) d.slot_moves = UINT32_MAX;
    if (!(d.lod.pixels > 0.0f)) d.lod.pixels = 1.0f;
    d.load_bytes = !d.load_bytes ? 65536u : d.load_bytes < 256u ? 256u : d.load_bytes;
    return d;
}

/* ---- meshes ---- */

/* Whether a kind draws a mesh: its skeleton moves it, or none does. */
static int is_drawn(const noh_kind_desc *kind, uint32_t mesh)
{
    noh_mesh m;
    noh_skin skin;
    if (noh_pack_mesh_at(kind->mesh, mesh, &m, NULL) != NOH_OK) {
        return 0;
    }
    return noh_pack_skin_at(kind->mesh, m.header->skin, &skin, NULL) != NOH_OK ||
           skin.header->skeleton == kind->skeleton;
}

/* Whether a kind draws a node, or in a pack without nodes a mesh, as far as its own list says. */
static int is_listed(const noh_kind_desc *kind, uint32_t node)
{
    for (uint32_t i = 0; kind->nodes && i < kind->node_count; i++) {
        if (kind->nodes[i] == node) return 1;
    }
    return !kind->nodes;
}

uint32_t noh_stage_items(const noh_kind_desc *kind, noh_stage_item *items)
{
    const noh_pack *pack = kind->mesh;
    const uint32_t count = pack->node_count ? pack->node_count : pack->runs[NOH_CHUNK_MESH].count;
    uint32_t found = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t mesh = pack->node_count ? pack->nodes[i].mesh : i;
        if (mesh == NOH_NONE || !is_listed(kind, i) || !is_drawn(kind, mesh)) {
            continue;
        }
        if (items && found < NOH_STAGE_MESHES_MAX) {
            items[found].node = pack->node_count ? i : NOH_NONE;
            items[found].mesh = mesh;
        }
        found++;
    }
    return found;
}

/* ---- textures ---- */

static int is_namesake(const char *name, const char *of, const char *suffix)
{
    while (*of && *name == *of) name++, of++;
    return !*of && noh_names_equal(name, suffix);
}

uint32_t noh_stage_worn(const noh_kind_desc *kind, uint32_t set, uint32_t texture, const noh_pack **pack)
{
    const noh_texture_set *s = set ? &kind->texture_sets[set - 1u] : NULL;
    const noh_pack *from = s && s->pack ? s->pack : kind->mesh;
    noh_texture own, other;
    *pack = kind->mesh;
    if (!s || noh_pack_texture_at(kind->mesh, texture, &own, NULL) != NOH_OK) {
        return texture;
    }
    for (uint32_t i = 0; noh_pack_texture_at(from, i, &other, NULL) == NOH_OK; i++) {
        if (is_namesake(other.name, own.name, s->suffix ? s->suffix : "")) {
            *pack = from;
            return i;
        }
    }
    return texture;
}

static int replaces_nothing(const noh_kind_desc *kind, uint32_t set)
{
    for (uint32_t t = 0; t < kind->mesh->runs[NOH_CHUNK_TEXTURE].count; t++) {
        const noh_pack *pack;
        if (noh_stage_worn(kind, set, t, &pack) != t || pack->bytes != kind->mesh->bytes) return 0;
    }
    return 1;
}

/* A set must use the texture coordinates of the kind's own textures. */
static int is_laid_out_otherwise(const noh_kind_desc *kind, uint32_t set)
{
    for (uint32_t t = 0; t < kind->mesh->runs[NOH_CHUNK_TEXTURE].count; t++) {
        const noh_pack *pack;
        noh_texture own, worn;
        const uint32_t at = noh_stage_worn(kind, set, t, &pack);
        if (noh_pack_texture_at(kind->mesh, t, &own, NULL) != NOH_OK) continue;
        if (noh_pack_texture_at(pack, at, &worn, NULL) != NOH_OK) continue;
        if (own.header->trim != worn.header->trim) return 1;
    }
    return 0;
}

/* ---- what is wrong ---- */

static const char *bad_texture_sets(const noh_kind_desc *d)
{
    if (d->texture_set_count > NOH_TEXTURE_SETS_MAX) return "texture_set_count of a kind is above NOH_TEXTURE_SETS_MAX";
    if (!d->texture_sets && d->texture_set_count)
        return "texture_sets of a kind is NULL, and texture_set_count is not 0";
    for (uint32_t i = 1; i <= d->texture_set_count; i++) {
        if (replaces_nothing(d, i)) return "a texture set of a kind replaces no texture of its mesh: see the names";
        if (is_laid_out_otherwise(d, i))
            return "a texture of a set has other parts trimmed than the one it replaces: build their packs with "
                   "--whole-textures";
    }
    return NULL;
}

static const char *bad_layer(const noh_layer_desc *layer)
{
    if (!layer->name) return "a layer of a kind: name is NULL";
    if ((unsigned)layer->mode > NOH_LAYER_ADD) return "a layer of a kind: mode is not a noh_layer_mode";
    return layer->track_count > NOH_LAYER_TRACKS_MAX ? "a layer of a kind: track_count is above NOH_LAYER_TRACKS_MAX"
                                                     : NULL;
}

static int bad_map(const noh_kind_desc *d)
{
    noh_skeleton own;
    return d->map && (noh_pack_skeleton_at(d->mesh, d->skeleton, &own, NULL, NULL) || !noh_bank_map_fits(d->map, &own));
}

static const char *bad_kind(const noh_stage_desc *desc, const noh_kind_desc *d)
{
    noh_kind_desc filled;
    if (!d->mesh) return "mesh of a kind is NULL";
    if (!NOH_PAGE && !d->mesh->bytes) return "mesh of a kind is no open pack: call noh_pack_open before the plan";
    if (d->actor_count == 0 || d->actor_count > NOH_STAGE_ACTORS_MAX)
        return "actor_count of a kind is not in 1..NOH_STAGE_ACTORS_MAX";
    if (d->visible_max > d->actor_count) return "visible_max of a kind is above its actor_count";
    if (d->layer_count > NOH_LAYERS_MAX) return "layer_count of a kind is above NOH_LAYERS_MAX";
    if (!d->layers && d->layer_count) return "layers of a kind is NULL, and layer_count is not 0";
    for (uint32_t i = 0; i < d->layer_count; i++) {
        const char *what = bad_layer(&d->layers[i]);
        if (what) return what;
    }
    if (d->clips && d->clip_packs) return "a kind has both clips and clip_packs: set one of them";
    for (uint32_t i = 0; d->nodes && i < d->node_count; i++) {
        if (d->nodes[i] >= (d->mesh->node_count ? d->mesh->node_count : d->mesh->runs[NOH_CHUNK_MESH].count))
            return "nodes of a kind: a node is not in the mesh's pack";
    }
    if (d->root_axes & ~(NOH_ROOT_GROUND | NOH_ROOT_Y | NOH_ROOT_BY_GAME))
        return "root_axes of a kind has unknown bits";
    if (d->change_count > NOH_CHANGES_MAX) return "change_count of a kind is above NOH_CHANGES_MAX";
    if (d->held_float_count != NOH_NONE && d->held_float_count > NOH_FLOATS_MAX)
        return "held_float_count of a kind is above NOH_FLOATS_MAX";
    if (bad_texture_sets(d)) return bad_texture_sets(d);
    if (d->clip_reserve > NOH_CLIP_RESERVE_MAX) return "clip_reserve of a kind is above NOH_CLIP_RESERVE_MAX";
    if (d->cover_count > 255u) return "cover_count of a kind is above 255";
    if (noh_stage_bad_worn(desc, d)) return noh_stage_bad_worn(desc, d);
    if (noh_stage_bad_finer(d)) return noh_stage_bad_finer(d);
    filled = filled_kind(d);
    if (filled.skeleton != NOH_NONE && filled.skeleton >= d->mesh->runs[NOH_CHUNK_SKELETON].count)
        return "skeleton of a kind is not in the mesh's pack";
    if (!NOH_PAGE && bad_map(&filled)) return "map of a kind is for another skeleton than the kind's";
    const uint32_t job_count = desc->job_count ? desc->job_count : 1u;
    const char *bad_module = noh_stage_bad_modules(&filled, job_count);
    if (bad_module) return bad_module;
    for (uint32_t i = 0; i < d->modifier_count; i++) {
        const noh_modifier *m = &d->modifiers[i];
        const char *what = m->refuse ? m->refuse(m->user, job_count) : NULL;
        if (what) return what;
    }
    return noh_stage_track_count(&filled) > NOH_TRACKS_MAX ? "layers of a kind: more tracks than NOH_TRACKS_MAX" : NULL;
}

static const char *bad_desc(const noh_stage_desc *d)
{
    if (!d->kinds || d->kind_count == 0 || d->kind_count > NOH_STAGE_KINDS_MAX)
        return "kinds of a stage: NULL, or kind_count is not in 1..NOH_STAGE_KINDS_MAX";
    if (d->job_count > NOH_STAGE_JOBS_MAX) return "job_count of a stage is above NOH_STAGE_JOBS_MAX";
    return d->event_count > NOH_STEP_EVENTS_MAX ? "event_count of a stage is above NOH_STEP_EVENTS_MAX" : NULL;
}

noh_result noh_stage_check_kind(const noh_stage_desc *desc, const noh_kind_desc *d, uint32_t number, noh_error *error)
{
    const char *what = bad_kind(desc, d);
    noh_kind_desc kind;
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, number, 0);
    }
    kind = filled_kind(d);
    if (noh_stage_items(&kind, NULL) > NOH_STAGE_MESHES_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "a kind draws more meshes than NOH_STAGE_MESHES_MAX", number,
                        noh_stage_items(&kind, NULL));
    }
    return NOH_OK;
}

static const char *bad_slot(const noh_kind_desc *d)
{
    if (d->changes < 0 || d->changes > 2) return "changes of a kind must be 0, 1 or 2";
    if (!d->changes && d->other_count) return "others of a kind, and changes is 0";
    return !d->others && d->other_count ? "others of a kind is NULL, and other_count is not 0" : NULL;
}

noh_result noh_stage_check_desc(const noh_stage_desc *desc, noh_error *error)
{
    const char *what = bad_desc(desc);
    noh_result result = NOH_OK;
    uint64_t actors = 0;
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, 0, 0);
    }
    for (uint32_t i = 0; i < desc->kind_count; i++) {
        const noh_kind_desc *kind = &desc->kinds[i];
        what = bad_slot(kind);
        if (what) {
            return noh_fail(error, NOH_ERR_ARG, what, i, 0);
        }
        result = noh_stage_check_kind(desc, kind, i, error);
        for (uint32_t o = 0; o < kind->other_count && result == NOH_OK; o++) {
            result = noh_stage_check_kind(desc, &kind->others[o], i, error);
        }
        if (result != NOH_OK) {
            return result;
        }
        actors += noh_stage_slot_actors(kind);
    }
    if (actors > NOH_STAGE_ACTORS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "a stage has more actors than NOH_STAGE_ACTORS_MAX", 0, actors);
    }
    return noh_lod_settings_check(&desc->lod, error);
}

/* ---- what kinds share ---- */

static int same_clips(const noh_kind_desc *a, const noh_kind_desc *b)
{
    const uint32_t count = a->clip_packs ? a->clip_pack_count : 1u;
    if ((b->clip_packs ? b->clip_pack_count : 1u) != count) return 0;
    for (uint32_t i = 0; i < count; i++) {
        const noh_pack *of_a = a->clip_packs ? a->clip_packs[i] : a->clips;
        const noh_pack *of_b = b->clip_packs ? b->clip_packs[i] : b->clips;
        if (of_a->bytes != of_b->bytes) return 0;
    }
    return 1;
}

static int same_play(const noh_kind_desc *a, const noh_kind_desc *b)
{
    return noh_stage_root_axes(a) == noh_stage_root_axes(b) && a->sample_rate_needed == b->sample_rate_needed &&
           a->clip_reserve == b->clip_reserve && a->map == b->map;
}

uint32_t noh_stage_bank_kind(const noh_stage_desc *desc, uint32_t kind)
{
    noh_kind_desc own;
    if (desc->kinds[kind].changes) {
        return kind;
    }
    own = noh_stage_kind_desc(desc, kind);
    for (uint32_t i = 0; i < kind; i++) {
        noh_kind_desc other;
        if (desc->kinds[i].changes) continue;
        other = noh_stage_kind_desc(desc, i);
        if (other.mesh->bytes == own.mesh->bytes && other.skeleton == own.skeleton && same_clips(&own, &other) &&
            same_play(&own, &other)) {
            return i;
        }
    }
    return kind;
}

noh_clip_bank_desc noh_stage_bank_desc(const noh_stage_desc *desc, const noh_stage_plan *plan, uint32_t kind)
{
    const noh_kind_desc d = noh_stage_kind_desc(desc, kind);
    noh_clip_bank_desc bank = { .mesh = d.mesh,
                                .clips = d.clips,
                                .clip_packs = d.clip_packs,
                                .clip_pack_count = d.clip_pack_count,
                                .skeleton = d.skeleton,
                                .root_axes = noh_stage_root_axes(&d),
                                .root_up = NOH_STAGE_UP,
                                .sample_rate_needed = d.sample_rate_needed,
                                .reserve_bytes = d.clip_reserve,
                                .map = d.map,
                                .cached_segment_count = plan->kinds[kind].cached_segment_count };
    if (bank.cached_segment_count == 1u) { /* of a clip of one segment: a cache is asked for two or more */
        bank.cached_segment_count = NOH_CLIP_CACHE_SEGMENTS_MIN;
    }
    for (uint32_t i = kind; i < desc->kind_count; i++) {
        if (noh_stage_bank_kind(desc, i) == kind) {
            const noh_kind_desc other = noh_stage_kind_desc(desc, i);
            const uint32_t tracks = noh_stage_track_count(&other);
            bank.instance_count += other.actor_count;
            bank.track_count = tracks > bank.track_count ? tracks : bank.track_count;
        }
    }
    if (!bank.track_count) bank.track_count = 1;
    return bank;
}
