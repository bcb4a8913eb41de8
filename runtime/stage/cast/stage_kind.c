/* stage_kind.c: what all actors of a kind share: meshes, clips, floats, levels, bounds. */
#include <string.h>

#include "core/base/math_internal.h"
#include "stage/cast/stage_internal.h"
#include "motion/bank/clip_bank_internal.h"
#include "stage/character/lod_pack_internal.h"
#include "noh/base.h"
#include "noh/pack.h"
#include "noh/clip.h"
#include "noh/noh.h"
#include "noh/low_stage.h"

/* ---- clips ---- */

/* The one clip of a kind without clips. */
static void sample_rest(void *user, uint32_t clip, uint32_t clip_tick, uint32_t joint_count, noh_transform *pose,
                        uint32_t float_count, float *floats)
{
    const noh_stage_kind *k = user;
    (void)clip, (void)clip_tick;
    if (joint_count) memcpy(pose, k->skeleton.bind_pose, joint_count * sizeof *pose);
    for (uint32_t i = 0; i < float_count; i++) floats[i] = k->set.float_defaults ? k->set.float_defaults[i] : 0.0f;
}

static void open_rest(noh_stage_kind *k, const noh_stage_needs *n)
{
    memset(&k->still, 0, sizeof k->still);
    k->still.clip.loop = NOH_LOOP_REPEAT;
    k->set.clip_count = 1;
    k->set.joint_count = k->skeleton.joint_count;
    k->set.float_count = n->shape.float_count;
    /* filled in by open_floats */
    k->set.float_defaults = k->modifier_bytes && n->weight_count ? k->named.defaults : NULL;
    k->set.clips = &k->still.clip;
    k->set.bind_pose = k->skeleton.joint_count ? k->skeleton.bind_pose : &k->still.pose;
    k->set.sample = sample_rest;
    k->set.user = k;
}

static noh_result open_clips(noh_stage *s, const noh_stage_desc *desc, uint32_t kind, void *memory,
                             const noh_stage_needs *n, noh_error *error)
{
    noh_stage_kind *k = &s->kinds[kind];
    noh_result result = NOH_OK;
    k->bank_kind = noh_stage_bank_kind(desc, kind);
    k->bank_desc = noh_stage_bank_desc(desc, s->plan, k->bank_kind);
    k->bank = k->bank_kind == kind ? NULL : s->kinds[k->bank_kind].bank;
    if (n->bank_bytes) {
        result = noh_clip_bank_init(memory, n->bank_bytes, &k->bank_desc, &k->bank, error);
    }
    (void)noh_pack_skeleton_at(k->desc->mesh, k->desc->skeleton, &k->skeleton, NULL, NULL);
    k->skeleton.inverse_bind = NULL; /* characters keep model-space matrices: skins differ, sockets want joints */
    if (k->bank) {
        k->set = k->bank->clips;
    } else if (result == NOH_OK) {
        open_rest(k, n);
    }
    return result;
}

/* ---- meshes and their floats ---- */

static const float *default_weights(const noh_pack *pack, const noh_stage_item *item, const noh_mesh *mesh)
{
    return item->node != NOH_NONE && pack->nodes[item->node].first_weight != NOH_NONE
               ? pack->node_weights + pack->nodes[item->node].first_weight
               : mesh->weights;
}

/* Where the floats of a mesh begin: at its node's floats in the set, or after the set's floats. */
static uint32_t place_floats(const noh_stage_kind *k, const noh_stage_item *item, uint32_t *next)
{
    const uint32_t group = k->bank ? noh_clip_bank_node_group(k->bank, item->node) : NOH_NONE;
    const uint32_t first = *next;
    return group != NOH_NONE ? k->bank->groups[group].first : first;
}

