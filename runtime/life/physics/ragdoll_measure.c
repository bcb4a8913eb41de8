/* ragdoll_measure.c: how far a ragdoll violates its joints' limits and the world. */
#include "core/base/math_internal.h"
#include "core/base/trig_internal.h"
#include "core/base/assert_internal.h"
#include "life/physics/ragdoll_internal.h"
#include "noh/body.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "core/base/vector_internal.h"
#include "life/physics/world_ask_internal.h"
#include "life/physics/world_internal.h"
#include "life/physics/shape_internal.h"

#define REACH_LEAST 0.05f /* metres: a body at rest that something pulls moves less within 1/60 s */

static const noh_ragdoll_doll *doll_of(const noh_ragdolls *set, uint32_t doll)
{
    const uint8_t *dolls = (const uint8_t *)set + ((sizeof *set + 15u) & ~(size_t)15u);
    return (const noh_ragdoll_doll *)(const void *)dolls + doll;
}

/* ---- joints ---- */

typedef struct joint {
    const noh_ragdoll_constants *c;
    const noh_ragdoll_state *a, *b;
} joint;

/* Radians beyond the ellipse of swing. r: rotation of the child's frame in the parent's */
static float past_swing(const noh_ragdoll_constants *c, const float r[4])
{
    const float rest = r[2] * r[2] + r[3] * r[3], swung = r[0] * r[0] + r[1] * r[1];
    const float x = r[0] * r[3] - r[1] * r[2], y = r[0] * r[2] + r[1] * r[3];
    const float fill = x * x * c->swing[0] + y * y * c->swing[1];
    if (fill <= rest) return 0.0f;
    const float sine = noh_sqrt(swung * rest / fill), cosine = noh_sqrt(noh_larger(1.0f - sine * sine, 0.0f));
    return 2.0f * (noh_atan2(noh_sqrt(swung), noh_sqrt(rest)) - noh_atan2(sine, cosine));
}

static float past_twist(const noh_ragdoll_constants *c, const float r[4])
{
    const float sign = r[3] < 0.0f ? -1.0f : 1.0f, angle = noh_atan2(sign * r[2], sign * r[3]);
    const float low = noh_atan2(c->twist_min[0], c->twist_min[1]), high = noh_atan2(c->twist_max[0], c->twist_max[1]);
    return 2.0f * noh_larger(noh_larger(angle - high, low - angle), 0.0f);
}

static float past_limits(const joint *j)
{
    float a[4], b[4], back[4], r[4], swing;
    noh_quat_mul(j->a->rotation, j->c->frame_parent, a);
    noh_quat_mul(j->b->rotation, j->c->frame, b);
    noh_quat_conjugate(a, back);
    noh_quat_mul(back, b, r);
    if (j->c->flags & NOH_RAGDOLL_HINGE) { /* swing: the angle between its axes */
        swing = 2.0f * noh_atan2(noh_sqrt(r[0] * r[0] + r[1] * r[1]), noh_sqrt(r[2] * r[2] + r[3] * r[3]));
        return j->c->flags & NOH_RAGDOLL_LOOSE ? swing : noh_larger(swing, past_twist(j->c, r));
    }
    return j->c->flags & NOH_RAGDOLL_LOOSE ? 0.0f : noh_larger(past_swing(j->c, r), past_twist(j->c, r));
}

static float separation(const joint *j)
{
    float a[3], b[3], d[3], q[4], back[4];
    noh_quat_rotate(j->a->rotation, j->c->anchor_parent, a);
    noh_quat_rotate(j->b->rotation, j->c->anchor, b);
    noh_madd3(a, 1.0f, j->a->position, a);
    noh_madd3(b, 1.0f, j->b->position, b);
    noh_sub3(b, a, d);
    if (j->c->flags & NOH_RAGDOLL_SLIDES) {
        noh_quat_mul(j->a->rotation, j->c->frame_parent, q);
        noh_quat_conjugate(q, back);
        noh_quat_rotate(back, d, d);
        for (int i = 0; i < 3; i++) {
            const float high = j->c->linear_max[i], low = j->c->linear_min[i];
            d[i] -= d[i] > high ? high : d[i] < low ? low : d[i];
        }
    }
    return noh_length3(d);
}

