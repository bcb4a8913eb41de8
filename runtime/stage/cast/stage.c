/* stage.c: a stage is made in its block, and deleted. */
#include <string.h>

#include "stage/cast/stage_internal.h"
#include "core/base/arena_internal.h"
#include "core/base/assert_internal.h"
#include "stage/character/lod_pools_internal.h"
#include "stage/character/scheduler_internal.h"
#include "noh/base.h"
#include "noh/low_core.h"
#include "noh/clip.h"
#include "noh/noh.h"

/* ---- actors, all free ---- */

void noh_stage_open_actors(noh_stage *s, uint32_t kind)
{
    noh_stage_kind *k = &s->kinds[kind];
    noh_stage_free *f = &s->head->kinds[kind];
    for (uint32_t i = 0; i < k->desc->actor_count; i++) {
        if (!k->actors[i].generation) k->actors[i].generation = 1;
        k->actors[i].next_free = i + 1u < k->desc->actor_count ? i + 2u : 0;
    }
    f->first = 1;
    f->last = k->desc->actor_count;
}

noh_result noh_stage_open_pools(noh_stage *s, uint32_t kind, void *memory, noh_error *error)
{
    noh_stage_kind *k = &s->kinds[kind];
    uint32_t levels[NOH_LOD_LEVELS_MAX], slots[NOH_LOD_LEVELS_MAX];
    noh_lod_pools_desc desc = { k->desc->actor_count, 0, levels, slots, k->desc->visible_max };
    desc.pool_count = noh_stage_pools(k->plan, levels, slots);
    return noh_lod_pools_init(memory, noh_lod_pools_size(&desc), &desc, &k->pools, error);
}

/* ---- jobs ---- */

static void open_jobs(noh_stage *s, const noh_stage_blocks *b)
{
    for (uint32_t j = 0; j < s->desc.job_count; j++) {
        memset(&s->jobs[j], 0, sizeof s->jobs[j]);
        s->jobs[j].scratch = b->scratch + j * b->scratch_bytes;
        s->jobs[j].matrices = b->matrices + j * b->matrices_floats;
        s->jobs[j].wearer = b->wearers + j * (size_t)b->wearer_joints;
        s->jobs[j].module_scratch = b->module_scratch_bytes ? b->module_scratch + j * b->module_scratch_bytes : NULL;
    }
}

noh_result noh_stage_open_views(noh_stage *s, uint32_t kind, uint8_t *at, size_t stride, noh_error *error)
{
    const noh_stage_kind *k = &s->kinds[kind];
    noh_result result = NOH_OK;
    for (uint32_t j = 0; j < s->desc.job_count && result == NOH_OK && k->bank && k->bank_kind == kind; j++) {
        result = noh_clip_bank_view_init(at + j * stride, noh_clip_bank_view_size(k->bank), k->bank,
                                         &s->jobs[j].views[kind], error);
    }
    return result;
}

/* The views of each kind's clips lie one after another. */
static noh_result open_all_views(noh_stage *s, const noh_stage_blocks *b, noh_error *error)
{
    uint8_t *at = b->views;
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < s->desc.kind_count && result == NOH_OK; i++) {
        const noh_stage_kind *k = &s->kinds[i];
        if (s->slots && s->slots->of[i].own) {
            s->slots->of[i].views = at;
            at += (size_t)s->plan->kinds[i].room.view_bytes;
        } else if (k->bank && k->bank_kind == i) {
            result = noh_stage_open_views(s, i, at, b->views_bytes, error);
            at += noh_aligned(noh_clip_bank_view_size(k->bank));
        }
    }
    return result;
}

/* ---- the block ---- */

static void adopt(const noh_stage_desc *desc, const noh_stage_plan *plan, const noh_stage_blocks *b)
{
    static const noh_stage_peers without_peers = { NULL, 0 };
    noh_stage *s = b->stage;
    memset(s, 0, sizeof *s);
    s->desc = noh_stage_desc_filled(desc);
    if (!NOH_PAGE && desc->share) s->desc.share = &without_peers; /* only plans read them */
    noh_stage_desc_by_plan(&s->desc, plan);
    s->slots = b->slots;
    if (s->slots) s->slots->plan = *plan;
    if (s->slots) s->slots->views_bytes = b->views_bytes;
    s->plan = s->slots ? &s->slots->plan : plan;
    s->kinds = b->kinds;
    s->kind_descs = b->kind_descs;
    memset(s->kind_descs, 0, desc->kind_count * sizeof *s->kind_descs);
    s->head = b->head;
    s->state = (uint8_t *)b->head;
    s->state_bytes = b->state_bytes;
    s->actors = b->actors;
    s->shown = b->shown;
    s->todo = b->todo;
    s->by_distance = b->by_distance;
    s->events = b->events;
    s->stats.wanted = b->wanted;
    s->jobs = b->jobs;
    s->scratch_bytes = b->scratch_bytes;
    s->module_scratch_bytes = b->module_scratch_bytes;
    s->wearer_joints = b->wearer_joints;
    s->pick_scratch = b->pick_scratch;
    s->pick_bytes = b->pick_bytes;
    s->inertia_scratch = b->inertia_scratch;
    s->inertia_bytes = b->inertia_bytes;
    for (uint32_t i = 0; i < desc->kind_count; i++) {
        s->kinds[i].desc = &s->kind_descs[i];
        s->kinds[i].first_actor = s->actor_count;
        s->kinds[i].actors = s->actors + s->actor_count;
        s->actor_count += desc->kinds[i].changes ? (uint32_t)plan->kinds[i].room.actor_count
                                                 : desc->kinds[i].actor_count;
    }
}

