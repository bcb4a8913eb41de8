/* crowd_plan.c: the planned velocity of an agent: towards its goal, past walls, no faster than agents in front allow,
 * and aside if it gets further there.
 *
 * source   Moussaid, Helbing, Theraulaz: How simple rules determine pedestrian behavior and crowd disasters, PNAS 2011
 *          (direction by reachable distance; here a fan of five directions, with the speed that agents in front
 *          allow) */
#include "stage/crowd/crowd_internal.h"
#include "noh/crowd.h"

#define ARRIVE 2.0f       /* per second and metre: speed before a goal; braking starts half a second away */
#define BLEND 0.2f        /* share of the change from the velocity to the wish in one step */
#define HEADWAY_S 0.1f    /* time in which a gap may close */
#define IN_FRONT 0.7f     /* of the radii: agents further aside are not in front */
#define ONCOMING 0.2f     /* of the speed: agents approaching faster are passed, not waited for */
#define ASIDE 0.8f        /* of the speed: an agent that can walk this fast looks for no other direction */
#define LEFT 0.2f         /* weight of a direction to the left, so that most agents pass on the same side */
#define WAIT_STEPS 15.0f  /* steps below a fifth of its speed before an agent pushes */
#define PUSH_STEPS 60.0f  /* steps in which the push grows by the agent's speed */
#define PUSH_MAX 0.4f     /* of the speed */
#define YIELD_WAIT 45u    /* steps of waiting before an agent makes way */
#define YIELD_STEPS 75u   /* steps for which it makes way */
#define YIELD_LEAST 30u   /* agents with fewer steps left are not followed */
#define YIELD_WITHIN 2.5f /* radii of both */
#define AGAINST -0.3f     /* cosine of opposing directions */
#define WAY_X 0.8290376f  /* unit */
#define WAY_Z 0.5591929f

/* The neighbours of an agent. */
typedef struct view {
    vec2 to[CROWD_NEIGHBORS], velocity[CROWD_NEIGHBORS];
    float radii[CROWD_NEIGHBORS]; /* of both */
    uint32_t count;
} view;

static void look(const noh_crowd *c, uint32_t rank, const crowd_runs *runs, view *v)
{
    const crowd_body *bodies = CROWD_CONST(crowd_body, c, body), *b = &bodies[rank];
    const vec2 *velocities = CROWD_CONST(vec2, c, plan[1]);
    const uint16_t *names = CROWD_CONST(uint16_t, c, neighbor) + (size_t)rank * CROWD_NEIGHBORS;
    for (v->count = 0; v->count < CROWD_NEIGHBORS && names[v->count] != CROWD_NO_NEIGHBOR; v->count++) {
        const uint32_t j = noh_crowd_rank_of(runs, names[v->count]);
        v->to[v->count] = v2_sub(bodies[j].at, b->at);
        v->velocity[v->count] = velocities[j];
        v->radii[v->count] = b->radius + bodies[j].radius;
    }
}

/* The speed that agents in front allow. */
static float speed_along(const view *v, vec2 direction, float speed)
{
    float most = speed;
    for (uint32_t k = 0; k < v->count; k++) {
        const float along = v2_dot(v->to[k], direction), across = v2_cross(direction, v->to[k]), r = v->radii[k];
        const float lead = v2_dot(v->velocity[k], direction);
        /* one branch in place of three that nothing predicts */
        if ((along <= 0.0f) | (across * across > IN_FRONT * IN_FRONT * r * r) | (lead < -ONCOMING * speed)) continue;
        const float gap = along - noh_sqrt(r * r - across * across);
        const float may = (lead > 0.0f ? lead : 0.0f) + (gap > 0.0f ? gap : 0.0f) * (1.0f / HEADWAY_S);
        if (may < most) most = may;
    }
    return most;
}

