/* hair_lanes.c: a step of control hairs that follow their roots, and the result between two steps, for as many hairs as
 * there are lanes. Along a hair each point depends on the previous one; hairs are independent of each other. A lane
 * without work keeps its bits, so the width does not matter. */
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_life.h"

#include "core/base/assert_internal.h"
#include "core/base/compiler_internal.h"
#include "life/hair/hair_internal.h"
#include "life/physics/lanes3_internal.h"
#include "core/base/vector_internal.h"

#define FOLLOW 0.9f     /* share of a point's correction that is removed from the velocity of the previous one */
#define SPEED_MAX 20.0f /* metres per second; exceeded only after a teleport without reset */
#define PASSES 4        /* over spheres that overlap */
#define SEAM 0.02f      /* share of a sphere's squared radius that hair may be inside of it where another overlaps it */
#define GUST_STEPS 24u  /* between values of the noise: 0.4 s */
#define BEND 2.6f       /* radians that a hair bends at most from root to tip, more than at rest: no loops */
#define LEAN_ROOT 0.98f /* the least cosine of a segment and itself at rest, at the root */
#define LEAN_TIP 2.3f   /* less by this at the tip, which may point anywhere */
#define ROW 10u         /* floats per point */
NOH_STATIC_ASSERT(sizeof(noh_hair_point) == ROW * sizeof(float), point_row);

typedef union per_lane {
    lanes v;
    float f[NOH_LANES];
} per_lane;

/* As many hairs as there are lanes; lanes without a hair read the last one and write nothing. */
typedef struct group {
    uint32_t first, used;
    uint32_t at[NOH_LANES]; /* index of the first point of each */
} group;

static group group_of(const noh_hair *h, uint32_t first)
{
    group g;
    g.first = first;
    g.used = h->hair_count - first < NOH_LANES ? h->hair_count - first : NOH_LANES;
    for (uint32_t lane = 0; lane < NOH_LANES; lane++) {
        g.at[lane] = (first + (lane < g.used ? lane : g.used - 1u)) * h->point_count;
    }
    return g;
}

/* ---- rows in and out ---- */

NOH_ALWAYS_INLINE lane3 lane3_of(const lanes v[3])
{
    const lane3 r = { v[0], v[1], v[2] };
    return r;
}

NOH_ALWAYS_INLINE void load_points(const group *g, const noh_hair_point *points, uint32_t i, lanes out[ROW])
{
    const float *rows[NOH_LANES];
    for (uint32_t lane = 0; lane < NOH_LANES; lane++) rows[lane] = points[g->at[lane] + i].now;
    lanes_gather(rows, 0, out);
    lanes_gather(rows, 4, out + 4);
    lanes last[4];
    lanes_gather(rows, 6, last);
    out[8] = last[2];
    out[9] = last[3];
}

NOH_ALWAYS_INLINE void store_points(const group *g, const lanes row[ROW], noh_hair_point *points, uint32_t i)
{
    float *rows[NOH_LANES], nowhere[ROW];
    for (uint32_t lane = 0; lane < NOH_LANES; lane++) {
        rows[lane] = lane < g->used ? points[g->at[lane] + i].now : nowhere;
    }
    lanes_scatter(row, rows, 0);
    lanes_scatter(row + 4, rows, 4);
    lanes_scatter(row + 6, rows, 6);
}

/* Load point i, from 1 on, of each: four floats end with it. */
NOH_ALWAYS_INLINE lane3 load_rest(const group *g, const float *rest, uint32_t i)
{
    const float *rows[NOH_LANES];
    lanes out[4];
    for (uint32_t lane = 0; lane < NOH_LANES; lane++) rows[lane] = rest + 3u * (size_t)(g->at[lane] + i) - 1u;
    lanes_gather(rows, 0, out);
    return lane3_of(out + 1);
}

