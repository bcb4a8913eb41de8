/* stage_ragdoll.c: actors that fall. */
#include "motion/pose/skeleton_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/modules.h"
#include "noh/noh.h"

#include <string.h>

#include "motion/anim/clock_internal.h"
#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"
#include "life/physics/ragdoll_internal.h"
#include "core/base/vector_internal.h"
#include "life/physics/world_ask_internal.h"
#include "stage/modules/stage_ragdoll_internal.h"

#define APART 0.005f /* of a doll's size: its joints have another scale if they are farther apart than this */

/* ---- made ---- */

static const char *bad(const noh_kind_desc *d, const void *desc)
{
    const noh_kind_ragdoll *r = desc;
    if (!r->count || r->count > NOH_RAGDOLLS_MAX) return "count of a kind's ragdoll is not in 1..NOH_RAGDOLLS_MAX";
    if (r->substeps && (r->substeps < 5u || r->substeps > NOH_RAGDOLL_SUBSTEPS_MAX))
        return "substeps of a kind's ragdoll is not in 5..NOH_RAGDOLL_SUBSTEPS_MAX";
    if (!(r->mass >= 0.0f) || !noh_is_finite(r->mass)) return "mass of a kind's ragdoll is below 0 or not finite";
    if (!noh_is_finite(r->stagger_speed)) return "stagger_speed of a kind's ragdoll is not finite";
    if (d->skeleton == NOH_NONE) return "ragdoll of a kind: it has no skeleton: use the pack of a skinned model";
    return r->world && noh_world_check(r->world, NULL) ? "world of a kind's ragdoll: see noh_world_check" : NULL;
}

static uint32_t hash(const noh_kind_desc *d, const void *desc)
{
    (void)d;
    return ((const noh_kind_ragdoll *)desc)->count;
}

static uint32_t asks(const noh_kind_ragdoll *desc)
{
    return desc->world && noh_world_asks(desc->world) ? 1u : 0u;
}

static void *carve(noh_arena *arena, const noh_kind_ragdoll *desc)
{
    (void)noh_arena_carve(arena, sizeof(noh_stage_ragdoll_kind), 16);
    return noh_arena_carve(arena, NOH_RAGDOLL_SCRATCH_FLOATS(asks(desc)) * sizeof(float) + 32u, 16);
}

static noh_result measure(const noh_kind_desc *d, const void *desc, const noh_stage_needs *n, noh_module_needs *needs,
                          noh_error *error)
{
    noh_arena arena = noh_arena_measure();
    (void)d, (void)n, (void)error;
    (void)carve(&arena, desc);
    needs->kind_bytes = arena.used;
    needs->actor_bytes = sizeof(noh_stage_body);
    needs->pool_bytes = noh_ragdolls_state_size(((const noh_kind_ragdoll *)desc)->count);
    return NOH_OK;
}

noh_result noh_kind_can_fall(const noh_kind_desc *kind, noh_ragdoll_rig *rig, noh_error *error)
{
    noh_ragdoll_source source = { .pack = kind->mesh, .skeleton = kind->skeleton };
    const noh_kind_ragdoll *desc = kind->ragdoll.desc;
    const noh_skeleton_header *header;
    noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
    uint32_t count;
    noh_result result;
    if (source.skeleton == NOH_NONE || !source.pack->runs[NOH_CHUNK_SKELETON].count) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "the kind has no skeleton: use the pack of a skinned model", 0, 0);
    }
    result = noh_pack_skeleton_at(source.pack, source.skeleton, &source.joints, &header, error);
    if (result != NOH_OK) return result;
    source.metres = header->unit_cm / 100.0f;
    source.mass = desc ? desc->mass : 0.0f;
    result = noh_ragdoll_find_rows(&source, rows, &count, error);
    return result == NOH_OK ? noh_ragdoll_rig_make(&source, rows, count, rig, error) : result;
}

