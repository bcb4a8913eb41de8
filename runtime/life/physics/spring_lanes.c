/* spring_lanes.c: the reference's algorithm at a fixed rate, and the result between two steps, for as many chains as
 * there are lanes.
 *
 * A finished lane keeps its bits, so chains of different lengths, times and colliders are stepped together in any
 * combination. Colliders that no joint of a group can reach are skipped: a joint's end is no farther from the chain's
 * start than the total length of the bones up to it. */
#include "noh/base.h"
#include "noh/low_core.h"
#include "noh/low_life.h"

#include "core/base/assert_internal.h"
#include "core/base/compiler_internal.h"
#include "life/physics/lanes3_internal.h"
#include "life/physics/spring_internal.h"
#include "core/base/vector_internal.h"

#define STEP_SECONDS ((float)NOH_SPRING_STEP_TICKS / 48000.0f)
#define ROW 7u         /* floats of a point, a carrier and a collider */
#define JOINT_ROW 13u  /* of a joint */
#define BEYOND 1.0001f /* margin on reach, for rounding */
#define FAR_AWAY 1e15f /* position of a collider that a lane does not have */
NOH_STATIC_ASSERT(sizeof(noh_spring_point) == ROW * sizeof(float), point_row);
NOH_STATIC_ASSERT(sizeof(noh_spring_carrier) == ROW * sizeof(float), carrier_row);
NOH_STATIC_ASSERT(sizeof(noh_spring_collider) == ROW * sizeof(float), collider_row);
NOH_STATIC_ASSERT(sizeof(noh_spring_joint) == JOINT_ROW * sizeof(float), joint_row);

typedef union per_lane {
    lanes v;
    float f[NOH_LANES];
} per_lane;

/* A collider for a step: relative to the first joint. */
typedef struct obstacle {
    lane3 from, axis;
    lanes per_square; /* 1 over the square of the axis; 0 for a sphere */
    lanes radius;
    lanes near; /* its least distance from the first joint */
} obstacle;
NOH_STATIC_ASSERT(sizeof(obstacle) * 8u <= 72u * sizeof(float) * NOH_LANES, scratch);

/* As many chains as there are lanes; lanes without one read the first and write nothing. */
typedef struct group {
    const noh_spring_move *moves[NOH_LANES];
    per_lane joints;      /* per chain; 0 without one */
    per_lane restitution; /* per chain */
    per_lane meets;       /* per chain: 1 with `touches` */
    uint32_t joint_count, collider_count, used, bounces, touches;
} group;

static void fill_group(group *g, const noh_spring_move *moves, uint32_t count)
{
    g->used = count < NOH_LANES ? count : NOH_LANES;
    g->joint_count = g->collider_count = g->bounces = g->touches = 0;
    for (uint32_t lane = 0; lane < NOH_LANES; lane++) {
        const noh_spring_desc *d = moves[lane < g->used ? lane : 0].desc;
        g->moves[lane] = &moves[lane < g->used ? lane : 0];
        g->joints.f[lane] = lane < g->used ? (float)d->joint_count : 0.0f;
        g->restitution.f[lane] = d->restitution;
        g->bounces |= d->restitution > 0.0f;
        g->meets.f[lane] = g->moves[lane]->touches ? 1.0f : 0.0f;
        g->touches |= g->moves[lane]->touches != NULL;
        if (d->joint_count > g->joint_count) g->joint_count = d->joint_count;
        if (d->collider_count > g->collider_count) g->collider_count = d->collider_count;
    }
}

/* ---- rows in and out ---- */

NOH_ALWAYS_INLINE void load_row(const float *const *rows, lanes out[ROW])
{
    lanes rest[4];
    lanes_gather(rows, 0, out);
    lanes_gather(rows, 3, rest);
    NOH_UNROLL
    for (int i = 1; i < 4; i++) out[3 + i] = rest[i];
}

NOH_ALWAYS_INLINE void store_row(const lanes row[ROW], float *const *rows)
{
    lanes_scatter(row, rows, 0);
    lanes_scatter(row + 3, rows, 3);
}

NOH_ALWAYS_INLINE lane3 lane3_of(const lanes v[3])
{
    const lane3 r = { v[0], v[1], v[2] };
    return r;
}