NOH_ALWAYS_INLINE lane3 load_roots(const group *g, const float *rest)
{
    const float *rows[NOH_LANES];
    lanes out[4];
    for (uint32_t lane = 0; lane < NOH_LANES; lane++) rows[lane] = rest + 3u * (size_t)g->at[lane];
    lanes_gather(rows, 0, out);
    return lane3_of(out);
}

/* ---- spheres ---- */

/* The spheres for each hair: no larger than to its root. */
typedef struct obstacles {
    uint32_t count;
    const noh_hair_sphere *spheres;
    float middle[3];
    lanes square[NOH_HAIR_SPHERES_MAX]; /* of the radius */
} obstacles;

static void find_obstacles(const group *g, const noh_hair_desc *d, obstacles *o)
{
    const lane3 roots = load_roots(g, d->rest);
    o->count = d->sphere_count;
    o->spheres = d->spheres;
    o->middle[0] = o->middle[1] = o->middle[2] = 0.0f;
    for (uint32_t i = 0; i < o->count; i++) {
        const noh_hair_sphere *s = &d->spheres[i];
        const lane3 way = lane3_sub(lane3_set(s->centre), roots);
        o->square[i] = lanes_min(lane3_dot(way, way), lanes_set(s->radius * s->radius));
        noh_madd3(o->middle, 1.0f / (float)o->count, s->centre, o->middle);
    }
}

/* Hair that points straight at a centre turns to an arbitrary side, one lane at a time. */
static NOH_NEVER_INLINE lane3 any_side(lanes mask, lane3 way, lane3 side)
{
    static const float up[3] = { 0.0f, 1.0f, 0.0f };
    const per_lane straight = { lanes_choose(mask, lanes_set(1.0f), lanes_set(0.0f)) };
    per_lane w[3] = { { way.x }, { way.y }, { way.z } }, out[3] = { { side.x }, { side.y }, { side.z } };
    for (uint32_t lane = 0; lane < NOH_LANES; lane++) {
        const float v[3] = { w[0].f[lane], w[1].f[lane], w[2].f[lane] };
        float to[3];
        if (straight.f[lane] == 0.0f) continue;
        noh_perpendicular3(v, up, to);
        for (int i = 0; i < 3; i++) out[i].f[lane] = to[i];
    }
    const lane3 r = { out[0].v, out[1].v, out[2].v };
    return r;
}

/* Turn directions away from a sphere until the point at `length` along them from `head` is outside the sphere. The
 * heads are outside, so such a direction always exists; lengths do not change. Returns the lanes that were inside, and
 * adds those that were deep inside: turns away from spheres that overlap only approach the seam between them. */
NOH_ALWAYS_INLINE lanes turn_away(const obstacles *o, uint32_t i, lane3 head, lanes length, lane3 *direction,
                                  lanes *deep)
{
    const lanes zero = lanes_set(0.0f), one = lanes_set(1.0f), twice = lanes_add(length, length);
    lane3 way = lane3_sub(lane3_set(o->spheres[i].centre), head);
    const lanes square = lane3_dot(way, way);
    const lanes reach = lanes_sub(lanes_add(lanes_mul(length, length), square), o->square[i]);
    const lanes toward = lanes_mul(twice, lane3_dot(*direction, way));
    const lanes in = lanes_and(lanes_less(reach, toward), lanes_less(zero, square));
    if (!lanes_any(in)) return in;
    const lanes inverse = lanes_inverse_root(in, square);
    const lanes most = lanes_mul(lanes_div(reach, twice), inverse), hit = lanes_and(in, lanes_less(most, one));
    way = lane3_scale(way, inverse);
    lane3 side = lane3_madd(*direction, lanes_negate(lane3_dot(*direction, way)), way);
    const lanes across = lane3_dot(side, side), is_aside = lanes_less(lanes_set(1e-8f), across);
    side = lane3_scale(side, lanes_inverse_root(is_aside, across));
    const lanes straight = lanes_choose(is_aside, zero, hit);
    if (lanes_any(straight)) side = any_side(straight, way, side);
    const lanes cosine = lanes_max(most, lanes_set(-1.0f)), rest = lanes_sub(one, lanes_mul(cosine, cosine));
    const lanes sine = lanes_sqrt(lanes_max(rest, zero));
    *direction = lane3_choose(hit, lane3_madd(lane3_scale(way, cosine), sine, side), *direction);
    const lanes depth = lanes_sub(toward, reach), seam = lanes_mul(lanes_set(SEAM), o->square[i]);
    *deep = lanes_or(*deep, lanes_and(hit, lanes_less(seam, depth)));
    return hit;
}