static void open_meshes(noh_stage_kind *k)
{
    noh_stage_item items[NOH_STAGE_MESHES_MAX];
    const uint32_t count = noh_stage_items(k->desc, items);
    uint32_t next = k->bank ? k->set.float_count : 0;
    for (uint32_t i = 0; i < count; i++) {
        noh_stage_mesh *m = &k->meshes[i];
        noh_mesh whole;
        memset(m, 0, sizeof *m);
        m->item = items[i];
        (void)noh_pack_mesh_at(k->desc->mesh, items[i].mesh, &m->mesh, NULL);
        m->skinned = noh_pack_skin_at(k->desc->mesh, m->mesh.header->skin, &m->skin, NULL) == NOH_OK;
        m->node_world = items[i].node == NOH_NONE ? NULL : k->desc->mesh->nodes[items[i].node].world;
        m->defaults = default_weights(k->desc->mesh, &items[i], &m->mesh);
        m->first_float = place_floats(k, &items[i], &next);
        if (m->first_float == next) next += m->mesh.header->target_count;
        m->first_weight = k->weight_count;
        k->weight_count += m->mesh.header->target_count;
        whole = noh_stage_whole_mesh(k->desc, items[i].mesh);
        noh_lod_target_radii(&whole, k->target_radii + m->first_weight);
    }
    k->float_count = next;
}

/* Whether any clip moves a group of floats. */
static int is_moved(const noh_stage_kind *k, uint32_t group)
{
    for (uint32_t c = 0; c < k->set.clip_count; c++) {
        if (noh_clip_bank_moves(k->bank, c, group)) return 1;
    }
    return 0;
}

static void name_floats(noh_stage_kind *k)
{
    for (uint32_t g = 0; k->bank && g < k->bank->group_count; g++) {
        const noh_clip_group *group = &k->bank->groups[g];
        for (uint32_t i = 0; i < group->width; i++) {
            k->named.name_hashes[group->first + i] = group->name_hash;
            k->named.sources[group->first + i] = is_moved(k, g) ? group->first + i : NOH_NONE;
        }
    }
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        const noh_stage_mesh *mesh = &k->meshes[m];
        for (uint32_t i = 0; i < mesh->mesh.header->target_count; i++) {
            const uint32_t at = mesh->first_float + i;
            k->named.name_hashes[at] = mesh->mesh.targets[i].name_hash;
            k->named.defaults[at] = mesh->defaults[i];
        }
    }
}

/* A float that no clip moves takes the value of the first one of its name that a clip does move: teeth follow the jaw
 * though the clips know only the face. */
static void find_sources(noh_stage_kind *k)
{
    const uint32_t set_floats = k->bank ? k->set.float_count : 0;
    k->named.first_renamed = k->float_count;
    for (uint32_t f = 0; f < k->float_count; f++) {
        uint32_t from = f;
        if (f < set_floats && k->named.sources[f] == f) continue;
        for (uint32_t g = 0; g < set_floats; g++) {
            if (k->named.sources[g] == g && k->named.name_hashes[g] == k->named.name_hashes[f]) {
                from = g;
                break;
            }
        }
        k->named.sources[f] = from;
        if (from != f && f < k->named.first_renamed) k->named.first_renamed = f;
    }
}

static void open_floats(noh_stage_kind *k)
{
    for (uint32_t f = 0; f < k->float_count; f++) {
        k->named.sources[f] = NOH_NONE;
        k->named.name_hashes[f] = 0;
        k->named.defaults[f] = k->set.float_defaults && f < k->set.float_count ? k->set.float_defaults[f] : 0.0f;
    }
    name_floats(k);
    find_sources(k);
}

/* ---- levels ---- */

