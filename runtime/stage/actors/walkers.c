/* walkers.c: measures the clips of walkers, and ties actors to agents. */
#include "core/base/assert_internal.h"
#include "motion/anim/root_motion_internal.h"
#include "motion/anim/tracks_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/crowd.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/noh.h"

#include <string.h>

#include "motion/anim/sync_internal.h"
#include "core/base/math_internal.h"
#include "motion/anim/clip_set_internal.h"
#include "stage/actors/walkers_internal.h"
#include "stage/character/character_internal.h"

#define TURN_SPEED 4.0f

/* ---- size and init ---- */

static noh_result check(const noh_walkers_desc *d, noh_error *error)
{
    if (!d->walker_max || d->walker_max > NOH_CROWD_AGENTS_MAX || d->near_max > d->walker_max) {
        return noh_fail(error, NOH_ERR_LIMIT, "walker_max is 0 or above NOH_CROWD_AGENTS_MAX", 0, d->walker_max);
    }
    if (!(d->walk_speed >= 0.0f && d->walk_speed <= 1e6f) || !(d->run_speed >= 0.0f && d->run_speed <= 1e6f) ||
        !(d->turn_speed >= 0.0f && d->turn_speed <= 1e3f) || (d->near_max && !d->feet_modifier)) {
        return noh_fail(error, NOH_ERR_ARG,
                        "a speed of walkers is out of its range, or near_max is without feet_modifier", 0, 0);
    }
    return NOH_OK;
}

static size_t bytes_of(const noh_walkers_desc *d)
{
    return (sizeof(noh_walkers) + d->walker_max * sizeof(walker) + d->near_max * sizeof(walker_near) + 15u) &
           ~(size_t)15u;
}

size_t noh_walkers_size(const noh_walkers_desc *desc)
{
    NOH_ASSERT(desc);
    return check(desc, NULL) ? 0 : bytes_of(desc);
}

static const noh_stage_kind *kind_of(const noh_stage *stage, const noh_walkers_desc *d, uint32_t clip_count)
{
    const noh_stage_kind *k = d->kind < stage->desc.kind_count ? &stage->kinds[d->kind] : NULL;
    const noh_stage_layer *l = k && d->layer < k->layer_count ? &k->layers[d->layer] : NULL;
    const int has_part = !d->feet_modifier || (k && d->feet_modifier <= k->desc->modifier_count);
    return l && l->mode == NOH_LAYER_BASE && l->track_count >= clip_count && has_part ? k : NULL;
}

/* The displacement of the root of a clip from its start. */
static void root_at(const noh_stage_kind *k, uint32_t clip, int64_t position, float at[2])
{
    const noh_root_pose pose = noh_root_between(&k->set, &k->set.roots[clip], clip, NOH_LOOP_REPEAT, 0, position);
    at[0] = (float)pose.translation[0];
    at[1] = (float)pose.translation[2];
}

static void measure_sway(const noh_stage_kind *k, walker_clip *c, const float end[2])
{
    for (uint32_t i = 0; i <= WALKER_SWAY; i++) {
        const float part = (float)i / (float)WALKER_SWAY;
        root_at(k, c->clip, noh_position_of(c->ticks) * (int64_t)i / (int64_t)WALKER_SWAY, c->sway[i]);
        c->sway[i][0] -= part * end[0];
        c->sway[i][1] -= part * end[1];
    }
}

/* The stride of a clip; forward[2]: its direction. */
static noh_result measure(const noh_stage_kind *k, uint32_t which, const char *name, float speed, walker_clip *c,
                          float forward[2], noh_error *error)
{
    float end[2] = { 0.0f, 0.0f };
    c->clip = noh_clip_set_find(&k->set, noh_hash_name(name));
    if (!k->bank || c->clip == NOH_NONE || c->clip >= noh_stage_clip_count(k)) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "the kind has no clip with the name in noh_walkers_desc", which, 0);
    }
    c->ticks = k->set.clips[c->clip].duration_ticks;
    if (k->set.roots && c->ticks) {
        root_at(k, c->clip, noh_position_of(c->ticks), end);
        measure_sway(k, c, end);
    }
    const float way = noh_sqrt(end[0] * end[0] + end[1] * end[1]);
    c->stride = speed > 0.0f ? speed * (float)c->ticks * (1.0f / (float)NOH_TICKS_PER_SECOND) : way;
    if (which == WALKER_IDLE) return NOH_OK;
    if (!(c->stride > 1e-6f)) {
        return noh_fail(error, NOH_ERR_ARG, "the root of a walker's clip does not move: set walk_speed or run_speed",
                        which, 0);
    }
    if (which == WALKER_WALK && way > 0.01f * c->stride) {
        forward[0] = end[0] / way;
        forward[1] = end[1] / way;
    }
    return NOH_OK;
}

