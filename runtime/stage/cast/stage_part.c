/* stage_part.c: parts: functions that change a pose before it is shown. */
#include "core/base/assert.h"
#include "stage/cast/part.h"
#include "stage/cast/springs.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_stage.h"
#include "noh/modules.h"
#include "noh/noh.h"

#include <string.h>

#include "motion/anim/clock_internal.h"
#include "core/base/math_internal.h"
#include "stage/cast/stage_internal.h"

static size_t aligned(size_t bytes)
{
    return (bytes + 15u) & ~(size_t)15u;
}

/* ---- springs of the pack ---- */

size_t noh_stage_springs_bytes(const noh_kind_desc *kind, size_t *state_bytes, size_t *scratch_bytes)
{
    noh_springs_desc desc;
    *state_bytes = *scratch_bytes = 0;
    if (kind->without_springs || !noh_springs_of_pack(kind->mesh, kind->skeleton, &desc)) {
        return 0;
    }
    noh_springs_measure(&desc, state_bytes, scratch_bytes);
    return noh_springs_size(&desc);
}

noh_result noh_stage_open_springs(noh_stage_kind *k, void *memory, size_t bytes, noh_error *error)
{
    noh_springs_desc desc;
    noh_springs *springs;
    if (!bytes || !noh_springs_of_pack(k->desc->mesh, k->desc->skeleton, &desc)) {
        return NOH_OK;
    }
    const noh_result result = noh_springs_init(memory, bytes, &desc, &springs, error);
    if (result == NOH_OK) k->springs = noh_springs_part(springs);
    return result;
}

/* ---- where states lie ---- */

size_t noh_stage_part_bytes(const noh_kind_desc *d)
{
    size_t springs, scratch;
    size_t bytes = noh_stage_has_parts(d) ? sizeof(noh_stage_part_head) : 0;
    if (d->face) bytes += sizeof(noh_stage_face);
    if (d->ragdoll) bytes += sizeof(noh_stage_body);
    for (uint32_t i = 0; i < d->part_count; i++) bytes += aligned(d->parts[i].state_bytes);
    (void)noh_stage_springs_bytes(d, &springs, &scratch);
    return bytes + springs;
}

/* The states of an actor: a head, its face, its ragdoll, then each part's, then that of its springs. */
static uint8_t *states_of(const noh_stage_kind *k, uint32_t index)
{
    return k->part_states + (size_t)index * k->part_bytes;
}

static size_t body_offset(const noh_stage_kind *k)
{
    return sizeof(noh_stage_part_head) + (k->face ? sizeof(noh_stage_face) : 0);
}

static size_t state_offset(const noh_stage_kind *k, uint32_t part)
{
    size_t at = body_offset(k) + (k->ragdoll ? sizeof(noh_stage_body) : 0);
    for (uint32_t i = 0; i < part; i++) at += aligned(k->parts[i].state_bytes);
    return at;
}

void *noh_actor_part(noh_stage *stage, noh_actor actor, uint32_t part)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    if (!a || part >= k->desc->part_count || stage->phase > NOH_STAGE_STEPPING) {
        return NULL;
    }
    return states_of(k, noh_stage_index(k, a)) + state_offset(k, part);
}

noh_result noh_stage_check_parts(const noh_stage_kind *k, const void *states, noh_error *error)
{
    const noh_stage_part_head *head = states;
    if (noh_stage_has_parts(k->desc) && head->was_posed > 1u) {
        return noh_fail(error, NOH_ERR_DATA, "state: bad head of an actor's parts", 0, 0);
    }
    if (k->face && noh_stage_check_face((const noh_stage_face *)(const void *)(head + 1))) {
        return noh_fail(error, NOH_ERR_DATA, noh_stage_check_face((const noh_stage_face *)(const void *)(head + 1)), 0,
                        0);
    }
    if (k->ragdoll) {
        const void *body = (const uint8_t *)states + body_offset(k);
        const char *what = noh_stage_check_body(k, body);
        if (what) return noh_fail(error, NOH_ERR_DATA, what, 0, 0);
    }
    for (uint32_t i = 0; i < k->desc->part_count; i++) {
        const noh_stage_part *part = &k->parts[i];
        const char *what = part->check ? part->check(part->user, (const uint8_t *)states + state_offset(k, i)) : NULL;
        if (what) return noh_fail(error, NOH_ERR_DATA, what, i, 0);
    }
    if (k->springs.modify) {
        const uint8_t *at = (const uint8_t *)states + state_offset(k, k->desc->part_count);
        const char *what = k->springs.check(k->springs.user, at);
        if (what) return noh_fail(error, NOH_ERR_DATA, what, 0, 0);
    }
    return NOH_OK;
}

noh_stage_face *noh_stage_face_of(const noh_stage_kind *k, uint32_t index)
{
    return (noh_stage_face *)(void *)(states_of(k, index) + sizeof(noh_stage_part_head));
}

noh_stage_body *noh_stage_body_of(const noh_stage_kind *k, uint32_t index)
{
    return (noh_stage_body *)(void *)(states_of(k, index) + body_offset(k));
}

