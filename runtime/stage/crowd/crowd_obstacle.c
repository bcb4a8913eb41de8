/* crowd_obstacle.c: directions past walls and posts, and out of them. */
#include "stage/crowd/crowd_internal.h"
#include "noh/crowd.h"

#define WALLS 16u /* that a detour looks at: the first of a cell's */

#define HAIR 0.96f /* of the radius: what is kept free where a wall is walked along */

/* An obstacle, widened for an agent's centre. */
typedef struct wall {
    vec2 from, along; /* along: to the other end */
    float per_square; /* 1 over the square of its length; 0 for a post */
    float radius;     /* with the agent's */
} wall;

static inline wall wall_of(const noh_crowd_obstacle *o, float radius)
{
    wall w;
    w.from = v2(o->from[0], o->from[1]);
    w.along = v2_sub(v2(o->to[0], o->to[1]), w.from);
    const float square = v2_dot(w.along, w.along);
    w.per_square = square > 0.0f ? 1.0f / square : 0.0f;
    w.radius = o->radius + radius;
    return w;
}

/* From the nearest point of its middle line. */
static inline vec2 away_from(const wall *w, vec2 at)
{
    const vec2 to = v2_sub(at, w->from);
    float t = v2_dot(to, w->along) * w->per_square;
    t = t < 0.0f ? 0.0f : t > 1.0f ? 1.0f : t;
    return v2_madd(to, -t, w->along);
}

static int holds(const wall *w, vec2 at)
{
    const vec2 away = away_from(w, at);
    return v2_dot(away, away) < w->radius * w->radius;
}

/* Whether an end of the wall is too near to the path. */
static int grazes(const wall *w, vec2 to_end, vec2 direction, float distance)
{
    const float along = v2_dot(to_end, direction), stop = along < 0.0f ? 0.0f : along > distance ? distance : along;
    const vec2 off = v2_madd(to_end, -stop, direction);
    return v2_dot(off, off) < w->radius * w->radius;
}

static int crosses(const wall *w, vec2 at, vec2 direction, float distance)
{
    const vec2 to = v2_sub(w->from, at);
    const float side = v2_cross(direction, to), other = side + v2_cross(direction, w->along);
    const float begin = v2_cross(to, w->along), stop = begin - distance * v2_cross(direction, w->along);
    return (side < 0.0f) != (other < 0.0f) && (begin < 0.0f) != (stop < 0.0f);
}

/* Whether the path from `at` along a unit vector meets the wall. An agent touching the wall may walk along it, or
 * away. */
static int blocks(const wall *w, vec2 at, vec2 direction, float distance)
{
    const vec2 away = away_from(w, at);
    const float square = v2_dot(away, away);
    if (square < w->radius * w->radius) {
        const float inward = v2_dot(away, direction);
        return inward < 0.0f && inward * inward > 0.01f * square;
    }
    const vec2 to = v2_sub(w->from, at), end = v2(to.x + w->along.x, to.z + w->along.z);
    return holds(w, v2_madd(at, distance, direction)) || grazes(w, to, direction, distance) ||
           grazes(w, end, direction, distance) || crosses(w, at, direction, distance);
}

static int is_free(const wall *walls, uint32_t count, vec2 at, vec2 direction, float distance)
{
    for (uint32_t i = 0; i < count; i++) {
        if (blocks(&walls[i], at, direction, distance)) return 0;
    }
    return 1;
}

/* The direction that passes an end of a wall at a distance, on its right (side 1) or left (-1). */
static vec2 tangent(vec2 to_end, float radius, float side)
{
    const float square = v2_dot(to_end, to_end);
    if (!(square > 1e-12f)) return v2(1.0f, 0.0f);
    const float sine2 = square > radius * radius ? radius * radius / square : 1.0f;
    const float sine = noh_sqrt(sine2) * side, cosine = noh_sqrt(1.0f - sine2), per = 1.0f / noh_sqrt(square);
    return v2((to_end.x * cosine - to_end.z * sine) * per, (to_end.x * sine + to_end.z * cosine) * per);
}

/* The direction with the smallest turn past an end of a wall within reach, free up to the end. */
static vec2 way_past(const wall *walls, uint32_t count, vec2 at, vec2 direction, float distance, float reach)
{
    vec2 way = direction;
    float best = -2.0f;
    for (uint32_t i = 0; i < 4u * count; i++) { /* each end, on each side */
        const wall *w = &walls[i / 4u];
        const vec2 to = v2_sub(i & 1u ? v2(w->from.x + w->along.x, w->from.z + w->along.z) : w->from, at);
        const vec2 try = tangent(to, w->radius * 1.1f, i & 2u ? 1.0f : -1.0f);
        const float along = v2_dot(try, direction), far = v2_length(to);
        if (far <= reach && along > best && is_free(walls, count, at, try, far < distance ? far : distance)) {
            best = along;
            way = try;
        }
    }
    return way;
}