static noh_result init(noh_stage_kind *k, const void *desc, noh_error *error)
{
    const noh_kind_ragdoll *from = desc;
    noh_stage_ragdoll_kind *r = k->modules[NOH_SLOT_BODY].shared;
    noh_arena arena = noh_arena_over(r, SIZE_MAX);
    const noh_skeleton_header *header;
    noh_skeleton joints;
    noh_ragdolls_desc dolls;
    uint8_t *scratch;
    noh_result result;
    memset(r, 0, sizeof *r);
    result = noh_kind_can_fall(k->desc, &r->rig, error);
    if (result != NOH_OK) return result;
    (void)noh_pack_skeleton_at(k->desc->mesh, k->desc->skeleton, &joints, &header, NULL);
    r->metres = header->unit_cm / 100.0f;
    noh_ragdoll_fit_make(&r->rig, &k->skeleton, r->metres, &r->fit);
    for (uint32_t i = 0; i < r->rig.body_count; i++) r->mass += r->rig.bodies[i].mass;
    r->stagger_speed = from->stagger_speed;
    noh_stage_find_parts(r, &(noh_ragdoll_source){ k->desc->mesh, k->desc->skeleton, joints, r->metres, 0.0f });
    r->world = from->world;
    r->count = from->count;
    r->dolls = k->modules[NOH_SLOT_BODY].pool;
    scratch = carve(&arena, from);
    r->scratch = (float *)(void *)(scratch + (32u - (uintptr_t)scratch % 32u) % 32u);
    dolls.rig = &r->rig;
    dolls.count = from->count;
    dolls.substeps = from->substeps;
    dolls.asks = r->asks = asks(from);
    (void)noh_ragdolls_begin(r->dolls, &dolls);
    return NOH_OK;
}

/* ---- dolls ---- */

void noh_stage_give_doll(const noh_stage_kind *k, noh_stage_body *b)
{
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
    if (b->doll) noh_ragdoll_rest(shared->dolls, b->doll - 1u, &shared->rig);
    b->doll = 0;
}

static void despawn(noh_stage_kind *k, uint32_t index)
{
    noh_stage_give_doll(k, noh_stage_body_of(k, index));
}

/* How many actors have a doll, given as 1 + its index: more than one only in states from outside.
 * states  of the actors' bodies, `stride` bytes apart */
static uint32_t owners(const noh_stage_kind *k, const uint8_t *states, uint32_t doll)
{
    const size_t stride = k->modules[NOH_SLOT_BODY].stride;
    uint32_t count = 0;
    for (uint32_t i = 0; i < k->desc->actor_count; i++)
        count += ((const noh_stage_body *)(const void *)(states + i * stride))->doll == doll;
    return count;
}

/* 1 + the first doll from `from` on that no actor has; 0: there is none. */
static uint32_t free_doll(const noh_stage_kind *k, uint32_t from)
{
    for (uint32_t doll = from + 1u; doll <= noh_stage_ragdoll_kind_of(k)->count; doll++) {
        if (!owners(k, k->modules[NOH_SLOT_BODY].states, doll)) return doll;
    }
    return 0;
}

/* ---- poses ---- */

noh_ragdoll_frame noh_stage_ragdoll_frame(const noh_stage_kind *k, const noh_place *place, const float origin[3])
{
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
    noh_ragdoll_frame f;
    for (int i = 0; i < 3; i++) {
        f.position[i] = (float)((double)place->position[i] * (double)shared->metres - (double)origin[i]);
    }
    memcpy(f.rotation, place->rotation, sizeof f.rotation);
    f.metres = shared->metres * place->scale;
    return f;
}

void noh_stage_ragdoll_weights(const noh_stage_kind *k, const noh_stage_body *b, float *weights)
{
    for (uint32_t i = 0; i < noh_stage_ragdoll_kind_of(k)->rig.body_count; i++) {
        weights[i] = b->held >> i & 1u ? 0.0f : 1.0f - b->animated[i];
    }
}

/* What is remembered counts from near to a place. */
static void move_origin(const noh_stage_kind *k, noh_stage_body *b, const noh_place *place)
{
    float at[3], origin[3];
    for (int i = 0; i < 3; i++) at[i] = place->position[i] * noh_stage_ragdoll_kind_of(k)->metres;
    noh_ragdoll_origin_near(at, origin);
    for (int i = 0; i < 3; i++) {
        const float by = origin[i] - b->origin[i];
        for (uint32_t n = 0; n < 2u * NOH_RAGDOLL_BODIES_MAX; n++) {
            b->bodies[n / NOH_RAGDOLL_BODIES_MAX][n % NOH_RAGDOLL_BODIES_MAX].position[i] -= by;
        }
        b->origin[i] = origin[i];
    }
}

