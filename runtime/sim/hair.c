/* hair.c: control hairs that follow their roots, in the head's space. */
#include "sim/hair.h"

#include "base/arena.h"
#include "base/assert.h"
#include "sim/vector_internal.h"

#define FOLLOW 0.9f     /* share of a point's correction that the speed of the one before is relieved of */
#define SPEED_MAX 20.0f /* metres per second; faster after a leap that was not reset */
#define PASSES 4        /* over spheres that overlap */
#define GUST_STEPS 24u  /* from one value of the noise to the next: 0.4 s */
#define STEP_SECONDS ((float)NOH_HAIR_STEP_TICKS / 48000.0f)

/* All in head space as of the step. */
typedef struct point {
    float now[3], before[3]; /* of the last two steps */
    float velocity[3];       /* in the world, along the head's axes */
    float length;            /* from the point before; of a root 0 */
} point;

/* Behind it point[hair_count][point_count]. */
struct noh_hair {
    uint32_t hair_count, point_count;
    uint32_t left;            /* ticks since the last step */
    uint32_t steps;           /* of all time, for gusts */
    noh_hair_carrier last;    /* of the last call */
    noh_hair_carrier stepped; /* of the last step */
    uint32_t reserved[4];
};
NOH_STATIC_ASSERT(sizeof(noh_hair) == 112, hair);
NOH_STATIC_ASSERT(sizeof(point) == 40, point);

static point *points_of(noh_hair *h)
{
    return (point *)(void *)(h + 1);
}

static const point *const_points_of(const noh_hair *h)
{
    return (const point *)(const void *)(h + 1);
}

/* ---- size and init ---- */

size_t noh_hair_size(const noh_hair_desc *desc)
{
    NOH_ASSERT(desc);
    if (!desc->hair_count || desc->hair_count > NOH_HAIRS_MAX || desc->point_count < 2u ||
        desc->point_count > NOH_HAIR_POINTS_MAX || desc->sphere_count > NOH_HAIR_SPHERES_MAX) {
        return 0;
    }
    const size_t bytes = sizeof(noh_hair) + (size_t)desc->hair_count * desc->point_count * sizeof(point);
    return (bytes + 15u) & ~(size_t)15u;
}

/* Numbers whose squares, and those of their differences, stay finite. */
static int are_sound(const float *v, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!(v[i] > -1e15f && v[i] < 1e15f)) return 0;
    }
    return 1;
}

static int is_share(float x)
{
    return x >= 0.0f && x <= 1.0f;
}

static noh_result check_desc(const noh_hair_desc *d, noh_error *error)
{
    if (!noh_hair_size(d)) {
        return noh_fail(error, NOH_ERR_LIMIT, "hair has no hairs, too few points, or more than a limit", d->hair_count,
                        NOH_HAIRS_MAX);
    }
    if (!is_share(d->pull) || !is_share(d->pull_at_tip) || !(d->damping >= 0.0f) || !(d->gravity >= 0.0f) ||
        !are_sound(&d->damping, 1) || !are_sound(&d->gravity, 1)) {
        return noh_fail(error, NOH_ERR_ARG, "hair: pull, damping or gravity is out of its range", 0, 0);
    }
    for (uint32_t i = 0; i < d->sphere_count; i++) {
        if (!are_sound(d->spheres[i].centre, 3) || !are_sound(&d->spheres[i].radius, 1) ||
            d->spheres[i].radius < 0.0f) {
            return noh_fail(error, NOH_ERR_ARG, "hair: a sphere has a number out of its range", i, 0);
        }
    }
    for (uint32_t i = 0; i < d->hair_count * d->point_count; i++) {
        const float *p = d->rest + 3 * (size_t)i;
        float way[3];
        if (!are_sound(p, 3)) return noh_fail(error, NOH_ERR_ARG, "hair: a point at rest is not finite", i, 0);
        if (i % d->point_count == 0) continue;
        noh_sub3(p, p - 3, way);
        if (!(noh_dot3(way, way) > 1e-12f)) {
            return noh_fail(error, NOH_ERR_ARG, "hair: two points of a hair are at one place", i, 0);
        }
    }
    return NOH_OK;
}

noh_result noh_hair_init(void *memory, size_t bytes, const noh_hair_desc *desc, const noh_hair_carrier *carrier,
                         noh_hair **hair, noh_error *error)
{
    noh_arena arena;
    NOH_ASSERT(desc && carrier && hair);
    noh_result result = check_desc(desc, error);
    if (!result) result = noh_arena_open(&arena, memory, bytes, noh_hair_size(desc), error);
    if (result) return result;
    noh_hair *h = memory;
    memset(h, 0, noh_hair_size(desc));
    h->hair_count = desc->hair_count;
    h->point_count = desc->point_count;
    noh_hair_reset(h, desc, carrier);
    *hair = h;
    return NOH_OK;
}

