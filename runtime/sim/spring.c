/* spring.c: the reference's algorithm at a fixed rate, and what is shown between two of its steps. */
#include "sim/spring.h"

#include "base/arena.h"
#include "base/assert.h"
#include "sim/vector_internal.h"

/* The end of a joint. Positions count from where the first joint was in the last step, so that a character far from the
 * origin loses no digits. */
typedef struct point {
    float now[3], before[3]; /* of the last two steps */
    float length;
} point;

/* Behind it point[joint_count], then noh_spring_collider[collider_count] as of the last call. */
struct noh_spring {
    uint32_t joint_count, collider_count, collides;
    uint32_t left;              /* ticks since the last step */
    noh_spring_carrier last;    /* of the last call */
    noh_spring_carrier stepped; /* of the last step */
    float moved[3];             /* by which the carrier moved in the last step */
    float turned[4];            /* its rotation in the step before */
    uint32_t reserved;
};
NOH_STATIC_ASSERT(sizeof(noh_spring) == 104, spring);
NOH_STATIC_ASSERT(sizeof(point) == 28, point);

static point *points_of(noh_spring *s)
{
    return (point *)(void *)(s + 1);
}

static const point *const_points_of(const noh_spring *s)
{
    return (const point *)(const void *)(s + 1);
}

static noh_spring_collider *colliders_of(noh_spring *s)
{
    return (noh_spring_collider *)(void *)(points_of(s) + s->joint_count);
}

/* ---- size and init ---- */

size_t noh_spring_size(const noh_spring_desc *desc)
{
    if (!desc->joint_count || desc->joint_count > NOH_SPRING_JOINTS_MAX ||
        desc->collider_count > NOH_SPRING_COLLIDERS_MAX) {
        return 0;
    }
    const size_t bytes = sizeof(noh_spring) + desc->joint_count * sizeof(point) +
                         desc->collider_count * sizeof(noh_spring_collider);
    return (bytes + 15u) & ~(size_t)15u;
}

static int is_good(const noh_spring_joint *j)
{
    const float square = noh_dot3(j->bone, j->bone), unit = noh_quat_dot(j->rest, j->rest);
    return square > 1e-16f && noh_is_finite(square) && unit > 0.99f && unit < 1.01f && j->stiffness >= 0.0f &&
           noh_is_finite(j->stiffness) && j->drag >= 0.0f && j->drag <= 1.0f && j->radius >= 0.0f &&
           noh_is_finite(j->radius) && noh_is_finite(noh_dot3(j->gravity, j->gravity));
}

noh_result noh_spring_check_desc(const noh_spring_desc *desc, noh_error *error)
{
    NOH_ASSERT(desc);
    if (!noh_spring_size(desc)) {
        return noh_fail(error, NOH_ERR_LIMIT, "a spring has no joints, or more joints or colliders than the limit",
                        desc->joint_count, NOH_SPRING_JOINTS_MAX);
    }
    for (uint32_t i = 0; i < desc->joint_count; i++) {
        if (!is_good(&desc->joints[i])) {
            return noh_fail(error, NOH_ERR_ARG, "a spring's joint has no length, or a number out of its range", i, 0);
        }
    }
    return NOH_OK;
}

noh_result noh_spring_init(void *memory, size_t bytes, const noh_spring_desc *desc, const noh_spring_carrier *carrier,
                           noh_spring **spring, noh_error *error)
{
    noh_arena arena;
    NOH_ASSERT(desc && carrier && spring);
    noh_result result = noh_spring_check_desc(desc, error);
    if (result) return result;
    result = noh_arena_open(&arena, memory, bytes, noh_spring_size(desc), error);
    if (result) return result;
    noh_spring *s = memory;
    memset(s, 0, noh_spring_size(desc));
    s->joint_count = desc->joint_count;
    s->collider_count = desc->collider_count;
    for (uint32_t i = 0; i < desc->joint_count; i++) points_of(s)[i].length = noh_length3(desc->joints[i].bone);
    noh_spring_reset(s, desc, carrier);
    *spring = s;
    return NOH_OK;
}