NOH_ALWAYS_INLINE lane4 lane4_of(const lanes v[4])
{
    const lane4 r = { v[0], v[1], v[2], v[3] };
    return r;
}

NOH_ALWAYS_INLINE lane3 lane3_mix(lane3 a, lane3 b, lanes t)
{
    return lane3_madd(a, t, lane3_sub(b, a));
}

NOH_ALWAYS_INLINE lane4 lane4_nlerp(lane4 a, lane4 b, lanes t)
{
    const lanes one = lanes_set(1.0f), zero = lanes_set(0.0f);
    const lanes cosine = lanes_add(lanes_add(lanes_mul(a.x, b.x), lanes_mul(a.y, b.y)),
                                   lanes_add(lanes_mul(a.z, b.z), lanes_mul(a.w, b.w)));
    const lanes s = lanes_choose(lanes_less(cosine, zero), lanes_negate(t), t), u = lanes_sub(one, t);
    const lane4 sum = { lanes_add(lanes_mul(a.x, u), lanes_mul(b.x, s)),
                        lanes_add(lanes_mul(a.y, u), lanes_mul(b.y, s)),
                        lanes_add(lanes_mul(a.z, u), lanes_mul(b.z, s)),
                        lanes_add(lanes_mul(a.w, u), lanes_mul(b.w, s)) };
    return lane4_normalize(sum);
}

/* ---- rotations ---- */

/* Rotate bones that are bent back by more than a right angle, one lane at a time. */
static NOH_NEVER_INLINE lane4 bent_back(lanes mask, lane3 a, lane3 b, lane4 q)
{
    static const float up[3] = { 0.0f, 1.0f, 0.0f };
    const per_lane back = { lanes_choose(mask, lanes_set(1.0f), lanes_set(0.0f)) };
    per_lane from[3] = { { a.x }, { a.y }, { a.z } }, to[3] = { { b.x }, { b.y }, { b.z } };
    per_lane out[4] = { { q.x }, { q.y }, { q.z }, { q.w } };
    for (uint32_t lane = 0; lane < NOH_LANES; lane++) {
        const float one[3] = { from[0].f[lane], from[1].f[lane], from[2].f[lane] };
        const float other[3] = { to[0].f[lane], to[1].f[lane], to[2].f[lane] };
        float turn[4];
        if (back.f[lane] == 0.0f) continue;
        noh_quat_between(one, other, up, turn);
        for (int i = 0; i < 4; i++) out[i].f[lane] = turn[i];
    }
    const lane4 r = { out[0].v, out[1].v, out[2].v, out[3].v };
    return r;
}

/* The shortest rotation from direction a to b; size: the product of their lengths, known beforehand. The square of (a x
 * b, size + a.b) is twice its last component times the size. */
NOH_ALWAYS_INLINE lane4 between(lane3 a, lane3 b, lanes size)
{
    const lanes zero = lanes_set(0.0f), one = lanes_set(1.0f), cosine = lane3_dot(a, b), w = lanes_add(size, cosine);
    const lane3 v = lane3_cross(a, b);
    const lanes square = lanes_mul(lanes_add(size, size), w), good = lanes_less(zero, square);
    const lanes inverse = lanes_div(one, lanes_sqrt(lanes_choose(good, square, one)));
    const lane4 q = { lanes_mul(v.x, inverse), lanes_mul(v.y, inverse), lanes_mul(v.z, inverse),
                      lanes_choose(good, lanes_mul(w, inverse), one) };
    const lanes back = lanes_less(cosine, zero);
    return lanes_any(back) ? bent_back(back, a, b, q) : q;
}

/* ---- one step ---- */

/* Of a group: the fraction of the call's time at the end of this step, and the lanes that take it. */
typedef struct moment {
    lanes t, live;
    lane3 moved;
    lane3 ahead; /* from the carriers at the end of the call */
    lane4 rotation;
} moment;

/* The carrier at the end of the call: as it was before where a number of it is out of range. */
static const noh_spring_carrier *carrier_of(const noh_spring_move *move)
{
    return NOH_PAGE || noh_spring_carries(move->carrier) ? move->carrier : &move->spring->last;
}

