/* ragdoll_lanes.c: advances by 1/60 s as many ragdolls as there are lanes.
 *
 * In each substep: predict; pairs of bodies; joints from the first body to the last, each by anchors, hinge or swing,
 * twist, strength; the world, with static friction; velocities from the change of position; restitution; friction in
 * joints.
 * After the last substep, positions alone are corrected further. Masked lanes keep their bits: a correction that no
 * lane needs may be skipped, so the width does not matter.
 *
 * The axis of a capsule is z of its space and its centre the centre of mass, so inertia is two numbers: I^-1 v = across
 * v + (along - across) z (z . v). */
#include "core/base/assert_internal.h"
#include "core/base/compiler_internal.h"
#include "life/physics/lanes3_internal.h"
#include "life/physics/ragdoll_internal.h"
#include "core/base/vector_internal.h"
#include "life/physics/world_ask_internal.h"
#include "life/physics/world_internal.h"
#include "noh/low_life.h"
#include "noh/base.h"
#include "noh/body.h"

#define TURN_BACK_SPEED 2.0f /* radians per second at which joints that begin beyond their limits return */
#define AT_ONCE 1e3f
#define DOWN 0.7f      /* a direction steeper than 45 degrees */
#define NO_WAY 1e12f   /* larger than any box */
#define NEAR_END 0.99f /* along a capsule, where its end begins */
#define POINTS 3u      /* contact points of a body with the world: its two ends, and one between */

typedef struct lane_body {
    lane3 p;
    lane4 q;
    lane3 v, w, goal_p;
    lane4 goal_q;
    lanes hertz;
    lanes mass, across, along; /* inverse mass and inertia; 0: held */
    lane3 z;                   /* the axis, from q */
    lane3 p_before;
    lane4 q_before;
    lane3 normals[POINTS];
    lanes at[POINTS], pushed[POINTS]; /* where along the axis, and by how much in this substep */
    lanes approach[POINTS];           /* approach speed, below 0; for a world that bounces */
} lane_body;
NOH_STATIC_ASSERT(sizeof(lane_body) == NOH_RAGDOLL_LANE_FLOATS * sizeof(lanes), lane_body);

/* A world relative to the origins of the lanes' dolls. */
typedef struct lane_world {
    lane3 origin;
    lane3 root;      /* position of the first body in this substep */
    lanes push_out;  /* how far overlaps from before a substep separate in it */
    lanes turn_back; /* likewise for joints */
    lanes plane_distances[NOH_OBSTACLES_MAX];
} lane_world;
NOH_STATIC_ASSERT(sizeof(lane_world) == NOH_RAGDOLL_PLACE_FLOATS * sizeof(lanes), lane_world);
NOH_STATIC_ASSERT(NOH_LANES <= NOH_RAGDOLL_LANES_MAX, lane_count);

/* Planes that the world has answered: three for each end and two for what is between, as contact points are numbered.
 * A plane that is missing is far below. */
#define END_TOUCHES 3u
typedef struct lane_touch {
    lane3 normal;
    lanes distance, at;
} lane_touch;
NOH_STATIC_ASSERT(sizeof(lane_touch) * NOH_TOUCHES_MAX == NOH_RAGDOLL_TOUCH_FLOATS * sizeof(lanes), lane_touch);

/* ---- dolls in and out ---- */

static void load_doll(const noh_ragdoll_shape *shape, const noh_ragdoll_doll *doll, lane_body *bodies, uint32_t lane)
{
    for (uint32_t i = 0; i < shape->body_count; i++) {
        const noh_ragdoll_constants *c = &shape->bodies[i];
        const float *from = (const float *)(const void *)&doll->bodies[i];
        float *to = (float *)(void *)&bodies[i];
        const int held = (doll->held >> i) & 1u;
        for (uint32_t k = 0; k < NOH_RAGDOLL_STATE_FLOATS; k++) to[k * NOH_LANES + lane] = from[k];
        to[20 * NOH_LANES + lane] = doll->hertz[i];
        to[21 * NOH_LANES + lane] = held ? 0.0f : 1.0f / c->mass;
        to[22 * NOH_LANES + lane] = held ? 0.0f : 1.0f / c->inertia_across;
        to[23 * NOH_LANES + lane] = held ? 0.0f : 1.0f / c->inertia_along;
    }
}

static void store_doll(const noh_ragdoll_shape *shape, noh_ragdoll_doll *doll, const lane_body *bodies, uint32_t lane)
{
    for (uint32_t i = 0; i < shape->body_count; i++) {
        const float *from = (const float *)(const void *)&bodies[i];
        float *to = (float *)(void *)&doll->bodies[i];
        for (uint32_t k = 0; k < NOH_RAGDOLL_MOVES; k++) to[k] = from[k * NOH_LANES + lane];
    }
}

static void load_place(const noh_world *world, const noh_ragdoll_doll *doll, float seconds, lane_world *place,
                       uint32_t lane)
{
    float *to = (float *)(void *)place;
    for (uint32_t k = 0; k < 3; k++) to[k * NOH_LANES + lane] = doll->origin[k];
    to = (float *)(void *)&place->turn_back;
    to[lane] = doll->bent ? TURN_BACK_SPEED * seconds : AT_ONCE;
    to = (float *)(void *)place->plane_distances;
    for (uint32_t i = 0; world && i < world->plane_count; i++) {
        to[i * NOH_LANES + lane] = noh_plane_distance(&world->planes[i], doll->origin);
    }
}

/* A touch in a lane; NULL: none. */
static void load_touch(const noh_touch *touch, float half, lane_touch *out, uint32_t lane)
{
    float *to = (float *)(void *)out;
    for (uint32_t k = 0; k < 3; k++) to[k * NOH_LANES + lane] = touch ? touch->plane.normal[k] : k == 1 ? 1.0f : 0.0f;
    to[3 * NOH_LANES + lane] = touch ? touch->plane.distance : -NO_WAY;
    to[4 * NOH_LANES + lane] = touch ? touch->along * half : 0.0f;
}

