/* stage_carve.c: how a stage lies in its block. The code that lays it out also measures it. */
#include <string.h>

#include "core/base/arena_internal.h"
#include "core/base/compiler_internal.h"
#include "life/face/recipe_internal.h"
#include "stage/character/lod_pools_internal.h"
#include "stage/character/scheduler_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "stage/cast/stage_internal.h"

/* ---- what a kind needs ---- */

/* A clip bank with counts alone, for sizes that depend on nothing else. */
static size_t lod_bytes(const noh_clip_bank_desc *bank_desc, const noh_stage_needs *n, const noh_mesh *mesh)
{
    noh_clip_bank counts;
    noh_lod_pack_desc desc;
    if (!n->has_clips) {
        return 0;
    }
    memset(&counts, 0, sizeof counts);
    memset(&desc, 0, sizeof desc);
    counts.clips = n->shape;
    counts.skeleton.joint_count = n->shape.joint_count;
    desc.set = &counts;
    desc.set_desc = bank_desc;
    desc.mesh = mesh;
    return noh_lod_pack_size(&desc);
}

/* Without clips there is a set of one clip, the bind pose; a set without joints has a float. With modifiers it
 * has the floats of the meshes, for them to set. */
static void shape_without_clips(const noh_kind_desc *d, uint32_t weight_count, noh_clip_set *shape)
{
    noh_skeleton skeleton;
    memset(shape, 0, sizeof *shape);
    shape->clip_count = 1;
    if (noh_pack_skeleton_at(d->mesh, d->skeleton, &skeleton, NULL, NULL) == NOH_OK) {
        shape->joint_count = skeleton.joint_count;
    }
    shape->float_count = noh_stage_has_modifiers(d) && weight_count ? weight_count : shape->joint_count ? 0 : 1;
}

noh_result noh_stage_measure_clips(const noh_stage_desc *desc, const noh_stage_plan *plan, uint32_t kind,
                                   noh_kind_clips *clips, noh_error *error)
{
    const noh_clip_bank_desc bank = noh_stage_bank_desc(desc, plan, kind);
    noh_error said = { NOH_OK, "", 0, 0 };
    noh_clip_bank_needs needs;
    const int none = bank.clip_packs && !bank.clip_pack_count;
    const noh_result result = none ? NOH_ERR_NOT_FOUND : noh_clip_bank_measure(&bank, &needs, &said);
    memset(clips, 0, sizeof *clips);
    clips->asked = plan->kinds[kind].cached_segment_count;
    if (result == NOH_ERR_NOT_FOUND) {
        return NOH_OK;
    }
    if (result != NOH_OK) {
        return noh_fail(error, result, said.what, said.where, said.need);
    }
    clips->bank_bytes = needs.bytes;
    clips->view_bytes = needs.view_bytes;
    clips->clip_count = needs.shape.clip_count;
    clips->event_count = needs.shape.event_count;
    clips->marker_count = needs.shape.marker_count;
    clips->joint_count = needs.shape.joint_count;
    clips->float_count = needs.shape.float_count;
    clips->cached_segment_count = needs.cached_segment_count;
    clips->segment_count = needs.segment_count;
    return NOH_OK;
}

static void take_clips(const noh_kind_clips *clips, const noh_kind_desc *d, int owns, noh_stage_needs *n)
{
    if (!clips->bank_bytes) {
        shape_without_clips(d, n->weight_count, &n->shape);
        return;
    }
    n->has_clips = 1;
    n->shape.clip_count = clips->clip_count;
    n->shape.event_count = clips->event_count;
    n->shape.marker_count = clips->marker_count;
    n->shape.joint_count = clips->joint_count;
    n->shape.float_count = clips->float_count;
    n->cached_segment_count = clips->cached_segment_count;
    n->segment_count = clips->segment_count;
    n->bank_bytes = owns ? (size_t)clips->bank_bytes : 0;
    n->view_bytes = owns ? (size_t)clips->view_bytes : 0;
}