/* ---- the world ---- */

/* How deep a point of thickness `radius` is in a box, through the nearest side. */
static float in_box(const noh_obb *at, const float origin[3], const float point[3], float radius)
{
    noh_obb local = *at;
    const noh_obb *box = &local;
    float closest[3], d[3], back[4], least = 1e30f;
    noh_sub3(at->centre, origin, local.centre);
    noh_obb_closest(box, point, closest);
    noh_sub3(point, closest, d);
    if (!noh_obb_contains(box, point)) return radius - noh_length3(d);
    noh_quat_conjugate(box->rotation, back);
    noh_sub3(point, box->centre, d);
    noh_quat_rotate(back, d, d);
    for (int i = 0; i < 3; i++) {
        const float in = box->half[i] - (d[i] < 0.0f ? -d[i] : d[i]);
        least = in < least ? in : least;
    }
    return least + radius;
}

/* point: relative to the origin */
static float in_ground(const noh_world *world, const float origin[3], const float point[3], float radius)
{
    float deepest = 0.0f, height, normal[3];
    for (uint32_t i = 0; i < world->plane_count; i++) {
        const noh_plane *p = &world->planes[i];
        const float distance = noh_plane_distance(p, origin);
        deepest = noh_larger(deepest, distance + radius - noh_dot3(point, p->normal));
    }
    for (uint32_t i = 0; i < world->box_count; i++) {
        deepest = noh_larger(deepest, in_box(&world->boxes[i], origin, point, radius));
    }
    if (world->field && noh_field_height_about(world->field, origin, point[0], point[2], &height, normal)) {
        deepest = noh_larger(deepest, radius - (point[1] - height) * normal[1]);
    }
    return deepest;
}

static float in_capsules(const noh_world *world, const float origin[3], const float from[3], const float to[3],
                         float radius)
{
    float deepest = 0.0f;
    for (uint32_t i = 0; i < world->capsule_count; i++) {
        const noh_capsule *k = &world->capsules[i];
        float along[2], p[3], q[3], d[3], a[3], b[3];
        noh_sub3(k->from, origin, a);
        noh_sub3(k->to, origin, b);
        noh_segments_closest(from, to, a, b, along);
        noh_sub3(to, from, d);
        noh_madd3(from, along[0], d, p);
        noh_sub3(b, a, d);
        noh_madd3(a, along[1], d, q);
        noh_sub3(p, q, d);
        deepest = noh_larger(deepest, k->radius + radius - noh_length3(d));
    }
    return deepest;
}

/* How deep a body is in what it touches by the answers of a world. */
static float in_asked(const noh_touches *touches, const noh_ragdoll_constants *c, const noh_ragdoll_state *s,
                      const float axis[3])
{
    float deepest = 0.0f;
    for (uint32_t i = 0; i < touches->count; i++) {
        const noh_touch *t = &touches->at[i];
        float point[3];
        noh_madd3(s->position, t->along * c->half, axis, point);
        deepest = noh_larger(deepest, t->plane.distance + c->radius - noh_dot3(point, t->plane.normal));
    }
    return deepest;
}