/* out: [NOH_TOUCHES_MAX] of one body. Which come first counts, where there are too many at one contact point. */
static void load_touches(const noh_touches *touches, float half, lane_touch *out, uint32_t lane)
{
    static const uint32_t first[POINTS + 1u] = { 0, END_TOUCHES, 2u * END_TOUCHES, NOH_TOUCHES_MAX };
    for (uint32_t point = 0; point < POINTS; point++) {
        uint32_t to = first[point];
        for (uint32_t i = 0; i < touches->count && to < first[point + 1u]; i++) {
            const float along = touches->at[i].along;
            const uint32_t own = along > NEAR_END ? 0u : along < -NEAR_END ? 1u : 2u;
            if (own == point) load_touch(&touches->at[i], half, &out[to++], lane);
        }
        while (to < first[point + 1u]) load_touch(NULL, half, &out[to++], lane);
    }
}

/* ---- masses ---- */

NOH_ALWAYS_INLINE lane3 inverse_inertia(const lane_body *b, lane3 v)
{
    const lanes extra = lanes_mul(lanes_sub(b->along, b->across), lane3_dot(b->z, v));
    return lane3_madd(lane3_scale(v, b->across), extra, b->z);
}

/* One over the effective mass of a rotation about n, or of a push along n at r with c = r x n. */
NOH_ALWAYS_INLINE lanes turn_weight(const lane_body *b, lane3 n)
{
    const lanes d = lane3_dot(b->z, n);
    return lanes_add(lanes_mul(b->across, lane3_dot(n, n)), lanes_mul(lanes_sub(b->along, b->across), lanes_mul(d, d)));
}

NOH_ALWAYS_INLINE lanes push_weight(const lane_body *b, lane3 c)
{
    return lanes_add(b->mass, turn_weight(b, c));
}

/* a share / weight, 0 if the weight is 0 or the lane is masked out */
NOH_ALWAYS_INLINE lanes over_weight(lanes mask, lanes value, lanes weight)
{
    const lanes some = lanes_and(mask, lanes_less(lanes_set(0.0f), weight));
    return lanes_choose(some, lanes_div(value, lanes_choose(some, weight, lanes_set(1.0f))), lanes_set(0.0f));
}

NOH_ALWAYS_INLINE void turn_body(lane_body *b, lanes mask, lane3 by)
{
    b->q = lane4_choose(mask, lane4_turn(b->q, by), b->q);
    b->z = lane4_axis_z(b->q);
}

/* Turn two bodies by an angle about the unit axis n: a forwards, b backwards, each by its share. */
NOH_ALWAYS_INLINE void turn_pair(lane_body *a, lane_body *b, lanes mask, lane3 n, lanes angle)
{
    const lanes s = over_weight(mask, angle, lanes_add(turn_weight(a, n), turn_weight(b, n)));
    const lane3 by_a = lane3_scale(inverse_inertia(a, n), s);
    const lane3 by_b = lane3_scale(inverse_inertia(b, n), lanes_negate(s));
    turn_body(a, mask, by_a);
    turn_body(b, mask, by_b);
}

/* Move two bodies by `far` along the unit vector n at ra and rb: a backwards, b forwards. */
NOH_ALWAYS_INLINE void push_pair(lane_body *a, lane3 ra, lane_body *b, lane3 rb, lanes mask, lane3 n, lanes far)
{
    const lane3 ca = lane3_cross(ra, n), cb = lane3_cross(rb, n);
    const lanes s = over_weight(mask, far, lanes_add(push_weight(a, ca), push_weight(b, cb)));
    const lane3 by_a = lane3_scale(inverse_inertia(a, ca), lanes_negate(s)),
                by_b = lane3_scale(inverse_inertia(b, cb), s);
    a->p = lane3_choose(mask, lane3_madd(a->p, lanes_negate(lanes_mul(s, a->mass)), n), a->p);
    b->p = lane3_choose(mask, lane3_madd(b->p, lanes_mul(s, b->mass), n), b->p);
    turn_body(a, mask, by_a);
    turn_body(b, mask, by_b);
}

/* ---- joints ---- */

typedef struct joint {
    const noh_ragdoll_constants *c;
    lane_body *a, *b; /* the parent and the body itself */
    lanes turn_back;  /* how far joints that were beyond a limit before a substep turn back in it, radians */
} joint;

NOH_ALWAYS_INLINE lane4 frame_a(const joint *j)
{
    return lane4_mul(j->a->q, lane4_set(j->c->frame_parent));
}

NOH_ALWAYS_INLINE lane4 frame_b(const joint *j)
{
    return lane4_mul(j->b->q, lane4_set(j->c->frame));
}

/* The frames at the start of the substep. */
NOH_ALWAYS_INLINE lane4 frame_a_before(const joint *j)
{
    return lane4_mul(j->a->q_before, lane4_set(j->c->frame_parent));
}

NOH_ALWAYS_INLINE lane4 frame_b_before(const joint *j)
{
    return lane4_mul(j->b->q_before, lane4_set(j->c->frame));
}

/* The correction of an angle beyond a limit: all of what this substep added, and only a bounded part of what was there
 * before, so that nothing is thrown. */
NOH_ALWAYS_INLINE lanes way_back(const joint *j, lanes past, lanes before)
{
    const lanes zero = lanes_set(0.0f), left = lanes_max(lanes_sub(before, j->turn_back), zero);
    return lanes_max(lanes_sub(past, left), zero);
}

/* Align the axes of a hinge. */
NOH_ALWAYS_INLINE void solve_hinge(const joint *j)
{
    const lane3 c = lane3_cross(lane4_axis_z(frame_a(j)), lane4_axis_z(frame_b(j)));
    const lane3 was = lane3_cross(lane4_axis_z(frame_a_before(j)), lane4_axis_z(frame_b_before(j)));
    const lanes square = lane3_dot(c, c), mask = lanes_less(lanes_set(1e-14f), square);
    const lanes inverse = lanes_inverse_root(mask, square);
    const lanes back = way_back(j, lanes_mul(square, inverse), lanes_sqrt(lane3_dot(was, was)));
    turn_pair(j->a, j->b, mask, lane3_scale(c, inverse), back);
}

