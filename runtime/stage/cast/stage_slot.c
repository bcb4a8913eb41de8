/* stage_slot.c: kinds that come into a running stage and go out of it.
 *
 * A kind that changes has a slot: a stretch of the state, a stretch for all else that is the kind's, room for the views
 * of its clips in each job, and indices of actors. The plan makes each as large as the largest of the kinds that it
 * knows for the slot, planned one after another as if each were alone. So what runs never moves, and a kind that comes
 * is checked, planned and laid out by the code that does so at init. A slot shares nothing with other kinds: whatever
 * is in it can go without asking them. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/compiler_internal.h"
#include "noh/base.h"
#include "noh/low_core.h"
#include "noh/noh.h"
#include "stage/cast/stage_internal.h"

/* ---- room ---- */

/* In the order of noh_kind_room. */
static const char *const too_large[] = { "a kind has more actors than its slot",
                                         "a kind has more joints than its slot",
                                         "a kind has a skin of more joints than its slot",
                                         "a kind takes more bytes of state than its slot has",
                                         "a kind and its clips take more bytes than its slot has",
                                         "the clips of a kind take more bytes of views than its slot has",
                                         "a kind takes more bytes of scratch for its poses than its slot has",
                                         "the modules of a kind take more bytes of scratch than its slot has",
                                         "picking a kind takes more bytes than its slot has",
                                         "inertia of a kind takes more bytes than its slot has" };

/* The other fields are checked in stage_gl_slot.c. */
NOH_STATIC_ASSERT(sizeof(noh_kind_room) == 8 * (3 + sizeof too_large / sizeof *too_large), kind_room);

static noh_result check_room(const noh_kind_room *asked, const noh_kind_room *had, noh_error *error)
{
    const uint64_t *a = (const uint64_t *)(const void *)asked, *h = (const uint64_t *)(const void *)had;
    for (uint32_t i = 0; i < sizeof too_large / sizeof *too_large; i++) {
        if (a[i] > h[i]) return noh_fail(error, NOH_ERR_MEMORY, too_large[i], h[i], a[i]);
    }
    return NOH_OK;
}

static void widen(const noh_kind_room *by, noh_kind_room *room)
{
    const uint64_t *b = (const uint64_t *)(const void *)by;
    uint64_t *r = (uint64_t *)(void *)room;
    for (uint32_t i = 0; i < sizeof *by / sizeof *b; i++) r[i] = b[i] > r[i] ? b[i] : r[i];
}

static noh_result no_finer(noh_error *error)
{
    return noh_fail(error, NOH_ERR_UNSUPPORTED,
                    "finer of a kind: the kinds of a slot are uploaded in pieces anyway; leave it NULL", 0, 0);
}

/* Not inlined: gpu->room has a deep stack, and a noh_stage_needs is large. */
NOH_NEVER_INLINE static noh_result plan_posed(const noh_stage_desc *alone, noh_stage_plan *plan, noh_kind_room *room,
                                              noh_error *error)
{
    noh_stage_needs needs;
    const noh_result result = noh_stage_plan_kind(alone, 0, plan, &needs, error);
    if (result == NOH_OK) noh_stage_room(alone, plan, 0, &needs, room);
    return result;
}

/* A kind by itself, in kinds[0] of the plan. */
NOH_NEVER_INLINE static noh_result plan_alone(const noh_stage_desc *desc, const noh_kind_desc *kind,
                                              const struct noh_gl_caps *caps, noh_stage_plan *plan, noh_kind_room *room,
                                              noh_error *error)
{
    noh_stage_desc alone = *desc;
    noh_kind_desc slot = *kind;
    noh_kind_room one;
    noh_result result;
    slot.changes = 1;
    alone.kinds = &slot;
    alone.kind_count = 1;
    if (desc->gpu && kind->finer) return no_finer(error);
    memset(&plan->kinds[0], 0, sizeof plan->kinds[0]);
    memset(&one, 0, sizeof one);
    result = plan_posed(&alone, plan, &one, error);
    noh_stage_desc_by_plan(&alone, plan);
    if (result == NOH_OK && desc->gpu) result = desc->gpu->room(&alone, caps, plan, &one, error);
    if (result == NOH_OK) widen(&one, room);
    return result;
}

int noh_stage_has_slots(const noh_stage_desc *desc)
{
    int has = 0;
    for (uint32_t i = 0; i < desc->kind_count; i++) has |= desc->kinds[i].changes != 0;
    return has;
}