/* ---- spheres ---- */

/* The spheres as one hair has them: no larger than to its root. */
typedef struct obstacles {
    uint32_t count;
    float radius[NOH_HAIR_SPHERES_MAX];
    float middle[3];
    const noh_hair_sphere *spheres;
} obstacles;

static obstacles obstacles_of(const noh_hair_desc *d, const float root[3])
{
    obstacles o;
    memset(&o, 0, sizeof o);
    o.count = d->sphere_count;
    o.spheres = d->spheres;
    for (uint32_t i = 0; i < o.count; i++) {
        float way[3];
        noh_sub3(d->spheres[i].centre, root, way);
        const float distance = noh_length3(way);
        o.radius[i] = distance < d->spheres[i].radius ? distance : d->spheres[i].radius;
        noh_madd3(o.middle, 1.0f / (float)o.count, d->spheres[i].centre, o.middle);
    }
    return o;
}

/* Turn a direction away from a sphere until what lies at `length` along it from `head` is out of the sphere. The head
 * is outside, so there always is such a direction; none is pushed off its length. 0: it was out. */
static int turn_away(const noh_hair_sphere *s, float radius, const float head[3], float length, float direction[3])
{
    static const float up[3] = { 0.0f, 1.0f, 0.0f };
    float way[3], side[3];
    noh_sub3(s->centre, head, way);
    const float square = noh_dot3(way, way), reach = length * length + square - radius * radius;
    if (2.0f * length * noh_dot3(direction, way) <= reach || !(square > 0.0f)) return 0;
    const float far_off = noh_sqrt(square), most = reach / (2.0f * length * far_off);
    if (most >= 1.0f) return 0;
    noh_madd3(way, 1.0f / far_off - 1.0f, way, way);
    noh_reject3(direction, way, side);
    if (noh_dot3(side, side) > 1e-8f) {
        noh_normalize3(side, up);
    } else {
        noh_perpendicular3(way, up, side); /* straight at the centre: to any side */
    }
    const float cosine = most > -1.0f ? most : -1.0f, rest = 1.0f - cosine * cosine;
    const float sine = rest > 0.0f ? noh_sqrt(rest) : 0.0f;
    for (int i = 0; i < 3; i++) direction[i] = cosine * way[i] + sine * side[i];
    return 1;
}

/* Put a point at its length from the one before, as near as may be to where it is, out of all spheres. */
static void follow(const obstacles *o, const float head[3], float length, float p[3])
{
    static const float down[3] = { 0.0f, -1.0f, 0.0f };
    float direction[3];
    int turned = 0;
    noh_sub3(p, head, direction);
    noh_normalize3(direction, down);
    for (int pass = 0; pass < PASSES && (turned || !pass); pass++) {
        turned = 0;
        for (uint32_t i = 0; i < o->count; i++)
            turned |= turn_away(&o->spheres[i], o->radius[i], head, length, direction);
    }
    if (turned && o->count > 1u) { /* between spheres: away from all of them */
        noh_sub3(head, o->middle, direction);
        noh_normalize3(direction, down);
    }
    noh_madd3(head, length, direction, p);
}

/* ---- rest ---- */