/* Masks: one for each layer that names joints or floats. */
static uint32_t count_masks(const noh_kind_desc *d)
{
    uint32_t masks = 0;
    for (uint32_t i = 0; i < d->layer_count; i++) {
        masks += d->layers[i].joints || d->layers[i].floats;
    }
    return masks;
}

static void measure_meshes(const noh_kind_desc *d, noh_stage_needs *n, noh_mesh *skinned)
{
    noh_stage_item items[NOH_STAGE_MESHES_MAX];
    n->mesh_count = noh_stage_items(d, items);
    skinned->header = NULL;
    for (uint32_t i = 0; i < n->mesh_count; i++) {
        noh_mesh mesh;
        noh_skin skin;
        size_t pick;
        (void)noh_pack_mesh_at(d->mesh, items[i].mesh, &mesh, NULL);
        n->weight_count += mesh.header->target_count;
        n->corrective_count += noh_correctives_bind(&mesh, NULL, 0);
        n->weight_rule_count += d->weight_rules ? noh_weight_rules_bind(&mesh, NULL, 0)
                                                : noh_expressions_bind(&mesh, NULL, 0);
        pick = d->unpickable ? 0 : noh_stage_pick_bytes(&mesh, NULL);
        n->pick_bytes = pick > n->pick_bytes ? pick : n->pick_bytes;
        if (noh_pack_skin_at(d->mesh, mesh.header->skin, &skin, NULL) != NOH_OK) {
            continue;
        }
        if (!skinned->header) *skinned = mesh;
        n->skin_joints = skin.header->joint_count > n->skin_joints ? skin.header->joint_count : n->skin_joints;
    }
}

static void measure_actors(const noh_kind_desc *d, noh_stage_needs *n)
{
    noh_character_desc character;
    memset(&character, 0, sizeof character);
    n->shape.mask_count = n->mask_count;
    character.controller.set = &n->shape;
    character.controller.track_count = noh_stage_track_count(d);
    character.controller.change_count = d->change_count;
    character.controller.flags = noh_stage_controller_flags(d);
    n->inertia_bytes = d->inertia ? noh_pose_scratch_size(&n->shape, 1) : 0;
    n->character_bytes = noh_character_size(&character);
    n->scratch_bytes = noh_character_scratch_size(&character);
}

static size_t pools_bytes(const noh_stage_plan *plan, const noh_kind_desc *d, uint32_t kind)
{
    uint32_t levels[NOH_LOD_LEVELS_MAX], slots[NOH_LOD_LEVELS_MAX];
    noh_lod_pools_desc desc = { d->actor_count, 0, levels, slots, d->visible_max };
    desc.pool_count = noh_stage_pools(&plan->kinds[kind], levels, slots);
    return noh_lod_pools_size(&desc);
}

noh_result noh_stage_measure_kind(const noh_stage_desc *desc, const noh_stage_plan *plan, uint32_t kind,
                                  noh_stage_needs *needs, noh_error *error)
{
    const noh_kind_desc d = noh_stage_kind_desc(desc, kind);
    const uint32_t owner = noh_stage_bank_kind(desc, kind);
    const noh_clip_bank_desc bank = noh_stage_bank_desc(desc, plan, owner);
    noh_mesh skinned;
    noh_result result;
    memset(needs, 0, sizeof *needs);
    needs->kind = kind;
    measure_meshes(&d, needs, &skinned);
    take_clips(&plan->kinds[kind].clips, &d, owner == kind, needs);
    needs->mask_count = count_masks(&d);
    needs->float_count = (needs->has_clips ? needs->shape.float_count : 0) +
                         (needs->has_clips && d.mesh->node_count ? 0 : needs->weight_count);
    needs->lod_bytes = desc->full_detail ? 0 : lod_bytes(&bank, needs, skinned.header ? &skinned : NULL);
    measure_actors(&d, needs);
    result = noh_stage_measure_modules(&d, needs, error);
    if (result != NOH_OK) {
        return result;
    }
    needs->pools_bytes = pools_bytes(plan, &d, kind);
    if (!needs->character_bytes || !needs->pools_bytes) {
        return noh_fail(error, NOH_ERR_LIMIT, "a kind has more clips, joints, tracks or slots than a character can",
                        kind, 0);
    }
    return NOH_OK;
}

