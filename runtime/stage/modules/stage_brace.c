/* stage_brace.c: actors that a push fells: they topple over their feet, and brace for the ground.
 *
 * Joints turn towards a pose that arms, head and legs take against the ground: arms reach for it, the head is held away
 * from it, knees bend. Once the trunk has landed the joints go limp. */
#include <string.h>

#include "core/base/math_internal.h"
#include "core/base/quarter_internal.h"
#include "life/physics/ragdoll_internal.h"
#include "core/base/vector_internal.h"
#include "life/reach/feet_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "stage/modules/stage_ragdoll_internal.h"

/* Times, rates and hertz are of an actor of scale 1: times grow by the square root of the scale, as falls do. */
#define SPIN_MAX 0.7f /* of the rate at which a pendulum as high as the centre of mass falls over */
#define ARM_HERTZ 6.0f
#define HEAD_HERTZ 5.0f
#define TRUNK_HERTZ 3.0f
#define LEG_HERTZ 6.0f
#define ELBOW 0.6f    /* radians */
#define LEG_BEND 0.1f /* of knees, and 0.7 of it of hips; to BACK_BEND more of one that falls on its back */
#define BACK_BEND 0.7f
#define FOOT_RATE 6.0f   /* 1/s: how fast a foot may rise, for each metre that it is below the hips */
#define FOOT_MARGIN 0.1f /* of a leg */
#define FOOT_DOWN 1.5f   /* legs a second: no foot is sent down faster */
#define LANDED 0.4f      /* of the greatest speed downwards: when the trunk is slower than this, it has landed */
#define BRACE_MAX_TICKS 72000u
#define BRACE_MIN_TICKS 9600u
#define RELAX_SECONDS 0.35f

static const float up[3] = { 0.0f, 1.0f, 0.0f };

static float time_of(const noh_ragdoll_doll *doll)
{
    return noh_sqrt(noh_ragdoll_size(doll));
}

/* ---- bodies ---- */

static uint32_t body_at(const noh_stage_ragdoll_kind *shared, uint32_t joint)
{
    for (uint32_t i = 0; i < shared->fit.body_count; i++) {
        if (shared->fit.joints[i] == joint) return i;
    }
    return NOH_NONE;
}

static void find_legs(noh_stage_ragdoll_kind *shared)
{
    noh_stage_parts *p = &shared->parts;
    p->has_legs = shared->legs.leg_count == NOH_FEET_LEGS_MAX;
    for (uint32_t i = 0; i < NOH_FEET_LEGS_MAX && p->has_legs; i++) {
        p->thighs[i] = body_at(shared, shared->legs.legs[i].thigh);
        p->shins[i] = body_at(shared, shared->legs.legs[i].shin);
        p->feet[i] = body_at(shared, shared->legs.legs[i].foot);
        p->has_legs = p->thighs[i] != NOH_NONE && p->shins[i] != NOH_NONE && p->feet[i] != NOH_NONE;
    }
}

/* Forearms are the hinges that are no shins; the chest carries the upper arms and the head. */
void noh_stage_find_parts(noh_stage_ragdoll_kind *shared, const noh_ragdoll_source *source)
{
    const noh_ragdoll_rig *rig = &shared->rig;
    noh_stage_parts *p = &shared->parts;
    memset(p, 0, sizeof *p);
    p->spine = p->chest = p->head = NOH_NONE;
    if (noh_feet_rig_make(source, &shared->legs, NULL) != NOH_OK) return;
    find_legs(shared);
    p->front = (uint16_t)noh_feet_front(source, &shared->legs);
    for (uint32_t i = 1; i < rig->body_count && p->has_legs; i++) {
        const uint32_t upper = rig->bodies[i].parent;
        if (!(rig->joints[i].flags & NOH_RAGDOLL_HINGE) || i == p->shins[0] || i == p->shins[1]) continue;
        if (upper == 0u || p->arm_count == 2u) continue;
        p->upper_arms[p->arm_count] = upper;
        p->forearms[p->arm_count++] = i;
        p->chest = rig->bodies[upper].parent;
    }
    if (p->chest == NOH_NONE || p->chest == 0u) {
        p->chest = NOH_NONE;
        p->arm_count = 0;
        return;
    }
    p->spine = rig->bodies[p->chest].parent ? rig->bodies[p->chest].parent : NOH_NONE;
    for (uint32_t i = 1; i < rig->body_count; i++) {
        if (rig->bodies[i].parent == p->chest && i != p->upper_arms[0] && i != p->upper_arms[1]) p->head = i;
    }
}