/* The angle by which swing is outside its ellipse; 0 inside. r: rotation of b in the frame of a. */
NOH_ALWAYS_INLINE lanes past_swing(const joint *j, lane4 r, lanes *outside)
{
    const lanes one = lanes_set(1.0f);
    const lanes rest = lanes_add(lanes_mul(r.z, r.z), lanes_mul(r.w, r.w));
    const lanes swung = lanes_add(lanes_mul(r.x, r.x), lanes_mul(r.y, r.y));
    /* x and y of the swing alone, times the root of `rest` */
    const lanes x = lanes_sub(lanes_mul(r.x, r.w), lanes_mul(r.y, r.z));
    const lanes y = lanes_add(lanes_mul(r.x, r.z), lanes_mul(r.y, r.w));
    const lanes fill = lanes_add(lanes_mul(lanes_mul(x, x), lanes_set(j->c->swing[0])),
                                 lanes_mul(lanes_mul(y, y), lanes_set(j->c->swing[1])));
    const lanes mask = lanes_less(rest, fill); /* fill / rest above 1 */
    *outside = mask;
    if (!lanes_any(mask)) return lanes_set(0.0f);
    const lanes a = lanes_sqrt(swung), b = lanes_sqrt(rest);
    const lanes sine = lanes_mul(a, lanes_sqrt(lanes_div(rest, lanes_choose(mask, fill, one))));
    const lanes cosine = lanes_sqrt(lanes_max(lanes_sub(one, lanes_mul(sine, sine)), lanes_set(0.0f)));
    const lanes over = lanes_sub(lanes_mul(a, cosine), lanes_mul(b, sine));
    const lanes along = lanes_add(lanes_mul(b, cosine), lanes_mul(a, sine));
    const lanes angle = lanes_mul(lanes_set(2.0f), lanes_arc_tangent(over, lanes_max(along, lanes_set(1e-3f))));
    return lanes_choose(mask, angle, lanes_set(0.0f));
}

/* Turn swing back into its ellipse, by the shortest way to its centre. */
NOH_ALWAYS_INLINE void solve_swing(const joint *j)
{
    lanes mask, was;
    const lanes past = past_swing(j, lane4_mul(lane4_conjugate(frame_a(j)), frame_b(j)), &mask);
    if (!lanes_any(mask)) return;
    const lane4 r = lane4_mul(lane4_conjugate(frame_a_before(j)), frame_b_before(j));
    const lanes angle = way_back(j, past, past_swing(j, r, &was));
    const lane3 n = lane3_cross(lane4_axis_z(frame_a(j)), lane4_axis_z(frame_b(j)));
    const lanes square = lane3_dot(n, n);
    mask = lanes_and(mask, lanes_less(lanes_set(1e-12f), square));
    turn_pair(j->a, j->b, mask, lane3_scale(n, lanes_inverse_root(mask, square)), angle);
}

/* Half the angle by which twist is above its upper limit, or (negative) below its lower one; 0 between them. */
NOH_ALWAYS_INLINE lanes past_twist(const joint *j, lane4 r, lanes *outside)
{
    const lanes zero = lanes_set(0.0f), turned = lanes_less(r.w, zero);
    const lanes s0 = lanes_set(j->c->twist_min[0]), c0 = lanes_set(j->c->twist_min[1]);
    const lanes s1 = lanes_set(j->c->twist_max[0]), c1 = lanes_set(j->c->twist_max[1]);
    const lanes z = lanes_choose(turned, lanes_negate(r.z), r.z), w = lanes_choose(turned, lanes_negate(r.w), r.w);
    const lanes over = lanes_sub(lanes_mul(z, c1), lanes_mul(w, s1));
    const lanes under = lanes_sub(lanes_mul(z, c0), lanes_mul(w, s0));
    const lanes above = lanes_less(zero, over);
    const lanes mask = lanes_or(above, lanes_less(under, zero));
    *outside = mask;
    if (!lanes_any(mask)) return zero;
    const lanes along = lanes_choose(above, lanes_add(lanes_mul(w, c1), lanes_mul(z, s1)),
                                     lanes_add(lanes_mul(w, c0), lanes_mul(z, s0)));
    const lanes ratio = lanes_arc_tangent(lanes_choose(above, over, under), lanes_max(along, lanes_set(1e-3f)));
    return lanes_choose(mask, lanes_mul(lanes_set(2.0f), ratio), zero);
}

/* Turn twist back between its limits; needs no arc functions while it is within them. */
NOH_ALWAYS_INLINE void solve_twist(const joint *j)
{
    const lanes zero = lanes_set(0.0f);
    lanes mask, was;
    const lanes past = past_twist(j, lane4_mul(lane4_conjugate(frame_a(j)), frame_b(j)), &mask);
    if (!lanes_any(mask)) return;
    const lanes before = past_twist(j, lane4_mul(lane4_conjugate(frame_a_before(j)), frame_b_before(j)), &was);
    const lanes below = lanes_less(past, zero);
    const lanes size = way_back(j, lanes_abs(past), lanes_max(lanes_choose(below, lanes_negate(before), before), zero));
    const lanes angle = lanes_choose(below, lanes_negate(size), size);
    const lane3 n = lane3_add(lane4_axis_z(frame_a(j)), lane4_axis_z(frame_b(j)));
    const lanes square = lane3_dot(n, n);
    mask = lanes_and(mask, lanes_less(lanes_set(1e-6f), square));
    turn_pair(j->a, j->b, mask, lane3_scale(n, lanes_inverse_root(mask, square)), angle);
}

/* Turn towards the goals' angle as a critically damped spring of this frequency: by (s / (1 + s))^2 of the angle and 2
 * s / (1 + s)^2 of the speed, with s = 2 pi hertz h.
 * source  Macklin et al. 2016, section 5, with the effective inertia inserted */
NOH_ALWAYS_INLINE void solve_strength(const joint *j, lanes h)
{
    const lanes one = lanes_set(1.0f), s = lanes_mul(lanes_mul(j->b->hertz, lanes_set(6.2831853f)), h);
    const lanes part = lanes_div(one, lanes_add(one, s)), share = lanes_mul(lanes_mul(s, s), lanes_mul(part, part));
    const lanes damping = lanes_mul(lanes_mul(lanes_set(2.0f), s), lanes_mul(part, part));
    lanes mask = lanes_less(lanes_set(0.0f), s);
    if (!lanes_any(mask)) return;
    const lane4 goal = lane4_mul(lane4_conjugate(j->a->goal_q), j->b->goal_q);
    const lane3 off = lane4_difference(j->b->q, lane4_mul(j->a->q, goal));
    const lane3 moved = lane3_scale(lane3_sub(j->b->w, j->a->w), h);
    const lane3 back = lane3_madd(lane3_scale(off, share), damping, moved);
    const lanes square = lane3_dot(back, back);
    mask = lanes_and(mask, lanes_less(lanes_set(1e-16f), square));
    const lanes inverse = lanes_inverse_root(mask, square);
    turn_pair(j->a, j->b, mask, lane3_scale(back, inverse), lanes_mul(square, inverse));
}