NOH_ALWAYS_INLINE lane3 unit_or(lane3 v, lane3 fallback)
{
    const lanes square = lane3_dot(v, v), is_long = lanes_less(lanes_set(1e-30f), square);
    return lane3_choose(is_long, lane3_scale(v, lanes_inverse_root(is_long, square)), fallback);
}

/* Put points at their lengths from the previous ones, as near as possible to where they are, outside of all spheres. */
NOH_ALWAYS_INLINE lane3 follow(const obstacles *o, lane3 head, lanes length, lane3 p)
{
    static const float down[3] = { 0.0f, -1.0f, 0.0f };
    lane3 direction = unit_or(lane3_sub(p, head), lane3_set(down));
    const lanes none = lanes_less(lanes_set(0.0f), lanes_set(0.0f));
    lanes turned = lanes_less(lanes_set(0.0f), lanes_set(1.0f)), deep = none;
    for (int pass = 0; pass < PASSES && lanes_any(turned); pass++) {
        turned = deep = none;
        for (uint32_t i = 0; i < o->count; i++) {
            turned = lanes_or(turned, turn_away(o, i, head, length, &direction, &deep));
        }
    }
    if (o->count > 1u && lanes_any(deep)) { /* between spheres: away from all of them */
        const lane3 away = unit_or(lane3_sub(head, lane3_set(o->middle)), lane3_set(down));
        direction = lane3_choose(deep, away, direction);
    }
    return lane3_madd(head, length, direction);
}

/* A point whose segment leans farther from an axis than this cosine is put on the cone about it. */
NOH_ALWAYS_INLINE lane3 within_cone(lane3 head, lanes length, lane3 axis, lanes least, lane3 p)
{
    const lane3 direction = unit_or(lane3_sub(p, head), axis);
    const lanes cosine = lane3_dot(direction, axis), outside = lanes_less(cosine, least);
    if (!lanes_any(outside)) return p;
    const lane3 side = unit_or(lane3_madd(direction, lanes_negate(cosine), axis), direction);
    const lanes sine = lanes_sqrt(lanes_max(lanes_sub(lanes_set(1.0f), lanes_mul(least, least)), lanes_set(0.0f)));
    return lane3_choose(outside, lane3_madd(head, length, lane3_madd(lane3_scale(axis, least), sine, side)), p);
}

/* ---- gusts ---- */

static uint32_t scramble(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ x >> 16;
}

/* Value noise, 0..1, from a seed, a hair and time, smooth in time. Hairs with neighbouring indices share half of it. */
static float gust(uint32_t seed, uint32_t hair, uint32_t steps)
{
    const uint32_t at = steps / GUST_STEPS;
    const float t = (float)(steps % GUST_STEPS) / (float)GUST_STEPS, smooth = t * t * (3.0f - 2.0f * t);
    float sum = 0.0f;
    for (uint32_t of = 0; of < 2u; of++) {
        const uint32_t own = scramble(seed + (of ? 0x9e3779b9u * (hair + 1u) : 0u));
        const float a = (float)(scramble(own + at) >> 8), b = (float)(scramble(own + at + 1u) >> 8);
        sum += (a + smooth * (b - a)) * (0.5f / 16777216.0f);
    }
    return sum;
}