noh_result noh_stage_plan_rooms(const noh_stage_desc *desc, const struct noh_gl_caps *caps, noh_stage_plan *plan,
                                noh_error *error)
{
    noh_kind_room first;
    noh_result result = NOH_OK;
    memset(&first, 0, sizeof first);
    for (uint32_t i = 0; i < desc->kind_count && result == NOH_OK; i++) {
        const noh_kind_desc *d = &desc->kinds[i];
        noh_kind_room *room = i ? &plan->kinds[i].room : &first;
        if (!d->changes) continue;
        result = plan_alone(desc, d, caps, plan, room, error);
        for (uint32_t o = 0; o < d->other_count && result == NOH_OK; o++) {
            result = plan_alone(desc, &d->others[o], caps, plan, room, error);
        }
    }
    memset(&plan->kinds[0], 0, sizeof plan->kinds[0]);
    plan->kinds[0].room = first;
    return result;
}

/* ---- in and out ---- */

/* What is in the slots belongs to what a state means. */
static void hash_slots(noh_stage *s)
{
    uint32_t hash = s->plan->hash;
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        if (s->slots->of[i].own) hash = noh_stage_mix(hash, s->slots->of[i].hash);
    }
    s->head->hash = hash;
}

/* Its actors' generations stay: their ids never come back. */
static void empty(noh_stage *s, uint32_t kind)
{
    noh_stage_kind *k = &s->kinds[kind], cleared;
    noh_kind_plan *plan = &s->slots->plan.kinds[kind];
    const noh_kind_room room = plan->room;
    if (s->gpu) s->desc.gpu->close(s, kind);
    if (!NOH_PAGE) noh_stage_forget_wanted(s, kind);
    memset(&cleared, 0, sizeof cleared);
    cleared.desc = k->desc;
    cleared.plan = plan;
    cleared.first_actor = k->first_actor;
    cleared.actors = k->actors;
    cleared.bank_kind = kind;
    cleared.finer.kind = NOH_NONE;
    *k = cleared;
    memset(k->desc, 0, sizeof *k->desc);
    k->desc->changes = 1;
    memset(plan, 0, sizeof *plan);
    plan->room = room;
    memset(s->slots->of[kind].state, 0, (size_t)room.state_bytes);
    memset(&s->head->kinds[kind], 0, sizeof s->head->kinds[kind]);
    memset(s->shown + k->first_actor, 0, (size_t)room.actor_count * sizeof *s->shown);
    for (uint64_t i = 0; i < room.actor_count; i++) {
        const uint32_t generation = k->actors[i].generation;
        memset(&k->actors[i], 0, sizeof k->actors[i]);
        k->actors[i].generation = generation;
    }
    for (uint32_t j = 0; j < s->desc.job_count; j++) s->jobs[j].views[kind] = NULL;
    s->slots->of[kind].hash = 0;
    s->slots->of[kind].used = 0;
}

/* What wears garments is not worn itself (noh_stage_bad_worn has the other direction). */
static noh_result check_worn(const noh_stage *s, uint32_t kind, const noh_kind_desc *desc, noh_error *error)
{
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        if (s->desc.kinds[i].worn_by >> kind & 1u && desc->worn_by)
            return noh_fail(error, NOH_ERR_ARG,
                            "worn_by of a kind whose slot is in worn_by of another kind: clear one of both", i, 0);
    }
    return NOH_OK;
}

/* A pose of a wearer is kept for its garments while they follow it. */
static noh_result check_wearers(const noh_stage *s, uint32_t kind, const noh_stage_needs *needs, noh_error *error)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        if (s->desc.kinds[i].worn_by >> kind & 1u && needs->shape.joint_count > most) most = needs->shape.joint_count;
        if (s->desc.kinds[kind].worn_by >> i & 1u && s->kinds[i].skeleton.joint_count > most)
            most = s->kinds[i].skeleton.joint_count;
    }
    return most <= s->wearer_joints
               ? NOH_OK
               : noh_fail(error, NOH_ERR_MEMORY,
                          "worn_by of a kind: its wearer has more joints than the plan has room for", s->wearer_joints,
                          most);
}

