/* crowd_avoid.c: planned velocities, corrected so that agents pass each other and do not overlap after the step. */
#include "stage/crowd/crowd_internal.h"
#include "noh/base.h"
#include "noh/crowd.h"

#define MARGIN 1.03f       /* of the radii: distance kept between two agents */
#define OVER 1.5f          /* over-relaxation of contacts, whose corrections are averaged */
#define HORIZON_S 4.0f     /* later meetings are ignored */
#define SIDEWAYS 2.0f      /* stiffness of passing a neighbour before a meeting */
#define SIDE_ITERATIONS 1u /* iterations that correct for meetings; all correct for contacts */
#define NEAR 1.5f          /* of the radii: neighbours within this after the planned step may be touched */
#define AWAITED 0.2f       /* of its speed: an agent below this waits */
#define RECOVERY 4u        /* steps of waiting cancelled by a step of walking */
#define WAITED_MAX CROWD_WAITED

/* Corrections by the neighbours of an agent. */
typedef struct asked {
    vec2 apart, aside;
    uint32_t contacts;
} asked;

/* p and u: where one is from the other, and how it moves from there. Before they meet it turns aside, so far that the
 * discs would just pass each other: a wish to be at p + u t, where they are nearest, as far apart as both are wide. */
static void pass(asked *a, vec2 p, vec2 u, float radii, float share)
{
    const float nearing = v2_dot(p, u), square = v2_dot(u, u), clear = v2_dot(p, p) - radii * radii;
    const float root = nearing * nearing - square * clear;
    /* one branch, which is seldom taken, in place of three that nothing predicts */
    if ((nearing >= 0.0f) | (root <= 0.0f) | (clear <= 0.0f)) return;
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
    float direction[2] = { 0.0f, 0.0f };
    if (apart > 1e-6f) {
        a->apart = v2_madd(a->apart, push / apart, d);
    } else {
        noh_crowd_direction_of(id, other, direction);
        a->apart = v2_madd(a->apart, push, v2(direction[0], direction[1]));
    }
    a->contacts++;
}

/* What one neighbour asks, in an iteration that looks at all of them. returns whether it may be touched in this step */
static int ask(asked *a, const noh_crowd *c, const crowd_body *b, const crowd_body *other, vec2 u, int is_side)
{
    const uint32_t *ids = CROWD_CONST(uint32_t, c, id);
    const vec2 p = v2_sub(b->at, other->at), d = v2_madd(p, CROWD_STEP_S, u);
    const float radii = b->radius + other->radius, square = v2_dot(d, d);
    const float share = other->item & CROWD_HOLDS ? 1.0f : 0.5f;
    if (square < radii * radii * (MARGIN * MARGIN)) {
        part(a, d, square, radii, share, ids[CROWD_ITEM(b)], ids[CROWD_ITEM(other)]);
    } else if (is_side && !(b->item & CROWD_FORCES)) {
        pass(a, p, u, radii, share);
    }
    return square < radii * radii * (NEAR * NEAR);
}

NOH_STATIC_ASSERT(CROWD_NEIGHBORS == 8u && !(CROWD_NO_NEIGHBOR & CROWD_CLOSE), crowd_names);

/* Iterations after the last that passes look only at those that it found close. */
static inline int is_alone(const uint16_t *names)
{
    uint64_t four[2];
    memcpy(four, names, sizeof four);
    return !((four[0] | four[1]) & 0x0001000100010001u * CROWD_CLOSE);
}

static vec2 corrected(const noh_crowd *c, const crowd_body *b, vec2 plan, const asked *a)
{
    plan = v2(plan.x + a->aside.x, plan.z + a->aside.z);
    if (a->contacts) plan = v2_madd(plan, OVER / (float)a->contacts, a->apart);
    if (c->obstacle_count) { /* what a wall takes away the neighbours have to know */
        const vec2 to = noh_crowd_keep_out(c, b->at, v2_madd(b->at, CROWD_STEP_S, plan), b->radius);
        plan = v2_scale(v2_sub(to, b->at), CROWD_STEPS_PER_S);
    }
    return plan;
}