/* The best of five directions, by how far along the wished one they get it. */
static vec2 way_through(const view *v, vec2 direction, float speed, float most)
{
    static const float cosine[4] = { 0.8192f, 0.8192f, 0.342f, 0.342f }; /* 35 and 70 degrees */
    static const float sine[4] = { -0.5736f, 0.5736f, -0.9397f, 0.9397f };
    vec2 best = v2_scale(direction, most);
    float gain = most;
    for (uint32_t k = 0; k < 4u; k++) {
        const float counts = k & 1u ? LEFT : 1.0f;
        if (speed * cosine[k] * counts <= gain) continue; /* even if nobody were there */
        const vec2 try = v2(direction.x * cosine[k] - direction.z * sine[k],
                            direction.x * sine[k] + direction.z * cosine[k]);
        const float go = speed_along(v, try, speed), more = go * cosine[k] * counts;
        if (more > gain) {
            gain = more;
            best = v2_scale(try, go);
        }
    }
    return best;
}

/* Who waits begins to push, and so do the others around: knots come undone. */
static float push_of(float waited)
{
    const float push = (waited - WAIT_STEPS) * (1.0f / PUSH_STEPS);
    return push < 0.0f ? 0.0f : push > PUSH_MAX ? PUSH_MAX : push;
}

/* Slower before the goal, within v^2 / 2a for a braking of its speed per second, and so that it does not pass it. */
static float speed_at(const crowd_wish *w, float distance)
{
    const float slow = ARRIVE * distance;
    return slow < w->speed ? slow : w->speed;
}

/* By a flow field, at full speed, as long as the goal is neither near nor seen. returns 0 where that is not so */
static int is_led(const noh_crowd *c, const crowd_field *field, const crowd_body *b, float distance, float speed,
                  vec2 *direction)
{
    const float near = speed * (1.0f / ARRIVE) + b->radius;
    if (distance < c->reach && distance < near && noh_crowd_sees(c, b->at, field->goal)) return 0;
    return noh_crowd_flow_way(c, field, b->at, direction);
}

/* Towards the goal, past walls; *speed: how fast. returns 0 where it is there */
static int aim_of(noh_crowd *c, const crowd_body *b, const crowd_wish *w, vec2 now, vec2 *direction, float *speed)
{
    const crowd_field *field = noh_crowd_followed(c, CROWD_CONST(uint32_t, c, state)[CROWD_ITEM(b)]);
    const vec2 goal = !field ? w->goal : field->is_built ? field->goal : field->asked;
    float distance = v2_length(v2_sub(goal, b->at));
    *speed = w->speed;
    if (!(w->speed > 0.0f)) return 0;
    if (field && field->is_built && is_led(c, field, b, distance, w->speed, direction)) return 1;
    const int goes = noh_crowd_round(c, b, now, goal, w->speed, direction, &distance);
    *speed = speed_at(w, distance);
    return goes;
}

/* The same, as fast as the ground lets it. */
static int heading_of(noh_crowd *c, const crowd_body *b, const crowd_wish *w, vec2 now, vec2 *direction, float *speed)
{
    if (!aim_of(c, b, w, now, direction, speed)) return 0;
    if (c->ground) *speed *= noh_crowd_ease(c, b->at, *direction);
    return 1;
}

/* Among others. */
static vec2 way_among(const noh_crowd *c, uint32_t rank, const crowd_runs *runs, float waited, vec2 direction,
                      float speed)
{
    const float push = push_of(waited) * speed;
    view v;
    look(c, rank, runs, &v);
    float most = speed_along(&v, direction, speed);
    if (most < push) most = push;
    return most < ASIDE * speed ? way_through(&v, direction, speed, most) : v2_scale(direction, most);
}

/* ---- doors ----
 *
 * When two groups meet in a door that admits one agent at a time, neither can go on, because agents behind push. An
 * agent that has waited makes way if the agents ahead come from its goal's side, have also waited, and have priority;
 * agents of its own side behind it follow. */

/* Where the goal of an agent lies, unit; 0 where it is there. */
static vec2 goal_way(const noh_crowd *c, const crowd_body *b)
{
    const uint32_t item = CROWD_ITEM(b);
    const crowd_field *field = noh_crowd_followed(c, CROWD_CONST(uint32_t, c, state)[item]);
    const vec2 to = v2_sub(field ? field->goal : CROWD_CONST(crowd_wish, c, wish)[item].goal, b->at);
    const float length = v2_length(to);
    return length > 1e-6f ? v2_scale(to, 1.0f / length) : v2(0.0f, 0.0f);
}