/* Within its reach lies what the ends of a body get to within 1/60 s, and as far again for what joints pull. */
void noh_ragdoll_ask(const noh_ragdoll_shape *shape, const noh_world *world, const noh_ragdoll_doll *doll,
                     noh_touches *touches)
{
    static const float z[3] = { 0.0f, 0.0f, 1.0f };
    noh_world_body asked[NOH_RAGDOLL_BODIES_MAX];
    const float size = noh_ragdoll_size(doll);
    float origin[3], rest[3] = { 0.0f, 0.0f, 0.0f };
    for (int k = 0; k < 3; k++) origin[k] = size * doll->origin[k];
    if (size != 1.0f) { /* floats far away do not hold it */
        noh_ragdoll_origin_near(origin, origin);
        for (int k = 0; k < 3; k++) rest[k] = (float)((double)size * (double)doll->origin[k] - (double)origin[k]);
    }
    for (uint32_t i = 0; i < shape->body_count; i++) {
        const noh_ragdoll_constants *c = &shape->bodies[i];
        const noh_ragdoll_state *s = &doll->bodies[i];
        noh_world_body *a = &asked[i];
        float axis[3];
        noh_quat_rotate(s->rotation, z, axis);
        noh_madd3(s->position, -c->half, axis, a->capsule.from);
        noh_madd3(s->position, c->half, axis, a->capsule.to);
        for (int k = 0; k < 3; k++) {
            a->origin[k] = origin[k];
            a->capsule.from[k] = size * a->capsule.from[k] + rest[k];
            a->capsule.to[k] = size * a->capsule.to[k] + rest[k];
        }
        a->capsule.radius = size * c->radius;
        a->reach = size * ((noh_length3(s->velocity) + c->half * noh_length3(s->spin)) / 30.0f) + REACH_LEAST;
    }
    noh_world_ask_touches(world, asked, shape->body_count, touches);
    for (uint32_t i = 0; i < shape->body_count; i++) {
        for (uint32_t k = 0; k < touches[i].count; k++) {
            noh_plane *plane = &touches[i].at[k].plane;
            plane->distance = (plane->distance - noh_dot3(plane->normal, rest)) / size;
        }
    }
}

/* ---- all ---- */

static float energy_of(const noh_ragdoll_constants *c, const noh_ragdoll_state *s, const float axis[3], float height)
{
    const float along = noh_dot3(s->spin, axis), all = noh_dot3(s->spin, s->spin);
    return 0.5f * c->mass * noh_dot3(s->velocity, s->velocity) + c->mass * NOH_GRAVITY * height +
           0.5f * (c->inertia_across * (all - along * along) + c->inertia_along * along * along);
}

void noh_ragdoll_measure(const noh_ragdolls *set, uint32_t doll, const noh_world *world, noh_ragdoll_measures *m)
{
    NOH_ASSERT(doll < set->count);
    static const float z[3] = { 0.0f, 0.0f, 1.0f };
    const noh_ragdoll_doll *d = doll_of(set, doll);
    NOH_ASSERT(!world || noh_ragdoll_size(d) == 1.0f);
    noh_touches touches[NOH_RAGDOLL_BODIES_MAX];
    const int asks = world && noh_world_asks(world);
    memset(m, 0, sizeof *m);
    memset(touches, 0, sizeof touches);
    if (asks) noh_ragdoll_ask(&set->shape, world, d, touches);
    for (uint32_t i = 0; i < set->shape.body_count; i++) {
        const noh_ragdoll_constants *c = &set->shape.bodies[i];
        const noh_ragdoll_state *s = &d->bodies[i];
        float axis[3], from[3], to[3];
        noh_quat_rotate(s->rotation, z, axis);
        noh_madd3(s->position, c->half, axis, from);
        noh_madd3(s->position, -c->half, axis, to);
        m->energy += energy_of(c, s, axis, d->origin[1] + s->position[1]);
        if (world) {
            m->penetration = noh_larger(m->penetration, in_ground(world, d->origin, from, c->radius));
            m->penetration = noh_larger(m->penetration, in_ground(world, d->origin, to, c->radius));
            m->penetration = noh_larger(m->penetration, in_capsules(world, d->origin, from, to, c->radius));
        }
        if (asks) m->penetration = noh_larger(m->penetration, in_asked(&touches[i], c, s, axis));
        if (i) {
            const joint j = { c, &d->bodies[c->parent], s };
            const float apart = separation(&j);
            m->limit = noh_larger(m->limit, past_limits(&j));
            m->separation = noh_larger(m->separation, apart);
            m->separation_mean += apart / (float)(set->shape.body_count - 1u);
        }
    }
}