/* Where its bodies are now, and where they were in the pose before. */
static void remember(const noh_stage_kind *k, noh_stage_body *b, const noh_modifier_work *w)
{
    if (w->cut) b->poses = 0;
    move_origin(k, b, &w->place);
    const noh_ragdoll_frame frame = noh_stage_ragdoll_frame(k, &w->place, b->origin);
    if (b->poses && w->clock > b->clocks[0]) {
        memcpy(b->bodies[1], b->bodies[0], sizeof b->bodies[1]);
        b->clocks[1] = b->clocks[0];
        b->poses = 2;
    }
    if (!b->poses) b->poses = 1;
    b->clocks[0] = w->clock;
    noh_ragdoll_from_pose(&noh_stage_ragdoll_kind_of(k)->fit, w->skeleton, w->local, &frame, b->bodies[0]);
}

/* Whether its ragdoll has to know where clips have its bodies. */
static int has_goals(const noh_stage_kind *k, const noh_stage_body *b)
{
    int some = b->held != 0;
    for (uint32_t i = 0; i < noh_stage_ragdoll_kind_of(k)->rig.body_count; i++) some |= b->hertz[i] > 0.0f;
    return some;
}

static void show_doll(const noh_stage_kind *k, noh_stage_body *b, const noh_modifier_work *w)
{
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
    const noh_ragdoll_frame frame = noh_stage_ragdoll_frame(k, &w->place, b->origin);
    float weights[NOH_RAGDOLL_BODIES_MAX];
    b->goals = b->doll && has_goals(k, b);
    if (b->goals) noh_ragdoll_from_pose(&shared->fit, w->skeleton, w->local, &frame, b->bodies[1]);
    noh_stage_ragdoll_weights(k, b, weights);
    noh_ragdoll_to_pose(&shared->fit, w->skeleton, &frame, b->bodies[0], weights, w->local);
    noh_stage_breathe_lying(k, b, w);
}

static void modify(noh_modifier_work *w)
{
    const noh_stage_kind *k = w->kind;
    noh_stage_body *b = w->state;
    if (b->state != NOH_BODY_STANDS) {
        show_doll(k, b, w);
        return;
    }
    if (b->moves == NOH_MOVES_STAGGERING) {
        noh_stage_run_stagger(k, b, w);
    } else if (b->moves) {
        noh_stage_run_get_up(k, b, w);
    }
    remember(k, b, w);
    if (b->goals) noh_stage_breathe_out(k, b, w);
}

/* ---- time ---- */

/* Where its place lies from its first body, one axis of it: in the world's units. */
static float carried_to(const noh_stage_kind *k, const noh_stage_body *b, int i)
{
    const double from = (double)b->bodies[0][0].position[i] + (double)b->offset[i];
    return (float)(((double)b->origin[i] + from) / (double)noh_stage_ragdoll_kind_of(k)->metres);
}

/* Where the game has moved a place, or as it begins to fall. */
static void take_offset(const noh_stage_kind *k, noh_stage_body *b, const noh_place *place)
{
    const noh_ragdoll_frame frame = noh_stage_ragdoll_frame(k, place, b->origin);
    noh_sub3(frame.position, b->bodies[0][0].position, b->offset);
}

/* The place goes where the first body goes, unless that is held: as far from it as ever, so that small ways add up. */
static void follow_doll(const noh_stage_kind *k, noh_stage_body *b, noh_stage_actor *a)
{
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
    int moved = 0;
    for (int i = 0; i < 3; i++) moved |= a->place.position[i] != carried_to(k, b, i);
    if (moved) take_offset(k, b, &a->place);
    noh_ragdoll_bodies_local(shared->dolls, b->doll - 1u, b->origin, b->bodies[0]);
    for (int i = 0; i < 3 && noh_stage_falls_free(b); i++) a->place.position[i] = carried_to(k, b, i);
    if (!NOH_PAGE) noh_stage_keep_within(&a->place, a->rest);
    if (b->dead && noh_ragdoll_sleeps(shared->dolls, b->doll - 1u)) {
        b->state = NOH_BODY_LIES;
        noh_stage_give_doll(k, b);
    }
}

