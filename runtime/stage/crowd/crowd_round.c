/* crowd_round.c: walking around obstacles of any shape between an agent and its goal.
 *
 * An agent goes straight where that is free, and past the end of a wall that it sees. Where neither gets it nearer, it
 * keeps a hand on what blocks it and walks along, until it is nearer to its goal than where it began, and the way there
 * is free: each time it lets go it has come nearer, so it arrives wherever a way exists.
 *
 * source   Lumelsky, Stepanov: Path-planning strategies for a point mobile automaton moving amidst unknown obstacles of
 *          arbitrary shape, Algorithmica 1987 */
#include "stage/crowd/crowd_internal.h"
#include "noh/crowd.h"

#define IDLE_STEPS 60u /* without coming nearer, though ends of walls are seen */
#define LEAST 0.2f     /* of its speed: what counts as coming nearer */
#define NEARER 0.05f   /* metres by which it has come nearer when it lets go */
#define CLOSE 1.5f     /* radii: once it has walked round something, what is further away is not in its way */
#define TURNS 24u      /* of 15 degrees each */
#define COSINE 0.96592583f
#define SINE 0.25881905f
#define PROBE 0.5f    /* radii that a direction has to be free for */
#define PROGRESS 0.2f /* cosine of a way that gets nearer */
#define TURN_STEPS 45u
#define TURN_WITHIN 2.5f /* radii of both */
#define ALIKE 1.25f
#define TURN_S \
    0.7f /* what is walked ahead, of the speed that it has in that direction; half a second's is full speed */
#define CREEP 0.15f
#define OTHER -0.3f /* sine of the angle from which on the nearest wall is on the other hand */

enum { GOES = 0, HAND_LEFT, HAND_RIGHT };

static vec2 turned(vec2 v, float cosine, float sine)
{
    return v2(v.x * cosine - v.z * sine, v.x * sine + v.z * cosine);
}

/* If an agent is too wide to stand on its goal: the place next to it; for a goal within a wall, on the agent's side. */
static vec2 place_for(const noh_crowd *c, vec2 goal, float radius, vec2 to)
{
    goal = v2_madd(goal, -1e-3f, to);
    for (int i = 0; i < 2; i++) goal = noh_crowd_keep_out(c, goal, goal, radius);
    return goal;
}

/* The side of the wall to walk on: past the nearer end; if both are about as near, the current direction. */
static uint8_t hand_of(const noh_crowd_obstacle *o, vec2 at, vec2 now, vec2 inward, vec2 goal, float speed)
{
    const float walks = v2_cross(inward, now);
    float ways[2], turn = v2_cross(inward, v2(o->to[0] - o->from[0], o->to[1] - o->from[1]));
    for (int e = 0; e < 2; e++) {
        const vec2 end = e ? v2(o->to[0], o->to[1]) : v2(o->from[0], o->from[1]);
        ways[e] = v2_length(v2_sub(end, at)) + v2_length(v2_sub(goal, end));
    }
    if (ways[0] < ways[1]) turn = -turn;
    if (ways[0] < ALIKE * ways[1] && ways[1] < ALIKE * ways[0] && walks * walks > 0.09f * speed * speed) turn = walks;
    return turn > 0.0f ? HAND_RIGHT : HAND_LEFT;
}

/* Along the wall: the first free direction, turning away from the wall. returns 0 if there is none */
static int along_wall(const noh_crowd *c, const crowd_body *b, crowd_round *m, float speed, vec2 *direction)
{
    const float side = m->mode == HAND_RIGHT ? -1.0f : 1.0f; /* towards the wall */
    const float ahead = 2.0f * speed * CROWD_STEP_S, probe = PROBE * b->radius > ahead ? PROBE * b->radius : ahead;
    vec2 way;
    if (!noh_crowd_nearest(c, b->at, b->radius, NULL, 0.0f, &way)) {
        m->mode = GOES;
        return 0;
    }
    if (side * v2_cross(m->heading, way) < OTHER) way = v2(-side * m->heading.z, side * m->heading.x);
    for (uint32_t i = 0; i < TURNS; i++) {
        if (noh_crowd_is_free(c, b->at, b->radius, way, probe)) {
            const float length = v2_length(way);
            *direction = m->heading = v2_scale(way, 1.0f / length);
            return 1;
        }
        way = turned(way, COSINE, -side * SINE);
    }
    m->heading = v2(0.0f, 0.0f);
    return 0;
}

static void begin(const noh_crowd *c, const crowd_body *b, crowd_round *m, vec2 now, vec2 direction, float distance,
                  float speed)
{
    vec2 inward;
    const noh_crowd_obstacle *o = noh_crowd_nearest(c, b->at, b->radius, &direction, CLOSE * b->radius, &inward);
    if (!o) return;
    m->mode = hand_of(o, b->at, now, inward, v2_madd(b->at, distance, direction), speed);
    m->nearest = distance;
    m->heading = v2(0.0f, 0.0f);
}

/* Past ends that are seen, as long as that gets it nearer: once it has walked round something, each step has to.
 * returns 0 where it does not */