static noh_result open_slot(noh_stage *s, uint32_t kind, noh_error *error)
{
    noh_stage_kind_blocks blocks;
    noh_result result;
    result = noh_stage_carve_slot(s, kind, &blocks, error);
    if (result == NOH_OK) result = noh_stage_open_kind(s, &s->desc, kind, &blocks, error);
    if (result == NOH_OK) result = noh_stage_open_pools(s, kind, blocks.pools, error);
    if (result == NOH_OK)
        result = noh_stage_open_views(s, kind, s->slots->of[kind].views, s->slots->views_bytes, error);
    if (result == NOH_OK) noh_stage_open_worn(s, kind);
    if (!NOH_PAGE && result == NOH_OK) noh_stage_empty_clips(s, kind);
    return result;
}

/* Plan a kind in its slot. Not inlined: opening it has a deep stack. */
NOH_NEVER_INLINE static noh_result plan_slot(noh_stage *s, uint32_t kind, noh_error *error)
{
    noh_stage_needs needs;
    noh_kind_room room;
    noh_result result = noh_stage_plan_kind(&s->desc, kind, &s->slots->plan, &needs, error);
    if (result == NOH_OK) {
        noh_stage_room(&s->desc, s->plan, kind, &needs, &room);
        result = check_room(&room, &s->plan->kinds[kind].room, error);
    }
    if (result == NOH_OK) result = check_wearers(s, kind, &needs, error);
    if (result == NOH_OK) s->slots->of[kind].hash = noh_stage_hash_kind(2166136261u, &s->desc, s->plan, kind);
    return result;
}

/* The slot is empty, and is again where the kind does not fit. */
static noh_result fill(noh_stage *s, uint32_t kind, const noh_kind_desc *desc, noh_error *error)
{
    noh_kind_desc *d = &s->kind_descs[kind];
    noh_result result = noh_stage_check_kind(&s->desc, desc, kind, error);
    if (result == NOH_OK) result = check_worn(s, kind, desc, error);
    if (!NOH_PAGE && result == NOH_OK && desc->clip_reserve && !s->stats.wanted) {
        result = noh_fail(error, NOH_ERR_UNSUPPORTED,
                          "clip_reserve of a kind, and no kind of the plan has it: set it in one of the slot's others",
                          kind, 0);
    }
    if (result != NOH_OK) {
        return result;
    }
    *d = *desc;
    d->changes = 1;
    d->others = NULL;
    d->other_count = 0;
    result = s->desc.gpu && desc->finer ? no_finer(error) : plan_slot(s, kind, error);
    if (result == NOH_OK) result = open_slot(s, kind, error);
    if (result == NOH_OK && s->gpu) result = s->desc.gpu->open(s, kind, error);
    s->kinds[kind].finer.hidden = s->gpu != NULL;
    d->finer = NULL;
    if (result == NOH_OK) {
        noh_stage_open_actors(s, kind); /* last: it begins generations, which stay */
    } else {
        empty(s, kind);
    }
    return result;
}

noh_result noh_stage_open_slots(noh_stage *s, const noh_stage_desc *desc, noh_error *error)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        if (desc->kinds[i].changes) empty(s, i);
    }
    for (uint32_t i = 0; i < s->desc.kind_count && result == NOH_OK; i++) {
        if (desc->kinds[i].changes == 1) result = fill(s, i, &desc->kinds[i], error);
    }
    hash_slots(s);
    return result;
}

static const char *cannot_set(const noh_stage *s, uint32_t kind, const noh_kind_desc *desc)
{
    if (s->phase != NOH_STAGE_IDLE) return "cannot change a kind during a step or a frame";
    if (kind >= s->desc.kind_count || !s->slots || !s->slots->of[kind].own)
        return "the kind has no slot: set changes of noh_kind_desc";
    if (desc && s->kinds[kind].pools) return "the slot holds a kind: empty it first";
    return !desc && s->head->kinds[kind].count ? "actors of the kind are there: despawn them first" : NULL;
}

noh_result noh_stage_set_kind(noh_stage *stage, uint32_t kind, const noh_kind_desc *desc, noh_error *error)
{
    noh_result result = NOH_OK;
    const char *what;
    NOH_ASSERT(stage);
    what = cannot_set(stage, kind, desc);
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, kind,
                        kind < stage->desc.kind_count ? stage->head->kinds[kind].count : stage->desc.kind_count);
    }
    if (desc) {
        result = fill(stage, kind, desc, error);
    } else {
        empty(stage, kind);
    }
    hash_slots(stage);
    return result;
}