void noh_spring_reset(noh_spring *spring, const noh_spring_desc *desc, const noh_spring_carrier *carrier)
{
    float rotation[4], at[3] = { 0.0f, 0.0f, 0.0f };
    NOH_ASSERT(spring && desc && carrier && desc->joint_count == spring->joint_count);
    memcpy(rotation, carrier->rotation, sizeof rotation);
    for (uint32_t i = 0; i < desc->joint_count; i++) {
        point *p = &points_of(spring)[i];
        float bone[3];
        noh_quat_mul(rotation, desc->joints[i].rest, rotation);
        noh_quat_rotate(rotation, desc->joints[i].bone, bone);
        noh_madd3(at, 1.0f, bone, at);
        memcpy(p->now, at, sizeof at);
        memcpy(p->before, at, sizeof at);
    }
    spring->last = spring->stepped = *carrier;
    spring->collides = 0;
    spring->left = 0;
    memset(spring->moved, 0, sizeof spring->moved);
    memcpy(spring->turned, carrier->rotation, sizeof spring->turned);
}

/* ---- from outside ---- */

/* Numbers that steps can go on from: squares of their differences stay finite. */
static int are_sound(const float *v, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!(v[i] > -1e15f && v[i] < 1e15f)) return 0;
    }
    return 1;
}

static int turns(const float q[4])
{
    const float square = noh_quat_dot(q, q);
    return square > 0.9f && square < 1.1f;
}

const char *noh_spring_check(const noh_spring *spring, const noh_spring_desc *desc)
{
    const noh_spring *s = spring;
    NOH_ASSERT(spring && desc);
    if (s->joint_count != desc->joint_count || s->collider_count != desc->collider_count) {
        return "a spring is of another desc";
    }
    if (s->collides > 1u || s->left >= NOH_SPRING_STEP_TICKS || !turns(s->last.rotation) ||
        !turns(s->stepped.rotation) || !turns(s->turned) || !are_sound(s->last.position, 3) ||
        !are_sound(s->stepped.position, 3) || !are_sound(s->moved, 3)) {
        return "a spring's time or carrier is out of range";
    }
    for (uint32_t i = 0; i < s->joint_count; i++) {
        const point *p = &const_points_of(s)[i];
        if (!are_sound(p->now, 3) || !are_sound(p->before, 3) || p->length != noh_length3(desc->joints[i].bone)) {
            return "a spring's joint is out of range";
        }
    }
    const noh_spring_collider *c = (const noh_spring_collider *)(const void *)(const_points_of(s) + s->joint_count);
    for (uint32_t i = 0; i < s->collider_count; i++) {
        if (!are_sound(c[i].from, 3) || !are_sound(c[i].to, 3) || !are_sound(&c[i].radius, 1)) {
            return "a spring's collider is out of range";
        }
    }
    return NULL;
}

/* ---- one step ---- */

/* A collider as a step looks at it: from the first joint. */
typedef struct obstacle {
    float from[3], axis[3];
    float per_square; /* 1 over the square of the axis; 0 for a sphere */
    float radius;
} obstacle;

static obstacle obstacle_of(const noh_spring_collider *c, const float origin[3])
{
    obstacle o;
    noh_sub3(c->from, origin, o.from);
    noh_sub3(c->to, c->from, o.axis);
    const float square = noh_dot3(o.axis, o.axis);
    o.per_square = square > 0.0f ? 1.0f / square : 0.0f;
    o.radius = c->radius;
    return o;
}

/* Push a joint's end out of a capsule, then back to its distance from the joint. */
static void push_out(const obstacle *o, const float head[3], float radius, float length, float tail[3])
{
    const float wanted = o->radius + radius;
    float away[3];
    noh_sub3(tail, o->from, away);
    const float along = noh_dot3(away, o->axis) * o->per_square;
    noh_madd3(away, along <= 0.0f ? 0.0f : along >= 1.0f ? -1.0f : -along, o->axis, away);
    const float distance = noh_dot3(away, away);
    if (distance >= wanted * wanted || distance <= 0.0f) return;
    noh_madd3(tail, wanted / noh_sqrt(distance) - 1.0f, away, tail);
    noh_sub3(tail, head, away);
    noh_normalize3(away, o->axis);
    noh_madd3(head, length, away, tail);
}

