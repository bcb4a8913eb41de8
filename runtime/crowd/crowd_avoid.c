/* crowd_avoid.c: planned velocities, corrected so that agents pass each other and do not overlap after the step. */
#include "crowd/crowd_internal.h"

#include "base/trig.h"

#define MARGIN 1.03f       /* of the radii: what is kept free between two */
#define OVER 1.5f          /* over-relaxation of contacts, whose corrections are averaged */
#define HORIZON_S 4.0f     /* meetings that are further off than this are left alone */
#define SIDEWAYS 1.5f      /* stiffness of passing someone who is about to be met */
#define SIDE_ITERATIONS 2u /* that correct for meetings; all correct for contacts */
#define AWAITED 0.2f       /* of its speed: an agent below this waits */
#define RECOVERY 4u        /* steps of waiting that a step of walking makes up for */

/* What neighbours ask of an agent. */
typedef struct asked {
    vec2 apart, aside;
    uint32_t contacts;
} asked;

/* Two in one place are parted by who they are. */
static vec2 direction_of(uint32_t id, uint32_t other)
{
    const uint32_t low = id < other ? id : other, high = id < other ? other : id;
    uint32_t h = low * 0x9e3779b1u ^ (high * 0x85ebca6bu + 0x7f4a7c15u);
    vec2 d;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    noh_sin_cos_turn(h ^ h >> 13, &d.z, &d.x);
    return id < other ? d : v2(-d.x, -d.z);
}

/* p and u: where one is from the other, and how it moves from there. Before they meet it turns aside, so far that the
 * discs would just pass each other: a wish to be at p + u t, where they are nearest, as far apart as both are wide. */
static void pass(asked *a, vec2 p, vec2 u, float radii, float share)
{
    const float square = v2_dot(u, u), nearing = v2_dot(p, u), clear = v2_dot(p, p) - radii * radii;
    const float root = nearing * nearing - square * clear;
    if (nearing >= 0.0f || root <= 0.0f || clear <= 0.0f) return;
    const float meet = clear / (noh_sqrt(root) - nearing), soon = 1.0f - meet * (1.0f / HORIZON_S);
    if (soon <= 0.0f) return;
    const float nearest = -nearing / square;
    const vec2 miss = v2_madd(p, nearest, u);
    const float by = v2_length(miss), stiff = SIDEWAYS * 2.0f * share * soon * soon * (radii - by) / nearest;
    if (by > 0.1f * radii) {
        a->aside = v2_madd(a->aside, stiff / by, miss);
    } else { /* head on: to the right */
        a->aside = v2_madd(a->aside, stiff / noh_sqrt(square), v2(u.z, -u.x));
    }
}

/* Both have `share` of what keeps them apart to do; who faces one that holds its place has all of it. */
static void part(asked *a, vec2 d, float square, float radii, float share, uint32_t id, uint32_t other)
{
    const float apart = noh_sqrt(square), push = share * (radii * MARGIN - apart) * CROWD_STEPS_PER_S;
    a->apart = apart > 1e-6f ? v2_madd(a->apart, push / apart, d) : v2_madd(a->apart, push, direction_of(id, other));
    a->contacts++;
}

void noh_crowd_iterate(noh_crowd *c, uint32_t rank, uint32_t iteration)
{
    const crowd_body *bodies = CROWD_CONST(crowd_body, c, body), *b = &bodies[rank];
    const vec2 *plans = iteration & 1u ? CROWD_CONST(vec2, c, plan[1]) : CROWD_CONST(vec2, c, plan[0]);
    vec2 *next = iteration & 1u ? CROWD_ARRAY(vec2, c, plan[0]) : CROWD_ARRAY(vec2, c, plan[1]);
    const uint16_t *names = CROWD_CONST(uint16_t, c, neighbor) + (size_t)rank * CROWD_NEIGHBORS;
    const uint32_t *ids = CROWD_CONST(uint32_t, c, id);
    vec2 plan = plans[rank];
    asked a = { { 0.0f, 0.0f }, { 0.0f, 0.0f }, 0 };
    uint32_t first[3], end[3];
    next[rank] = plan;
    if (b->item & CROWD_HOLDS) return;
    noh_crowd_runs(c, b->at, first, end);
    for (uint32_t k = 0; k < CROWD_NEIGHBORS && names[k] != CROWD_NO_NEIGHBOR; k++) {
        const crowd_body *other = &bodies[noh_crowd_rank_of(first, names[k])];
        const vec2 p = v2_sub(b->at, other->at), u = v2_sub(plan, plans[other - bodies]);
        const vec2 d = v2_madd(p, CROWD_STEP_S, u);
        const float radii = b->radius + other->radius, square = v2_dot(d, d);
        const float share = other->item & CROWD_HOLDS ? 1.0f : 0.5f;
        if (square < radii * radii * (MARGIN * MARGIN)) {
            part(&a, d, square, radii, share, ids[b->item], ids[other->item & ~CROWD_HOLDS]);
        } else if (iteration < SIDE_ITERATIONS) {
            pass(&a, p, u, radii, share);
        }
    }
    plan = v2(plan.x + a.aside.x, plan.z + a.aside.z);
    if (a.contacts) plan = v2_madd(plan, OVER / (float)a.contacts, a.apart);
    if (c->obstacle_count) { /* what a wall takes away the neighbours have to know */
        const vec2 to = noh_crowd_keep_out(c, b->at, v2_madd(b->at, CROWD_STEP_S, plan), b->radius);
        plan = v2_scale(v2_sub(to, b->at), CROWD_STEPS_PER_S);
    }
    next[rank] = plan;
}

void noh_crowd_finish(noh_crowd *c, uint32_t rank)
{
    const crowd_body *b = CROWD_CONST(crowd_body, c, body) + rank;
    const uint32_t item = b->item & ~CROWD_HOLDS;
    const float speed = CROWD_CONST(crowd_wish, c, wish)[item].speed, fast = CROWD_FAST * speed;
    uint32_t *waited = CROWD_ARRAY(uint32_t, c, waited) + item;
    vec2 plan = CROWD_CONST(vec2, c, plan[CROWD_ITERATIONS & 1u])[rank];
    const float square = v2_dot(plan, plan);
    if (!(square <= fast * fast)) plan = square > 0.0f ? v2_scale(plan, fast / noh_sqrt(square)) : v2(0.0f, 0.0f);
    const vec2 to = noh_crowd_keep_out(c, b->at, v2_madd(b->at, CROWD_STEP_S, plan), b->radius);
    const vec2 velocity = v2_scale(v2_sub(to, b->at), CROWD_STEPS_PER_S);
    if (v2_dot(velocity, velocity) < AWAITED * AWAITED * speed * speed) {
        if (*waited < 255u) ++*waited;
    } else {
        *waited = *waited > RECOVERY ? *waited - RECOVERY : 0;
    }
    CROWD_ARRAY(vec2, c, velocity)[item] = velocity;
    CROWD_ARRAY(vec2, c, position)[item] = to;
}