void noh_hair_reset(noh_hair *hair, const noh_hair_desc *desc, const noh_hair_carrier *carrier)
{
    NOH_ASSERT(hair && desc && carrier && desc->hair_count == hair->hair_count &&
               desc->point_count == hair->point_count);
    for (uint32_t i = 0; i < hair->hair_count * hair->point_count; i++) {
        point *p = &points_of(hair)[i];
        const float *rest = desc->rest + 3 * (size_t)i;
        float way[3] = { 0.0f, 0.0f, 0.0f };
        if (i % hair->point_count) noh_sub3(rest, rest - 3, way);
        memset(p, 0, sizeof *p);
        memcpy(p->now, rest, sizeof p->now);
        memcpy(p->before, rest, sizeof p->before);
        p->length = noh_length3(way);
    }
    hair->last = hair->stepped = *carrier;
    hair->left = 0;
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

/* Value noise, 0..1: of a seed, a hair and time, smooth in time. Neighbours by index share half of it. */
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

/* What a step knows of the head: from its space in the last step to that in this one, and what pulls. */
typedef struct motion {
    float turn[3][3], moved[3]; /* columns */
    float gravity[3], wind[3];  /* head space */
    float keep;                 /* of a speed */
} motion;

static motion motion_of(const noh_hair *h, const noh_hair_desc *d, const noh_hair_carrier *to)
{
    motion m;
    float back[4], turn[4];
    const float down[3] = { 0.0f, -d->gravity, 0.0f };
    noh_quat_conjugate(to->rotation, back);
    noh_quat_mul(back, h->stepped.rotation, turn);
    noh_quat_normalize(turn);
    memset(m.turn, 0, sizeof m.turn);
    for (int c = 0; c < 3; c++) {
        m.turn[c][c] = 1.0f;
        noh_quat_rotate(turn, m.turn[c], m.turn[c]);
    }
    noh_sub3(h->stepped.position, to->position, m.moved);
    noh_quat_rotate(back, m.moved, m.moved);
    noh_quat_rotate(back, down, m.gravity);
    noh_quat_rotate(back, to->wind, m.wind);
    m.keep = 1.0f / (1.0f + d->damping * STEP_SECONDS);
    return m;
}

static void limit_speed(float velocity[3])
{
    const float square = noh_dot3(velocity, velocity);
    if (square > SPEED_MAX * SPEED_MAX) {
        noh_madd3(velocity, SPEED_MAX / noh_sqrt(square) - 1.0f, velocity, velocity);
    }
}

/* One point by inertia, forces and the pull to rest. stood: where it stood in the world, in the head's new space */
static void move_point(const motion *m, const float force[3], float pull, const float rest[3], point *p, float stood[3])
{
    float velocity[3], to_rest[3];
    for (int c = 0; c < 3; c++) {
        stood[c] = m->moved[c] + m->turn[0][c] * p->now[0] + m->turn[1][c] * p->now[1] + m->turn[2][c] * p->now[2];
        velocity[c] = m->turn[0][c] * p->velocity[0] + m->turn[1][c] * p->velocity[1] + m->turn[2][c] * p->velocity[2];
    }
    memcpy(p->before, p->now, sizeof p->before);
    for (int c = 0; c < 3; c++) {
        velocity[c] = m->keep * velocity[c] + STEP_SECONDS * force[c];
        p->now[c] = stood[c] + STEP_SECONDS * velocity[c];
    }
    noh_sub3(rest, p->now, to_rest);
    noh_madd3(p->now, pull, to_rest, p->now);
}

static void step_hair(const noh_hair *h, const noh_hair_desc *d, const motion *m, uint32_t hair, point *points)
{
    const float *rest = d->rest + 3 * (size_t)hair * h->point_count;
    const obstacles o = obstacles_of(d, rest);
    const float share = gust(d->seed, hair, h->steps);
    float force[3];
    noh_madd3(m->gravity, 2.0f * share, m->wind, force);
    for (uint32_t i = 1; i < h->point_count; i++) {
        point *p = &points[i];
        const float t = (float)i / (float)(h->point_count - 1u), *at = rest + 3 * (size_t)i;
        float stood[3], free_at[3], correction[3];
        move_point(m, force, d->pull + t * (d->pull_at_tip - d->pull), at, p, stood);
        memcpy(free_at, p->now, sizeof free_at);
        follow(&o, points[i - 1u].now, p->length, p->now);
        noh_sub3(p->now, stood, p->velocity);
        noh_madd3(p->velocity, 1.0f / STEP_SECONDS - 1.0f, p->velocity, p->velocity);
        noh_sub3(p->now, free_at, correction);
        if (i > 1u) {
            noh_madd3(points[i - 1u].velocity, -FOLLOW / STEP_SECONDS, correction, points[i - 1u].velocity);
            limit_speed(points[i - 1u].velocity);
        }
    }
    limit_speed(points[h->point_count - 1u].velocity);
}

/* ---- time ---- */

static void mix3(const float a[3], const float b[3], float t, float out[3])
{
    for (int i = 0; i < 3; i++) out[i] = a[i] + t * (b[i] - a[i]);
}

static void advance(noh_hair *h, const noh_hair_desc *d, const noh_hair_carrier *carrier, float t)
{
    noh_hair_carrier at = *carrier;
    mix3(h->last.position, carrier->position, t, at.position);
    mix3(h->last.wind, carrier->wind, t, at.wind);
    noh_quat_nlerp(h->last.rotation, carrier->rotation, t, at.rotation);
    const motion m = motion_of(h, d, &at);
    for (uint32_t i = 0; i < h->hair_count; i++) {
        step_hair(h, d, &m, i, points_of(h) + (size_t)i * h->point_count);
    }
    h->stepped = at;
    h->steps++;
}

uint32_t noh_hair_step(noh_hair *hair, const noh_hair_desc *desc, const noh_hair_carrier *carrier, uint32_t ticks)
{
    NOH_ASSERT(hair && desc && carrier && desc->hair_count == hair->hair_count &&
               desc->point_count == hair->point_count);
    const uint64_t whole = ((uint64_t)hair->left + ticks) / NOH_HAIR_STEP_TICKS;
    const uint32_t steps = whole < NOH_HAIR_STEPS_MAX ? (uint32_t)whole : NOH_HAIR_STEPS_MAX;
    const uint32_t dropped = (uint32_t)(whole - steps) * NOH_HAIR_STEP_TICKS, kept = ticks - dropped;
    for (uint32_t i = 1; i <= steps; i++) {
        advance(hair, desc, carrier, (float)(i * NOH_HAIR_STEP_TICKS - hair->left) / (float)kept);
    }
    hair->left += kept - steps * NOH_HAIR_STEP_TICKS;
    hair->last = *carrier;
    return dropped;
}

/* ---- what comes out ---- */

void noh_hair_points(const noh_hair *hair, const noh_hair_desc *desc, float *points)
{
    const float t = (float)hair->left / (float)NOH_HAIR_STEP_TICKS;
    NOH_ASSERT(hair && desc && points && desc->hair_count == hair->hair_count);
    for (uint32_t h = 0; h < hair->hair_count; h++) {
        const size_t first = (size_t)h * hair->point_count;
        const point *p = const_points_of(hair) + first;
        const obstacles o = obstacles_of(desc, desc->rest + 3 * first);
        float *out = points + 3 * first;
        memcpy(out, p->now, 3 * sizeof *out);
        for (uint32_t i = 1; i < hair->point_count; i++) {
            float *at = out + 3 * (size_t)i;
            mix3(p[i].before, p[i].now, t, at);
            follow(&o, at - 3, p[i].length, at);
        }
    }
}

const char *noh_hair_check(const noh_hair *hair, const noh_hair_desc *desc)
{
    NOH_ASSERT(hair && desc);
    if (hair->hair_count != desc->hair_count || hair->point_count != desc->point_count) {
        return "hair is of another desc";
    }
    const noh_hair_carrier *carriers[2] = { &hair->last, &hair->stepped };
    for (int i = 0; i < 2; i++) {
        const float square = noh_quat_dot(carriers[i]->rotation, carriers[i]->rotation);
        if (!are_sound(carriers[i]->position, 3) || !are_sound(carriers[i]->wind, 3) ||
            !(square > 0.9f && square < 1.1f)) {
            return "hair: the head is out of range";
        }
    }
    if (hair->left >= NOH_HAIR_STEP_TICKS) return "hair: its time is out of range";
    for (uint32_t i = 0; i < hair->hair_count * hair->point_count; i++) {
        const point *p = &const_points_of(hair)[i];
        const float *rest = desc->rest + 3 * (size_t)i;
        float way[3] = { 0.0f, 0.0f, 0.0f };
        if (i % hair->point_count) noh_sub3(rest, rest - 3, way);
        if (!are_sound(p->now, 3) || !are_sound(p->before, 3) || !are_sound(p->velocity, 3) ||
            p->length != noh_length3(way)) {
            return "hair: a point is out of range";
        }
    }
    return NULL;
}

void noh_hair_curve(const float *points, uint32_t count, float t, float out[3])
{
    NOH_ASSERT(points && count > 1u);
    const float along = (t > 0.0f ? t < 1.0f ? t : 1.0f : 0.0f) * (float)(count - 1u);
    const uint32_t whole = (uint32_t)along, at = whole < count - 2u ? whole : count - 2u;
    const float u = along - (float)at;
    const float *p1 = points + 3 * (size_t)at, *p2 = p1 + 3;
    for (int c = 0; c < 3; c++) {
        const float before = at ? p1[c - 3] : p1[c] - (p2[c] - p1[c]);
        const float after = at + 2u < count ? p2[c + 3] : p2[c] + (p2[c] - p1[c]);
        const float m1 = 0.5f * (p2[c] - before), m2 = 0.5f * (after - p1[c]), way = p2[c] - p1[c];
        out[c] = p1[c] + u * (m1 + u * (3.0f * way - 2.0f * m1 - m2 + u * (m1 + m2 - 2.0f * way)));
    }
}