uint32_t noh_stage_pools(const noh_kind_plan *plan, uint32_t *levels, uint32_t *slots)
{
    uint32_t count = 0;
    for (uint32_t l = 0; l < plan->level_count; l++) {
        if (plan->levels[l].slot_count) {
            levels[count] = l;
            slots[count++] = plan->levels[l].slot_count;
        }
    }
    return count;
}

/* ---- the block ---- */

#define CARVE(arena, count, type) ((type *)noh_arena_carve(arena, (size_t)(count) * sizeof(type), 16))

void noh_stage_add_part(noh_stage_list *list, const char *what, uint32_t kind, uint64_t cpu_bytes, uint64_t gpu_bytes)
{
    if (list && list->count < list->capacity) {
        noh_stage_bytes *part = &list->parts[list->count];
        part->what = what;
        part->kind = kind;
        part->cpu_bytes = cpu_bytes;
        part->gpu_bytes = gpu_bytes;
    }
    if (list) {
        list->count++;
        list->cpu_bytes += cpu_bytes;
    }
}

/* Everything that was carved since *from. */
static void add(noh_stage_list *list, const char *what, uint32_t kind, const noh_arena *arena, size_t *from)
{
    noh_stage_add_part(list, what, kind, arena->used - *from, 0);
    *from = arena->used;
}

/* What the other functions need to know of all kinds together. */
typedef struct widest {
    size_t scratch_bytes, module_scratch_bytes, pick_bytes, views_bytes, inertia_bytes;
    uint32_t skin_joints, wearer_joints, actors, slot_count;
    int reserves; /* 1: clips may come */
} widest;

static int is_wearer(const noh_stage_desc *desc, uint32_t kind)
{
    for (uint32_t i = 0; i < desc->kind_count; i++) {
        const noh_kind_desc *d = &desc->kinds[i];
        uint32_t worn_by = d->worn_by;
        for (uint32_t o = 0; d->changes && o < d->other_count; o++) worn_by |= d->others[o].worn_by;
        if (worn_by >> kind & 1u) return 1;
    }
    return 0;
}

static void widen(widest *most, const noh_stage_desc *desc, uint32_t kind, const noh_stage_needs *n)
{
    if (n->scratch_bytes > most->scratch_bytes) most->scratch_bytes = n->scratch_bytes;
    if (n->module_scratch_bytes > most->module_scratch_bytes) most->module_scratch_bytes = n->module_scratch_bytes;
    if (n->pick_bytes > most->pick_bytes) most->pick_bytes = n->pick_bytes;
    if (n->inertia_bytes > most->inertia_bytes) most->inertia_bytes = n->inertia_bytes;
    if (n->skin_joints > most->skin_joints) most->skin_joints = n->skin_joints;
    if (n->shape.joint_count > most->wearer_joints && is_wearer(desc, kind)) most->wearer_joints = n->shape.joint_count;
    most->views_bytes += noh_aligned(n->view_bytes);
    most->actors += desc->kinds[kind].actor_count;
}

static size_t larger(size_t a, uint64_t b)
{
    return a > b ? a : (size_t)b;
}

static void widen_by_room(widest *most, const noh_stage_desc *desc, uint32_t kind, const noh_kind_room *room)
{
    most->scratch_bytes = larger(most->scratch_bytes, room->scratch_bytes);
    most->module_scratch_bytes = larger(most->module_scratch_bytes, room->module_scratch_bytes);
    most->pick_bytes = larger(most->pick_bytes, room->pick_bytes);
    most->inertia_bytes = larger(most->inertia_bytes, room->inertia_bytes);
    most->skin_joints = (uint32_t)larger(most->skin_joints, room->skin_joint_count);
    if (is_wearer(desc, kind)) most->wearer_joints = (uint32_t)larger(most->wearer_joints, room->joint_count);
    most->views_bytes += (size_t)room->view_bytes;
    most->actors += (uint32_t)room->actor_count;
}