/* Interpolate the carriers at this step. */
static void move_carriers(const group *g, moment *m, lane3 *position)
{
    const float *last_rows[NOH_LANES], *next_rows[NOH_LANES], *stepped_rows[NOH_LANES], *was_rows[NOH_LANES];
    float *stepped_to[NOH_LANES], *was_to[NOH_LANES], nowhere[ROW];
    lanes last[ROW], next[ROW], stepped[ROW], was[ROW], at[ROW];
    for (uint32_t lane = 0; lane < NOH_LANES; lane++) {
        noh_spring *s = g->moves[lane]->spring;
        last_rows[lane] = s->last.position;
        next_rows[lane] = carrier_of(g->moves[lane])->position;
        stepped_rows[lane] = s->stepped.position;
        was_rows[lane] = s->moved;
        stepped_to[lane] = lane < g->used ? s->stepped.position : nowhere;
        was_to[lane] = lane < g->used ? s->moved : nowhere;
    }
    load_row(last_rows, last);
    load_row(next_rows, next);
    load_row(stepped_rows, stepped);
    load_row(was_rows, was);
    *position = lane3_mix(lane3_of(last), lane3_of(next), m->t);
    m->rotation = lane4_nlerp(lane4_of(last + 3), lane4_of(next + 3), m->t);
    m->moved = lane3_sub(*position, lane3_of(stepped));
    m->ahead = lane3_sub(*position, lane3_of(next));
    const lanes now[ROW] = { position->x,   position->y,   position->z,  m->rotation.x,
                             m->rotation.y, m->rotation.z, m->rotation.w };
    const lanes then[ROW] = { m->moved.x, m->moved.y, m->moved.z, stepped[3], stepped[4], stepped[5], stepped[6] };
    NOH_UNROLL
    for (uint32_t i = 0; i < ROW; i++) {
        at[i] = lanes_choose(m->live, now[i], stepped[i]);
        was[i] = lanes_choose(m->live, then[i], was[i]);
    }
    store_row(at, stepped_to);
    store_row(was, was_to);
}

static void move_colliders(const group *g, const moment *m, lane3 position, obstacle *obstacles)
{
    static const noh_spring_collider none = { { FAR_AWAY, 0.0f, 0.0f }, { FAR_AWAY, 0.0f, 0.0f }, 0.0f };
    const lanes zero = lanes_set(0.0f), one = lanes_set(1.0f);
    for (uint32_t k = 0; k < g->collider_count; k++) {
        const float *last_rows[NOH_LANES], *next_rows[NOH_LANES];
        lanes last[ROW], next[ROW];
        obstacle *o = &obstacles[k];
        for (uint32_t lane = 0; lane < NOH_LANES; lane++) {
            const noh_spring_move *move = g->moves[lane];
            const int has = k < move->desc->collider_count;
            const noh_spring_collider *to = has ? &move->colliders[k] : &none;
            next_rows[lane] = to->from;
            last_rows[lane] = (has && move->spring->collides ? &noh_spring_colliders(move->spring)[k] : to)->from;
        }
        load_row(last_rows, last);
        load_row(next_rows, next);
        o->from = lane3_mix(lane3_of(last), lane3_of(next), m->t);
        o->axis = lane3_sub(lane3_mix(lane3_of(last + 3), lane3_of(next + 3), m->t), o->from);
        o->from = lane3_sub(o->from, position);
        const lanes square = lane3_dot(o->axis, o->axis), is_long = lanes_less(zero, square);
        o->per_square = lanes_choose(is_long, lanes_div(one, lanes_choose(is_long, square, one)), zero);
        o->radius = lanes_add(last[6], lanes_mul(m->t, lanes_sub(next[6], last[6])));
        const lanes along = lanes_negate(lanes_mul(lane3_dot(o->from, o->axis), o->per_square));
        const lane3 nearest = lane3_madd(o->from, lanes_max(zero, lanes_min(one, along)), o->axis);
        o->near = lanes_sub(lanes_sqrt(lane3_dot(nearest, nearest)), o->radius);
    }
}