static int past_ends(const noh_crowd *c, const crowd_body *b, crowd_round *m, vec2 to, float distance, float speed,
                     vec2 *direction)
{
    *direction = noh_crowd_detour(c, b->at, b->radius, to, distance);
    if (direction->x == to.x && direction->z == to.z) {
        m->has_gone_round = 1;
        return 0;
    }
    if (m->has_gone_round) return v2_dot(*direction, to) > PROGRESS;
    if (m->idle < UINT8_MAX) m->idle++;
    if (!(m->nearest > 0.0f) || distance < m->nearest) {
        const float steps = (m->nearest - distance) * CROWD_STEPS_PER_S / (LEAST * speed);
        m->idle = m->nearest > 0.0f && steps < (float)m->idle ? (uint8_t)((float)m->idle - steps) : (uint8_t)0;
        m->nearest = distance;
    }
    m->has_gone_round = m->idle > IDLE_STEPS;
    return !m->has_gone_round;
}

/* Leave the wall where the way is free, once nearer to the goal than where following it began. */
static int lets_go(const noh_crowd *c, const crowd_body *b, crowd_round *m, vec2 to, float distance, float speed,
                   int is_free, vec2 *direction)
{
    if (!(distance < m->nearest - NEARER) || (!is_free && !past_ends(c, b, m, to, distance, speed, direction)))
        return 0;
    m->mode = GOES;
    m->idle = 0;
    return 1;
}

int noh_crowd_round(noh_crowd *c, const crowd_body *b, vec2 now, vec2 goal, float speed, vec2 *direction,
                    float *distance)
{
    crowd_round *m = CROWD_ARRAY(crowd_round, c, round) + CROWD_ITEM(b);
    vec2 to = v2_sub(goal, b->at);
    float sees;
    *distance = v2_length(to);
    if (!(*distance > 1e-6f)) return 0;
    *direction = to = v2_scale(to, 1.0f / *distance);
    if (!c->obstacle_count) return 1;
    sees = m->has_gone_round && *distance > CLOSE * b->radius ? CLOSE * b->radius : *distance;
    int is_free = noh_crowd_is_free(c, b->at, b->radius, to, sees);
    const int is_clear = is_free;
    if (!is_free) { /* perhaps the goal itself is too near to a wall */
        to = v2_sub(place_for(c, goal, b->radius, to), b->at);
        *distance = v2_length(to);
        if (!(*distance > NEARER)) return 0;
        *direction = to = v2_scale(to, 1.0f / *distance);
        is_free = noh_crowd_is_free(c, b->at, b->radius, to, sees < *distance ? sees : *distance);
    }
    if (m->mode && lets_go(c, b, m, to, *distance, speed, is_free, direction)) return 1;
    if (!m->mode && is_free) {
        if (!m->has_gone_round && is_clear) *direction = noh_crowd_detour(c, b->at, b->radius, to, *distance);
        return 1;
    }
    if (!m->mode) {
        if (past_ends(c, b, m, to, *distance, speed, direction)) return 1;
        *direction = to;
        begin(c, b, m, now, to, *distance, speed);
    }
    if (!m->mode) return 1;
    if (!along_wall(c, b, m, speed, direction)) return 0;
    sees = v2_dot(now, *direction) * TURN_S; /* round a corner it walks slowly, or it would miss a narrow door */
    sees = sees > CREEP * speed ? sees : CREEP * speed;
    if (sees < *distance) *distance = sees;
    return 1;
}

/* Whether somebody close ahead stays there, or waits and came along the wall the other way. Those ahead who go the same
 * way are a queue: it moves on, as before a door. */
static int is_met(const noh_crowd *c, uint32_t rank, const crowd_runs *runs, const crowd_round *m)
{
    const crowd_body *bodies = CROWD_CONST(crowd_body, c, body), *b = &bodies[rank];
    const uint16_t *names = CROWD_CONST(uint16_t, c, neighbor) + (size_t)rank * CROWD_NEIGHBORS;
    const uint32_t other_hand = HAND_LEFT + HAND_RIGHT - (uint32_t)m->mode;
    for (uint32_t k = 0; k < CROWD_NEIGHBORS && names[k] != CROWD_NO_NEIGHBOR; k++) {
        const crowd_body *other = &bodies[noh_crowd_rank_of(runs, names[k])];
        const uint32_t state = CROWD_CONST(uint32_t, c, state)[CROWD_ITEM(other)];
        const vec2 to = v2_sub(other->at, b->at);
        const float radii = TURN_WITHIN * (b->radius + other->radius);
        const int comes = (state >> CROWD_HAND_SHIFT & 3u) == other_hand && state & CROWD_WAITED;
        if (!comes && !(other->item & CROWD_HOLDS)) continue;
        if (v2_dot(to, to) <= radii * radii && v2_dot(to, m->heading) > 0.0f) return 1;
    }
    return 0;
}

void noh_crowd_turn_round(noh_crowd *c, uint32_t rank, const crowd_runs *runs, uint32_t waited)
{
    const uint32_t item = CROWD_ITEM(CROWD_CONST(crowd_body, c, body) + rank);
    const uint32_t patience = TURN_STEPS + (CROWD_CONST(uint32_t, c, id)[item] * 0x9e3779b9u >> 26);
    crowd_round *m = CROWD_ARRAY(crowd_round, c, round) + item;
    if (!m->mode) return;
    if (waited < TURN_STEPS || !is_met(c, rank, runs, m)) {
        m->idle = 0;
    } else if (++m->idle > patience) {
        m->idle = 0;
        m->mode = (uint8_t)(HAND_LEFT + HAND_RIGHT - m->mode);
        m->heading = v2(0.0f, 0.0f);
    }
}