/* The origin of the world moves by `by`. What counts from the actor's home stays. */
void noh_stage_shift_parts(noh_stage_kind *k, uint32_t index, const float by[3])
{
    uint8_t *states = states_of(k, index) + state_offset(k, 0);
    for (uint32_t i = 0; i < k->desc->part_count; i++) {
        noh_stage_shift_points(&k->parts[i], states, by);
        states += aligned(k->parts[i].state_bytes);
    }
    if (k->face) {
        float *point = noh_stage_face_of(k, index)->point;
        for (int i = 0; i < 3; i++) point[i] -= by[i];
    }
}

/* ---- what a part may ask ---- */

const float *noh_part_model(noh_part_work *work)
{
    NOH_ASSERT(work);
    if (!work->skeleton->joint_count) {
        return NULL;
    }
    noh_local_to_model(work->skeleton, work->local, work->skeleton->joint_count, work->model);
    return work->model;
}

/* Where a float lies in the set; NOH_NONE: behind it. */
static uint32_t place_of(const noh_part_work *work, uint32_t index)
{
    const noh_stage_kind *k = work->kind;
    return index < k->float_count && k->sources[index] < k->set.float_count ? k->sources[index] : NOH_NONE;
}

float noh_part_float(const noh_part_work *work, uint32_t index)
{
    const uint32_t at = place_of(work, index);
    return at == NOH_NONE ? 0.0f : work->floats[at];
}

int noh_part_set_float(noh_part_work *work, uint32_t index, float value)
{
    const uint32_t at = place_of(work, index);
    if (at == NOH_NONE || value - value != 0.0f) {
        return 0;
    }
    work->floats[at] = value;
    return 1;
}

/* ---- in a job ---- */

static void set_time(noh_part_work *w, noh_stage_part_head *head, int64_t clock, int cut)
{
    w->clock = clock;
    w->cut = cut || !head->was_posed;
    w->ticks = 0;
    if (!w->cut && clock > head->posed_clock) {
        const int64_t ticks = noh_clock_since(clock, head->posed_clock);
        w->ticks = ticks > UINT32_MAX ? UINT32_MAX : (uint32_t)ticks;
    }
    if (w->cut || w->ticks) head->posed_clock = clock; /* a state that is ahead stays there until the clock comes */
    head->was_posed = 1;
}

/* The place of the one at the end of its attachments. The home stays while the actor is near it. */
static void set_place(const noh_stage *s, noh_stage_actor *a, noh_part_work *w)
{
    const noh_stage_actor *on = noh_stage_root_of(s, a);
    w->place = on->place;
    for (int i = 0; i < 3; i++) {
        const double at = (double)on->place.position[i] + (double)on->rest[i], from = at - a->home[i];
        if (w->cut || from > (double)NOH_NEAR_ORIGIN || from < -(double)NOH_NEAR_ORIGIN) {
            const double home = (double)noh_on_grid(on->place.position[i]);
            w->home_moved[i] = (float)(home - a->home[i]);
            a->home[i] = home;
        }
        w->home[i] = a->home[i];
        w->near_place[i] = (float)(at - a->home[i]);
    }
}

int noh_part_home_moved(const noh_part_work *w)
{
    return w->home_moved[0] != 0.0f || w->home_moved[1] != 0.0f || w->home_moved[2] != 0.0f;
}

void noh_stage_begin_parts(const noh_stage *s, const noh_stage_job_part *job, const noh_stage_kind *k, uint32_t index,
                           int64_t clock, noh_character_scratch *scratch, noh_part_work *w)
{
    const noh_character *ch = noh_stage_character(k, index);
    memset(w, 0, sizeof *w);
    w->actor = noh_stage_actor_at(s, k->first_actor + index);
    w->skeleton = &k->skeleton;
    w->local = scratch->local;
    w->joint_count = scratch->joint_count;
    w->level = ch->lod.mesh;
    w->pixels_per_metre = k->actors[index].look.posed || noh_stage_is_full(s, &k->actors[index])
                              ? NOH_PART_FULL_DETAIL
                              : ch->lod.pixels_per_metre;
    w->kind = k;
    w->floats = scratch->floats;
    w->model = scratch->model;
    w->scratch = job->part_scratch;
    set_time(w, (noh_stage_part_head *)(void *)states_of(k, index), clock,
             s->shown[k->first_actor + index].due == NOH_DUE_AT_ONCE);
    set_place(s, &k->actors[index], w);
}

void noh_stage_run_parts(const noh_stage_kind *k, uint32_t index, noh_part_work *w)
{
    uint8_t *states = states_of(k, index) + state_offset(k, 0);
    for (uint32_t i = 0; i < k->desc->part_count; i++) {
        w->state = states;
        w->user = k->parts[i].user;
        k->parts[i].modify(w);
        states += aligned(k->parts[i].state_bytes);
    }
}

void noh_stage_run_springs(const noh_stage_kind *k, uint32_t index, noh_part_work *w)
{
    w->state = states_of(k, index) + state_offset(k, k->desc->part_count);
    w->user = k->springs.user;
    k->springs.modify(w);
}