/* The separation of a sliding joint's anchors beyond its limits. */
NOH_ALWAYS_INLINE lane3 past_linear(const joint *j, lane3 apart)
{
    const lane4 q = frame_a(j);
    const lane3 d = lane4_rotate(lane4_conjugate(q), apart);
    const lane3 low = lane3_set(j->c->linear_min), high = lane3_set(j->c->linear_max);
    const lane3 past = { lanes_sub(d.x, lanes_max(lanes_min(d.x, high.x), low.x)),
                         lanes_sub(d.y, lanes_max(lanes_min(d.y, high.y), low.y)),
                         lanes_sub(d.z, lanes_max(lanes_min(d.z, high.z), low.z)) };
    return lane4_rotate(q, past);
}

/* Bring the anchors together. */
NOH_ALWAYS_INLINE void solve_anchors(const joint *j)
{
    const lane3 ra = lane4_rotate(j->a->q, lane3_set(j->c->anchor_parent));
    const lane3 rb = lane4_rotate(j->b->q, lane3_set(j->c->anchor));
    lane3 d = lane3_sub(lane3_add(j->b->p, rb), lane3_add(j->a->p, ra));
    if (j->c->flags & NOH_RAGDOLL_SLIDES) d = past_linear(j, d);
    const lanes square = lane3_dot(d, d), mask = lanes_less(lanes_set(1e-18f), square);
    const lanes inverse = lanes_inverse_root(mask, square);
    push_pair(j->b, rb, j->a, ra, mask, lane3_scale(d, inverse), lanes_mul(square, inverse));
}

static inline void solve_joint(const joint *j, lanes h)
{
    solve_anchors(j);
    if (j->c->flags & NOH_RAGDOLL_HINGE) solve_hinge(j);
    if (!(j->c->flags & NOH_RAGDOLL_LOOSE)) {
        if (!(j->c->flags & NOH_RAGDOLL_HINGE)) solve_swing(j);
        solve_twist(j);
    }
    solve_strength(j, h);
}

/* ---- the world ---- */

NOH_ALWAYS_INLINE lane3 contact_arm(const lane_body *b, uint32_t point, lanes radius)
{
    return lane3_madd(lane3_scale(b->z, b->at[point]), lanes_negate(radius), b->normals[point]);
}

/* How far a point of a body at `arm` has moved in this substep. */
NOH_ALWAYS_INLINE lane3 moved_at(const lane_body *b, lane3 arm)
{
    const lane3 turned = lane4_difference(b->q, b->q_before);
    return lane3_add(lane3_sub(b->p, b->p_before), lane3_cross(turned, arm));
}

/* How far to push where `depth` is below 0, after a move of `moved` along the normal: all of what this substep added,
 * and only a bounded part of what was there before, so that nothing is thrown. */
NOH_ALWAYS_INLINE lanes way_out(lanes depth, lanes moved, lanes push_out)
{
    const lanes zero = lanes_set(0.0f), before = lanes_sub(depth, moved);
    return lanes_max(lanes_sub(lanes_min(zero, lanes_add(before, push_out)), depth), zero);
}

/* Push out of the world along n where `depth` is below 0; then back along the ground by its motion there, as far as
 * friction holds. */
static inline void touch(lane_body *b, const noh_ragdoll_constants *c, uint32_t point, lanes at, lane3 n, lanes depth,
                         const noh_world *world, lanes push_out)
{
    const lanes zero = lanes_set(0.0f), mask = lanes_less(depth, zero);
    if (!lanes_any(mask)) return;
    b->normals[point] = lane3_choose(mask, n, b->normals[point]);
    b->at[point] = lanes_choose(mask, at, b->at[point]);
    const lane3 r = contact_arm(b, point, lanes_set(c->radius)), cross = lane3_cross(r, n);
    const lanes far = way_out(depth, lane3_dot(moved_at(b, r), n), push_out);
    const lanes push = over_weight(mask, far, push_weight(b, cross));
    if (world->restitution > 0.0f) {
        const lanes speed = lane3_dot(lane3_add(b->v, lane3_cross(b->w, r)), n);
        b->approach[point] = lanes_choose(mask, speed, b->approach[point]);
    }
    b->pushed[point] = lanes_add(b->pushed[point], push);
    b->p = lane3_choose(mask, lane3_madd(b->p, lanes_mul(push, b->mass), n), b->p);
    turn_body(b, mask, lane3_scale(inverse_inertia(b, cross), push));

    const lane3 arm = contact_arm(b, point, lanes_set(c->radius));
    const lane3 moved = moved_at(b, arm);
    const lane3 slid = lane3_madd(moved, lanes_negate(lane3_dot(moved, n)), n);
    const lanes square = lane3_dot(slid, slid), slides = lanes_and(mask, lanes_less(lanes_set(1e-18f), square));
    const lanes inverse = lanes_inverse_root(slides, square);
    const lane3 back = lane3_scale(slid, lanes_negate(inverse)), about = lane3_cross(arm, back);
    const lanes whole = over_weight(slides, lanes_mul(square, inverse), push_weight(b, about));
    const lanes held = lanes_min(whole, lanes_mul(lanes_set(world->friction), b->pushed[point]));
    b->p = lane3_choose(slides, lane3_madd(b->p, lanes_mul(held, b->mass), back), b->p);
    turn_body(b, slides, lane3_scale(inverse_inertia(b, about), held));
}

static inline lanes end_of(const noh_ragdoll_constants *c, uint32_t point)
{
    return lanes_set(point == 0 ? c->half : point == 1 ? -c->half : 0.0f);
}

static void touch_planes(lane_body *b, const noh_ragdoll_constants *c, const noh_world *world, const lane_world *place)
{
    for (uint32_t i = 0; i < world->plane_count; i++) {
        const lane3 n = lane3_set(world->planes[i].normal);
        const lanes far = lanes_add(place->plane_distances[i], lanes_set(c->radius));
        for (uint32_t point = 0; point < 2; point++) {
            const lanes at = end_of(c, point);
            const lanes depth = lanes_sub(lane3_dot(lane3_madd(b->p, at, b->z), n), far);
            touch(b, c, point, at, n, depth, world, place->push_out);
        }
    }
}

