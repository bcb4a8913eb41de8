/* stage_modifier.c: the modifiers of a kind, and what all that change a pose are given. */
#include "core/base/arena_internal.h"
#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/modules.h"
#include "noh/noh.h"

#include <string.h>

#include "motion/anim/clock_internal.h"
#include "core/base/math_internal.h"
#include "stage/cast/stage_internal.h"

/* ---- a kind's modifiers as a module ---- */

static const char *bad(const noh_kind_desc *d, const void *desc)
{
    (void)desc;
    if (d->modifier_count > NOH_MODIFIERS_MAX) return "modifier_count of a kind is above NOH_MODIFIERS_MAX";
    if (!d->modifiers) return "modifiers of a kind is NULL, and modifier_count is not 0";
    for (uint32_t i = 0; i < d->modifier_count; i++) {
        if (!d->modifiers[i].modify) return "a modifier of a kind: modify is NULL";
        if (d->modifiers[i].state_bytes > NOH_MODIFIER_BYTES_MAX ||
            d->modifiers[i].scratch_bytes > NOH_MODIFIER_BYTES_MAX)
            return "a modifier of a kind: more bytes than NOH_MODIFIER_BYTES_MAX";
    }
    return NULL;
}

static noh_result measure(const noh_kind_desc *d, const void *desc, const noh_stage_needs *n, noh_module_needs *needs,
                          noh_error *error)
{
    (void)desc, (void)n, (void)error;
    needs->kind_bytes = d->modifier_count * sizeof *d->modifiers;
    for (uint32_t i = 0; i < d->modifier_count; i++) {
        const size_t scratch = d->modifiers[i].scratch_bytes;
        needs->actor_bytes += noh_aligned(d->modifiers[i].state_bytes);
        needs->scratch_bytes = scratch > needs->scratch_bytes ? scratch : needs->scratch_bytes;
    }
    return NOH_OK;
}

static noh_result init(noh_stage_kind *k, const void *desc, noh_error *error)
{
    (void)desc, (void)error;
    memcpy(k->modules[NOH_SLOT_MODIFIERS].shared, k->desc->modifiers,
           k->desc->modifier_count * sizeof *k->desc->modifiers);
    return NOH_OK;
}

static uint8_t *states_of(const noh_stage_kind *k, uint32_t index)
{
    return k->modules[NOH_SLOT_MODIFIERS].states + index * k->modules[NOH_SLOT_MODIFIERS].stride;
}

void *noh_actor_modifier(noh_stage *stage, noh_actor actor, uint32_t modifier)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    uint8_t *state;
    if (!a || modifier >= k->desc->modifier_count || stage->phase > NOH_STAGE_STEPPING) {
        return NULL;
    }
    state = states_of(k, noh_stage_index(k, a));
    for (uint32_t i = 0; i < modifier; i++) state += noh_aligned(noh_stage_modifiers_of(k)[i].state_bytes);
    return state;
}

/* What counts from an actor's home stays. */
static void shift(noh_stage_kind *k, const float by[3])
{
    for (uint32_t a = 0; a < k->desc->actor_count; a++) {
        uint8_t *state = states_of(k, a);
        for (uint32_t i = 0; i < k->desc->modifier_count; i++) {
            const noh_modifier *m = &noh_stage_modifiers_of(k)[i];
            if (k->actors[a].alive && m->shift) m->shift(m->user, state, by);
            state += noh_aligned(m->state_bytes);
        }
    }
}

static noh_result check(const noh_stage_kind *k, const void *states, noh_error *error)
{
    const uint8_t *state = states;
    for (uint32_t i = 0; i < k->desc->modifier_count; i++) {
        const noh_modifier *m = &noh_stage_modifiers_of(k)[i];
        const char *what = m->check ? m->check(m->user, state) : NULL;
        if (what) return noh_fail(error, NOH_ERR_DATA, what, i, 0);
        state += noh_aligned(m->state_bytes);
    }
    return NOH_OK;
}

