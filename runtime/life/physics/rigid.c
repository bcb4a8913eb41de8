/* rigid.c: a free rigid body: exact flight, rotation by splitting, contacts by impulses. */
#include "core/base/trig_internal.h"
#include "life/physics/rigid_internal.h"
#include "life/physics/world_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_core.h"
#include "noh/low_life.h"

#include "core/base/assert_internal.h"
#include "life/physics/contact_internal.h"
#include "life/physics/ragdoll_internal.h"
#include "core/base/vector_internal.h"

#define SECONDS ((float)NOH_RIGID_STEP_TICKS / 48000.0f)
#define STEPS_MAX 150u /* a quarter of a second */
#define SWEEPS 10u
#define SLACK 1e-4f /* metres of overlap that remain, so that resting bodies keep touching */
#define PUSH_PART 0.2f
#define BOUNCE_STEPS 4.0f /* an approach speed up to what gravity adds in this many substeps does not bounce */
#define STILL_SPEED 0.08f
#define STILL_STEPS 300u /* half a second */
#define TURN_MAX 1e18f   /* of a momentum or a torque: its square stays finite */
NOH_STATIC_ASSERT(sizeof(noh_rigid) == 144, rigid);

/* ---- making a body ---- */

/* Inertia of a solid of the shape; of the box around it unless it is a ball or capsule. */
static void solid_inertia(const noh_rigid_desc *d, float inertia[3])
{
    const float r = d->radius, m = d->mass, x = d->half[0] + r, y = d->half[1] + r, z = d->half[2] + r;
    if (d->half[0] > 0.0f || d->half[1] > 0.0f) {
        inertia[0] = m / 3.0f * (y * y + z * z);
        inertia[1] = m / 3.0f * (x * x + z * z);
        inertia[2] = m / 3.0f * (x * x + y * y);
        return;
    }
    const float h = d->half[2], tube = m * h / (h + 2.0f / 3.0f * r), ends = m - tube;
    inertia[2] = tube * 0.5f * r * r + ends * 0.4f * r * r;
    inertia[0] = inertia[1] = tube * (h * h / 3.0f + 0.25f * r * r) + ends * (0.4f * r * r + h * h + 0.75f * h * r);
}

static int good_shape(const noh_rigid_desc *d)
{
    int some = d->radius > 0.0f;
    if (!(d->radius >= 0.0f && d->radius < NOH_NUMBER_MAX)) return 0;
    for (int i = 0; i < 3; i++) {
        if (!(d->half[i] >= 0.0f && d->half[i] < NOH_NUMBER_MAX)) return 0;
    }
    some |= (d->half[0] > 0.0f) + (d->half[1] > 0.0f) + (d->half[2] > 0.0f) >= 2;
    return some;
}

noh_result noh_rigid_init(noh_rigid *body, const noh_rigid_desc *desc, noh_error *error)
{
    static const char *const wrong = "a rigid body has a side, mass, inertia or place out of its range";
    const float *own = desc->inertia, *q = desc->rotation;
    float inertia[3], turned = noh_quat_dot(q, q);
    if (!good_shape(desc)) return noh_fail(error, NOH_ERR_ARG, wrong, 0, 0);
    if (!(desc->mass > 0.0f && desc->mass < NOH_NUMBER_MAX)) return noh_fail(error, NOH_ERR_ARG, wrong, 1, 0);
    memcpy(inertia, own, sizeof inertia);
    if (own[0] == 0.0f && own[1] == 0.0f && own[2] == 0.0f) solid_inertia(desc, inertia);
    for (int i = 0; i < 3; i++) {
        if (!(inertia[i] > 0.0f && noh_is_finite(inertia[i]) && noh_is_finite(1.0f / inertia[i])))
            return noh_fail(error, NOH_ERR_ARG, wrong, 2, 0);
    }
    if (!noh_is_number3(desc->position)) return noh_fail(error, NOH_ERR_ARG, wrong, 3, 0);
    if (!(turned == 0.0f || (turned > 0.99f && turned < 1.01f))) return noh_fail(error, NOH_ERR_ARG, wrong, 3, 0);
    memset(body, 0, sizeof *body);
    memcpy(body->half, desc->half, sizeof body->half);
    body->radius = desc->radius;
    body->mass = desc->mass;
    memcpy(body->inertia, inertia, sizeof inertia);
    noh_ragdoll_origin_near(desc->position, body->origin);
    noh_sub3(desc->position, body->origin, body->position);
    body->rotation[3] = 1.0f;
    if (turned > 0.0f) memcpy(body->rotation, q, sizeof body->rotation);
    noh_quat_normalize(body->rotation);
    return NOH_OK;
}

