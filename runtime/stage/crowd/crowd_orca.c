/* crowd_orca.c: optimal reciprocal collision avoidance: of all velocities at which an agent and each of its neighbours,
 * each doing half, do not meet within a time, the one nearest to its wish.
 *
 * source   van den Berg, Guy, Lin, Manocha: Reciprocal n-Body Collision Avoidance, ISRR 2009; de Berg and others:
 *          Computational Geometry, 2008, section 4.4 (linear programs of low dimension, one half plane after the other)
 */
#include "stage/crowd/crowd_internal.h"
#include "noh/crowd.h"

#define HORIZON_S 4.0f
#define PARALLEL 1e-5f

/* Allowed velocities lie to the left of a line. */
typedef struct line {
    vec2 point, along; /* along: unit */
} line;

/* The half plane allowed by a neighbour. p: from here to it; v and other: velocities. */
static line line_of(vec2 p, vec2 v, vec2 other, float radii)
{
    const vec2 u = v2_sub(v, other);
    const float square = v2_dot(p, p), far = square - radii * radii;
    const float rate = far > 0.0f ? 1.0f / HORIZON_S : CROWD_STEPS_PER_S; /* who overlaps parts within the step */
    const vec2 w = v2_madd(u, -rate, p);
    const float along = v2_dot(w, p), length2 = v2_dot(w, w);
    line l;
    vec2 change;
    if (far <= 0.0f || (along < 0.0f && along * along > radii * radii * length2)) { /* the round end of the cone */
        const float length = noh_sqrt(length2);
        const vec2 unit = length > 1e-9f ? v2_scale(w, 1.0f / length) : v2(1.0f, 0.0f);
        l.along = v2(unit.z, -unit.x);
        change = v2_scale(unit, radii * rate - length);
    } else { /* one of its sides */
        const float side = noh_sqrt(far), per = 1.0f / square;
        l.along = v2_cross(p, w) > 0.0f ? v2((p.x * side - p.z * radii) * per, (p.x * radii + p.z * side) * per)
                                        : v2(-(p.x * side + p.z * radii) * per, (p.x * radii - p.z * side) * per);
        change = v2_sub(v2_scale(l.along, v2_dot(u, l.along)), u);
    }
    l.point = v2_madd(v, 0.5f, change);
    return l;
}

/* On lines[at], within the ones before it and the circle of `fast`: the point nearest to `wish`, or, where `wish` is a
 * direction, furthest along it. returns 0 where there is none */
static int on_line(const line *lines, uint32_t at, float fast, vec2 wish, int is_direction, vec2 *result)
{
    const line *l = &lines[at];
    const float middle = v2_dot(l->point, l->along);
    const float root = middle * middle + fast * fast - v2_dot(l->point, l->point);
    float low, high, t;
    if (root < 0.0f) return 0;
    low = -middle - noh_sqrt(root);
    high = -middle + noh_sqrt(root);
    for (uint32_t i = 0; i < at; i++) {
        const float down = v2_cross(l->along, lines[i].along);
        const float up = v2_cross(lines[i].along, v2_sub(l->point, lines[i].point));
        if (down <= PARALLEL && down >= -PARALLEL) {
            if (up < 0.0f) return 0;
            continue;
        }
        t = up / down;
        if (down > 0.0f)
            high = t < high ? t : high;
        else
            low = t > low ? t : low;
        if (low > high) return 0;
    }
    t = is_direction ? (v2_dot(wish, l->along) > 0.0f ? high : low) : v2_dot(l->along, v2_sub(wish, l->point));
    *result = v2_madd(l->point, t < low ? low : t > high ? high : t, l->along);
    return 1;
}

/* returns count if there is a solution, otherwise the line where it failed; *result is then the best before this
 * line */
static uint32_t within_all(const line *lines, uint32_t count, float fast, vec2 wish, int is_direction, vec2 *result)
{
    const float square = v2_dot(wish, wish);
    *result = is_direction           ? v2_scale(wish, fast)
              : square > fast * fast ? v2_scale(wish, fast / noh_sqrt(square))
                                     : wish;
    for (uint32_t i = 0; i < count; i++) {
        const vec2 before = *result;
        if (v2_cross(lines[i].along, v2_sub(lines[i].point, before)) <= 0.0f) continue;
        if (!on_line(lines, i, fast, wish, is_direction, result)) {
            *result = before;
            return i;
        }
    }
    return count;
}

/* The line of points equally far on the wrong side of both. returns 0 if none is needed */
static int between(const line *a, const line *b, line *out)
{
    const float cross = v2_cross(a->along, b->along);
    if (cross <= PARALLEL && cross >= -PARALLEL) {
        if (v2_dot(a->along, b->along) > 0.0f) return 0;
        out->point = v2_scale(v2_madd(a->point, 1.0f, b->point), 0.5f);
    } else {
        out->point = v2_madd(a->point, v2_cross(b->along, v2_sub(a->point, b->point)) / cross, a->along);
    }
    const vec2 turn = v2_sub(b->along, a->along);
    const float length = v2_length(turn);
    if (!(length > 0.0f)) return 0;
    out->along = v2_scale(turn, 1.0f / length);
    return 1;
}

/* If no velocity satisfies all lines: the velocity with the smallest largest violation. */
static void least_bad(const line *lines, uint32_t count, uint32_t from, float fast, vec2 *result)
{
    float worst = 0.0f;
    for (uint32_t i = from; i < count; i++) {
        line bounds[CROWD_NEIGHBORS];
        uint32_t bound_count = 0;
        const vec2 before = *result;
        if (v2_cross(lines[i].along, v2_sub(lines[i].point, before)) <= worst) continue;
        for (uint32_t j = 0; j < i; j++) bound_count += between(&lines[i], &lines[j], &bounds[bound_count]) ? 1u : 0u;
        if (within_all(bounds, bound_count, fast, v2(-lines[i].along.z, lines[i].along.x), 1, result) < bound_count) {
            *result = before; /* by rounding alone: it is there already */
        }
        worst = v2_cross(lines[i].along, v2_sub(lines[i].point, *result));
    }
}

vec2 noh_crowd_orca(const noh_crowd *c, uint32_t rank, const crowd_runs *runs, vec2 wish, float fast)
{
    const crowd_body *bodies = CROWD_CONST(crowd_body, c, body), *b = &bodies[rank];
    const vec2 *velocities = CROWD_CONST(vec2, c, plan[1]);
    const uint16_t *names = CROWD_CONST(uint16_t, c, neighbor) + (size_t)rank * CROWD_NEIGHBORS;
    line lines[CROWD_NEIGHBORS];
    uint32_t count;
    vec2 result;
    for (count = 0; count < CROWD_NEIGHBORS && names[count] != CROWD_NO_NEIGHBOR; count++) {
        const uint32_t j = noh_crowd_rank_of(runs, names[count]);
        lines[count] = line_of(v2_sub(bodies[j].at, b->at), velocities[rank], velocities[j],
                               b->radius + bodies[j].radius);
    }
    const uint32_t solved = within_all(lines, count, fast, wish, 0, &result);
    if (solved < count) least_bad(lines, count, solved, fast, &result);
    return result;
}