/* What is planned for an agent after all that its neighbours ask. */
static vec2 asked_of(noh_crowd *c, uint32_t rank, const crowd_runs *runs, const vec2 *plans, int is_side)
{
    const crowd_body *bodies = CROWD_CONST(crowd_body, c, body), *b = &bodies[rank];
    uint16_t *names = CROWD_ARRAY(uint16_t, c, neighbor) + (size_t)rank * CROWD_NEIGHBORS;
    const vec2 plan = plans[rank];
    asked a = { { 0.0f, 0.0f }, { 0.0f, 0.0f }, 0 };
    for (uint32_t k = 0; k < CROWD_NEIGHBORS && names[k] != CROWD_NO_NEIGHBOR; k++) {
        if (!is_side && !(names[k] & CROWD_CLOSE)) continue;
        const uint32_t j = noh_crowd_rank_of(runs, names[k]);
        const int is_near = ask(&a, c, b, &bodies[j], v2_sub(plan, plans[j]), is_side);
        if (is_side && is_near) names[k] |= CROWD_CLOSE;
    }
    return corrected(c, b, plan, &a);
}

void noh_crowd_iterate(noh_crowd *c, uint32_t begin, uint32_t end, uint32_t iteration)
{
    const crowd_body *bodies = CROWD_CONST(crowd_body, c, body);
    const uint16_t *names = CROWD_CONST(uint16_t, c, neighbor);
    const vec2 *plans = iteration & 1u ? CROWD_CONST(vec2, c, plan[1]) : CROWD_CONST(vec2, c, plan[0]);
    vec2 *next = iteration & 1u ? CROWD_ARRAY(vec2, c, plan[0]) : CROWD_ARRAY(vec2, c, plan[1]);
    const int is_side = iteration < SIDE_ITERATIONS;
    crowd_runs runs;
    runs.until = 0;
    for (uint32_t rank = begin; rank < end; rank++) {
        const int stays = (bodies[rank].item & (CROWD_HOLDS | CROWD_ORCA)) ||
                          (!is_side && is_alone(names + (size_t)rank * CROWD_NEIGHBORS));
        next[rank] = plans[rank];
        if (stays) continue;
        noh_crowd_runs_of(c, rank, &runs);
        next[rank] = asked_of(c, rank, &runs, plans, is_side);
    }
}

void noh_crowd_finish(noh_crowd *c, uint32_t rank)
{
    const crowd_body *b = CROWD_CONST(crowd_body, c, body) + rank;
    const uint32_t item = CROWD_ITEM(b);
    const float speed = CROWD_CONST(crowd_wish, c, wish)[item].speed, fast = CROWD_FAST * speed;
    uint32_t *state = CROWD_ARRAY(uint32_t, c, state) + item, waited = *state & CROWD_WAITED;
    vec2 plan = c->corrected && (CROWD_ITERATIONS & 1u) ? CROWD_CONST(vec2, c, plan[1])[rank]
                                                        : CROWD_CONST(vec2, c, plan[0])[rank];
    const float square = v2_dot(plan, plan);
    if (!(square <= fast * fast)) plan = square > 0.0f ? v2_scale(plan, fast / noh_sqrt(square)) : v2(0.0f, 0.0f);
    const vec2 to = noh_crowd_keep_out(c, b->at, v2_madd(b->at, CROWD_STEP_S, plan), b->radius);
    const vec2 velocity = v2_scale(v2_sub(to, b->at), CROWD_STEPS_PER_S);
    if (v2_dot(velocity, velocity) < AWAITED * AWAITED * speed * speed) {
        waited += waited < WAITED_MAX ? 1u : 0u;
    } else {
        waited -= waited < RECOVERY ? waited : RECOVERY;
    }
    *state = waited | (*state & ~CROWD_WAITED);
    if (c->obstacle_count) {
        const crowd_round *m = CROWD_CONST(crowd_round, c, round) + item;
        *state &= ~(0xffu << CROWD_YIELDS_SHIFT | 3u << CROWD_HAND_SHIFT);
        *state |= (uint32_t)m->yields << CROWD_YIELDS_SHIFT | (uint32_t)m->mode << CROWD_HAND_SHIFT;
    }
    CROWD_ARRAY(vec2, c, velocity)[item] = velocity;
    CROWD_ARRAY(vec2, c, position)[item] = to;
}