/* ---- spin and momentum ---- */

/* Multiply or divide a vector of the world by the inertia, in the body's axes. */
static void by_inertia(const noh_rigid *b, const float v[3], int over, float out[3])
{
    float back[4];
    noh_quat_conjugate(b->rotation, back);
    noh_quat_rotate(back, v, out);
    for (int i = 0; i < 3; i++) out[i] = over ? out[i] / b->inertia[i] : out[i] * b->inertia[i];
    noh_quat_rotate(b->rotation, out, out);
}

static float capped(float x, float most)
{
    return x > most ? most : x < -most ? -most : x >= -most ? x : 0.0f;
}

/* Add to a velocity or a force, so that squares stay finite. */
static void add(float sum[3], float factor, const float more[3])
{
    for (int i = 0; i < 3; i++) sum[i] = capped(sum[i] + factor * more[i], NOH_NUMBER_MAX);
}

/* The same for a momentum or a torque: the spin, too, has to stay a number, about each of the body's axes. */
static void add_turn(const noh_rigid *b, float sum[3], float factor, const float more[3])
{
    float back[4], own[3], most[3];
    int is_cut = 0;
    for (int i = 0; i < 3; i++) sum[i] = capped(sum[i] + factor * more[i], TURN_MAX);
    noh_quat_conjugate(b->rotation, back);
    noh_quat_rotate(back, sum, own);
    for (int i = 0; i < 3; i++) {
        most[i] = capped(b->inertia[i] * NOH_NUMBER_MAX, TURN_MAX);
        is_cut |= !(noh_abs(own[i]) <= most[i]);
        own[i] = capped(own[i], most[i]);
    }
    if (is_cut) noh_quat_rotate(b->rotation, own, sum);
}

noh_result noh_rigid_set_motion(noh_rigid *body, const float velocity[3], const float spin[3], noh_error *error)
{
    static const float none[3] = { 0.0f, 0.0f, 0.0f };
    for (int i = 0; i < 3; i++) {
        if (!noh_is_number(velocity[i]) || !noh_is_number(spin[i])) {
            return noh_fail(error, NOH_ERR_ARG, "a rigid body's velocity or spin is not a number, or larger than 10^12",
                            (uint64_t)i, 0);
        }
    }
    memcpy(body->velocity, velocity, sizeof body->velocity);
    by_inertia(body, spin, 0, body->momentum);
    add_turn(body, body->momentum, 0.0f, none);
    body->still = 0;
    return NOH_OK;
}

static void arm_of(const noh_rigid *b, const float point[3], float arm[3])
{
    noh_sub3(point, b->origin, arm);
    noh_sub3(arm, b->position, arm);
}

void noh_rigid_force(noh_rigid *body, const float point[3], const float force[3])
{
    float arm[3], torque[3];
    if (!noh_is_finite3(point) || !noh_is_finite3(force)) return;
    arm_of(body, point, arm);
    noh_cross3(arm, force, torque);
    add(body->force, 1.0f, force);
    add_turn(body, body->torque, 1.0f, torque);
    body->still = 0;
}

void noh_rigid_torque(noh_rigid *body, const float torque[3])
{
    if (!noh_is_finite3(torque)) return;
    add_turn(body, body->torque, 1.0f, torque);
    body->still = 0;
}

void noh_rigid_push(noh_rigid *body, const float point[3], const float impulse[3])
{
    float arm[3], twist[3];
    if (!noh_is_finite3(point) || !noh_is_finite3(impulse)) return;
    arm_of(body, point, arm);
    noh_cross3(arm, impulse, twist);
    add(body->velocity, 1.0f / body->mass, impulse);
    add_turn(body, body->momentum, 1.0f, twist);
    body->still = 0;
}

/* ---- a substep ---- */

/* Turn a body by its momentum about one of its axes for a time, exactly. */
static void turn_about(noh_rigid *b, const float momentum[3], int axis, float seconds)
{
    float back[4], own[3], by[4] = { 0.0f, 0.0f, 0.0f, 0.0f };
    noh_quat_conjugate(b->rotation, back);
    noh_quat_rotate(back, momentum, own);
    noh_sin_cos(0.5f * seconds * own[axis] / b->inertia[axis], &by[axis], &by[3]);
    noh_quat_mul(b->rotation, by, b->rotation);
}