static void carve_state(noh_arena *arena, const noh_kind_desc *d, const noh_stage_needs *n, noh_stage_kind *k,
                        void **pools)
{
    k->character_bytes = (uint32_t)n->character_bytes;
    k->characters = noh_arena_carve(arena, d->actor_count * n->character_bytes, 16);
    k->held = CARVE(arena, d->actor_count * (size_t)d->held_float_count, noh_stage_held);
    k->modules[NOH_SLOT_SOURCE].states = noh_arena_carve(arena,
                                                         d->actor_count * n->modules[NOH_SLOT_SOURCE].actor_bytes, 16);
    k->modifier_states = noh_arena_carve(arena, d->actor_count * n->modifier_bytes, 16);
    k->modifier_bytes = n->modifier_bytes;
    for (uint32_t slot = 0; slot < NOH_SLOT_COUNT; slot++) {
        k->modules[slot].pool = noh_arena_carve(arena, n->modules[slot].pool_bytes, 16);
    }
    *pools = noh_arena_carve(arena, n->pools_bytes, 16);
}

static void carve_shared(noh_arena *arena, const noh_kind_desc *d, const noh_kind_plan *plan, const noh_stage_needs *n,
                         noh_stage_kind *k)
{
    k->layers = CARVE(arena, d->layer_count, noh_stage_layer);
    k->meshes = CARVE(arena, n->mesh_count, noh_stage_mesh);
    k->named.sources = CARVE(arena, n->float_count, uint32_t);
    k->named.name_hashes = CARVE(arena, n->float_count, uint32_t);
    k->named.defaults = CARVE(arena, n->float_count, float);
    k->target_radii = CARVE(arena, n->weight_count, float);
    k->targets.correctives = CARVE(arena, n->corrective_count, noh_corrective_term);
    k->targets.weight_rules = CARVE(arena, n->weight_rule_count, noh_weight_rule);
    k->worn_maps = CARVE(arena, noh_stage_worn_maps(d) * (n->shape.joint_count + n->float_count), uint16_t);
    k->masks = CARVE(arena, n->mask_count * (size_t)(n->shape.joint_count + n->shape.float_count), uint8_t);
    k->levels = CARVE(arena, plan->level_count, noh_lod_mesh);
    k->joint_radii = CARVE(arena, n->shape.joint_count, float);
}

static void carve_frame(noh_arena *arena, const noh_kind_desc *d, const noh_stage_needs *n, noh_stage_kind *k)
{
    k->floats = CARVE(arena, (size_t)d->actor_count * n->float_count, float);
    k->weights = CARVE(arena, (size_t)d->actor_count * n->weight_count, float);
    k->order = CARVE(arena, d->visible_max, uint32_t);
}

/* Once for the stage, after the state. */
static void carve_stage(noh_arena *arena, const noh_stage_desc *filled, const widest *most, noh_stage_blocks *b)
{
    b->stage = CARVE(arena, 1, noh_stage);
    b->kinds = CARVE(arena, filled->kind_count, noh_stage_kind);
    b->kind_descs = CARVE(arena, filled->kind_count, noh_kind_desc);
    if (most->slot_count) b->slots = CARVE(arena, 1, noh_stage_slots);
    b->shown = CARVE(arena, most->actors, noh_stage_shown);
    b->todo = CARVE(arena, most->actors, uint32_t);
    b->wanted = !NOH_PAGE && most->reserves ? CARVE(arena, NOH_WANTED_CLIPS_MAX, noh_wanted_clip) : NULL;
    b->by_distance = CARVE(arena, filled->sort_blended ? most->actors : 0, noh_stage_far);
    b->schedule = noh_arena_carve(arena, noh_schedule_size(most->actors), 16);
    b->pick_bytes = most->pick_bytes;
    b->pick_scratch = noh_arena_carve(arena, most->pick_bytes, 16);
    b->inertia_bytes = most->inertia_bytes;
    b->inertia_scratch = noh_arena_carve(arena, most->inertia_bytes, 16);
}