/* Push joints' ends out of a capsule, then back to their distance from the joints. */
NOH_ALWAYS_INLINE lane3 push_out(const obstacle *o, lane3 head, lanes radius, lanes length, lane3 tail)
{
    const lanes zero = lanes_set(0.0f), one = lanes_set(1.0f), wanted = lanes_add(o->radius, radius);
    lane3 away = lane3_sub(tail, o->from);
    const lanes along = lanes_mul(lane3_dot(away, o->axis), o->per_square);
    away = lane3_madd(away, lanes_negate(lanes_max(zero, lanes_min(one, along))), o->axis);
    const lanes distance = lane3_dot(away, away);
    const lanes hit = lanes_and(lanes_less(distance, lanes_mul(wanted, wanted)), lanes_less(zero, distance));
    if (!lanes_any(hit)) return tail;
    const lanes far_off = lanes_sqrt(lanes_choose(hit, distance, one));
    const lane3 out = lane3_madd(tail, lanes_sub(lanes_div(wanted, far_off), one), away), bone = lane3_sub(out, head);
    const lanes square = lane3_dot(bone, bone), is_long = lanes_less(lanes_set(1e-30f), square);
    const lanes scale = lanes_mul(length, lanes_inverse_root(is_long, square));
    return lane3_choose(lanes_and(hit, is_long), lane3_madd(head, scale, bone), tail);
}

/* Turn bones so that their ends are in front of a plane: the part of a bone along the normal is at least `least`, its
 * length stays. A bone that points straight into the plane turns towards x, or towards z where the normal is nearly
 * along x. */
NOH_ALWAYS_INLINE lane3 turn_up(lane3 normal, lanes least, lane3 head, lanes length, lane3 tail)
{
    const lanes zero = lanes_set(0.0f), one = lanes_set(1.0f), tiny = lanes_mul(lanes_set(1e-8f), length);
    const lane3 bone = lane3_sub(tail, head);
    const lanes along = lane3_dot(bone, normal), hit = lanes_less(along, least);
    if (!lanes_any(hit)) return tail;
    const lanes flat = lanes_less(lanes_mul(normal.x, normal.x), lanes_set(0.5f));
    const lane3 other = { lanes_choose(flat, one, zero), zero, lanes_choose(flat, zero, one) };
    const lane3 in_plane = lane3_madd(other, lanes_negate(lane3_dot(other, normal)), normal);
    lane3 side = lane3_madd(bone, lanes_negate(along), normal);
    const lanes leans = lanes_less(lanes_mul(tiny, length), lane3_dot(side, side));
    side = lane3_choose(leans, side, in_plane);
    const lanes up = lanes_min(least, length), rest = lanes_sub(lanes_mul(length, length), lanes_mul(up, up));
    const lanes across = lanes_div(lanes_sqrt(lanes_max(zero, rest)), lanes_sqrt(lane3_dot(side, side)));
    const lane3 turned = lane3_madd(lane3_madd(head, up, normal), across, side);
    return lane3_choose(hit, turned, tail);
}

/* Keep the ends of joints in front of what their chains touch.
 * ahead  the joint, from the carrier at the end of the call
 * turn   planes are turned by it; NULL: they are not */
static NOH_NEVER_INLINE lane3 stay_in_front(const group *g, uint32_t joint, lane3 ahead, const lane4 *turn, lane3 head,
                                            lanes radius, lanes length, lane3 tail)
{
    static const noh_touch none = { { { 0.0f, 1.0f, 0.0f }, -FAR_AWAY }, 0.0f };
    for (uint32_t k = 0; k < NOH_TOUCHES_MAX; k++) {
        const float *rows[NOH_LANES];
        lanes plane[4];
        uint32_t some = 0;
        for (uint32_t lane = 0; lane < NOH_LANES; lane++) {
            const noh_spring_move *move = g->moves[lane];
            const noh_touches *t = joint < move->desc->joint_count && move->touches ? &move->touches[joint] : NULL;
            const int has = t && k < t->count;
            rows[lane] = has ? t->at[k].plane.normal : none.plane.normal;
            some |= (uint32_t)has;
        }
        if (!some) break;
        lanes_gather(rows, 0, plane);
        const lane3 normal = turn ? lane4_rotate(*turn, lane3_of(plane)) : lane3_of(plane);
        const lanes least = lanes_sub(lanes_add(radius, plane[3]), lane3_dot(normal, ahead));
        tail = turn_up(normal, least, head, length, tail);
    }
    return tail;
}

/* The previous position of an end, set so that it rebounds: it was pushed from `free` to `tail`, and `inertia` is its
 * velocity without pulls; otherwise it would never rest. */