/* ---- topple ---- */

/* All bodies get the push together: the feet stay and the rest goes over them, up to some spin; a push far below the
 * centre of mass takes the feet away. Momentum is the push's. */
static void topple(const noh_stage_ragdoll_kind *shared, noh_ragdoll_doll *doll, const noh_stage_push *push)
{
    const float size = noh_ragdoll_size(doll), height = push->point[1] / size - doll->origin[1];
    const float mass = shared->mass * size * size * size;
    const noh_ragdoll_rig *rig = &shared->rig;
    float centre[3] = { 0.0f, 0.0f, 0.0f }, low = doll->bodies[0].position[1], spin[3], speed[3];
    for (uint32_t i = 0; i < rig->body_count; i++) {
        const float *at = doll->bodies[i].position;
        noh_madd3(centre, rig->bodies[i].mass / shared->mass, at, centre);
        low = at[1] < low ? at[1] : low;
    }
    const float high = centre[1] - low > 0.1f ? centre[1] - low : 0.1f;
    const float from_centre = 1.0f + 2.0f * (height - centre[1]) / high;
    const float share = from_centre > 1.0f ? 1.0f : from_centre < -1.0f ? -1.0f : from_centre;
    for (int n = 0; n < 3; n++) speed[n] = push->impulse[n] / mass / size;
    noh_cross3(up, speed, spin);
    const float rate = noh_length3(spin) / high, most = SPIN_MAX * noh_sqrt(NOH_GRAVITY / size / high);
    const float scale = share / high * (rate > most ? most / rate : 1.0f);
    for (int n = 0; n < 3; n++) spin[n] *= scale;
    for (uint32_t i = 0; i < rig->body_count; i++) {
        noh_ragdoll_state *s = &doll->bodies[i];
        float from[3], way[3];
        noh_sub3(s->position, centre, from);
        noh_cross3(spin, from, way);
        noh_madd3(way, 1.0f, speed, way);
        noh_madd3(s->velocity, 1.0f, way, s->velocity);
        noh_madd3(s->spin, 1.0f, spin, s->spin);
    }
}

noh_result noh_stage_brace_fall(noh_stage_kind *k, const noh_stage_actor *a, noh_stage_body *b,
                                const noh_stage_push *push, noh_error *error)
{
    const noh_stage_ragdoll_kind *shared = noh_stage_ragdoll_kind_of(k);
    const noh_result result = noh_stage_fall(k, a, b, error);
    if (result != NOH_OK) return result;
    noh_ragdoll_doll *doll = &noh_ragdoll_dolls(shared->dolls)[b->doll - 1u];
    noh_stage_brace *brace = &b->of.brace;
    float toward[3];
    if (push) topple(shared, doll, push);
    memset(brace, 0, sizeof *brace);
    brace->strength = 1.0f;
    memcpy(toward, doll->bodies[0].velocity, sizeof toward);
    toward[1] = 0.0f;
    noh_normalize3(toward, toward);
    brace->toward[0] = toward[0];
    brace->toward[1] = toward[2];
    b->moves = NOH_MOVES_BRACING;
    return NOH_OK;
}

/* ---- the pose ---- */

typedef struct bracing {
    const noh_ragdoll_rig *rig;
    const noh_ragdoll_state *bodies;
    noh_ragdoll_pose *goals;
    float *hertz;
    float chest[4]; /* from the chest as it is to its goal: joints turn towards angles between goals */
} bracing;

/* The goal that keeps a body as it is at rest from its parent, whose goal is known. */
static void as_at_rest(const bracing *b, uint32_t i)
{
    const noh_ragdoll_body *body = &b->rig->bodies[i];
    float back[4];
    noh_quat_conjugate(b->rig->bodies[body->parent].rotation, back);
    noh_quat_mul(back, body->rotation, back);
    noh_quat_mul(b->goals[body->parent].rotation, back, b->goals[i].rotation);
    noh_quat_normalize(b->goals[i].rotation);
}

static void turn_goal(const bracing *b, uint32_t i, const float by[4])
{
    noh_quat_mul(by, b->goals[i].rotation, b->goals[i].rotation);
    noh_quat_normalize(b->goals[i].rotation);
}

/* From its joint to its centre, as its goal has it. */
static void axis_of(const bracing *b, uint32_t i, float axis[3])
{
    const noh_ragdoll_body *body = &b->rig->bodies[i];
    float back[4];
    noh_quat_conjugate(body->rotation, back);
    noh_sub3(body->position, b->rig->joints[i].anchor, axis);
    noh_normalize3(axis, up);
    noh_quat_rotate(back, axis, axis);
    noh_quat_rotate(b->goals[i].rotation, axis, axis);
}