static void turn_free(noh_rigid *b, const float momentum[3])
{
    turn_about(b, momentum, 0, 0.5f * SECONDS);
    turn_about(b, momentum, 1, 0.5f * SECONDS);
    turn_about(b, momentum, 2, SECONDS);
    turn_about(b, momentum, 1, 0.5f * SECONDS);
    turn_about(b, momentum, 0, 0.5f * SECONDS);
    noh_quat_normalize(b->rotation);
}

/* A contact for the impulse solver. */
typedef struct hold {
    float arm[3], wanted; /* least speed along the normal */
    float push, rub[3];   /* impulses so far: along the normal, across it */
} hold;

typedef struct solver {
    noh_rigid *body;
    float velocity[3], spin[3]; /* the motion being solved: velocities, or the separation of overlaps */
    float momentum[3];
    noh_contacts contacts;
    hold holds[NOH_CONTACTS_MAX];
} solver;

static void speed_at(const solver *s, const float arm[3], float out[3])
{
    noh_cross3(s->spin, arm, out);
    noh_madd3(out, 1.0f, s->velocity, out);
}

static void apply(solver *s, const float arm[3], float size, const float along[3])
{
    float twist[3];
    noh_cross3(arm, along, twist);
    noh_madd3(s->velocity, size / s->body->mass, along, s->velocity);
    noh_madd3(s->momentum, size, twist, s->momentum);
    by_inertia(s->body, s->momentum, 1, s->spin);
}

/* The speed that a unit impulse along n makes at a point. */
static float ease(const solver *s, const float arm[3], const float n[3])
{
    float twist[3], spin[3];
    noh_cross3(arm, n, twist);
    by_inertia(s->body, twist, 1, spin);
    return 1.0f / s->body->mass + noh_dot3(twist, spin);
}

static void press(solver *s, uint32_t i)
{
    hold *h = &s->holds[i];
    const float *n = s->contacts.at[i].normal;
    float v[3];
    speed_at(s, h->arm, v);
    const float more = (h->wanted - noh_dot3(v, n)) / ease(s, h->arm, n), before = h->push;
    h->push = before + more > 0.0f ? before + more : 0.0f;
    if (h->push != before) apply(s, h->arm, h->push - before, n);
}

static void rub(solver *s, uint32_t i, float friction)
{
    hold *h = &s->holds[i];
    float v[3], rubbed[3], change[3];
    speed_at(s, h->arm, v);
    noh_reject3(v, s->contacts.at[i].normal, v);
    const float speed = noh_length3(v), most = friction * h->push;
    if (!(speed > 1e-9f) && !(noh_dot3(h->rub, h->rub) > most * most)) return;
    memcpy(rubbed, h->rub, sizeof rubbed);
    if (speed > 1e-9f) {
        float along[3];
        for (int k = 0; k < 3; k++) along[k] = v[k] / speed;
        noh_madd3(rubbed, -speed / ease(s, h->arm, along), along, rubbed);
    }
    const float size = noh_length3(rubbed);
    if (size > most) {
        for (int k = 0; k < 3; k++) rubbed[k] *= most / size;
    }
    noh_sub3(rubbed, h->rub, change);
    memcpy(h->rub, rubbed, sizeof rubbed);
    apply(s, h->arm, 1.0f, change);
}

/* The speed at which a point leaves that arrives at `speed`, is `depth` inside already, and is pulled towards the world
 * by `gravity`: as if it had bounced at the surface; otherwise small bounces would never end. */
static float bounced(float restitution, float speed, float depth, float gravity)
{
    const float before = speed - gravity * SECONDS, lift = 2.0f * gravity * depth;
    const float at_surface = before * before - lift;
    const float square = restitution * restitution * at_surface + lift;
    const float leaves = at_surface > 0.0f && square > 0.0f ? noh_sqrt(square) - gravity * SECONDS : 0.0f;
    return leaves > 0.0f ? leaves : 0.0f;
}

/* Velocities: none into the world remains, and fast ones bounce. */
static void meet(solver *s, const noh_world *world, const float gravity[3])
{
    const float slow = BOUNCE_STEPS * SECONDS * noh_length3(gravity);
    for (uint32_t i = 0; i < s->contacts.count; i++) {
        hold *h = &s->holds[i];
        float v[3];
        memset(h, 0, sizeof *h);
        noh_sub3(s->contacts.at[i].point, s->body->position, h->arm);
        speed_at(s, h->arm, v);
        const noh_contact *c = &s->contacts.at[i];
        const float speed = -noh_dot3(v, c->normal);
        if (speed > slow && world->restitution > 0.0f) {
            h->wanted = bounced(world->restitution, speed, -c->gap, -noh_dot3(gravity, c->normal));
        }
    }
    for (uint32_t sweep = 0; sweep < SWEEPS; sweep++) {
        for (uint32_t i = 0; i < s->contacts.count; i++) rub(s, i, world->friction);
        for (uint32_t i = 0; i < s->contacts.count; i++) press(s, i);
    }
}

