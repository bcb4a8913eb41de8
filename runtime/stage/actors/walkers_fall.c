/* walkers_fall.c: walkers that fall, lie and get up, and the places of their agents meanwhile. */
#include <string.h>

#include "core/base/math_internal.h"
#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/crowd.h"
#include "noh/low_core.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "stage/modules/stage_ragdoll_internal.h"
#include "stage/actors/walkers_internal.h"

#define FADE_TICKS (NOH_TICKS_PER_SECOND * 3u / 10u) /* from the get-up clip */

/* ---- pushes ---- */

/* The nearest standing walker farther than `beyond`, or as far but later in order; NOH_NONE: none. *square: squared
 * distance */
static uint32_t next_nearest(noh_walkers *w, noh_stage *stage, const float point[3], float most, float beyond,
                             uint32_t last, float *square)
{
    uint32_t nearest = NOH_NONE;
    for (uint32_t i = 0; i < w->walker_max; i++) {
        walker *r = noh_walker_at(w, i);
        noh_place place;
        if (!r->actor || r->fallen || noh_actor_body(stage, (noh_actor){ r->actor }) != NOH_BODY_STANDS) continue;
        if (noh_actor_place(stage, (noh_actor){ r->actor }, &place, NULL)) continue;
        const float x = place.position[0] - point[0], z = place.position[2] - point[2], away = x * x + z * z;
        if (!(away <= most) || away < beyond || (away == beyond && last != NOH_NONE && i <= last)) continue;
        if (nearest != NOH_NONE && away >= *square) continue;
        nearest = i;
        *square = away;
    }
    return nearest;
}

static noh_result push(noh_stage *stage, const walker *r, const float point[3], float impulse)
{
    noh_place place;
    float away[3];
    noh_stage_actor *a;
    noh_stage_kind *k;
    noh_stage_body *b = NULL;
    const noh_result found = noh_actor_place(stage, (noh_actor){ r->actor }, &place, NULL);
    if (found) return found;
    float at[3] = { place.position[0], point[1], place.position[2] };
    noh_push_away(point, at, impulse, away);
    if (away[0] == 0.0f && away[2] == 0.0f) {
        away[0] = impulse * r->heading[0];
        away[2] = impulse * r->heading[1];
    }
    const noh_result open = noh_stage_open_body(stage, (noh_actor){ r->actor }, &a, &k, &b, NULL);
    if (open) return open;
    for (int i = 0; i < 3; i++) at[i] *= noh_stage_ragdoll_kind_of(k)->metres;
    return noh_stage_knock_down(k, a, b, &(noh_stage_push){ at, away }, NULL);
}

uint32_t noh_walkers_push(noh_walkers *walkers, noh_stage *stage, const float point[3], float radius, float impulse)
{
    NOH_ASSERT(walkers && stage && point);
    float beyond = -1.0f;
    uint32_t fell = 0, last = NOH_NONE;
    if (!noh_is_number3(point) || !noh_is_number(radius) || !noh_is_number(impulse)) return 0;
    if (stage->phase != NOH_STAGE_IDLE || !noh_stage_ragdoll_kind_of(&stage->kinds[walkers->kind])) return 0;
    for (;;) {
        float square = 0.0f;
        last = next_nearest(walkers, stage, point, radius * radius, beyond, last, &square);
        if (last == NOH_NONE) return fell;
        const noh_result result = push(stage, noh_walker_at(walkers, last), point, impulse);
        if (result == NOH_ERR_LIMIT) return fell;
        fell += result == NOH_OK;
        beyond = square;
    }
}

/* ---- after the fall ---- */

/* Move the agent and the known position to the body. */
static void bring(walker *r, noh_crowd *crowd, const noh_stage_actor *a)
{
    const float at[2] = { a->place.position[0], a->place.position[2] };
    noh_crowd_move(crowd, r->agent, at);
    for (int i = 0; i < 2; i++) {
        r->body[i] = (float)((double)at[i] + (double)a->rest[2 * i] - crowd->home[i]);
        r->at[i] = r->body[i];
    }
}

