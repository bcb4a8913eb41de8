/* stage_ragdoll.c: actors that fall. */
#include "stage/stage_ragdoll.h"

#include <string.h>

#include "base/assert.h"
#include "base/math_internal.h"
#include "sim/ragdoll_internal.h"
#include "stage/stage_internal.h"

/* ---- made ---- */

const char *noh_stage_bad_ragdoll(const noh_kind_desc *d)
{
    const noh_kind_ragdoll *r = d->ragdoll;
    if (!r->count || r->count > NOH_RAGDOLLS_MAX) return "count of a kind's ragdoll is not in 1..NOH_RAGDOLLS_MAX";
    if (r->substeps && (r->substeps < 5u || r->substeps > NOH_RAGDOLL_SUBSTEPS_MAX))
        return "substeps of a kind's ragdoll is not in 5..NOH_RAGDOLL_SUBSTEPS_MAX";
    if (!(r->mass >= 0.0f) || !noh_is_finite(r->mass)) return "mass of a kind's ragdoll is below 0 or not finite";
    if (d->skeleton == NOH_NONE) return "a kind with ragdolls has no skeleton";
    return r->world && noh_world_check(r->world, NULL) ? "world of a kind's ragdoll: see noh_world_check" : NULL;
}

size_t noh_stage_doll_bytes(const noh_kind_desc *d)
{
    return d->ragdoll ? noh_ragdolls_state_size(d->ragdoll->count) : 0;
}

size_t noh_stage_doll_scratch_bytes(const noh_kind_desc *d)
{
    return d->ragdoll ? NOH_RAGDOLL_SCRATCH_FLOATS * sizeof(float) + 32u : 0;
}

noh_result noh_stage_open_ragdoll(noh_stage_kind *k, noh_error *error)
{
    noh_stage_ragdoll_kind *r = k->ragdoll;
    noh_ragdoll_source source = { .pack = k->desc->mesh, .skeleton = k->desc->skeleton };
    const noh_skeleton_header *header;
    noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdolls_desc desc;
    uint32_t count;
    noh_result result = noh_pack_skeleton_at(source.pack, source.skeleton, &source.joints, &header, error);
    if (result != NOH_OK) return result;
    source.metres = header->unit_cm / 100.0f;
    source.mass = k->desc->ragdoll->mass;
    result = noh_ragdoll_find_rows(&source, rows, &count, error);
    if (result == NOH_OK) result = noh_ragdoll_rig_make(&source, rows, count, &r->rig, error);
    if (result != NOH_OK) return result;
    noh_ragdoll_fit_make(&r->rig, &k->skeleton, source.metres, &r->fit);
    r->metres = source.metres;
    r->world = k->desc->ragdoll->world;
    desc.rig = &r->rig;
    desc.count = k->desc->ragdoll->count;
    desc.substeps = k->desc->ragdoll->substeps;
    (void)noh_ragdolls_begin(k->dolls, &desc);
    return NOH_OK;
}

/* ---- poses ---- */

static noh_ragdoll_frame frame_of(const noh_stage_kind *k, const noh_place *place)
{
    noh_ragdoll_frame f;
    for (int i = 0; i < 3; i++) f.position[i] = place->position[i] * k->ragdoll->metres;
    memcpy(f.rotation, place->rotation, sizeof f.rotation);
    f.metres = k->ragdoll->metres * place->scale;
    return f;
}

/* Where its bodies are now, and where they were in the pose before. */
static void remember(const noh_stage_kind *k, noh_stage_body *b, const noh_part_work *w)
{
    const noh_ragdoll_frame frame = frame_of(k, &w->place);
    if (w->cut) b->poses = 0;
    if (b->poses && w->clock > b->clocks[0]) {
        memcpy(b->bodies[1], b->bodies[0], sizeof b->bodies[1]);
        b->clocks[1] = b->clocks[0];
        b->poses = 2;
    }
    if (!b->poses) b->poses = 1;
    b->clocks[0] = w->clock;
    noh_ragdoll_from_pose(&k->ragdoll->fit, w->skeleton, w->local, &frame, b->bodies[0]);
}

void noh_stage_run_ragdoll(const noh_stage_kind *k, noh_stage_body *b, noh_part_work *w)
{
    const noh_ragdoll_frame frame = frame_of(k, &w->place);
    if (!b->doll) {
        remember(k, b, w);
    } else {
        noh_ragdoll_to_pose(&k->ragdoll->fit, w->skeleton, &frame, b->bodies[0], NULL, w->local);
    }
}

/* ---- time ---- */