/* ---- one step ---- */

static lane3 force_on(const group *g, const noh_hair *h, const noh_hair_desc *d, const noh_hair_motion *m)
{
    per_lane share;
    for (uint32_t lane = 0; lane < NOH_LANES; lane++) share.f[lane] = 2.0f * gust(d->seed, g->first + lane, h->steps);
    return lane3_madd(lane3_set(m->gravity), share.v, lane3_set(m->wind));
}

NOH_ALWAYS_INLINE lane3 turned_by(const noh_hair_motion *m, lane3 v)
{
    const lane3 x = lane3_scale(lane3_set(m->turn[0]), v.x);
    return lane3_madd(lane3_madd(x, v.y, lane3_set(m->turn[1])), v.z, lane3_set(m->turn[2]));
}

NOH_ALWAYS_INLINE lane3 limited(lane3 velocity)
{
    const lanes square = lane3_dot(velocity, velocity), most = lanes_set(SPEED_MAX);
    const lanes fast = lanes_less(lanes_mul(most, most), square);
    if (!lanes_any(fast)) return velocity;
    return lane3_choose(fast, lane3_scale(velocity, lanes_mul(most, lanes_inverse_root(fast, square))), velocity);
}

NOH_ALWAYS_INLINE void put3(lanes out[3], lane3 v)
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

static void step_group(const group *g, noh_hair *h, const noh_hair_desc *d, const noh_hair_motion *m)
{
    const lanes seconds = lanes_set(NOH_HAIR_STEP_SECONDS), per_second = lanes_set(1.0f / NOH_HAIR_STEP_SECONDS);
    const lane3 push = lane3_scale(force_on(g, h, d, m), seconds), moved = lane3_set(m->moved);
    noh_hair_point *points = noh_hair_points_of(h);
    lanes row[ROW], last[ROW];
    lane3 rest_before = load_roots(g, d->rest), shape_before = lane3_set(m->gravity), previous = shape_before;
    const float bend = BEND / (float)(h->point_count - 1u);
    const lanes cosine_lost = lanes_set(0.5f * bend * bend);
    obstacles o;
    find_obstacles(g, d, &o);
    load_points(g, points, 0, last);
    for (uint32_t i = 1; i < h->point_count; i++) {
        const float t = (float)i / (float)(h->point_count - 1u), pull = d->pull + t * (d->pull_at_tip - d->pull);
        load_points(g, points, i, row);
        const lane3 now = lane3_of(row), stood = lane3_add(moved, turned_by(m, now));
        const lane3 velocity = lane3_madd(push, lanes_set(m->keep), turned_by(m, lane3_of(row + 6)));
        const lane3 goal = lane3_madd(stood, seconds, velocity);
        const lane3 rest = load_rest(g, d->rest, i);
        const lane3 free_at = lane3_madd(goal, lanes_set(pull), lane3_sub(rest, goal));
        const lanes inverse = lanes_div(lanes_set(1.0f), row[9]);
        const lane3 shape = lane3_scale(lane3_sub(rest, rest_before), inverse);
        if (i == 1u) previous = shape_before = shape;
        const lanes least = lanes_max(lanes_sub(lane3_dot(shape, shape_before), cosine_lost), lanes_set(-1.0f));
        const lanes lean = lanes_set(LEAN_ROOT - t * t * LEAN_TIP);
        const lane3 combed = within_cone(lane3_of(last), row[9], shape, lean, free_at);
        const lane3 bent = within_cone(lane3_of(last), row[9], previous, least, combed);
        const lane3 to = follow(&o, lane3_of(last), row[9], bent);
        previous = lane3_scale(lane3_sub(to, lane3_of(last)), inverse);
        shape_before = shape;
        rest_before = rest;
        put3(row, to);
        put3(row + 3, now);
        put3(row + 6, lane3_scale(lane3_sub(to, stood), per_second));
        if (i > 1u) {
            const lane3 correction = lane3_sub(to, bent);
            const lanes share = lanes_set(-FOLLOW / NOH_HAIR_STEP_SECONDS);
            put3(last + 6, limited(lane3_madd(lane3_of(last + 6), share, correction)));
            store_points(g, last, points, i - 1u);
        }
        for (uint32_t c = 0; c < ROW; c++) last[c] = row[c];
    }
    put3(last + 6, limited(lane3_of(last + 6)));
    store_points(g, last, points, h->point_count - 1u);
}