static void brace(const noh_stage_ragdoll_kind *shared, const noh_stage_body *b)
{
    noh_ragdoll_pose goals[NOH_RAGDOLL_BODIES_MAX];
    float hertz[NOH_RAGDOLL_BODIES_MAX], origin[3];
    noh_stage_brace_goals(shared, b, origin, goals, hertz);
    (void)noh_ragdoll_follow_about(shared->dolls, b->doll - 1u, origin, goals, 0, hertz, NULL);
}

/* Dolls learn what their clips want. */
static void tell_dolls(const noh_stage_kind *k)
{
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
    for (uint32_t i = 0; i < k->desc->actor_count; i++) {
        const noh_stage_body *b = noh_stage_body_of(k, i);
        if (!k->actors[i].alive || !b->doll) continue;
        if (b->moves == NOH_MOVES_BRACING && !has_goals(k, b)) {
            brace(shared, b);
            continue;
        }
        (void)noh_ragdoll_follow_about(shared->dolls, b->doll - 1u, b->origin,
                                       b->goals && has_goals(k, b) ? b->bodies[1] : NULL, b->held, b->hertz, NULL);
    }
}

static void keep_feet_low(const noh_stage_kind *k)
{
    for (uint32_t i = 0; i < k->desc->actor_count; i++) {
        const noh_stage_body *b = noh_stage_body_of(k, i);
        if (k->actors[i].alive && b->doll && !b->dead && !has_goals(k, b)) {
            noh_stage_keep_feet_low(noh_stage_ragdoll_kind_of(k), b);
        }
    }
}

static void step(noh_stage_kind *k, uint32_t ticks)
{
    const noh_stage_ragdoll_kind *r = noh_stage_ragdoll_kind_of(k);
    tell_dolls(k);
    for (uint32_t left = noh_ragdolls_take(r->dolls, ticks); left; left--) {
        noh_ragdolls_step_once(r->dolls, r->world, r->scratch, r->asks);
        keep_feet_low(k);
    }
    for (uint32_t i = 0; i < k->desc->actor_count; i++) {
        noh_stage_body *b = noh_stage_body_of(k, i);
        if (!k->actors[i].alive) continue;
        if (b->doll && b->moves == NOH_MOVES_BRACING) noh_stage_step_brace(r, b, ticks);
        if (b->doll) noh_stage_step_lying(r, b, ticks);
        if (b->doll) follow_doll(k, b, &k->actors[i]);
        if (b->moves == NOH_MOVES_STAGGERING) noh_stage_step_stagger(k, &k->actors[i], b, ticks);
    }
}

static int carries(const noh_stage_kind *k, uint32_t index)
{
    const noh_stage_body *b = noh_stage_body_of(k, index);
    return noh_stage_falls_free(b) || b->moves == NOH_MOVES_STAGGERING;
}

static void shift(noh_stage_kind *k, const float by[3])
{
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
    float metres[3];
    for (int i = 0; i < 3; i++) metres[i] = -by[i] * shared->metres;
    noh_ragdolls_shift(shared->dolls, metres);
    for (uint32_t doll = 0; (doll = free_doll(k, doll)) != 0;) {
        noh_ragdoll_rest(shared->dolls, doll - 1u, &shared->rig);
    }
    for (uint32_t a = 0; a < k->desc->actor_count; a++) {
        noh_stage_body *b = noh_stage_body_of(k, a);
        float lost[3];
        if (!k->actors[a].alive) continue;
        noh_ragdoll_origin_shift(b->origin, metres, lost);
        for (uint32_t n = 0; n < 2u * NOH_RAGDOLL_BODIES_MAX; n++) {
            float *at = b->bodies[n / NOH_RAGDOLL_BODIES_MAX][n % NOH_RAGDOLL_BODIES_MAX].position;
            noh_madd3(at, 1.0f, lost, at);
        }
    }
}

/* ---- calls ---- */

noh_result noh_stage_open_body(noh_stage *stage, noh_actor actor, noh_stage_actor **a, noh_stage_kind **k,
                               noh_stage_body **b, noh_error *error)
{
    const noh_result result = noh_stage_change(stage, actor, a, k, error);
    if (result != NOH_OK) return result;
    if (!noh_stage_ragdoll_kind_of(*k)) {
        return noh_fail(error, NOH_ERR_ARG, "the actor's kind has no ragdolls: set noh_kind_desc.ragdoll",
                        (uint64_t)(*k - stage->kinds), 0);
    }
    *b = noh_stage_body_of(*k, noh_stage_index(*k, *a));
    return NOH_OK;
}