/* The world rotation of a joint whose bone points along a direction: rest, and from there by the shortest way.
 * at_rest: its bone by `rest`, its world rotation at rest */
static void turn_towards(const float rest[4], const float at_rest[3], const float bone[3], float out[4])
{
    static const float up[3] = { 0.0f, 1.0f, 0.0f };
    float swing[4];
    noh_quat_between(at_rest, bone, up, swing);
    noh_quat_mul(swing, rest, out);
}

static void step(noh_spring *s, const noh_spring_desc *desc, const noh_spring_carrier *carrier,
                 const obstacle *obstacles)
{
    const float seconds = (float)NOH_SPRING_STEP_TICKS / 48000.0f;
    float rotation[4], head[3] = { 0.0f, 0.0f, 0.0f };
    memcpy(rotation, carrier->rotation, sizeof rotation);
    noh_sub3(carrier->position, s->stepped.position, s->moved);
    memcpy(s->turned, s->stepped.rotation, sizeof s->turned);
    for (uint32_t i = 0; i < s->joint_count; i++) {
        const noh_spring_joint *j = &desc->joints[i];
        point *p = &points_of(s)[i];
        float tail[3], rest[4], pull[3], bone[3];
        noh_quat_mul(rotation, j->rest, rest);
        noh_quat_rotate(rest, j->bone, pull);
        for (int c = 0; c < 3; c++) {
            const float inertia = (p->now[c] - p->before[c]) * (1.0f - j->drag);
            tail[c] = p->now[c] - s->moved[c] + inertia +
                      seconds * (j->stiffness * pull[c] / p->length + j->gravity[c]);
            p->before[c] = p->now[c] - s->moved[c];
        }
        noh_sub3(tail, head, bone);
        noh_normalize3(bone, pull);
        noh_madd3(head, p->length, bone, tail);
        for (uint32_t k = 0; k < s->collider_count; k++) {
            push_out(&obstacles[k], head, j->radius, p->length, tail);
        }
        memcpy(p->now, tail, sizeof tail);
        noh_sub3(tail, head, bone);
        turn_towards(rest, pull, bone, rotation);
        memcpy(head, tail, sizeof head);
    }
    s->stepped = *carrier;
}

/* ---- time ---- */

static void mix3(const float a[3], const float b[3], float t, float out[3])
{
    for (int i = 0; i < 3; i++) out[i] = a[i] + t * (b[i] - a[i]);
}

/* What carries the chain and its colliders, a share of the time from the last call to this one. */
static void advance(noh_spring *s, const noh_spring_desc *desc, const noh_spring_carrier *carrier,
                    const noh_spring_collider *colliders, float t)
{
    obstacle obstacles[NOH_SPRING_COLLIDERS_MAX];
    noh_spring_carrier at = *carrier;
    mix3(s->last.position, carrier->position, t, at.position);
    noh_quat_nlerp(s->last.rotation, carrier->rotation, t, at.rotation);
    for (uint32_t i = 0; i < s->collider_count; i++) {
        const noh_spring_collider *from = s->collides ? &colliders_of(s)[i] : &colliders[i];
        noh_spring_collider between;
        mix3(from->from, colliders[i].from, t, between.from);
        mix3(from->to, colliders[i].to, t, between.to);
        between.radius = from->radius + t * (colliders[i].radius - from->radius);
        obstacles[i] = obstacle_of(&between, at.position);
    }
    step(s, desc, &at, obstacles);
}