/* Two clips can be blended only if sync markers show that they are in step. */
static uint16_t are_in_step(const noh_walkers *w, const noh_stage_kind *k)
{
    if (w->clips[WALKER_RUN].clip == NOH_NONE) return 0;
    const noh_clip_entry *walk = &k->set.clips[w->clips[WALKER_WALK].clip],
                         *run = &k->set.clips[w->clips[WALKER_RUN].clip];
    return walk->marker_count && noh_sync_fits(&k->set, walk, run) ? 1u : 0u;
}

static noh_result measure_all(noh_walkers *w, const noh_walkers_desc *d, noh_stage *s, const noh_stage_kind *k,
                              noh_error *error)
{
    const char *const names[WALKER_CLIPS] = { d->walk, d->idle, d->run };
    const float speeds[WALKER_CLIPS] = { d->walk_speed, 0.0f, d->run_speed };
    w->forward[1] = 1.0f;
    if (!NOH_PAGE) {
        uint32_t clips[WALKER_CLIPS];
        for (uint32_t i = 0; i < WALKER_CLIPS; i++) {
            clips[i] = names[i] ? noh_clip_set_find(&k->set, noh_hash_name(names[i])) : NOH_NONE;
        }
        const noh_result there = noh_stage_check_there(s, k, clips, WALKER_CLIPS, error);
        if (there) return there;
    }
    for (uint32_t i = 0; i < WALKER_CLIPS; i++) {
        w->clips[i].clip = NOH_NONE;
        if (!names[i]) continue;
        const noh_result result = measure(k, i, names[i], speeds[i], &w->clips[i], w->forward, error);
        if (result) return result;
    }
    w->in_step = are_in_step(w, k);
    return NOH_OK;
}

noh_result noh_walkers_init(void *memory, size_t bytes, const noh_walkers_desc *desc, noh_stage *stage,
                            noh_walkers **walkers, noh_error *error)
{
    noh_arena arena;
    noh_walkers *w = memory;
    NOH_ASSERT(desc && stage && walkers && desc->walk);
    noh_result result = check(desc, error);
    if (result) return result;
    const noh_stage_kind *k = kind_of(stage, desc, 1u + (desc->idle != NULL) + (desc->run != NULL));
    if (!k || (k->set.roots && !(k->desc->root_axes & NOH_ROOT_BY_GAME))) {
        return noh_fail(
            error, NOH_ERR_ARG,
            "walkers need NOH_ROOT_BY_GAME, a base layer with a track for each clip, and feet_modifier of their kind",
            desc->kind, 0);
    }
    result = noh_arena_open(&arena, memory, bytes, bytes_of(desc), error);
    if (result) return result;
    memset(memory, 0, bytes_of(desc));
    result = measure_all(w, desc, stage, k, error);
    if (result) return result;
    w->bytes = (uint32_t)bytes_of(desc);
    w->walker_max = desc->walker_max;
    w->near_max = desc->near_max;
    w->kind = desc->kind;
    w->layer = desc->layer;
    w->feet_modifier = desc->feet_modifier;
    w->turn_speed = desc->turn_speed > 0.0f ? desc->turn_speed : TURN_SPEED;
    const noh_feet_rig *rig = desc->feet_modifier
                                  ? noh_walkers_rig(&noh_stage_modifiers_of(k)[desc->feet_modifier - 1u])
                                  : NULL;
    if (rig && stage->phase == NOH_STAGE_IDLE) noh_walkers_measure_soles(w, stage, k, rig);
    *walkers = w;
    return NOH_OK;
}

/* ---- actors and agents ---- */