static void step_all(noh_hair *h, const noh_hair_desc *d, const noh_hair_carrier *carrier, float t)
{
    noh_hair_carrier at;
    noh_hair_motion motion;
    noh_hair_carry(h, d, carrier, t, &at, &motion);
    for (uint32_t first = 0; first < h->hair_count; first += NOH_LANES) {
        const group g = group_of(h, first);
        step_group(&g, h, d, &motion);
    }
    h->stepped = at;
    h->steps++;
}

uint32_t NOH_HAIR_STEP(noh_hair *hair, const noh_hair_desc *desc, const noh_hair_carrier *carrier, uint32_t ticks)
{
    NOH_ASSERT(hair && desc && carrier && desc->hair_count == hair->hair_count &&
               desc->point_count == hair->point_count);
    const noh_hair_carrier to = noh_hair_carries(carrier) ? *carrier : hair->last;
    const uint64_t whole = ((uint64_t)hair->left + ticks) / NOH_HAIR_STEP_TICKS;
    const uint32_t steps = whole < NOH_HAIR_STEPS_MAX ? (uint32_t)whole : NOH_HAIR_STEPS_MAX;
    const uint32_t dropped = (uint32_t)(whole - steps) * NOH_HAIR_STEP_TICKS, kept = ticks - dropped;
    for (uint32_t i = 1; i <= steps; i++) {
        step_all(hair, desc, &to, (float)(i * NOH_HAIR_STEP_TICKS - hair->left) / (float)kept);
    }
    hair->left += kept - steps * NOH_HAIR_STEP_TICKS;
    hair->last = to;
    return dropped;
}

/* ---- results ---- */

static void show_group(const group *g, const noh_hair *h, const noh_hair_desc *d, float *points)
{
    const lanes t = lanes_set((float)h->left / (float)NOH_HAIR_STEP_TICKS);
    const noh_hair_point *from = noh_hair_const_points_of(h);
    lane3 head = load_roots(g, d->rest);
    obstacles o;
    find_obstacles(g, d, &o);
    for (uint32_t lane = 0; lane < g->used; lane++) {
        memcpy(points + 3u * (size_t)g->at[lane], d->rest + 3u * (size_t)g->at[lane], 3 * sizeof *points);
    }
    for (uint32_t i = 1; i < h->point_count; i++) {
        float *to[NOH_LANES], nowhere[4];
        lanes row[ROW];
        load_points(g, from, i, row);
        const lane3 now = lane3_of(row), before = lane3_of(row + 3);
        const lane3 at = follow(&o, head, row[9], lane3_madd(before, t, lane3_sub(now, before)));
        const lanes out[4] = { head.z, at.x, at.y, at.z };
        for (uint32_t lane = 0; lane < NOH_LANES; lane++) {
            to[lane] = lane < g->used ? points + 3u * (size_t)(g->at[lane] + i) - 1u : nowhere;
        }
        lanes_scatter(out, to, 0);
        head = at;
    }
}

void NOH_HAIR_POINTS(const noh_hair *hair, const noh_hair_desc *desc, float *points)
{
    NOH_ASSERT(hair && desc && points && desc->hair_count == hair->hair_count);
    for (uint32_t first = 0; first < hair->hair_count; first += NOH_LANES) {
        const group g = group_of(hair, first);
        show_group(&g, hair, desc, points);
    }
}