NOH_ALWAYS_INLINE lane3 bounce(const group *g, lane3 before, lane3 inertia, lane3 free, lane3 tail)
{
    const lane3 out = lane3_sub(tail, free);
    const lanes square = lane3_dot(out, out), hit = lanes_less(lanes_set(1e-12f), square);
    const lane3 n = lane3_scale(out, lanes_inverse_root(hit, square));
    const lanes towards = lane3_dot(inertia, n), leaves = lane3_dot(lane3_sub(tail, before), n);
    const lanes fast = lanes_and(lanes_less(lanes_set(0.0f), g->restitution.v), lanes_less(towards, lanes_set(0.0f)));
    const lanes back = lanes_add(leaves, lanes_mul(towards, g->restitution.v));
    return lane3_choose(lanes_and(hit, fast), lane3_madd(before, back, n), before);
}

typedef struct lane_joint {
    lane3 bone;
    lane4 rest;
    lanes stiffness, drag, radius;
    lane3 gravity;
} lane_joint;

NOH_ALWAYS_INLINE lane_joint load_joint(const float *const *rows)
{
    lanes c[13];
    lane_joint j;
    lanes last[4];
    lanes_gather(rows, 0, c);
    lanes_gather(rows, 4, c + 4);
    lanes_gather(rows, 8, c + 8);
    lanes_gather(rows, 9, last);
    c[12] = last[3];
    j.bone = lane3_of(c);
    j.rest = lane4_of(c + 3);
    j.stiffness = c[7];
    j.drag = c[8];
    j.radius = c[9];
    j.gravity = lane3_of(c + 10);
    return j;
}

/* Move the ends of joints, from the first joint to the last. */
static void step_joints(const group *g, moment *m, const obstacle *obstacles)
{
    const lanes one = lanes_set(1.0f), seconds = lanes_set(STEP_SECONDS), beyond = lanes_set(BEYOND);
    const lanes tiny = lanes_set(1e-30f);
    lane3 head = { lanes_set(0.0f), lanes_set(0.0f), lanes_set(0.0f) };
    lanes reach = lanes_set(0.0f);
    for (uint32_t i = 0; i < g->joint_count; i++) {
        const float *joint_rows[NOH_LANES], *rows[NOH_LANES];
        float *to[NOH_LANES], nowhere[ROW];
        lanes p[ROW];
        for (uint32_t lane = 0; lane < NOH_LANES; lane++) {
            const noh_spring_move *move = g->moves[lane];
            const uint32_t at = i < move->desc->joint_count ? i : move->desc->joint_count - 1u;
            noh_spring_point *point = &noh_spring_points(move->spring)[at];
            joint_rows[lane] = move->desc->joints[at].bone;
            rows[lane] = point->now;
            to[lane] = lane < g->used ? point->now : nowhere;
        }
        load_row(rows, p);
        const lane_joint j = load_joint(joint_rows);
        const lanes active = lanes_and(m->live, lanes_less(lanes_set((float)i), g->joints.v)), length = p[6];
        const lane4 unswung = lane4_mul(m->rotation, j.rest);
        const lane3 pull = lane4_rotate(unswung, j.bone), now = lane3_of(p);
        lane3 kept = lane3_sub(now, m->moved);
        const lanes pulled = lanes_mul(seconds, lanes_div(j.stiffness, length));
        lane3 tail = lane3_madd(kept, lanes_sub(one, j.drag), lane3_sub(now, lane3_of(p + 3)));
        tail = lane3_add(tail, lane3_madd(lane3_scale(j.gravity, seconds), pulled, pull));
        lane3 bone = lane3_sub(tail, head);
        const lanes square = lane3_dot(bone, bone), is_long = lanes_less(tiny, square);
        const lanes scale = lanes_choose(is_long, lanes_mul(length, lanes_inverse_root(is_long, square)), one);
        tail = lane3_madd(head, scale, lane3_choose(is_long, bone, pull));
        reach = lanes_add(reach, length);
        const lane3 free = tail;
        const lanes within = lanes_mul(beyond, lanes_add(reach, j.radius));
        for (uint32_t k = 0; k < g->collider_count; k++) {
            if (lanes_any(lanes_less(obstacles[k].near, within))) {
                tail = push_out(&obstacles[k], head, j.radius, length, tail);
            }
        }
        if (!NOH_PAGE && g->touches) {
            tail = stay_in_front(g, i, lane3_add(m->ahead, head), NULL, head, j.radius, length, tail);
        }
        if (g->bounces) {
            const lane3 inertia = lane3_scale(lane3_sub(now, lane3_of(p + 3)), lanes_sub(one, j.drag));
            kept = bounce(g, kept, inertia, free, tail);
        }
        const lanes next[ROW] = { tail.x, tail.y, tail.z, kept.x, kept.y, kept.z, length };
        NOH_UNROLL
        for (uint32_t c = 0; c < ROW; c++) p[c] = lanes_choose(active, next[c], p[c]);
        store_row(p, to);
        m->rotation = lane4_mul(between(pull, lane3_sub(tail, head), lanes_mul(length, length)), unswung);
        head = tail;
    }
}