/* The place goes where the first body goes. */
static void follow_doll(const noh_stage_kind *k, noh_stage_body *b, noh_stage_actor *a)
{
    noh_ragdoll_pose now[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_bodies(k->dolls, b->doll - 1u, now);
    for (int i = 0; i < 3; i++) {
        a->place.position[i] += (now[0].position[i] - b->bodies[0][0].position[i]) / k->ragdoll->metres;
    }
    memcpy(b->bodies[0], now, k->ragdoll->rig.body_count * sizeof now[0]);
}

void noh_stage_step_ragdolls(noh_stage_kind *k, uint32_t ticks)
{
    uint8_t *scratch = k->doll_scratch;
    scratch += (32u - (uintptr_t)scratch % 32u) % 32u;
    (void)noh_ragdolls_step_with(k->dolls, k->ragdoll->world, ticks, (float *)(void *)scratch);
    for (uint32_t i = 0; i < k->desc->actor_count; i++) {
        noh_stage_body *b = noh_stage_body_of(k, i);
        if (k->actors[i].alive && b->doll) follow_doll(k, b, &k->actors[i]);
    }
}

/* ---- calls ---- */

static noh_result open_body(noh_stage *stage, noh_actor actor, noh_stage_actor **a, noh_stage_kind **k,
                            noh_stage_body **b, noh_error *error)
{
    const noh_result result = noh_stage_change(stage, actor, a, k, error);
    if (result != NOH_OK) return result;
    if (!(*k)->ragdoll) {
        return noh_fail(error, NOH_ERR_ARG, "the actor's kind has no ragdolls: set noh_kind_desc.ragdoll",
                        (uint64_t)(*k - stage->kinds), 0);
    }
    *b = noh_stage_body_of(*k, noh_stage_index(*k, *a));
    return NOH_OK;
}

/* 1 + a doll that no actor has; 0: there is none. */
static uint32_t free_doll(const noh_stage_kind *k)
{
    for (uint32_t doll = 1; doll <= k->desc->ragdoll->count; doll++) {
        uint32_t i = 0;
        while (i < k->desc->actor_count && noh_stage_body_of(k, i)->doll != doll) i++;
        if (i == k->desc->actor_count) return doll;
    }
    return 0;
}

/* An actor that was not shown yet falls out of the bind pose, at rest. */
static noh_result place_doll(noh_stage_kind *k, const noh_stage_actor *a, noh_stage_body *b, uint32_t doll,
                             noh_error *error)
{
    const uint32_t count = k->ragdoll->rig.body_count;
    noh_ragdoll_motion motions[NOH_RAGDOLL_BODIES_MAX];
    if (!b->poses) {
        const noh_ragdoll_frame frame = frame_of(k, &a->place);
        noh_ragdoll_from_pose(&k->ragdoll->fit, &k->skeleton, k->skeleton.bind_pose, &frame, b->bodies[0]);
    }
    memset(motions, 0, sizeof motions);
    if (b->poses == 2u) {
        const float seconds = (float)(b->clocks[0] - b->clocks[1]) / (float)NOH_TICKS_PER_SECOND;
        noh_ragdoll_motions_of(b->bodies[1], b->bodies[0], count, seconds, motions);
    }
    return noh_ragdoll_place(k->dolls, doll - 1u, b->bodies[0], motions, error);
}

static noh_result fall(noh_stage_kind *k, const noh_stage_actor *a, noh_stage_body *b, noh_error *error)
{
    uint32_t doll;
    noh_result result;
    if (b->doll) return NOH_OK;
    if (a->parent || a->place.scale != 1.0f) {
        return noh_fail(error, NOH_ERR_ARG, "an actor falls that hangs on none and has a scale of 1", 0, 0);
    }
    doll = free_doll(k);
    if (!doll) {
        return noh_fail(error, NOH_ERR_LIMIT, "all ragdolls of the kind are in use: raise noh_kind_ragdoll.count",
                        k->desc->ragdoll->count, k->desc->ragdoll->count + 1u);
    }
    result = place_doll(k, a, b, doll, error);
    if (result != NOH_OK) return result;
    b->doll = doll;
    noh_character_wake(noh_stage_character(k, noh_stage_index(k, a)));
    return NOH_OK;
}

noh_result noh_actor_fall(noh_stage *stage, noh_actor actor, noh_error *error)
{
    noh_stage_actor *a;
    noh_stage_kind *k;
    noh_stage_body *b;
    const noh_result result = open_body(stage, actor, &a, &k, &b, error);
    return result == NOH_OK ? fall(k, a, b, error) : result;
}

noh_result noh_actor_hit(noh_stage *stage, noh_actor actor, const float point[3], const float impulse[3],
                         noh_error *error)
{
    noh_stage_actor *a;
    noh_stage_kind *k;
    noh_stage_body *b;
    noh_result result = open_body(stage, actor, &a, &k, &b, error);
    NOH_ASSERT(point && impulse);
    if (result != NOH_OK) return result;
    for (int i = 0; i < 3; i++) {
        if (!noh_is_finite(point[i]) || !noh_is_finite(impulse[i]))
            return noh_fail(error, NOH_ERR_ARG, "a hit's point or impulse is not finite", (uint64_t)i, 0);
    }
    result = fall(k, a, b, error);
    if (result == NOH_OK) noh_ragdoll_push(k->dolls, b->doll - 1u, point, impulse);
    return result;
}

int noh_actor_falls(const noh_stage *stage, noh_actor actor)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    const noh_stage_body *b = a && k->ragdoll ? noh_stage_body_of(k, noh_stage_index(k, a)) : NULL;
    if (!b || !b->doll) return 0;
    return noh_ragdoll_sleeps(k->dolls, b->doll - 1u) ? 2 : 1;
}

/* ---- state from outside ---- */

const char *noh_stage_check_body(const noh_stage_kind *k, const noh_stage_body *b)
{
    if (b->doll > k->desc->ragdoll->count || b->poses > 2u || (b->poses == 2u && b->clocks[0] <= b->clocks[1])) {
        return "state: bad ragdoll of an actor";
    }
    for (uint32_t i = 0; i < 2u * NOH_RAGDOLL_BODIES_MAX; i++) {
        const noh_ragdoll_pose *pose = &b->bodies[i / NOH_RAGDOLL_BODIES_MAX][i % NOH_RAGDOLL_BODIES_MAX];
        float sum = 0.0f;
        for (int n = 0; n < 3; n++) sum += pose->position[n] - pose->position[n];
        for (int n = 0; n < 4; n++) sum += pose->rotation[n] - pose->rotation[n];
        if (sum != 0.0f) return "state: an actor's ragdoll is not finite";
    }
    return NULL;
}