/* Put bodies together by their joints at a scale, from the first body on: a game may have changed the scale of an actor
 * that lies dead, whose bodies remember the old one. */
static void rejoin(const noh_stage_ragdoll_kind *shared, float scale, noh_ragdoll_pose *bodies)
{
    for (uint32_t i = 1; i < shared->rig.body_count; i++) {
        const noh_ragdoll_constants *c = &shared->dolls->shape.bodies[i];
        const noh_ragdoll_pose *parent = &bodies[c->parent];
        float arm[3];
        noh_quat_rotate(parent->rotation, c->anchor_parent, arm);
        noh_madd3(parent->position, scale, arm, bodies[i].position);
        noh_quat_rotate(bodies[i].rotation, c->anchor, arm);
        noh_madd3(bodies[i].position, -scale, arm, bodies[i].position);
    }
}

/* An actor that was not shown yet falls out of the bind pose, at rest. */
static noh_result place_doll(noh_stage_kind *k, const noh_stage_actor *a, noh_stage_body *b, uint32_t doll,
                             noh_error *error)
{
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
    const uint32_t count = shared->rig.body_count;
    noh_ragdoll_motion motions[NOH_RAGDOLL_BODIES_MAX];
    const int stands = b->state == NOH_BODY_STANDS;
    if (stands && !b->poses) {
        move_origin(k, b, &a->place);
        const noh_ragdoll_frame frame = noh_stage_ragdoll_frame(k, &a->place, b->origin);
        noh_ragdoll_from_pose(&shared->fit, &k->skeleton, k->skeleton.bind_pose, &frame, b->bodies[0]);
    }
    memset(motions, 0, sizeof motions);
    if (stands && b->poses == 2u) {
        const float seconds = (float)(b->clocks[0] - b->clocks[1]) / (float)NOH_TICKS_PER_SECOND;
        noh_ragdoll_motions_of(b->bodies[1], b->bodies[0], count, seconds, motions);
    }
    noh_ragdoll_measures joints = { .separation_mean = 0.0f };
    noh_result result = noh_ragdoll_place_about(shared->dolls, doll - 1u, b->origin, a->place.scale, b->bodies[0],
                                                motions, error);
    if (result == NOH_OK && !stands) noh_ragdoll_measure(shared->dolls, doll - 1u, NULL, &joints);
    if (joints.separation_mean > APART * shared->dolls->size) {
        rejoin(shared, a->place.scale, b->bodies[0]);
        result = noh_ragdoll_place_about(shared->dolls, doll - 1u, b->origin, a->place.scale, b->bodies[0], motions,
                                         error);
    }
    if (result == NOH_OK) take_offset(k, b, &a->place);
    return result;
}

int noh_stage_can_fall(const noh_stage_actor *a)
{
    return !a->parent && noh_ragdoll_is_size(a->place.scale);
}

noh_result noh_stage_fall(noh_stage_kind *k, const noh_stage_actor *a, noh_stage_body *b, noh_error *error)
{
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
    uint32_t doll;
    noh_result result;
    if (b->doll) return NOH_OK;
    if (!noh_stage_can_fall(a)) {
        return noh_fail(error, NOH_ERR_ARG, "cannot ragdoll: the actor is attached, or its scale is not in 0.01..100",
                        0, 0);
    }
    doll = free_doll(k, 0);
    if (!doll) {
        return noh_fail(error, NOH_ERR_LIMIT, "all ragdolls of the kind are in use: raise noh_kind_ragdoll.count",
                        shared->count, shared->count + 1u);
    }
    result = place_doll(k, a, b, doll, error);
    b->doll = doll;
    if (result != NOH_OK) {
        noh_stage_give_doll(k, b);
        return result;
    }
    b->state = NOH_BODY_FALLS;
    b->moves = NOH_MOVES_BY_CLIPS;
    b->rise_ticks = 0;
    b->goals = 0;
    b->poses = 0;
    noh_character_wake(noh_stage_character(k, noh_stage_index(k, a)));
    return NOH_OK;
}

noh_result noh_actor_fall(noh_stage *stage, noh_actor actor, noh_error *error)
{
    noh_stage_actor *a;
    noh_stage_kind *k;
    noh_stage_body *b = NULL;
    const noh_result result = noh_stage_open_body(stage, actor, &a, &k, &b, error);
    return b ? noh_stage_fall(k, a, b, error) : result;
}