/* ---- time ---- */

typedef struct span {
    uint32_t steps, kept, dropped;
} span;

/* How many steps a spring takes in this many ticks. Beyond the limit only the last ones are taken, at the carrier's
 * speed, from rest at its place then. */
static span begin(const noh_spring_move *move, uint32_t ticks)
{
    noh_spring *s = move->spring;
    const uint64_t time = (uint64_t)s->left + ticks, whole = time / NOH_SPRING_STEP_TICKS;
    span r = { (uint32_t)whole, ticks, 0 };
    if (whole > NOH_SPRING_STEPS_MAX) {
        const noh_spring_carrier *to = carrier_of(move);
        noh_spring_carrier at;
        r.steps = NOH_SPRING_STEPS_MAX;
        r.kept = NOH_SPRING_STEPS_MAX * NOH_SPRING_STEP_TICKS + (uint32_t)(time % NOH_SPRING_STEP_TICKS);
        r.dropped = (uint32_t)(time - r.kept);
        const float t = (float)(ticks - r.kept) / (float)ticks;
        for (int k = 0; k < 3; k++) {
            at.position[k] = s->last.position[k] + t * (to->position[k] - s->last.position[k]);
        }
        noh_quat_nlerp(s->last.rotation, to->rotation, t, at.rotation);
        noh_spring_reset(s, move->desc, &at);
    }
    return r;
}

static void finish(const noh_spring_move *move, span time)
{
    noh_spring *s = move->spring;
    s->left += time.kept - time.steps * NOH_SPRING_STEP_TICKS;
    s->last = *carrier_of(move);
    if (s->collider_count) {
        memcpy(noh_spring_colliders(s), move->colliders, s->collider_count * sizeof *move->colliders);
        s->collides = 1;
    }
}

/* Returns the ticks that were dropped. */
static uint32_t step_group(const group *g, uint32_t ticks, obstacle *obstacles)
{
    span times[NOH_LANES];
    uint32_t steps = 0, dropped = 0;
    memset(times, 0, sizeof times); /* lanes beyond `used` take no step */
    for (uint32_t lane = 0; lane < g->used; lane++) {
        times[lane] = begin(g->moves[lane], ticks);
        if (times[lane].steps > steps) steps = times[lane].steps;
        if (times[lane].dropped > dropped) dropped = times[lane].dropped;
    }
    for (uint32_t i = 1; i <= steps; i++) {
        per_lane t, live;
        lane3 position;
        moment m;
        for (uint32_t lane = 0; lane < NOH_LANES; lane++) {
            const int on = lane < g->used && i <= times[lane].steps;
            live.f[lane] = on ? 1.0f : 0.0f;
            t.f[lane] = on ? (float)(i * NOH_SPRING_STEP_TICKS - g->moves[lane]->spring->left) / (float)times[lane].kept
                           : 0.0f;
        }
        m.t = t.v;
        m.live = lanes_less(lanes_set(0.0f), live.v);
        move_carriers(g, &m, &position);
        move_colliders(g, &m, position, obstacles);
        step_joints(g, &m, obstacles);
    }
    for (uint32_t lane = 0; lane < g->used; lane++) finish(g->moves[lane], times[lane]);
    return dropped;
}

uint32_t NOH_SPRING_STEP(const noh_spring_move *moves, uint32_t count, uint32_t ticks, float *scratch)
{
    uint32_t dropped = 0;
    float *aligned = scratch ? scratch + (0u - (uintptr_t)scratch / sizeof(float)) % NOH_LANES : NULL;
    NOH_ASSERT(moves || !count);
    for (uint32_t i = 0; i < count; i += NOH_LANES) {
        group g;
        fill_group(&g, moves + i, count - i);
        NOH_ASSERT(scratch || !g.collider_count);
        const uint32_t lost = step_group(&g, ticks, (obstacle *)(void *)aligned);
        if (lost > dropped) dropped = lost;
    }
    return dropped;
}