/* Bend a hinge from rest, the way it bends. */
static void bend(const bracing *b, uint32_t i, float angle)
{
    static const float along[3] = { 0.0f, 0.0f, 1.0f };
    const noh_ragdoll_joint *joint = &b->rig->joints[i];
    const float way = joint->twist_max > -joint->twist_min ? angle : -angle;
    float axis[3], back[4], q[4];
    noh_quat_rotate(joint->frame, along, axis);
    noh_quat_conjugate(b->rig->bodies[i].rotation, back);
    noh_quat_rotate(back, axis, axis);
    noh_quat_rotate(b->goals[i].rotation, axis, axis);
    for (int n = 0; n < 3; n++) axis[n] *= way;
    noh_quat_from_rotation(axis, q);
    turn_goal(b, i, q);
}

/* Point a body in a direction of the world, or part of the way.
 * carrier  from what carries the body as it is to its goal */
static void aim(const bracing *b, uint32_t i, const float carrier[4], const float direction[3], float share)
{
    float axis[3], way[3], q[4];
    axis_of(b, i, axis);
    noh_quat_rotate(carrier, direction, way);
    for (int n = 0; n < 3; n++) way[n] = share * way[n] + (1.0f - share) * axis[n];
    noh_quat_between(axis, way, up, q);
    turn_goal(b, i, q);
}

static void brace_arms(const bracing *b, const noh_stage_parts *parts, const float toward[2])
{
    float side[3];
    for (uint32_t i = 0; i < parts->arm_count; i++) {
        const uint32_t upper = parts->upper_arms[i], lower = parts->forearms[i];
        noh_sub3(b->bodies[upper].position, b->bodies[parts->chest].position, side);
        noh_normalize3(side, up);
        const float reach[3] = { 0.8f * toward[0] + 0.3f * side[0], -0.7f, 0.8f * toward[1] + 0.3f * side[2] };
        aim(b, upper, b->chest, reach, 1.0f);
        as_at_rest(b, lower);
        bend(b, lower, ELBOW);
        b->hertz[upper] = b->hertz[lower] = ARM_HERTZ;
    }
}