/* The value of one lane. */
NOH_ALWAYS_INLINE float lane_of(const lanes *v, uint32_t lane)
{
    return ((const float *)(const void *)v)[lane];
}

NOH_ALWAYS_INLINE void set_lane(lanes *v, uint32_t lane, float value)
{
    ((float *)(void *)v)[lane] = value;
}

/* A height field is looked up lane by lane. */
static void touch_field(lane_body *b, const noh_ragdoll_constants *c, const noh_world *world, const lane_world *place)
{
    for (uint32_t point = 0; point < 2; point++) {
        const lanes at = end_of(c, point);
        const lane3 end = lane3_madd(b->p, at, b->z);
        lane3 n = { lanes_set(0.0f), lanes_set(1.0f), lanes_set(0.0f) };
        lanes depth = lanes_set(1.0f);
        for (uint32_t lane = 0; lane < NOH_LANES; lane++) {
            const float origin[3] = { lane_of(&place->origin.x, lane), lane_of(&place->origin.y, lane),
                                      lane_of(&place->origin.z, lane) };
            float height, normal[3];
            if (noh_field_height_about(world->field, origin, lane_of(&end.x, lane), lane_of(&end.z, lane), &height,
                                       normal)) {
                set_lane(&n.x, lane, normal[0]);
                set_lane(&n.y, lane, normal[1]);
                set_lane(&n.z, lane, normal[2]);
                set_lane(&depth, lane, (lane_of(&end.y, lane) - height) * normal[1] - c->radius);
            }
        }
        touch(b, c, point, at, n, depth, world, place->push_out);
    }
}

/* The nearest points of two segments, given as centres and half vectors. at: -1..1 along each.
 * source  Ericson 2005, section 5.1.9 */
NOH_ALWAYS_INLINE void closest(lane3 a, lane3 half_a, lane3 b, lane3 half_b, lanes at[2])
{
    const lanes one = lanes_set(1.0f), less = lanes_set(-1.0f), tiny = lanes_set(1e-12f);
    const lane3 r = lane3_sub(a, b);
    const lanes aa = lane3_dot(half_a, half_a), bb = lane3_dot(half_b, half_b), ab = lane3_dot(half_a, half_b);
    const lanes ar = lane3_dot(half_a, r), br = lane3_dot(half_b, r);
    const lanes square = lanes_sub(lanes_mul(aa, bb), lanes_mul(ab, ab));
    const lanes crossed = lanes_less(lanes_mul(lanes_set(1e-6f), lanes_mul(aa, bb)), square);
    lanes s = lanes_sub(lanes_mul(ab, br), lanes_mul(ar, bb));
    s = lanes_choose(crossed, lanes_div(s, lanes_choose(crossed, square, one)), lanes_set(0.0f));
    s = lanes_max(lanes_min(s, one), less);
    lanes t = lanes_div(lanes_add(lanes_mul(ab, s), br), lanes_max(bb, tiny));
    t = lanes_max(lanes_min(t, one), less);
    s = lanes_div(lanes_sub(lanes_mul(ab, t), ar), lanes_max(aa, tiny));
    at[0] = lanes_max(lanes_min(s, one), less);
    at[1] = t;
}

/* From a capsule's axis to the first body: the common way out for all bodies whose axes are inside it; otherwise the
 * doll would be caught around it. */
static lane3 way_to_root(const lane_world *place, const noh_capsule *k, lane3 middle, lane3 half)
{
    static const float up[3] = { 0.0f, 1.0f, 0.0f };
    const lanes one = lanes_set(1.0f), square = lanes_max(lane3_dot(half, half), lanes_set(1e-12f));
    const lane3 from = lane3_sub(place->root, middle);
    const lanes t = lanes_max(lanes_min(lanes_div(lane3_dot(from, half), square), one), lanes_set(-1.0f));
    const lane3 out = lane3_madd(from, lanes_negate(t), half);
    const lanes far = lane3_dot(out, out), some = lanes_less(lanes_set(1e-6f), far);
    float axis[3], across[3];
    noh_sub3(k->to, k->from, axis);
    noh_normalize3(axis, up);
    noh_perpendicular3(axis, up, across);
    return lane3_choose(some, lane3_scale(out, lanes_inverse_root(some, far)), lane3_set(across));
}

static void touch_capsules(lane_body *b, const noh_ragdoll_constants *c, const noh_world *world,
                           const lane_world *place)
{
    for (uint32_t i = 0; i < world->capsule_count; i++) {
        const noh_capsule *k = &world->capsules[i];
        const lane3 from = lane3_sub(lane3_set(k->from), place->origin);
        const lane3 to = lane3_sub(lane3_set(k->to), place->origin);
        const lane3 middle = lane3_scale(lane3_add(from, to), lanes_set(0.5f));
        const lane3 half = lane3_scale(lane3_sub(to, from), lanes_set(0.5f));
        lanes at[2];
        closest(b->p, lane3_scale(b->z, lanes_set(c->half)), middle, half, at);
        const lanes along = lanes_mul(at[0], lanes_set(c->half));
        const lane3 d = lane3_sub(lane3_madd(b->p, along, b->z), lane3_madd(middle, at[1], half));
        const lanes square = lane3_dot(d, d), mask = lanes_less(lanes_set(1e-12f), square);
        const lanes inverse = lanes_inverse_root(mask, square), reach = lanes_set(k->radius + c->radius);
        const lanes inside = lanes_less(square, lanes_set(k->radius * k->radius));
        lanes depth = lanes_choose(mask, lanes_sub(lanes_mul(square, inverse), reach), lanes_set(1.0f));
        lane3 n = lane3_scale(d, inverse);
        if (lanes_any(inside)) {
            const lane3 out = way_to_root(place, k, middle, half);
            n = lane3_choose(inside, out, n);
            depth = lanes_choose(inside, lanes_sub(lane3_dot(d, out), reach), depth);
        }
        touch(b, c, 2, along, n, depth, world, place->push_out);
    }
}

/* How far a point in a box's space is beyond the box's side on one axis, on either side. */
NOH_ALWAYS_INLINE lanes past_side(lanes at, float half)
{
    return lanes_sub(lanes_abs(at), lanes_set(half));
}