/* ---- results ---- */

/* The rotation of a group's planes into the space in which it is shown. */
static lane4 turn_of(const group *g, lane4 carrier)
{
    const float *rows[NOH_LANES];
    lanes last[4];
    for (uint32_t lane = 0; lane < NOH_LANES; lane++) rows[lane] = g->moves[lane]->spring->last.rotation;
    lanes_gather(rows, 0, last);
    return lane4_mul(carrier, lane4_conjugate(lane4_of(last)));
}

/* Interpolate between the last two steps, turned with the carrier, which turns nothing within the chain: a chain that
 * is carried rigidly does not lag behind. It stays in front of what it touches where it is carried to. */
static void show_group(const group *g)
{
    const float *rows[NOH_LANES], *was_rows[NOH_LANES];
    per_lane left;
    lanes stepped[ROW], was[ROW];
    lane3 head = { lanes_set(0.0f), lanes_set(0.0f), lanes_set(0.0f) };
    for (uint32_t lane = 0; lane < NOH_LANES; lane++) {
        const noh_spring *s = g->moves[lane]->spring;
        rows[lane] = s->stepped.position;
        was_rows[lane] = s->moved;
        left.f[lane] = (float)s->left / (float)NOH_SPRING_STEP_TICKS;
    }
    load_row(rows, stepped);
    load_row(was_rows, was);
    lane4 parent = lane4_nlerp(lane4_of(was + 3), lane4_of(stepped + 3), left.v);
    const lane4 turn = turn_of(g, parent);
    lane3 end = head; /* of the last bone, as shown */
    for (uint32_t i = 0; i < g->joint_count; i++) {
        const float *joint_rows[NOH_LANES];
        float *to[NOH_LANES], nowhere[4];
        lanes p[ROW], j[ROW], more[4];
        for (uint32_t lane = 0; lane < NOH_LANES; lane++) {
            const noh_spring_move *move = g->moves[lane];
            const int has = i < move->desc->joint_count;
            const uint32_t at = has ? i : move->desc->joint_count - 1u;
            rows[lane] = noh_spring_const_points(move->spring)[at].now;
            joint_rows[lane] = move->desc->joints[at].bone;
            to[lane] = has && lane < g->used ? move->rotations + 4u * (size_t)at : nowhere;
        }
        load_row(rows, p);
        load_row(joint_rows, j);
        const lane3 tail = lane3_mix(lane3_add(lane3_of(p + 3), lane3_of(was)), lane3_of(p), left.v);
        const lane4 rest = lane4_normalize(lane4_of(j + 3));
        lane3 way = lane3_sub(tail, head);
        if (!NOH_PAGE && g->touches) {
            const lanes square = lane3_dot(way, way), is_long = lanes_less(lanes_set(1e-30f), square);
            const lane3 free = lane3_madd(end, lanes_mul(p[6], lanes_inverse_root(is_long, square)), way);
            lanes_gather(joint_rows, 6, more);
            const lane3 kept = stay_in_front(g, i, end, &turn, end, more[3], p[6], free);
            way = lane3_choose(lanes_less(lanes_set(0.0f), g->meets.v), lane3_sub(kept, end), way);
            end = kept;
        }
        const lane3 bone = lane4_rotate(lane4_conjugate(parent), way);
        const lanes size = lanes_mul(p[6], lanes_sqrt(lane3_dot(bone, bone)));
        const lane4 local = lane4_mul(between(lane4_rotate(rest, lane3_of(j)), bone, size), rest);
        const lanes out[4] = { local.x, local.y, local.z, local.w };
        lanes_scatter(out, to, 0);
        parent = lane4_mul(parent, local);
        head = tail;
    }
}

void NOH_SPRING_ROTATIONS(const noh_spring_move *moves, uint32_t count)
{
    NOH_ASSERT(moves || !count);
    for (uint32_t i = 0; i < count; i += NOH_LANES) {
        group g;
        fill_group(&g, moves + i, count - i);
        show_group(&g);
    }
}