static void brace_legs(const bracing *b, const noh_stage_parts *parts, const float toward[2])
{
    static const float down[3] = { 0.0f, -1.0f, 0.0f }, as_it_is[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
    float across[3] = { -0.7f, 0.0f, 0.0f }, ahead[3] = { 0.0f, 0.0f, 1.0f };
    float turned[4], front[3], turn[3], q[4];
    noh_quarter_turn(parts->front, across, across);
    noh_quarter_turn(parts->front, ahead, ahead);
    noh_quat_conjugate(b->rig->bodies[0].rotation, turned);
    noh_quat_mul(b->goals[0].rotation, turned, turned);
    noh_quat_rotate(turned, ahead, front);
    noh_quat_rotate(turned, across, turn);
    const float back = -(front[0] * toward[0] + front[2] * toward[1]);
    const float knee = LEG_BEND + (back > 0.0f ? BACK_BEND * back : 0.0f);
    for (int n = 0; n < 3; n++) turn[n] *= knee;
    noh_quat_from_rotation(turn, q);
    for (uint32_t i = 0; i < 2u; i++) {
        turn_goal(b, parts->thighs[i], q);
        aim(b, parts->thighs[i], as_it_is, down, 0.4f); /* no leg is left in the air */
        as_at_rest(b, parts->shins[i]);
        bend(b, parts->shins[i], knee);
        as_at_rest(b, parts->feet[i]);
        b->hertz[parts->thighs[i]] = b->hertz[parts->shins[i]] = b->hertz[parts->feet[i]] = LEG_HERTZ;
    }
}

static void brace_head(const bracing *b, const noh_stage_parts *parts)
{
    if (parts->head == NOH_NONE) return;
    aim(b, parts->head, b->chest, up, 0.5f);
    b->hertz[parts->head] = HEAD_HERTZ;
}

void noh_stage_brace_goals(const noh_stage_ragdoll_kind *shared, const noh_stage_body *body, float *origin,
                           noh_ragdoll_pose *goals, float *hertz)
{
    const noh_stage_brace *brace = &body->of.brace;
    const noh_ragdoll_doll *doll = &noh_ragdoll_dolls(shared->dolls)[body->doll - 1u];
    bracing b = { &shared->rig, doll->bodies, goals, hertz, { 0.0f, 0.0f, 0.0f, 1.0f } };
    noh_ragdoll_bodies_local(shared->dolls, body->doll - 1u, origin, goals);
    for (uint32_t i = 0; i < shared->rig.body_count; i++) {
        if (i) as_at_rest(&b, i);
        hertz[i] = TRUNK_HERTZ;
    }
    brace_legs(&b, &shared->parts, brace->toward);
    if (shared->parts.chest != NOH_NONE) {
        noh_quat_conjugate(doll->bodies[shared->parts.chest].rotation, b.chest);
        noh_quat_mul(goals[shared->parts.chest].rotation, b.chest, b.chest);
        brace_arms(&b, &shared->parts, brace->toward);
        brace_head(&b, &shared->parts);
    }
    for (uint32_t i = 0; i < shared->rig.body_count; i++) hertz[i] *= brace->strength / time_of(doll);
}

/* ---- legs ---- */

/* The nearer a foot gets to the height of the hips, the slower its leg may rise. A leg that is kicked up as the trunk
 * lands or rolls comes down again, as muscles would have it; a foot that lies high, on a stair, stays. */
static void brake_leg(const noh_stage_parts *p, noh_ragdoll_doll *doll, uint32_t leg, float length)
{
    const uint32_t bodies[3] = { p->thighs[leg], p->shins[leg], p->feet[leg] };
    const noh_ragdoll_state *hips = &doll->bodies[0], *foot = &doll->bodies[p->feet[leg]];
    const float time = time_of(doll), room = hips->position[1] - foot->position[1] - FOOT_MARGIN * length;
    const float most = hips->velocity[1] + FOOT_RATE / time * (room > 0.0f ? room : 0.0f);
    const float down = -FOOT_DOWN / time * length, leg_speed = length / time;
    const float excess = foot->velocity[1] - (most > down ? most : down);
    if (!(excess > 0.0f)) return;
    const float share = excess < leg_speed ? excess / leg_speed : 1.0f; /* of the spin: all from a leg a second on */
    for (int i = 0; i < 3; i++) {
        noh_ragdoll_state *s = &doll->bodies[bodies[i]];
        s->velocity[1] -= excess * (i ? 1.0f : 0.5f);
        s->spin[0] *= 1.0f - share;
        s->spin[2] *= 1.0f - share;
    }
}

void noh_stage_keep_feet_low(const noh_stage_ragdoll_kind *shared, const noh_stage_body *body)
{
    noh_ragdoll_doll *doll = &noh_ragdoll_dolls(shared->dolls)[body->doll - 1u];
    if (!shared->parts.has_legs || doll->asleep || body->held) return;
    for (uint32_t i = 0; i < NOH_FEET_LEGS_MAX; i++) {
        brake_leg(&shared->parts, doll, i, shared->legs.length * shared->metres);
    }
}

/* ---- time ---- */

void noh_stage_step_brace(const noh_stage_ragdoll_kind *shared, noh_stage_body *body, uint32_t ticks)
{
    noh_stage_brace *brace = &body->of.brace;
    const noh_ragdoll_doll *doll = &noh_ragdoll_dolls(shared->dolls)[body->doll - 1u];
    const uint32_t trunk = shared->parts.chest == NOH_NONE ? 0u : shared->parts.chest;
    const float down = -noh_ragdoll_size(doll) * doll->bodies[trunk].velocity[1];
    brace->fastest = down > brace->fastest ? down : brace->fastest;
    const float time = time_of(doll);
    const uint32_t least = (uint32_t)(BRACE_MIN_TICKS * time), most = (uint32_t)(BRACE_MAX_TICKS * time);
    brace->ticks += ticks < most ? ticks : most;
    const int landed = brace->ticks > least && brace->fastest > time && down < LANDED * brace->fastest;
    if (landed || brace->ticks > most || brace->strength < 1.0f) {
        brace->strength -= (float)ticks / (float)NOH_TICKS_PER_SECOND / (RELAX_SECONDS * time);
    }
    if (!(brace->strength > 0.0f) || body->dead) body->moves = NOH_MOVES_BY_CLIPS;
}

const char *noh_stage_check_brace(const noh_stage_brace *b)
{
    return noh_are_sound(b->toward, 2) && noh_are_sound(&b->fastest, 1) && b->strength > 0.0f && b->strength <= 1.0f &&
                   b->ticks <= 2u * NOH_RAGDOLL_TIME_MAX * BRACE_MAX_TICKS
               ? NULL
               : "state: an actor's brace is out of range";
}