NOH_ALWAYS_INLINE lanes with_sign(lanes size, lanes sign)
{
    return lanes_choose(lanes_less(sign, lanes_set(0.0f)), lanes_negate(size), size);
}

/* The cost of a way out through one side of a box, below or above 0, for a point and the first body together, or, if
 * the box contains the first body, for that body alone. A box that contains it most likely stands on the ground: no way
 * leads down. up: component along the axis, in the world */
NOH_ALWAYS_INLINE lanes cost_of_side(lanes at, lanes root, lanes held, float half, lanes up, lanes *below)
{
    const lanes h = lanes_set(half), zero = lanes_set(0.0f), own = lanes_choose(held, root, at);
    const lanes steep = lanes_set(DOWN), ground = lanes_set(NO_WAY);
    lanes above = lanes_add(lanes_sub(h, own), lanes_max(lanes_sub(h, root), zero));
    lanes under = lanes_add(lanes_add(h, own), lanes_max(lanes_add(h, root), zero));
    above = lanes_add(above, lanes_choose(lanes_and(held, lanes_less(up, lanes_negate(steep))), ground, zero));
    under = lanes_add(under, lanes_choose(lanes_and(held, lanes_less(steep, up)), ground, zero));
    *below = lanes_less(under, above);
    return lanes_min(under, above);
}

/* Push out of a box that contains the point: through one side for all that is inside; otherwise a doll would be caught
 * around it. up: in the box's space */
static lanes out_with_root(const noh_obb *box, lane3 l, lane3 root, lane3 up, lane3 *n)
{
    const lanes zero = lanes_set(0.0f), one = lanes_set(1.0f), less = lanes_set(-1.0f);
    const lanes past = lanes_max(lanes_max(past_side(root.x, box->half[0]), past_side(root.y, box->half[1])),
                                 past_side(root.z, box->half[2]));
    const lanes held = lanes_less(past, zero);
    lane3 below;
    const lanes x = cost_of_side(l.x, root.x, held, box->half[0], up.x, &below.x);
    const lanes y = cost_of_side(l.y, root.y, held, box->half[1], up.y, &below.y);
    const lanes z = cost_of_side(l.z, root.z, held, box->half[2], up.z, &below.z);
    const lanes not_x = lanes_less(lanes_min(y, z), x), not_y = lanes_less(z, y);
    n->x = lanes_choose(not_x, zero, lanes_choose(below.x, less, one));
    n->y = lanes_choose(not_x, lanes_choose(not_y, zero, lanes_choose(below.y, less, one)), zero);
    n->z = lanes_choose(lanes_and(not_x, not_y), lanes_choose(below.z, less, one), zero);
    const lanes half = lanes_choose(not_x, lanes_choose(not_y, lanes_set(box->half[2]), lanes_set(box->half[1])),
                                    lanes_set(box->half[0]));
    return lanes_sub(lane3_dot(l, *n), half);
}

/* Direction out of a box, in its space, and the distance, for a point outside the box. */
NOH_ALWAYS_INLINE lanes out_of_box(const noh_obb *box, lane3 l, lane3 *n, lanes *outside)
{
    const lanes zero = lanes_set(0.0f);
    const lane3 past = { past_side(l.x, box->half[0]), past_side(l.y, box->half[1]), past_side(l.z, box->half[2]) };
    const lane3 off = { lanes_max(past.x, zero), lanes_max(past.y, zero), lanes_max(past.z, zero) };
    const lanes square = lane3_dot(off, off);
    *outside = lanes_less(lanes_set(1e-12f), square);
    const lanes inverse = lanes_inverse_root(*outside, square);
    const lane3 size = lane3_scale(off, inverse);
    n->x = with_sign(size.x, l.x);
    n->y = with_sign(size.y, l.y);
    n->z = with_sign(size.z, l.z);
    return lanes_mul(square, inverse);
}

static void touch_boxes(lane_body *b, const noh_ragdoll_constants *c, const noh_world *world, const lane_world *place)
{
    static const float world_up[3] = { 0.0f, 1.0f, 0.0f };
    for (uint32_t i = 0; i < world->box_count; i++) {
        const noh_obb *box = &world->boxes[i];
        const lane4 q = lane4_set(box->rotation);
        const lane3 centre = lane3_sub(lane3_set(box->centre), place->origin);
        const lanes all = lanes_less(lanes_set(0.0f), lanes_set(1.0f));
        for (uint32_t point = 0; point < POINTS; point++) {
            const lanes half = lanes_set(c->half), to = lane3_dot(lane3_sub(centre, b->p), b->z);
            const lanes nearest = lanes_max(lanes_min(to, half), lanes_negate(half));
            const lanes at = point < 2 ? end_of(c, point) : nearest;
            const lane3 from = lane3_sub(lane3_madd(b->p, at, b->z), centre);
            const lane3 l = lane4_rotate(lane4_conjugate(q), from);
            lanes outside;
            lane3 n;
            lanes depth = out_of_box(box, l, &n, &outside);
            const lanes inside = lanes_choose(outside, lanes_set(0.0f), all);
            if (lanes_any(inside)) {
                const lane3 root = lane4_rotate(lane4_conjugate(q), lane3_sub(place->root, centre));
                const lane3 up = lane4_rotate(lane4_conjugate(q), lane3_set(world_up));
                lane3 out;
                depth = lanes_choose(outside, depth, out_with_root(box, l, root, up, &out));
                n = lane3_choose(outside, n, out);
            }
            depth = lanes_sub(depth, lanes_set(c->radius));
            touch(b, c, point, at, lane4_rotate(q, n), depth, world, place->push_out);
        }
    }
}

/* Like planes of the world, in the order in which ends meet those. */
static void touch_asked(lane_body *b, const noh_ragdoll_constants *c, const noh_world *world, const lane_world *place,
                        const lane_touch *touches)
{
    for (uint32_t i = 0; i < NOH_TOUCHES_MAX; i++) {
        const uint32_t point = i >= 2u * END_TOUCHES ? 2u : i % 2u;
        const lane_touch *t = &touches[point == 2u ? i : i / 2u + point * END_TOUCHES];
        const lanes far = lanes_add(t->distance, lanes_set(c->radius));
        const lanes depth = lanes_sub(lane3_dot(lane3_madd(b->p, t->at, b->z), t->normal), far);
        touch(b, c, point, t->at, t->normal, depth, world, place->push_out);
    }
}