uint32_t noh_crowd_near_of(const noh_crowd *c, vec2 at, const uint16_t **near)
{
    const uint32_t *start = CROWD_CONST(uint32_t, c, near_start);
    uint32_t column, row;
    if (!c->obstacle_count) return 0;
    const uint32_t cell = noh_crowd_cell_at(&c->cells, at, &column, &row);
    *near = CROWD_CONST(uint16_t, c, near) + start[cell];
    return start[cell + 1u] - start[cell];
}

vec2 noh_crowd_away_from(const noh_crowd_obstacle *o, vec2 at)
{
    const wall w = wall_of(o, 0.0f);
    return away_from(&w, at);
}

int noh_crowd_sees(const noh_crowd *c, vec2 from, vec2 to)
{
    const noh_crowd_obstacle *obstacles = CROWD_CONST(noh_crowd_obstacle, c, obstacle);
    const uint16_t *near = NULL;
    const uint32_t count = noh_crowd_near_of(c, from, &near);
    const vec2 way = v2_sub(to, from);
    const float distance = v2_length(way);
    if (!(distance > 0.0f)) return 1;
    for (uint32_t k = 0; k < count; k++) {
        const wall w = wall_of(&obstacles[near[k]], 0.0f);
        if (blocks(&w, from, v2_scale(way, 1.0f / distance), distance)) return 0;
    }
    return 1;
}

vec2 noh_crowd_detour(const noh_crowd *c, vec2 at, float radius, vec2 direction, float distance)
{
    const noh_crowd_obstacle *obstacles = CROWD_CONST(noh_crowd_obstacle, c, obstacle);
    const uint16_t *near = NULL;
    wall walls[WALLS];
    uint32_t count = noh_crowd_near_of(c, at, &near);
    if (!count) return direction;
    if (count > WALLS) count = WALLS;
    for (uint32_t k = 0; k < count; k++) walls[k] = wall_of(&obstacles[near[k]], radius);
    if (distance > c->reach) distance = c->reach;
    return is_free(walls, count, at, direction, distance) ? direction
                                                          : way_past(walls, count, at, direction, distance, c->reach);
}

const noh_crowd_obstacle *noh_crowd_nearest(const noh_crowd *c, vec2 at, float radius, const vec2 *direction,
                                            float distance, vec2 *inward)
{
    const noh_crowd_obstacle *obstacles = CROWD_CONST(noh_crowd_obstacle, c, obstacle), *found = NULL;
    const uint16_t *near = NULL;
    const uint32_t count = noh_crowd_near_of(c, at, &near);
    float least = 0.0f;
    for (uint32_t k = 0; k < count; k++) {
        const wall w = wall_of(&obstacles[near[k]], radius);
        const vec2 away = away_from(&w, at);
        const float length = v2_length(away), space = length - w.radius;
        if ((found && space >= least) || !(length > 1e-6f)) continue;
        if (direction && !blocks(&w, at, *direction, distance)) continue;
        found = &obstacles[near[k]];
        least = space;
        if (inward) *inward = v2_scale(away, -1.0f / length);
    }
    return found;
}

int noh_crowd_is_free(const noh_crowd *c, vec2 at, float radius, vec2 direction, float distance)
{
    const noh_crowd_obstacle *obstacles = CROWD_CONST(noh_crowd_obstacle, c, obstacle);
    const uint16_t *near = NULL;
    const uint32_t count = noh_crowd_near_of(c, at, &near);
    if (distance > c->reach) distance = c->reach;
    for (uint32_t k = 0; k < count; k++) {
        const wall w = wall_of(&obstacles[near[k]], HAIR * radius);
        if (blocks(&w, at, direction, distance)) return 0;
    }
    return 1;
}

/* Keep an agent on its side of a wall, however far it was pushed. */
vec2 noh_crowd_keep_out(const noh_crowd *c, vec2 from, vec2 to, float radius)
{
    const noh_crowd_obstacle *obstacles = CROWD_CONST(noh_crowd_obstacle, c, obstacle);
    const uint16_t *near = NULL;
    const uint32_t count = noh_crowd_near_of(c, from, &near);
    for (uint32_t k = 0; k < count; k++) {
        const wall w = wall_of(&obstacles[near[k]], radius);
        const vec2 before = away_from(&w, from);
        vec2 away = away_from(&w, to);
        const int through = v2_dot(away, before) < 0.0f;
        float square = v2_dot(away, away);
        if (!through && square >= w.radius * w.radius) continue;
        const vec2 nearest = v2_sub(to, away);
        float wanted = through ? -w.radius : w.radius;
        if (square < 1e-12f) { /* on the line itself: back to where it came from */
            away = before;
            square = v2_dot(before, before);
            wanted = w.radius;
        }
        if (square >= 1e-12f) to = v2_madd(nearest, wanted / noh_sqrt(square), away);
    }
    return to;
}