/* Limit a vector to a length. */
static void shorten(float v[3], float most)
{
    const float length = noh_length3(v);
    if (length > most) noh_madd3(v, most / length - 1.0f, v, v);
}

/* Separate overlaps, at a bounded speed that the body does not keep. */
static void come_apart(solver *s)
{
    const float reach = noh_length3(s->body->half) + s->body->radius;
    int some = 0;
    for (uint32_t i = 0; i < s->contacts.count; i++) { /* points that separate by themselves need only the rest */
        hold *h = &s->holds[i];
        float v[3], speed = PUSH_PART * (-s->contacts.at[i].gap - SLACK) / SECONDS;
        speed_at(s, h->arm, v);
        const float leaves = noh_dot3(v, s->contacts.at[i].normal);
        speed = speed < NOH_PUSH_OUT_SPEED ? speed : NOH_PUSH_OUT_SPEED;
        h->push = 0.0f;
        h->wanted = leaves > 0.0f ? speed - leaves : speed;
        some |= h->wanted > 0.0f;
    }
    memset(s->velocity, 0, sizeof s->velocity);
    memset(s->spin, 0, sizeof s->spin);
    memset(s->momentum, 0, sizeof s->momentum);
    for (uint32_t sweep = 0; some && sweep < SWEEPS; sweep++) {
        for (uint32_t i = 0; i < s->contacts.count; i++) {
            if (s->holds[i].wanted > 0.0f) press(s, i);
        }
    }
    shorten(s->velocity, NOH_PUSH_OUT_SPEED);
    shorten(s->spin, NOH_PUSH_OUT_SPEED / reach);
}

static void turn_by(noh_rigid *b, const float spin[3])
{
    float turn[3], q[4];
    for (int i = 0; i < 3; i++) turn[i] = spin[i] * SECONDS;
    noh_quat_from_rotation(turn, q);
    noh_quat_mul(q, b->rotation, b->rotation);
    noh_quat_normalize(b->rotation);
}

/* Returns the squared speed of separation from overlaps; below 0 if it touches nothing. */
static float substep(noh_rigid *b, const noh_world *world, const float gravity[3])
{
    solver s;
    float before[3], turned[3], pull[3];
    memcpy(before, b->velocity, sizeof before);
    memcpy(turned, b->momentum, sizeof turned);
    for (int k = 0; k < 3; k++) pull[k] = gravity[k] + b->force[k] / b->mass;
    add(b->velocity, SECONDS, pull);
    add_turn(b, b->momentum, SECONDS, b->torque);
    s.contacts.count = 0;
    if (world) {
        noh_round_box shape;
        memcpy(shape.box.centre, b->position, sizeof shape.box.centre);
        memcpy(shape.box.half, b->half, sizeof shape.box.half);
        memcpy(shape.box.rotation, b->rotation, sizeof shape.box.rotation);
        shape.radius = b->radius;
        noh_contacts_find(world, b->origin, &shape, &s.contacts);
    }
    if (!s.contacts.count) { /* by the mean of both velocities, which is exact under a constant force */
        noh_madd3(b->position, 0.5f * SECONDS, before, b->position);
        noh_madd3(b->position, 0.5f * SECONDS, b->velocity, b->position);
        for (int k = 0; k < 3; k++) turned[k] = 0.5f * (turned[k] + b->momentum[k]);
        turn_free(b, turned);
        return -1.0f;
    }
    s.body = b;
    memcpy(s.velocity, b->velocity, sizeof s.velocity);
    memcpy(s.momentum, b->momentum, sizeof s.momentum);
    by_inertia(b, s.momentum, 1, s.spin);
    meet(&s, world, gravity);
    memcpy(b->velocity, s.velocity, sizeof s.velocity);
    memcpy(b->momentum, s.momentum, sizeof s.momentum);
    come_apart(&s);
    noh_madd3(b->position, SECONDS, b->velocity, b->position);
    noh_madd3(b->position, SECONDS, s.velocity, b->position);
    turn_free(b, b->momentum);
    turn_by(b, s.spin);
    return noh_dot3(s.velocity, s.velocity);
}