static void carve_jobs(noh_arena *arena, const noh_stage_desc *filled, const widest *most, noh_stage_blocks *b)
{
    b->jobs = CARVE(arena, filled->job_count, noh_stage_job_part);
    b->views_bytes = most->views_bytes;
    b->views = noh_arena_carve(arena, filled->job_count * most->views_bytes, 16);
    b->scratch_bytes = noh_aligned(most->scratch_bytes);
    b->scratch = noh_arena_carve(arena, filled->job_count * b->scratch_bytes, 16);
    b->module_scratch_bytes = noh_aligned(most->module_scratch_bytes);
    b->module_scratch = noh_arena_carve(arena, filled->job_count * b->module_scratch_bytes, 16);
    b->matrices_floats = 12u * (size_t)most->skin_joints;
    b->matrices = CARVE(arena, filled->job_count * b->matrices_floats, float);
    b->wearer_joints = most->wearer_joints;
    b->wearers = CARVE(arena, filled->job_count * (size_t)most->wearer_joints, noh_transform);
}

/* The state of one kind, whose pointers are not wanted yet. Not inlined: what measures a kind has deep stacks, and a
 * noh_stage_kind need not lie below them. */
static NOH_NEVER_INLINE void measure_state(noh_arena *arena, const noh_stage_desc *desc, uint32_t i,
                                           const noh_stage_needs *n, noh_stage_blocks *b)
{
    const noh_kind_desc d = noh_stage_kind_desc(desc, i);
    noh_stage_kind kind;
    carve_state(arena, &d, n, &kind, &b->of[i].pools);
}

/* States of modules that are listed by themselves. */
static void list_states(noh_stage_list *list, const noh_stage_desc *desc, uint32_t kind, const noh_stage_needs *n,
                        size_t *from)
{
    const noh_kind_desc d = noh_stage_kind_desc(desc, kind);
    for (uint32_t slot = 0; slot < NOH_SLOT_COUNT; slot++) {
        const noh_module m = noh_stage_wanted(&d, slot);
        const size_t pool = noh_aligned(n->modules[slot].pool_bytes);
        const size_t states = d.actor_count * n->modules[slot].actor_bytes;
        if (m.type && m.type->pool_name) {
            noh_stage_add_part(list, m.type->pool_name, kind, pool, 0);
            *from += pool;
        }
        if (m.type && m.type->state_name) {
            noh_stage_add_part(list, m.type->state_name, kind, states, 0);
            *from += states;
        }
    }
}

static int has_reserve(const noh_kind_desc *d)
{
    int has = d->clip_reserve != 0;
    for (uint32_t o = 0; d->changes && o < d->other_count; o++) has |= d->others[o].clip_reserve != 0;
    return has;
}

/* The first pass: the state, and what it takes to know how large the rest is. */
static noh_result carve_states(noh_arena *arena, const noh_stage_desc *desc, const noh_stage_plan *plan,
                               noh_stage_blocks *b, noh_stage_list *list, widest *most, noh_error *error)
{
    size_t from = arena->used;
    memset(most, 0, sizeof *most);
    for (uint32_t i = 0; i < desc->kind_count; i++) {
        most->actors += desc->kinds[i].changes ? (uint32_t)plan->kinds[i].room.actor_count : desc->kinds[i].actor_count;
        most->slot_count += desc->kinds[i].changes != 0;
        most->reserves |= has_reserve(&desc->kinds[i]);
    }
    b->head = CARVE(arena, 1, noh_stage_head);
    b->actors = CARVE(arena, most->actors, noh_stage_actor);
    most->actors = 0;
    add(list, "actors", NOH_NONE, arena, &from);
    for (uint32_t i = 0; i < desc->kind_count; i++) {
        noh_stage_needs needs;
        noh_result result;
        if (desc->kinds[i].changes) {
            (void)noh_arena_carve(arena, (size_t)plan->kinds[i].room.state_bytes, 16);
            widen_by_room(most, desc, i, &plan->kinds[i].room);
            add(list, "characters", i, arena, &from);
            continue;
        }
        result = noh_stage_measure_kind(desc, plan, i, &needs, error);
        if (result != NOH_OK) {
            return result;
        }
        measure_state(arena, desc, i, &needs, b);
        widen(most, desc, i, &needs);
        if (list) list_states(list, desc, i, &needs, &from);
        add(list, "characters", i, arena, &from);
    }
    (void)noh_arena_carve(arena, 0, 16);
    b->state_bytes = arena->used;
    return NOH_OK;
}