/* touches: [NOH_TOUCHES_MAX] of this body; NULL: the world is not asked */
static inline void solve_world(lane_body *b, const noh_ragdoll_constants *c, const noh_world *world,
                               const lane_world *place, const lane_touch *touches)
{
    if (touches) touch_asked(b, c, world, place, touches);
    touch_planes(b, c, world, place);
    if (world->field) touch_field(b, c, world, place);
    touch_capsules(b, c, world, place);
    touch_boxes(b, c, world, place);
}

static inline const lane_touch *touches_of(const lane_touch *touches, uint32_t body)
{
    return touches ? touches + body * NOH_TOUCHES_MAX : NULL;
}

/* ---- bodies of a doll against each other ---- */

static inline void solve_pair(const noh_ragdoll_shape *shape, const noh_ragdoll_pair *pair, lane_body *bodies,
                              lanes push_out)
{
    lane_body *a = &bodies[pair->a], *b = &bodies[pair->b];
    const float half_a = shape->bodies[pair->a].half, half_b = shape->bodies[pair->b].half;
    const lane3 between = lane3_sub(b->p, a->p);
    const float reach = half_a + half_b + pair->distance;
    if (!lanes_any(lanes_less(lane3_dot(between, between), lanes_set(reach * reach)))) return;
    const lane3 axis_a = lane3_scale(a->z, lanes_set(half_a)), axis_b = lane3_scale(b->z, lanes_set(half_b));
    lanes at[2];
    closest(a->p, axis_a, b->p, axis_b, at);
    const lane3 ra = lane3_scale(axis_a, at[0]), rb = lane3_scale(axis_b, at[1]);
    const lane3 d = lane3_sub(lane3_add(b->p, rb), lane3_add(a->p, ra));
    const lanes square = lane3_dot(d, d), least = lanes_set(pair->distance);
    const lanes mask = lanes_and(lanes_less(lanes_set(1e-12f), square), lanes_less(square, lanes_mul(least, least)));
    if (!lanes_any(mask)) return;
    const lanes inverse = lanes_inverse_root(mask, square);
    const lane3 n = lane3_scale(d, inverse);
    const lanes moved = lane3_dot(lane3_sub(moved_at(b, rb), moved_at(a, ra)), n);
    const lanes depth = lanes_sub(lanes_mul(square, inverse), least);
    push_pair(a, ra, b, rb, mask, n, way_out(depth, moved, push_out));
}

/* ---- substeps ---- */

static inline void predict(lane_body *b, lanes h, float fall, float speed_max)
{
    const lanes free = lanes_less(lanes_set(0.0f), b->mass), top = lanes_set(speed_max);
    b->p_before = b->p;
    b->q_before = b->q;
    b->v.y = lanes_choose(free, lanes_sub(b->v.y, lanes_set(fall)), b->v.y);
    const lanes square = lane3_dot(b->v, b->v), fast = lanes_and(free, lanes_less(lanes_mul(top, top), square));
    if (lanes_any(fast)) {
        b->v = lane3_choose(fast, lane3_scale(b->v, lanes_mul(top, lanes_inverse_root(fast, square))), b->v);
    }
    b->p = lane3_madd(b->p, h, b->v);
    b->q = lane4_normalize(lane4_turn(b->q, lane3_scale(b->w, h)));
    b->z = lane4_axis_z(b->q);
    for (uint32_t i = 0; i < POINTS; i++) b->pushed[i] = lanes_set(0.0f);
}

/* Stop what separates from the world, or let it leave at a share of its approach speed; approach speeds up to what
 * gravity adds in two substeps only rest. */
static inline void bounce(lane_body *b, const noh_ragdoll_constants *c, float restitution, float fall)
{
    const lanes zero = lanes_set(0.0f);
    for (uint32_t point = 0; point < POINTS; point++) {
        lanes mask = lanes_less(lanes_set(0.0f), b->pushed[point]);
        if (!lanes_any(mask)) continue;
        const lane3 n = b->normals[point], r = contact_arm(b, point, lanes_set(c->radius));
        const lanes away = lane3_dot(lane3_add(b->v, lane3_cross(b->w, r)), n);
        const lane3 cross = lane3_cross(r, n);
        lanes wanted = zero;
        if (restitution > 0.0f) {
            const lanes fast = lanes_less(b->approach[point], lanes_set(-2.0f * fall));
            wanted = lanes_choose(fast, lanes_mul(b->approach[point], lanes_set(-restitution)), zero);
        }
        const lanes over = lanes_sub(away, wanted);
        mask = lanes_and(mask, lanes_or(lanes_less(zero, over), lanes_less(zero, wanted)));
        const lanes push = over_weight(mask, lanes_negate(over), push_weight(b, cross));
        b->v = lane3_choose(mask, lane3_madd(b->v, lanes_mul(push, b->mass), n), b->v);
        b->w = lane3_choose(mask, lane3_madd(b->w, push, inverse_inertia(b, cross)), b->w);
    }
}

static inline void take_velocity(lane_body *b, lanes per_second)
{
    b->q = lane4_normalize(b->q);
    b->v = lane3_scale(lane3_sub(b->p, b->p_before), per_second);
    b->w = lane3_scale(lane4_turned(b->q, b->q_before), per_second);
}

/* A joint does not turn below a torque. */
static inline void rub_joint(const joint *j, float seconds)
{
    const lane3 d = lane3_sub(j->b->w, j->a->w);
    const lanes square = lane3_dot(d, d), mask = lanes_less(lanes_set(1e-12f), square);
    const lanes inverse = lanes_inverse_root(mask, square);
    const lane3 n = lane3_scale(d, inverse);
    const lanes weight = lanes_add(turn_weight(j->a, n), turn_weight(j->b, n));
    const lanes whole = over_weight(mask, lanes_mul(square, inverse), weight);
    const lanes held = lanes_min(whole, lanes_set(j->c->friction * seconds));
    j->a->w = lane3_choose(mask, lane3_madd(j->a->w, held, inverse_inertia(j->a, n)), j->a->w);
    j->b->w = lane3_choose(mask, lane3_madd(j->b->w, lanes_negate(held), inverse_inertia(j->b, n)), j->b->w);
}