/* share: the phase, 0..1, at which clips begin. */
static noh_result start(const noh_walkers *w, const noh_stage_kind *k, noh_controller *c, uint32_t share,
                        noh_error *error)
{
    noh_result result = NOH_OK;
    uint32_t track = k->layers[w->layer].first_track;
    const int stands = w->clips[WALKER_IDLE].clip != NOH_NONE;
    for (uint32_t i = 0; i < WALKER_CLIPS && !result; i++) {
        noh_track_desc d;
        if (w->clips[i].clip == NOH_NONE) continue;
        memset(&d, 0, sizeof d);
        d.clip = w->clips[i].clip;
        d.loop = NOH_LOOP_REPEAT;
        d.position_ticks = (int64_t)((uint64_t)w->clips[i].ticks * share >> 32);
        d.mask = k->layers[w->layer].mask;
        d.sync_group = w->in_step && i != WALKER_IDLE ? 1u : 0u;
        d.flags = i == (stands ? (uint32_t)WALKER_IDLE : (uint32_t)WALKER_WALK) ? 0u : NOH_TRACK_SILENT;
        result = noh_controller_start(c, &k->set, track++, &d, error);
    }
    return result;
}

noh_result noh_walkers_add(noh_walkers *walkers, uint32_t index, noh_stage *stage, noh_actor actor, uint32_t agent,
                           const float heading[2], noh_error *error)
{
    noh_stage_kind *k;
    noh_stage_actor *a;
    NOH_ASSERT(walkers && stage);
    noh_result result = noh_stage_change(stage, actor, &a, &k, error);
    if (result) return result;
    if (index >= walkers->walker_max || k != &stage->kinds[walkers->kind]) {
        return noh_fail(error, NOH_ERR_ARG, "index is not below walker_max, or the actor is of another kind", index, 0);
    }
    if (!NOH_PAGE) { /* all of them: one that is started alone would change the actor */
        uint32_t clips[WALKER_CLIPS];
        for (uint32_t i = 0; i < WALKER_CLIPS; i++) clips[i] = walkers->clips[i].clip;
        result = noh_stage_check_there(stage, k, clips, WALKER_CLIPS, error);
        if (result) return result;
    }
    result = start(walkers, k, noh_character_controller(noh_stage_character(k, noh_stage_index(k, a))),
                   index * 2654435769u, error);
    if (result) return result;
    noh_walkers_remove(walkers, index);
    walker *r = noh_walker_at(walkers, index);
    memset(r, 0, sizeof *r);
    r->actor = actor.id;
    r->agent = agent;
    r->height = a->place.position[1];
    r->heading[0] = heading ? heading[0] : 0.0f;
    r->heading[1] = heading ? heading[1] : 1.0f;
    return NOH_OK;
}

void noh_walkers_remove(noh_walkers *walkers, uint32_t index)
{
    NOH_ASSERT(walkers && index < walkers->walker_max);
    noh_walker_at(walkers, index)->actor = 0;
}

void noh_walkers_face(noh_walkers *walkers, uint32_t index, const float direction[2])
{
    NOH_ASSERT(walkers && index < walkers->walker_max);
    walker *r = noh_walker_at(walkers, index);
    const float x = direction ? direction[0] : 0.0f, z = direction ? direction[1] : 0.0f, square = x * x + z * z;
    const float per = square > 1e-20f && noh_is_finite(square) ? 1.0f / noh_sqrt(square) : 0.0f;
    r->face[0] = per > 0.0f ? x * per : 0.0f;
    r->face[1] = per > 0.0f ? z * per : 0.0f;
}

int noh_walkers_heading(const noh_walkers *walkers, uint32_t index, float heading[2])
{
    NOH_ASSERT(walkers && index < walkers->walker_max);
    const walker *r = (const walker *)(const void *)((const char *)walkers + sizeof *walkers) + index;
    if (!r->actor) return 0;
    memcpy(heading, r->heading, sizeof r->heading);
    return 1;
}

void noh_walkers_shift_origin(noh_walkers *walkers, const float by[3])
{
    NOH_ASSERT(walkers && by);
    for (uint32_t i = 0; i < walkers->walker_max; i++) {
        noh_walker_at(walkers, i)->height -= by[1]; /* x and z count from the crowd's home, which moves */
    }
}