uint32_t noh_spring_step(noh_spring *spring, const noh_spring_desc *desc, const noh_spring_carrier *carrier,
                         const noh_spring_collider *colliders, uint32_t ticks)
{
    NOH_ASSERT(spring && desc && carrier && (colliders || !desc->collider_count));
    NOH_ASSERT(desc->joint_count == spring->joint_count && desc->collider_count == spring->collider_count);
    const uint64_t whole = ((uint64_t)spring->left + ticks) / NOH_SPRING_STEP_TICKS;
    const uint32_t steps = whole < NOH_SPRING_STEPS_MAX ? (uint32_t)whole : NOH_SPRING_STEPS_MAX;
    const uint32_t dropped = (uint32_t)(whole - steps) * NOH_SPRING_STEP_TICKS, kept = ticks - dropped;
    for (uint32_t i = 1; i <= steps; i++) {
        advance(spring, desc, carrier, colliders, (float)(i * NOH_SPRING_STEP_TICKS - spring->left) / (float)kept);
    }
    spring->left += kept - steps * NOH_SPRING_STEP_TICKS;
    spring->last = *carrier;
    if (spring->collider_count) {
        memcpy(colliders_of(spring), colliders, spring->collider_count * sizeof *colliders);
        spring->collides = 1;
    }
    return dropped;
}

/* ---- what is shown ---- */

/* From the first joint to the end of joint i, between the last two steps, turned along with what carries the chain: a
 * chain that is carried stiffly does not lag behind. `turn` is that rotation. */
static void shown(const noh_spring *s, uint32_t i, float t, const float turn[4], float out[3])
{
    const point *p = &const_points_of(s)[i];
    float before[3];
    noh_madd3(p->before, 1.0f, s->moved, before); /* from where the first joint was then */
    mix3(before, p->now, t, out);
    noh_quat_rotate(turn, out, out);
}

/* From the carrier's rotation of what is shown to that of the last call. */
static float begin_shown(const noh_spring *s, float turn[4])
{
    const float t = (float)s->left / (float)NOH_SPRING_STEP_TICKS;
    noh_quat_nlerp(s->turned, s->stepped.rotation, t, turn);
    noh_quat_conjugate(turn, turn);
    noh_quat_mul(s->last.rotation, turn, turn);
    return t;
}

void noh_spring_rotations(const noh_spring *spring, const noh_spring_desc *desc, float *rotations)
{
    float turn[4], parent[4], head[3] = { 0.0f, 0.0f, 0.0f };
    const float t = begin_shown(spring, turn);
    NOH_ASSERT(desc->joint_count == spring->joint_count && rotations);
    memcpy(parent, spring->last.rotation, sizeof parent);
    for (uint32_t i = 0; i < spring->joint_count; i++) {
        float tail[3], bone[3], rest[4], at_rest[3], world[4], back[4];
        shown(spring, i, t, turn, tail);
        noh_sub3(tail, head, bone);
        noh_quat_mul(parent, desc->joints[i].rest, rest);
        noh_quat_rotate(rest, desc->joints[i].bone, at_rest);
        turn_towards(rest, at_rest, bone, world);
        noh_quat_conjugate(parent, back);
        noh_quat_mul(back, world, rotations + 4 * (size_t)i);
        noh_quat_normalize(rotations + 4 * (size_t)i);
        memcpy(parent, world, sizeof parent);
        memcpy(head, tail, sizeof head);
    }
}

void noh_spring_ends(const noh_spring *spring, const noh_spring_desc *desc, float *ends)
{
    float turn[4], head[3] = { 0.0f, 0.0f, 0.0f }, at[3];
    const float t = begin_shown(spring, turn);
    NOH_ASSERT(desc->joint_count == spring->joint_count && ends);
    memcpy(at, spring->last.position, sizeof at);
    for (uint32_t i = 0; i < spring->joint_count; i++) {
        float tail[3], bone[3];
        shown(spring, i, t, turn, tail);
        noh_sub3(tail, head, bone);
        noh_normalize3(bone, desc->joints[i].bone);
        noh_madd3(at, const_points_of(spring)[i].length, bone, at); /* mixed directions, whole lengths */
        memcpy(ends + 3 * (size_t)i, at, sizeof at);
        memcpy(head, tail, sizeof head);
    }
}