static void substep(const noh_ragdoll_shape *shape, const noh_world *world, lane_world *place, lane_body *bodies,
                    const lane_touch *touches, float seconds, float size)
{
    const lanes h = lanes_set(seconds);
    const float fall = NOH_GRAVITY * seconds / size; /* the speed that gravity adds */
    for (uint32_t i = 0; i < shape->body_count; i++) predict(&bodies[i], h, fall, shape->speed_max);
    for (uint32_t i = 0; i < shape->pair_count; i++) solve_pair(shape, &shape->pairs[i], bodies, place->push_out);
    for (uint32_t i = 1; i < shape->body_count; i++) {
        const joint j = { &shape->bodies[i], &bodies[shape->bodies[i].parent], &bodies[i], place->turn_back };
        solve_joint(&j, h);
    }
    place->root = bodies[0].p;
    for (uint32_t i = 0; world && i < shape->body_count; i++) {
        solve_world(&bodies[i], &shape->bodies[i], world, place, touches_of(touches, i));
    }
    for (uint32_t i = 0; i < shape->body_count; i++) {
        take_velocity(&bodies[i], lanes_set(1.0f / seconds));
        if (world) bounce(&bodies[i], &shape->bodies[i], world->restitution, fall);
    }
    for (uint32_t i = 1; i < shape->body_count; i++) {
        const joint j = { &shape->bodies[i], &bodies[shape->bodies[i].parent], &bodies[i], place->turn_back };
        if (j.c->friction > 0.0f) rub_joint(&j, seconds / size);
    }
}

static inline void settle_world(const noh_ragdoll_shape *shape, const noh_world *world, const lane_world *place,
                                const lane_touch *touches, lane_body *b, uint32_t body)
{
    noh_ragdoll_constants thinner = shape->bodies[body];
    const float most = 0.5f * thinner.radius;
    thinner.radius -= shape->slack < most ? shape->slack : most;
    for (uint32_t i = 0; i < POINTS; i++) b->pushed[i] = lanes_set(0.0f);
    solve_world(b, &thinner, world, place, touches_of(touches, body));
}

/* Reduce the remaining errors without changing velocities: joints once more, then their anchors from the last body to
 * the first, opposite to the order within a substep; otherwise separations caused by the ground would last as long as
 * it pushes. The world comes last, but only beyond its slack: a full correction would separate joints again. */
static inline void settle(const noh_ragdoll_shape *shape, const noh_world *world, lane_world *place, lane_body *bodies,
                          const lane_touch *touches)
{
    for (uint32_t i = 0; i < shape->body_count; i++) {
        bodies[i].p_before = bodies[i].p;
        bodies[i].q_before = bodies[i].q;
    }
    for (uint32_t i = 1; i < shape->body_count; i++) {
        const joint j = { &shape->bodies[i], &bodies[shape->bodies[i].parent], &bodies[i], place->turn_back };
        solve_joint(&j, lanes_set(0.0f));
    }
    for (uint32_t i = shape->body_count; i-- > 1u;) {
        const joint j = { &shape->bodies[i], &bodies[shape->bodies[i].parent], &bodies[i], place->turn_back };
        solve_anchors(&j);
    }
    place->root = bodies[0].p;
    for (uint32_t i = 0; i < shape->body_count; i++) {
        if (world) settle_world(shape, world, place, touches, &bodies[i], i);
        bodies[i].q = lane4_normalize(bodies[i].q);
    }
}

/* Held bodies arrive at their goals at the end of the step. */
static void send_held(lane_body *b, lanes per_second)
{
    const lanes held = lanes_less(b->mass, lanes_set(1e-30f));
    const lane3 v = lane3_scale(lane3_sub(b->goal_p, b->p), per_second);
    const lane3 w = lane3_scale(lane4_difference(b->goal_q, b->q), per_second);
    b->v = lane3_choose(held, v, b->v);
    b->w = lane3_choose(held, w, b->w);
}

/* Ask what the bodies of dolls touch, doll after doll. Lanes without a doll repeat the last one. */
static void ask(const noh_ragdoll_shape *shape, const noh_world *world, noh_ragdoll_doll *const *dolls, uint32_t count,
                lane_touch *touches)
{
    noh_touches answers[NOH_RAGDOLL_BODIES_MAX];
    memset(answers, 0, sizeof answers);
    for (uint32_t lane = 0; lane < NOH_LANES; lane++) {
        if (lane < count) noh_ragdoll_ask(shape, world, dolls[lane], answers);
        for (uint32_t i = 0; i < shape->body_count; i++) {
            load_touches(&answers[i], shape->bodies[i].half, touches + i * NOH_TOUCHES_MAX, lane);
        }
    }
}

void NOH_RAGDOLL_STEP(const noh_ragdoll_shape *shape, const noh_world *world, noh_ragdoll_doll *const *dolls,
                      uint32_t count, float *scratch, float size)
{
    const int asks = world && noh_world_asks(world);
    lane_body *bodies = (lane_body *)(void *)scratch;
    lane_world *place = (lane_world *)(void *)(bodies + NOH_RAGDOLL_BODIES_MAX);
    lane_touch *touches = asks ? (lane_touch *)(void *)(place + 1) : NULL;
    const float seconds = 1.0f / (60.0f * (float)shape->substeps);
    for (uint32_t first = 0; first < count; first += NOH_LANES) {
        const uint32_t lanes_used = count - first < NOH_LANES ? count - first : NOH_LANES;
        for (uint32_t lane = 0; lane < NOH_LANES; lane++) { /* lanes without a doll repeat the last one */
            const noh_ragdoll_doll *doll = dolls[first + (lane < lanes_used ? lane : lanes_used - 1u)];
            load_doll(shape, doll, bodies, lane);
            load_place(world, doll, seconds, place, lane);
        }
        if (asks) ask(shape, world, dolls + first, lanes_used, touches);
        place->push_out = lanes_set(NOH_PUSH_OUT_SPEED * seconds / size);
        for (uint32_t i = 0; i < shape->body_count; i++) send_held(&bodies[i], lanes_set(60.0f));
        for (uint32_t s = 0; s < shape->substeps; s++) substep(shape, world, place, bodies, touches, seconds, size);
        settle(shape, world, place, bodies, touches);
        for (uint32_t lane = 0; lane < lanes_used; lane++) store_doll(shape, dolls[first + lane], bodies, lane);
    }
}