noh_result noh_stage_knock_down(noh_stage_kind *k, const noh_stage_actor *a, noh_stage_body *b,
                                const noh_stage_push *push, noh_error *error)
{
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
    if (b->state == NOH_BODY_STANDS && shared->parts.has_legs) return noh_stage_brace_fall(k, a, b, push, error);
    const noh_result result = noh_stage_fall(k, a, b, error);
    if (result == NOH_OK) noh_ragdoll_push(shared->dolls, b->doll - 1u, push->point, push->impulse);
    return result;
}

noh_result noh_actor_hit(noh_stage *stage, noh_actor actor, const float point[3], const float impulse[3],
                         noh_error *error)
{
    noh_stage_actor *a;
    noh_stage_kind *k;
    noh_stage_body *b = NULL;
    const noh_stage_push push = { point, impulse };
    const noh_result result = noh_stage_open_body(stage, actor, &a, &k, &b, error);
    NOH_ASSERT(point && impulse);
    if (!b) return result;
    for (int i = 0; i < 3; i++) {
        if (!noh_is_number(point[i]) || !noh_is_number(impulse[i])) {
            return noh_fail(error, NOH_ERR_ARG, "a hit's point or impulse is not a number, or larger than 10^12",
                            (uint64_t)i, 0);
        }
    }
    return noh_stage_begin_stagger(k, a, b, &push) ? NOH_OK : noh_stage_knock_down(k, a, b, &push, error);
}

noh_result noh_actor_kill(noh_stage *stage, noh_actor actor, noh_error *error)
{
    noh_stage_actor *a;
    noh_stage_kind *k;
    noh_stage_body *b = NULL;
    noh_result result = noh_stage_open_body(stage, actor, &a, &k, &b, error);
    if (!b) return result;
    if (b->state != NOH_BODY_LIES) result = noh_stage_fall(k, a, b, error);
    if (result == NOH_OK) b->dead = 1;
    return result;
}

noh_result noh_actor_revive(noh_stage *stage, noh_actor actor, noh_error *error)
{
    noh_stage_actor *a;
    noh_stage_kind *k;
    noh_stage_body *b = NULL;
    const noh_result result = noh_stage_open_body(stage, actor, &a, &k, &b, error);
    if (b) b->dead = 0;
    return result;
}

noh_result noh_actor_hold_body(noh_stage *stage, noh_actor actor, uint32_t joint, const noh_body_hold *hold,
                               noh_error *error)
{
    noh_stage_actor *a;
    noh_stage_kind *k;
    noh_stage_body *b = NULL;
    uint32_t found = 0;
    const noh_result result = noh_stage_open_body(stage, actor, &a, &k, &b, error);
    NOH_ASSERT(hold);
    if (!b) return result;
    if (!(hold->hertz >= 0.0f && noh_is_number(hold->hertz)) || !(hold->animated >= 0.0f && hold->animated <= 1.0f))
        return noh_fail(error, NOH_ERR_ARG, "hertz of a body's hold is not in 0..10^12, or animated not in 0..1", joint,
                        0);
    for (uint32_t i = 0; joint != NOH_JOINT_ROOT && i < noh_stage_ragdoll_kind_of(k)->rig.body_count; i++) {
        if (!noh_joint_is_below(&k->skeleton, noh_stage_ragdoll_kind_of(k)->fit.joints[i], joint)) continue;
        b->held = (b->held & ~(1u << i)) | (hold->held ? 1u << i : 0u);
        b->hertz[i] = hold->hertz;
        b->animated[i] = hold->animated;
        found = 1;
    }
    return found ? NOH_OK : noh_fail(error, NOH_ERR_ARG, "no body begins at that joint, nor below it", joint, 0);
}

noh_body_state noh_actor_body(const noh_stage *stage, noh_actor actor)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    const noh_stage_body *b = a && noh_stage_ragdoll_kind_of(k) ? noh_stage_body_of(k, noh_stage_index(k, a)) : NULL;
    if (!b) return NOH_BODY_STANDS;
    if (b->doll)
        return noh_ragdoll_sleeps(noh_stage_ragdoll_kind_of(k)->dolls, b->doll - 1u) ? NOH_BODY_LIES : NOH_BODY_FALLS;
    if (b->state == NOH_BODY_LIES) return NOH_BODY_LIES;
    if (b->moves == NOH_MOVES_STAGGERING) return NOH_BODY_STAGGERS;
    return b->moves && noh_clock_since(stage->head->clock, b->rise_clock) < (int64_t)b->rise_ticks ? NOH_BODY_GETS_UP
                                                                                                   : NOH_BODY_STANDS;
}