/* Of two ways against each other, whose it is: a direction that no door is likely to lie across; else by id. */
static int has_way(vec2 own, vec2 other, uint32_t id, uint32_t other_id)
{
    const float by = WAY_X * (own.x - other.x) + WAY_Z * (own.z - other.z);
    return by * by > 0.01f ? by > 0.0f : id > other_id;
}

/* For how many steps an agent makes way. */
static uint32_t yield_of(const noh_crowd *c, uint32_t rank, const crowd_runs *runs, uint32_t waited)
{
    const crowd_body *bodies = CROWD_CONST(crowd_body, c, body), *b = &bodies[rank];
    const uint32_t *states = CROWD_CONST(uint32_t, c, state), *ids = CROWD_CONST(uint32_t, c, id);
    const uint16_t *names = CROWD_CONST(uint16_t, c, neighbor) + (size_t)rank * CROWD_NEIGHBORS;
    const uint32_t before = states[CROWD_ITEM(b)] >> CROWD_YIELDS_SHIFT & 0xffu;
    const vec2 own = goal_way(c, b);
    if (before || waited < YIELD_WAIT) return before ? before - 1u : 0u;
    for (uint32_t k = 0; k < CROWD_NEIGHBORS && names[k] != CROWD_NO_NEIGHBOR; k++) {
        const crowd_body *other = &bodies[noh_crowd_rank_of(runs, names[k])];
        const uint32_t state = states[CROWD_ITEM(other)], yields = state >> CROWD_YIELDS_SHIFT & 0xffu;
        const vec2 to = v2_sub(other->at, b->at), way = goal_way(c, other);
        const float radii = YIELD_WITHIN * (b->radius + other->radius);
        if (v2_dot(to, to) > radii * radii || v2_dot(to, own) <= 0.0f) continue;
        if (v2_dot(way, own) > 0.0f && yields > YIELD_LEAST) return yields;
        if (v2_dot(way, own) < AGAINST && (state & CROWD_WAITED) >= YIELD_WAIT / 2u && !(other->item & CROWD_HOLDS) &&
            !has_way(own, way, ids[CROWD_ITEM(b)], ids[CROWD_ITEM(other)])) {
            return YIELD_STEPS;
        }
    }
    return 0;
}

/* Back, and to its right. */
static vec2 aside_of(const noh_crowd *c, const crowd_body *b)
{
    const vec2 way = goal_way(c, b);
    return v2(0.6f * way.z - 0.8f * way.x, -0.6f * way.x - 0.8f * way.z);
}

void noh_crowd_plan(noh_crowd *c, uint32_t rank, const crowd_runs *runs)
{
    const crowd_body *b = CROWD_CONST(crowd_body, c, body) + rank;
    const crowd_wish *w = CROWD_CONST(crowd_wish, c, wish) + CROWD_ITEM(b);
    const uint32_t waited = CROWD_CONST(uint32_t, c, state)[CROWD_ITEM(b)] & CROWD_WAITED;
    const vec2 now = CROWD_CONST(vec2, c, plan[1])[rank];
    vec2 direction, wish = v2(0.0f, 0.0f);
    float speed;
    const int goes = heading_of(c, b, w, now, &direction, &speed);
    if (b->item & CROWD_ORCA) {
        if (goes) wish = v2_scale(direction, speed);
        CROWD_ARRAY(vec2, c, plan[0])[rank] = noh_crowd_orca(c, rank, runs, wish, CROWD_FAST * w->speed);
    } else if (b->item & CROWD_FORCES) {
        if (goes) wish = v2_scale(direction, speed);
        CROWD_ARRAY(vec2, c, plan[0])[rank] = noh_crowd_flock(c, rank, runs, wish, w->speed);
    } else {
        if (goes && c->obstacle_count) {
            const uint32_t yields = yield_of(c, rank, runs, waited);
            CROWD_ARRAY(crowd_round, c, round)[CROWD_ITEM(b)].yields = (uint8_t)yields;
            if (yields) direction = aside_of(c, b);
            noh_crowd_turn_round(c, rank, runs, waited);
        }
        if (goes) wish = way_among(c, rank, runs, (float)waited, direction, speed);
        CROWD_ARRAY(vec2, c, plan[0])[rank] = v2_madd(now, BLEND, v2_sub(wish, now));
    }
}
