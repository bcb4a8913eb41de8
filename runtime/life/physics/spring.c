/* spring.c: chains at rest, checks of chains from outside, and the ends of joints. spring_lanes.c moves them. */
#include "life/physics/spring_internal.h"
#include "noh/base.h"
#include "noh/low_core.h"
#include "noh/low_life.h"

#include "core/base/assert_internal.h"
#include "core/base/vector_internal.h"

/* ---- size and init ---- */

size_t noh_spring_size(const noh_spring_desc *desc)
{
    if (!desc->joint_count || desc->joint_count > NOH_SPRING_JOINTS_MAX ||
        desc->collider_count > NOH_SPRING_COLLIDERS_MAX) {
        return 0;
    }
    const size_t bytes = sizeof(noh_spring) + desc->joint_count * sizeof(noh_spring_point) +
                         desc->collider_count * sizeof(noh_spring_collider);
    return (bytes + 15u) & ~(size_t)15u;
}

/* Turns are found by the fourth power of a bone's length. */
static int is_good(const noh_spring_joint *j)
{
    const float square = noh_dot3(j->bone, j->bone), unit = noh_quat_dot(j->rest, j->rest);
    return square > 1e-16f && noh_is_finite(16.0f * square * square) && unit > 0.99f && unit < 1.01f &&
           j->stiffness >= 0.0f && noh_is_number(j->stiffness) && j->drag >= 0.0f && j->drag <= 1.0f &&
           j->radius >= 0.0f && noh_is_number(j->radius) && noh_is_number3(j->gravity);
}

noh_result noh_spring_check_desc(const noh_spring_desc *desc, noh_error *error)
{
    NOH_ASSERT(desc);
    if (!noh_spring_size(desc)) {
        return noh_fail(error, NOH_ERR_LIMIT, "joint_count or collider_count of a spring desc is out of its range",
                        desc->joint_count, NOH_SPRING_JOINTS_MAX);
    }
    if (!(desc->restitution >= 0.0f && desc->restitution <= 1.0f)) {
        return noh_fail(error, NOH_ERR_ARG, "restitution of a spring must be 0 to 1", 0, 0);
    }
    for (uint32_t i = 0; i < desc->joint_count; i++) {
        if (!is_good(&desc->joints[i])) {
            return noh_fail(error, NOH_ERR_ARG, "a joint of a spring has length 0, or a number out of its range", i, 0);
        }
    }
    return NOH_OK;
}

static int turns(const float q[4])
{
    const float square = noh_quat_dot(q, q);
    return square > 0.9f && square < 1.1f;
}

int noh_spring_carries(const noh_spring_carrier *carrier)
{
    return noh_is_number3(carrier->position) && turns(carrier->rotation);
}

noh_result noh_spring_init(void *memory, size_t bytes, const noh_spring_desc *desc, const noh_spring_carrier *carrier,
                           noh_spring **spring, noh_error *error)
{
    noh_arena arena;
    NOH_ASSERT(desc && carrier && spring);
    noh_result result = noh_spring_check_desc(desc, error);
    if (result) return result;
    if (!noh_spring_carries(carrier)) {
        return noh_fail(error, NOH_ERR_ARG, "the carrier of a spring is out of range, or its rotation is not unit", 0,
                        0);
    }
    result = noh_arena_open(&arena, memory, bytes, noh_spring_size(desc), error);
    if (result) return result;
    noh_spring *s = memory;
    memset(s, 0, noh_spring_size(desc));
    s->joint_count = desc->joint_count;
    s->collider_count = desc->collider_count;
    for (uint32_t i = 0; i < desc->joint_count; i++) noh_spring_points(s)[i].length = noh_length3(desc->joints[i].bone);
    noh_spring_reset(s, desc, carrier);
    *spring = s;
    return NOH_OK;
}

void noh_spring_shift(noh_spring *spring, const float by[3])
{
    noh_sub3(spring->last.position, by, spring->last.position);
    noh_sub3(spring->stepped.position, by, spring->stepped.position);
    for (uint32_t i = 0; i < spring->collider_count; i++) {
        noh_spring_collider *c = &noh_spring_colliders(spring)[i];
        noh_sub3(c->from, by, c->from);
        noh_sub3(c->to, by, c->to);
    }
}