/* ---- state from outside ---- */

static int is_hold(const noh_stage_body *b, uint32_t i)
{
    return b->hertz[i] >= 0.0f && noh_is_number(b->hertz[i]) && b->animated[i] >= 0.0f && b->animated[i] <= 1.0f;
}

static const char *bad_move(const noh_stage_kind *k, const noh_stage_body *b)
{
    const int falls = b->state == NOH_BODY_FALLS, legs = (int)noh_stage_ragdoll_kind_of(k)->parts.has_legs;
    if (b->moves == NOH_MOVES_BY_CLIPS) return NULL;
    if (b->moves > NOH_MOVES_BRACING || falls != (b->moves == NOH_MOVES_BRACING))
        return "state: bad ragdoll of an actor";
    if (b->moves >= NOH_MOVES_STAGGERING && !legs) return "state: an actor without legs staggers";
    if (b->moves == NOH_MOVES_STAGGERING) return noh_stage_check_stagger(&b->of.stagger);
    if (b->moves == NOH_MOVES_BRACING) return noh_stage_check_brace(&b->of.brace);
    return noh_are_sound(b->of.motions[0].velocity, 6u * NOH_RAGDOLL_BODIES_MAX) && b->rise_ticks
               ? NULL
               : "state: an actor's ragdoll is not a number";
}

static const char *bad_body(const noh_stage_kind *k, const noh_stage_body *b)
{
    if (b->doll > noh_stage_ragdoll_kind_of(k)->count || b->poses > 2u ||
        (b->poses == 2u && b->clocks[0] <= b->clocks[1]) || b->state > NOH_BODY_LIES ||
        (b->state == NOH_BODY_FALLS) != (b->doll != 0) || b->dead > 1u || (b->doll && b->goals > 1u)) {
        return "state: bad ragdoll of an actor";
    }
    if (!NOH_ARE_SOUND(noh_stage_body, b, bodies, of) || !NOH_ARE_SOUND(noh_stage_body, b, offset, hertz) ||
        !noh_are_sound(b->origin, 3)) {
        return "state: an actor's ragdoll is not a number";
    }
    for (uint32_t i = 0; i < NOH_RAGDOLL_BODIES_MAX; i++) {
        if (!is_hold(b, i)) return "state: an actor's ragdoll is not a number";
    }
    return bad_move(k, b);
}

static noh_result check(const noh_stage_kind *k, const void *state, noh_error *error)
{
    const char *what = bad_body(k, state);
    return what ? noh_fail(error, NOH_ERR_DATA, what, 0, 0) : NOH_OK;
}

static const char *check_pool(const noh_stage_kind *k, const void *pool)
{
    const noh_stage_module *m = &k->modules[NOH_SLOT_BODY];
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
    const uint8_t *states = (const uint8_t *)pool + (m->states - (const uint8_t *)m->pool);
    const char *what = noh_ragdolls_check(shared->dolls, pool);
    for (uint32_t doll = 1; !what && doll <= shared->count; doll++) {
        const uint32_t count = owners(k, states, doll);
        if (count > 1u) what = "state: two actors have one ragdoll";
        if (!count && !noh_ragdoll_rests(pool, doll - 1u, &shared->rig))
            what = "state: a ragdoll that no actor has is not at rest";
    }
    return what;
}

/* ---- the module ---- */

noh_module noh_ragdoll_module(const noh_kind_ragdoll *ragdoll)
{
    static const noh_module_type ragdolls = {
        .slot = NOH_SLOT_BODY,
        .kind_name = "ragdolls",
        .state_name = "ragdoll states",
        .pool_name = "ragdoll pool",
        .hash = hash,
        .bad = bad,
        .measure = measure,
        .init = init,
        .despawn = despawn,
        .shift = shift,
        .check = check,
        .check_pool = check_pool,
        .step = step,
        .carries = carries,
        .modify = modify,
    };
    return (noh_module){ ragdoll ? &ragdolls : NULL, ragdoll };
}