static void modify(noh_modifier_work *w)
{
    const noh_stage_kind *k = w->kind;
    uint8_t *state = w->state;
    for (uint32_t i = 0; i < k->desc->modifier_count; i++) {
        const noh_modifier *m = &noh_stage_modifiers_of(k)[i];
        w->state = state;
        w->user = m->user;
        m->modify(w);
        state += noh_aligned(m->state_bytes);
    }
}

const noh_module_type noh_stage_modifiers_type = {
    .slot = NOH_SLOT_MODIFIERS,
    .kind_name = "modifiers",
    .bad = bad,
    .measure = measure,
    .init = init,
    .shift = shift,
    .check = check,
    .modify = modify,
};

/* ---- what a modifier may ask ---- */

const float *noh_modifier_model(noh_modifier_work *work)
{
    NOH_ASSERT(work);
    if (!work->skeleton->joint_count) {
        return NULL;
    }
    noh_local_to_model(work->skeleton, work->local, work->skeleton->joint_count, work->model);
    return work->model;
}

void noh_stage_joint_in(const noh_skeleton *skeleton, const noh_transform *local, uint32_t joint, float rotation[4],
                        float at[3])
{
    memcpy(rotation, local[joint].rotation, 4 * sizeof *rotation);
    memcpy(at, local[joint].translation, 3 * sizeof *at);
    for (uint32_t up = skeleton->parents[joint]; up != NOH_JOINT_ROOT; up = skeleton->parents[up]) {
        for (int i = 0; i < 3; i++) at[i] *= local[up].scale[i];
        noh_quat_rotate(local[up].rotation, at, at);
        for (int i = 0; i < 3; i++) at[i] += local[up].translation[i];
        noh_quat_mul(local[up].rotation, rotation, rotation);
    }
}

/* Where a float lies in the set; NOH_NONE: behind it. */
static uint32_t place_of(const noh_modifier_work *work, uint32_t index)
{
    const noh_stage_kind *k = work->kind;
    return index < k->float_count && k->named.sources[index] < k->set.float_count ? k->named.sources[index] : NOH_NONE;
}

float noh_modifier_float(const noh_modifier_work *work, uint32_t index)
{
    const uint32_t at = place_of(work, index);
    return at == NOH_NONE ? 0.0f : work->floats[at];
}

int noh_modifier_set_float(noh_modifier_work *work, uint32_t index, float value)
{
    const uint32_t at = place_of(work, index);
    if (at == NOH_NONE || value - value != 0.0f) {
        return 0;
    }
    work->floats[at] = value;
    return 1;
}

/* ---- in a job ---- */

static void set_time(noh_modifier_work *w, noh_stage_modifier_head *head, int64_t clock, int cut)
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
static void set_place(const noh_stage *s, noh_stage_actor *a, noh_modifier_work *w)
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

int noh_modifier_home_moved(const noh_modifier_work *w)
{
    return w->home_moved[0] != 0.0f || w->home_moved[1] != 0.0f || w->home_moved[2] != 0.0f;
}

void noh_stage_begin_modifiers(const noh_stage *s, const noh_stage_job_part *job, const noh_stage_kind *k,
                               uint32_t index, int64_t clock, noh_character_scratch *scratch, noh_modifier_work *w)
{
    const noh_character *ch = noh_stage_character(k, index);
    memset(w, 0, sizeof *w);
    w->actor = noh_stage_actor_at(s, k->first_actor + index);
    w->skeleton = &k->skeleton;
    w->local = scratch->local;
    w->joint_count = scratch->joint_count;
    w->level = ch->lod.mesh;
    w->pixels_per_metre = k->actors[index].look.posed || noh_stage_is_full(s, &k->actors[index])
                              ? NOH_MODIFIER_FULL_DETAIL
                              : ch->lod.pixels_per_metre;
    w->stage = s;
    w->kind = k;
    w->floats = scratch->floats;
    w->model = scratch->model;
    w->scratch = job->module_scratch;
    set_time(w, (noh_stage_modifier_head *)(void *)(k->modifier_states + index * k->modifier_bytes), clock,
             s->shown[k->first_actor + index].due == NOH_DUE_AT_ONCE);
    set_place(s, &k->actors[index], w);
}