/* ---- time ---- */

int noh_rigid_sleeps(const noh_rigid *body)
{
    return body->still > STILL_STEPS;
}

static void rest_or_go_on(noh_rigid *b, float apart)
{
    const float reach = noh_length3(b->half) + b->radius;
    float spin[3];
    by_inertia(b, b->momentum, 1, spin);
    const float square = apart + noh_dot3(b->velocity, b->velocity) + reach * reach * noh_dot3(spin, spin);
    b->still = apart >= 0.0f && square < STILL_SPEED * STILL_SPEED ? b->still + 1u : 0;
    if (!noh_rigid_sleeps(b)) return;
    memset(b->velocity, 0, sizeof b->velocity);
    memset(b->momentum, 0, sizeof b->momentum);
}

uint32_t noh_rigid_step(noh_rigid *body, const noh_world *world, const float gravity[3], uint32_t ticks)
{
    static const float down[3] = { 0.0f, -NOH_GRAVITY, 0.0f };
    const uint32_t dropped = body->steps.dropped;
    const uint32_t steps = noh_steps_take(&body->steps, ticks, NOH_RIGID_STEP_TICKS, STEPS_MAX);
    NOH_ASSERT(!gravity || noh_is_finite3(gravity));
    for (uint32_t i = 0; i < steps && !noh_rigid_sleeps(body); i++) {
        float origin[3], by[3];
        noh_ragdoll_origin_near(body->position, origin);
        noh_madd3(body->origin, 1.0f, origin, origin);
        noh_sub3(origin, body->origin, by);
        if (noh_dot3(by, by) > 1.0f) {
            memcpy(body->origin, origin, sizeof origin);
            noh_sub3(body->position, by, body->position);
        }
        rest_or_go_on(body, substep(body, world, gravity ? gravity : down));
    }
    memset(body->force, 0, sizeof body->force);
    memset(body->torque, 0, sizeof body->torque);
    return body->steps.dropped - dropped;
}

/* ---- output ---- */

void noh_rigid_place(const noh_rigid *body, float position[3], float rotation[4])
{
    noh_madd3(body->position, 1.0f, body->origin, position);
    memcpy(rotation, body->rotation, sizeof body->rotation);
}

void noh_rigid_motion(const noh_rigid *body, float velocity[3], float spin[3], float momentum[3])
{
    if (velocity) memcpy(velocity, body->velocity, sizeof body->velocity);
    if (spin) by_inertia(body, body->momentum, 1, spin);
    if (momentum) memcpy(momentum, body->momentum, sizeof body->momentum);
}

float noh_rigid_energy(const noh_rigid *body)
{
    float spin[3];
    by_inertia(body, body->momentum, 1, spin);
    return 0.5f * (body->mass * noh_dot3(body->velocity, body->velocity) + noh_dot3(spin, body->momentum));
}

void noh_rigid_shift(noh_rigid *body, const float by[3])
{
    float lost[3];
    noh_ragdoll_origin_shift(body->origin, by, lost);
    noh_madd3(body->position, 1.0f, lost, body->position);
}

/* ---- point masses ---- */

int noh_point_touch(const noh_world *world, float radius, float position[3], float velocity[3], float seconds)
{
    noh_round_box ball;
    noh_contacts contacts;
    float origin[3];
    memset(&ball, 0, sizeof ball);
    ball.box.rotation[3] = 1.0f;
    ball.radius = radius;
    noh_ragdoll_origin_near(position, origin);
    noh_sub3(position, origin, ball.box.centre);
    noh_contacts_find(world, origin, &ball, &contacts);
    for (uint32_t i = 0; i < contacts.count; i++) {
        const noh_contact *c = &contacts.at[i];
        const float towards = noh_dot3(velocity, c->normal), depth = -c->gap;
        const float brought = seconds * (NOH_PUSH_OUT_SPEED + (towards < 0.0f ? -towards : 0.0f));
        noh_madd3(position, depth < brought ? depth : brought, c->normal, position);
        if (!(towards < 0.0f)) continue;
        const float back = towards < -BOUNCE_STEPS * NOH_GRAVITY * seconds ? -world->restitution * towards : 0.0f;
        float along[3];
        noh_reject3(velocity, c->normal, along);
        const float speed = noh_length3(along), most = world->friction * (back - towards);
        const float kept = speed > most ? 1.0f - most / speed : 0.0f;
        for (int k = 0; k < 3; k++) velocity[k] = kept * along[k] + back * c->normal[k];
    }
    return contacts.count > 0;
}