static noh_result open_kinds(noh_stage *s, const noh_stage_desc *desc, const noh_stage_blocks *b, noh_error *error)
{
    noh_result result = NOH_OK;
    memset(s->state, 0, s->state_bytes);
    memset(s->shown, 0, s->actor_count * sizeof *s->shown);
    s->head->magic = NOH_STAGE_MAGIC;
    s->head->hash = s->plan->hash;
    for (uint32_t i = 0; i < s->desc.kind_count && result == NOH_OK; i++) {
        if (desc->kinds[i].changes) continue;
        result = noh_stage_open_kind(s, desc, i, &b->of[i], error);
        if (result == NOH_OK) result = noh_stage_open_pools(s, i, b->of[i].pools, error);
        if (result == NOH_OK) noh_stage_open_actors(s, i);
    }
    return result;
}

static noh_result open_all(const noh_stage_desc *desc, const noh_stage_plan *plan, const noh_stage_blocks *b,
                           noh_error *error)
{
    noh_stage *s = b->stage;
    noh_result result;
    adopt(desc, plan, b);
    open_jobs(s, b);
    result = open_kinds(s, desc, b, error);
    s->desc.kinds = s->kind_descs;
    if (result == NOH_OK) result = open_all_views(s, b, error);
    if (result == NOH_OK) noh_stage_open_worn(s, NOH_NONE);
    if (result == NOH_OK && s->slots) result = noh_stage_open_slots(s, desc, error);
    if (!NOH_PAGE && result == NOH_OK) noh_stage_empty_clips(s, NOH_NONE);
    if (result == NOH_OK) {
        result = noh_schedule_init(b->schedule, noh_schedule_size(s->actor_count), s->actor_count, &s->schedule, error);
    }
    return result;
}

static noh_result of_another_desc(const noh_stage_plan *plan, noh_error *error)
{
    return noh_fail(error, NOH_ERR_ARG, "the plan of a stage was made for another desc: make one for this desc", 0,
                    plan->cpu_bytes);
}

/* The sizes of all that plays follow from what the plan says of the clips: it is read again, and believed where it is
 * the same. */
static noh_result check_clips(const noh_stage_desc *desc, const noh_stage_plan *plan, noh_error *error)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < desc->kind_count && result == NOH_OK; i++) {
        const uint32_t owner = noh_stage_bank_kind(desc, i);
        noh_kind_clips clips = plan->kinds[owner].clips;
        if (desc->kinds[i].changes) continue; /* measured when it comes */
        if (owner == i) result = noh_stage_measure_clips(desc, plan, i, &clips, error);
        if (result == NOH_OK && memcmp(&clips, &plan->kinds[i].clips, sizeof clips) != 0) {
            result = of_another_desc(plan, error);
        }
    }
    return result;
}

noh_result noh_stage_init(void *memory, size_t bytes, const void *device, const noh_stage_desc *desc,
                          const noh_stage_plan *plan, noh_stage **stage, noh_error *error)
{
    noh_stage_blocks b;
    noh_arena arena;
    noh_result result;
    NOH_ASSERT(desc && plan && stage);
    result = noh_stage_check_desc(desc, error);
    if (result != NOH_OK) {
        return result;
    }
    if ((desc->gpu != NULL) != (device != NULL)) {
        return noh_fail(error, NOH_ERR_ARG, "a stage that draws needs a device, and one that does not takes none", 0,
                        0);
    }
    result = noh_arena_open(&arena, memory, bytes, (size_t)plan->cpu_bytes, error);
    if (result != NOH_OK) {
        return result;
    }
    memset(&b, 0, sizeof b);
    result = check_clips(desc, plan, error);
    if (result == NOH_OK) result = noh_stage_carve(&arena, desc, plan, &b, NULL, error);
    if (result != NOH_OK || !b.stage || !b.kinds || arena.used > plan->cpu_bytes) {
        return result != NOH_OK ? result : of_another_desc(plan, error);
    }
    result = open_all(desc, plan, &b, error);
    if (result == NOH_OK && desc->gpu) {
        const size_t from = (arena.used + 15u) & ~(size_t)15u;
        result = desc->gpu->init((uint8_t *)memory + from, (size_t)plan->cpu_bytes - from, device, desc, b.stage,
                                 error);
    }
    for (uint32_t i = 0; i < desc->kind_count; i++) {
        if (b.kind_descs[i].finer) b.kind_descs[i].cover_count = 0; /* it has no covers */
        b.kind_descs[i].finer = NULL;                               /* not kept */
    }
    if (result == NOH_OK) {
        *stage = b.stage;
    }
    return result;
}

void noh_stage_delete(noh_stage *stage)
{
    NOH_ASSERT(stage);
    if (stage->gpu) {
        stage->desc.gpu->destroy(stage);
    }
}

noh_result noh_stage_restore(noh_stage *stage, noh_error *error)
{
    NOH_ASSERT(stage);
    return stage->gpu ? stage->desc.gpu->restore(stage, error) : NOH_OK;
}

const noh_stage_stats *noh_stage_stats_of(const noh_stage *stage)
{
    NOH_ASSERT(stage);
    return &stage->stats;
}