void noh_spring_reset(noh_spring *spring, const noh_spring_desc *desc, const noh_spring_carrier *carrier)
{
    float rotation[4], at[3] = { 0.0f, 0.0f, 0.0f };
    NOH_ASSERT(spring && desc && carrier && desc->joint_count == spring->joint_count);
    memcpy(rotation, carrier->rotation, sizeof rotation);
    for (uint32_t i = 0; i < desc->joint_count; i++) {
        noh_spring_point *p = &noh_spring_points(spring)[i];
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

/* ---- springs from outside ---- */

const char *noh_spring_check(const noh_spring *spring, const noh_spring_desc *desc)
{
    const noh_spring *s = spring;
    NOH_ASSERT(spring && desc);
    if (s->joint_count != desc->joint_count || s->collider_count != desc->collider_count) {
        return "the spring was made with another desc";
    }
    if (s->collides > 1u || s->left >= NOH_SPRING_STEP_TICKS || !turns(s->last.rotation) ||
        !turns(s->stepped.rotation) || !turns(s->turned) || !noh_are_sound(s->last.position, 3) ||
        !noh_are_sound(s->stepped.position, 3) || !noh_are_sound(s->moved, 3)) {
        return "a spring's time or carrier is out of range";
    }
    for (uint32_t i = 0; i < s->joint_count; i++) {
        const noh_spring_point *p = &noh_spring_const_points(s)[i];
        if (!noh_are_sound(p->now, 3) || !noh_are_sound(p->before, 3) ||
            p->length != noh_length3(desc->joints[i].bone)) {
            return "a spring's joint is out of range";
        }
    }
    const noh_spring_collider *c = (const noh_spring_collider *)(const void *)(noh_spring_const_points(s) +
                                                                               s->joint_count);
    for (uint32_t i = 0; i < s->collider_count; i++) {
        if (!noh_are_sound(c[i].from, 3) || !noh_are_sound(c[i].to, 3) || !noh_are_sound(&c[i].radius, 1)) {
            return "a spring's collider is out of range";
        }
    }
    return NULL;
}

/* ---- results ---- */

/* From the first joint to the end of joint i, interpolated between the last two steps and turned with the carrier: a
 * chain that is carried rigidly does not lag behind. `turn` is the carrier's rotation since. */
static void shown(const noh_spring *s, uint32_t i, float t, const float turn[4], float out[3])
{
    const noh_spring_point *p = &noh_spring_const_points(s)[i];
    float before[3];
    noh_madd3(p->before, 1.0f, s->moved, before); /* relative to the first joint at that time */
    noh_mix3(before, p->now, t, out);
    noh_quat_rotate(turn, out, out);
}

/* The rotation from the interpolated carrier to the carrier of the last call. */
static float begin_shown(const noh_spring *s, float turn[4])
{
    const float t = (float)s->left / (float)NOH_SPRING_STEP_TICKS;
    noh_quat_nlerp(s->turned, s->stepped.rotation, t, turn);
    noh_quat_conjugate(turn, turn);
    noh_quat_mul(s->last.rotation, turn, turn);
    return t;
}

void noh_spring_ends(const noh_spring *spring, const noh_spring_desc *desc, float *ends)
{
    NOH_ASSERT(desc->joint_count == spring->joint_count && ends);
    float turn[4], head[3] = { 0.0f, 0.0f, 0.0f }, at[3];
    const float t = begin_shown(spring, turn);
    memcpy(at, spring->last.position, sizeof at);
    for (uint32_t i = 0; i < spring->joint_count; i++) {
        float tail[3], bone[3];
        shown(spring, i, t, turn, tail);
        noh_sub3(tail, head, bone);
        noh_normalize3(bone, desc->joints[i].bone);
        /* directions are interpolated, lengths are kept */
        noh_madd3(at, noh_spring_const_points(spring)[i].length, bone, at);
        memcpy(ends + 3 * (size_t)i, at, sizeof at);
        memcpy(head, tail, sizeof head);
    }
}