/* Walk on from where it got up, in the direction it faces. */
static void stand_up(const noh_walkers *w, walker *r, const noh_place *place)
{
    const float ahead[3] = { w->forward[0], 0.0f, w->forward[1] };
    float faced[3];
    noh_quat_rotate(place->rotation, ahead, faced);
    const float length = noh_sqrt(faced[0] * faced[0] + faced[2] * faced[2]);
    if (length > 1e-6f) {
        r->heading[0] = faced[0] / length;
        r->heading[1] = faced[2] / length;
    }
    memset(r->velocity, 0, sizeof r->velocity);
    r->height = place->position[1];
    r->climb = r->even = r->goes = r->runs = 0.0f;
    r->begun = WALKER_STANDS_UP;
}

/* Stop the agent of a walker that falls. */
static void fall_down(walker *r, noh_crowd *crowd)
{
    noh_crowd_agent agent;
    r->pace = noh_crowd_agent_stepped(crowd, r->agent, &agent) ? agent.speed : 0.0f;
    noh_crowd_set_speed(crowd, r->agent, 0.0f);
    memset(&r->fall, 0, sizeof r->fall);
    r->fallen = 1;
}

static int is_down(const noh_stage *stage, noh_actor actor)
{
    const noh_body_state body = noh_actor_body(stage, actor);
    return body == NOH_BODY_FALLS || body == NOH_BODY_LIES;
}

/* Returns whether it is still down. */
static int tend(noh_walkers *w, walker *r, noh_crowd *crowd, noh_stage *stage, uint32_t layer, uint32_t ticks,
                noh_error *error)
{
    const noh_actor actor = { r->actor };
    const int was_down = is_down(stage, actor);
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    const int is_dead = noh_stage_body_of(k, noh_stage_index(k, a))->dead;
    if (was_down && !r->fallen) fall_down(r, crowd);
    if (!r->fallen) return 0;
    if (!(is_dead && was_down)) (void)noh_fall_step(&r->fall, stage, actor, layer, ticks, error);
    if (was_down || !r->begun) bring(r, crowd, a);
    if (!r->begun && !is_down(stage, actor)) stand_up(w, r, &a->place);
    if (noh_fall_lasts(&r->fall, stage, actor)) return 1;
    (void)noh_actor_stop(stage, actor, layer, FADE_TICKS, NULL);
    noh_crowd_set_speed(crowd, r->agent, r->pace);
    r->fallen = 0;
    return 0;
}

uint32_t noh_walkers_tend(noh_walkers *walkers, noh_crowd *crowd, noh_stage *stage, uint32_t layer, uint32_t ticks,
                          noh_error *error)
{
    uint32_t down = 0;
    NOH_ASSERT(walkers && crowd && stage);
    if (!noh_stage_ragdoll_kind_of(&stage->kinds[walkers->kind])) return 0;
    if (stage->phase != NOH_STAGE_IDLE || layer == walkers->layer) {
        (void)noh_fail(error, NOH_ERR_ARG,
                       "noh_walkers_tend called during a step or a frame, or with the walkers' own layer", layer, 0);
        return 0;
    }
    for (uint32_t i = 0; i < walkers->walker_max; i++) {
        walker *r = noh_walker_at(walkers, i);
        noh_stage_kind *k;
        if (!r->actor || !noh_stage_actor_of(stage, (noh_actor){ r->actor }, &k)) continue;
        down += (uint32_t)tend(walkers, r, crowd, stage, layer, ticks, error);
    }
    return down;
}

int noh_walkers_is_down(const noh_walkers *walkers, uint32_t index)
{
    NOH_ASSERT(walkers && index < walkers->walker_max);
    const walker *r = (const walker *)(const void *)((const char *)walkers + sizeof *walkers) + index;
    return r->actor && r->fallen;
}