/* The pointers into the state, once there are kinds to hold them. */
static void point_at_state(const noh_stage_desc *desc, const noh_stage_needs *n, uint32_t i, uint8_t **at,
                           noh_stage_kind *k)
{
    const noh_kind_desc d = noh_stage_kind_desc(desc, i);
    noh_arena arena = noh_arena_over(*at, SIZE_MAX);
    void *pools;
    carve_state(&arena, &d, n, k, &pools);
    noh_stage_open_modules(k, n);
    *at += noh_aligned(arena.used);
}

/* What is not state of one kind.
 * state  where its state lies; NULL: only measured */
static NOH_NEVER_INLINE void carve_kind(noh_arena *arena, const noh_stage_desc *desc, const noh_stage_plan *plan,
                                        uint32_t i, const noh_stage_needs *n, noh_stage_blocks *b, noh_stage_list *list,
                                        uint8_t **state)
{
    const noh_kind_desc d = noh_stage_kind_desc(desc, i);
    noh_stage_kind measured, *k = b->kinds ? &b->kinds[i] : &measured;
    size_t from = arena->used;
    memset(k, 0, sizeof *k);
    carve_shared(arena, &d, &plan->kinds[i], n, k);
    b->of[i].lod = noh_arena_carve(arena, n->lod_bytes, 16);
    carve_frame(arena, &d, n, k);
    add(list, "kind", i, arena, &from);
    for (uint32_t slot = 0; slot < NOH_SLOT_COUNT; slot++) {
        const noh_module m = noh_stage_wanted(&d, slot);
        if (!m.type) continue;
        k->modules[slot].type = m.type;
        k->modules[slot].shared = noh_arena_carve(arena, n->modules[slot].kind_bytes, 16);
        if (m.type->kind_name) add(list, m.type->kind_name, i, arena, &from);
    }
    b->of[i].bank = noh_arena_carve(arena, n->bank_bytes, 16);
    if (!NOH_PAGE && d.clip_reserve && n->bank_bytes) {
        const uint32_t reserve = (uint32_t)noh_aligned(d.clip_reserve);
        noh_stage_add_part(list, "clip reserve", i, reserve, 0);
        from += reserve;
    }
    add(list, "clips", i, arena, &from);
    if (*state) point_at_state(desc, n, i, state, k);
}

/* ---- slots ---- */

/* Not inlined: a copy of all blocks lies on the stack. */
NOH_NEVER_INLINE void noh_stage_room(const noh_stage_desc *desc, const noh_stage_plan *plan, uint32_t kind,
                                     const noh_stage_needs *n, noh_kind_room *room)
{
    noh_stage_blocks none;
    noh_arena state = noh_arena_measure(), own = noh_arena_measure();
    uint8_t *at = NULL;
    memset(&none, 0, sizeof none);
    measure_state(&state, desc, kind, n, &none);
    carve_kind(&own, desc, plan, kind, n, &none, NULL, &at);
    room->actor_count = desc->kinds[kind].actor_count;
    room->joint_count = n->shape.joint_count;
    room->skin_joint_count = n->skin_joints;
    room->state_bytes = noh_aligned(state.used);
    room->kind_bytes = noh_aligned(own.used);
    room->view_bytes = noh_aligned(n->view_bytes);
    room->scratch_bytes = noh_aligned(n->scratch_bytes);
    room->module_scratch_bytes = noh_aligned(n->module_scratch_bytes);
    room->pick_bytes = n->pick_bytes;
    room->inertia_bytes = n->inertia_bytes;
}

