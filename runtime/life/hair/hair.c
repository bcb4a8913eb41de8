/* hair.c: control hairs at rest, checks of hair from outside, and time. hair_lanes.c moves it. */
#include "life/hair/hair_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_core.h"
#include "noh/low_life.h"

#include "core/base/assert_internal.h"
#include "core/base/vector_internal.h"

/* ---- size and init ---- */

size_t noh_hair_size(const noh_hair_desc *desc)
{
    NOH_ASSERT(desc);
    if (!desc->hair_count || desc->hair_count > NOH_HAIRS_MAX || desc->point_count < 2u ||
        desc->point_count > NOH_HAIR_POINTS_MAX || desc->sphere_count > NOH_HAIR_SPHERES_MAX) {
        return 0;
    }
    const size_t bytes = sizeof(noh_hair) + (size_t)desc->hair_count * desc->point_count * sizeof(noh_hair_point);
    return (bytes + 15u) & ~(size_t)15u;
}

static int is_share(float x)
{
    return x >= 0.0f && x <= 1.0f;
}

static noh_result check_desc(const noh_hair_desc *d, noh_error *error)
{
    if (!noh_hair_size(d)) {
        return noh_fail(error, NOH_ERR_LIMIT,
                        "hair_count, point_count or sphere_count of a hair desc is out of its range", d->hair_count,
                        NOH_HAIRS_MAX);
    }
    if (!is_share(d->pull) || !is_share(d->pull_at_tip) || !(d->damping >= 0.0f) || !(d->gravity >= 0.0f) ||
        !noh_are_sound(&d->damping, 1) || !noh_are_sound(&d->gravity, 1)) {
        return noh_fail(error, NOH_ERR_ARG, "pull, damping or gravity of a hair desc is out of its range", 0, 0);
    }
    for (uint32_t i = 0; i < d->sphere_count; i++) {
        if (!noh_are_sound(d->spheres[i].centre, 3) || !noh_are_sound(&d->spheres[i].radius, 1) ||
            d->spheres[i].radius < 0.0f) {
            return noh_fail(error, NOH_ERR_ARG, "a sphere of a hair desc is not finite, or its radius is below 0", i,
                            0);
        }
    }
    for (uint32_t i = 0; i < d->hair_count * d->point_count; i++) {
        const float *p = d->rest + 3 * (size_t)i;
        float way[3];
        if (!noh_are_sound(p, 3))
            return noh_fail(error, NOH_ERR_ARG, "a rest point of a hair desc is not finite", i, 0);
        if (i % d->point_count == 0) continue;
        noh_sub3(p, p - 3, way);
        if (!(noh_dot3(way, way) > 1e-12f)) {
            return noh_fail(error, NOH_ERR_ARG, "two consecutive rest points of a hair are equal", i, 0);
        }
    }
    return NOH_OK;
}

int noh_hair_carries(const noh_hair_carrier *carrier)
{
    const float square = noh_quat_dot(carrier->rotation, carrier->rotation);
    return noh_are_sound(carrier->position, 3) && noh_are_sound(carrier->wind, 3) && square > 0.9f && square < 1.1f;
}

noh_result noh_hair_init(void *memory, size_t bytes, const noh_hair_desc *desc, const noh_hair_carrier *carrier,
                         noh_hair **hair, noh_error *error)
{
    noh_arena arena;
    NOH_ASSERT(desc && carrier && hair);
    noh_result result = check_desc(desc, error);
    if (!result && !noh_hair_carries(carrier)) {
        return noh_fail(error, NOH_ERR_ARG, "the carrier of hair is out of range, or its rotation is not unit", 0, 0);
    }
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

/* ---- rest ---- */

void noh_hair_shift(noh_hair *hair, const float by[3])
{
    noh_sub3(hair->last.position, by, hair->last.position);
    noh_sub3(hair->stepped.position, by, hair->stepped.position);
}

void noh_hair_reset(noh_hair *hair, const noh_hair_desc *desc, const noh_hair_carrier *carrier)
{
    NOH_ASSERT(hair && desc && carrier && desc->hair_count == hair->hair_count &&
               desc->point_count == hair->point_count);
    for (uint32_t i = 0; i < hair->hair_count * hair->point_count; i++) {
        noh_hair_point *p = &noh_hair_points_of(hair)[i];
        const float *rest = desc->rest + 3 * (size_t)i;
        float way[3] = { 0.0f, 0.0f, 0.0f };
        if (i % hair->point_count) noh_sub3(rest, rest - 3, way);
        memset(p, 0, sizeof *p);
        memcpy(p->now, rest, sizeof p->now);
        memcpy(p->before, rest, sizeof p->before);
        p->length = noh_length3(way);
    }
    if (noh_hair_carries(carrier)) hair->last = *carrier;
    hair->stepped = hair->last;
    hair->left = 0;
}

/* ---- time ---- */

static noh_hair_motion motion_of(const noh_hair *h, const noh_hair_desc *d, const noh_hair_carrier *to)
{
    noh_hair_motion m;
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
    m.keep = 1.0f / (1.0f + d->damping * NOH_HAIR_STEP_SECONDS);
    return m;
}

void noh_hair_carry(const noh_hair *h, const noh_hair_desc *d, const noh_hair_carrier *carrier, float t,
                    noh_hair_carrier *at, noh_hair_motion *motion)
{
    noh_mix3(h->last.position, carrier->position, t, at->position);
    noh_mix3(h->last.wind, carrier->wind, t, at->wind);
    noh_quat_nlerp(h->last.rotation, carrier->rotation, t, at->rotation);
    *motion = motion_of(h, d, at);
}

/* ---- hair from outside, and curves ---- */

const char *noh_hair_check(const noh_hair *hair, const noh_hair_desc *desc)
{
    NOH_ASSERT(hair && desc);
    if (hair->hair_count != desc->hair_count || hair->point_count != desc->point_count) {
        return "hair was made with another desc";
    }
    if (!noh_hair_carries(&hair->last) || !noh_hair_carries(&hair->stepped)) {
        return "hair: the head's transform is out of range";
    }
    if (hair->left >= NOH_HAIR_STEP_TICKS) return "hair: its time is out of range";
    for (uint32_t i = 0; i < hair->hair_count * hair->point_count; i++) {
        const noh_hair_point *p = &noh_hair_const_points_of(hair)[i];
        const float *rest = desc->rest + 3 * (size_t)i;
        float way[3] = { 0.0f, 0.0f, 0.0f };
        if (i % hair->point_count) noh_sub3(rest, rest - 3, way);
        if (!noh_are_sound(p->now, 3) || !noh_are_sound(p->before, 3) || !noh_are_sound(p->velocity, 3) ||
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