static void open_levels(noh_stage_kind *k)
{
    for (uint32_t l = 0; l < k->plan->level_count; l++) {
        const noh_actor_level *from = &k->plan->levels[l];
        noh_lod_mesh *to = &k->levels[l];
        memset(to, 0, sizeof *to);
        to->triangle_count = from->triangle_count;
        to->error_m = from->error_m;
        for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
            const noh_mesh whole = noh_stage_whole_mesh(k->desc, k->meshes[m].item.mesh);
            const noh_mesh mesh = noh_mesh_at_lod(&whole, from->mesh_levels[m]);
            to->vertex_count += mesh.header->vertex_count;
            if (mesh.header->influence_count > to->influence_count) to->influence_count = mesh.header->influence_count;
        }
    }
    k->table.meshes = k->levels;
    k->table.mesh_level_count = k->plan->level_count;
    k->table.mesh_level_first = k->first_there;
}

/* The table of the first skinned mesh, with its mesh levels replaced by the actors' levels. Fewer influences are
 * chosen only where all meshes have the same: errors are stated by mesh. */
static noh_result open_lod(const noh_stage *s, noh_stage_kind *k, void *memory, size_t bytes, noh_error *error)
{
    noh_lod_pack_desc desc;
    const noh_stage_mesh *skinned = NULL;
    uint32_t count = 0;
    noh_result result = NOH_OK;
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        if (k->meshes[m].skinned) {
            if (!skinned) skinned = &k->meshes[m];
            count++;
        }
    }
    if (k->bank && !s->desc.full_detail) {
        memset(&desc, 0, sizeof desc);
        desc.set = k->bank;
        desc.set_desc = &k->bank_desc;
        desc.mesh = skinned ? &skinned->mesh : NULL;
        result = noh_lod_pack_init(memory, bytes, &desc, &k->lod, error);
        k->table = k->lod.table;
        if (count > 1u) k->table.influence_level_count = 0;
    }
    open_levels(k);
    return result;
}

/* ---- all of it ---- */

noh_character_desc noh_stage_character_desc(const noh_stage_kind *kind, uint32_t instance)
{
    noh_character_desc d;
    memset(&d, 0, sizeof d);
    d.controller.set = &kind->set;
    d.controller.track_count = kind->plan->track_count;
    d.controller.change_count = kind->desc->change_count;
    d.controller.flags = noh_stage_controller_flags(kind->desc);
    d.instance = instance;
    return d;
}

static noh_result open_bounds(noh_stage *s, noh_stage_kind *k, noh_error *error)
{
    const noh_character_desc desc = noh_stage_character_desc(k, 0);
    noh_character_scratch scratch;
    const noh_result result = noh_character_scratch_init(s->jobs[0].scratch, s->scratch_bytes, &desc, &scratch, error);
    if (result == NOH_OK) noh_stage_open_bounds(k, &scratch);
    return result;
}

noh_result noh_stage_open_kind(noh_stage *s, const noh_stage_desc *desc, uint32_t kind,
                               const noh_stage_kind_blocks *blocks, noh_error *error)
{
    static const noh_module none;
    noh_stage_kind *k = &s->kinds[kind];
    noh_stage_needs needs;
    noh_result result = noh_stage_measure_kind(desc, s->plan, kind, &needs, error);
    *k->desc = noh_stage_kind_desc(desc, kind);
    k->plan = &s->plan->kinds[kind];
    if (result == NOH_OK) result = open_clips(s, desc, kind, blocks->bank, &needs, error);
    if (result != NOH_OK) {
        return result;
    }
    open_meshes(k);
    noh_stage_open_load(s, desc, kind);
    open_floats(k);
    noh_stage_open_correctives(k, needs.corrective_count);
    noh_stage_open_weight_rules(k, needs.weight_rule_count);
    result = noh_stage_open_layers(k, kind, error);
    if (result == NOH_OK) result = open_lod(s, k, blocks->lod, needs.lod_bytes, error);
    if (result == NOH_OK) result = open_bounds(s, k, error);
    if (result == NOH_OK) result = noh_stage_init_modules(k, error);
    k->desc->modifiers = NULL;
    k->desc->layers = NULL;
    k->desc->graphs = k->desc->face = k->desc->ragdoll = k->desc->springs = none;
    return result;
}