/* Not inlined, as above. */
NOH_NEVER_INLINE noh_result noh_stage_carve_slot(const noh_stage *s, uint32_t kind, noh_stage_kind_blocks *out,
                                                 noh_error *error)
{
    const noh_kind_desc d = noh_stage_kind_desc(&s->desc, kind);
    noh_arena own = noh_arena_over(s->slots->of[kind].own, (size_t)s->plan->kinds[kind].room.kind_bytes);
    noh_arena state = noh_arena_over(s->slots->of[kind].state, (size_t)s->plan->kinds[kind].room.state_bytes);
    uint8_t *at = s->slots->of[kind].state;
    noh_stage_kind k = s->kinds[kind];
    noh_stage_needs needs;
    noh_stage_blocks b;
    const noh_result result = noh_stage_measure_kind(&s->desc, s->plan, kind, &needs, error);
    if (result != NOH_OK) {
        return result;
    }
    memset(&b, 0, sizeof b);
    b.kinds = s->kinds;
    carve_kind(&own, &s->desc, s->plan, kind, &needs, &b, NULL, &at);
    s->kinds[kind].desc = k.desc;
    s->kinds[kind].plan = k.plan;
    s->kinds[kind].first_actor = k.first_actor;
    s->kinds[kind].actors = k.actors;
    carve_state(&state, &d, &needs, &k, &b.of[kind].pools); /* for where the pools lie */
    s->slots->of[kind].used = (uint32_t)state.used;
    *out = b.of[kind];
    return NOH_OK;
}

static void carve_slots_room(noh_arena *arena, uint32_t kind, const noh_kind_room *room, noh_stage_blocks *b,
                             noh_stage_list *list, uint8_t **state)
{
    size_t from = arena->used;
    uint8_t *own = noh_arena_carve(arena, (size_t)room->kind_bytes, 16);
    add(list, "kind", kind, arena, &from);
    if (!*state) return;
    b->slots->of[kind].own = own;
    b->slots->of[kind].state = *state;
    *state += room->state_bytes;
}

noh_result noh_stage_carve(noh_arena *arena, const noh_stage_desc *desc, const noh_stage_plan *plan,
                           noh_stage_blocks *b, noh_stage_list *list, noh_error *error)
{
    const noh_stage_desc filled = noh_stage_desc_filled(desc);
    widest most;
    size_t from;
    uint8_t *state;
    noh_result result = carve_states(arena, desc, plan, b, list, &most, error);
    if (result != NOH_OK) {
        return result;
    }
    state = b->actors ? (uint8_t *)b->actors + noh_aligned(most.actors * sizeof *b->actors) : NULL;
    from = arena->used;
    carve_stage(arena, &filled, &most, b);
    if (b->slots) memset(b->slots, 0, sizeof *b->slots);
    add(list, "stage", NOH_NONE, arena, &from);
    b->events = CARVE(arena, filled.event_count, noh_stage_event);
    add(list, "events", NOH_NONE, arena, &from);
    carve_jobs(arena, &filled, &most, b);
    add(list, "jobs", NOH_NONE, arena, &from);
    for (uint32_t i = 0; i < desc->kind_count && result == NOH_OK; i++) {
        noh_stage_needs needs;
        if (desc->kinds[i].changes) {
            carve_slots_room(arena, i, &plan->kinds[i].room, b, list, &state);
            continue;
        }
        result = noh_stage_measure_kind(desc, plan, i, &needs, error);
        if (result == NOH_OK) carve_kind(arena, desc, plan, i, &needs, b, list, &state);
    }
    return result;
}
